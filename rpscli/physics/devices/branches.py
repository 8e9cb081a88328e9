"""Where the laws of devices change."""

from __future__ import annotations

from rpscli.physics.compile import compiled, inlined
from rpscli.physics.devices.acting import has_friction
from rpscli.physics.devices.own import find_branches
from rpscli.physics.devices.table import change_of, tension_of, watched_of
from rpscli.physics.devices.tendon import any_yields, reset_yielded_tendons
from rpscli.physics.devices.worked import worked
from rpscli.physics.ground import log_event
from rpscli.physics.lane import polar, rate_of, tilt_of, ways_of
from rpscli.physics.state import (
    BEYOND,
    SLOTS,
    STOP,
    STOP_GAP,
    TENDON,
    TENDON_YIELD,
    WORKING,
    Record,
)

SLOWING = 1 + 2 * SLOTS
WATCHED = SLOWING + 1
"""Numbers of watched values."""


@inlined
def may_be_watched(s: Record, l: int, which: int) -> bool:
    """True if a number is one of a device that is there, or of the tilt."""
    return which in (0, SLOWING) or (which - 1) % SLOTS < s.devices[l]


@inlined
def slowing(s: Record, l: int, end: int) -> tuple[float, float]:
    """Value that falls below zero where friction stops a tilt, and its slope.

    In one plane the rate in the direction of friction; to any side
    |u_b'|^2 over that of a stop.
    """
    if ways_of(s) == 1:
        p, a = (s.new_v[l], s.new_a[l]) if end > 0 else (s.v[l], s.a[l])
        return s.direction[l] * p, s.direction[l] * a
    speed = s.new_speed[l] if end > 0 else s.speed[l]
    least = s.stop_speed[l]
    return speed * speed - least * least, s.new_square_rate[
        l
    ] if end > 0 else s.square_rate[l]


@inlined
def standstill(s: Record) -> int:
    """The number of what falls below zero where friction stops a tilt."""
    return 0 if ways_of(s) == 1 else SLOWING


@inlined
def kink_limit(s: Record, l: int) -> float:
    """Longest step over which |u_b'| changes by a part of itself only."""
    speed = s.speed[l]
    least = s.linear_speed[l]
    most = 2.0 * least if speed <= least else KINK * speed
    return most / max(s.quicker[l], 1e-300)  # type: ignore[no-any-return]


KINK = 0.25
"""Largest change of |u_b'| over a step, where a damper has a kink at its zero."""


@compiled
def watched(s: Record, l: int, which: int, end: int) -> tuple[bool, float, float]:
    """A watched value and its slope, at the start (0) or the end (1) of the step.

    Number 0 is the rate of the tilt in the direction of friction, 1 + i and 1 + SLOTS + i
    belong to device i; `SLOWING` is the velocity of what friction brakes while it may
    tilt to any side. Returns first whether there is such a one.
    """
    if which == standstill(s) and has_friction(s, l):
        value, slope = slowing(s, l, end)
        return True, value, slope
    if which == SLOWING:
        return False, 0.0, 0.0
    if which == 0:
        p, a = (s.new_v[l], s.new_a[l]) if end > 0 else (s.v[l], s.a[l])
        return any_yields(s, l), s.direction[l] * p, s.direction[l] * a
    second = which > SLOTS
    i = which - 1 - (SLOTS if second else 0)
    if i >= s.devices[l]:
        return False, 0.0, 0.0
    return watched_of(s, l, i, end, second)


@compiled
def change_law(s: Record, l: int, log: Record, which: int) -> bool:
    """Make the change that a watched value below zero stands for; True if friction now
    holds the tilt.
    """
    if which == 0:  # what goes round goes on
        _, n, t, _, q = polar(s, l, tilt_of(s, l), rate_of(s, l))
        s.v[l] = 0.0
        s.tilt_rate[0, l] = 0.0
        if ways_of(s) == 2:
            s.tilt_rate[0, l] = -t * q
            s.tilt_rate[1, l] = n * q
        reset_yielded_tendons(s, l)
        return True
    second = which > SLOTS
    i = which - 1 - (SLOTS if second else 0)
    branch, event = change_of(s, l, i, second)
    s.branch[i, l] = branch
    if event >= 0:
        log_event(s, l, log, event, s.v[l], s.v[l], 0.0)
    return False


@compiled
def release_devices(s: Record, l: int) -> None:
    """Be held at a tilt: stops push, and tendons that cannot hold it have yielded."""
    at = worked(s, l, tilt_of(s, l), (0.0, 0.0))
    for i in range(s.devices[l]):
        kind = s.device_kind[i, l]
        if kind == STOP and at.path > s.law[i, STOP_GAP, l]:
            s.branch[i, l] = WORKING
        elif kind == TENDON and tension_of(s, l, i, at.e) > s.law[i, TENDON_YIELD, l]:
            s.branch[i, l] = BEYOND
    reset_yielded_tendons(s, l)
    find_branches(s, l)
