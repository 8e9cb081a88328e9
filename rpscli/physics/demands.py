"""What a step demands of floors and contacts, at its ends and within.

A storey shear is a sum over modes, sum_r s_ir q_r, so that all of them cost n^2 products a step,
more than the motion itself. By Cauchy and Schwarz's inequality what it changes by is bounded:

    (sum_r s_ir dq_r)^2 <= (sum_r s_ir^2/g_r) (sum_r g_r dq_r^2)

whatever the weights g_r > 0. With dq what has changed since all storeys were last looked at, no
shear is raised while the last sum, which costs n, stays below the least

    (largest shear so far of storey i - its shear when last looked at)^2/(sum_r s_ir^2/g_r).

The same holds for floor accelerations, sums over the modal forces. Within a step of length h a
motion leaves the chord between its ends by h/8 of what its velocity changes by, if it is a cubic;
with a margin for what it is more, the same sum over that change bounds the whole step. Only where
that bound is passed the step is looked at. The forces of contacts are compared with the largest so
far at the ends of all steps, and looked at within where they come near.

Rows of demands are those of shears, then those of accelerations: in one plane one each; of both
components resultants, then x, then y, whose sums are added for resultants.
"""

from __future__ import annotations

import math
from typing import TypeAlias

from rpscli.physics.compile import compiled, inlined
from rpscli.physics.devices.acting import act, power_in_step
from rpscli.physics.devices.seen import raise_devices
from rpscli.physics.devices.worked import worked
from rpscli.physics.energy import path_at
from rpscli.physics.events import path_of
from rpscli.physics.friction import grip_at, push_at_rest
from rpscli.physics.ground import log_row
from rpscli.physics.lane import (
    contact_forces,
    felt_at,
    g_up_at,
    ground_at,
    lanes_of,
    mode_acceleration,
    new_rate_of,
    new_tilt_of,
    patch,
    place_with,
    polar,
    pushed_by,
    rate_of,
    respond,
    stands,
    tilt_of,
    ways_of,
    without_shock,
    z_of,
)
from rpscli.physics.peaks import middle_of, peak, turning_value
from rpscli.physics.quintic import (
    Quintic,
    cubic,
    first_descent,
    lower_hull,
    offset,
    peak_in_step,
    quintic,
    slope,
    upper_hull,
    value,
)
from rpscli.physics.state import (
    CRITICAL_PASSAGE,
    NO_HISTORY,
    STUCK,
    Floats,
    Record,
)
from rpscli.physics.storeys import free_rows

WITHIN = 1.5
"""Room for what a motion within a step is more than a cubic."""

SURELY = 1.0 - 1e-9
"""Room for the rounding of either side."""

UNSEEN = 1e-6
"""Of the weight: smaller changes of the floors' force on springs are ignored."""

NEARLY = 0.999
"""Steps that may pass this part of the largest force so far, with what the base shear may be within
them above their ends, are looked at within. As long as columns rock |F|/N hardly leaves
tan(alpha)."""


@inlined
def rows_of(s: Record) -> int:
    """Rows of demands of a kind."""
    return 2 * ways_of(s) - 1


@inlined
def reach(one: float, other: float) -> float:
    """The square of a sum, from the squares."""
    return one + other + 2.0 * math.sqrt(one * other)


@inlined
def floors_may_rise(s: Record, l: int) -> bool:
    """Whether the sums, and what they may be within the step, leave room for a larger demand."""
    rises, part = s.marked[l] > 0, WITHIN / 8.0 * s.h[l]
    part *= part
    for j in range(rows_of(s)):
        shear, acceleration, bent = 0.0, 0.0, 0.0
        for axis in range(ways_of(s)):
            if j in (0, 1 + axis):
                shear += max(s.shear_before[axis, l], s.shear_sum[axis, l])
                acceleration += max(s.acceleration_before[axis, l], s.acceleration_sum[axis, l])
                bent += s.bent[axis, l]
        bent *= part
        rises |= reach(shear, bent) > s.room[j, l]
        rises |= reach(acceleration, bent * s.bend_ratio[l]) > s.room[rows_of(s) + j, l]
    return rises  # type: ignore[no-any-return]


