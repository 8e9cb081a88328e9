"""A second road through histories of a storey under both horizontal components.

It shares nothing with the program: the unknowns are the Cartesian tilt (X, Y) and the floors'
displacements (`spatial_lagrangian`), the steps those of DOP853 restarted at every sample of the
record and at every event, full contact the matrix exponentials of both directions. Where the tilt
falls below `TIP` the storey crosses the rest of the cone, unrolled, in a straight line.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from .crossings import Array, Curve, Rates, Stepper
from .devices import OracleDevice
from .full_contact import FullContact
from .spatial_lagrangian import SpatialDevices, SpatialLagrangian
from .storey_lagrangian import Contact, OracleSystem

TIP = 1e-10
_BEGINNING = 1e-12  # tilt at which an uplift is handed over to the integrator
_ORDER = 12  # of the pushes within a quarter of a radian of the fastest mode: 1e-17 of them is left


@dataclass
class Passed:
    """One closest approach: when, tilt, share of an impact's loss, energy lost."""

    time: float
    tilt: float
    share: float
    lost: float


class SpatialSimulation(Stepper):
    """The state y = [X, Y, u_x, u_y and their rates], floors relative to the ground."""

    def __init__(
        self,
        along_x: OracleSystem,
        along_y: OracleSystem | None = None,
        *,
        axial: float | None = None,
        contact_time: float = 0.0,
        recontact: float = 1e-6,
        rtol: float = 1e-11,
        limit: float = 2.0,
        integrated_spin: bool = False,
        begins_at: float | None = None,
        devices: tuple[OracleDevice, ...] = (),
    ) -> None:
        """`begins_at`: uplifts start at rest at this tilt, not with the cube of the time."""
        along_y, self.begins_at = along_y or along_x, begins_at
        if axial is None:  # a solid round column as wide as its arcs
            axial = 0.5 * along_x.tan_alpha_wedge**2 / (1.0 + along_x.tan_alpha**2)
        self.motion = SpatialLagrangian(along_x, along_y, axial, integrated_spin=integrated_spin)
        plane = self.plane = self.motion.plane
        self.devices = self.motion.devices = SpatialDevices(plane, devices)
        self.fixed = [FullContact(type(plane)(way)) for way in (along_x, along_y)]
        self.alpha = math.atan(along_x.tan_alpha)
        self.contact_time, self.rtol = contact_time, rtol
        self.negligible = recontact * self.alpha
        self.limit = limit * plane.critical_rotation
        self.restitution = type(plane)(replace(along_x, law="flexible")).restitution
        slope = plane.cap_beam(0.0, rolling=plane.beta > 0.0)[1]
        self.falling = self.motion.tilt_inertia(slope)  # A(0)
        sideways = along_x.columns_mass / 4.0 + along_x.cap_beam_mass
        self.going_round = plane.spin_inertia + sideways * slope.real**2  # K(0)
        self.lever = slope.real
        self.y: Array = np.zeros(4 + 4 * plane.storeys)
        self.standing, self.rolling, self.overturned = True, plane.beta > 0.0, False
        self.time = self.end = self.max_tilt = 0.0
        self.tolerance = np.full(len(self.y), 1e-3 * rtol)
        # towards the tip positions decide; rates have the rounding of theta'^2/theta in them
        self.tolerance[:2], self.tolerance[self.half :][:2] = 1e-6 * rtol, 1e-4 * rtol
        self.uplifts: list[tuple[float, float]] = []
        self.passes: list[Passed] = []

    @property
    def half(self) -> int:
        return len(self.y) // 2

    def release(self, tilt: tuple[float, float], rate: tuple[float, float]) -> None:
        """With the springs at ease and the floors at the beam's velocity."""
        n, half = self.motion.storeys, self.half
        x = math.hypot(*tilt)
        self.standing, self.rolling, self.max_tilt = False, x < self.plane.beta, x
        self.y[:2], self.y[half : half + 2] = tilt, rate
        beam, beam_rate = self.beam()
        self.y[2:half], self.y[half + 2 :] = np.repeat(beam, n), np.repeat(beam_rate, n)

    def beam(self) -> tuple[Array, Array]:
        """Displacement and velocity of the cap beam."""
        tilt, rate = self.y[:2], self.y[self.half : self.half + 2]
        x = math.hypot(*tilt)
        here = self.motion.section(x, rolling=self.rolling)
        outwards = tilt / x
        grows = float(outwards @ rate)
        around = rate - grows * outwards
        shift, slope = here.shift.real, here.slope.real
        return shift * outwards, slope * grows * outwards + shift / x * around

    # full contact

    def fixed_state(self, ground: Array, slope: Array, way: int) -> Array:
        n, half = self.motion.storeys, self.half
        floors, rates = self.y[2:half].reshape(2, n)[way], self.y[half + 2 :].reshape(2, n)[way]
        drifts = np.diff(floors, prepend=0.0), np.diff(rates, prepend=0.0)
        return np.concatenate((*drifts, [ground[way], slope[way]]))

    def margin(self, ground: Array, slope: Array, h: float) -> Array:
        """Pushes of both directions and what holds, as polynomials of the time over h."""
        rows = []
        powers = h ** np.arange(_ORDER + 1)
        for way, fixed in enumerate(self.fixed):
            rows.append(fixed.taylor[: _ORDER + 1] @ self.fixed_state(ground, slope, way) * powers)
        hold = np.zeros(_ORDER + 1)
        weight = self.plane.lifted_mass * math.tan(self.alpha)
        hold[:2] = weight * (self.motion.system.gravity + ground[2]), weight * slope[2] * h
        upright = Contact(1, rolling=self.plane.beta > 0.0)
        active, held = self.devices.at_rest(upright, 0.0)
        hold[0] += (held - active) / self.lever
        return np.array([*rows, hold])

    def stand(self, ground: Array, slope: Array, duration: float) -> float:
        """Full contact until uplift or the end; returns the time that passed."""
        fastest = max(fixed.fastest for fixed in self.fixed)
        pieces = max(1, math.ceil(4.0 * duration * fastest))
        h = duration / pieces
        for piece in range(pieces):
            here = ground + slope * (piece * h)
            push_x, push_y, hold = self.margin(here, slope, h)
            least = hold[0] - abs(hold[1])
            if math.hypot(np.sum(np.abs(push_x)), np.sum(np.abs(push_y))) >= least:
                excess = np.convolve(push_x, push_x) + np.convolve(push_y, push_y)
                excess -= np.convolve(hold, hold)
                found = 0.0 if excess[0] > 0.0 else Curve(excess).crossing(0.0, 1)
                if found is not None:
                    self.stay(here, slope, found * h)
                    at = piece * h + found * h
                    return at + self.lift(ground + slope * at, slope, duration - at)
            self.stay(here, slope, h)
        return duration

    def stay(self, ground: Array, slope: Array, tau: float) -> None:
        """The building on its fixed base for a time tau."""
        n, half = self.motion.storeys, self.half
        for way, fixed in enumerate(self.fixed):
            z = fixed.over(self.fixed_state(ground, slope, way), tau)
            self.y[2:half].reshape(2, n)[way] = np.cumsum(z[:n])
            self.y[half + 2 :].reshape(2, n)[way] = np.cumsum(z[n : 2 * n])

    def lift(self, ground: Array, slope: Array, left: float) -> float:
        """The first instants of an uplift: along the push, by its excess m_0 + m_1 t."""
        push_x, push_y, hold = self.margin(ground, slope, 1.0)
        size = math.hypot(push_x[0], push_y[0])
        growth = (push_x[0] * push_x[1] + push_y[0] * push_y[1]) / size - hold[1]
        excess = max(size - hold[0], 0.0) * self.lever / self.falling
        growth *= self.lever / self.falling
        tau = (6.0 * _BEGINNING / growth) ** (1.0 / 3.0) if growth > 0.0 else math.inf
        if excess > 0.0:
            tau = min(tau, math.sqrt(2.0 * _BEGINNING / excess))
        tau = min(tau, 0.5 * left)
        self.uplifts.append((self.end - left, math.atan2(push_y[0], push_x[0])))
        tau *= self.begins_at is None
        self.stay(ground, slope, tau)
        push_x, push_y, _ = self.margin(ground + slope * tau, slope, 1.0)
        outwards = np.array([push_x[0], push_y[0]]) / math.hypot(push_x[0], push_y[0])
        tilt = self.begins_at or excess * tau**2 / 2.0 + growth * tau**3 / 6.0
        rate = 0.0 if self.begins_at else excess * tau + growth * tau**2 / 2.0
        self.y[:2], self.y[self.half : self.half + 2] = tilt * outwards, rate * outwards
        self.standing, self.rolling, self.step = False, self.plane.beta > 0.0, 0.1 * tau or 1e-6
        return tau

    # tilted

    def rates(self, ground: Array, slope: Array) -> Rates:
        rolling, half = self.rolling, self.half

        def rates(tau: float, y: Any) -> Any:
            moved = self.motion.accelerations(y, ground + slope * tau, rolling=rolling)
            return np.concatenate((y[half:], moved))

        return rates

    def curves(self, y: Array) -> Array:
        """theta and theta theta' of states in columns."""
        half = self.half
        return np.array(
            [np.hypot(y[0], y[1]), y[0] * y[half] + y[1] * y[half + 1]],
        )

    def tilted(self, ground: Array, slope: Array, duration: float) -> float:
        """Tilted until an event or the end; returns the time that passed."""
        rates, levels = self.rates(ground, slope), [("limit", self.limit, 1), ("tip", TIP, -1)]
        if self.plane.beta > 0.0:
            levels.append(("phase", self.plane.beta, 1 if self.rolling else -1))
        for step in self.steps(rates, duration):
            curve, radial = (Curve.through(values) for values in self.curves(step.states))
            roots = [(curve.crossing(level, way, curve.noise), kind) for kind, level, way in levels]
            # a steady wobble has nothing but rounding here
            noise = 1e-12 * curve.end * float(np.abs(step.states[self.half :, -1][:2]).sum())
            roots.append((radial.crossing(0.0, 1, noise), "pass"))
            if self.devices.yields(
                float(np.max(self.curves(step.states)[0])), rolling=self.rolling
            ):
                roots.append((radial.crossing(0.0, -1, noise), "turn"))
            events = [(root, kind) for root, kind in roots if root is not None]
            at, kind = min(events, default=(1.0, ""))
            self.max_tilt = max(self.max_tilt, curve.highest(at))
            if kind:
                tau = self.meet(rates, partial(self.miss, kind), step, at)
                self.step = step.h
                self.switch(kind, ground + slope * tau, slope, self.end - duration + tau)
                return tau
        return duration

    def miss(self, kind: str, y: Array) -> float:
        theta, moving = self.curves(y)
        level = {"limit": self.limit, "tip": TIP, "phase": self.plane.beta}
        return float(moving if kind in ("pass", "turn") else theta - level[kind])

    def switch(self, kind: str, ground: Array, slope: Array, time: float) -> None:
        if kind == "phase":
            self.rolling = not self.rolling
        elif kind == "limit":
            self.overturned = True
        elif kind == "turn":
            self.devices.unload(math.hypot(self.y[0], self.y[1]), rolling=self.rolling)
        elif kind == "pass":
            self.approach(ground, slope, time)
        else:
            self.cross(ground, slope, time)

    def share_lost(self, tilt: float, rate: float) -> float:
        """l(s) of Theory, section 13."""
        if self.contact_time == 0.0 or rate == 0.0:
            return 0.0
        s = tilt / (rate * self.contact_time)
        return float(1.0 / (1.0 + 3.5 * s**1.04 + 2.0 * s**2.7))

    def spare_turn(self) -> float:
        return math.pi * (math.sqrt(self.falling / self.going_round) - 1.0)

    def turn(self, angle: float, scale: float) -> None:
        """The tilt and, scaled, its rate are turned; floors stay where they are."""
        c, s = math.cos(angle), math.sin(angle)
        matrix, half = np.array([[c, -s], [s, c]]), self.half
        self.y[:2] = matrix @ self.y[:2]
        self.y[half : half + 2] = scale * (matrix @ self.y[half : half + 2])

    def approach(self, ground: Array, slope: Array, time: float) -> None:
        """What the closest approach loses, and whether the storey comes down there."""
        half = self.half
        tilt = math.hypot(self.y[0], self.y[1])
        around = float(self.y[0] * self.y[half + 1] - self.y[1] * self.y[half]) / tilt
        share = self.share_lost(tilt, abs(around))
        before = self.motion.energy(self.y, rolling=self.rolling)
        scale = math.sqrt(1.0 - share * (1.0 - self.restitution**2))
        # exactly tangential: the next step shall not find this approach again
        self.y[half : half + 2] = around / tilt * np.array([-self.y[1], self.y[0]])
        self.turn(-math.copysign(share * self.spare_turn(), around), scale)
        self.come_down(ground, slope, tilt, self.going_round * (scale * around) ** 2)
        lost = before - self.motion.energy(self.y, rolling=self.rolling)
        self.passes.append(Passed(time, tilt, share, lost))

    def cross(self, ground: Array, slope: Array, time: float) -> None:
        """Across the tip of the cone, unrolled: a straight line at the distance `near`."""
        half = self.half
        tilt = math.hypot(self.y[0], self.y[1])
        outwards = self.y[:2] / tilt
        rate = self.y[half : half + 2]
        radial = float(outwards @ rate)
        around = float(outwards[0] * rate[1] - outwards[1] * rate[0])
        opening = math.sqrt(self.going_round / self.falling)
        speed = math.hypot(radial, opening * around)
        near = tilt * opening * abs(around) / speed
        share = 1.0 if self.contact_time else 0.0
        if around != 0.0:
            share = self.share_lost(near, speed / opening)
        scale = math.sqrt(1.0 - share * (1.0 - self.restitution**2))
        before = self.motion.energy(self.y, rolling=self.rolling)
        swept = 2.0 * math.acos(min(near / tilt, 1.0)) / opening - share * self.spare_turn()
        angle = math.copysign(swept, around) if around else math.pi
        c, s = math.cos(angle), math.sin(angle)
        matrix = np.array([[c, -s], [s, c]])
        if around == 0.0:
            matrix = -np.eye(2)
        out = matrix @ outwards
        self.y[:2] = tilt * out
        self.y[half : half + 2] = scale * (-radial * out + around * np.array([-out[1], out[0]]))
        self.come_down(ground, slope, near, self.falling * (scale * speed) ** 2)
        lost = before - self.motion.energy(self.y, rolling=self.rolling)
        self.passes.append(Passed(time, near, share, lost))

    def come_down(self, ground: Array, slope: Array, tilt: float, twice_energy: float) -> None:
        """Full contact if neither this pass nor the next swing would be seen."""
        push_x, push_y, hold = self.margin(ground, slope, 1.0)
        spare = hold[0] - math.hypot(push_x[0], push_y[0])
        height = math.inf if spare <= 0.0 else twice_energy / (2.0 * self.lever * spare)
        if max(tilt, height) < self.negligible:
            self.y[:2] = self.y[self.half : self.half + 2] = 0.0
            self.standing = True

    def advance(self, ground: Array, slope: Array, duration: float) -> None:
        """Through one interval in which the ground is linear."""
        tau, self.end = 0.0, self.time + duration
        while duration - tau > 1e-13 * duration and not self.overturned:
            passed = self.stand if self.standing else self.tilted
            tau += passed(ground + slope * tau, slope, duration - tau)
        self.time = self.end


def simulate_pair(
    simulation: SpatialSimulation, ground: Array, dt: float, duration: float
) -> Array:
    """States at the samples of `ground` (3, m: a_x, a_y, a_v), which is zero after the last one."""
    states = [simulation.y.copy()]
    for j in range(round(duration / dt)):
        if j < ground.shape[1] - 1:
            rate = (ground[:, j + 1] - ground[:, j]) / dt
            simulation.advance(ground[:, j], rate, dt)
        else:
            simulation.advance(np.zeros(3), np.zeros(3), dt)
        if simulation.overturned:
            break
        states.append(simulation.y.copy())
    return np.array(states)
