"""Near the upright position: uplift, impact or pass, and how a storey comes to rest.

In one plane a column goes over from one edge to the other: an impact (4.7). Of columns
that tilt to any side the motion becomes one on a cone: what passes near upright turns
its azimuth by pi/kappa in all, kappa = sqrt(K(0)/A(0)), however near. A real contact
takes a time t_c of its own. A pass whose own time x/|q| is short beside it loses what
an impact does and goes straight on; between the two stands a fit, the share l of that
loss (13.14) to (13.16).
"""

from __future__ import annotations

import math

from rpscli.physics.bed import enter_on_bed, first_phase, impact_number
from rpscli.physics.compile import compiled, own_law
from rpscli.physics.devices.acting import has_friction
from rpscli.physics.devices.stop import begin_excursion, take_up_stops
from rpscli.physics.energy import (
    RATES,
    Beam,
    beam_now,
    lift_at,
    lifted_mass,
    potential,
    relative_momentum,
    strain_energy,
    tilting_energy,
    total_energy,
)
from rpscli.physics.friction import force_at_rest, set_limits
from rpscli.physics.ground import log_event
from rpscli.physics.lane import (
    Polar,
    Vector,
    felt_at,
    place_of,
    polar,
    pushed_by,
    rate_of,
    set_vector,
    tilt_of,
    ways_of,
    z_at,
)
from rpscli.physics.laws.place import length, turned
from rpscli.physics.state import (
    BEDDED,
    FAILED_RESTITUTION,
    FULL_CONTACT,
    IMPACT,
    PASS,
    RECONTACT,
    ROLLING,
    STICKING,
    STUCK,
    UPLIFT,
    Record,
)
from rpscli.physics.step import renew

UPRIGHT_TILT = 5e-13
"""theta_c [rad]: what passes nearer is taken over by a map; below `uplift_tilt`."""

FIRST_STEP = 3e-5
"""Longest step at the start of such an uplift [s]."""

DIRECTIONLESS = 1e-12
KEEP_COMING = 8
"""Passes nearer to upright [rad] leave in a direction that no program
resolves: so many of them in a row are an accumulation, and become an uplift
begun anew along what pushes."""

SLOW = 20.0
"""A pass whose v^2 is below this times (|z| + limit) theta_c/A does not leave upright."""


@compiled
def enter_phase(s: Record, l: int, system: Record, phase: int) -> None:
    """Set the constants of a phase of motion and the range that the tilt has in it."""
    s.phase[l] = phase
    s.moves[l] = 0.0 if phase in (FULL_CONTACT, STUCK) else 1.0
    if phase == STUCK:
        return
    # those of a column that stands are those with which a tilt would begin
    rolls = phase == ROLLING or (phase == FULL_CONTACT and system.beta > 0.0)
    s.rolls[l] = 1.0 if rolls else 0.0
    constants = system.rolling if rolls else system.rocking
    s.p[l] = constants[0]
    s.q0[l] = constants[1]
    s.c[l] = constants[2]
    s.u0[l] = constants[3]
    s.v0[l] = constants[4]
    upright = 0.0
    if ways_of(s) == 2:
        upright = UPRIGHT_TILT if s.cone[l] > 0.0 else -1.0
    s.x_low[l] = max(system.beta, upright)
    s.x_high[l] = system.theta_limit
    if phase == ROLLING:
        s.x_low[l] = upright
        s.x_high[l] = min(system.beta, system.theta_limit)
    s.h_most[l] = 1.0 / system.step_rate
    enter_on_bed(s, l, system, phase)
    if phase == FULL_CONTACT:
        s.x[l] = 0.0
        s.v[l] = 0.0
        for axis in range(ways_of(s)):
            s.tilt[axis, l] = 0.0
            s.tilt_rate[axis, l] = 0.0
        set_limits(s, l)


@compiled
def move_floors(s: Record, l: int, before: Beam) -> None:
    """The cap beam has left way and velocity of `before` without the floors."""
    now = beam_now(s, l)
    for axis in range(s.axes):
        moved = now[axis] - before[axis]
        faster = now[RATES + axis] - before[RATES + axis]
        for r in range(axis * s.n, (axis + 1) * s.n):
            s.q[r, l] -= s.Gamma[r, l] * moved
            s.dq[r, l] -= s.Gamma[r, l] * faster


