"""A damper of another package, whose law is called by its address."""

from __future__ import annotations

from rpscli.physics.compile import compiled, own_law
from rpscli.physics.devices.device import DeviceLaw, set_apart, speed_of
from rpscli.physics.devices.worked import Worked, worked
from rpscli.physics.energy import path_at
from rpscli.physics.lane import place_of, rate_of, tilt_of
from rpscli.physics.laws.place import length
from rpscli.physics.state import BEYOND, OWN, WORKING, Record


@compiled
def load(s: Record, l: int, i: int, system: Record) -> None:
    """It is looked at by itself."""
    set_apart(s, l, i)
    s.kinks[l] = 1.0 if system.own_law[i, 2] == 1 else s.kinks[l]


@compiled
def asked(s: Record, l: int, i: int, which: int, path: float, speed: float) -> float:
    """Force (0) or watched value (1) of a law of another package."""
    of = s.law
    u = max(path, 0.0)  # a step may try what is beyond upright
    v = max(speed, 0.0)
    given = (u, v, of[i, 0, l], of[i, 1, l], of[i, 2, l], of[i, 3, l], 0.0, 0.0, 0.0)
    return own_law(s.own_law[i, which, l], given)


@compiled
def drag(s: Record, l: int, i: int, path: float, speed: float) -> float:
    """Resistance over |u_b'|."""
    return asked(s, l, i, 0, path, speed) / max(speed, 1e-150)


@compiled
def power(s: Record, l: int, i: int, at: Worked) -> float:
    """Of its force."""
    speed = length(at.along, at.across)
    return drag(s, l, i, at.path, speed) * (speed * speed)


NEARBY = 1e-5
"""Of the sampling interval, to either side: slopes of what is watched are found by it."""


@compiled
def watched(
    s: Record,
    l: int,
    i: int,
    end: int,
    second: bool,
) -> tuple[bool, float, float]:
    """Value that its law watches, positive on its branch, and the slope in time."""
    if second or s.own_law[i, 1, l] == 0:
        return False, 0.0, 0.0
    sign = 1.0 if s.branch[i, l] == WORKING else -1.0
    x, p = (s.new_x[l], s.new_v[l]) if end > 0 else (s.x[l], s.v[l])
    path = s.diameter[l] * path_at(s, l, x)
    out = s.diameter[l] * place_of(s, l, x).C * p
    speed = s.new_speed[l] if end > 0 else s.speed[l]
    near = NEARBY * s.dt[l]
    rate = s.new_square_rate[l] if end > 0 else s.square_rate[l]
    faster = 0.5 * rate / max(speed, 1e-150)
    later = asked(s, l, i, 1, path + near * out, speed + near * faster)
    before = asked(s, l, i, 1, path - near * out, speed - near * faster)
    return (
        True,
        sign * asked(s, l, i, 1, path, speed),
        sign * (later - before) / (2.0 * near),
    )


@compiled
def change(s: Record, l: int, i: int, second: bool) -> tuple[int, int]:
    """To the other side of what it watches."""
    return (BEYOND if s.branch[i, l] == WORKING else WORKING), -1


@compiled
def at(s: Record, l: int, i: int, at: Worked) -> tuple[float, float, float]:
    """Force, rate and displacement."""
    speed = speed_of(s, at)
    return drag(s, l, i, at.path, abs(speed)) * speed, speed, at.path


DEVICE = DeviceLaw(OWN, load, at, drag=drag, power=power, watched=watched, change=change)


@compiled
def find_branches(s: Record, l: int) -> None:
    """Own laws follow the branch on whose side of zero their
    watched value is: after a jump.
    """
    for i in range(s.devices[l]):
        if s.device_kind[i, l] == OWN and s.own_law[i, 1, l] != 0:
            at = worked(s, l, tilt_of(s, l), rate_of(s, l))
            speed = length(at.along, at.across)
            s.branch[i, l] = (
                WORKING if asked(s, l, i, 1, at.path, speed) >= 0.0 else BEYOND
            )
