"""Rolling resistance: a moment 2 W f of all columns against their turning (11.12)."""

from __future__ import annotations

from rpscli.physics.compile import compiled
from rpscli.physics.devices.device import DeviceLaw, set_kink, speed_of
from rpscli.physics.devices.worked import Worked
from rpscli.physics.state import ROLLING_MOMENT, ROLLING_RESISTANCE, Record


@compiled
def load(s: Record, l: int, i: int, system: Record) -> None:
    """A sum of its lane."""
    moment = system.device_constants[i, ROLLING_MOMENT]
    s.friction_moment[l] += moment
    s.swing_constant[i, l] = moment
    set_kink(s, l)


@compiled
def at(s: Record, l: int, i: int, at: Worked) -> tuple[float, float, float]:
    """The horizontal force that does the same, M/(2 R C), rate and displacement."""
    moment = s.direction[l] * s.law[i, ROLLING_MOMENT, l]
    return moment / (s.diameter[l] * at.C), speed_of(s, at), at.path


DEVICE = DeviceLaw(ROLLING_RESISTANCE, load, at)
