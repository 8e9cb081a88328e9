"""A storey that friction holds: at rest on its ends, or tilted (section 11).

In one plane it is held between two limits. A tilt to any side is held inside a
closed curve of what pushes it, a circle where dampers alone hold it, and begins
to slide along its normal.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from rpscli.physics.compile import compiled, inlined
from rpscli.physics.devices.acting import has_friction
from rpscli.physics.devices.table import resistance_of, tension_of
from rpscli.physics.devices.worked import tendon_elongation
from rpscli.physics.energy import path_at
from rpscli.physics.ground import log_event
from rpscli.physics.lane import (
    Vector,
    felt,
    felt_at,
    g_up_at,
    ground_of,
    patch,
    place_of,
    polar,
    pushed_by,
    resultant,
    set_vector,
    tilt_of,
    ways_of,
    z_at,
    z_vector,
)
from rpscli.physics.laws.place import Place, across, along, length, turned
from rpscli.physics.state import STICKING, STUCK, Record


@compiled
def push_of_stops(s: Record, l: int) -> float:
    """Force of all stops against a tilt at rest [N]."""
    path = s.diameter[l] * path_at(s, l, s.x[l])
    push = 0.0
    for i in range(s.devices[l]):
        push += resistance_of(s, l, i, path, 0.0)
    return push


@compiled
def force_at_rest(s: Record, l: int) -> tuple[float, float]:
    """Horizontal force at the cap beam against a tilt at rest [N].

    Returns: That of stops and tendons, towards smaller x, and what
    friction may add to either side.
    """
    if s.devices[l] == 0:
        return 0.0, 0.0
    e, lever, _, _ = tendon_elongation(s, l, s.x[l])
    arm = s.diameter[l] * place_of(s, l, s.x[l]).C
    elastic = push_of_stops(s, l)
    for i in range(s.devices[l]):
        elastic += s.columns[l] * tension_of(s, l, i, e) * lever / arm
    return elastic, s.friction_force[l] + s.friction_moment[l] / arm


@inlined
def is_gripped(s: Record, l: int) -> bool:
    """True if friction holds a tilt that may be to any side (13.25)."""
    return False if ways_of(s) == 1 else s.phase[l] == STUCK


@compiled
def set_limits(s: Record, l: int) -> None:
    """Write what holds a lane at rest to either side, in full contact
    or stuck (3.2), (11.14).
    """
    R = 0.5 * s.diameter[l]
    elastic, friction = force_at_rest(s, l)
    elastic = R * pushed_by(s, l, elastic)
    friction = R * pushed_by(s, l, friction)
    limit = s.tan_a[l] * (R * s.weigh[l])
    s.held_x[l] = 0.0
    s.held_y[l] = 0.0
    if s.bed_back[l] > 0.0:
        set_limits_on_bed(s, l, elastic, friction)
    elif s.phase[l] == STUCK:
        set_limits_stuck(s, l, elastic, friction)
    else:
        set_right(s, l, limit, elastic + friction)
        set_left(s, l, limit, elastic + friction)


@inlined
def set_right(s: Record, l: int, limit: float, held: float) -> None:
    """Write the limit of R |z| to the right: what multiplies g + a_v, what adds to it."""
    s.limit_right[l] = limit
    s.held_right[l] = held


@inlined
def set_left(s: Record, l: int, limit: float, held: float) -> None:
    """And to the left."""
    s.limit_left[l] = limit
    s.held_left[l] = held


@compiled
def set_limits_on_bed(s: Record, l: int, elastic: float, friction: float) -> None:
    """Limits between a bed and lifted ends: outwards as these, inwards as the bed."""
    R = 0.5 * s.diameter[l]
    at = place_of(s, l, s.x[l])
    back = R * s.bed_back[l]
    missing = R * (s.root[l] - s.sink[l]) * s.w[l] * s.gravity[l] * s.weigh[l]
    limit = at.Bv / at.C * (R * s.weigh[l])
    held = elastic + friction + missing / at.C
    if s.side[l] < 0.0:
        set_right(s, l, 0.0, friction - elastic - back)
        set_left(s, l, limit, held)
    else:
        set_right(s, l, limit, held)
        set_left(s, l, 0.0, friction - elastic - back)


@compiled
def set_limits_stuck(s: Record, l: int, elastic: float, friction: float) -> None:
    """Limits of a tilt that friction holds; of one to any side a circle
    about `held_x` and `held_y`.
    """
    R = 0.5 * s.diameter[l]
    weigh = R * s.weigh[l]
    at = place_of(s, l, s.x[l])
    side = s.side[l]
    missing = (s.root[l] - s.sink[l]) * s.w[l] * s.gravity[l] * s.weigh[l]
    elastic += R * (missing + s.bed_k[l] * s.x[l]) / at.C
    now = polar(s, l, tilt_of(s, l), (0.0, 0.0))
    back = elastic + at.Bv / at.C * weigh * s.gravity[l] if s.x[l] > 0.0 else 0.0
    s.held_x[l] = back * now.n
    s.held_y[l] = back * now.t
    if is_gripped(s, l):  # within it surely is: what (13.25) asks of dampers alone
        moment = s.friction_moment[l] / (s.diameter[l] * max(at.C, at.h))
        set_right(s, l, 0.0, R * pushed_by(s, l, s.friction_force[l] + moment))
        return
    limit = side * at.Bv / at.C * weigh
    elastic = side * elastic
    set_right(s, l, limit, friction + elastic)
    set_left(s, l, -limit, friction - elastic)


@compiled
def push_at_rest(s: Record, l: int, V: Vector, time: float, V_up: float) -> float:
    """Write to `drive` the push of friction dampers on the cap beam while a lane is at
    rest [N].

    In full contact the columns hold what they can, and friction dampers the rest: no
    less, or the columns would turn (11.13). A stuck storey is held by dampers and
    rolling resistance in proportion to what each could. Returns the share of their
    friction that is asked for, against growing tilts, -1 to 1; of a tilt to any side
    against where it is pushed to, 0 to 1.
    """
    # Between bed and lifted ends the columns hold what they can too, up to where they let
    # go.
    if s.friction_force[l] + s.friction_moment[l] == 0.0 or s.bed_back[l] > 0.0:
        return 0.0
    g_felt = felt(s, l, g_up_at(s, l, time), V_up)
    z = z_vector(s, l, V, ground_of(s, l, time))
    if is_gripped(s, l):
        return push_gripped(s, l, z, g_felt)
    if s.phase[l] == STUCK:
        return push_stuck(s, l, z[0], g_felt)
    return push_upright(s, l, z, g_felt)


@compiled
def push_stuck(s: Record, l: int, z: float, g_felt: float) -> float:
    """`push_at_rest` of a lane that is stuck, in one plane."""
    R = 0.5 * s.diameter[l]
    side = s.side[l]
    action = side * (-R * z)
    friction = force_at_rest(s, l)[1] * pushed_by(s, l, R)
    resists = 0.5 * (s.limit_right[l] - s.limit_left[l]) * side * g_felt
    resists += 0.5 * side * (s.held_right[l] - s.held_left[l])
    share = -(resists + action) / friction
    s.drive[0, l] = -side * (push_of_stops(s, l) + share * s.friction_force[l])
    return float(share)


@compiled
def push_upright(s: Record, l: int, z: Vector, g_felt: float) -> float:
    """`push_at_rest` of a lane in full contact."""
    R = 0.5 * s.diameter[l]
    per_N = pushed_by(s, l, R)
    dampers = per_N * s.friction_force[l]
    if dampers == 0.0:
        return 0.0
    x = -R * z[0]
    y = -R * z[1]
    action = resultant(s, x, y)
    resists = s.limit_right[l] * g_felt + s.held_right[l]
    beyond = min(max(action - (resists - dampers), 0.0), dampers)
    if ways_of(s) == 2:
        push = beyond / max(per_N * action, 1e-300)
        set_vector(s, s.drive, l, push * x, push * y)
        return float(beyond / dampers)
    side = s.side[l]
    share = -math.copysign(beyond / dampers, side * x)
    s.drive[0, l] = -side * share * s.friction_force[l]
    return share


@compiled
def sticks(s: Record, l: int, log: Record) -> bool:
    """After x' = 0 under friction: go on to the side that is
    pushed to; True if neither is.
    """
    if not has_friction(s, l):
        return False
    at = place_of(s, l, s.x[l])
    moment = at.C * s.friction_force[l] + s.friction_moment[l] / s.diameter[l]
    held = pushed_by(s, l, moment) / at.A
    free = s.a[l] + s.direction[l] * held
    if abs(free) > held:
        s.direction[l] = 1.0 if free > 0.0 else -1.0
        return False
    s.phase[l] = STUCK
    log_event(s, l, log, STICKING, 0.0, 0.0, 0.0)
    return True


# Where the tilt may have any azimuth (13.25). With P the friction of dampers along W d =
# (C d_n, h d_t) and M that of rolling along d, Q is held if Q.d <= P |W d| + M for every
# unit vector d.


class Grip(NamedTuple):
    """Hold of friction on a tilt at rest, over N m_c R^2 [1/s2]."""

    used: float  # the part of what friction could do: it holds up to 1
    # P |W d| + M - Q.d, where d is the vector for which that is least at used = 1
    margin: float
    slope: float  # its rate [1/s3]
    late: float  # what it is below zero when a motion has come to `START_SPEED`
    d_n: float
    d_t: float
    drag_n: float  # W d/|W d|
    drag_t: float


TURNS = 10
"""Steps to d, each of which leaves |C - h|/C of what is missing: some hundredth."""


@inlined
def unit(x: float, y: float) -> Vector:
    """A vector over its size; of none the first axis."""
    size = length(x, y)
    return (x / size, y / size) if size > 0.0 else (1.0, 0.0)


@compiled
def least_held(
    at: Place, P: float, M: float, aim_n: float, aim_t: float
) -> tuple[float, float, float]:
    """d of (13.25), the vector along which least holds Q, which aims so; and |W d|."""
    d_n, d_t = unit(aim_n, aim_t)
    long = length(at.C * d_n, at.h * d_t)
    turns = 1 if M == 0.0 or P == 0.0 else TURNS  # of one alone d follows at once
    for _ in range(turns if P + M > 0.0 else 0):
        # Where Q is just held it is the gradient of P |W d| + M |d|.
        d_n = aim_n / (P * at.C * at.C / long + M)
        d_t = aim_t / (P * at.h * at.h / long + M)
        d_n, d_t = unit(d_n, d_t)
        long = length(at.C * d_n, at.h * d_t)
    return d_n, d_t, long


@compiled
def grip_of(
    s: Record,
    l: int,
    z: Vector,
    z_rate: Vector,
    g_felt: tuple[float, float],
    less: float,
) -> Grip:
    """Hold on a tilt at rest under z of what is not friction, and g_f, with their rates.

    Of the dampers' part `less` may not be asked for [1/s2].
    """
    x, n, t, _, _ = polar(s, l, tilt_of(s, l), (0.0, 0.0))
    w, _ = patch(s, l, x)
    at = place_of(s, l, x)
    P = max(pushed_by(s, l, s.friction_force[l]) - less, 0.0)
    M = pushed_by(s, l, s.friction_moment[l]) / s.diameter[l]
    arm = at.Bv * s.weigh[l]
    missing = (s.root[l] - s.sink[l]) * w * s.gravity[l] * s.weigh[l]
    held = arm * g_felt[0] + missing + s.bed_k[l] * x
    held = held + at.C * pushed_by(s, l, force_at_rest(s, l)[0]) if x > 0.0 else 0.0
    Q_n = at.C * along(n, t, z[0], z[1]) - held
    Q_t = at.h * across(n, t, z[0], z[1])
    rate_n = at.C * along(n, t, z_rate[0], z_rate[1]) - arm * g_felt[1]
    rate_t = at.h * across(n, t, z_rate[0], z_rate[1])
    pushed = Q_n != 0.0 or Q_t != 0.0  # else it will be where that grows to
    aim_n, aim_t = (Q_n, Q_t) if pushed else (rate_n, rate_t)
    d_n, d_t, long = least_held(at, P, M, aim_n, aim_t)
    most = P * long + M
    pulled = Q_n * d_n + Q_t * d_t
    falls = max(rate_n * d_n + rate_t * d_t, 0.0)
    inert = (at.A * d_n * d_n + at.K * d_t * d_t) / (s.diameter[l] * long)
    return Grip(
        pulled / max(most, 1e-300),
        most * (1.0 + ROUNDING) - pulled,
        -(rate_n * d_n + rate_t * d_t),
        math.sqrt(2.0 * s.start_speed[l] * inert * falls),
        d_n,
        d_t,
        at.C * d_n / long,
        at.h * d_t / long,
    )


ROUNDING = 1e-13
"""Share of what friction can hold within which its margin is zero."""


@compiled
def grip_at(s: Record, l: int, end: int) -> Grip:
    """Hold on a lane at the start (0) or at the end (1) of its step."""
    z, z_rate = z_at(s, l, end)
    g_felt, g_rate, _ = felt_at(s, l, end)
    return grip_of(s, l, z, z_rate, (g_felt, g_rate), 0.0)


@compiled
def push_gripped(s: Record, l: int, z: Vector, g_felt: float) -> float:
    """`push_at_rest` of a lane that is stuck with a tilt to any side."""
    grip = grip_of(s, l, z, (0.0, 0.0), (g_felt, 0.0), 0.0)
    now = polar(s, l, tilt_of(s, l), (0.0, 0.0))
    # a little more would be asked for just before it lets go (13.26)
    used = min(grip.used, 1.0)
    push = used * s.friction_force[l]
    out = -push * grip.drag_n - push_of_stops(s, l)
    push_x, push_y = turned(now.n, now.t, out, -push * grip.drag_t)
    set_vector(s, s.drive, l, push_x, push_y)
    return used
