"""Largest storey shears and floor accelerations: looked at only where one may be raised.

A storey shear is a sum over modes, sum_r s_ir q_r, so that all of them cost n^2 products a sample,
more than the motion itself. By Cauchy and Schwarz's inequality

    (sum_r s_ir q_r)^2 <= (sum_r s_ir^2/g_r) (sum_r g_r q_r^2)

whatever the weights g_r > 0: while the last sum, which costs n, stays below the least

    (largest shear so far of storey i)^2/(sum_r s_ir^2/g_r),

no storey's shear is raised. The same holds for floor accelerations, sums over the modes' pulls.
`rpscli.analyses.kernel_tables` says which weights.
"""

from __future__ import annotations

import math

from rpscli.physics.lanes import floor_count, lane_count
from rpscli.physics.layout import (
    BLOCKS,
    FLOOR,
    FLOOR_ACCELERATION,
    NEXT_Q,
    PULL,
    PULLED_BOUND,
    PULLED_REACH,
    SCALARS,
    SEEN,
    STOREY,
    STOREY_SHEAR,
    STRAIN_BOUND,
    STRAIN_REACH,
)
from rpscli.physics.parameters import Floats, Shape
from rpscli.physics.part import lane_routine, part

SURELY = 1.0 - 1e-9
"""Room for the rounding of either side."""


@lane_routine
def raise_floors(b: Floats, shape: Shape) -> None:
    """Raise the demands of storeys and floors by those at the end of the step, where SEEN."""
    n, L = floor_count(shape), len(shape.stride)
    threes = n - n % 3
    for i in range(n):
        floor = (SCALARS + i) * L
        for l in range(lane_count(shape)):
            b[STOREY * L + l], b[FLOOR * L + l] = 0.0, 0.0
        for r in range(0, threes, 3):
            add_modes(b, shape, i, r)
        for r in range(threes, n):
            add_mode(b, shape, i, r)
        for l in range(lane_count(shape)):
            shear = b[SEEN * L + l] * abs(b[STOREY * L + l])
            row = floor + STOREY_SHEAR * n * L + l
            b[row] = max(b[row], shear)
        for l in range(lane_count(shape)):
            absolute = b[SEEN * L + l] * abs(b[FLOOR * L + l])
            row = floor + FLOOR_ACCELERATION * n * L + l
            b[row] = max(b[row], absolute)
    for l in range(lane_count(shape)):
        b[STRAIN_REACH * L + l], b[PULLED_REACH * L + l] = math.inf, math.inf
    for i in range(n):
        floor = (SCALARS + i) * L
        for l in range(lane_count(shape)):
            extend_reach(b, n, L, floor, l)


@part
def add_mode(b: Floats, shape: Shape, i: int, r: int) -> None:
    """Add what mode r contributes at storey i: shear k_i (phi_i - phi_(i-1)) q and pull."""
    n, L = floor_count(shape), len(shape.stride)
    mode, shapes = (SCALARS + r) * L, (SCALARS + (BLOCKS + r) * n + i) * L
    q, pull = mode + NEXT_Q * n * L, mode + PULL * n * L
    for l in range(lane_count(shape)):
        b[STOREY * L + l] += b[shapes + n * n * L + l] * b[q + l]
        b[FLOOR * L + l] += b[shapes + l] * b[pull + l]


@part
def add_modes(b: Floats, shape: Shape, i: int, r: int) -> None:
    """The same for the modes r, r + 1 and r + 2: the sum waits in a register."""
    n, L = floor_count(shape), len(shape.stride)
    mode, shapes = (SCALARS + r) * L, (SCALARS + (BLOCKS + r) * n + i) * L
    q, pull = mode + NEXT_Q * n * L, mode + PULL * n * L
    next_shape, shears = n * L, shapes + n * n * L
    for l in range(lane_count(shape)):
        b[STOREY * L + l] += (
            b[shears + l] * b[q + l]
            + b[shears + next_shape + l] * b[q + L + l]
            + b[shears + 2 * next_shape + l] * b[q + 2 * L + l]
        )
        b[FLOOR * L + l] += (
            b[shapes + l] * b[pull + l]
            + b[shapes + next_shape + l] * b[pull + L + l]
            + b[shapes + 2 * next_shape + l] * b[pull + 2 * L + l]
        )


@part
def extend_reach(b: Floats, n: int, L: int, floor: int, l: int) -> None:
    """Lower the reach of a lane to that of a floor whose rows begin at entry `floor`."""
    shear = b[floor + STOREY_SHEAR * n * L + l]
    reach = SURELY * (shear * shear) * b[floor + STRAIN_BOUND * n * L + l]
    b[STRAIN_REACH * L + l] = min(b[STRAIN_REACH * L + l], reach)
    top = b[floor + FLOOR_ACCELERATION * n * L + l]
    reach = SURELY * (top * top) * b[floor + PULLED_BOUND * n * L + l]
    b[PULLED_REACH * L + l] = min(b[PULLED_REACH * L + l], reach)
