"""What the end of a step demands of floors and contacts, in all lanes together.

A storey shear is a sum over modes, sum_r s_ir q_r, so that all of them cost n^2 products a sample,
more than the motion itself. By Cauchy and Schwarz's inequality what it changes by is bounded:

    (sum_r s_ir dq_r)^2 <= (sum_r s_ir^2/g_r) (sum_r g_r dq_r^2)

whatever the weights g_r > 0. With dq what has changed since all storeys were last looked at, no
shear is raised while the last sum, which costs n, stays below the least

    (largest shear so far of storey i - its shear when last looked at)^2/(sum_r s_ir^2/g_r).

The same holds for floor accelerations, sums over the modal forces. Which weights is said in
`rpscli.analyses.kernels.systems`. Within a step of length h a motion leaves the chord between its
ends by h/8 of what its velocity changes by, if it is a cubic; with a margin for what it is more,
the same sum over that change bounds the whole step. Only where that bound is passed the step is
looked at, at its end, and within where what is then known does not exclude it. The forces of
contacts are compared with the largest so far at the ends of all steps, and looked at likewise.
"""

from __future__ import annotations

import math

from rpscli.physics.core.compile import by_record, compiled, inlined
from rpscli.physics.core.records import ORDER, Floats, Record
from rpscli.physics.core.series import (
    integral,
    middle_of,
    peak,
    sine_cosine,
    slope,
    turning_value,
    value,
)
from rpscli.physics.planar.bed.terms import upwards_on_bed
from rpscli.physics.planar.devices.forces import set_devices
from rpscli.physics.planar.equation_of_motion import (
    Measures,
    cap_beam_acceleration,
    contact_arm,
    contact_forces,
    contact_height,
    contact_measures,
    phase_constants,
    rotation_terms,
)

WITHIN = 1.5
"""Room for what a motion within a step is more than a cubic."""

SURELY = 1.0 - 1e-9
"""Room for the rounding of either side."""


@compiled
def written(x: float) -> float:
    """The same number, to be written wherever it came from (but -0 becomes 0).

    What is either new or what stood there before invites the compiler to write only the new ones,
    lane by lane; processors take ten times as long for that as for writing all.
    """
    return x + 0.0


@inlined
def add_mode(s: Record, r: int, l: int) -> None:
    """Add what mode r has changed by since the last look, and its velocity in the step."""
    q, force = s.next_q[r, l] - s.seen_q[r, l], s.modal_force[r, l] - s.seen_force[r, l]
    lost = s.dq[0, r, l] - s.next_dq[r, l]
    s.shear_bound[l] += s.shear_weight[r, l] * (q * q)
    s.acceleration_bound[l] += s.acceleration_weight[r, l] * (force * force)
    s.shear_bend[l] += s.shear_weight[r, l] * (lost * lost)


@inlined
def floors_may_rise(s: Record, l: int) -> bool:
    """Whether those sums leave room for a larger demand, see this module."""
    bulge = (WITHIN / 8.0 * s.step[l]) ** 2 * s.shear_bend[l]
    shear = reach(max(s.shear_before[l], s.shear_bound[l]), bulge)
    bulge *= s.bend_ratio[l]
    acceleration = reach(max(s.acceleration_before[l], s.acceleration_bound[l]), bulge)
    return bool((shear > s.shear_room[l]) | (acceleration > s.acceleration_room[l]))


@inlined
def reach(one: float, other: float) -> float:
    """The square of a sum, from the squares."""
    return one + other + 2.0 * math.sqrt(one * other)


@compiled
def observe_ends(s: Record) -> None:
    """Raise the largest tilt by those at the ends of accepted steps.

    Says in `demands_rise` and `contacts_rise` where the demands of floors and contacts may be
    raised, at the end or within.
    """
    lanes = s.lanes
    for l in range(lanes):
        s.shear_bound[l], s.acceleration_bound[l] = 0.0, 0.0
        s.shear_bend[l] = 0.0
    for r in range(s.n):
        for l in range(lanes):
            add_mode(s, r, l)
    for l in range(lanes):
        s.demands_rise[l] = 1.0 if floors_may_rise(s, l) else 0.0
    for l in range(lanes):
        s.contacts_rise[l] = 1.0 if contacts_may_rise(s, l) else 0.0
    for l in range(lanes):
        theta = s.next_theta[l]
        higher = (s.accepted[l] > s.peak_inside[l]) & (theta > s.max_theta[l])
        time = s.interval_start[l] + (s.time[l] + s.step[l])
        s.max_theta[l] = written(theta if higher else s.max_theta[l])
        s.max_theta_time[l] = written(time if higher else s.max_theta_time[l])


