"""A viscous damper: a force c |u_b'|^a against the cap beam's velocity (11.1)."""

from __future__ import annotations

from rpscli.physics.compile import compiled
from rpscli.physics.devices.device import DeviceLaw, is_apart, set_apart, speed_of
from rpscli.physics.devices.worked import Worked
from rpscli.physics.laws.place import length
from rpscli.physics.state import DAMPER_COEFFICIENT, DAMPER_EXPONENT, VISCOUS, Record


@compiled
def load(s: Record, l: int, i: int, system: Record) -> None:
    """A linear one is a sum of its lane; with an exponent it is looked at by itself."""
    c = system.device_constants[i, DAMPER_COEFFICIENT]
    if s.law[i, DAMPER_EXPONENT, l] == 1.0:
        s.viscous[l] += c
        s.square_constant[i, l] = c
    else:
        set_apart(s, l, i)
        s.kinks[l] = 1.0


@compiled
def drag(s: Record, l: int, i: int, path: float, speed: float) -> float:
    """Resistance over |u_b'|, up to a small velocity that of a linear one."""
    exponent = s.law[i, DAMPER_EXPONENT, l] - 1.0
    return float(
        s.law[i, DAMPER_COEFFICIENT, l] * max(speed, s.linear_speed[l]) ** exponent
    )


@compiled
def power(s: Record, l: int, i: int, at: Worked) -> float:
    """Of a damper with an exponent."""
    speed = length(at.along, at.across)
    return drag(s, l, i, at.path, speed) * (speed * speed)


@compiled
def at(s: Record, l: int, i: int, at: Worked) -> tuple[float, float, float]:
    """Force, rate and displacement."""
    speed = speed_of(s, at)
    if not is_apart(s, l, i):
        return s.law[i, DAMPER_COEFFICIENT, l] * speed, speed, at.path
    return drag(s, l, i, at.path, abs(speed)) * speed, speed, at.path


DEVICE = DeviceLaw(VISCOUS, load, at, drag=drag, power=power)
