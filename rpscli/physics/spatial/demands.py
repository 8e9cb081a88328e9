"""What a step demands of floors and contacts: resultants of both directions, and either alone.

Bounds tell which steps can raise the demands of floors, as in `planar.demands`, with the sums of x
and of y; for resultants they are added. A step that can is looked at within. Forces of contacts are
looked at within steps that begin near the largest so far. Where a pass takes less than the
contact's own time they are the impulse of an impact, and like those not among the largest forces.
"""

from __future__ import annotations

import math

from rpscli.physics.core.compile import compiled, inlined
from rpscli.physics.core.records import Floats, Record
from rpscli.physics.core.series import integral, middle_of, peak, slope, value
from rpscli.physics.planar.demands import SURELY, WITHIN, raise_by, reach, whole_vectors
from rpscli.physics.planar.equation_of_motion import (
    Measures,
    contact_forces,
    measures_of,
    rotation_terms,
)
from rpscli.physics.spatial.energy import direction_at
from rpscli.physics.spatial.equation_of_motion import MOST, Place, dot, place_of, turning_terms
from rpscli.physics.spatial.state import Pair

NEARLY, AS_MUCH = 0.95, 0.999
"""Steps that begin above this part of the largest force so far, or of the largest friction demand,
are looked at within. As long as columns rock |F|/N hardly leaves tan(alpha)."""


@inlined
def add_mode_3d(s: Record, r: int, l: int, axis: int) -> None:
    """Add what mode r has changed by since the last look, and its velocity in the step."""
    q, force = s.next_q[r, l] - s.seen_q[r, l], s.modal_force[r, l] - s.seen_force[r, l]
    lost = s.dq[0, r, l] - s.next_dq[r, l]
    s.shear_bound[axis, l] += s.shear_weight[r, l] * (q * q)
    s.acceleration_bound[axis, l] += s.acceleration_weight[r, l] * (force * force)
    s.shear_bend[axis, l] += s.shear_weight[r, l] * (lost * lost)


@inlined
def floors_may_rise_3d(s: Record, l: int) -> bool:
    """Whether those sums leave room for a larger demand."""
    part = (WITHIN / 8.0 * s.step[l]) ** 2
    ratio = s.bend_ratio[l]
    shear_x = max(s.shear_before[0, l], s.shear_bound[0, l])
    shear_y = max(s.shear_before[1, l], s.shear_bound[1, l])
    force_x = max(s.acceleration_before[0, l], s.acceleration_bound[0, l])
    force_y = max(s.acceleration_before[1, l], s.acceleration_bound[1, l])
    bent_x, bent_y = part * s.shear_bend[0, l], part * s.shear_bend[1, l]
    both = bent_x + bent_y
    rises = (reach(shear_x, bent_x) > s.shear_rooms[1, l]) | (
        reach(shear_y, bent_y) > s.shear_rooms[2, l]
    )
    rises |= reach(force_x, ratio * bent_x) > s.acceleration_rooms[1, l]
    rises |= reach(force_y, ratio * bent_y) > s.acceleration_rooms[2, l]
    rises |= reach(shear_x + shear_y, both) > s.shear_rooms[0, l]
    rises |= reach(force_x + force_y, ratio * both) > s.acceleration_rooms[0, l]
    return bool(rises)


@compiled
def observe_ends_3d(s: Record) -> None:
    """Say where the demands of floors and contacts may be raised; the beam's way in x and y."""
    lanes, half = s.lanes, s.storeys & MOST
    for i in range(2):
        for l in range(lanes):
            s.shear_bound[i, l], s.acceleration_bound[i, l], s.shear_bend[i, l] = 0.0, 0.0, 0.0
    for r in range(half):
        for l in range(lanes):
            add_mode_3d(s, r, l, 0)
    for r in range(half):
        for l in range(lanes):
            add_mode_3d(s, half + r, l, 1)
    for l in range(lanes):
        s.demands_rise[l] = 1.0 if floors_may_rise_3d(s, l) else 0.0
    for l in range(lanes):
        s.contacts_rise[l] = 1.0 if contacts_may_rise_3d(s, l) else 0.0
    for l in range(lanes):
        accepted, diameter = s.accepted[l] > 0.0, s.diameter[l]
        way = diameter * way_within(s, l)
        s.max_x[l] = max(s.max_x[l], way if accepted else 0.0)
        way = diameter * way_within_y(s, l)
        s.max_y[l] = max(s.max_y[l], way if accepted else 0.0)


