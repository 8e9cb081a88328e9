"""Demands of a step on contacts, devices and floors, and how far it tilts.

The forces of contacts are compared with the largest so far at the ends of all steps, and
looked at within where they come near.
"""

from __future__ import annotations

import math
from typing import TypeAlias

from rpscli.physics.compile import compiled, inlined
from rpscli.physics.devices.acting import act, power_in_step
from rpscli.physics.devices.seen import raise_devices
from rpscli.physics.devices.worked import worked
from rpscli.physics.floors import observe_floors, raise_floors, sums_at_start
from rpscli.physics.friction import grip_at, is_gripped, push_at_rest
from rpscli.physics.lane import (
    Vector,
    contact_forces,
    felt_at,
    force_of,
    g_up_at,
    ground_of,
    lanes_of,
    new_rate_of,
    new_tilt_of,
    patch,
    place_with,
    polar,
    pushed_beam,
    pushed_by,
    rate_of,
    respond,
    resultant,
    stands,
    tilt_of,
    vector,
    ways_of,
    without_shock,
    z_at,
)
from rpscli.physics.largest_tilt import observe_tilt, observe_ways
from rpscli.physics.laws.place import across, length
from rpscli.physics.peaks import turning_value
from rpscli.physics.quintic import (
    cubic,
    upper_hull,
)
from rpscli.physics.state import (
    NO_HISTORY,
    STUCK,
    Record,
)
from rpscli.physics.within import bulge, mode_within, parts_of, tilt_within

UNSEEN = 1e-6
"""Of the weight: smaller changes of the floors' force on springs are ignored."""

NEARLY = 0.999
"""Steps that may pass this part of the largest force so far, with what the base shear may
be within them above their ends, are looked at within. As long as columns rock |F|/N
hardly leaves tan(alpha)."""


# Contacts.

Measures: TypeAlias = tuple[float, float, float, float, float, float]
"""|F|/N, N over the weight on it and |F|, each at the upper and at the lower ends."""


@inlined
def measures_of(
    s: Record,
    l: int,
    stays: float,
    beam: Vector,
    lift: float,
    V: Vector,
    ground: Vector,
    up: tuple[float, float],
) -> Measures:
    """Measures of contacts; where nothing stands on the columns their
    upper ends demand nothing.

    In a shock `stays` is 0, else 1: forces are those without it (13.19), and what
    friction they ask for says nothing.
    """
    lift *= stays
    x, low_x, N_top, N_bottom = contact_forces(
        s, l, stays * beam[0], lift, V[0], ground[0], up
    )
    y, low_y, _, _ = contact_forces(s, l, stays * beam[1], lift, V[1], ground[1], up)
    top = resultant(s, x, y)
    bottom = resultant(s, low_x, low_y)
    upper = s.cap_beam_mass[l] + s.floors_mass[l]
    lower = upper + s.columns_mass[l]
    loaded = upper > 0.0
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


@compiled
def observe_contacts(s: Record) -> None:
    """Say in `contacts_rise` where the forces of contacts at the
    ends come near the largest.

    In full contact without what friction dampers may take: the more.
    """
    for l in range(lanes_of(s)):
        rises = contacts_may_rise(s, l, measures_at_end(s, l))
        # A vibration upwards may turn just behind the end of the step before.
        near = s.contacts_near[l] > 0.0
        springs = s.axes > ways_of(s)
        s.contacts_rise[l] = 1.0 if rises | (near & springs) else 0.0
        near = rises if s.accepted[l] > 0.0 else near
        s.contacts_near[l] = 1.0 if near else 0.0


@inlined
def measures_at_end(s: Record, l: int) -> Measures:
    """Measures of contacts at the end of the step."""
    time = s.time[l] + s.h[l]
    ground = ground_of(s, l, time)
    shaking = vector(s, s.new_shaking, l)
    beam = shaking[0] - ground[0], shaking[1] - ground[1]
    rate = new_rate_of(s, l)
    now = polar(s, l, new_tilt_of(s, l), rate)
    stays = without_shock(s, l, now.x, rate)
    V = vector(s, s.new_V, l)
    drive = vector(s, s.drive, l)
    V_x = V[0] + drive[0]
    V_y = V[1] + drive[1]
    if s.equipped > 0:  # friction dampers push until all is what the columns hold
        stuck = s.phase[l] == STUCK
        V_x = force_of(s, l, s.held_x[l], ground[0]) if stuck else V_x
        V_y = force_of(s, l, s.held_y[l], ground[1]) if stuck else V_y
    V = V_x + s.tied[l] * now.n, V_y + s.tied[l] * now.t
    up = g_up_at(s, l, time), s.new_V[ways_of(s), l]
    return measures_of(s, l, stays, beam, s.new_lift[l], V, ground, up)


