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

from rpscli.physics.lanes import floor_count, lane_count, written
from rpscli.physics.layout import (
    ACCELERATION_NOW,
    BLOCKS,
    FLOOR_ACCELERATION,
    NEXT_Q,
    PULL,
    PULLED_BOUND,
    PULLED_REACH,
    SCALARS,
    SEEN,
    SHEAR_NOW,
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
    """Raise the demands of storeys and floors by those at the end of the step, where SEEN.

    Floors follow one another within modes, so that no sum waits for its own last term.
    """
    n, L = floor_count(shape), len(shape.stride)
    threes = n - n % 3
    shears, tops = (SCALARS + SHEAR_NOW * n) * L, (SCALARS + ACCELERATION_NOW * n) * L
    for i in range(n * L):
        b[shears + i], b[tops + i] = 0.0, 0.0
    for r in range(0, threes, 3):
        for i in range(n):
            add_modes(b, shape, i, r)
    for r in range(threes, n):
        for i in range(n):
            add_mode(b, shape, i, r)
    for l in range(lane_count(shape)):
        b[STRAIN_REACH * L + l], b[PULLED_REACH * L + l] = math.inf, math.inf
    for i in range(n):
        floor = (SCALARS + i) * L
        for l in range(lane_count(shape)):
            seen = b[SEEN * L + l]
            row = floor + STOREY_SHEAR * n * L + l
            b[row] = written(max(b[row], seen * abs(b[floor + SHEAR_NOW * n * L + l])))
            row = floor + FLOOR_ACCELERATION * n * L + l
            b[row] = written(max(b[row], seen * abs(b[floor + ACCELERATION_NOW * n * L + l])))
        for l in range(lane_count(shape)):
            lower_reach(b, n, L, floor, l)


@part
def add_mode(b: Floats, shape: Shape, i: int, r: int) -> None:
    """Add what mode r contributes at storey i: shear k_i (phi_i - phi_(i-1)) q and pull."""
    n, L = floor_count(shape), len(shape.stride)
    mode, shapes = (SCALARS + r) * L, (SCALARS + (BLOCKS + r) * n + i) * L
    q, pull, shears = mode + NEXT_Q * n * L, mode + PULL * n * L, shapes + n * n * L
    shear, top = (SCALARS + SHEAR_NOW * n + i) * L, (SCALARS + ACCELERATION_NOW * n + i) * L
    for l in range(lane_count(shape)):
        b[shear + l] += b[shears + l] * b[q + l]
        b[top + l] += b[shapes + l] * b[pull + l]


@part
def add_modes(b: Floats, shape: Shape, i: int, r: int) -> None:
    """The same for the modes r, r + 1 and r + 2."""
    n, L = floor_count(shape), len(shape.stride)
    mode, shapes = (SCALARS + r) * L, (SCALARS + (BLOCKS + r) * n + i) * L
    q, pull, shears = mode + NEXT_Q * n * L, mode + PULL * n * L, shapes + n * n * L
    shear, top = (SCALARS + SHEAR_NOW * n + i) * L, (SCALARS + ACCELERATION_NOW * n + i) * L
    second, third = n * L, 2 * n * L
    for l in range(lane_count(shape)):
        b[shear + l] = (
            b[shear + l]
            + b[shears + l] * b[q + l]
            + b[shears + second + l] * b[q + L + l]
            + b[shears + third + l] * b[q + 2 * L + l]
        )
        b[top + l] = (
            b[top + l]
            + b[shapes + l] * b[pull + l]
            + b[shapes + second + l] * b[pull + L + l]
            + b[shapes + third + l] * b[pull + 2 * L + l]
        )


@part
def lower_reach(b: Floats, n: int, L: int, floor: int, l: int) -> None:
    """Lower the reach of a lane to that of a floor whose rows begin at entry `floor`."""
    shear, top = b[floor + STOREY_SHEAR * n * L + l], b[floor + FLOOR_ACCELERATION * n * L + l]
    reach = reach_of(shear, b[floor + STRAIN_BOUND * n * L + l])
    b[STRAIN_REACH * L + l] = written(min(b[STRAIN_REACH * L + l], reach))
    reach = reach_of(top, b[floor + PULLED_BOUND * n * L + l])
    b[PULLED_REACH * L + l] = written(min(b[PULLED_REACH * L + l], reach))


@part
def reach_of(largest: float, bound: float) -> float:
    """What the weighted squares of the modes may reach without raising the largest demand."""
    return SURELY * (largest * largest) * bound
