"""Exact solutions: rigid frames by quadrature of their energy, statics, modes, and uplift.

Lengths come from the complex contact geometry of `storey_lagrangian`. Differences between two tilts
are formed as products, so that they keep their digits where a swing turns.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from functools import partial
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from oracles.crossings import Array
from oracles.devices import Friction, OracleDevice, RollingResistance, Stop, Tendon
from oracles.full_contact import FullContact
from oracles.storey_lagrangian import OracleSystem, StoreyLagrangian
from scipy.linalg import expm
from scipy.optimize import brentq

NODES, WEIGHTS = np.polynomial.legendre.leggauss(60)


def integral(of: Callable[[float], float], start: float, end: float) -> float:
    """By sixty points of Gauss: exact to rounding for what is analytic nearby."""
    half = 0.5 * (end - start)
    values = [of(start + half * (1.0 + z)) for z in NODES]
    return half * float(WEIGHTS @ np.array(values))


def tilt_at(of: Callable[[float], float], value: float, high: float) -> float:
    """Where a function that grows from 0 on takes a value."""
    return float(brentq(lambda x: of(x) - value, 0.0, high, xtol=1e-16, rtol=1e-15))


class Hit(NamedTuple):
    """An impact: when, and |theta'| just before."""

    time: float
    rate: float


class RigidFrame:
    """A rigid frame or block that swings freely, with devices or without; |theta| below its end."""

    def __init__(self, system: OracleSystem, devices: tuple[OracleDevice, ...] = ()) -> None:
        self.motion, self.devices = StoreyLagrangian(system), devices
        self.weight = self.motion.lifted_mass * system.gravity

    def moved(self, high: float, low: float) -> complex:
        """w(high) - w(low) of the cap beam."""
        motion, border = self.motion, self.motion.beta
        if low < border < high:
            return self.moved(high, border) + self.moved(border, low)
        rolling = high <= border and border > 0.0
        # exp(-i low) - exp(-i high)
        turned = 2j * math.sin(0.5 * (high - low)) * cmath.exp(-0.5j * (high + low))
        if rolling:
            return 2.0 * motion.radius * (high - low) + 2.0 * motion.arc_frame * turned
        return 2.0 * motion.arc_end * turned

    def fallen(self, high: float, low: float, way: int) -> float:
        """Kinetic energy from a turn at `high` to `low` (way -1), or lost from `low` to it (+1)."""
        moved, far = self.moved(high, low), self.moved(high, 0.0).real
        energy = self.weight * moved.imag
        for device in self.devices:
            if isinstance(device, Friction):
                energy += way * device.force * moved.real
            elif isinstance(device, RollingResistance):
                energy += way * 2.0 * self.weight * device.lever * (high - low)
            elif isinstance(device, Stop):
                # of k (u - d)^2/2 beyond the gap
                beyond = max(far - device.gap, 0.0)
                left = max(far - moved.real - device.gap, 0.0)
                near = moved.real if left > 0.0 else beyond
                energy += 0.5 * device.stiffness * near * (beyond + left)
            elif isinstance(device, Tendon):
                # between the middles of flat ends: e = 4 B sin(x/2)
                width = 4.0 * self.motion.half_width
                e, longer = width * math.sin(0.5 * high), 2.0 * width
                longer *= math.cos(0.25 * (high + low)) * math.sin(0.25 * (high - low))
                mean = device.prestress + device.stiffness * (e - 0.5 * longer)
                energy += device.columns * longer * mean
        return energy

    def inertia(self, x: float) -> float:
        """Of theta'^2/2."""
        rolling = x <= self.motion.beta and self.motion.beta > 0.0
        slope = self.motion.cap_beam(x, rolling=rolling)[1]
        return self.motion.spin_inertia + self.motion.moving_mass * abs(slope) ** 2

    def breaks(self, high: float) -> list[float]:
        """Tilts at which a law changes, from 0 to the turn."""
        found = [0.0, self.motion.beta]
        gaps = [device.gap for device in self.devices if isinstance(device, Stop)]
        reached = (gap for gap in gaps if self.moved(high, 0.0).real > gap > 0.0)
        found += [tilt_at(lambda x: self.moved(x, 0.0).real, gap, high) for gap in reached]
        return [*sorted(x for x in set(found) if x < high), high]

    def duration(self, high: float, low: float, way: int) -> float:
        """Between the turn at `high` and `low`."""
        places = [low, *(x for x in self.breaks(high) if x > low)]

        def slowness(x: float) -> float:
            return math.sqrt(0.5 * self.inertia(x) / self.fallen(high, x, way))

        total = sum(integral(slowness, a, b) for a, b in pairwise(places[:-1]))
        span = high - places[-2]
        # x = high - span s^2 takes the root out of the last piece
        return total + integral(lambda s: 2.0 * span * s * slowness(high - span * s * s), 0.0, 1.0)

    def impacts(self, release: float, count: int) -> list[Hit]:
        """Of a release at rest, with theta'+ = e theta'-."""
        found: list[Hit] = []
        high, time = release, self.duration(release, 0.0, -1)
        for _ in range(count):
            energy = self.fallen(high, 0.0, -1)
            found.append(Hit(time, math.sqrt(2.0 * energy / self.inertia(0.0))))
            left = energy * self.motion.restitution**2
            high = tilt_at(partial(self.fallen, low=0.0, way=1), left, high)
            time += self.duration(high, 0.0, 1) + self.duration(high, 0.0, -1)
        return found

    def tilt_after(self, release: float, time: float) -> float:
        """Of spherical ends, which pass upright without loss: theta at a time."""
        quarter = self.duration(release, 0.0, -1)
        rest, side = time % (4.0 * quarter), 1.0
        if rest > 2.0 * quarter:  # the other half of the swing is its image
            rest, side = rest - 2.0 * quarter, -1.0
        if rest > quarter:
            rest, side = 2.0 * quarter - rest, -side
        least = release * (1.0 - 1e-6)
        return side * float(
            brentq(
                lambda x: self.duration(release, x, -1) - rest, 0.0, least, xtol=1e-16, rtol=1e-15
            )
        )


