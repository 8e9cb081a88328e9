"""Devices between ground and cap beam as generalised forces on the tilt.

All of them follow from two lengths: the cap beam's displacement Re w(x) of `storey_lagrangian` and
the opening of the joints at the columns' axis. The middle of the lower end, -i H in the column's
frame, moves by z = w/2 + i H (1 - exp(-i x)), the middle of the upper one stays behind the cap beam
by as much: a tendon through both elongates by e = 2 |z|.

Laws are functions, clipped where the program follows branches: integrators find the kinks by
themselves. Only what a tendon has yielded is remembered.
"""

import cmath
import math
from dataclasses import dataclass


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

    def push(self, displacement, speed):
        """Against a displacement that grows with a speed."""
        if displacement <= self.gap:
            return 0.0
        return max(self.stiffness * (displacement - self.gap) + self.damping * speed, 0.0)


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


class Equipment:
    """The devices of a storey, with the elongation that each tendon keeps [m]."""

    def __init__(self, lagrangian, devices):
        self.lagrangian, self.devices = lagrangian, devices
        self.plastic = [0.0] * len(devices)

    def opening(self, x, *, rolling):
        """z(x) and dz/dx [m]; x is taken out of differences, so that small ones keep digits."""
        motion = self.lagrangian
        turn = 2j * math.sin(0.5 * x) * cmath.exp(-0.5j * x)  # 1 - exp(-i x)
        if rolling:
            arm = complex(motion.half_width, motion.radius)
            return motion.radius * x + arm * turn, motion.radius + 1j * arm * (1.0 - turn)
        arm = motion.arc_end + 1j * motion.half_height
        start = motion.half_width + motion.radius * motion.beta
        return (start - arm) + arm * turn, 1j * arm * (1.0 - turn)

    def elongation(self, x, *, rolling):
        """e(x) and de/dx of a tendon [m]."""
        z, slope = self.opening(x, rolling=rolling)
        if z == 0.0:
            return 0.0, 2.0 * abs(slope)
        return 2.0 * abs(z), 2.0 * (z.conjugate() * slope).real / abs(z)

    def tension(self, k, tendon, e):
        elastic = tendon.prestress + tendon.stiffness * (e - self.plastic[k])
        return min(max(elastic, 0.0), tendon.yield_force)

    def rolling(self, device):
        """Moment of the resistance."""
        return (
            2.0
            * self.lagrangian.lifted_mass
            * self.lagrangian.system.gravity
            * device.lever
        )

    def moments(self, contact, theta, rate, direction):
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
                yield 0.0, -direction * self.rolling(device)
            elif isinstance(device, Stop):
                yield -side * device.push(shift.real, side * speed) * slope.real, 0.0
            else:
                e, growth = self.elongation(x, rolling=contact.rolling)
                yield -side * device.columns * self.tension(k, device, e) * growth, 0.0

    def at_rest(self, contact, theta):
        """Moment of the devices without rate, and what friction holds beside it, both [N m]."""
        pairs = list(self.moments(contact, theta, 0.0, 1))
        return sum(active for active, _ in pairs), -sum(held for _, held in pairs)

    @property
    def turns(self):
        """Whether some force changes its law where the rate changes its sign."""
        return any(
            isinstance(device, Friction | RollingResistance | Tendon)
            or (isinstance(device, Viscous) and device.exponent != 1.0)
            for device in self.devices
        )

    def yields(self, x, *, rolling):
        """Whether a tendon is at its limit."""
        return any(
            self.tension(k, d, self.elongation(x, rolling=rolling)[0]) >= d.yield_force
            for k, d in enumerate(self.devices)
            if isinstance(d, Tendon)
        )

    def unload(self, x, *, rolling):
        """The tilt turns: what yielded keeps its elongation."""
        e, _ = self.elongation(x, rolling=rolling)
        for k, device in enumerate(self.devices):
            if isinstance(device, Tendon):
                room = (device.yield_force - device.prestress) / device.stiffness
                self.plastic[k] = max(self.plastic[k], e - room)
