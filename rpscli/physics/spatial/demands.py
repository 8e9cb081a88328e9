"""What a step demands of floors and contacts: resultants of both directions, and either alone.

Bounds tell which steps can raise the demands of floors, as in `planar.demands`, with the sums of x
and of y; for resultants they are added. A step that can is looked at within. Forces of contacts are
looked at within steps that begin near the largest so far. Where a pass takes less than the
contact's own time they are the impulse of an impact, and like those not among the largest forces.

Rows of sums are shears in x and in y, then accelerations; rows of demands are shears as resultants,
in x and in y, then accelerations.
"""

from __future__ import annotations

import math

from rpscli.physics.core.compile import compiled, inlined, variant
from rpscli.physics.core.records import INSTANTS, Floats, Record
from rpscli.physics.core.series import integral, middle_of, peak, slope, value
from rpscli.physics.planar.demands import (
    SURELY,
    WITHIN,
    fill_within,
    look_at_end,
    observe_end,
    raise_by,
    raise_by_end,
    raise_contacts_within,
    raise_floors,
    reach,
    set_below_all_maxima,
)
from rpscli.physics.planar.equation_of_motion import (
    Measures,
    contact_forces,
    measures_of,
    rotation_terms,
)
from rpscli.physics.planar.full_contact.demands import add_modes, raise_floors_of_block
from rpscli.physics.planar.full_contact.follow import observe_block
from rpscli.physics.spatial.devices import set_push
from rpscli.physics.spatial.equation_of_motion import (
    MOST,
    Place,
    direction_at,
    pair_within,
    place_of,
    turning_terms,
)

NEARLY, AS_MUCH = 0.95, 0.999
"""Steps that begin above this part of the largest force so far, or of the largest friction demand,
are looked at within. As long as columns rock |F|/N hardly leaves tan(alpha)."""


# Floors.


@inlined
def rises_above(
    rooms: Floats, l: int, kind: int, x: float, y: float, bent_x: float, bent_y: float
) -> bool:
    """Whether sums, and what they may be within the step, leave their rooms."""
    rises = reach(x + y, bent_x + bent_y) > rooms[3 * kind, l]
    rises |= reach(x, bent_x) > rooms[3 * kind + 1, l]
    return bool(rises | (reach(y, bent_y) > rooms[3 * kind + 2, l]))


@inlined
def floors_may_rise_3d(s: Record, l: int) -> bool:
    """Whether what modes have changed by leaves room for a larger demand."""
    part = (WITHIN / 8.0 * s.step[l]) * (WITHIN / 8.0 * s.step[l])
    rises = False
    for kind in range(2):
        ratio = part * s.bend_ratio[l] if kind == 1 else part
        x = max(s.before[2 * kind, l], s.bound[2 * kind, l])
        y = max(s.before[2 * kind + 1, l], s.bound[2 * kind + 1, l])
        rises |= rises_above(s.room, l, kind, x, y, ratio * s.bend[0, l], ratio * s.bend[1, l])
    return rises


@compiled
def observe_ends_3d(s: Record) -> None:
    """Say where the demands of floors and contacts may be raised."""
    lanes, half = s.lanes, s.storeys & MOST
    for i in range(4):
        for l in range(lanes):
            s.bound[i, l] = 0.0
    for axis in range(2):
        for l in range(lanes):
            s.bend[axis, l] = 0.0
        for i in range(half):
            r = half * axis + i
            for l in range(lanes):
                q, lost = s.next_q[r, l] - s.seen_q[r, l], s.dq[0, r, l] - s.next_dq[r, l]
                force = s.modal_force[r, l] - s.seen_force[r, l]
                s.bound[axis, l] += s.shear_weight[r, l] * (q * q)
                s.bound[2 + axis, l] += s.acceleration_weight[r, l] * (force * force)
                s.bend[axis, l] += s.shear_weight[r, l] * (lost * lost)
    for l in range(lanes):
        s.demands_rise[l] = 1.0 if floors_may_rise_3d(s, l) else 0.0
    for l in range(lanes):
        s.contacts_rise[l] = 1.0 if contacts_may_rise_3d(s, l) else 0.0
    raise_ways(s)