@compiled
def set_polar(
    s: Record, l: int, x: float, n: float, t: float, p: float, q: float
) -> None:
    """Set tilt and rate of a lane by x, the azimuth, x' and the rate across it."""
    s.x[l] = x
    s.v[l] = p
    rate = turned(n, t, p, q)
    set_vector(s, s.tilt, l, n * x, t * x)
    set_vector(s, s.tilt_rate, l, rate[0], rate[1])


@compiled
def change_rate(s: Record, l: int, system: Record, p: float, q: float) -> float:
    """Set x' and the rate across it; floors keep their velocities.
    Returns what is lost [J].
    """
    energy = total_energy(s, l, system)
    before = beam_now(s, l)
    x, n, t, _, _ = polar(s, l, tilt_of(s, l), rate_of(s, l))
    set_polar(s, l, x, n, t, p, q)
    move_floors(s, l, before)
    return float(energy - total_energy(s, l, system))


@compiled
def restitution_at(s: Record, l: int, system: Record, rate: float) -> float:
    """e at a rate of the tilt; what an own law gives outside of
    (0, 1] ends the history.
    """
    if system.impact_law == 0:
        return float(system.restitution)
    of = system.impact_constants
    tan_a = math.tan(system.alpha)
    eta = system.eta if s.spared[l] == 0.0 else 0.0  # floors on springs take no part
    given = (rate, tan_a, system.Io, system.gamma, eta, of[2], of[3], of[4], of[5])
    e = of[0] + of[1] * own_law(system.impact_law, given)
    if not 0.0 < e <= 1.0:
        s.outcome[l] = FAILED_RESTITUTION
    return float(e)


@compiled
def loss_share(nearness: float) -> float:
    """l(s): of what an impact loses, what a pass of s = theta_min/(|q| t_c) does (13.14).

    Fitted within .04 to passes of single columns on plastic contacts
    of t_c from 80 us to 8 ms.
    """
    if not nearness < 1e6:
        return 0.0
    return float(1.0 / (1.0 + 3.5 * nearness**1.04 + 2.0 * nearness**2.7))


@compiled
def pass_upright(s: Record, l: int, system: Record, log: Record, near: bool) -> None:
    """An impact of one plane, or a pass of free columns; `near`:
    by the map from theta_c.
    """
    if ways_of(s) == 1:
        impact(s, l, system, log)
        return
    now = polar(s, l, tilt_of(s, l), rate_of(s, l))
    x, n, t, p, q = now
    if not near and x <= 2.0 * system.uplift_tilt and abs(q) < x:
        set_polar(s, l, x, n, t, 0.0, q)
        return  # it has only begun to tilt, a little too early
    at = place_of(s, l, x)
    before = beam_now(s, l)
    strain = strain_energy(s, l)
    kappa = s.kappa[l]
    moving = tilting_energy(s, l, at, p, q)
    least = x
    speed = abs(q)
    if near:
        speed = math.sqrt(p * p + kappa * kappa * q * q) / kappa
        least = x * abs(q) / speed
    own = s.contact_time[l]
    nearness = math.inf if own == 0.0 else least / max(speed * own, 1e-300)
    share = loss_share(nearness)
    e = restitution_at(s, l, system, math.sqrt(p * p + q * q))
    left = 1.0 - share * (1.0 - e * e)
    keeps = math.sqrt(left)
    n, t = azimuth_behind(s, l, now, near, least, share)
    set_polar(s, l, x, n, t, max(-keeps * p, 0.0) if near else 0.0, keeps * q)
    move_floors(s, l, before)
    lost = (1.0 - left) * moving + strain - strain_energy(s, l)
    s.energy_lost[l] += lost
    s.energy_passes[l] += lost
    row = log_event(s, l, log, PASS, p, s.v[l], lost)
    if row >= 0:
        log[row].least_tilt = least
        log[row].nearness = nearness
        log[row].loss_share = share
    count_pass(s, l, system, least, speed, share)
    take_up_stops(s, l, log)


@compiled
def azimuth_behind(
    s: Record, l: int, now: Polar, near: bool, least: float, share: float
) -> Vector:
    """Cosine and sine of the azimuth towards which a pass goes on (13.14) to (13.16)."""
    kappa = s.kappa[l]
    sign = math.copysign(1.0, now.q)
    extra = math.pi / kappa - math.pi
    n = -now.n if near else now.n
    t = -now.t if near else now.t
    angle = 0.0
    if not near:
        angle = -sign * share * extra
    elif now.q != 0.0:
        inside = 2.0 * math.asin(min(1.0, least / now.x)) / kappa
        angle = sign * (extra * (1.0 - share) - inside)
    if angle == 0.0:
        return n, t
    return turned(math.cos(angle), math.sin(angle), n, t)


