"""What the end of a step demands of floors and contacts, in all lanes together.

A storey shear is a sum over modes, sum_r s_ir q_r, so that all of them cost n^2 products a sample,
more than the motion itself. By Cauchy and Schwarz's inequality

    (sum_r s_ir q_r)^2 <= (sum_r s_ir^2/g_r) (sum_r g_r q_r^2)

whatever the weights g_r > 0: while the last sum, which costs n, stays below the least

    (largest shear so far of storey i)^2/(sum_r s_ir^2/g_r),

no storey's shear is raised. The same holds for floor accelerations, sums over the modal forces.
`rpscli.analyses.kernels.systems` says which weights. Within a step of length h a motion leaves the
chord between its ends by h/8 of what its velocity changes by, if it is a cubic; with a margin for
what it is more, and (a + b)^2 <= ENDS a^2 + b^2 ENDS/(ENDS - 1), the same sum over that change
bounds the whole step. Only where that bound is passed the step is looked at, within and at its end.
"""

from __future__ import annotations

import math

from rpscli.physics.core.compile import compiled
from rpscli.physics.core.records import ORDER, Record
from rpscli.physics.core.series import (
    integral,
    middle_of,
    peak,
    sine_cosine,
    slope,
    turning_value,
    value,
)
from rpscli.physics.planar.devices.forces import set_devices
from rpscli.physics.planar.equation_of_motion import (
    Measures,
    cap_beam_acceleration,
    contact_arm,
    contact_height,
    contact_measures,
    phase_constants,
    rotation_terms,
)

WITHIN = 1.5
"""Room for what a motion within a step is more than a cubic."""

ENDS = 1.05
BULGE = (WITHIN / 8.0) ** 2 * ENDS / (ENDS - 1.0)
"""See above: what multiplies the sums over the motion at the ends, and over its change."""

SURELY = 1.0 - 1e-9
"""Room for the rounding of either side."""


@compiled
def written(x: float) -> float:
    """The same number, to be written wherever it came from (but -0 becomes 0).

    What is either new or what stood there before invites the compiler to write only the new ones,
    lane by lane; processors take ten times as long for that as for writing all.
    """
    return x + 0.0


@compiled
def observe_ends(s: Record) -> None:
    """Raise the demands of contacts and the largest tilt by those at the ends of accepted steps.

    Says in `demands_rise` and `contacts_rise` where those of floors, and those of contacts within
    the step, may be raised too.
    """
    lanes = s.lanes
    for l in range(lanes):
        s.shear_bound[l], s.acceleration_bound[l] = 0.0, 0.0
        s.shear_bend[l] = 0.0
    for r in range(s.n):
        for l in range(lanes):
            q, force = s.next_q[r, l], s.modal_force[r, l]
            lost = s.dq[0, r, l] - s.next_dq[r, l]
            s.shear_bound[l] += s.shear_weight[r, l] * (q * q)
            s.acceleration_bound[l] += s.acceleration_weight[r, l] * (force * force)
            s.shear_bend[l] += s.shear_weight[r, l] * (lost * lost)
    for l in range(lanes):
        bulge = BULGE * s.step[l] * s.step[l] * s.shear_bend[l]
        shear = ENDS * max(s.shear_before[l], s.shear_bound[l]) + bulge
        acceleration = ENDS * max(s.acceleration_before[l], s.acceleration_bound[l])
        acceleration += s.bend_ratio[l] * bulge
        rises = (shear > s.shear_below_all_maxima[l]) | (
            acceleration > s.acceleration_below_all_maxima[l]
        )
        s.demands_rise[l] = s.accepted[l] if rises else 0.0
    for l in range(lanes):
        across, upwards = cap_beam_acceleration(
            s.side[l],
            s.diameter[l],
            s.phase_c[l],
            s.next_B[l],
            s.next_C[l],
            s.next_theta_dot[l],
            s.next_theta_ddot[l],
        )
        raise_contacts(s, l, s.accepted[l], across, upwards, s.next_V[l] + s.next_push[l])
        # Within the step x'' leaves its chord by (3 d_3/4 + 3 d_4/2 + ...)/h at most.
        d, h = s.dtheta_terms, s.step[l]
        leaves = 0.75 * abs(d[3, l]) + 1.5 * abs(d[4, l]) + 2.2 * abs(d[5, l])
        bend = WITHIN * s.diameter[l] * max(abs(s.B[l]), abs(s.next_B[l])) * leaves / s.gravity[l]
        lower = min(s.light[l], s.next_light[l]) * h - bend < s.normal_bottom[l] * h
        higher = max(s.light[l], s.next_light[l]) * h + bend > s.heavy_bottom[l] * h
        dragged = max(s.drag[l], s.next_drag[l]) * (h + bend) > s.shear_bottom[l] * h
        s.contacts_rise[l] = s.accepted[l] if lower | higher | dragged else 0.0
    for l in range(lanes):
        theta = s.next_theta[l]
        higher = (s.accepted[l] > s.peak_inside[l]) & (theta > s.max_theta[l])
        time = s.interval_start[l] + (s.time[l] + s.step[l])
        s.max_theta[l] = written(theta if higher else s.max_theta[l])
        s.max_theta_time[l] = written(time if higher else s.max_theta_time[l])