@inlined
def contacts_may_rise(s: Record, l: int) -> bool:
    """Whether forces of contacts may pass the extremes so far; writes those at the end."""
    across, upwards = cap_beam_acceleration(
        s.side[l],
        s.diameter[l],
        s.phase_c[l],
        s.next_B[l],
        s.next_C[l],
        s.next_theta_dot[l],
        s.next_theta_ddot[l],
    )
    upwards = upwards_on_bed(
        s, l, s.next_theta[l], upwards, s.next_theta_dot[l], s.next_theta_ddot[l]
    )
    beam, floors, columns = s.cap_beam_mass[l], s.floors_mass[l], s.columns_mass[l]
    shear_top, shear_bottom, top, bottom = contact_forces(
        beam,
        floors,
        columns,
        across,
        upwards,
        s.next_V[l] + s.next_push[l],
        s.next_a_g[l],
        s.next_g_up[l],
        s.next_pull[l],
    )
    shear_top, shear_bottom = abs(shear_top), abs(shear_bottom)
    upper, lower = (beam + floors) * s.gravity[l], (beam + floors + columns) * s.gravity[l]
    rises = (shear_top > s.friction_top[l] * top) | (shear_bottom > s.friction_bottom[l] * bottom)
    rises |= (top < s.normal_top[l] * upper) | (top > s.heavy_top[l] * upper)
    rises |= shear_top > s.shear_top[l]
    # Within the step x'' leaves its chord by (3 d_3/4 + 3 d_4/2 + ...)/h at most.
    d, h = s.dtheta_terms, s.step[l]
    leaves = 0.75 * abs(d[3, l]) + 1.5 * abs(d[4, l]) + 2.2 * abs(d[5, l])
    bend = WITHIN * s.diameter[l] * max(abs(s.B[l]), abs(s.next_B[l])) * leaves / s.gravity[l]
    rises |= min(s.light[l], bottom) * h - lower * bend < s.normal_bottom[l] * lower * h
    rises |= max(s.light[l], bottom) * h + lower * bend > s.heavy_bottom[l] * lower * h
    rises |= max(s.drag[l], shear_bottom) * (h + bend) > s.shear_bottom[l] * h
    s.next_light[l], s.next_drag[l] = bottom, shear_bottom
    return bool(rises)


@compiled
def observe_start(s: Record, l: int) -> None:
    """Look at what begins anew, after an event or a sudden change of the ground."""
    forces = contacts_at_start(s, l)
    raise_contacts(s, l, forces, forces)
    s.light[l], s.drag[l] = forces[3] * weight(s, l), forces[5]
    shear, acceleration = 0.0, 0.0
    for r in range(s.n):
        q, force = s.q[r, l] - s.seen_q[r, l], s.modal_force[r, l] - s.seen_force[r, l]
        shear += s.shear_weight[r, l] * (q * q)
        acceleration += s.acceleration_weight[r, l] * (force * force)
    s.shear_before[l], s.acceleration_before[l] = shear, acceleration


@compiled
def weight(s: Record, l: int) -> float:
    """Of all that the ground carries [N]."""
    return float((s.cap_beam_mass[l] + s.floors_mass[l] + s.columns_mass[l]) * s.gravity[l])


@compiled
def contacts_of(
    s: Record,
    l: int,
    theta: float,
    theta_dot: float,
    theta_ddot: float,
    B: float,
    C: float,
    V: float,
    a_g: float,
    g_up: float,
) -> Measures:
    """Measures of contacts in a motion, with what devices push and pull."""
    across, upwards = cap_beam_acceleration(
        s.side[l], s.diameter[l], s.phase_c[l], B, C, theta_dot, theta_ddot
    )
    upwards = upwards_on_bed(s, l, theta, upwards, theta_dot, theta_ddot)
    return contact_measures(
        s.cap_beam_mass[l],
        s.floors_mass[l],
        s.columns_mass[l],
        across,
        upwards,
        V + s.next_push[l],
        a_g,
        g_up,
        s.gravity[l],
        s.next_pull[l],
    )


@compiled
def contacts_at_start(s: Record, l: int) -> Measures:
    """Measures of contacts at the start of the step."""
    if s.devices[l] > 0:
        set_devices(s, l, s.theta[l], s.theta_dot[l])
    a_g = s.a_g[l] + s.a_g_slope[l] * s.time[l]
    g_up = s.g_up[l] + s.g_up_slope[l] * s.time[l]
    B, C, V = s.B[l], s.C[l], s.V[l]
    theta, rate = s.theta[l], s.theta_dot[l]
    return contacts_of(s, l, theta, rate, s.theta_ddot[l], B, C, V, a_g, g_up)


