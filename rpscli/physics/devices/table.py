"""The devices, and a question to the one that is meant."""

from __future__ import annotations

from rpscli.physics.compile import compiled
from rpscli.physics.devices import friction_damper, own, rolling, stop, tendon, viscous
from rpscli.physics.devices.worked import Worked
from rpscli.physics.state import IDLE, Record

DEVICES = (
    viscous.DEVICE,
    friction_damper.DEVICE,
    stop.DEVICE,
    tendon.DEVICE,
    rolling.DEVICE,
    own.DEVICE,
)


@compiled
def load_device(s: Record, l: int, i: int, system: Record) -> None:
    """Begin with a device."""
    kind = system.device_kind[i]
    s.device_kind[i, l] = kind
    s.branch[i, l] = IDLE
    s.permanent[i, l] = 0.0
    s.device_force[i, l] = 0.0
    s.device_velocity[i, l] = 0.0
    s.device_energy[i, l] = 0.0
    s.square_constant[i, l] = 0.0
    s.pace_constant[i, l] = 0.0
    s.swing_constant[i, l] = 0.0
    s.apart[i, l] = 0.0
    for k in range(4):
        s.law[i, k, l] = system.device_constants[i, k]
    for k in range(2):
        s.own_law[i, k, l] = system.own_law[i, k]
    for device in DEVICES:
        if kind == device.kind:
            device.load(s, l, i, system)


@compiled
def drag_of(s: Record, l: int, i: int, path: float, speed: float) -> float:
    """Resistance over |u_b'| of a device that is looked at by itself [N s/m]."""
    for device in DEVICES:
        if s.device_kind[i, l] == device.kind:
            return device.drag(s, l, i, path, speed)  # type: ignore[no-any-return]
    return 0.0


@compiled
def resistance_of(s: Record, l: int, i: int, path: float, along: float) -> float:
    """Resistance along the tilt of one [N]."""
    for device in DEVICES:
        if s.device_kind[i, l] == device.kind:
            return device.resistance(s, l, i, path, along)  # type: ignore[no-any-return]
    return 0.0


@compiled
def tension_of(s: Record, l: int, i: int, e: float) -> float:
    """Tension of one in each column [N]."""
    for device in DEVICES:
        if s.device_kind[i, l] == device.kind:
            return device.tension(s, l, i, e)  # type: ignore[no-any-return]
    return 0.0


@compiled
def power_of(s: Record, l: int, i: int, at: Worked) -> float:
    """Power that a device dissipates [W]."""
    for device in DEVICES:
        if s.device_kind[i, l] == device.kind:
            return device.power(s, l, i, at)  # type: ignore[no-any-return]
    return 0.0


@compiled
def stored_in(s: Record, l: int, i: int, at: Worked) -> float:
    """Energy stored in a device over that at the start [J]; a yielded
    tendon's may be negative.
    """
    for device in DEVICES:
        if s.device_kind[i, l] == device.kind:
            return device.stored(s, l, i, at)  # type: ignore[no-any-return]
    return 0.0


@compiled
def device_at(s: Record, l: int, i: int, at: Worked) -> tuple[float, float, float]:
    """Force of a device, the rate at which it is worked, and its displacement.

    Of horizontal devices the resistance with |u_b|; of a tendon the tension of
    one with its elongation; of rolling resistance the horizontal force that
    does the same, M/(2 R C).
    """
    for device in DEVICES:
        if s.device_kind[i, l] == device.kind:
            return device.at(s, l, i, at)  # type: ignore[no-any-return]
    return 0.0, 0.0, 0.0


@compiled
def watched_of(
    s: Record,
    l: int,
    i: int,
    end: int,
    second: bool,
) -> tuple[bool, float, float]:
    """Value that a device watches at the start (0) or the end (1) of the step, and its
    slope.
    """
    for device in DEVICES:
        if s.device_kind[i, l] == device.kind:
            return device.watched(s, l, i, end, second)  # type: ignore[no-any-return]
    return False, 0.0, 0.0


@compiled
def change_of(s: Record, l: int, i: int, second: bool) -> tuple[int, int]:
    """The next branch of a device, and the event to log, or -1."""
    for device in DEVICES:
        if s.device_kind[i, l] == device.kind:
            return device.change(s, l, i, second)  # type: ignore[no-any-return]
    return IDLE, -1