@compiled
def count_pass(
    s: Record, l: int, system: Record, least: float, speed: float, share: float
) -> None:
    """Keep how near a pass came, what it lost, and whether its direction is known."""
    s.closest_pass[l] = min(s.closest_pass[l], least / system.alpha)
    s.shortest_pass[l] = min(s.shortest_pass[l], least / max(speed, 1e-300))
    s.passes_as_impacts[l] += 1 if share > 0.5 else 0
    lost_direction = 0.0 < least < DIRECTIONLESS  # in a plane it is known
    s.directionless[l] = s.directionless[l] + 1 if lost_direction else 0


@compiled
def impact(s: Record, l: int, system: Record, log: Record) -> None:
    """From the edge on one side to the other (4.7); without a flat part
    the same motion goes on.

    theta'+ = e theta'-, and floors that move with the cap beam jump by -2 R cos(alpha) (1
    - e) theta'- (paper, Eq. 6); those that do not keep their own velocity.
    """
    if s.phase[l] != first_phase(system):
        enter_phase(s, l, system, first_phase(system))
    side = s.side[l]
    arriving = min(s.v[l], 0.0)
    if system.alpha == 0.0:
        s.side[l] = -side
        set_polar(s, l, 0.0, -side, 0.0, -arriving, 0.0)
        begin_excursion(s, l, log)
        return
    at = place_of(s, l, 0.0)
    rate = side * arriving
    arm = s.diameter[l] * at.C
    e = restitution_at(s, l, system, abs(rate))
    jump = -arm * (1.0 - e) * rate
    lost = tilting_energy(s, l, at, arriving, 0.0)
    if system.floors_jump > 0:
        momentum = relative_momentum(s, l, 0) + s.floors_mass[l] * (
            arm * rate + 0.5 * jump
        )
        lost -= jump * momentum
    else:
        for r in range(s.n):
            s.dq[r, l] -= s.Gamma[r, l] * jump
        for r in range(s.n, s.axes * s.n):
            s.dq[r, l] += s.Gamma[r, l] * (s.diameter[l] * at.B * (1.0 + e) * arriving)
    s.side[l] = -side
    leaving = -e * arriving
    set_polar(s, l, 0.0, -side, 0.0, leaving, 0.0)
    lost -= tilting_energy(s, l, at, leaving, 0.0)
    s.energy_lost[l] += lost
    if lost < 0.0:
        s.energy_created[l] -= lost
        s.creating_impacts[l] += 1
    row = log_event(s, l, log, IMPACT, arriving, leaving, lost)
    if row >= 0:  # before it the tilt was to the other side
        log[row].theta_dot_before = rate
    begin_excursion(s, l, log)


@compiled
def pushes(s: Record, l: int) -> tuple[float, float, float, float]:
    """z in x and y, its size, and its limit of a lane that would stand [1/s2]."""
    z, _ = z_at(s, l, 0)
    limit = s.tan_a[l] * felt_at(s, l, 0)[0] * s.weigh[l]
    limit += pushed_by(s, l, force_at_rest(s, l)[0])
    return z[0], z[1], length(z[0], z[1]), limit


@compiled
def settle(s: Record, l: int, system: Record, log: Record, near: bool) -> None:
    """After it: come to rest if it is that slow; what is too slow
    to get away starts anew.

    Impacts accumulate: each excursion is e^2 times as high as the last. At
    constant deceleration one reaches v^2/(2 |x''|). Reads the accelerations
    behind the impact or the pass.
    """
    low = system.recontact_tolerance * system.alpha
    x, _, _, p, q = polar(s, l, tilt_of(s, l), rate_of(s, l))
    at = place_of(s, l, x)
    if ways_of(s) == 1:
        if s.a[l] < 0.0 and p * p < 2.0 * abs(s.a[l]) * low:
            come_to_rest(s, l, system, log)
        return
    z_x, z_y, push, limit = pushes(s, l)
    v2 = p * p + (s.kappa[l] * q) * (s.kappa[l] * q)
    slow = v2 < SLOW * (push + limit) * UPRIGHT_TILT / at.A
    accumulates = s.directionless[l] >= KEEP_COMING
    if near and push >= limit and (slow or accumulates):
        s.accumulations[l] += 1
        s.directionless[l] = 0
        begin_tilt(s, l, system, z_x, z_y)
        renew(s, l)
        return
    slows = math.cos(system.alpha) * (limit - push) / at.A
    if slows > 0.0 and v2 < 2.0 * slows * low and x < low:
        come_to_rest(s, l, system, log)


