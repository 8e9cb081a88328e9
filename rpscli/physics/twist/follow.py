"""A history of a slab that turns: step, events, samples."""

from __future__ import annotations

import math

from rpscli.physics.compile import compiled
from rpscli.physics.laws.place import length
from rpscli.physics.state import (
    AT_REST,
    FAILED_NOT_FINITE,
    FAILED_STEP_TOO_SMALL,
    FAILED_TOO_MANY_STEPS,
    OVERTURNED_ROCKING,
    OVERTURNED_ROLLING,
    RUNNING,
    SURVIVED,
    Floats,
    Record,
)
from rpscli.physics.twist.passes import (
    HARDLY,
    approach,
    pass_together,
    share_of_pass,
)
from rpscli.physics.twist.resting import load_share, spare_torque
from rpscli.physics.twist.slab import energy_of, kinetic
from rpscli.physics.twist.step import renew, take_step

LAST = 1e-12
"""Of the sampling interval: nothing is left of it."""

ON_BETA = 1e-12
"""Of 2 R: so near to the end of its arc a column is at it."""

NEAREST = 1e-9
"""Of 2 R: so far beyond where it is nearest to upright a head may be taken as there."""

MOST_TRIES = 60
SHORTEST = 1e-13
"""Of the sampling interval."""

LEAST = 1e-300


@compiled
def follow_twist(
    slab: Record,
    columns: Record,
    modes: Record,
    dampers: Record,
    offset: Floats,
    ground: Floats,
    samples: Floats,
) -> None:
    """Follow a slab from its present state under ground accelerations (2, npts)."""
    s = slab[0]
    for i in range(columns.shape[0]):
        c = columns[i]
        c.rolls = 1.0 if c.beyond_beta > 0.0 else 0.0
    renew(s, columns, modes, dampers, offset)
    choose_phases(s, columns)
    s.h_limit = s.h_most
    store_sample(s, columns, modes, dampers, offset, samples)
    observe(s, columns)
    while s.outcome == RUNNING:
        set_ground(s, ground)
        while s.outcome == RUNNING and s.dt - s.time > LAST * s.dt:
            go_on(s, columns, modes, dampers, offset)
        s.interval += 1
        s.time = 0.0
        if s.outcome == RUNNING and s.interval >= s.intervals:
            s.outcome = SURVIVED
        if s.outcome == RUNNING and s.until_rest > 0 and s.interval >= s.npts - 1:
            s.outcome = AT_REST if is_over(s, modes) else RUNNING
        set_ground(s, ground)
        store_sample(s, columns, modes, dampers, offset, samples)


@compiled
def choose_phases(s: Record, columns: Record) -> None:
    """Begin on the arcs or beyond them."""
    for i in range(columns.shape[0]):
        c = columns[i]
        c.rolls = 1.0 if c.beyond_beta > 0.0 and c.away < c.beyond_beta else 0.0


@compiled
def set_ground(s: Record, ground: Floats) -> None:
    """The ground's acceleration over the interval; none behind the record."""
    i = s.interval
    for axis in range(2):
        before = ground[axis, i] if i < s.npts else 0.0
        behind = ground[axis, i + 1] if i + 1 < s.npts else 0.0
        if i + 1 == s.npts:
            before = 0.0
        s.a_g[axis] = before
        s.a_g_slope[axis] = (behind - before) / s.dt


@compiled
def longest_step(s: Record, columns: Record) -> float:
    """The longest step that the distances from upright allow."""
    longest = min(s.h_most, s.h_limit)
    if s.stands > 0:
        return float(s.h_most)
    for i in range(columns.shape[0]):
        c = columns[i]
        speed = length(c.w_x, c.w_y)
        near = length(c.away, s.bowl)
        pulled = length(s.bend[0], s.bend[1]) + s.radius * abs(s.bend[2])
        turns = 2.0 * math.sqrt(near / (pulled + s.gravity * c.tan_a))
        longest = min(longest, s.arc * min(near / (speed + 1e-300), turns))
    return float(longest)


