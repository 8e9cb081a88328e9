"""Devices between ground and cap beam as generalised forces on the tilt, and where they change.

All of them follow from two lengths: the cap beam's displacement Re w(x) of `storey_lagrangian` and
the opening of the joints at the columns' axis. The middle of the lower end, -i H in the column's
frame, moves by z = w/2 + i H (1 - exp(-i x)), the middle of the upper one stays behind the cap beam
by as much: a tendon through both elongates by e = 2 |z|.

A force that a device can only hold up to a limit - friction, at rest - is the moment `held`; all
others are `moment`, smooth as long as the branches stay.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

from scipy.optimize import brentq

from .storey_lagrangian import Contact, StoreyLagrangian


@dataclass(frozen=True)
class Viscous:
    """P = -c |u_b'|^a sgn(u_b')."""

    coefficient: float
    exponent: float = 1.0


@dataclass(frozen=True)
class Friction:
    """P = -F_d sgn(u_b')."""

    force: float


@dataclass(frozen=True)
class Stop:
    """k (|u_b| - d) + c |u_b|' against the displacement beyond the gap d, never negative."""

    gap: float
    stiffness: float
    damping: float = 0.0


@dataclass(frozen=True)
class Tendon:
    """One in each of `columns` columns: P_0 + k (e - e_plastic) between 0 and P_y."""

    columns: float
    prestress: float
    stiffness: float
    yield_force: float = math.inf


@dataclass(frozen=True)
class RollingResistance:
    """The weight runs ahead of both contacts by f: a moment of f times the static 2 W."""

    lever: float


OracleDevice = Viscous | Friction | Stop | Tendon | RollingResistance
Branch = Literal["open", "pushing", "released", "slack", "elastic", "yielding", "only"]


class Change(NamedTuple):
    """A device takes another branch where |theta| passes a level."""

    level: float
    direction: int
    device: int
    branch: Branch


@dataclass
class Equipment:
    """The devices of a storey with what they remember."""

    lagrangian: StoreyLagrangian
    devices: tuple[OracleDevice, ...]
    limit: float
    branches: list[Branch] = field(init=False)
    plastic: list[float] = field(init=False)
    _searched: tuple[object, list[Change]] | None = field(init=False, default=None)

    def __post_init__(self) -> None:
        first: dict[type, Branch] = {Stop: "open", Tendon: "elastic"}
        self.branches = [first.get(type(device), "only") for device in self.devices]
        self.plastic = [0.0] * len(self.devices)
        self.stand()

    def stand(self) -> None:
        """The branches at theta = 0: a stop without a gap is met from there."""
        for k, device in enumerate(self.devices):
            if isinstance(device, Stop) and device.gap == 0.0:
                self.branches[k] = "pushing"

    def opening(self, x: float, *, rolling: bool) -> tuple[complex, complex]:
        """z(x) and dz/dx [m]; x is taken out of differences, so that small ones keep digits."""
        motion = self.lagrangian
        turn = 2j * math.sin(0.5 * x) * cmath.exp(-0.5j * x)  # 1 - exp(-i x)
        if rolling:
            arm = complex(motion.half_width, motion.radius)
            return motion.radius * x + arm * turn, motion.radius + 1j * arm * (1.0 - turn)
        arm = motion.arc_end + 1j * motion.half_height
        start = motion.half_width + motion.radius * motion.beta
        return (start - arm) + arm * turn, 1j * arm * (1.0 - turn)

    def elongation(self, x: float, *, rolling: bool) -> tuple[float, float]:
        """e(x) and de/dx of a tendon [m]."""
        z, slope = self.opening(x, rolling=rolling)
        if z == 0.0:
            return 0.0, 2.0 * abs(slope)
        return 2.0 * abs(z), 2.0 * (z.conjugate() * slope).real / abs(z)

    def tension(self, k: int, tendon: Tendon, e: float) -> float:
        if self.branches[k] == "elastic":
            return tendon.prestress + tendon.stiffness * (e - self.plastic[k])
        return tendon.yield_force if self.branches[k] == "yielding" else 0.0

    def moments(
        self, contact: Contact, theta: float, rate: float, direction: int
    ) -> Iterator[tuple[float, float]]:
        """Of each device: the moment against theta's growth, split into active and frictional."""
        side, x = contact.side, contact.side * theta
        shift, slope, _ = self.lagrangian.cap_beam(x, rolling=contact.rolling)
        speed = slope.real * rate
        for k, device in enumerate(self.devices):
            if isinstance(device, Viscous):
                force = device.coefficient * abs(speed) ** device.exponent
                yield -math.copysign(force, speed) * slope.real, 0.0
            elif isinstance(device, Friction):
                yield 0.0, -direction * device.force * slope.real
            elif isinstance(device, RollingResistance):
                weight = self.lagrangian.lifted_mass * self.lagrangian.system.gravity
                yield 0.0, -direction * 2.0 * weight * device.lever
            elif isinstance(device, Stop):
                force = self.push(device, shift.real, side * speed)
                yield -side * force * slope.real * (self.branches[k] == "pushing"), 0.0
            else:
                e, growth = self.elongation(x, rolling=contact.rolling)
                yield -side * device.columns * self.tension(k, device, e) * growth, 0.0

    @staticmethod
    def push(stop: Stop, displacement: float, speed: float) -> float:
        return stop.stiffness * (displacement - stop.gap) + stop.damping * speed

    def at_rest(self, contact: Contact, theta: float) -> tuple[float, float]:
        """Moment of the devices without rate, and what friction holds beside it, both [N m]."""
        pairs = list(self.moments(contact, theta, 0.0, 1))
        return sum(active for active, _ in pairs), -sum(held for _, held in pairs)

    @property
    def turns(self) -> bool:
        """Whether some force changes its law where the rate changes its sign."""
        return any(
            isinstance(device, Friction | RollingResistance | Tendon)
            or (isinstance(device, Viscous) and device.exponent != 1.0)
            for device in self.devices
        )

    def tilt_at(self, length: float, *, of: Literal["displacement", "elongation"]) -> float:
        """|theta| at which a length that grows with it is reached; infinite beyond the limit."""

        def excess(x: float) -> float:
            rolling = x < self.lagrangian.beta
            if of == "elongation":
                return self.elongation(x, rolling=rolling)[0] - length
            return self.lagrangian.cap_beam(x, rolling=rolling)[0].real - length

        if length <= 0.0:
            return 0.0 if length == 0.0 else -math.inf
        if excess(self.limit) < 0.0:
            return math.inf
        return float(brentq(excess, 0.0, self.limit, xtol=1e-16, rtol=1e-15))

    def changes(self) -> list[Change]:
        """Where |theta| takes a device to another branch, until one does."""
        state = (tuple(self.branches), tuple(self.plastic))
        if self._searched is None or self._searched[0] != state:
            self._searched = (state, list(self._changes()))
        return self._searched[1]

    def _changes(self) -> Iterator[Change]:
        for k, device in enumerate(self.devices):
            branch = self.branches[k]
            if isinstance(device, Stop) and device.gap > 0.0:
                gap = self.tilt_at(device.gap, of="displacement")
                met = branch == "open"
                yield Change(gap, 1 if met else -1, k, "pushing" if met else "open")
            elif isinstance(device, Tendon):
                room = device.yield_force - device.prestress
                free = self.plastic[k] - device.prestress / device.stiffness
                if branch == "elastic":
                    full = self.plastic[k] + room / device.stiffness
                    yield Change(self.tilt_at(full, of="elongation"), 1, k, "yielding")
                    if free > 0.0:
                        yield Change(self.tilt_at(free, of="elongation"), -1, k, "slack")
                elif branch == "slack":
                    yield Change(self.tilt_at(free, of="elongation"), 1, k, "elastic")

    def letting_go(self) -> Iterator[tuple[int, Stop]]:
        """Stops whose damper may pull, or stop pulling, beyond the gap."""
        for k, device in enumerate(self.devices):
            if isinstance(device, Stop) and device.damping and self.branches[k] != "open":
                yield k, device

    def turn(self, x: float, *, outwards: bool, rolling: bool) -> None:
        """Tendons that yielded unload from here; one that is drawn on goes on yielding."""
        for k, device in enumerate(self.devices):
            if isinstance(device, Tendon) and self.branches[k] == "yielding" and not outwards:
                e, _ = self.elongation(x, rolling=rolling)
                self.plastic[k] = e - (device.yield_force - device.prestress) / device.stiffness
                self.branches[k] = "elastic"

    def release(self, x: float, *, rolling: bool) -> None:
        """The branches of a storey that was drawn to a tilt before it is let go."""
        displacement = self.lagrangian.cap_beam(x, rolling=rolling)[0].real
        e, _ = self.elongation(x, rolling=rolling)
        for k, device in enumerate(self.devices):
            if isinstance(device, Stop) and displacement > device.gap:
                self.branches[k] = "pushing"
            if isinstance(device, Tendon):
                room = (device.yield_force - device.prestress) / device.stiffness
                self.plastic[k] = max(0.0, e - room)