@compiled
def observe_floors(s: Record) -> None:
    """Say in `demands_rise` where the demands of floors may be raised."""
    n, lanes = s.n, lanes_of(s)
    for axis in range(ways_of(s)):
        for l in range(lanes):
            s.shear_sum[axis, l], s.acceleration_sum[axis, l], s.bent[axis, l] = 0.0, 0.0, 0.0
        for r in range(axis * n, (axis + 1) * n):
            for l in range(lanes):
                q, force = s.new_q[r, l] - s.seen_q[r, l], s.force[r, l] - s.seen_force[r, l]
                lost = s.dq[r, l] - s.new_dq[r, l]
                s.shear_sum[axis, l] += s.shear_weight[r, l] * (q * q)
                s.acceleration_sum[axis, l] += s.acceleration_weight[r, l] * (force * force)
                s.bent[axis, l] += s.shear_weight[r, l] * (lost * lost)
    for l in range(lanes):
        s.demands_rise[l] = 1.0 if floors_may_rise(s, l) else 0.0


@compiled
def bounds_of(systems: Record, axis: int, kind: int) -> Floats:
    """Of all storeys or floors what times their demand sums do not pass, in a direction."""
    system = systems[axis]
    return system.shear_bound_of if kind == 0 else system.acceleration_bound_of  # type: ignore[no-any-return]


@compiled
def raise_floors(s: Record, l: int, systems: Record) -> None:
    """Raise the demands of a lane's storeys and floors by those of the step just taken.

    By those at its end; and by those within, where they bulge enough above both ends.
    """
    n, ways, rows, within = s.n, ways_of(s), s.seen, False
    for axis in range(ways):
        system, shears, accelerations = systems[axis], rows[2 * axis], rows[2 * axis + 1]
        for i in range(n):
            shears[i], accelerations[i] = 0.0, 0.0
        for of in range(n):
            r = axis * n + of
            q, force = s.new_q[r, l], s.force[r, l]
            s.seen_q[r, l], s.seen_force[r, l] = q, force
            for i in range(n):
                shears[i] += system.storey_shear_of[of, i] * q
                accelerations[i] += system.phi[of, i] * force
        if s.yields[l] > 0:
            free_rows(s, l, system, axis, shears, s.freeing[0])
    for kind in range(2):
        for j in range(rows_of(s)):
            within |= raise_row(s, l, systems, kind, j)
    for axis in range(ways):
        s.shear_sum[axis, l], s.acceleration_sum[axis, l] = 0.0, 0.0
    if within and s.h[l] > 0.0:
        raise_floors_within(s, l, systems)


@compiled
def raise_row(s: Record, l: int, systems: Record, kind: int, j: int) -> bool:
    """Raise a row of demands by what they are now, and note it as the last that was seen.

    True if more may have been between; leaves the sum with which none rises from now on.
    """
    moved, bent, k = 0.0, 0.0, kind * rows_of(s) + j
    for axis in range(ways_of(s)):
        if j in (0, 1 + axis):
            moved += s.acceleration_before[axis, l] if kind > 0 else s.shear_before[axis, l]
            bent += s.bent[axis, l]
    bent *= s.bend_ratio[l] if kind > 0 else 1.0
    moved, bulge = math.sqrt(moved), WITHIN / 8.0 * s.h[l] * math.sqrt(bent)
    within, room = False, math.inf
    for i in range(s.n):
        if ways_of(s) == 1 or j == 1:
            here, share = abs(s.seen[kind, i]), bounds_of(systems, 0, kind)[i]
        elif j == 2:
            here, share = abs(s.seen[2 + kind, i]), bounds_of(systems, 1, kind)[i]
        else:
            x, y = s.seen[kind, i], s.seen[2 + kind, i]
            here = math.sqrt(x * x + y * y)
            share = min(bounds_of(systems, 0, kind)[i], bounds_of(systems, 1, kind)[i])
        most = s.largest[k, l, i]
        left, before = share * (most - here), share * (most - s.last[k, l, i]) - moved
        within |= min(left, before) < bulge
        s.largest[k, l, i], s.last[k, l, i] = max(most, here), here
        room = min(room, max(left, 0.0))
    s.room[k, l] = SURELY * (room * room)
    return within


PARTS = 8
"""Of steps that are made for vertical springs, in which the motions of floors turn: a parabola
through both ends of a part and its middle leaves 4e-6 of a vibration."""


STRAIGHT = 1e-5
"""Of the floors' weight: forces of springs that leave the chord by less need no parts."""


@inlined
def parts_of(s: Record, l: int) -> int:
    """Parts of a step that are looked at, each by its ends and its middle."""
    springs = s.axes > ways_of(s)
    turns = bulge(s, l, 0, s.axes) > STRAIGHT * s.floors_mass[l] * s.gravity[l]
    return PARTS if springs and turns else 1


