"""Rows of samples: the motion at the record's samples, and at even parts between them."""

from __future__ import annotations

import math

from rpscli.physics.core.compile import compiled
from rpscli.physics.core.quintic import quintic, slope, value
from rpscli.physics.demands import tilt_within
from rpscli.physics.devices import act, push_at_rest, store_devices, worked
from rpscli.physics.laws import beam_at, motion_at, patch, place_with, polar, rate_of, tilt_of, ways_of
from rpscli.physics.run import Output
from rpscli.physics.state import FULL_CONTACT, Record

PASSED = 1e-9
"""Of a part of the interval: what is passed by less is met."""


@compiled
def store_sample(s: Record, l: int, systems: Record, output: Output) -> None:
    """Keep the state at the start of the present interval, if there is room."""
    for axis in range(ways_of(s)):
        for i in range(s.n):
            r = axis * s.n + i
            s.looked_at[2 * axis, i], s.looked_at[2 * axis + 1, i] = s.q[r, l], s.dq[r, l]
    row = s.interval[l] * output.finer
    write_row(s, l, systems, output, row, tilt_of(s, l), rate_of(s, l), s.time[l])


@compiled
def store_within(s: Record, l: int, systems: Record, output: Output) -> None:
    """Keep the states at the even parts of the interval that the step just taken passes."""
    h, part = s.h[l], s.dt[l] / output.finer
    if h <= 0.0:
        return
    for j in range(max(math.ceil(s.time[l] / part - PASSED), 1), output.finer):
        t = (j * part - s.time[l]) / h
        if t * h >= h - PASSED * part:
            break
        for axis in range(ways_of(s)):
            for i in range(s.n):
                r = axis * s.n + i
                ddq = -(s.Gamma[r, l] * s.new_base[axis, l]) - s.force[r, l]
                q = quintic(
                    h, s.q[r, l], s.dq[r, l], s.ddq[0, r, l], s.new_q[r, l], s.new_dq[r, l], ddq
                )
                s.looked_at[2 * axis, i], s.looked_at[2 * axis + 1, i] = value(q, t), slope(q, t) / h
        tilt, rate = tilt_within(s, l, t)
        row = s.interval[l] * output.finer + j
        write_row(s, l, systems, output, row, tilt, rate, s.time[l] + t * h)


@compiled
def write_row(
    s: Record,
    l: int,
    systems: Record,
    output: Output,
    row: int,
    tilt: tuple[float, float],
    rate: tuple[float, float],
    time: float,
) -> None:
    """Keep a motion of a lane, whose modes stand in `looked_at`."""
    if row >= output.samples.shape[0]:
        return
    sample, n, ways = output.samples[row], s.n, ways_of(s)
    V_x, V_y = 0.0, 0.0
    for i in range(n):
        V_x += s.Gamma[i, l] * (
            s.omega2[i, l] * s.looked_at[0, i] + s.two_xi_omega[i, l] * s.looked_at[1, i]
        )
        if ways == 2:
            r = n + i
            V_y += s.Gamma[r, l] * (
                s.omega2[r, l] * s.looked_at[2, i] + s.two_xi_omega[r, l] * s.looked_at[3, i]
            )
    x, cosine, sine, p, q = polar(s, l, tilt, rate)
    w, dw = patch(s, l, x)
    a_x, a_y = s.a_g[0, l] + time * s.a_g_slope[0, l], 0.0
    if ways == 2:
        a_y = s.a_g[ways - 1, l] + time * s.a_g_slope[ways - 1, l]
    g_up, share = s.g_up[l] + time * s.g_up_slope[l], 0.0
    if s.devices[l] > 0:
        at = worked(s, l, tilt, rate)
        act(s, l, at)
        if s.moves[l] == 0.0 and ways == 1:
            share = push_at_rest(s, l, V_x, a_x, g_up)
        store_devices(s, l, at, share, output.devices[row])
    drive_y = s.drive[ways - 1, l] if ways == 2 else 0.0
    z_x = s.share[l] * (V_x + s.drive[0, l]) - s.load[l] * a_x
    z_y = s.share[l] * (V_y + drive_y) - s.load[l] * a_y
    place = place_with(s, l, x, w, dw)
    motion = motion_at(s, l, place, w, tilt, rate, (z_x, z_y), g_up)
    sign = s.side[l] if ways == 1 else 1.0
    moves = s.phase[l] != FULL_CONTACT
    sample.theta, sample.theta_dot = (sign * x, sign * p) if moves else (0.0, 0.0)
    sample.theta_ddot, sample.phase = sign * motion.a, s.phase[l]
    sample.azimuth, sample.turning, sample.turning_rate = 0.0, 0.0, 0.0
    if ways == 2 and moves and x > 0.0:
        across = motion.bend_y * cosine - motion.bend_x * sine
        turning = q / x
        sample.azimuth, sample.turning = math.atan2(sine, cosine), turning
        sample.turning_rate = (across - 2.0 * p * turning) / x
    sample.push_x = s.drive[0, l] + s.tied[l] * cosine
    sample.push_y = drive_y + s.tied[l] * sine
    sample.energy_input, sample.energy_damped = s.energy_input[l], s.energy_damped[l]
    sample.energy_lost, sample.bed_energy = s.energy_lost[l], s.bed_energy[l]
    beam = beam_at(s, l, tilt, rate)
    for axis in range(ways):
        for i in range(n):
            u, du = beam[axis], beam[2 + axis]
            for r in range(n):
                u += systems[axis].phi[r, i] * s.looked_at[2 * axis, r]
                du += systems[axis].phi[r, i] * s.looked_at[2 * axis + 1, r]
            output.floors[row, 0, n * axis + i], output.floors[row, 1, n * axis + i] = u, du