@compiled
def bounces_left_out(s: Record, l: int, system: Record) -> float:
    """Velocity that the bounces left out add to that of the floors, over u_b' (3.5).

    Floors that do not jump keep theirs: the beam stops. Friction lets the beam come back
    with k of the rate with which it left: k = 1 without it, 0 if it holds the beam where
    it turns (11.17), (11.18).
    """
    friction = s.friction_force[l] + s.friction_moment[l]
    if system.floors_jump == 0:
        return 1.0
    k = 1.0
    if friction > 0.0:
        at = place_of(s, l, 0.0)
        moment = at.C * s.friction_force[l] + s.friction_moment[l] / s.diameter[l]
        slowed = pushed_by(s, l, moment) / at.A
        k = math.sqrt(max(0.0, 1.0 + 2.0 * slowed / s.a[l]))
    return float((1.0 + k) / (1.0 + system.restitution * k))


@compiled
def come_to_rest(s: Record, l: int, system: Record, log: Record) -> None:
    """Full contact from now on.

    The floors lose the cap beam's velocity u_b' and would keep the relative one; the
    bounces that are left out change it by a multiple of u_b' (3.5). What they lose of
    u_b' is lost: the mean of both velocities times the change.
    """
    x, _, _, p, q = polar(s, l, tilt_of(s, l), rate_of(s, l))
    before = beam_now(s, l)
    strain = strain_energy(s, l)
    kept = bounces_left_out(s, l, system)
    # What stops and tendons hold at so small a tilt is theirs, and given back.
    held = force_at_rest(s, l)[0] * s.diameter[l] * math.cos(system.alpha) * x
    lost = tilting_energy(s, l, place_of(s, l, x), p, q) + held
    lost += lifted_mass(s, l) * s.gravity[l] * lift_at(s, l, x)
    for axis in range(s.axes):
        u = before[RATES + axis]
        carried = (
            relative_momentum(s, l, axis) + 0.5 * (1.0 + kept) * s.floors_mass[l] * u
        )
        lost += (1.0 - kept) * u * carried
        for r in range(axis * s.n, (axis + 1) * s.n):
            s.q[r, l] += s.Gamma[r, l] * before[axis]
            s.dq[r, l] += s.Gamma[r, l] * (kept * u)
    lost += strain - strain_energy(s, l)
    s.energy_lost[l] += lost
    row = log_event(s, l, log, RECONTACT, p, 0.0, lost)
    if row >= 0:
        log[row].theta = 0.0
    enter_phase(s, l, system, FULL_CONTACT)
    renew(s, l)


@compiled
def begin_tilt(s: Record, l: int, system: Record, z_x: float, z_y: float) -> None:
    """Tilt to any side along z, at rest, by `uplift_tilt`; the work of that is booked."""
    size = length(z_x, z_y)
    if size == 0.0:  # what falls freely may tilt to any side
        z_x = 1.0
        size = 1.0
    strain = strain_energy(s, l)
    lifted = 0.0
    start = system.uplift_tilt
    rise = start
    before = beam_now(s, l)
    if s.phase[l] != FULL_CONTACT:
        x, _, _, p, q = polar(s, l, tilt_of(s, l), rate_of(s, l))
        rise -= x
        lifted = potential(s, l, system, x) + tilting_energy(
            s, l, place_of(s, l, x), p, q
        )
    else:
        lifted = potential(s, l, system, 0.0)
    enter_phase(s, l, system, first_phase(system))
    arm = s.diameter[l] * math.cos(system.alpha)
    rate = 2.0 * s.stop_speed[l] / arm if has_friction(s, l) else 0.0
    set_polar(s, l, start, z_x / size, z_y / size, rate, 0.0)
    move_floors(s, l, before)
    moving = tilting_energy(s, l, place_of(s, l, start), rate, 0.0)
    s.energy_input[l] += potential(s, l, system, start) - lifted + moving
    s.energy_input[l] += strain_energy(s, l) - strain
    s.energy_input[l] += force_at_rest(s, l)[0] * arm * rise
    s.h_limit[l] = FIRST_STEP


@compiled
def keep_growing(s: Record, l: int, out: float) -> None:
    """In one plane x'' is zero at the threshold but for rounding, and about
    to grow, or (-1) to fall.
    """
    if ways_of(s) == 1:
        s.a[l] = out * max(out * s.a[l], 0.0)
        s.bend[0, l] = s.side[l] * s.a[l]