@compiled
def go_on(
    s: Record, columns: Record, modes: Record, dampers: Record, offset: Floats
) -> None:
    """Take one step, or a part of one to an event."""
    renew(s, columns, modes, dampers, offset)
    left = s.dt - s.time
    longest = longest_step(s, columns)
    s.h = left / max(math.ceil(left / longest - 1e-9), 1.0)
    take_step(s, columns, modes, dampers, offset)
    if not math.isfinite(s.new_way[0] + s.new_way[1] + s.new_way[2] + s.error):
        s.outcome = FAILED_NOT_FINITE
        return
    while s.stands == 0 and s.error > 1.0 and s.outcome == RUNNING:
        s.h *= max(0.2, 0.9 * s.error ** (-1.0 / 6.0))
        s.h_limit = s.h
        if s.h < SHORTEST * s.dt:
            s.outcome = FAILED_STEP_TOO_SMALL
            return
        take_step(s, columns, modes, dampers, offset)
    end_on_event(s, columns, modes, dampers, offset)
    accept(s, columns, modes)
    observe(s, columns)
    if s.stands == 0 and passed_nearest(s, columns):
        pass_together(s, columns, modes)
    switch(s, columns, modes, dampers, offset)
    grow = 0.9 * max(s.error, 1e-7) ** (-1.0 / 6.0)
    s.h_limit = max(s.h_limit, s.h) * min(max(grow, 1.0), 2.0)
    s.steps += 1
    if s.steps > s.most_steps and s.outcome == RUNNING:
        s.outcome = FAILED_TOO_MANY_STEPS


@compiled
def left_of_phase(s: Record, columns: Record) -> float:
    """Least that is left of a phase of motion at the end of the step: of full contact the
    torque it holds over that without a push, of columns the way to the end of their arcs,
    or to where they are nearest to upright, over 2 R; below zero it has ended.
    """
    if s.stands > 0:
        Q_x, Q_y, T = pushes(s, s.time + s.h)
        return max(float(spare_torque(s, columns, Q_x, Q_y, T) / s.holds), -1.0)
    least = 1.0
    for i in range(columns.shape[0]):
        c = columns[i]
        if c.beyond_beta > 0.0:
            inside = c.beyond_beta - length(c.u_x, c.u_y)
            inside = inside if c.rolls > 0.0 else -inside
            least = min(least, inside / c.diameter)
        if c.leaving < 0.0 and share_of_pass(s, c) > HARDLY:
            least = min(least, -approach(s, c) / c.diameter * (ON_BETA / NEAREST))
    return least


@compiled
def pushes(s: Record, time: float) -> tuple[float, float, float]:
    """Push on the slab in full contact and its torque [N; N m], of V and the ground."""
    a_x = s.a_g[0] + time * s.a_g_slope[0]
    a_y = s.a_g[1] + time * s.a_g_slope[1]
    return s.V[0] - s.pushed * a_x, s.V[1] - s.pushed * a_y, s.V[2]


@compiled
def end_on_event(
    s: Record, columns: Record, modes: Record, dampers: Record, offset: Floats
) -> None:
    """Shorten a step behind whose end a phase of motion is over, to where it ends."""
    tolerance = ON_BETA
    behind = left_of_phase(s, columns)
    if behind >= -tolerance:
        return
    low = 0.0
    high = s.h
    at_low = -behind  # not known: the middle first
    at_high = behind
    taken = high
    tries = 0
    while behind < -tolerance and high - low > SHORTEST * s.dt and tries < MOST_TRIES:
        s.h = low + (high - low) * at_low / (at_low - at_high)
        taken = s.h
        take_step(s, columns, modes, dampers, offset)
        found = left_of_phase(s, columns)
        if found < 0.0:  # regula falsi, with Illinois' halves
            at_low = 0.5 * at_low if tries > 0 else at_low
            high = s.h
            at_high = found
            behind = found
        else:
            at_high = 0.5 * at_high if tries > 0 else at_high
            low = s.h
            at_low = max(found, LEAST)
        tries += 1
    if taken != high:
        s.h = high
        take_step(s, columns, modes, dampers, offset)


@compiled
def passed_nearest(s: Record, columns: Record) -> bool:
    """True if the step ends just behind where a head was nearest to upright."""
    for i in range(columns.shape[0]):
        c = columns[i]
        near = 0.0 <= approach(s, c) <= 2.0 * NEAREST * c.diameter
        if near and c.leaving < 0.0 and share_of_pass(s, c) > HARDLY:
            return True
    return False


