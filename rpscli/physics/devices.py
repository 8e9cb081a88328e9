"""Devices of the rocking storey: what they do, and where their laws change (section 11).

Dampers and stops push the cap beam, a tendon pulls both ends of its column together, rolling
resistance turns the columns back. Which branch of its law a device follows is part of the state, so
that all is smooth within a step; a law changes where a watched value falls below zero. A new law is
its force and its power in `drag_of` and `power_of`, what it watches in `watched` and
`change_law`, and where it has any, its constants in `load_devices`, its energy in `stored_in`.

Friction in one plane has the sign of `direction`. Where the tilt may have any azimuth it acts along
the velocity, which seldom is zero: what comes to a stop is held, or turns at once to where it is
pushed (13.25).
"""

from __future__ import annotations

import math
from typing import NamedTuple

from rpscli.physics.compile import compiled, inlined, own_law
from rpscli.physics.energy import path_at
from rpscli.physics.ground import log_event
from rpscli.physics.lane import (
    Polar,
    lanes_of,
    new_rate_of,
    new_tilt_of,
    place_of,
    place_with,
    polar,
    pushed_by,
    rate_of,
    stands,
    tilt_of,
    turned,
    ways_of,
)
from rpscli.physics.laws.geometry import end_displacement
from rpscli.physics.laws.place import Place, length
from rpscli.physics.peaks import peak
from rpscli.physics.state import (
    BEYOND,
    DAMPER_COEFFICIENT,
    DAMPER_EXPONENT,
    FRICTION,
    FRICTION_FORCE,
    FULL_CONTACT,
    IDLE,
    OWN,
    ROLLING_MOMENT,
    ROLLING_RESISTANCE,
    SLOTS,
    STOP,
    STOP_DAMPING,
    STOP_GAP,
    STOP_LEFT,
    STOP_MET,
    STOP_STIFFNESS,
    TENDON,
    TENDON_PRESTRESS,
    TENDON_SLACK,
    TENDON_STIFFNESS,
    TENDON_TAUT,
    TENDON_YIELD,
    TENDON_YIELDING,
    VISCOUS,
    WORKING,
    Floats,
    Record,
)


class Worked(NamedTuple):
    """How the devices of a lane are worked at a motion."""

    tilt: Polar
    path: float  # |u_b| [m]
    along: float  # u_b' along the tilt and across it [m/s]
    across: float
    C: float  # height of the cap beam's path, over R
    e: float  # elongation of a tendon [m], de/dx, and the angle psi of its end from the vertical
    lever: float
    sin_psi: float
    cos_psi: float