@compiled
def uplift(s: Record, l: int, system: Record, log: Record, side: int) -> None:
    """Leave full contact along z, in one plane to a side."""
    renew(s, l)
    if ways_of(s) == 1:
        s.side[l] = float(side)
        enter_phase(s, l, system, first_phase(system))
        set_polar(s, l, 0.0, s.side[l], 0.0, 0.0, 0.0)
    else:
        z_x, z_y, _, _ = pushes(s, l)
        begin_tilt(s, l, system, z_x, z_y)
    row = log_event(s, l, log, UPLIFT, 0.0, 0.0, 0.0)
    if row >= 0:
        log[row].theta = 0.0
    begin_excursion(s, l, log)
    renew(s, l)
    keep_growing(s, l, 1.0)


@compiled
def pass_on_bed(s: Record, l: int, system: Record, log: Record, enters: bool) -> None:
    """Uplift from a bed, or contact with it again; floors keep their velocities.

    Going outwards x' changes by j, inwards by e/j, and what goes
    round by e (13.21), (13.22).
    """
    if s.x[l] < 0.0:  # over to the other side
        s.side[l] = -s.side[l]
        s.direction[l] = -s.direction[l]
        s.v[l] = -s.v[l]
    _, n, t, p, q = polar(s, l, tilt_of(s, l), rate_of(s, l))
    change = system.lifts
    keeps = 1.0
    lost = 0.0
    u = system.bed_uplift
    set_polar(s, l, u, n, t, p, q)
    before = beam_now(s, l)
    if enters:
        keeps = restitution_at(s, l, system, math.sqrt(p * p + q * q))
        change = keeps / change
        lost = (1.0 - keeps * keeps) * tilting_energy(s, l, place_of(s, l, u), p, q)
        chi = impact_number(system, math.sqrt(p * p + q * q))
        s.impact_number[l] = max(s.impact_number[l], chi)
    set_polar(s, l, u, n, t, change * p, keeps * q)
    enter_phase(s, l, system, BEDDED if enters else first_phase(system))
    move_floors(s, l, before)
    s.energy_lost[l] += lost
    log_event(s, l, log, IMPACT if enters else UPLIFT, p, s.v[l], lost)
    renew(s, l)
    if ways_of(s) == 1:
        hold_between(s, l, system, log)
    else:
        keep_apart(s, l, system)


NEAREST_RETURN = 1e-4
"""Of phi_u: what would come back from less far, and may go round, is sent so far."""


@compiled
def keep_apart(s: Record, l: int, system: Record) -> None:
    """Let a slow storey leave phi_u a little where the bed pushes out
    and lifted ends turn back.

    It goes to and fro there until either lets it go.
    """
    outwards = 1.0 if s.phase[l] != BEDDED else -1.0
    least = 2.0 * abs(s.a[l]) * NEAREST_RETURN * system.bed_uplift
    _, _, _, p, q = polar(s, l, tilt_of(s, l), rate_of(s, l))
    if outwards * s.a[l] >= 0.0 or p * p >= least:
        return
    s.energy_lost[l] += change_rate(s, l, system, outwards * math.sqrt(least), q)
    renew(s, l)


HELD = 1e-6
"""Of phi_u: what would come back from less far is held there."""


@compiled
def hold_between(s: Record, l: int, system: Record, log: Record) -> None:
    """Hold a slow storey at phi_u where the bed pushes out and lifted ends turn back."""
    phase = s.phase[l]
    side = s.side[l]
    v = s.v[l]
    a = s.a[l]
    outwards = 1.0 if phase != BEDDED else -1.0
    if not (outwards * a < 0.0 and v * v < 2.0 * abs(a) * HELD * system.bed_uplift):
        return
    moving = total_energy(s, l, system)
    before = beam_now(s, l)
    enter_phase(s, l, system, first_phase(system) if phase == BEDDED else BEDDED)
    renew(s, l)
    if outwards * s.a[l] < 0.0:  # it goes on there
        enter_phase(s, l, system, phase)
        renew(s, l)
        return
    enter_phase(s, l, system, first_phase(system))
    set_polar(s, l, system.bed_uplift, side, 0.0, 0.0, 0.0)
    move_floors(s, l, before)
    lost = moving - total_energy(s, l, system)
    s.energy_lost[l] += lost
    log_event(s, l, log, STICKING, v, 0.0, lost)
    s.bed_back[l] = system.bed_k * system.bed_uplift / system.bed_height
    enter_phase(s, l, system, STUCK)
    set_limits(s, l)
    renew(s, l)