@compiled
def mode_path(s: Record, r: int, l: int, axis: int) -> Quintic:
    """A mode's displacement over the step just taken."""
    start = mode_acceleration(s, r, l, axis)
    end = -(s.Gamma[r, l] * s.new_shaking[axis, l]) - s.force[r, l]
    return quintic(s.h[l], s.q[r, l], s.dq[r, l], start, s.new_q[r, l], s.new_dq[r, l], end)


@compiled
def mode_within(s: Record, r: int, l: int, axis: int, t: float) -> tuple[float, float]:
    """Displacement and velocity of a mode a fraction t into the step."""
    h, q0, v0, q1, v1 = s.h[l], s.q[r, l], s.dq[r, l], s.new_q[r, l], s.new_dq[r, l]
    if t == 0.0:
        return q0, v0
    if t == 1.0:
        return q1, v1
    if s.axes == ways_of(s):
        return middle_of(q0, q1, h * v0, h * v1), 1.5 / h * (q1 - q0) - 0.25 * (v0 + v1)
    path = mode_path(s, r, l, axis)
    return value(path, t), slope(path, t) / h


@compiled
def raise_floors_within(s: Record, l: int, systems: Record) -> None:
    """The same by those at start, middle and end, and of a parabola through them."""
    parts = parts_of(s, l)
    for part in range(parts):
        raise_floors_between(s, l, systems, part / parts, (part + 1) / parts)


@compiled
def raise_floors_between(s: Record, l: int, systems: Record, begin: float, end: float) -> None:
    """The same between fractions of the step."""
    n, rows = s.n, s.between
    for axis in range(ways_of(s)):
        write_between(s, l, systems[axis], axis, begin, end)
    for kind in range(2):
        for j in range(rows_of(s)):
            k, x = kind * rows_of(s) + j, 3 * kind + (6 if j == 2 else 0)
            for i in range(n):
                a, b, c = rows[x, i], rows[x + 1, i], rows[x + 2, i]
                if ways_of(s) == 2 and j == 0:
                    y = x + 6
                    a = math.sqrt(a * a + rows[y, i] * rows[y, i])
                    b = math.sqrt(b * b + rows[y + 1, i] * rows[y + 1, i])
                    c = math.sqrt(c * c + rows[y + 2, i] * rows[y + 2, i])
                s.largest[k, l, i] = max(s.largest[k, l, i], peak(a, b, c))


@compiled
def write_between(s: Record, l: int, system: Record, axis: int, begin: float, end: float) -> None:
    """Write shears and accelerations at three instants of the step, of a direction."""
    n, rows, first = s.n, s.between, 6 * axis
    for k in range(first, first + 6):
        for i in range(n):
            rows[k, i] = 0.0
    for of in range(n):
        r = axis * n + of
        q0, v0 = mode_within(s, r, l, axis, begin)
        q, v = mode_within(s, r, l, axis, 0.5 * (begin + end))
        q1, v1 = mode_within(s, r, l, axis, end)
        omega2, damping = s.omega2[r, l], s.two_xi_omega[r, l]
        f0, f1 = omega2 * q0 + damping * v0, omega2 * q1 + damping * v1
        f = omega2 * q + damping * v
        for i in range(n):
            shear, phi = system.storey_shear_of[of, i], system.phi[of, i]
            rows[first, i] += shear * q0
            rows[first + 1, i] += shear * q
            rows[first + 2, i] += shear * q1
            rows[first + 3, i] += phi * f0
            rows[first + 4, i] += phi * f
            rows[first + 5, i] += phi * f1
    for k in range(first, first + 3 if s.yields[l] > 0 else first):
        free_rows(s, l, system, axis, rows[k], rows[k + 3])


@compiled
def sums_at_start(s: Record, l: int) -> None:
    """What the modes have changed by since the last look, where a step begins anew."""
    for axis in range(ways_of(s)):
        shear, acceleration = 0.0, 0.0
        for r in range(axis * s.n, (axis + 1) * s.n):
            force = s.omega2[r, l] * s.q[r, l] + s.two_xi_omega[r, l] * s.dq[r, l]
            force -= s.freed[r, l]
            q, force = s.q[r, l] - s.seen_q[r, l], force - s.seen_force[r, l]
            shear += s.shear_weight[r, l] * (q * q)
            acceleration += s.acceleration_weight[r, l] * (force * force)
        s.shear_before[axis, l], s.acceleration_before[axis, l] = shear, acceleration


# Contacts.

Measures: TypeAlias = tuple[float, float, float, float, float, float]
"""|F|/N, N over the weight on it and |F|, each at the upper and at the lower ends."""


