"""Devices of a storey that tilts to any side, as forces on the Cartesian tilt.

Laws are functions here, clipped where the program follows branches: the integrator finds the kinks
by itself. Only what a tendon has yielded is remembered.
"""

from __future__ import annotations

import math

import numpy as np

from .devices import Equipment, Friction, OracleDevice, RollingResistance, Stop, Tendon, Viscous
from .storey_lagrangian import Array, StoreyLagrangian


class SpatialDevices:
    """Forces of devices; sums over all of a kind."""

    def __init__(self, plane: StoreyLagrangian, devices: tuple[OracleDevice, ...]) -> None:
        self.plane, self.devices = plane, devices
        self.openings = Equipment(plane, devices, 2.0 * plane.critical_rotation)
        self.plastic = dict.fromkeys(range(len(devices)), 0.0)

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
            if isinstance(device, Stop) and shift > device.gap:
                force = device.stiffness * (shift - device.gap) + device.damping * slope * rate
                moment += max(force, 0.0) * slope
            elif isinstance(device, Tendon):
                e, growth = self.openings.elongation(x, rolling=rolling)
                moment += device.columns * self.tension(k, device, e) * growth
        return moment

    def tension(self, k: int, tendon: Tendon, e: float) -> float:
        elastic = tendon.prestress + tendon.stiffness * (e - self.plastic[k])
        return min(max(elastic, 0.0), tendon.yield_force)

    def against_rolling(self, grows: float, swings: float) -> Array:
        """Moments against theta' and theta phi'."""
        moment = sum(self.rolling(d) for d in self.devices if isinstance(d, RollingResistance))
        rolls = math.hypot(grows, swings)
        return moment / rolls * np.array([grows, swings]) if moment else np.zeros(2)

    def rolling(self, device: RollingResistance) -> float:
        return 2.0 * self.plane.lifted_mass * self.plane.system.gravity * device.lever

    def at_rest(self, alpha: float, R: float) -> float:
        """Force on the cap beam that devices hold in full contact."""
        held = 0.0
        for k, device in enumerate(self.devices):
            if isinstance(device, Friction):
                held += device.force
            elif isinstance(device, Tendon):
                held += device.columns * self.tension(k, device, 0.0) * math.tan(alpha)
            elif isinstance(device, RollingResistance):
                held += self.rolling(device) / (2.0 * R * math.cos(alpha))
        return held

    def yields(self, x: float, *, rolling: bool) -> bool:
        return any(
            self.tension(k, d, self.openings.elongation(x, rolling=rolling)[0]) >= d.yield_force
            for k, d in enumerate(self.devices)
            if isinstance(d, Tendon)
        )

    def unload(self, x: float, *, rolling: bool) -> None:
        """The tilt turns: what yielded keeps its elongation."""
        e, _ = self.openings.elongation(x, rolling=rolling)
        for k, device in enumerate(self.devices):
            if isinstance(device, Tendon):
                room = (device.yield_force - device.prestress) / device.stiffness
                self.plastic[k] = max(self.plastic[k], e - room)