@compiled
def worked(s: Record, l: int, tilt: tuple[float, float], rate: tuple[float, float]) -> Worked:
    """How devices are worked at a tilt and its rate."""
    now, diameter = polar(s, l, tilt, rate), s.diameter[l]
    if s.phase[l] == FULL_CONTACT:
        still = Polar(0.0, now.n, now.t, 0.0, 0.0)
        return Worked(still, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
    at = place_with(s, l, now.x, 0.0, 0.0)  # C and h know of no patch
    e, lever, sin_psi, cos_psi = 0.0, 0.0, 0.0, 1.0
    if s.tendons[l] > 0:
        e, lever, sin_psi, cos_psi = tendon_elongation(s, l, now.x)
    out, aside = diameter * at.C * now.p, diameter * at.h * now.q
    path = diameter * path_at(s, l, now.x)
    return Worked(now, path, out, aside, at.C, e, lever, sin_psi, cos_psi)


@compiled
def tendon_elongation(s: Record, l: int, x: float) -> tuple[float, float, float, float]:
    """Elongation e of a tendon, de/dx, and sine and cosine of psi, at a tilt x (11.7) to (11.10).

    The middle of either end moves by (M_1, M_2) from where it stood; with E its distance from there
    a tendon is longer by e = 2 E. Seen from the contact, which lies B + r x from that place along
    the ground while rolling and B + r beta while rocking, de/dx = 2 cos(psi) times that distance.
    """
    y = x if s.rolls[l] > 0.0 else s.beta[l]
    half_sine, half_sine_y = math.sin(0.5 * x), math.sin(0.5 * y)
    across, upwards, reach = end_displacement(
        s.half_width[l],
        s.arc_radius[l],
        (y, math.sin(y), 2.0 * (half_sine_y * half_sine_y)),
        (math.sin(x), 2.0 * (half_sine * half_sine)),
    )
    distance = math.sqrt(across * across + upwards * upwards)
    if x < 0.0:  # on from upright as it came there, where a step may try
        distance = -distance
    sin_psi, cos_psi = 0.0, 1.0
    if distance != 0.0:
        sin_psi, cos_psi = across / distance, upwards / distance
    return 2.0 * distance, 2.0 * cos_psi * reach, sin_psi, cos_psi


@compiled
def tension(s: Record, l: int, i: int, e: float) -> float:
    """Tension of one tendon of a device that is one [N], at its elongation [m]; else 0."""
    if s.device_kind[i, l] != TENDON or s.branch[i, l] == IDLE:
        return 0.0
    if s.branch[i, l] == WORKING:
        stretch = e - s.permanent[i, l]
        return float(s.law[i, TENDON_PRESTRESS, l] + s.law[i, TENDON_STIFFNESS, l] * stretch)
    return float(s.law[i, TENDON_YIELD, l])


@compiled
def own(s: Record, l: int, i: int, which: int, path: float, speed: float) -> float:
    """Force (0) or watched value (1) of a law of another package."""
    of = s.law
    u, v = max(path, 0.0), max(speed, 0.0)  # a step may try what is beyond upright
    given = (u, v, of[i, 0, l], of[i, 1, l], of[i, 2, l], of[i, 3, l], 0.0, 0.0, 0.0)
    return own_law(s.own_law[i, which, l], given)


# Linear dampers, friction and rolling resistance are sums of a lane, and lanes act together. What
# has branches or powers is looked at device by device.


@inlined
def is_branched(s: Record, l: int, i: int) -> bool:
    """Whether the law of a device has branches or powers."""
    kind = s.device_kind[i, l]
    branched = (kind == VISCOUS) & (s.law[i, DAMPER_EXPONENT, l] != 1.0)
    return branched | (kind == STOP) | (kind == TENDON) | (kind == OWN)  # type: ignore[no-any-return]


@compiled
def drag_of(s: Record, l: int, i: int, path: float, speed: float) -> float:
    """Resistance over |u_b'| of dampers with an exponent and of own laws; else 0 [N s/m]."""
    if s.device_kind[i, l] == OWN:
        return own(s, l, i, 0, path, speed) / max(speed, 1e-150)
    if s.device_kind[i, l] != VISCOUS:
        return 0.0
    exponent = s.law[i, DAMPER_EXPONENT, l] - 1.0
    return float(s.law[i, DAMPER_COEFFICIENT, l] * max(speed, s.linear_speed[l]) ** exponent)


@compiled
def stop_force(s: Record, l: int, i: int, path: float, along: float) -> float:
    """Resistance of a stop that is met, along the tilt; else 0 [N]."""
    if s.device_kind[i, l] != STOP or s.branch[i, l] != WORKING:
        return 0.0
    beyond = path - s.law[i, STOP_GAP, l]
    return float(s.law[i, STOP_STIFFNESS, l] * beyond + s.law[i, STOP_DAMPING, l] * along)


@compiled
def power_of(s: Record, l: int, i: int, at: Worked) -> float:
    """What such a device dissipates [W]."""
    kind, branch = s.device_kind[i, l], s.branch[i, l]
    if kind == STOP and branch == WORKING:
        return float(s.law[i, STOP_DAMPING, l] * (at.along * at.along))
    if kind == STOP and branch == BEYOND:  # it recovers by itself
        beyond = at.path - s.law[i, STOP_GAP, l]
        return float(-s.law[i, STOP_STIFFNESS, l] * beyond * at.along)
    if kind == TENDON and branch == BEYOND:
        return float(s.columns[l] * s.law[i, TENDON_YIELD, l] * at.lever * at.tilt.p)
    speed = math.sqrt(at.along * at.along + at.across * at.across)
    return drag_of(s, l, i, at.path, speed) * (speed * speed)


@inlined
def paces(s: Record, l: int, at: Place, tilt: Polar) -> tuple[float, float, float, float, float]:
    """u_b' along the tilt, across it, and its size [m/s]; rates against which friction acts.

    These are of dampers [m/s] and of rolling resistance [rad/s]; in one plane they have the sign of
    `direction`.
    """
    out, aside = s.diameter[l] * at.C * tilt.p, s.diameter[l] * at.h * tilt.q
    if ways_of(s) == 1:
        return out, 0.0, abs(out), s.direction[l] * out, s.direction[l] * tilt.p
    speed = length(out, aside)
    return out, aside, speed, speed, length(tilt.p, tilt.q)


@inlined
def push(s: Record, l: int, at: Place, tilt: Polar) -> None:
    """Write what the devices of a lane do at a place and rate: `drive` and `turning`."""
    u_out, u_aside, speed, _, swing = paces(s, l, at, tilt)
    drag, resisting, moves = s.drag_branched[l] + s.viscous[l], s.stop_force[l], s.moves[l] > 0.0
    rolls, aside_rolls = s.direction[l] * s.friction_moment[l], 0.0
    if ways_of(s) == 1:
        resisting += s.direction[l] * s.friction_force[l]
    else:
        drag += s.friction_force[l] / max(speed, 1e-150)
        per_rate = s.friction_moment[l] / max(swing, 1e-300)
        rolls, aside_rolls = per_rate * tilt.p, per_rate * tilt.q
    moment, diameter = s.tendon_moment[l] + rolls, s.diameter[l]
    s.turning[l] = -pushed_by(s, l, moment) / diameter if moves else 0.0
    s.turning_across[l] = -pushed_by(s, l, aside_rolls) / diameter if moves else 0.0
    push_x, push_y = turned(tilt, -(drag * u_out + resisting), -drag * u_aside)
    s.drive[0, l] = push_x if moves else 0.0
    if ways_of(s) == 2:
        s.drive[1, l] = push_y if moves else 0.0


@compiled
def act_branched(s: Record, l: int, at: Worked) -> None:
    """Write the sums of what has branches or powers, and of tendons `tied` and `pull`."""
    speed = math.sqrt(at.along * at.along + at.across * at.across)
    drag, resisting, tense = 0.0, 0.0, 0.0
    for i in range(s.devices[l]):
        if is_branched(s, l, i):
            drag += drag_of(s, l, i, at.path, speed)
            resisting += stop_force(s, l, i, at.path, at.along)
            tense += s.columns[l] * tension(s, l, i, at.e)
    s.drag_branched[l], s.stop_force[l], s.tendon_moment[l] = drag, resisting, tense * at.lever
    s.tied[l], s.pull[l] = -tense * at.sin_psi, tense * at.cos_psi


@compiled
def act(s: Record, l: int, tilt: tuple[float, float], rate: tuple[float, float]) -> None:
    """Write what all devices of a lane do at a tilt and its rate."""
    if s.branched[l] > 0.0:
        act_branched(s, l, worked(s, l, tilt, rate))
    now = polar(s, l, tilt, rate)
    push(s, l, place_with(s, l, now.x, 0.0, 0.0), now)


@inlined
def add_work(s: Record, l: int, at: Place, tilt: Polar, weight: float) -> float:
    """Add what flows at an instant to the means of the step; |u_b'| [m/s]."""
    _, _, speed, pace, swing = paces(s, l, at, tilt)
    s.mean_square[l] += weight * (speed * speed)
    s.mean_pace[l] += weight * pace
    s.mean_swing[l] += weight * swing
    return speed


@compiled
def begin_work(s: Record, weight: float) -> None:
    """Begin the means of the step with what is worked at its start."""
    for l in range(lanes_of(s)):
        now = polar(s, l, tilt_of(s, l), rate_of(s, l))
        s.mean_square[l], s.mean_pace[l], s.mean_swing[l] = 0.0, 0.0, 0.0
        add_work(s, l, place_with(s, l, now.x, 0.0, 0.0), now, weight)
    for l in range(lanes_of(s)):
        if s.branched[l] > 0.0:
            at = worked(s, l, tilt_of(s, l), rate_of(s, l))
            for i in range(s.devices[l]):
                s.device_work[i, l] = weight * power_of(s, l, i, at)


@compiled
def act_branched_at_stage(s: Record, weight: float) -> None:
    """`act_branched` at a stage of the step, in all lanes that have such; adds to their work."""
    for l in range(lanes_of(s)):
        if s.branched[l] > 0.0:
            at = worked(s, l, new_tilt_of(s, l), new_rate_of(s, l))
            act_branched(s, l, at)
            for i in range(s.devices[l]):
                s.device_work[i, l] += weight * power_of(s, l, i, at)


@inlined
def power_in_step(s: Record, l: int, i: int) -> float:
    """Mean of what a device dissipated in the step just taken [W]."""
    kind, constant = s.device_kind[i, l], s.law[i, 0, l]
    mean = s.mean_square[l] if kind == VISCOUS else 0.0
    mean = s.mean_pace[l] if kind == FRICTION else mean
    mean = s.mean_swing[l] if kind == ROLLING_RESISTANCE else mean
    return s.device_work[i, l] if is_branched(s, l, i) else constant * mean  # type: ignore[no-any-return]


# Loading, beginning an excursion, being held.


STOP_SPEED = 5e-3
"""Of that at which sliding begins: what slides more slowly to any side is stopped, or turned to
where it is pushed. A step may err by a fiftieth of it, however slow the motion is."""

STOP_SPEED_OF_PASSES, SLOW_RATE = 1e-9, 1e-3
"""Of sqrt(g R), and of sqrt(g/R): the same of rigid ends. What passes upright asks for velocities
in proportion, except where it tilts more slowly than this."""


@inlined
def has_friction(s: Record, l: int) -> bool:
    """Whether something holds the tilt at rest."""
    return s.friction_force[l] + s.friction_moment[l] > 0.0  # type: ignore[no-any-return]


@compiled
def load_devices(s: Record, l: int, system: Record) -> None:
    """Begin a history with its devices as they are at rest and upright."""
    s.devices[l], s.columns[l], s.tendons[l] = system.devices, system.columns, 0
    s.linear_speed[l], s.direction[l] = system.linear_speed, 1.0
    s.viscous[l], s.friction_force[l], s.friction_moment[l], s.kinks[l] = 0.0, 0.0, 0.0, 0.0
    s.turning[l], s.turning_across[l], s.tied[l], s.pull[l] = 0.0, 0.0, 0.0, 0.0
    s.branched[l], s.drag_branched[l], s.stop_force[l], s.tendon_moment[l] = 0.0, 0.0, 0.0, 0.0
    s.least_height[l] = math.inf
    s.start_speed[l] = system.start_speed
    for axis in range(ways_of(s)):
        s.drive[axis, l] = 0.0
    for i in range(system.devices):
        load_device(s, l, i, system)
    s.stop_speed[l] = STOP_SPEED * system.start_speed
    error = 0.02 * s.stop_speed[l] / s.diameter[l]
    if system.alpha > 0.0 and system.compliant == 0:
        s.stop_speed[l] = STOP_SPEED_OF_PASSES * math.sqrt(system.gravity * system.R)
        error = system.step_error * SLOW_RATE * math.sqrt(system.gravity / system.R)
    s.least_error[l] = error if ways_of(s) == 2 and has_friction(s, l) else 0.0


@compiled
def load_device(s: Record, l: int, i: int, system: Record) -> None:
    """Begin with one of them."""
    kind, of = system.device_kind[i], system.device_constants[i]
    s.device_kind[i, l], s.branch[i, l], s.permanent[i, l] = kind, IDLE, 0.0
    s.device_force[i, l], s.device_velocity[i, l], s.device_energy[i, l] = 0.0, 0.0, 0.0
    for k in range(4):
        s.law[i, k, l] = of[k]
    for k in range(2):
        s.own_law[i, k, l] = system.own_law[i, k]
    branched, turns = (
        is_branched(s, l, i),
        ways_of(s) == 2 and kind in (FRICTION, ROLLING_RESISTANCE),
    )
    if branched:
        s.branched[l] = 1.0
    if turns or (branched and kind == VISCOUS) or system.own_law[i, 2] == 1:
        s.kinks[l] = 1.0
    if kind == VISCOUS and not branched:
        s.viscous[l] += of[DAMPER_COEFFICIENT]
    elif kind == FRICTION:
        s.friction_force[l] += of[FRICTION_FORCE]
    elif kind == ROLLING_RESISTANCE:
        s.friction_moment[l] += of[ROLLING_MOMENT]
    elif kind == TENDON:
        s.tendons[l] += 1
        s.branch[i, l], s.device_force[i, l] = WORKING, of[TENDON_PRESTRESS]
        s.pull[l] += system.columns * of[TENDON_PRESTRESS]


@compiled
def begin_excursion(s: Record, l: int, log: Record) -> None:
    """Leave x = 0: friction acts against growing tilts, and a stop without a gap is met at once."""
    s.direction[l] = 1.0
    for i in range(s.devices[l]):
        if s.device_kind[i, l] == STOP:
            s.branch[i, l] = IDLE
            if s.law[i, STOP_GAP, l] == 0.0:
                s.branch[i, l] = WORKING
                log_event(s, l, log, STOP_MET, s.v[l], s.v[l], 0.0)


@compiled
def release_devices(s: Record, l: int) -> None:
    """Be held at a tilt: stops push, and tendons that cannot hold it have yielded."""
    at = worked(s, l, tilt_of(s, l), (0.0, 0.0))
    for i in range(s.devices[l]):
        kind = s.device_kind[i, l]
        if kind == STOP and at.path > s.law[i, STOP_GAP, l]:
            s.branch[i, l] = WORKING
        elif kind == TENDON and tension(s, l, i, at.e) > s.law[i, TENDON_YIELD, l]:
            s.branch[i, l] = BEYOND
    reset_yielded_tendons(s, l)
    find_branches(s, l)


UNLOADED = 1e-12
"""Share of its limit by which a tendon that yielded is below it once the tilt turns: a margin of
zero could be negative by rounding at the end of a short step, and the tendon yield on the way back.
"""


@compiled
def reset_yielded_tendons(s: Record, l: int) -> None:
    """Tendons that yielded are elastic again, longer by what they yielded."""
    for i in range(s.devices[l]):
        if s.device_kind[i, l] == TENDON and s.branch[i, l] == BEYOND:
            e = worked(s, l, tilt_of(s, l), (0.0, 0.0)).e
            limit = s.law[i, TENDON_YIELD, l] * (1.0 - UNLOADED)
            until_yield = limit - s.law[i, TENDON_PRESTRESS, l]
            s.permanent[i, l] = e - until_yield / s.law[i, TENDON_STIFFNESS, l]
            s.branch[i, l] = WORKING


# Where laws change.


SLOWING = 1 + 2 * SLOTS
WATCHED = SLOWING + 1
"""Numbers of watched values."""


@inlined
def may_be_watched(s: Record, l: int, which: int) -> bool:
    """Whether a number is one of a device that is there, or of the tilt."""
    return which in (0, SLOWING) or (which - 1) % SLOTS < s.devices[l]


@inlined
def slowing(s: Record, l: int, end: int) -> tuple[float, float]:
    """What falls below zero where friction stops a tilt, and its slope.

    In one plane the rate in the direction of friction; to any side |u_b'|^2 over that of a stop.
    """
    if ways_of(s) == 1:
        p, a = (s.new_v[l], s.new_a[l]) if end > 0 else (s.v[l], s.a[l])
        return s.direction[l] * p, s.direction[l] * a
    speed, least = (s.new_speed[l] if end > 0 else s.speed[l]), s.stop_speed[l]
    return speed * speed - least * least, s.new_square_rate[l] if end > 0 else s.square_rate[l]


@inlined
def kink_limit(s: Record, l: int) -> float:
    """Longest step over which |u_b'| changes by a part of itself only."""
    speed, least = s.speed[l], s.linear_speed[l]
    most = 2.0 * least if speed <= least else KINK * speed
    return most / max(s.quicker[l], 1e-300)  # type: ignore[no-any-return]


KINK = 0.25
"""Largest change of |u_b'| over a step, where a damper has a kink at its zero."""


@compiled
def watched(  # noqa: PLR0911 -- a law each
    s: Record, l: int, which: int, end: int
) -> tuple[bool, float, float]:
    """A watched value and its slope, at the start (0) or the end (1) of the step.

    Number 0 is the rate of the tilt in the direction of friction, 1 + i and 1 + SLOTS + i belong to
    device i; `SLOWING` is the velocity of what friction brakes while it may tilt to any side.
    Returns first whether there is such a one.
    """
    if which == SLOWING or (which == 0 and ways_of(s) == 1 and has_friction(s, l)):
        value, slope = slowing(s, l, end)
        return has_friction(s, l) and (which == 0) == (ways_of(s) == 1), value, slope
    x, p, a = (s.new_x[l], s.new_v[l], s.new_a[l]) if end > 0 else (s.x[l], s.v[l], s.a[l])
    if which == 0:
        there = False
        for i in range(s.devices[l]):
            there |= s.device_kind[i, l] == TENDON and s.branch[i, l] == BEYOND
        return there, s.direction[l] * p, s.direction[l] * a
    second = which > SLOTS
    i = which - 1 - (SLOTS if second else 0)
    if i >= s.devices[l]:
        return False, 0.0, 0.0
    kind, branch = s.device_kind[i, l], s.branch[i, l]
    if kind == STOP:  # its gap is open; it pushes, or does not; second, it may again
        if second and branch != BEYOND:
            return False, 0.0, 0.0
        at, diameter = place_of(s, l, x), s.diameter[l]
        stiffness, damping = s.law[i, STOP_STIFFNESS, l], s.law[i, STOP_DAMPING, l]
        if branch == IDLE or second:
            stiffness, damping = 1.0, 0.0
        sign = 1.0 if branch == WORKING or second else -1.0
        beyond = diameter * path_at(s, l, x) - s.law[i, STOP_GAP, l]
        along, faster = diameter * at.C * p, diameter * (at.C * a + at.B * p * p)
        value = sign * (stiffness * beyond + damping * along)
        return True, value, sign * (stiffness * along + damping * faster)
    if kind != TENDON or branch == BEYOND:
        return watched_by_own(s, l, i, end) if not second else (False, 0.0, 0.0)
    limit, stiffness = s.law[i, TENDON_YIELD, l], s.law[i, TENDON_STIFFNESS, l]
    if second and (branch == IDLE or limit == math.inf):
        return False, 0.0, 0.0
    e, lever, _, _ = tendon_elongation(s, l, x)
    tense = s.law[i, TENDON_PRESTRESS, l] + stiffness * (e - s.permanent[i, l])
    sign = -1.0 if second or branch == IDLE else 1.0  # tight, or slack; second, not yielding
    return True, (limit - tense if second else sign * tense), sign * stiffness * lever * p


NEARBY = 1e-5
"""Of the sampling interval, to either side: slopes of what own laws watch are found by it."""


@compiled
def watched_by_own(s: Record, l: int, i: int, end: int) -> tuple[bool, float, float]:
    """What a law of another package watches, positive on its branch, and the slope in time."""
    if s.device_kind[i, l] != OWN or s.own_law[i, 1, l] == 0:
        return False, 0.0, 0.0
    sign = 1.0 if s.branch[i, l] == WORKING else -1.0
    x, p = (s.new_x[l], s.new_v[l]) if end > 0 else (s.x[l], s.v[l])
    path, diameter = s.diameter[l] * path_at(s, l, x), s.diameter[l]
    out = diameter * place_of(s, l, x).C * p
    speed, near = (s.new_speed[l] if end > 0 else s.speed[l]), NEARBY * s.dt[l]
    rate = s.new_square_rate[l] if end > 0 else s.square_rate[l]
    faster = 0.5 * rate / max(speed, 1e-150)
    later = own(s, l, i, 1, path + near * out, speed + near * faster)
    before = own(s, l, i, 1, path - near * out, speed - near * faster)
    return True, sign * own(s, l, i, 1, path, speed), sign * (later - before) / (2.0 * near)


@compiled
def find_branches(s: Record, l: int) -> None:
    """Own laws follow the branch on whose side of zero their watched value is: after a jump."""
    for i in range(s.devices[l]):
        if s.device_kind[i, l] == OWN and s.own_law[i, 1, l] != 0:
            at = worked(s, l, tilt_of(s, l), rate_of(s, l))
            speed = math.sqrt(at.along * at.along + at.across * at.across)
            s.branch[i, l] = WORKING if own(s, l, i, 1, at.path, speed) >= 0.0 else BEYOND


@compiled
def change_law(s: Record, l: int, log: Record, which: int) -> bool:
    """What a watched value that fell below zero stands for; True if friction now holds the tilt."""
    if which == 0:  # what goes round goes on
        _, n, t, _, q = polar(s, l, tilt_of(s, l), rate_of(s, l))
        s.v[l], s.tilt_rate[0, l] = 0.0, 0.0
        if ways_of(s) == 2:
            s.tilt_rate[0, l], s.tilt_rate[1, l] = -t * q, n * q
        reset_yielded_tendons(s, l)
        return True
    second = which > SLOTS
    i = which - 1 - (SLOTS if second else 0)
    branch, event = s.branch[i, l], -1
    if s.device_kind[i, l] == STOP:
        if branch == WORKING:
            branch, event = (BEYOND if s.law[i, STOP_DAMPING, l] > 0.0 else IDLE), STOP_LEFT
        elif second:
            branch = IDLE
        else:
            branch, event = WORKING, STOP_MET
    elif s.device_kind[i, l] == OWN:
        branch = BEYOND if branch == WORKING else WORKING
    elif second:
        branch, event = BEYOND, TENDON_YIELDING
    elif branch == WORKING:
        branch, event = IDLE, TENDON_SLACK
    else:
        branch, event = WORKING, TENDON_TAUT
    s.branch[i, l] = branch
    if event >= 0:
        log_event(s, l, log, event, s.v[l], s.v[l], 0.0)
    return False


@compiled
def take_up_stops(s: Record, l: int, log: Record) -> None:
    """At a closest approach: what moves outwards again is met by stops that had let go."""
    for i in range(s.devices[l]):
        if s.device_kind[i, l] == STOP and s.branch[i, l] == BEYOND:
            s.branch[i, l] = WORKING
            log_event(s, l, log, STOP_MET, 0.0, 0.0, 0.0)


# What they see.


@compiled
def device_at(s: Record, l: int, i: int, at: Worked) -> tuple[float, float, float]:
    """Force of a device, the rate at which it is worked, and its displacement.

    Of horizontal devices the resistance with |u_b|; of a tendon the tension of one with its
    elongation; of rolling resistance the horizontal force that does the same, M/(2 R C).
    """
    kind = s.device_kind[i, l]
    if kind == TENDON:
        return tension(s, l, i, at.e), at.lever * at.tilt.p, at.e
    speed = at.along
    if ways_of(s) == 2:
        speed = math.sqrt(at.along * at.along + at.across * at.across)
    if kind == ROLLING_RESISTANCE:
        moment = s.direction[l] * s.law[i, ROLLING_MOMENT, l]
        return moment / (s.diameter[l] * at.C), speed, at.path
    if kind == FRICTION:
        return s.direction[l] * s.law[i, FRICTION_FORCE, l], speed, at.path
    if kind == STOP:
        return stop_force(s, l, i, at.path, at.along), at.along, at.path
    if not is_branched(s, l, i):
        return s.law[i, DAMPER_COEFFICIENT, l] * speed, speed, at.path
    return drag_of(s, l, i, at.path, abs(speed)) * speed, speed, at.path


@compiled
def raise_devices(s: Record, l: int, start: Worked, middle: Worked, end: Worked) -> None:
    """Raise the largest forces and rates of devices by those of three instants, and between."""
    for i in range(s.devices[l]):
        one, two, three = (
            device_at(s, l, i, start),
            device_at(s, l, i, middle),
            device_at(s, l, i, end),
        )
        force = peak(one[0], two[0], three[0])
        s.device_force[i, l] = max(s.device_force[i, l], force)
        s.device_velocity[i, l] = max(s.device_velocity[i, l], peak(one[1], two[1], three[1]))


@compiled
def stored_in(s: Record, l: int, i: int, at: Worked) -> float:
    """Energy stored in a device over that at the start [J]; a yielded tendon's may be negative."""
    kind = s.device_kind[i, l]
    if kind == STOP:
        beyond = max(at.path - s.law[i, STOP_GAP, l], 0.0)
        return float(0.5 * s.law[i, STOP_STIFFNESS, l] * (beyond * beyond))
    if kind == TENDON:
        tense, prestress = tension(s, l, i, at.e), s.law[i, TENDON_PRESTRESS, l]
        change = tense * tense - prestress * prestress
        return float(0.5 * s.columns[l] * change / s.law[i, TENDON_STIFFNESS, l])
    return 0.0


@compiled
def store_devices(s: Record, l: int, at: Worked, share: float, sample: Floats) -> None:
    """Keep force, displacement, dissipated and stored energy of each device of a lane.

    Horizontal forces are those on the cap beam, positive to the right, and go with u_b; of a tendon
    the tension of one goes with its elongation. Friction at rest is what equilibrium asks for while
    the storey is stuck, and in full contact the least that it can be: `share` of what it can.
    """
    side = s.side[l] if ways_of(s) == 1 else 1.0
    for i in range(s.devices[l]):
        kind = s.device_kind[i, l]
        force, _, displacement = device_at(s, l, i, at)
        if kind != TENDON:
            if stands(s, l) and kind in (FRICTION, ROLLING_RESISTANCE):
                force *= share * s.direction[l]
                if s.phase[l] == FULL_CONTACT and kind == ROLLING_RESISTANCE:
                    force = 0.0
            force, displacement = -side * force, side * displacement
        sample[0, i], sample[1, i] = force + 0.0, displacement + 0.0
        sample[2, i], sample[3, i] = s.device_energy[i, l], stored_in(s, l, i, at)