@inlined
def measures_of(
    s: Record,
    l: int,
    stays: float,
    beam: tuple[float, float],
    lift: float,
    V: tuple[float, float],
    ground: tuple[float, float],
    up: tuple[float, float],
) -> Measures:
    """Measures of contacts; where nothing stands on the columns their upper ends demand nothing.

    In a shock `stays` is 0, else 1: forces are those without it (13.19), and what friction they ask
    for says nothing.
    """
    lift *= stays
    top, bottom, N_top, N_bottom = contact_forces(s, l, stays * beam[0], lift, V[0], ground[0], up)
    top, bottom = abs(top), abs(bottom)
    if ways_of(s) == 2:
        y, low, _, _ = contact_forces(s, l, stays * beam[1], lift, V[1], ground[1], up)
        top, bottom = math.sqrt(top * top + y * y), math.sqrt(bottom * bottom + low * low)
    upper = s.cap_beam_mass[l] + s.floors_mass[l]
    lower, loaded = upper + s.columns_mass[l], upper > 0.0
    demand = top / (N_top if N_top > 0.0 else 1.0)
    demand = demand if N_top > 0.0 else math.inf
    demand_bottom = bottom / (N_bottom if N_bottom > 0.0 else 1.0)
    demand_bottom = demand_bottom if N_bottom > 0.0 else math.inf
    return (
        demand if loaded and stays > 0.0 else 0.0,
        demand_bottom if stays > 0.0 else 0.0,
        N_top / (upper * s.gravity[l] if loaded else 1.0) if loaded else math.inf,
        N_bottom / (lower * s.gravity[l]),
        top,
        bottom,
    )


@inlined
def bulge(s: Record, l: int, first: int, end: int) -> float:
    """What the forces of springs in some axes may be within the step above both ends [N]."""
    square = 0.0
    for axis in range(first, end):
        change = s.new_dV[axis, l] - s.dV[axis, l]
        square += change * change
    return WITHIN / 8.0 * s.h[l] * math.sqrt(square)  # type: ignore[no-any-return]


@compiled
def observe_contacts(s: Record) -> None:
    """Say in `contacts_rise` where the forces of contacts at the ends come near the largest.

    In full contact without what friction dampers may take: the more.
    """
    for l in range(lanes_of(s)):
        time = s.time[l] + s.h[l]
        ground = ground_at(s, l, 0, time)
        ground_y, beam_y, V_y = 0.0, 0.0, 0.0
        if ways_of(s) == 2:
            ground_y = ground_at(s, l, 1, time)
            beam_y, V_y = s.new_shaking[1, l] - ground_y, s.new_V[1, l] + s.drive[1, l]
        stuck = s.phase[l] == STUCK
        rate = new_rate_of(s, l)
        now = polar(s, l, new_tilt_of(s, l), rate)
        beam, g_up = s.new_shaking[0, l] - ground, g_up_at(s, l, time)
        stays, V = without_shock(s, l, now.x, rate), s.new_V[0, l] + s.drive[0, l]
        if s.equipped > 0:  # friction dampers push until all is what the columns hold
            per_share, load = 2.0 / (s.diameter[l] * s.share[l]), s.load[l] / s.share[l]
            V = s.held_x[l] * per_share + load * ground if stuck else V
            V_y = s.held_y[l] * per_share + load * ground_y if stuck else V_y
        V, V_y = V + s.tied[l] * now.n, V_y + s.tied[l] * now.t
        pressed, V_up = (g_up, s.new_V[ways_of(s), l]), bulge(s, l, ways_of(s), ways_of(s) + 1)
        found = measures_of(
            s, l, stays, (beam, beam_y), s.new_lift[l], (V, V_y), (ground, ground_y), pressed
        )
        more, heavier = (
            bulge(s, l, 0, ways_of(s)),
            pushed_by(s, l, s.diameter[l]) / s.one[l] * s.tan_a[l],
        )
        springs = s.axes > ways_of(s)
        heavier *= more / s.gravity[l] * s.moves[l]
        heavier += V_up / ((s.cap_beam_mass[l] + s.floors_mass[l] + 1e-300) * s.gravity[l])
        rises = found[4] + more > NEARLY * s.shear_top[l]
        rises |= found[5] + more > NEARLY * s.shear_bottom[l]
        more /= s.weigh[l] * s.diameter[l] * s.gravity[l] * s.columns_mass[l] * 0.5
        rises |= found[0] + more > NEARLY * s.friction_top[l]
        rises |= found[1] + more > NEARLY * s.friction_bottom[l]
        heavier -= UNSEEN if springs else 0.0
        rises |= found[3] - heavier < 1.0 - NEARLY * (1.0 - s.normal_bottom[l])
        rises |= found[3] + heavier > 1.0 + NEARLY * (s.heavy_bottom[l] - 1.0)
        rises |= found[2] - heavier < 1.0 - NEARLY * (1.0 - s.normal_top[l])
        rises |= stuck & ((s.friction_moment[l] > 0.0) | (g_up != s.gravity[l]) | springs)
        # A vibration upwards may turn just behind the end of the step before.
        near = s.contacts_near[l] > 0.0
        s.contacts_rise[l] = 1.0 if rises | (near & springs) else 0.0
        near = rises if s.accepted[l] > 0.0 else near
        s.contacts_near[l] = 1.0 if near else 0.0
    if ways_of(s) == 2:
        for l in range(lanes_of(s)):
            lever = torsion(s, l)
            s.torsion_lever[l] = max(s.torsion_lever[l], lever if s.accepted[l] > 0.0 else 0.0)