@compiled
def raise_ways(s: Record) -> None:
    """Raise the beam's way in x and y by those within accepted steps."""
    for axis in range(2):
        for l in range(s.lanes):
            middle, end = 0.0, 0.0
            for m in range(s.u_b_terms.shape[1] - 1, -1, -1):
                middle = 0.5 * middle + s.u_b_terms[axis, m, l]
                end += s.u_b_terms[axis, m, l]
            way = s.diameter[l] * peak(s.u_b_terms[axis, 0, l], middle, end)
            s.max_beam[axis, l] = max(s.max_beam[axis, l], way if s.accepted[l] > 0.0 else 0.0)


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
        s.before[axis, l], s.before[2 + axis, l] = shear, acceleration


@variant(observe_end, "cos_phi")
def observe_end_3d(s: Record, l: int, systems: Record) -> None:
    """Raise the demands of a lane's floors by those of a step that was cut short by an event."""
    if s.demands_rise[l] > 0.0:  # in the whole step
        for r in range(s.n):
            q, dq = s.next_q[r, l], s.next_dq[r, l]
            s.modal_force[r, l] = s.omega2[r, l] * q + s.two_xi_omega[r, l] * dq
        raise_floors_3d(s, l, systems)


@compiled
def bounds_of(systems: Record, kind: int) -> tuple[Floats, Floats]:
    """Of all storeys or floors what times their demand sums do not pass, in x and in y."""
    if kind == 0:
        return systems[0].shear_bound_of, systems[1].shear_bound_of
    return systems[0].acceleration_bound_of, systems[1].acceleration_bound_of


@variant(raise_floors, "cos_phi")
def raise_floors_3d(s: Record, l: int, systems: Record) -> None:
    """Raise the demands of storeys and floors by those of the step just taken.

    By those at its end; and by those within, where they bulge enough above both ends.
    """
    half, rows, within = s.storeys, s.looked_at, 0
    both, least = rows[4], rows[5]
    for axis in range(2):
        look_at_end(s, l, systems[axis], half * axis, rows[axis], rows[2 + axis])
    for kind in range(2):
        x, y, of = rows[2 * kind], rows[2 * kind + 1], bounds_of(systems, kind)
        for i in range(half):
            both[i], least[i] = math.sqrt(x[i] * x[i] + y[i] * y[i]), min(of[0][i], of[1][i])
        within |= raise_way(s, l, 3 * kind, both, least)
        within |= raise_way(s, l, 3 * kind + 1, x, of[0])
        within |= raise_way(s, l, 3 * kind + 2, y, of[1])
    for i in range(4):
        s.bound[i, l] = 0.0
    if within > 0:
        raise_floors_within_3d(s, l, systems)


