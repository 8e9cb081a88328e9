"""Questions to a device: a function each, most of which most devices leave as they are
here.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from rpscli.physics.compile import compiled, inlined
from rpscli.physics.devices.worked import Worked
from rpscli.physics.lane import ways_of
from rpscli.physics.laws.place import length
from rpscli.physics.state import IDLE, Record


@compiled
def no_drag(s: Record, l: int, i: int, path: float, speed: float) -> float:
    """Resistance over |u_b'| beyond sums of the lane [N s/m]."""
    return 0.0


@compiled
def no_resistance(s: Record, l: int, i: int, path: float, along: float) -> float:
    """Resistance along the tilt beyond sums of the lane [N]."""
    return 0.0


@compiled
def no_tension(s: Record, l: int, i: int, e: float) -> float:
    """Tension in each column at an elongation [N]."""
    return 0.0


@compiled
def no_power(s: Record, l: int, i: int, at: Worked) -> float:
    """Power dissipated beyond sums of the lane [W]."""
    return 0.0


@compiled
def nothing_stored(s: Record, l: int, i: int, at: Worked) -> float:
    """Energy stored over that at the start [J]; a yielded tendon's may be negative."""
    return 0.0


@compiled
def nothing_watched(
    s: Record, l: int, i: int, end: int, second: bool
) -> tuple[bool, float, float]:
    """Value that falls below zero where the law changes, and its slope, at an end of the
    step.

    First whether there is such a one; a device may watch a second one.
    """
    return False, 0.0, 0.0


@compiled
def no_other(s: Record, l: int, i: int, second: bool) -> tuple[int, int]:
    """The branch after the watched value has fallen below zero, and
    the event to log, or -1.
    """
    return IDLE, -1


@inlined
def is_apart(s: Record, l: int, i: int) -> bool:
    """True if a device is looked at by itself: its law has branches or powers."""
    return s.apart[i, l] > 0.0  # type: ignore[no-any-return]


@compiled
def set_apart(s: Record, l: int, i: int) -> None:
    """Have a device be looked at by itself."""
    s.apart[i, l] = 1.0
    s.branched[l] = 1.0


class DeviceLaw(NamedTuple):
    """A kind of device. What is a sum of its lane is said in `load`."""

    kind: int
    load: Callable[..., Any]
    at: Callable[
        ..., Any
    ]  # force, rate at which it is worked, displacement: as `seen` has them
    drag: Callable[..., Any] = no_drag
    resistance: Callable[..., Any] = no_resistance
    tension: Callable[..., Any] = no_tension
    power: Callable[..., Any] = no_power
    stored: Callable[..., Any] = nothing_stored
    watched: Callable[..., Any] = nothing_watched
    change: Callable[..., Any] = no_other


@inlined
def set_kink(s: Record, l: int) -> None:
    """Note that a force has a kink at u_b' = 0, where the tilt may go to any side."""
    s.kinks[l] = 1.0 if ways_of(s) == 2 else s.kinks[l]


@compiled
def speed_of(s: Record, at: Worked) -> float:
    """u_b' along the tilt in one plane, else its size [m/s]."""
    return at.along if ways_of(s) == 1 else length(at.along, at.across)