@inlined
def torsion(s: Record, l: int) -> float:
    """Torsion that prevents roll-out at the end of the step, over the weight: a length [m]."""
    tilt, rate = new_tilt_of(s, l), new_rate_of(s, l)
    x, n, t, p, q = polar(s, l, tilt, rate)
    at = place_with(s, l, x, s.w[l], s.dw[l])
    per_x = 1.0 / (x if x > 0.0 else 1.0)
    w, i_1, i_3 = q * per_x, s.io_1[l], s.i_3[l]
    faster = (s.new_bend[1, l] * n - s.new_bend[0, l] * t - 2.0 * p * w) * per_x
    c, p0, q0 = s.c[l], s.p[l], s.q0[l]
    # From B = p cos + q sin and C - c = p sin - q cos.
    size = p0 * p0 + q0 * q0 if s.bed_k[l] == 0.0 else 1.0
    sine, cosine = (q0 * at.B + p0 * (at.C - c)) / size, (p0 * at.B - q0 * (at.C - c)) / size
    turns = w * p
    l_1 = -i_1 * (faster * sine + 2.0 * turns * cosine) - turns * (i_3 * at.G)
    l_3 = -i_3 * (faster * at.G + turns * at.G_slope)
    tall, wide = c * cosine - q0, p0 + c * sine
    weight = s.cap_beam_mass[l] + s.floors_mass[l] + s.columns_mass[l]
    arm = 0.25 * s.diameter[l] * s.diameter[l] * s.columns_mass[l]
    lever = arm * abs(tall * l_3 - wide * l_1) / (at.C * weight * s.gravity[l])
    smooth = (s.moves[l] > 0.0) & (x > 0.0) & (s.bed_k[l] == 0.0)
    own = s.contact_time[l] * s.cone[l]
    smooth &= own * own * (rate[0] * rate[0] + rate[1] * rate[1]) <= x * x
    return lever if smooth else 0.0


@compiled
def force_within(s: Record, l: int, axis: int, t: float) -> float:
    """Force of springs and dampers under the floors a fraction t into the step [N]."""
    r, h = 1.0 - t, s.h[l]
    if s.axes == ways_of(s):
        V = r * r * (1.0 + 2.0 * t) * s.V[axis, l] + t * t * (3.0 - 2.0 * t) * s.new_V[axis, l]
        return V + h * t * r * (r * s.dV[axis, l] - t * s.new_dV[axis, l])  # type: ignore[no-any-return]
    V, slip = 0.0, 0.0
    for i in range(axis * s.n, (axis + 1) * s.n):
        q, dq = mode_within(s, i, l, axis, t)
        V += s.Gamma[i, l] * (s.omega2[i, l] * q + s.two_xi_omega[i, l] * dq)
        slip += s.slipping[i, l] * q
    if s.yields[l] > 0 and axis < ways_of(s):
        lowest, free = axis * s.n, 1.0 - s.hardening[l]
        if s.mark[lowest, l] == 0:
            slip = free * s.stiffness[lowest, l] * s.middle[lowest, l]
        V -= slip - free * s.mark[lowest, l] * s.strength[lowest, l]
    return V  # type: ignore[no-any-return]


