"""From one sample of the record to the next: store, and see whether the history is over."""

from __future__ import annotations

import math

from rpscli.physics.core.compile import by_record, compiled
from rpscli.physics.core.lanes import along, directions
from rpscli.physics.core.records import Record
from rpscli.physics.core.series import cubic, integral, sine_cosine, slope, value
from rpscli.physics.planar.bed.passages import energy_of_bed
from rpscli.physics.planar.devices.flows import store_devices
from rpscli.physics.planar.equation_of_motion import (
    cap_beam_displacement,
    contact_height,
    modal_terms,
    phase_constants,
    rotation_terms,
)
from rpscli.physics.planar.run import Output
from rpscli.physics.planar.state import FULL_CONTACT

PASSED = 1e-9
"""Of a part of the interval: what is passed by less is met."""


@compiled
def store_sample(s: Record, l: int, system: Record, output: Output) -> None:
    """Keep the state at the start of the present interval, if there is room."""
    for r in range(s.n):
        s.looked_at[0, r], s.looked_at[1, r] = s.q[r, l], s.dq[0, r, l]
    store_row(s, l, system, output, s.interval[l] * output.finer)


@compiled
def store_within(s: Record, l: int, system: Record, output: Output, fraction: float) -> None:
    """Keep the states at the even parts of the interval that the first part of the step passes."""
    h, part = s.step[l], s.dt[l] / output.finer
    if h <= 0.0:
        return
    for j in range(max(math.ceil(s.time[l] / part - PASSED), 1), output.finer):
        t = (j * part - s.time[l]) / h
        if t * h >= fraction * h - PASSED * part:
            break
        for r in range(s.n):
            mode = modal_terms(s, r, l)
            s.looked_at[0, r] = s.q[r, l] + h * integral(mode, t)
            s.looked_at[1, r] = value(mode, t)
        store_row_within(s, l, system, output, s.interval[l] * output.finer + j, t)


@by_record
def store_row_within(s: Record, l: int, system: Record, output: Output, at: int, t: float) -> None:
    """Keep the state a fraction t into the step, its modes as they stand in `looked_at`."""
    h, terms = s.step[l], rotation_terms(s, l)
    theta, theta_dot, theta_ddot = s.theta[l], s.theta_dot[l], s.theta_ddot[l]
    s.theta[l], s.theta_dot[l] = theta + h * integral(terms, t), value(terms, t)
    s.theta_ddot[l] = slope(terms, t) / h
    store_row(s, l, system, output, at)
    s.theta[l], s.theta_dot[l], s.theta_ddot[l] = theta, theta_dot, theta_ddot


@compiled
def store_at_rest(
    s: Record, l: int, system: Record, block: Record, output: Output, k: int, begin: float, h: float
) -> None:
    """The same in a step of the block, the k-th, that begins at a time of the interval."""
    part = s.dt[l] / output.finer
    for j in range(max(math.ceil(begin / part - PASSED), 1), output.finer):
        time = j * part - begin
        if time >= h - PASSED * part:
            break
        x = along(s, block, 0)
        s.next_V[l] = 0.0
        s.next_a_g[l] = x.a_g[k] + x.a_g_slope[k] * time
        s.next_g_up[l] = x.g_up[k] + x.g_up_slope[k] * time
        for axis in range(directions(s)):
            of = along(s, block, axis)
            for r in range(of.n):
                v0, v1, mode = h * of.dqs[r, k], h * of.dqs[r, k + 1], axis * of.n + r
                q, change = cubic(of.qs[r, k], of.qs[r, k + 1], v0, v1, time / h)
                s.looked_at[0, mode], s.looked_at[1, mode] = q, change / h
                force = s.omega2[mode, l] * q + s.two_xi_omega[mode, l] * change / h
                s.next_V[l] += s.Gamma[mode, l] * force
        store_row(s, l, system, output, s.interval[l] * output.finer + j)


@by_record
def store_row(s: Record, l: int, system: Record, output: Output, at: int) -> None:
    """Keep the state of a lane, its modes as they stand in `looked_at`, if there is room."""
    if at >= output.samples.shape[0]:
        return
    sample, side = output.samples[at], s.side[l]
    stands = s.phase[l] == FULL_CONTACT
    sample.theta, sample.theta_dot = side * s.theta[l], side * s.theta_dot[l]
    sample.theta_ddot = 0.0 if stands else side * s.theta_ddot[l]
    sample.phase = s.phase[l]
    sample.energy_input, sample.energy_damped = s.energy_input[l], s.energy_damped[l]
    sample.energy_lost = s.energy_lost[l]
    sample.bed_energy = energy_of_bed(s, l)
    u_b, du_b = 0.0, 0.0
    if not stands:
        phase, (sine, cosine) = phase_constants(s, l), sine_cosine(s.theta[l])
        u_b = side * s.diameter[l] * cap_beam_displacement(phase, s.theta[l], cosine, sine)
        du_b = side * s.diameter[l] * contact_height(phase, cosine, sine) * s.theta_dot[l]
    for i in range(s.n):
        u, du = u_b, du_b
        for r in range(s.n):
            u += system.phi[r, i] * s.looked_at[0, r]
            du += system.phi[r, i] * s.looked_at[1, r]
        output.floors[at, 0, i], output.floors[at, 1, i] = u, du
    if s.devices[l] > 0:
        store_devices(s, l, output.devices[at], 0.0)