@inlined
def contacts_may_rise(s: Record, l: int, found: Measures) -> bool:
    """True if measures at the end of the step, and what they may be more
    within it, come near the largest.
    """
    springs = s.axes > ways_of(s)
    stuck = s.phase[l] == STUCK
    g_up = g_up_at(s, l, s.time[l] + s.h[l])
    V_up = bulge(s, l, ways_of(s), ways_of(s) + 1)
    more = bulge(s, l, 0, ways_of(s))
    heavier = pushed_by(s, l, s.diameter[l]) / s.one[l] * s.tan_a[l]
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
    return rises  # type: ignore[no-any-return]


@compiled
def observe_torsion(s: Record) -> None:
    """Raise the largest torsion by those at the ends of accepted steps."""
    for l in range(lanes_of(s)):
        lever = torsion(s, l)
        counts = s.accepted[l] > 0.0
        s.torsion_lever[l] = max(s.torsion_lever[l], lever if counts else 0.0)


@inlined
def torsion(s: Record, l: int) -> float:
    """Torsion that prevents roll-out at the end of the step, over
    the weight: a length [m].
    """
    tilt = new_tilt_of(s, l)
    rate = new_rate_of(s, l)
    x, n, t, p, q = polar(s, l, tilt, rate)
    at = place_with(s, l, x, s.w[l], s.dw[l])
    per_x = 1.0 / (x if x > 0.0 else 1.0)
    w = q * per_x
    i_1 = s.io_1[l]
    i_3 = s.i_3[l]
    bend = vector(s, s.new_bend, l)
    faster = (across(n, t, bend[0], bend[1]) - 2.0 * p * w) * per_x
    c = s.c[l]
    p0 = s.p[l]
    q0 = s.q0[l]
    # From B = p cos + q sin and C - c = p sin - q cos.
    size = p0 * p0 + q0 * q0 if s.bed_k[l] == 0.0 else 1.0
    sine = (q0 * at.B + p0 * (at.C - c)) / size
    cosine = (p0 * at.B - q0 * (at.C - c)) / size
    turns = w * p
    l_1 = -i_1 * (faster * sine + 2.0 * turns * cosine) - turns * (i_3 * at.G)
    l_3 = -i_3 * (faster * at.G + turns * at.G_slope)
    tall = c * cosine - q0
    wide = p0 + c * sine
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
    r = 1.0 - t
    h = s.h[l]
    if s.axes == ways_of(s):
        V = (
            r * r * (1.0 + 2.0 * t) * s.V[axis, l]
            + t * t * (3.0 - 2.0 * t) * s.new_V[axis, l]
        )
        return V + h * t * r * (r * s.dV[axis, l] - t * s.new_dV[axis, l])  # type: ignore[no-any-return]
    V = 0.0
    slip = 0.0
    for i in range(axis * s.n, (axis + 1) * s.n):
        q, dq = mode_within(s, i, l, axis, t)
        V += s.Gamma[i, l] * (s.omega2[i, l] * q + s.two_xi_omega[i, l] * dq)
        slip += s.slipping[i, l] * q
    if s.yields[l] > 0 and axis < ways_of(s):
        lowest = axis * s.n
        free = 1.0 - s.hardening[l]
        if s.mark[lowest, l] == 0:
            slip = free * s.stiffness[lowest, l] * s.middle[lowest, l]
        V -= slip - free * s.mark[lowest, l] * s.strength[lowest, l]
    return V  # type: ignore[no-any-return]


@compiled
def measures_within(s: Record, l: int, t: float) -> tuple[float, Measures]:
    """Measures of contacts a fraction t into the step; first 0 if
    they are those of a shock.

    The tilt is on the quintic through both ends, the base shear on the cubic; what
    accelerates follows by the laws.
    """
    tilt, rate = tilt_within(s, l, t)
    now = polar(s, l, tilt, rate)
    time = s.time[l] + t * s.h[l]
    V = shears_within(s, l, t)
    if s.devices[l] > 0:
        act(s, l, tilt, rate)
        if stands(s, l):
            push_at_rest(s, l, (V[0], V[1]), time, V[2])
    w, dw = patch(s, l, now.x)
    found = respond(s, l, place_with(s, l, now.x, w, dw), w, now, V, time)
    stays = without_shock(s, l, now.x, rate)
    beam = (found.beam_x, found.beam_y)
    ground = found.a_x, found.a_y
    up = found.g_up, V[2]
    pushed = pushed_beam(s, l, (V[0], V[1]), now)
    return stays, measures_of(s, l, stays, beam, found.lift, pushed, ground, up)