@compiled
def contacts_within(s: Record, l: int, t: float) -> Measures:
    """Measures of contacts a fraction t into the step, from its Taylor terms."""
    terms, phase = rotation_terms(s, l), phase_constants(s, l)
    # At an impact the tilt is zero but for rounding; below zero tendons would pull the other way.
    theta = max(s.theta[l] + s.step[l] * integral(terms, t), 0.0)
    theta_dot = value(terms, t)
    sine, cosine = sine_cosine(theta)
    B, C = contact_arm(phase, cosine, sine), contact_height(phase, cosine, sine)
    action = 0.0
    for m in range(ORDER, -1, -1):
        action = action * t + s.action_terms[m, l]
    time = s.time[l] + t * s.step[l]
    a_g, g_up = s.a_g[l] + s.a_g_slope[l] * time, s.g_up[l] + s.g_up_slope[l] * time
    V = (a_g * s.ground_over_R[l] - s.side[l] * action) / s.shear_factor[l]
    if s.devices[l] > 0:
        set_devices(s, l, theta, theta_dot)
    acceleration = slope(terms, t) / s.step[l]
    return contacts_of(s, l, theta, theta_dot, acceleration, B, C, V, a_g, g_up)


@by_record
def raise_contacts_within(s: Record, l: int, fraction: float) -> None:
    """Raise the demands of contacts by those of the first part of the step, if any may rise.

    What bounds the whole step bounds its part.
    """
    if s.step[l] * fraction <= 0.0 or s.contacts_rise[l] == 0.0:
        return
    raise_by(
        s,
        l,
        contacts_at_start(s, l),
        contacts_within(s, l, 0.5 * fraction),
        contacts_within(s, l, fraction),
    )


@compiled
def raise_by(s: Record, l: int, start: Measures, middle: Measures, end: Measures) -> None:
    """Raise the demands of contacts by those of a step, of which three instants are known."""
    turned = (
        turning_value(start[0], middle[0], end[0]),
        turning_value(start[1], middle[1], end[1]),
        turning_value(start[2], middle[2], end[2]),
        turning_value(start[3], middle[3], end[3]),
        turning_value(start[4], middle[4], end[4]),
        turning_value(start[5], middle[5], end[5]),
    )
    raise_contacts(s, l, start, end)
    raise_contacts(s, l, turned, turned)


@compiled
def raise_contacts(s: Record, l: int, one: Measures, other: Measures) -> None:
    """Raise the demands of contacts by those at two instants."""
    s.friction_top[l] = max(s.friction_top[l], abs(one[0]), abs(other[0]))
    s.friction_bottom[l] = max(s.friction_bottom[l], abs(one[1]), abs(other[1]))
    s.normal_top[l] = min(s.normal_top[l], one[2], other[2])
    s.heavy_top[l] = max(s.heavy_top[l], one[2], other[2])
    s.normal_bottom[l] = min(s.normal_bottom[l], one[3], other[3])
    s.heavy_bottom[l] = max(s.heavy_bottom[l], one[3], other[3])
    s.shear_top[l] = max(s.shear_top[l], abs(one[4]), abs(other[4]))
    s.shear_bottom[l] = max(s.shear_bottom[l], abs(one[5]), abs(other[5]))


@by_record
def observe_end(s: Record, l: int, system: Record) -> None:
    """Raise the demands of a lane's floors by those of a step that was cut short by an event."""
    if s.demands_rise[l] == 0.0:  # in the whole step
        return
    s.shear_bound[l], s.acceleration_bound[l], s.shear_bend[l] = 0.0, 0.0, 0.0
    for r in range(s.n):
        q, dq = s.next_q[r, l], s.next_dq[r, l]
        s.modal_force[r, l] = s.omega2[r, l] * q + s.two_xi_omega[r, l] * dq
        add_mode(s, r, l)
    if floors_may_rise(s, l):
        raise_floors(s, l, system)


@by_record
def raise_floors(s: Record, l: int, system: Record) -> None:
    """Raise the demands of a lane's storeys and floors by those of the step just taken.

    By those at its end; and by those within, where they bulge enough above both ends.
    """
    shears, accelerations = s.looked_at[0], s.looked_at[1]
    look_at_end(s, l, system, 0, shears, accelerations)
    moved, shaken = math.sqrt(s.shear_before[l]), math.sqrt(s.acceleration_before[l])
    bulge = WITHIN / 8.0 * s.step[l] * math.sqrt(s.shear_bend[l])
    other_bulge = bulge * math.sqrt(s.bend_ratio[l])
    most, last, of = s.storey_shear[l], s.last_shear[l], system.shear_bound_of
    within, s.shear_room[l] = raise_by_end(most, last, shears, of, moved, bulge, s.n)
    most, last, of = s.floor_acceleration[l], s.last_acceleration[l], system.acceleration_bound_of
    other, s.acceleration_room[l] = raise_by_end(
        most, last, accelerations, of, shaken, other_bulge, s.n
    )
    s.shear_bound[l], s.acceleration_bound[l] = 0.0, 0.0
    if s.step[l] > 0.0 and within + other > 0:
        raise_floors_within(s, l, system)


