"""A second road through histories of a storey under both horizontal components.

It shares nothing with the program: the unknowns are the Cartesian tilt (X, Y) and the floors'
displacements, the steps those of DOP853 restarted at every sample of the
record and at every event, full contact the matrix exponentials of both directions. Where the tilt
falls below `TIP` the storey crosses the rest of the cone, unrolled, in a straight line.

Lagrange's equations are those of a storey that tilts to any side:
X = theta cos(phi), Y = theta sin(phi), and the floors' displacements relative to the ground. The
section of a column through its axis and its contact is that of `storey_lagrangian`, so the cap beam
moves by u(theta) towards the azimuth phi and v(theta) upwards. A column that keeps its place on its
circle of the radius `path` on the ground turns about its own axis by psi' = -kappa phi',
kappa = path/rim, `rim` being the distance of the contact from the axis. That is a condition on
velocities: only the part of dJ/dtheta that leaves kappa alone acts (Theory, section 13).
"""

import cmath
import math
from dataclasses import dataclass, replace
from functools import partial
from typing import NamedTuple

import numpy as np

from .crossings import Curve, Stepper
from .devices import (
    Equipment,
    Friction,
    RollingResistance,
    Stop,
    Tendon,
    Viscous,
)
from .full_contact import FullContact
from .storey_lagrangian import Contact, StoreyLagrangian

TIP = 1e-10
_BEGINNING = 1e-12  # tilt at which an uplift is handed over to the integrator
_ORDER = 12  # of the pushes within a quarter of a radian of the fastest mode: 1e-17 of them is left


class Section(NamedTuple):
    """Of one tilt: the cap beam and its first two derivatives, and what turns round."""

    shift: complex
    slope: complex
    bend: complex
    inertia: float  # J [kg m2] of phi'
    spinning: float  # dJ/dtheta at fixed kappa
    twisting: float  # what is left of dJ/dtheta
    kappa: float


class SpatialDevices(Equipment):
    """Devices as forces on the Cartesian tilt; sums over all of a kind."""

    def on_beam(self, rate):
        """Force against a velocity of the cap beam."""
        speed = math.hypot(*rate)
        if speed == 0.0:
            return np.zeros(2)
        force = 0.0
        for device in self.devices:
            if isinstance(device, Viscous):
                force += device.coefficient * speed**device.exponent
            elif isinstance(device, Friction):
                force += device.force
        return -force / speed * rate

    def against_tilt(self, x, shift, slope, rate, *, rolling):
        """Moment of stops and tendons against theta, which is at x."""
        moment = 0.0
        for k, device in enumerate(self.devices):
            if isinstance(device, Stop):
                moment += device.push(shift, slope * rate) * slope
            elif isinstance(device, Tendon):
                e, growth = self.elongation(x, rolling=rolling)
                moment += device.columns * self.tension(k, device, e) * growth
        return moment

    def against_rolling(self, grows, swings):
        """Moments against theta' and theta phi'."""
        moment = sum(
            self.rolling(d) for d in self.devices if isinstance(d, RollingResistance)
        )
        rolls = math.hypot(grows, swings)
        return moment / rolls * np.array([grows, swings]) if moment else np.zeros(2)