@inlined
def way_within(s: Record, l: int) -> float:
    """Largest |u_b| in x within the step, over 2R: of a parabola through three values."""
    start, middle, end = s.u_cos_terms[0, l], 0.0, 0.0
    for m in range(8, -1, -1):
        middle = 0.5 * middle + s.u_cos_terms[m, l]
        end += s.u_cos_terms[m, l]
    return float(peak(start, middle, end))


@inlined
def way_within_y(s: Record, l: int) -> float:
    """The same in y."""
    start, middle, end = s.u_sin_terms[0, l], 0.0, 0.0
    for m in range(8, -1, -1):
        middle = 0.5 * middle + s.u_sin_terms[m, l]
        end += s.u_sin_terms[m, l]
    return float(peak(start, middle, end))


@inlined
def forces_of(
    s: Record,
    l: int,
    at: Place,
    direction: tuple[float, float],
    rates: tuple[float, float, float, float],
    V: tuple[float, float],
    ground: tuple[float, float, float],
) -> tuple[float, float, float, float]:
    """Forces of all columns [N]: |F| and N at the upper ends, |F| and N at the lower ones.

    `rates` are p, w, p' and w', `ground` a in x and y and g + a_v.
    """
    p, w, p_rate, w_rate = rates
    cosine, sine = direction
    diameter, beam, floors = s.diameter[l], s.cap_beam_mass[l], s.floors_mass[l]
    along = diameter * (dot(at.C, p_rate, at.B * p, p) - at.u * w * w)
    across = diameter * dot(at.u, w_rate, 2.0 * at.C * p, w)
    upwards = diameter * dot(at.B, p_rate, (s.phase_c[l] - at.C) * p, p)
    top_x, bottom_x, top, bottom = contact_forces(
        beam,
        floors,
        s.columns_mass[l],
        dot(along, cosine, -across, sine),
        upwards,
        V[0] + s.push_x[l],
        ground[0],
        ground[2],
        s.pull[l],
    )
    top_y, bottom_y, _, _ = contact_forces(
        beam,
        floors,
        s.columns_mass[l],
        dot(along, sine, across, cosine),
        upwards,
        V[1] + s.push_y[l],
        ground[1],
        ground[2],
        s.pull[l],
    )
    return (
        math.sqrt(dot(top_x, top_x, top_y, top_y)),
        top,
        math.sqrt(dot(bottom_x, bottom_x, bottom_y, bottom_y)),
        bottom,
    )


@inlined
def contacts_may_rise_3d(s: Record, l: int) -> bool:
    """Whether forces of contacts come near the largest so far; raises the torsion's lever."""
    p, w, p_rate, w_rate = s.theta_dot[l], s.turning[l], s.theta_ddot[l], s.turning_rate[l]
    time = s.time[l]
    B, C, u, x = s.B_terms[0, l], s.C_terms[0, l], s.u_terms[0, l], s.theta[l]
    sine, cosine, J, A = s.sin_terms[0, l], s.cos_terms[0, l], s.J_terms[0, l], s.A_terms[0, l]
    G = 1.0 - cosine + s.g_terms[0, l]
    slope_of_g = s.g_slope_terms[0, l]
    at = Place(sine, cosine, B, C, u, A, J, s.H_terms[0, l], G, slope_of_g)
    top, N_top, bottom, N_bottom = forces_of(
        s,
        l,
        at,
        (s.cos_phi[l], s.sin_phi[l]),
        (p, w, p_rate, w_rate),
        (s.V[l], s.V_y[l]),
        (
            s.a_g[l] + s.a_g_slope[l] * time,
            s.a_g_y[l] + s.a_g_y_slope[l] * time,
            s.g_up[l] + s.g_up_slope[l] * time,
        ),
    )
    upper = (s.cap_beam_mass[l] + s.floors_mass[l]) * s.gravity[l]
    lower = upper + s.columns_mass[l] * s.gravity[l]
    rises = (top > AS_MUCH * s.friction_top[l] * N_top) | (top > NEARLY * s.shear_top[l])
    rises |= (bottom > AS_MUCH * s.friction_bottom[l] * N_bottom) | (
        bottom > NEARLY * s.shear_bottom[l]
    )
    rises |= N_bottom < lower * (1.0 - NEARLY * (1.0 - s.normal_bottom[l]))
    rises |= N_bottom > lower * (1.0 + NEARLY * (s.heavy_bottom[l] - 1.0))
    rises |= N_top < upper * (1.0 - NEARLY * (1.0 - s.normal_top[l]))
    # What takes less than the contact's own time is an impulse.
    own, across = s.contact_time[l], w * x
    slow = own * own * dot(p, p, across, across) <= x * x
    i_1, i_3 = s.io_1[l], s.inertia_axial[l]
    turns = w * p + 0.0
    l_1 = -i_1 * dot(w_rate, sine, 2.0 * turns, cosine) - turns * (i_3 * G)
    l_3 = -i_3 * dot(w_rate, G, turns, sine + slope_of_g)
    tall, wide = s.phase_c[l] * cosine - s.phase_q[l], s.phase_p[l] + s.phase_c[l] * sine
    arm = 0.25 * s.diameter[l] * s.diameter[l] * s.columns_mass[l]
    lever = arm * abs(dot(tall, l_3, -wide, l_1)) / (C * lower)
    s.torsion_lever[l] = max(s.torsion_lever[l], lever if slow else 0.0)
    return bool(rises & slow)