@compiled
def accept(s: Record, columns: Record, modes: Record) -> None:
    """Make the end of the step the present state."""
    s.time += s.h
    for k in range(4):
        s.flowed[k] += s.h * s.power[k]
    for axis in range(3):
        s.way[axis] = s.new_way[axis]
        s.rate[axis] = s.new_rate[axis]
        s.bend[axis] = s.new_bend[axis]
    for r in range(modes.shape[0]):
        m = modes[r]
        m.q = m.new_q
        m.dq = m.new_dq


@compiled
def observe(s: Record, columns: Record) -> None:
    """Raise the largest demands by the end of the step, and by peaks within it."""
    now = s.interval * s.dt + s.time
    s.max_twist = max(s.max_twist, abs(s.way[2]))
    far = length(s.way[0], s.way[1])
    left = s.way[0] * s.rate[0] + s.way[1] * s.rate[1]
    if s.leaving > 0.0 and left < 0.0 and s.h > 0.0:
        far = max(far, peak_within(s.away, s.leaving, far, left, s.h))
    s.max_u = max(s.max_u, far)
    s.max_shear = max(s.max_shear, length(s.V[0], s.V[1]))
    for i in range(columns.shape[0]):
        c = columns[i]
        away = length(c.u_x, c.u_y)
        leaving = c.u_x * c.w_x + c.u_y * c.w_y
        c.passes += 1 if (c.leaving < 0.0) & (leaving > 0.0) & (c.passed == 0.0) else 0
        c.passed = 0.0 if away > c.passed else c.passed
        if c.leaving > 0.0 and leaving < 0.0 and s.h > 0.0:
            away = max(away, peak_within(c.away, c.leaving, away, leaving, s.h))
        if away > c.max_u:
            c.max_u = away
            c.max_time = now
        c.max_tilt = max(c.max_tilt, c.tilt)
        c.least_load = min(c.least_load, c.load)
        c.most_load = max(c.most_load, c.load)
        if c.tilt >= c.theta_limit:
            s.outcome = OVERTURNED_ROLLING if c.rolls > 0.0 else OVERTURNED_ROCKING


@compiled
def peak_within(away: float, leaving: float, end: float, left: float, h: float) -> float:
    """Largest |u| within a step, of the cubic through |u|^2 and its rates at both ends."""
    y_0 = away * away
    y_1 = end * end
    d_0 = 2.0 * leaving * h
    d_1 = 2.0 * left * h
    c_2 = 3.0 * (y_1 - y_0) - 2.0 * d_0 - d_1
    c_3 = 2.0 * (y_0 - y_1) + d_0 + d_1
    root = math.sqrt(max(c_2 * c_2 - 3.0 * c_3 * d_0, 0.0))
    z = d_0 / (root - c_2) if root > c_2 else 0.5
    z = min(max(z, 0.0), 1.0)
    return math.sqrt(max(y_0 + z * (d_0 + z * (c_2 + z * c_3)), 0.0))


@compiled
def switch(
    s: Record, columns: Record, modes: Record, dampers: Record, offset: Floats
) -> None:
    """Change the phase of motion where one has ended."""
    if s.stands > 0:
        Q_x, Q_y, T = pushes(s, s.time)
        if spare_torque(s, columns, Q_x, Q_y, T) < 0.0:
            begin_to_move(s, columns, modes, dampers, offset)
        return
    for i in range(columns.shape[0]):
        c = columns[i]
        outside = (length(c.u_x, c.u_y) - c.beyond_beta) / c.diameter
        leaves = c.u_x * c.w_x + c.u_y * c.w_y
        if c.beyond_beta > 0.0 and abs(outside) <= 2.0 * ON_BETA:
            c.rolls = 1.0 if leaves < 0.0 else 0.0
    if comes_to_rest(s, columns):
        stand(s, columns, modes, dampers, offset)


BEGINS = 20.0
"""Of U_c: so far from upright motion begins, at rest. From the middle of the bowls the
whole push would set the slab in motion before they hold it."""