class SpatialLagrangian:
    """Masses and contact alike in x and y; stiffness and damping of each direction."""

    def __init__(self, along_x, along_y, axial, *, integrated_spin=False):
        """`axial` is I_3/(m_c R^2); `integrated_spin` lets all of dJ/dtheta act, as the program."""
        self.integrated_spin = integrated_spin
        self.devices = None
        self.system, self.directions = along_x, (along_x, along_y)
        self.plane = StoreyLagrangian(along_x)
        self.storeys, self.critical_rotation = (
            self.plane.storeys,
            self.plane.critical_rotation,
        )
        self.axial = axial * along_x.columns_mass * along_x.R**2
        n = self.storeys
        between = np.eye(n) - np.eye(n, k=-1)
        self.springs = [
            between.T @ np.diag(way.stiffnesses) @ between for way in self.directions
        ]

    def section(self, x, *, rolling):
        plane = self.plane
        _, slope, bend = plane.cap_beam(x, rolling=rolling)
        # as there, but 1 - exp(-i x) without its cancellation towards the tip of the cone
        versed = 2j * math.sin(x / 2.0) * cmath.exp(-0.5j * x)
        if rolling:
            shift = 2.0 * plane.radius * x + 2.0 * plane.arc_frame * versed
        else:
            foot = complex(
                plane.half_width + plane.radius * plane.beta, -plane.half_height
            )
            shift = 2.0 * (foot - plane.arc_end) + 2.0 * plane.arc_end * versed
        arc = x if rolling else plane.beta
        path = plane.half_width + plane.radius * arc
        rim = plane.half_width + plane.radius * math.sin(arc)
        kappa = path / rim
        kappa_slope = plane.radius * (1.0 - kappa * math.cos(x)) / rim if rolling else 0.0
        sine, cosine, u = math.sin(x), math.cos(x), shift.real
        mass = self.system.columns_mass / 4.0 + self.system.cap_beam_mass
        spin = self.axial * (kappa - cosine)
        twisting = 2.0 * spin * kappa_slope
        acting = twisting if self.integrated_spin else 0.0
        return Section(
            shift,
            slope,
            bend,
            plane.spin_inertia * sine**2 + spin * (kappa - cosine) + mass * u**2,
            2.0
            * (plane.spin_inertia * sine * cosine + spin * sine + mass * u * slope.real)
            + acting,
            twisting - acting,
            kappa,
        )

    def tilt_inertia(self, slope):
        """Of theta': floors ride along upwards alone."""
        plane = self.plane
        sideways = self.system.columns_mass / 4.0 + self.system.cap_beam_mass
        return float(
            plane.spin_inertia
            + sideways * slope.real**2
            + plane.moving_mass * slope.imag**2
        )

    def storey_forces(self, floors, rates, beam, beam_rate):
        """K v + C v' of both directions, (2, n)."""
        forces = [
            spring @ (floors[i] - beam[i])
            + way.damping_matrix @ (rates[i] - beam_rate[i])
            for i, (spring, way) in enumerate(
                zip(self.springs, self.directions, strict=True)
            )
        ]
        return np.array(forces).reshape(2, self.storeys)

    def accelerations(self, y, ground, *, rolling):
        """Of [X, Y, floors along x, floors along y] under `ground` = a_x, a_y, a_v."""
        n, half = self.storeys, len(y) // 2
        tilt, rate = y[:2], y[half : half + 2]
        x = math.hypot(tilt[0], tilt[1])
        outwards = tilt / x
        around = np.array([-outwards[1], outwards[0]])
        grows, swings = float(outwards @ rate), float(around @ rate)  # theta', theta phi'
        turns = swings / x
        here = self.section(x, rolling=rolling)
        beam = here.shift.real * outwards
        beam_rate = here.slope.real * grows * outwards + here.shift.real * turns * around
        forces = self.storey_forces(
            y[2:half].reshape(2, n), y[half + 2 :].reshape(2, n), beam, beam_rate
        )
        push = forces.sum(axis=1) - self.plane.pushed_mass * ground[:2]
        gravity = self.system.gravity + ground[2]
        # d(A theta')/dt - (1/2) dA/dtheta theta'^2 - (1/2) dJ/dtheta phi'^2
        sideways = self.system.columns_mass / 4.0 + self.system.cap_beam_mass
        half_slope = sideways * here.slope.real * here.bend.real
        half_slope += self.plane.moving_mass * here.slope.imag * here.bend.imag
        outward = here.slope.real * float(outwards @ push)
        outward -= self.plane.lifted_mass * gravity * here.slope.imag
        outward += 0.5 * here.spinning * turns**2 - half_slope * grows**2
        around_held = 0.0
        if self.devices is not None:
            held = self.devices.on_beam(beam_rate)
            against = self.devices.against_rolling(grows, swings)
            outward += here.slope.real * float(outwards @ held) - float(against[0])
            outward -= self.devices.against_tilt(
                x, here.shift.real, here.slope.real, grows, rolling=rolling
            )
            around_held = here.shift.real * float(around @ held) - x * float(against[1])
        theta2 = outward / self.tilt_inertia(here.slope)
        sweep = here.shift.real * float(around @ push) + around_held
        sweep -= (here.spinning + 0.5 * here.twisting) * grows * turns
        phi2 = sweep / here.inertia
        out = np.empty(half)
        out[:2] = (theta2 - swings * turns) * outwards + (
            x * phi2 + 2.0 * grows * turns
        ) * around
        out[2:] = (-forces / self.system.masses - ground[:2, None]).ravel()
        return out

    def energy(self, y, *, rolling):
        """Kinetic and potential energy [J] relative to the ground; zero at rest."""
        n, half = self.storeys, len(y) // 2
        floors, rates = y[2:half].reshape(2, n), y[half + 2 :].reshape(2, n)
        x = math.hypot(y[0], y[1])
        energy = 0.5 * float(np.sum(self.system.masses * rates**2))
        beam = np.zeros(2)
        if x > 0.0:
            outwards = y[:2] / x
            here = self.section(x, rolling=rolling)
            grows = float(outwards @ y[half : half + 2])
            turns = float(outwards[0] * y[half + 1] - outwards[1] * y[half]) / x
            energy += 0.5 * (
                self.tilt_inertia(here.slope) * grows**2 + here.inertia * turns**2
            )
            energy += self.plane.lifted_mass * self.system.gravity * here.shift.imag
            beam = here.shift.real * outwards
        for i, spring in enumerate(self.springs):
            drift = floors[i] - beam[i]
            energy += 0.5 * float(drift @ spring @ drift)
        return energy


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
        along_x,
        along_y=None,
        *,
        axial=None,
        contact_time=0.0,
        recontact=1e-6,
        rtol=1e-11,
        limit=2.0,
        integrated_spin=False,
        begins_at=None,
        devices=(),
    ):
        """`begins_at`: uplifts start at rest at this tilt, not with the cube of the time."""
        along_y, self.begins_at = along_y or along_x, begins_at
        if axial is None:  # a solid round column as wide as its arcs
            axial = 0.5 * along_x.tan_alpha_wedge**2 / (1.0 + along_x.tan_alpha**2)
        self.motion = SpatialLagrangian(
            along_x, along_y, axial, integrated_spin=integrated_spin
        )
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
        self.y = np.zeros(4 + 4 * plane.storeys)
        self.standing, self.rolling, self.overturned = True, plane.beta > 0.0, False
        self.time = self.end = self.max_tilt = 0.0
        self.tolerance = np.full(len(self.y), 1e-3 * rtol)
        # towards the tip positions decide; rates have the rounding of theta'^2/theta in them
        self.tolerance[:2], self.tolerance[self.half :][:2] = 1e-6 * rtol, 1e-4 * rtol
        self.uplifts = []
        self.passes = []

    @property
    def half(self):
        return len(self.y) // 2

    def release(self, tilt, rate):
        """With the springs at ease and the floors at the beam's velocity."""
        n, half = self.motion.storeys, self.half
        x = math.hypot(*tilt)
        self.standing, self.rolling, self.max_tilt = False, x < self.plane.beta, x
        self.y[:2], self.y[half : half + 2] = tilt, rate
        beam, beam_rate = self.beam()
        self.y[2:half], self.y[half + 2 :] = np.repeat(beam, n), np.repeat(beam_rate, n)

    def beam(self):
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

    def fixed_state(self, ground, slope, way):
        n, half = self.motion.storeys, self.half
        floors, rates = (
            self.y[2:half].reshape(2, n)[way],
            self.y[half + 2 :].reshape(2, n)[way],
        )
        drifts = np.diff(floors, prepend=0.0), np.diff(rates, prepend=0.0)
        return np.concatenate((*drifts, [ground[way], slope[way]]))

    def margin(self, ground, slope, h):
        """Pushes of both directions and what holds, as polynomials of the time over h."""
        rows = []
        powers = h ** np.arange(_ORDER + 1)
        for way, fixed in enumerate(self.fixed):
            rows.append(
                fixed.taylor[: _ORDER + 1] @ self.fixed_state(ground, slope, way) * powers
            )
        hold = np.zeros(_ORDER + 1)
        weight = self.plane.lifted_mass * math.tan(self.alpha)
        hold[:2] = (
            weight * (self.motion.system.gravity + ground[2]),
            weight * slope[2] * h,
        )
        upright = Contact(1, rolling=self.plane.beta > 0.0)
        active, held = self.devices.at_rest(upright, 0.0)
        hold[0] += (held - active) / self.lever
        return np.array([*rows, hold])

    def stand(self, ground, slope, duration):
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

    def stay(self, ground, slope, tau):
        """The building on its fixed base for a time tau."""
        n, half = self.motion.storeys, self.half
        for way, fixed in enumerate(self.fixed):
            z = fixed.over(self.fixed_state(ground, slope, way), tau)
            self.y[2:half].reshape(2, n)[way] = np.cumsum(z[:n])
            self.y[half + 2 :].reshape(2, n)[way] = np.cumsum(z[n : 2 * n])

    def lift(self, ground, slope, left):
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
        self.standing, self.rolling, self.step = (
            False,
            self.plane.beta > 0.0,
            0.1 * tau or 1e-6,
        )
        return tau

    # tilted

    def rates(self, ground, slope):
        rolling, half = self.rolling, self.half

        def rates(tau, y):
            moved = self.motion.accelerations(y, ground + slope * tau, rolling=rolling)
            return np.concatenate((y[half:], moved))

        return rates

    def curves(self, y):
        """theta and theta theta' of states in columns."""
        half = self.half
        return np.array(
            [np.hypot(y[0], y[1]), y[0] * y[half] + y[1] * y[half + 1]],
        )

    def tilted(self, ground, slope, duration):
        """Tilted until an event or the end; returns the time that passed."""
        rates, levels = (
            self.rates(ground, slope),
            [("limit", self.limit, 1), ("tip", TIP, -1)],
        )
        if self.plane.beta > 0.0:
            levels.append(("phase", self.plane.beta, 1 if self.rolling else -1))
        for step in self.steps(rates, duration):
            curve, radial = (Curve.through(values) for values in self.curves(step.states))
            roots = [
                (curve.crossing(level, way, curve.noise), kind)
                for kind, level, way in levels
            ]
            # a steady wobble has nothing but rounding here
            noise = (
                1e-12 * curve.end * float(np.abs(step.states[self.half :, -1][:2]).sum())
            )
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

    def miss(self, kind, y):
        theta, moving = self.curves(y)
        level = {"limit": self.limit, "tip": TIP, "phase": self.plane.beta}
        return float(moving if kind in ("pass", "turn") else theta - level[kind])

    def switch(self, kind, ground, slope, time):
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

    def share_lost(self, tilt, rate):
        """l(s) of Theory, section 13."""
        if self.contact_time == 0.0 or rate == 0.0:
            return 0.0
        s = tilt / (rate * self.contact_time)
        return float(1.0 / (1.0 + 3.5 * s**1.04 + 2.0 * s**2.7))

    def spare_turn(self):
        return math.pi * (math.sqrt(self.falling / self.going_round) - 1.0)

    def tilt_and_rate(self):
        x, v = self.y[:2], self.y[self.half :][:2]
        return complex(x[0], x[1]), complex(v[0], v[1])

    def approach(self, ground, slope, time):
        """What the closest approach loses, and whether the storey comes down there."""
        z, rate = self.tilt_and_rate()
        tilt = abs(z)
        around = (z.conjugate() * rate).imag / tilt
        share = self.share_lost(tilt, abs(around))
        out = z / tilt * cmath.exp(-1j * math.copysign(share * self.spare_turn(), around))
        # exactly tangential: the next step shall not find this approach again
        beyond = Passed(time, tilt, share, self.going_round * around**2)
        self.go_on(ground, slope, beyond, tilt * out, 1j * around * out)

    def cross(self, ground, slope, time):
        """Across the tip of the cone, unrolled: a straight line at the distance `near`."""
        z, rate = self.tilt_and_rate()
        tilt = abs(z)
        turned = (z / tilt).conjugate() * rate
        radial, around = turned.real, turned.imag
        opening = math.sqrt(self.going_round / self.falling)
        speed = math.hypot(radial, opening * around)
        near = tilt * opening * abs(around) / speed
        share, out = (1.0 if self.contact_time else 0.0), -z / tilt
        if around != 0.0:
            share = self.share_lost(near, speed / opening)
            swept = (
                2.0 * math.acos(min(near / tilt, 1.0)) / opening
                - share * self.spare_turn()
            )
            out = z / tilt * cmath.exp(1j * math.copysign(swept, around))
        beyond = Passed(time, near, share, self.falling * speed**2)
        self.go_on(ground, slope, beyond, tilt * out, (-radial + 1j * around) * out)

    def go_on(self, ground, slope, passed, z, rate):
        """From a pass; so far its `lost` is twice the kinetic energy of the tilt without loss."""
        before, kept = self.motion.energy(self.y, rolling=self.rolling), 1.0
        kept -= passed.share * (1.0 - self.restitution**2)
        rate *= math.sqrt(kept)
        self.y[:2], self.y[self.half :][:2] = (z.real, z.imag), (rate.real, rate.imag)
        self.come_down(ground, slope, passed.tilt, kept * passed.lost)
        passed.lost = before - self.motion.energy(self.y, rolling=self.rolling)
        self.passes.append(passed)

    def come_down(self, ground, slope, tilt, twice_energy):
        """Full contact if neither this pass nor the next swing would be seen."""
        push_x, push_y, hold = self.margin(ground, slope, 1.0)
        spare = hold[0] - math.hypot(push_x[0], push_y[0])
        height = math.inf if spare <= 0.0 else twice_energy / (2.0 * self.lever * spare)
        if max(tilt, height) < self.negligible:
            self.y[:2] = self.y[self.half : self.half + 2] = 0.0
            self.standing = True

    def advance(self, ground, slope, duration):
        """Through one interval in which the ground is linear."""
        tau, self.end = 0.0, self.time + duration
        while duration - tau > 1e-13 * duration and not self.overturned:
            passed = self.stand if self.standing else self.tilted
            tau += passed(ground + slope * tau, slope, duration - tau)
        self.time = self.end


def simulate_pair(simulation, ground, dt, duration):
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