@compiled
def look_at_end(
    s: Record, l: int, system: Record, first: int, shears: Floats, accelerations: Floats
) -> None:
    """Write what the modes from the first on, as they are now seen, make of storeys and floors."""
    width = whole_vectors(system.n)
    for i in range(width):
        shears[i], accelerations[i] = 0.0, 0.0
    for r in range(system.n):
        q, force = s.next_q[first + r, l], s.modal_force[first + r, l]
        s.seen_q[first + r, l], s.seen_force[first + r, l] = q, force
        for i in range(width):
            shears[i] += system.storey_shear_of[r, i] * q
            accelerations[i] += system.phi[r, i] * force


@compiled
def raise_by_end(
    largest: Floats,
    last: Floats,
    now: Floats,
    bound_of: Floats,
    moved: float,
    bulge: float,
    storeys: int,
) -> tuple[int, float]:
    """Raise demands of all floors by what they are now, and note it as the last that was seen.

    Returns 1 if more may have been between, and the sum with which none rises from now on.
    """
    within, room = 0, math.inf
    for i in range(storeys):
        most, here, share = largest[i], abs(now[i]), bound_of[i]
        left, before = share * (most - here), share * (most - last[i]) - moved
        within |= 1 if min(left, before) < bulge else 0
        largest[i], last[i] = max(most, here), here
        room = min(room, max(left, 0.0))
    return within, SURELY * (room * room)


@compiled
def whole_vectors(storeys: int) -> int:
    """So many storeys that vector instructions do them all; those that are not there are zeros."""
    return 8 * ((storeys + 7) // 8)


@compiled
def raise_floors_within(s: Record, l: int, system: Record) -> None:
    """The same by those at the start, in the middle, at the end, and of a parabola through them."""
    rows = s.looked_at
    fill_within(s, l, system, 0, rows)
    for i in range(s.n):
        shear = peak(rows[0, i], rows[1, i], rows[2, i])
        acceleration = peak(rows[3, i], rows[4, i], rows[5, i])
        s.storey_shear[l, i] = max(s.storey_shear[l, i], shear)
        s.floor_acceleration[l, i] = max(s.floor_acceleration[l, i], acceleration)


@compiled
def fill_within(s: Record, l: int, system: Record, first: int, rows: Floats) -> None:
    """Write shears and accelerations of modes from the first on at start, middle and end."""
    h, width = s.step[l], whole_vectors(system.n)
    rate = 1.5 / h
    for k in range(6):
        for i in range(width):
            rows[k, i] = 0.0
    for of in range(system.n):
        r = first + of
        q0, v0, q1, v1 = s.q[r, l], s.dq[0, r, l], s.next_q[r, l], s.next_dq[r, l]
        q, v = middle_of(q0, q1, h * v0, h * v1), rate * (q1 - q0) - 0.25 * (v0 + v1)
        omega2, damping = s.omega2[r, l], s.two_xi_omega[r, l]
        f0, f, f1 = omega2 * q0 + damping * v0, omega2 * q + damping * v, omega2 * q1 + damping * v1
        for i in range(width):
            shear, phi = system.storey_shear_of[of, i], system.phi[of, i]
            rows[0, i] += shear * q0
            rows[1, i] += shear * q
            rows[2, i] += shear * q1
            rows[3, i] += phi * f0
            rows[4, i] += phi * f
            rows[5, i] += phi * f1


@by_record
def set_below_all_maxima(s: Record, l: int, system: Record) -> None:
    """Note which sums over all modes, from rest, raise no storey's shear and no acceleration."""
    shear, acceleration = math.inf, math.inf
    for i in range(s.n):
        shear = min(shear, s.storey_shear[l, i] * system.shear_bound_of[i])
        largest = s.floor_acceleration[l, i]
        acceleration = min(acceleration, largest * system.acceleration_bound_of[i])
    s.shear_below_all_maxima[l] = SURELY * (shear * shear)
    s.acceleration_below_all_maxima[l] = SURELY * (acceleration * acceleration)