@compiled
def measures_within(s: Record, l: int, t: float) -> tuple[float, Measures]:
    """Measures of contacts a fraction t into the step; first 0 if they are those of a shock.

    The tilt is on the quintic through both ends, the base shear on the cubic; what accelerates
    follows by the laws.
    """
    tilt, rate = tilt_within(s, l, t)
    now, up, time = polar(s, l, tilt, rate), ways_of(s), s.time[l] + t * s.h[l]
    V_x, V_y, V_up = force_within(s, l, 0, t), 0.0, 0.0
    if up == 2:
        V_y = force_within(s, l, 1, t)
    if s.axes > up:
        V_up = force_within(s, l, up, t)
    if s.devices[l] > 0:
        act(s, l, tilt, rate)
        if stands(s, l):
            push_at_rest(s, l, (V_x, V_y), time, V_up)
    w, dw = patch(s, l, now.x)
    found = respond(s, l, place_with(s, l, now.x, w, dw), w, now, (V_x, V_y, V_up), time)
    V = V_x + s.drive[0, l] + s.tied[l] * now.n, 0.0
    if up == 2:
        V = V[0], V_y + s.drive[1, l] + s.tied[l] * now.t
    stays, beam = without_shock(s, l, now.x, rate), (found.beam_x, found.beam_y)
    ground = found.a_x, found.a_y
    return stays, measures_of(s, l, stays, beam, found.lift, V, ground, (found.g_up, V_up))


@inlined
def tilt_within(s: Record, l: int, t: float) -> tuple[tuple[float, float], tuple[float, float]]:
    """The tilt and its rate a fraction t into the step, by quintics through both ends."""
    x = axis_path(s, l, 0)
    per_h = 1.0 / s.h[l] if s.h[l] > 0.0 else 0.0
    if ways_of(s) == 1:
        return (value(x, t), 0.0), (slope(x, t) * per_h, 0.0)
    y = axis_path(s, l, ways_of(s) - 1)
    return (value(x, t), value(y, t)), (slope(x, t) * per_h, slope(y, t) * per_h)


@inlined
def axis_path(s: Record, l: int, axis: int) -> tuple[float, float, float, float, float, float]:
    """The quintic of a component of the tilt over the step."""
    return quintic(
        s.h[l],
        s.tilt[axis, l],
        s.tilt_rate[axis, l],
        s.bend[axis, l],
        s.new_tilt[axis, l],
        s.new_tilt_rate[axis, l],
        s.new_bend[axis, l],
    )


@compiled
def raise_contacts(s: Record, l: int) -> None:
    """Raise the demands of contacts by those of the step just taken."""
    if s.h[l] <= 0.0:
        return
    parts = parts_of(s, l)
    third, end = measures_within(s, l, 0.0)
    raise_by(s, l, end)
    for part in range(parts):
        first, start = third, end
        second, middle = measures_within(s, l, (part + 0.5) / parts)
        third, end = measures_within(s, l, (part + 1.0) / parts)
        raise_by(s, l, middle)
        raise_by(s, l, end)
        if first * second * third == 0.0:
            continue
        turned = (
            turning_value(start[0], middle[0], end[0]),
            turning_value(start[1], middle[1], end[1]),
            turning_value(start[2], middle[2], end[2]),
            turning_value(start[3], middle[3], end[3]),
            turning_value(start[4], middle[4], end[4]),
            turning_value(start[5], middle[5], end[5]),
        )
        raise_by(s, l, turned)


@compiled
def raise_by(s: Record, l: int, found: Measures) -> None:
    """Raise the demands of contacts by those of an instant."""
    s.friction_top[l] = max(s.friction_top[l], abs(found[0]))
    s.friction_bottom[l] = max(s.friction_bottom[l], abs(found[1]))
    s.normal_top[l] = min(s.normal_top[l], found[2])
    s.heavy_top[l] = max(s.heavy_top[l], found[2])
    s.normal_bottom[l] = min(s.normal_bottom[l], found[3])
    s.heavy_bottom[l] = max(s.heavy_bottom[l], found[3])
    s.shear_top[l] = max(s.shear_top[l], abs(found[4]))
    s.shear_bottom[l] = max(s.shear_bottom[l], abs(found[5]))


@compiled
def is_held(s: Record, l: int) -> bool:
    """Whether a storey at rest is held: one that lifts off at once has not stood."""
    if ways_of(s) == 2 and s.phase[l] == STUCK:
        return bool(grip_at(s, l, 0).margin >= 0.0)
    R, size, g_felt = 0.5 * s.diameter[l], 0.0, felt_at(s, l, 0)[0]
    for axis in range(ways_of(s)):
        push = R * z_of(s, l, s.V[axis, l], ground_at(s, l, axis, s.time[l]))
        size = push if ways_of(s) == 1 else size + push * push
    right = s.limit_right[l] * g_felt + s.held_right[l]
    if ways_of(s) == 2:
        return bool(math.sqrt(size) <= right)
    left = s.limit_left[l] * g_felt + s.held_left[l]
    return bool(-left <= size <= right)