@compiled
def observe_start(s: Record, l: int) -> None:
    """Look at what begins anew, after an event or a sudden change of the ground."""
    across, upwards = cap_beam_acceleration(
        s.side[l], s.diameter[l], s.phase_c[l], s.B[l], s.C[l], s.theta_dot[l], s.theta_ddot[l]
    )
    raise_contacts(s, l, 1.0, across, upwards, s.V[l] + s.next_push[l])
    s.light[l], s.drag[l] = s.next_light[l], s.next_drag[l]
    shear, acceleration = 0.0, 0.0
    for r in range(s.n):
        q, force = s.q[r, l], s.modal_force[r, l]
        shear += s.shear_weight[r, l] * (q * q)
        acceleration += s.acceleration_weight[r, l] * (force * force)
    s.shear_before[l], s.acceleration_before[l] = shear, acceleration


@compiled
def raise_contacts(s: Record, l: int, look: float, across: float, upwards: float, V: float) -> None:
    """Raise the demands of contacts of a lane, where look > 0."""
    top, bottom, light_top, light_bottom, shear_top, shear_bottom = contact_measures(
        s.cap_beam_mass[l],
        s.floors_mass[l],
        s.columns_mass[l],
        across,
        upwards,
        V,
        s.next_a_g[l],
        s.next_g_up[l],
        s.gravity[l],
        s.next_pull[l],
    )
    s.next_light[l], s.next_drag[l] = light_bottom, shear_bottom
    # What is not looked at counts as nothing; without branches, so that lanes go together.
    seen = look > 0.0
    s.friction_top[l] = written(max(s.friction_top[l], top if seen else 0.0))
    s.friction_bottom[l] = written(max(s.friction_bottom[l], bottom if seen else 0.0))
    s.normal_top[l] = written(min(s.normal_top[l], light_top if seen else math.inf))
    s.normal_bottom[l] = written(min(s.normal_bottom[l], light_bottom if seen else math.inf))
    s.heavy_top[l] = written(max(s.heavy_top[l], light_top if seen else 0.0))
    s.heavy_bottom[l] = written(max(s.heavy_bottom[l], light_bottom if seen else 0.0))
    s.shear_top[l] = written(max(s.shear_top[l], shear_top if seen else 0.0))
    s.shear_bottom[l] = written(max(s.shear_bottom[l], shear_bottom if seen else 0.0))


@compiled
def contacts_within(s: Record, l: int, t: float) -> Measures:
    """Measures of contacts a fraction t into the step, from its Taylor terms."""
    terms, phase = rotation_terms(s, l), phase_constants(s, l)
    # At an impact the tilt is zero but for rounding; below zero tendons would pull the other way.
    theta = max(s.theta[l] + s.step[l] * integral(terms, t), 0.0)
    theta_dot = value(terms, t)
    sine, cosine = sine_cosine(theta)
    B, C = contact_arm(phase, cosine, sine), contact_height(phase, cosine, sine)
    across, upwards = cap_beam_acceleration(
        s.side[l], s.diameter[l], phase.c, B, C, theta_dot, slope(terms, t) / s.step[l]
    )
    action = 0.0
    for m in range(ORDER, -1, -1):
        action = action * t + s.action_terms[m, l]
    time = s.time[l] + t * s.step[l]
    a_g, g_up = s.a_g[l] + s.a_g_slope[l] * time, s.g_up[l] + s.g_up_slope[l] * time
    V = (a_g * s.ground_over_R[l] - s.side[l] * action) / s.shear_factor[l]
    if s.devices[l] > 0:
        set_devices(s, l, theta, theta_dot)
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
def raise_contacts_within(s: Record, l: int, fraction: float) -> None:
    """Raise the demands of contacts by those within the first part of the step, and at its end."""
    if s.step[l] * fraction <= 0.0:
        return
    raise_by(
        s,
        l,
        contacts_within(s, l, 0.0),
        contacts_within(s, l, 0.5 * fraction),
        contacts_within(s, l, fraction),
    )