@compiled
def contacts_within_3d(s: Record, l: int, t: float) -> Measures:
    """Measures of contacts a fraction t into the step, from its Taylor terms."""
    rates, turning, h = rotation_terms(s, l), turning_terms(s, l), s.step[l]
    at = place_of(s, l, s.theta[l] + h * integral(rates, t))
    time = s.time[l] + t * h
    a_x, a_y = s.a_g[l] + s.a_g_slope[l] * time, s.a_g_y[l] + s.a_g_y_slope[l] * time
    g_up = s.g_up[l] + s.g_up_slope[l] * time
    z_x, z_y = 0.0, 0.0
    for m in range(s.z_x_terms.shape[0] - 1, -1, -1):
        z_x, z_y = z_x * t + s.z_x_terms[m, l], z_y * t + s.z_y_terms[m, l]
    # z holds what devices push with as well.
    V_x = (z_x + s.ground_over_R[l] * a_x) / s.shear_factor[l] - s.push_x[l]
    V_y = (z_y + s.ground_over_R[l] * a_y) / s.shear_factor[l] - s.push_y[l]
    shear_top, normal_top, shear_bottom, normal_bottom = forces_of(
        s,
        l,
        at,
        direction_at(s, l, t),
        (value(rates, t), value(turning, t), slope(rates, t) / h, slope(turning, t) / h),
        (V_x, V_y),
        (a_x, a_y, g_up),
    )
    upper = s.cap_beam_mass[l] + s.floors_mass[l]
    return measures_of(
        upper, s.columns_mass[l], s.gravity[l], shear_top, shear_bottom, normal_top, normal_bottom
    )


@compiled
def raise_contacts_3d(s: Record, l: int, fraction: float) -> None:
    """Raise the demands of contacts by those of the first part of the step, if any may rise."""
    if s.contacts_rise[l] > 0.0 and s.step[l] * fraction > 0.0:
        raise_by(
            s,
            l,
            contacts_within_3d(s, l, 0.0),
            contacts_within_3d(s, l, 0.5 * fraction),
            contacts_within_3d(s, l, fraction),
        )


# Floors.


@compiled
def observe_start_3d(s: Record, l: int) -> None:
    """What the modes have changed by since the last look, where a step begins anew."""
    half = s.storeys
    for axis in range(2):
        shear, acceleration = 0.0, 0.0
        for r in range(half * axis, half * (axis + 1)):
            force = s.omega2[r, l] * s.q[r, l] + s.two_xi_omega[r, l] * s.dq[0, r, l]
            q, force = s.q[r, l] - s.seen_q[r, l], force - s.seen_force[r, l]
            shear += s.shear_weight[r, l] * (q * q)
            acceleration += s.acceleration_weight[r, l] * (force * force)
        s.shear_before[axis, l], s.acceleration_before[axis, l] = shear, acceleration


@compiled
def observe_end_3d(s: Record, l: int, systems: Pair) -> None:
    """Raise the demands of a lane's floors by those of a step that was cut short by an event."""
    if s.demands_rise[l] > 0.0:  # in the whole step
        for r in range(s.n):
            q, dq = s.next_q[r, l], s.next_dq[r, l]
            s.modal_force[r, l] = s.omega2[r, l] * q + s.two_xi_omega[r, l] * dq
        raise_floors_3d(s, l, systems)