@compiled
def observe_start(s: Record, l: int) -> None:
    """Look at what begins anew, after an event or a sudden change of the ground."""
    h, time = s.h[l], s.time[l]
    tilt, rate = tilt_of(s, l), rate_of(s, l)
    now = polar(s, l, tilt, rate)
    a_x, g_up = ground_at(s, l, 0, time), g_up_at(s, l, time)
    V_x, V_y, a_y, beam_y = s.V[0, l], 0.0, 0.0, 0.0
    if ways_of(s) == 2:
        a_y = ground_at(s, l, 1, time)
        V_y, beam_y = s.V[1, l], s.shaking[1, l] - a_y
    if stands(s, l):
        push_at_rest(s, l, (V_x, V_y), time, s.V[ways_of(s), l])
    V_y += s.drive[1, l] if ways_of(s) == 2 else 0.0
    V = V_x + s.drive[0, l] + s.tied[l] * now.n, V_y + s.tied[l] * now.t
    if s.moves[l] > 0.0 or is_held(s, l):
        stays, beam = without_shock(s, l, now.x, rate), (s.shaking[0, l] - a_x, beam_y)
        up = g_up, s.V[ways_of(s), l]
        raise_by(s, l, measures_of(s, l, stays, beam, s.lift[l], V, (a_x, a_y), up))
    if s.devices[l] > 0:
        at = worked(s, l, tilt, rate)
        raise_devices(s, l, at, at, at)
    sums_at_start(s, l)
    s.h[l] = h


# The largest tilt, turning points between samples included, and the passage of theta_cr.


@compiled
def observe_tilt(s: Record, log: Record) -> None:
    """Raise the largest tilt and way of the beam by those of accepted steps."""
    for l in range(lanes_of(s)):
        x, end = s.new_x[l], s.interval[l] * s.dt[l] + (s.time[l] + s.h[l])
        higher = (s.accepted[l] > 0.0) & (x > s.max_theta[l])
        s.tilt_rises[l] = 1.0 if higher & (ways_of(s) == 2) else 0.0
        passing = (x > s.theta_cr[l]) & (s.critical_time[l] < 0.0)
        turning = (s.v[l] > 0.0) & (s.new_v[l] < 0.0)
        path = path_of(s, l)
        inside = turning & (max(upper_hull(path), path[0]) > s.max_theta[l])
        below = (s.bed_k[l] > 0.0) & (-min(lower_hull(path), path[0]) > s.max_theta[l])
        below &= ways_of(s) == 1
        closer = (s.accepted[l] > 0.0) & (passing | inside | below)
        s.tilt_rises[l] = 2.0 if closer else s.tilt_rises[l]
        s.max_theta_time[l] = (end if higher & (not closer) else s.max_theta_time[l]) + 0.0
        s.max_theta[l] = (x if higher & (not closer) else s.max_theta[l]) + 0.0
    for l in range(lanes_of(s)):
        if s.tilt_rises[l] > 1.0:
            raise_tilt(s, l, log)
        elif ways_of(s) == 2 and s.tilt_rises[l] > 0.0:
            s.max_azimuth[l] = math.atan2(s.new_tilt[ways_of(s) - 1, l], s.new_tilt[0, l])


@compiled
def raise_tilt(s: Record, l: int, log: Record) -> None:
    """Raise the largest tilt by that of the step just taken, to either side."""
    path = path_of(s, l)
    height, fraction = s.new_x[l], 1.0
    if s.v[l] > 0.0 and s.new_v[l] < 0.0 and upper_hull(path) > s.max_theta[l]:
        fraction, height = peak_in_step(path)
    bedded = ways_of(s) == 1 and s.bed_k[l] > 0.0
    if bedded and -min(lower_hull(path), path[0]) > s.max_theta[l]:
        over = (-path[0], -path[1], -path[2], -path[3], -path[4], -path[5])
        t, most = 1.0, -s.new_x[l]
        if s.v[l] < 0.0 < s.new_v[l]:
            t, most = peak_in_step(over)
        if most > height:
            fraction, height = t, most
    if height > s.max_theta[l]:
        s.max_theta[l] = height
        s.max_theta_time[l] = s.interval[l] * s.dt[l] + (s.time[l] + fraction * s.h[l])
        s.max_azimuth[l] = azimuth_within(s, l, fraction)
        if height > s.theta_cr[l] and s.critical_time[l] < 0.0:
            log_critical_passage(s, l, log, path)


