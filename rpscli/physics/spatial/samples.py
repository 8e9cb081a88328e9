"""Samples of a history under two components, as `planar.samples`."""

from __future__ import annotations

import math

from rpscli.physics.core.compile import compiled
from rpscli.physics.core.records import Record
from rpscli.physics.core.series import cubic, integral, slope, value
from rpscli.physics.planar.equation_of_motion import modal_terms, rotation_terms
from rpscli.physics.planar.run import Output
from rpscli.physics.planar.samples import PASSED
from rpscli.physics.planar.state import FULL_CONTACT
from rpscli.physics.spatial.energy import direction_at
from rpscli.physics.spatial.equation_of_motion import (
    beam_motion,
    place_of,
    rates_now,
    turning_terms,
)
from rpscli.physics.spatial.state import Pair


@compiled
def store_sample_3d(s: Record, l: int, systems: Pair, output: Output) -> None:
    """Keep the state at the start of the present interval, if there is room."""
    for r in range(s.n):
        s.next_q[r, l], s.next_dq[r, l] = s.q[r, l], s.dq[0, r, l]
    rates = 0.0, 0.0, 0.0, 0.0
    if s.phase[l] != FULL_CONTACT:
        rates = rates_now(s, l)
    at_row, direction = s.interval[l] * output.finer, (s.cos_phi[l], s.sin_phi[l])
    store_row_3d(s, l, systems, output, at_row, s.theta[l], direction, rates)


@compiled
def store_within_3d(s: Record, l: int, systems: Pair, output: Output, fraction: float) -> None:
    """Keep the states at the even parts of the interval that the first part of the step passes."""
    h, rates, turning = s.step[l], rotation_terms(s, l), turning_terms(s, l)
    part = s.dt[l] / output.finer
    for j in range(max(math.ceil(s.time[l] / part - PASSED), 1), output.finer):
        t = (j * part - s.time[l]) / h
        if t * h >= fraction * h - PASSED * part:
            break
        for r in range(s.n):
            mode = modal_terms(s, r, l)
            s.kept[0, r], s.kept[1, r] = s.next_q[r, l], s.next_dq[r, l]
            s.next_q[r, l] = s.q[r, l] + h * integral(mode, t)
            s.next_dq[r, l] = value(mode, t)
        store_row_3d(
            s,
            l,
            systems,
            output,
            s.interval[l] * output.finer + j,
            s.theta[l] + h * integral(rates, t),
            direction_at(s, l, t),
            (value(rates, t), value(turning, t), slope(rates, t) / h, slope(turning, t) / h),
        )
        for r in range(s.n):
            s.next_q[r, l], s.next_dq[r, l] = s.kept[0, r], s.kept[1, r]


@compiled
def store_at_rest_3d(
    s: Record, l: int, systems: Pair, blocks: Record, output: Output, k: int, begin: float, h: float
) -> None:
    """The same in a step of the blocks, the k-th, that begins at a time of the interval."""
    part, half = s.dt[l] / output.finer, s.storeys
    for j in range(max(math.ceil(begin / part - PASSED), 1), output.finer):
        time = j * part - begin
        if time >= h - PASSED * part:
            break
        for r in range(s.n):
            block, of = (blocks[0], r) if r < half else (blocks[1], r - half)
            v0, v1 = h * block.dqs[of, k], h * block.dqs[of, k + 1]
            q, change = cubic(block.qs[of, k], block.qs[of, k + 1], v0, v1, time / h)
            s.next_q[r, l], s.next_dq[r, l] = q, change / h
        row, rest = s.interval[l] * output.finer + j, (0.0, 0.0, 0.0, 0.0)
        store_row_3d(s, l, systems, output, row, 0.0, (1.0, 0.0), rest)


@compiled
def store_row_3d(
    s: Record,
    l: int,
    systems: Pair,
    output: Output,
    row: int,
    theta: float,
    direction: tuple[float, float],
    rates: tuple[float, float, float, float],
) -> None:
    """Keep a tilt and its rates p, w, p' and w', with the modes as they stand at the step's end."""
    if row >= output.samples.shape[0]:
        return
    sample, half, stands = output.samples[row], s.storeys, s.phase[l] == FULL_CONTACT
    sample.theta, sample.azimuth = 0.0, 0.0
    sample.theta_dot, sample.turning, sample.theta_ddot, sample.turning_rate = rates
    sample.phase = s.phase[l]
    sample.push_x, sample.push_y = s.push_x[l], s.push_y[l]
    sample.energy_input, sample.energy_damped = s.energy_input[l], s.energy_damped[l]
    sample.energy_lost = s.energy_lost[l]
    beam = 0.0, 0.0, 0.0, 0.0
    if not stands:
        kept = s.cos_phi[l], s.sin_phi[l]
        s.cos_phi[l], s.sin_phi[l] = direction
        beam = beam_motion(s, l, place_of(s, l, theta), rates[0], rates[1])
        s.cos_phi[l], s.sin_phi[l] = kept
        sample.theta, sample.azimuth = theta, math.atan2(direction[1], direction[0])
    for j in range(s.n):
        axis, i = (0, j) if j < half else (1, j - half)
        u, du = beam[axis], beam[2 + axis]
        system = systems[0] if axis == 0 else systems[1]
        for r in range(half):
            u += system.phi[r, i] * s.next_q[half * axis + r, l]
            du += system.phi[r, i] * s.next_dq[half * axis + r, l]
        output.floors[row, 0, j], output.floors[row, 1, j] = u, du