@compiled
def raise_floors_3d(s: Record, l: int, systems: Pair) -> None:
    """Raise the demands of storeys and floors by those at three instants of the step, and between.

    Notes what room is left for what changes from its end on.
    """
    h, rows, half, width = s.step[l], s.looked_at, s.storeys, whole_vectors(s.storeys)
    rate = 1.5 / h if h > 0.0 else 0.0
    for k in range(12):
        for i in range(width):
            rows[k, i] = 0.0
    for r in range(s.n):
        axis = 0 if r < half else 1
        of, first = r - half * axis, 3 * axis
        q0, v0, q1, v1 = s.q[r, l], s.dq[0, r, l], s.next_q[r, l], s.next_dq[r, l]
        q, v = middle_of(q0, q1, h * v0, h * v1), rate * (q1 - q0) - 0.25 * (v0 + v1)
        omega2, damping = s.omega2[r, l], s.two_xi_omega[r, l]
        f0, f, f1 = omega2 * q0 + damping * v0, omega2 * q + damping * v, omega2 * q1 + damping * v1
        s.seen_q[r, l], s.seen_force[r, l] = q1, f1
        system = systems[0] if axis == 0 else systems[1]
        for i in range(width):
            shear, phi = system.storey_shear_of[of, i], system.phi[of, i]
            rows[first, i] += shear * q0
            rows[first + 1, i] += shear * q
            rows[first + 2, i] += shear * q1
            rows[first + 6, i] += phi * f0
            rows[first + 7, i] += phi * f
            rows[first + 8, i] += phi * f1
    for i in range(2):
        s.shear_bound[i, l], s.acceleration_bound[i, l] = 0.0, 0.0
    both, in_x, in_y = s.storey_shear[l], s.storey_shear_x[l], s.storey_shear_y[l]
    of_x, of_y = systems[0].shear_bound_of, systems[1].shear_bound_of
    raise_rows(both, in_x, in_y, rows, 0, half)
    set_rooms(s.shear_rooms, l, both, in_x, in_y, of_x, of_y, rows, 0, half)
    both, in_x, in_y = s.floor_acceleration[l], s.floor_acceleration_x[l], s.floor_acceleration_y[l]
    of_x, of_y = systems[0].acceleration_bound_of, systems[1].acceleration_bound_of
    raise_rows(both, in_x, in_y, rows, 6, half)
    set_rooms(s.acceleration_rooms, l, both, in_x, in_y, of_x, of_y, rows, 6, half)


@compiled
def raise_rows(
    both: Floats, in_x: Floats, in_y: Floats, rows: Floats, first: int, storeys: int
) -> None:
    """Raise demands of all floors by a step whose instants stand in rows; writes sizes to row 0."""
    for i in range(whole_vectors(storeys)):
        x0, x1, x2 = rows[first, i], rows[first + 1, i], rows[first + 2, i]
        y0, y1, y2 = rows[first + 3, i], rows[first + 4, i], rows[first + 5, i]
        start, middle = math.sqrt(x0 * x0 + y0 * y0), math.sqrt(x1 * x1 + y1 * y1)
        size = math.sqrt(x2 * x2 + y2 * y2)
        both[i] = max(both[i], peak(start, middle, size))
        in_x[i], in_y[i] = max(in_x[i], peak(x0, x1, x2)), max(in_y[i], peak(y0, y1, y2))
        rows[first, i] = size


@compiled
def set_rooms(
    rooms: Floats,
    l: int,
    both: Floats,
    in_x: Floats,
    in_y: Floats,
    of_x: Floats,
    of_y: Floats,
    rows: Floats,
    first: int,
    storeys: int,
) -> None:
    """Keep the squares of what sums over modes may change by before a demand is raised.

    `rows` hold the present values: of sizes in `first`, in x and y in the third and sixth from it.
    """
    least, x, y = math.inf, math.inf, math.inf
    for i in range(storeys):
        least = min(least, min(of_x[i], of_y[i]) * (both[i] - rows[first, i]))
        x = min(x, of_x[i] * (in_x[i] - abs(rows[first + 2, i])))
        y = min(y, of_y[i] * (in_y[i] - abs(rows[first + 5, i])))
    least, x, y = max(least, 0.0), max(x, 0.0), max(y, 0.0)
    rooms[0, l], rooms[1, l] = SURELY * (least * least), SURELY * (x * x)
    rooms[2, l] = SURELY * (y * y)


@compiled
def set_below(s: Record, l: int, systems: Pair) -> None:
    """Note which sums over all modes, from rest, raise no storey's shear and no acceleration."""
    rows, half = s.looked_at, s.storeys
    for k in range(12):
        for i in range(half):
            rows[k, i] = 0.0
    of_x, of_y = systems[0].shear_bound_of, systems[1].shear_bound_of
    both, in_x, in_y = s.storey_shear[l], s.storey_shear_x[l], s.storey_shear_y[l]
    set_rooms(s.shear_below, l, both, in_x, in_y, of_x, of_y, rows, 0, half)
    of_x, of_y = systems[0].acceleration_bound_of, systems[1].acceleration_bound_of
    both, in_x, in_y = s.floor_acceleration[l], s.floor_acceleration_x[l], s.floor_acceleration_y[l]
    set_rooms(s.acceleration_below, l, both, in_x, in_y, of_x, of_y, rows, 0, half)