@compiled
def azimuth_within(s: Record, l: int, t: float) -> float:
    """Azimuth of the tilt a fraction t into the step [rad]."""
    if ways_of(s) == 1:
        return 0.0
    tilt, _ = tilt_within(s, l, t)
    return math.atan2(tilt[1], tilt[0])


@compiled
def log_critical_passage(
    s: Record, l: int, log: Record, path: tuple[float, float, float, float, float, float]
) -> None:
    """Note when theta_cr was passed for the first time, within the step just taken."""
    level, h = s.theta_cr[l], s.h[l]
    t = min(first_descent(offset(path, -1.0, level), s.piece), 1.0)
    sign = s.side[l] if ways_of(s) == 1 else 1.0
    rate = sign * slope(path, t) / h if h > 0.0 else 0.0
    s.critical_time[l] = s.interval[l] * s.dt[l] + s.time[l] + t * h
    s.critical_azimuth[l] = azimuth_within(s, l, t)
    row = log_row(s, l, log, CRITICAL_PASSAGE)
    if row >= 0:
        entry = log[row]
        entry.time, entry.kind, entry.theta = s.critical_time[l], CRITICAL_PASSAGE, sign * level
        entry.theta_dot_before, entry.theta_dot_after, entry.energy_lost = rate, rate, 0.0
        entry.azimuth, entry.least_tilt = s.critical_azimuth[l], 0.0
        entry.nearness, entry.loss_share = 0.0, 0.0


@compiled
def observe_ways(s: Record) -> None:
    """Raise the beam's way in x and in y by those at the ends of accepted steps, and between."""
    for axis in range(ways_of(s)):
        for l in range(lanes_of(s)):
            u = path_at(s, l, s.new_x[l]) * s.diameter[l]
            way = abs(u * s.new_tilt[axis, l] / (s.new_x[l] if s.new_x[l] > 0.0 else 1.0))
            counts = (s.accepted[l] > 0.0) & (s.moves[l] > 0.0)
            s.max_beam[axis, l] = max(s.max_beam[axis, l], way if counts else 0.0)


# All of it.


@inlined
def observe(s: Record, systems: Record, log: Record, stands: bool) -> None:
    """Raise all demands by those of accepted steps; those of the tilt unless all lanes stand."""
    ways = ways_of(s)
    observe_floors(s)
    observe_contacts(s)
    if not stands:
        observe_tilt(s, log)
    if ways == 2 and not stands:
        observe_ways(s)
    for l in range(lanes_of(s)):
        if s.accepted[l] == 0.0 or s.history[l] == NO_HISTORY:
            continue
        if s.demands_rise[l] > 0.0 and s.n > 0:
            first = s.system[l]
            raise_floors(s, l, systems[first : first + ways])
        if s.contacts_rise[l] > 0.0:
            raise_contacts(s, l)
    if s.equipped > 0 and not stands:
        observe_devices(s)


@compiled
def observe_devices(s: Record) -> None:
    """Raise what devices see in accepted steps, and book what they dissipated."""
    lanes = lanes_of(s)
    for l in range(lanes):
        speed, end, least = s.speed[l], s.new_speed[l], NEARLY * s.device_velocity[0, l]
        path = cubic(s.h[l], speed * speed, s.square_rate[l], end * end, s.new_square_rate[l])
        rises = max(upper_hull(path), path[0]) > least * least
        # the force that does what rolling resistance does is larger the lower the path is
        low = s.new_height[l]
        rises |= (s.branched[l] > 0.0) | ((s.friction_moment[l] > 0.0) & (low < s.least_height[l]))
        counts = (s.accepted[l] > 0.0) & (s.moves[l] > 0.0) & (s.devices[l] > 0)
        s.devices_rise[l] = 1.0 if counts & rises else 0.0
        s.least_height[l] = low if counts & (low < s.least_height[l]) else s.least_height[l]
    for i in range(s.equipped):
        for l in range(lanes):
            counts = (s.accepted[l] > 0.0) & (s.moves[l] > 0.0) & (s.devices[l] > i)
            work = s.h[l] * power_in_step(s, l, i)
            s.device_energy[i, l] += work if counts else 0.0
    for l in range(lanes):
        if s.devices_rise[l] > 0.0:
            tilt, rate = tilt_within(s, l, 0.5)
            middle = worked(s, l, tilt, rate)
            tilt, rate = tilt_within(s, l, 1.0)
            start, end = worked(s, l, tilt_of(s, l), rate_of(s, l)), worked(s, l, tilt, rate)
            raise_devices(s, l, start, middle, end)
