"""A stop: spring and dashpot behind a gap, which do not pull (11.3)."""

from __future__ import annotations

from rpscli.physics.compile import compiled
from rpscli.physics.devices.device import DeviceLaw, set_apart
from rpscli.physics.devices.worked import Worked
from rpscli.physics.energy import path_at
from rpscli.physics.ground import log_event
from rpscli.physics.lane import place_of
from rpscli.physics.state import (
    BEYOND,
    IDLE,
    STOP,
    STOP_DAMPING,
    STOP_GAP,
    STOP_LEFT,
    STOP_MET,
    STOP_STIFFNESS,
    WORKING,
    Record,
)


@compiled
def load(s: Record, l: int, i: int, system: Record) -> None:
    """It is looked at by itself, and is open."""
    set_apart(s, l, i)


@compiled
def resistance(s: Record, l: int, i: int, path: float, along: float) -> float:
    """Of a stop that is met, along the tilt."""
    if s.branch[i, l] != WORKING:
        return 0.0
    beyond = path - s.law[i, STOP_GAP, l]
    return float(s.law[i, STOP_STIFFNESS, l] * beyond + s.law[i, STOP_DAMPING, l] * along)


@compiled
def power(s: Record, l: int, i: int, at: Worked) -> float:
    """Of its dashpot; let go before its gap it recovers by itself."""
    if s.branch[i, l] == WORKING:
        return float(s.law[i, STOP_DAMPING, l] * (at.along * at.along))
    if s.branch[i, l] == BEYOND:
        beyond = at.path - s.law[i, STOP_GAP, l]
        return float(-s.law[i, STOP_STIFFNESS, l] * beyond * at.along)
    return 0.0


@compiled
def stored(s: Record, l: int, i: int, at: Worked) -> float:
    """In its spring."""
    beyond = max(at.path - s.law[i, STOP_GAP, l], 0.0)
    return float(0.5 * s.law[i, STOP_STIFFNESS, l] * (beyond * beyond))


@compiled
def watched(
    s: Record,
    l: int,
    i: int,
    end: int,
    second: bool,
) -> tuple[bool, float, float]:
    """Its gap is open; it pushes, or does not; second, it may again."""
    branch = s.branch[i, l]
    if second and branch != BEYOND:
        return False, 0.0, 0.0
    x, p, a = (
        (s.new_x[l], s.new_v[l], s.new_a[l]) if end > 0 else (s.x[l], s.v[l], s.a[l])
    )
    at = place_of(s, l, x)
    diameter = s.diameter[l]
    stiffness = s.law[i, STOP_STIFFNESS, l]
    damping = s.law[i, STOP_DAMPING, l]
    if branch == IDLE or second:
        stiffness = 1.0
        damping = 0.0
    sign = 1.0 if branch == WORKING or second else -1.0
    beyond = diameter * path_at(s, l, x) - s.law[i, STOP_GAP, l]
    along = diameter * at.C * p
    faster = diameter * (at.C * a + at.B * p * p)
    value = sign * (stiffness * beyond + damping * along)
    return True, value, sign * (stiffness * along + damping * faster)


@compiled
def change(s: Record, l: int, i: int, second: bool) -> tuple[int, int]:
    """It is left, met, or comes back to its gap."""
    if s.branch[i, l] == WORKING:
        return (BEYOND if s.law[i, STOP_DAMPING, l] > 0.0 else IDLE), STOP_LEFT
    if second:
        return IDLE, -1
    return WORKING, STOP_MET


@compiled
def at(s: Record, l: int, i: int, at: Worked) -> tuple[float, float, float]:
    """Force, rate and displacement."""
    return resistance(s, l, i, at.path, at.along), at.along, at.path


DEVICE = DeviceLaw(
    STOP,
    load,
    at,
    resistance=resistance,
    power=power,
    stored=stored,
    watched=watched,
    change=change,
)


@compiled
def begin_excursion(s: Record, l: int, log: Record) -> None:
    """Leave x = 0: friction acts against growing tilts, and a stop
    without a gap is met at once.
    """
    s.direction[l] = 1.0
    for i in range(s.devices[l]):
        if s.device_kind[i, l] == STOP:
            s.branch[i, l] = IDLE
            if s.law[i, STOP_GAP, l] == 0.0:
                s.branch[i, l] = WORKING
                log_event(s, l, log, STOP_MET, s.v[l], s.v[l], 0.0)


@compiled
def take_up_stops(s: Record, l: int, log: Record) -> None:
    """At a closest approach: what moves outwards again is met
    by stops that had let go.
    """
    for i in range(s.devices[l]):
        if s.device_kind[i, l] == STOP and s.branch[i, l] == BEYOND:
            s.branch[i, l] = WORKING
            log_event(s, l, log, STOP_MET, 0.0, 0.0, 0.0)
