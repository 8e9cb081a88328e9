"""A friction damper: a force F_d against the cap beam's velocity (11.2)."""

from __future__ import annotations

from rpscli.physics.compile import compiled
from rpscli.physics.devices.device import DeviceLaw, set_kink, speed_of
from rpscli.physics.devices.worked import Worked
from rpscli.physics.state import FRICTION, FRICTION_FORCE, Record


@compiled
def load(s: Record, l: int, i: int, system: Record) -> None:
    """A sum of its lane."""
    force = system.device_constants[i, FRICTION_FORCE]
    s.friction_force[l] += force
    s.pace_constant[i, l] = force
    set_kink(s, l)


@compiled
def at(s: Record, l: int, i: int, at: Worked) -> tuple[float, float, float]:
    """Force, rate and displacement."""
    return s.direction[l] * s.law[i, FRICTION_FORCE, l], speed_of(s, at), at.path


DEVICE = DeviceLaw(FRICTION, load, at)
