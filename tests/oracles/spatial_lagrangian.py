"""Lagrange's equations of a storey that tilts to any side, in Cartesian tilt coordinates.

X = theta cos(phi), Y = theta sin(phi), and the floors' displacements relative to the ground. The
section of a column through its axis and its contact is that of `storey_lagrangian`, so the cap beam
moves by u(theta) towards the azimuth phi and v(theta) upwards. A column that keeps its place on its
circle of the radius `path` on the ground turns about its own axis by psi' = -kappa phi',
kappa = path/rim, `rim` being the distance of the contact from the axis. That is a condition on
velocities: only the part of dJ/dtheta that leaves kappa alone acts (Theory, section 13).
"""

from __future__ import annotations

import cmath
import math
from typing import NamedTuple

import numpy as np

from .devices import Equipment, Friction, RollingResistance, Stop, Tendon, Viscous
from .storey_lagrangian import Array, OracleSystem, StoreyLagrangian


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

    def on_beam(self, rate: Array) -> Array:
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

    def against_tilt(
        self, x: float, shift: float, slope: float, rate: float, *, rolling: bool
    ) -> float:
        """Moment of stops and tendons against theta, which is at x."""
        moment = 0.0
        for k, device in enumerate(self.devices):
            if isinstance(device, Stop):
                moment += device.push(shift, slope * rate) * slope
            elif isinstance(device, Tendon):
                e, growth = self.elongation(x, rolling=rolling)
                moment += device.columns * self.tension(k, device, e) * growth
        return moment

    def against_rolling(self, grows: float, swings: float) -> Array:
        """Moments against theta' and theta phi'."""
        moment = sum(self.rolling(d) for d in self.devices if isinstance(d, RollingResistance))
        rolls = math.hypot(grows, swings)
        return moment / rolls * np.array([grows, swings]) if moment else np.zeros(2)


class SpatialLagrangian:
    """Masses and contact alike in x and y; stiffness and damping of each direction."""

    def __init__(
        self,
        along_x: OracleSystem,
        along_y: OracleSystem,
        axial: float,
        *,
        integrated_spin: bool = False,
    ) -> None:
        """`axial` is I_3/(m_c R^2); `integrated_spin` lets all of dJ/dtheta act, as the program."""
        self.integrated_spin = integrated_spin
        self.devices: SpatialDevices | None = None
        self.system, self.directions = along_x, (along_x, along_y)
        self.plane = StoreyLagrangian(along_x)
        self.storeys, self.critical_rotation = self.plane.storeys, self.plane.critical_rotation
        self.axial = axial * along_x.columns_mass * along_x.R**2
        n = self.storeys
        between = np.eye(n) - np.eye(n, k=-1)
        self.springs = [between.T @ np.diag(way.stiffnesses) @ between for way in self.directions]

    def section(self, x: float, *, rolling: bool) -> Section:
        plane = self.plane
        _, slope, bend = plane.cap_beam(x, rolling=rolling)
        # as there, but 1 - exp(-i x) without its cancellation towards the tip of the cone
        versed = 2j * math.sin(x / 2.0) * cmath.exp(-0.5j * x)
        if rolling:
            shift = 2.0 * plane.radius * x + 2.0 * plane.arc_frame * versed
        else:
            foot = complex(plane.half_width + plane.radius * plane.beta, -plane.half_height)
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
            2.0 * (plane.spin_inertia * sine * cosine + spin * sine + mass * u * slope.real)
            + acting,
            twisting - acting,
            kappa,
        )

    def tilt_inertia(self, slope: complex) -> float:
        """Of theta': floors ride along upwards alone."""
        plane = self.plane
        sideways = self.system.columns_mass / 4.0 + self.system.cap_beam_mass
        return float(
            plane.spin_inertia + sideways * slope.real**2 + plane.moving_mass * slope.imag**2
        )

    def storey_forces(self, floors: Array, rates: Array, beam: Array, beam_rate: Array) -> Array:
        """K v + C v' of both directions, (2, n)."""
        forces = [
            spring @ (floors[i] - beam[i]) + way.damping_matrix @ (rates[i] - beam_rate[i])
            for i, (spring, way) in enumerate(zip(self.springs, self.directions, strict=True))
        ]
        return np.array(forces).reshape(2, self.storeys)

    def accelerations(self, y: Array, ground: Array, *, rolling: bool) -> Array:
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
        out[:2] = (theta2 - swings * turns) * outwards + (x * phi2 + 2.0 * grows * turns) * around
        out[2:] = (-forces / self.system.masses - ground[:2, None]).ravel()
        return out

    def energy(self, y: Array, *, rolling: bool) -> float:
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
            energy += 0.5 * (self.tilt_inertia(here.slope) * grows**2 + here.inertia * turns**2)
            energy += self.plane.lifted_mass * self.system.gravity * here.shift.imag
            beam = here.shift.real * outwards
        for i, spring in enumerate(self.springs):
            drift = floors[i] - beam[i]
            energy += 0.5 * float(drift @ spring @ drift)
        return energy