@compiled
def begin_to_move(
    s: Record, columns: Record, modes: Record, dampers: Record, offset: Floats
) -> None:
    """Leave full contact along the push, or by a turn where the torque is more."""
    Q_x, Q_y, T = pushes(s, s.time)
    Q = length(Q_x, Q_y)
    renew(s, columns, modes, dampers, offset)
    before = energy_of(s, columns, modes)
    far = BEGINS * s.bowl
    if Q * s.radius >= abs(T):
        s.way[0] = far * Q_x / Q
        s.way[1] = far * Q_y / Q
    else:
        s.way[2] = math.copysign(far / s.radius, T)
    for r in range(modes.shape[0]):
        for axis in range(3):
            modes[r].q -= modes[r].Gamma[axis] * s.way[axis]
    s.stands = 0
    s.h_limit = s.h_most
    renew(s, columns, modes, dampers, offset)
    s.flowed[0] += energy_of(s, columns, modes) - before


@compiled
def comes_to_rest(s: Record, columns: Record) -> bool:
    """True if no column can get farther than `near` from upright under the present push.

    Within it the columns' weights rise by W tan(alpha) |u| at least, of which the push
    takes no more than its share; the bowls are lower by U_c each.
    """
    if s.holds == 0.0:
        return False
    least = math.inf
    total = 0.0
    for i in range(columns.shape[0]):
        c = columns[i]
        if length(c.u_x, c.u_y) > s.near:
            return False
        least = min(least, c.weight * c.tan_a)
        total += c.weight * c.tan_a
    Q_x, Q_y, T = pushes(s, s.time)
    if spare_torque(s, columns, Q_x, Q_y, T) <= 0.0:
        return False
    share = load_share(s, columns, Q_x, Q_y, T)
    energy = kinetic(s)
    for i in range(columns.shape[0]):
        energy += columns[i].weight * columns[i].lift
    energy -= Q_x * s.way[0] + Q_y * s.way[1] + T * s.way[2]
    return bool(energy < (1.0 - share) * least * s.near - total * s.bowl)


@compiled
def stand(
    s: Record, columns: Record, modes: Record, dampers: Record, offset: Floats
) -> None:
    """Full contact from now on: the slab stops, floors keep their velocities."""
    renew(s, columns, modes, dampers, offset)
    before = energy_of(s, columns, modes)
    for r in range(modes.shape[0]):
        m = modes[r]
        for axis in range(3):
            m.q += m.Gamma[axis] * s.way[axis]
            m.dq += m.Gamma[axis] * s.rate[axis]
    for axis in range(3):
        s.way[axis] = 0.0
        s.rate[axis] = 0.0
        s.bend[axis] = 0.0
    s.stands = 1
    renew(s, columns, modes, dampers, offset)
    s.lost += before - energy_of(s, columns, modes)


@compiled
def is_over(s: Record, modes: Record) -> bool:
    """True if the vibrating building can never again push the slab out of full contact.

    Each mode moves no faster than its present energy allows; pushes are bounded by its
    share of both resultants together.
    """
    if s.stands == 0:
        return False
    push = 0.0
    torque = 0.0
    for r in range(modes.shape[0]):
        m = modes[r]
        fast = math.sqrt(m.dq * m.dq + m.omega2 * m.q * m.q)
        force = (math.sqrt(m.omega2) + m.two_xi_omega) * fast
        push += length(m.Gamma[0], m.Gamma[1]) * force
        torque += abs(m.Gamma[2]) * force
    return bool(push / s.held + torque / s.holds < 1.0)


@compiled
def store_sample(
    s: Record,
    columns: Record,
    modes: Record,
    dampers: Record,
    offset: Floats,
    samples: Floats,
) -> None:
    """Keep the present motion, energies and loads, where there is room."""
    if s.interval >= samples.shape[0]:
        return
    s.h = 0.0
    renew(s, columns, modes, dampers, offset)
    row = s.interval
    for axis in range(3):
        samples[row, axis] = s.way[axis]
        samples[row, 3 + axis] = s.rate[axis]
        samples[row, 12 + axis] = s.V[axis]
    samples[row, 6] = energy_of(s, columns, modes)
    for k in range(4):
        samples[row, 7 + k] = s.flowed[k]
    samples[row, 11] = s.lost
    least = math.inf
    most = 0.0
    for i in range(columns.shape[0]):
        c = columns[i]
        least = min(least, c.load / c.weight)
        most = max(most, c.load / c.weight)
    samples[row, 15] = least
    samples[row, 16] = most
    samples[row, 17] = s.lost_in_passes