@inlined
def shears_within(s: Record, l: int, t: float) -> tuple[float, float, float]:
    """Base shears in x, in y and upwards a fraction t into the step [N]."""
    up = ways_of(s)
    V_x = force_within(s, l, 0, t)
    V_y = force_within(s, l, 1, t) if ways_of(s) == 2 else 0.0
    V_up = force_within(s, l, up, t) if s.axes > up else 0.0
    return V_x, V_y, V_up


@compiled
def raise_contacts(s: Record, l: int) -> None:
    """Raise the demands of contacts by those of the step just taken."""
    if s.h[l] <= 0.0:
        return
    parts = parts_of(s, l)
    third, end = measures_within(s, l, 0.0)
    raise_by(s, l, end)
    for part in range(parts):
        first = third
        start = end
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
    """True if a storey at rest is held: one that lifts off at once has not stood."""
    if is_gripped(s, l):
        return bool(grip_at(s, l, 0).margin >= 0.0)
    R = 0.5 * s.diameter[l]
    z, _ = z_at(s, l, 0)
    g_felt = felt_at(s, l, 0)[0]
    right = s.limit_right[l] * g_felt + s.held_right[l]
    if ways_of(s) == 2:
        return bool(length(R * z[0], R * z[1]) <= right)
    left = s.limit_left[l] * g_felt + s.held_left[l]
    return bool(-left <= R * z[0] <= right)


@compiled
def observe_start(s: Record, l: int) -> None:
    """Look at what begins anew, after an event or a sudden change of the ground."""
    h = s.h[l]
    time = s.time[l]
    tilt = tilt_of(s, l)
    rate = rate_of(s, l)
    now = polar(s, l, tilt, rate)
    ground = ground_of(s, l, time)
    V = vector(s, s.V, l)
    if stands(s, l):
        push_at_rest(s, l, V, time, s.V[ways_of(s), l])
    if s.moves[l] > 0.0 or is_held(s, l):
        stays = without_shock(s, l, now.x, rate)
        shaking = vector(s, s.shaking, l)
        beam = shaking[0] - ground[0], shaking[1] - ground[1]
        up = g_up_at(s, l, time), s.V[ways_of(s), l]
        pushed = pushed_beam(s, l, V, now)
        found = measures_of(s, l, stays, beam, s.lift[l], pushed, ground, up)
        raise_by(s, l, found)
    if s.devices[l] > 0:
        at = worked(s, l, tilt, rate)
        raise_devices(s, l, at, at, at)
    sums_at_start(s, l)
    s.h[l] = h


# All of it.


@inlined
def observe(s: Record, systems: Record, log: Record, stands: bool) -> None:
    """Raise all demands by those of accepted steps; those of the
    tilt unless all lanes stand.
    """
    ways = ways_of(s)
    observe_floors(s)
    observe_contacts(s)
    if not stands:
        observe_tilt(s, log)
    if ways == 2 and not stands:
        observe_ways(s)
        observe_torsion(s)
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
        speed = s.speed[l]
        end = s.new_speed[l]
        least = NEARLY * s.device_velocity[0, l]
        path = cubic(
            s.h[l], speed * speed, s.square_rate[l], end * end, s.new_square_rate[l]
        )
        rises = max(upper_hull(path), path[0]) > least * least
        # the force that does what rolling resistance does is larger the lower the path is
        low = s.new_height[l]
        rises |= (s.branched[l] > 0.0) | (
            (s.friction_moment[l] > 0.0) & (low < s.least_height[l])
        )
        counts = (s.accepted[l] > 0.0) & (s.moves[l] > 0.0) & (s.devices[l] > 0)
        s.devices_rise[l] = 1.0 if counts & rises else 0.0
        s.least_height[l] = (
            low if counts & (low < s.least_height[l]) else s.least_height[l]
        )
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
            start = worked(s, l, tilt_of(s, l), rate_of(s, l))
            end = worked(s, l, tilt, rate)
            raise_devices(s, l, start, middle, end)