class Statics(NamedTuple):
    """Of the uplifted podium."""

    uplift: float
    critical: float
    displacement: float
    lift: float
    force: float
    energy: float


def statics(system: OracleSystem, rotation: float) -> Statics:
    """Force at uplift and at a rotation, and where the weight restores no longer."""
    motion = StoreyLagrangian(system)
    weight = motion.lifted_mass * system.gravity

    def at(x: float) -> tuple[complex, complex, complex]:
        return motion.cap_beam(x, rolling=x <= motion.beta and motion.beta > 0.0)

    critical = brentq(lambda x: at(x)[1].imag, 1e-3, 0.6, xtol=1e-16, rtol=1e-15)
    first, there, far = at(0.0)[1], at(rotation)[1], at(critical)[0]
    return Statics(
        weight * first.imag / first.real, critical, far.real, far.imag,
        weight * there.imag / there.real, weight * far.imag,
    )  # fmt: skip


def uplifted_roots(system: OracleSystem) -> Array:
    """Eigenvalues of small motions on one side from tilt 0, in tilt and drifts."""
    motion, n = StoreyLagrangian(system), len(system.masses)
    _, slope, bend = motion.cap_beam(0.0, rolling=motion.beta > 0.0)
    stiffness = np.diag([motion.lifted_mass * system.gravity * bend.imag, *system.stiffnesses])
    damping = np.zeros((n + 1, n + 1))
    damping[1:, 1:] = motion.drift_damping
    flow = np.zeros((2 * n + 2, 2 * n + 2))
    flow[: n + 1, n + 1 :] = np.eye(n + 1)
    both = np.column_stack((stiffness, damping))
    flow[n + 1 :] = -np.linalg.solve(motion.mass_matrix(slope), both)
    return np.asarray(np.linalg.eigvals(flow))


def uplift_time(system: OracleSystem, a_g: Array, dt: float) -> float:
    """First uplift under a polygon, by matrix exponentials."""
    motion, n = StoreyLagrangian(system), len(system.masses)
    contact = FullContact(motion)
    flow, push = contact.flow, contact.taylor[0]
    hold = motion.lifted_mass * system.gravity * system.tan_alpha
    state = np.zeros(2 * n + 2)

    def spare(tau: float, begun: Array) -> float:
        return abs(float(push @ expm(flow * tau) @ begun)) - hold

    steps = 50
    for j in range(len(a_g) - 1):
        state[2 * n :] = a_g[j], (a_g[j + 1] - a_g[j]) / dt
        for i in range(steps):
            begun = expm(flow * (i * dt / steps)) @ state
            if spare(dt / steps, begun) > 0.0:
                tau = brentq(spare, 0.0, dt / steps, args=(begun,), xtol=1e-17, rtol=1e-15)
                return (j + i / steps) * dt + float(tau)
        state = expm(flow * dt) @ state
    raise RuntimeError("it does not lift")


def least_tilt(system: OracleSystem, axial: float, tilt: float, turning: float) -> float:
    """Where free motion of a rigid frame on flat ends, begun so, comes nearest to upright.

    `axial` is the inertia of all columns about their axes [kg m2].
    """
    motion = StoreyLagrangian(system)

    def round_inertia(x: float) -> float:
        around = motion.moving_mass * motion.cap_beam(x, rolling=False)[0].real ** 2
        turned = motion.spin_inertia * math.sin(x) ** 2
        return float(around + turned + axial * (1.0 - math.cos(x)) ** 2)

    momentum = round_inertia(tilt) * turning
    frame = RigidFrame(system)

    def excess(x: float) -> float:
        """Of the energy of the turning over what the fall from the beginning gives."""
        spin = 1.0 / round_inertia(x) - 1.0 / round_inertia(tilt)
        return 0.5 * momentum**2 * spin - frame.fallen(tilt, x, -1)

    return float(brentq(excess, 1e-3, 0.7 * tilt, xtol=1e-16, rtol=1e-15))