@compiled
def raise_way(s: Record, l: int, k: int, now: Floats, bound_of: Floats) -> int:
    """The same of a row of demands, by the ends; 1 if more may have been between."""
    moved, bent = 0.0, 0.0
    for axis in range(2):
        if k % 3 in (0, 1 + axis):
            moved, bent = moved + s.before[2 * (k // 3) + axis, l], bent + s.bend[axis, l]
    bent *= s.bend_ratio[l] if k > 2 else 1.0
    moved, bulge, storeys = math.sqrt(moved), WITHIN / 8.0 * s.step[l] * math.sqrt(bent), s.storeys
    most, last = s.largest[k, l], s.last[k, l]
    within, s.room[k, l] = raise_by_end(most, last, now, bound_of, moved, bulge, storeys)
    return within


@compiled
def raise_floors_within_3d(s: Record, l: int, systems: Record) -> None:
    """The same by those at the start, in the middle, at the end, and of a parabola through them."""
    half, rows = s.storeys, s.looked_at
    for axis in range(2):
        fill_within(s, l, systems[axis], half * axis, rows[6 * axis : 6 * axis + 6])
    for kind in range(2):
        both, in_x, in_y = (
            s.largest[3 * kind, l],
            s.largest[3 * kind + 1, l],
            s.largest[3 * kind + 2, l],
        )
        for i in range(half):
            x0, x1, x2 = rows[3 * kind, i], rows[3 * kind + 1, i], rows[3 * kind + 2, i]
            y0, y1, y2 = rows[3 * kind + 6, i], rows[3 * kind + 7, i], rows[3 * kind + 8, i]
            start, middle = math.sqrt(x0 * x0 + y0 * y0), math.sqrt(x1 * x1 + y1 * y1)
            both[i] = max(both[i], peak(start, middle, math.sqrt(x2 * x2 + y2 * y2)))
            in_x[i], in_y[i] = max(in_x[i], peak(x0, x1, x2)), max(in_y[i], peak(y0, y1, y2))


@variant(set_below_all_maxima, "cos_phi")
def set_below(s: Record, l: int, systems: Record) -> None:
    """Note which sums over all modes, from rest, raise no storey's shear and no acceleration."""
    for kind in range(2):
        of_x, of_y = bounds_of(systems, kind)
        both, x, y = math.inf, math.inf, math.inf
        for i in range(s.storeys):
            both = min(both, min(of_x[i], of_y[i]) * s.largest[3 * kind, l, i])
            x = min(x, of_x[i] * s.largest[3 * kind + 1, l, i])
            y = min(y, of_y[i] * s.largest[3 * kind + 2, l, i])
        s.below[3 * kind, l], s.below[3 * kind + 1, l] = SURELY * (both * both), SURELY * (x * x)
        s.below[3 * kind + 2, l] = SURELY * (y * y)


# Contacts.


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
    diameter, beam, floors, columns = (
        s.diameter[l],
        s.cap_beam_mass[l],
        s.floors_mass[l],
        s.columns_mass[l],
    )
    out = diameter * (at.C * p_rate + at.B * p * p - at.u * w * w)
    across = diameter * (at.u * w_rate + 2.0 * at.C * p * w)
    up = diameter * (at.B * p_rate + (s.phase_c[l] - at.C) * p * p)
    x, y, V_x, V_y = out * cosine - across * sine, out * sine + across * cosine, V[0], V[1]
    V_x, V_y, pull = V_x + s.push_x[l], V_y + s.push_y[l], s.pull[l]
    top_x, low_x, top, low = contact_forces(
        beam, floors, columns, x, up, V_x, ground[0], ground[2], pull
    )
    top_y, low_y, _, _ = contact_forces(
        beam, floors, columns, y, up, V_y, ground[1], ground[2], pull
    )
    return (
        math.sqrt(top_x * top_x + top_y * top_y),
        top,
        math.sqrt(low_x * low_x + low_y * low_y),
        low,
    )


@inlined
def contacts_may_rise_3d(s: Record, l: int) -> bool:
    """Whether forces of contacts come near the largest so far; raises the torsion's lever."""
    p, w, p_rate, w_rate = s.theta_dot[l], s.turning[l], s.theta_ddot[l], s.turning_rate[l]
    time, x = s.time[l], s.theta[l]
    sine, cosine, C = s.sin_terms[0, l], s.cos_terms[0, l], s.C_terms[0, l]
    G, slope_of_g = 1.0 - cosine + s.g_terms[0, l], s.g_slope_terms[0, l]
    J, A, H = s.J_terms[0, l], s.A_terms[0, l], s.H_terms[0, l]
    at = Place(sine, cosine, s.B_terms[0, l], C, s.u_terms[0, l], A, J, H, G, slope_of_g)
    ground = (
        s.a_g[l] + s.a_g_slope[l] * time,
        s.a_g_y[l] + s.a_g_y_slope[l] * time,
        s.g_up[l] + s.g_up_slope[l] * time,
    )
    # From z, which holds what dampers push with as well.
    V_x = (s.z_terms[0, 0, l] + s.ground_over_R[l] * ground[0]) / s.shear_factor[l]
    V_y = (s.z_terms[1, 0, l] + s.ground_over_R[l] * ground[1]) / s.shear_factor[l]
    top, N_top, bottom, N_bottom = forces_of(
        s, l, at, (s.cos_phi[l], s.sin_phi[l]), (p, w, p_rate, w_rate), (V_x, V_y), ground
    )
    upper = (s.cap_beam_mass[l] + s.floors_mass[l]) * s.gravity[l]
    lower = upper + s.columns_mass[l] * s.gravity[l]
    rises = (top > AS_MUCH * s.friction_top[l] * N_top) | (top > NEARLY * s.shear_top[l])
    rises |= bottom > AS_MUCH * s.friction_bottom[l] * N_bottom
    rises |= bottom > NEARLY * s.shear_bottom[l]
    rises |= N_bottom < lower * (1.0 - NEARLY * (1.0 - s.normal_bottom[l]))
    rises |= N_bottom > lower * (1.0 + NEARLY * (s.heavy_bottom[l] - 1.0))
    rises |= N_top < upper * (1.0 - NEARLY * (1.0 - s.normal_top[l]))
    # What takes less than the contact's own time is an impulse.
    own, across = s.contact_time[l], w * x
    slow = own * own * (p * p + across * across) <= x * x
    i_1, i_3, turns = s.io_1[l], s.inertia_axial[l], w * p
    l_1 = -i_1 * (w_rate * sine + 2.0 * turns * cosine) - turns * (i_3 * G)
    l_3 = -i_3 * (w_rate * G + turns * (sine + slope_of_g))
    tall, wide = s.phase_c[l] * cosine - s.phase_q[l], s.phase_p[l] + s.phase_c[l] * sine
    arm = 0.25 * s.diameter[l] * s.diameter[l] * s.columns_mass[l]
    lever = arm * abs(tall * l_3 - wide * l_1) / (C * lower)
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
    z_x, z_y = pair_within(s.z_terms, l, t)
    V_x = (z_x + s.ground_over_R[l] * a_x) / s.shear_factor[l]
    V_y = (z_y + s.ground_over_R[l] * a_y) / s.shear_factor[l]
    p, w, direction = value(rates, t), value(turning, t), direction_at(s, l, t)
    set_push(s, l, at, s.theta[l] + h * integral(rates, t), direction, (p, w), 0.0)
    shear_top, normal_top, shear_bottom, normal_bottom = forces_of(
        s,
        l,
        at,
        direction,
        (p, w, slope(rates, t) / h, slope(turning, t) / h),
        (V_x, V_y),
        (a_x, a_y, g_up),
    )
    upper = s.cap_beam_mass[l] + s.floors_mass[l]
    return measures_of(
        upper, s.columns_mass[l], s.gravity[l], shear_top, shear_bottom, normal_top, normal_bottom
    )


@variant(raise_contacts_within, "cos_phi")
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


# The same of blocks of steps in full contact.


@variant(observe_block, "cos_phi")
def observe_blocks(
    s: Record, l: int, systems: Record, blocks: Record, _pull: float, h: float, steps: int
) -> None:
    """Raise the demands of a lane by those of the first steps of the blocks, of length h [s]."""
    part, found, x, y = WITHIN / 8.0 * h * h, 0, blocks[0], blocks[1]
    part, ratio = part * part, part * part * s.bend_ratio[l]
    for k in range(INSTANTS):
        shear, other, bent = x.shear_bound[k], y.shear_bound[k], x.shear_bend[k]
        more = rises_above(s.below, l, 0, shear, other, part * bent, part * y.shear_bend[k])
        shaken, other = x.acceleration_bound[k], y.acceleration_bound[k]
        more |= rises_above(s.below, l, 1, shaken, other, ratio * bent, ratio * y.shear_bend[k])
        found |= 1 if more & (k <= steps) else 0
    if found > 0 and s.storeys > 0:
        for axis in range(2):
            shears, accelerations = s.largest[1 + axis, l], s.largest[4 + axis, l]
            raise_floors_of_block(blocks[axis], systems[axis], shears, accelerations, h, steps)
        for i in range(s.storeys):
            for axis in range(2):
                block, shares = blocks[axis], systems[axis].storey_shear_of
                add_modes(block, shares, block.qs, block.row, i)
                add_modes(block, shares, block.dqs, block.row_slope, i)
            raise_by_rows(s.largest[0, l], x, y, i, h, steps)
            for axis in range(2):
                block, shares = blocks[axis], systems[axis].phi
                add_modes(block, shares, block.forces, block.row, i)
                add_modes(block, shares, block.rises, block.row_slope, i)
            raise_by_rows(s.largest[3, l], x, y, i, h, steps)
        set_below(s, l, systems)
    observe_contacts_3d(s, l, blocks, h, steps)


@compiled
def raise_by_rows(both: Floats, x: Record, y: Record, i: int, h: float, steps: int) -> None:
    """Raise the resultant of one floor by the rows of both blocks."""
    largest, after = both[i], 0.0
    for k in range(steps):
        x0, x1, y0, y1 = x.row[k], x.row[k + 1], y.row[k], y.row[k + 1]
        x_middle = middle_of(x0, x1, h * x.row_slope[k], h * x.row_slope[k + 1])
        y_middle = middle_of(y0, y1, h * y.row_slope[k], h * y.row_slope[k + 1])
        before = math.sqrt(x0 * x0 + y0 * y0) if k == 0 else after
        middle = math.sqrt(x_middle * x_middle + y_middle * y_middle)
        after = math.sqrt(x1 * x1 + y1 * y1)
        largest = max(largest, peak(before, middle, after))
    both[i] = largest


@compiled
def observe_contacts_3d(s: Record, l: int, blocks: Record, h: float, steps: int) -> None:
    """Raise friction demands and forces of contacts at rest, within steps and at both ends."""
    x, y = blocks[0], blocks[1]
    beam, columns, gravity = s.cap_beam_mass[l], s.columns_mass[l], s.gravity[l]
    upper = beam + s.floors_mass[l]
    for k in range(steps):
        g_up, lighter = x.g_up[k], h * abs(x.g_up_slope[k])
        bulge = WITHIN / 8.0 * h * (abs(x.dV[k] - x.dV[k + 1]) + abs(y.dV[k] - y.dV[k + 1]))
        bulge += abs(x.V[k] - x.V[k + 1]) + abs(y.V[k] - y.V[k + 1])
        bulge += (beam + columns) * h * (abs(x.a_g_slope[k]) + abs(y.a_g_slope[k]))
        shear_x, shear_y = beam * x.a_g[k] - x.V[k], beam * y.a_g[k] - y.V[k]
        low_x, low_y = shear_x + columns * x.a_g[k], shear_y + columns * y.a_g[k]
        top = math.sqrt(shear_x * shear_x + shear_y * shear_y) + bulge
        bottom = math.sqrt(low_x * low_x + low_y * low_y) + bulge
        rises = top > s.friction_top[l] * upper * (g_up - lighter)
        rises |= bottom > s.friction_bottom[l] * (upper + columns) * (g_up - lighter)
        rises |= (top > s.shear_top[l]) | (bottom > s.shear_bottom[l])
        rises |= g_up - lighter < s.normal_bottom[l] * gravity
        rises |= g_up + lighter > s.heavy_bottom[l] * gravity
        if rises:
            V_x = middle_of(x.V[k], x.V[k + 1], h * x.dV[k], h * x.dV[k + 1])
            V_y = middle_of(y.V[k], y.V[k + 1], h * y.dV[k], h * y.dV[k + 1])
            raise_by(
                s,
                l,
                measures_at_rest(s, l, blocks, x.V[k], y.V[k], k, 0.0),
                measures_at_rest(s, l, blocks, V_x, V_y, k, 0.5 * h),
                measures_at_rest(s, l, blocks, x.V[k + 1], y.V[k + 1], k, h),
            )


@compiled
def measures_at_rest(
    s: Record, l: int, blocks: Record, V_x: float, V_y: float, k: int, t: float
) -> Measures:
    """Measures of contacts at rest, a time t into the step after k others."""
    x, y = blocks[0], blocks[1]
    g_up = x.g_up[k] + t * x.g_up_slope[k]
    a_x, a_y = x.a_g[k] + t * x.a_g_slope[k], y.a_g[k] + t * y.a_g_slope[k]
    still = Place(0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    top, N_top, bottom, N_bottom = forces_of(
        s, l, still, (1.0, 0.0), (0.0, 0.0, 0.0, 0.0), (V_x, V_y), (a_x, a_y, g_up)
    )
    upper = s.cap_beam_mass[l] + s.floors_mass[l]
    return measures_of(upper, s.columns_mass[l], s.gravity[l], top, bottom, N_top, N_bottom)