@compiled
def raise_by(s: Record, l: int, start: Measures, middle: Measures, end: Measures) -> None:
    """Raise the demands of contacts by those of a step, of which three instants are known."""
    s.friction_top[l] = max(s.friction_top[l], peak(start[0], middle[0], end[0]))
    s.friction_bottom[l] = max(s.friction_bottom[l], peak(start[1], middle[1], end[1]))
    turned = turning_value(start[2], middle[2], end[2])
    s.normal_top[l] = min(s.normal_top[l], turned, start[2], end[2])
    s.heavy_top[l] = max(s.heavy_top[l], turned, start[2], end[2])
    turned = turning_value(start[3], middle[3], end[3])
    s.normal_bottom[l] = min(s.normal_bottom[l], turned, start[3], end[3])
    s.heavy_bottom[l] = max(s.heavy_bottom[l], turned, start[3], end[3])
    s.shear_top[l] = max(s.shear_top[l], peak(start[4], middle[4], end[4]))
    s.shear_bottom[l] = max(s.shear_bottom[l], peak(start[5], middle[5], end[5]))


@compiled
def raise_floors(s: Record, l: int, system: Record) -> None:
    """Raise the demands of a lane's storeys and floors by those of the step just taken.

    By those at its end; and by those within, where they bulge enough above both ends.
    """
    shears, accelerations = s.looked_at[0], s.looked_at[1]
    for i in range(s.n):
        shears[i], accelerations[i] = 0.0, 0.0
    for r in range(s.n):
        q = s.next_q[r, l]
        force = s.omega2[r, l] * q + s.two_xi_omega[r, l] * s.next_dq[r, l]
        for i in range(s.n):
            shears[i] += system.storey_shear_of[r, i] * q
            accelerations[i] += system.phi[r, i] * force
    bulge = (WITHIN / 8.0 * s.step[l]) ** 2 * s.shear_bend[l]
    known, within = s.last_look[l] == s.steps[l] - 1.0, 0
    for i in range(s.n):
        shear, acceleration = abs(shears[i]), abs(accelerations[i])
        left = s.storey_shear[l, i] - max(shear, s.last_shear[l, i])
        within |= rises(left, system.shear_bound_of[i], bulge)
        left = s.floor_acceleration[l, i] - max(acceleration, s.last_acceleration[l, i])
        within |= rises(left, system.acceleration_bound_of[i], s.bend_ratio[l] * bulge)
        s.last_shear[l, i], s.last_acceleration[l, i] = shear, acceleration
        s.storey_shear[l, i] = max(s.storey_shear[l, i], shear)
        s.floor_acceleration[l, i] = max(s.floor_acceleration[l, i], acceleration)
    s.last_look[l] = s.steps[l]
    if s.step[l] > 0.0 and (within > 0 or not known):
        raise_floors_within(s, l, system)
    set_below_all_maxima(s, l, system)


@compiled
def rises(left: float, bound: float, bulge: float) -> int:
    """1 if what is left up to the largest demand may be passed, see this module."""
    return 1 if (left < 0.0) | (left * left * bound < bulge) else 0


@compiled
def raise_floors_within(s: Record, l: int, system: Record) -> None:
    """The same by those at the start, in the middle, at the end, and of a parabola through them."""
    h, rows = s.step[l], s.looked_at
    rate = 1.5 / h
    for i in range(s.n):
        for k in range(6):
            rows[k, i] = 0.0
    for r in range(s.n):
        q0, v0, q1, v1 = s.q[r, l], s.dq[0, r, l], s.next_q[r, l], s.next_dq[r, l]
        q, v = middle_of(q0, q1, h * v0, h * v1), rate * (q1 - q0) - 0.25 * (v0 + v1)
        omega2, damping = s.omega2[r, l], s.two_xi_omega[r, l]
        f0, f, f1 = omega2 * q0 + damping * v0, omega2 * q + damping * v, omega2 * q1 + damping * v1
        for i in range(s.n):
            shear, phi = system.storey_shear_of[r, i], system.phi[r, i]
            rows[0, i] += shear * q0
            rows[1, i] += shear * q
            rows[2, i] += shear * q1
            rows[3, i] += phi * f0
            rows[4, i] += phi * f
            rows[5, i] += phi * f1
    for i in range(s.n):
        shear = peak(rows[0, i], rows[1, i], rows[2, i])
        acceleration = peak(rows[3, i], rows[4, i], rows[5, i])
        s.storey_shear[l, i] = max(s.storey_shear[l, i], shear)
        s.floor_acceleration[l, i] = max(s.floor_acceleration[l, i], acceleration)


@compiled
def set_below_all_maxima(s: Record, l: int, system: Record) -> None:
    """Note what raises no storey's shear and no floor's acceleration, see this module."""
    shear, acceleration = math.inf, math.inf
    for i in range(s.n):
        shear = min(shear, below_maximum(s.storey_shear[l, i], system.shear_bound_of[i]))
        largest = s.floor_acceleration[l, i]
        acceleration = min(acceleration, below_maximum(largest, system.acceleration_bound_of[i]))
    s.shear_below_all_maxima[l], s.acceleration_below_all_maxima[l] = shear, acceleration


@compiled
def below_maximum(largest: float, bound: float) -> float:
    """What the weighted squares of the modes may reach without raising the largest demand."""
    return SURELY * (largest * largest) * bound
