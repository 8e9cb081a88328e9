"""What the devices of a structure saw in a history."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.kernels.history import History
from rpscli.model.devices import Device, RollingResistance, Tendon, name_of
from rpscli.model.podium import PodiumStructure

Array = NDArray[np.float64]


@dataclass(frozen=True)
class DeviceDemand:
    """Largest demands of one device, SI units.

    Forces are those at the cap beam, of a tendon the tension of one; of rolling resistance the
    horizontal force that does the same. `stroke` and `velocity` are those of the cap beam, of a
    tendon its elongation and the rate of that. Forces and velocities are looked at where steps end
    and where the tilt turns, the strokes everywhere. `energy` is dissipated, by all tendons
    together. `remaining_prestress` is that of a tendon at the end, upright; None of others.
    """

    kind: str
    force: float
    stroke: float
    velocity: float
    energy: float
    remaining_prestress: float | None


def device_demands(structure: PodiumStructure, history: History) -> tuple[DeviceDemand, ...]:
    """Demands of each device, in the order of the structure's."""
    rotation = np.array([history.max_rotation])
    _, beam, _ = structure.path(rotation)
    elongation = structure.bearing.tendon_elongation(rotation)
    found = []
    for i, device in enumerate(structure.devices):
        tendon = isinstance(device, Tendon)
        remaining = None
        if isinstance(device, Tendon):
            lost = device.stiffness * float(history.permanent[i])
            remaining = max(device.prestress - lost, 0.0)
        found.append(
            DeviceDemand(
                name_of(device),
                float(history.device_force[i]),
                float(elongation[0] if tendon else beam[0]),
                float(history.device_velocity[i]),
                float(history.device_energy[i]),
                remaining,
            )
        )
    return tuple(found)


def largest_force(
    structure: PodiumStructure,
    history: History,
    *kinds: type[Device],
) -> float | None:
    """Largest force of any device of these kinds [N]; None if there is none."""
    forces = [
        float(history.device_force[i])
        for i, device in enumerate(structure.devices)
        if isinstance(device, kinds)
    ]
    return max(forces, default=None)


@dataclass(frozen=True, eq=False)
class DeviceTrace:
    """What each device does at the samples, SI units: arrays (samples, devices).

    `force` is that on the cap beam, positive to the right, and goes with `displacement`, which is
    u_b; of a tendon they are tension and elongation of one. `energy` was dissipated so far, and
    `stored` is over what was stored at rest.
    """

    force: Array
    displacement: Array
    energy: Array
    stored: Array


def device_trace(samples: Array, devices: int) -> DeviceTrace:
    """From (samples, 4, slots) as the kernel leaves them."""
    force, displacement, energy, stored = np.moveaxis(samples[:, :, :devices], 1, 0)
    return DeviceTrace(force, displacement, energy, stored)


def cap_beam_forces(
    structure: PodiumStructure, devices: DeviceTrace, rotation: Array
) -> tuple[Array, Array]:
    """Forces of all devices on the cap beam, to the right and downwards [N] (Theory, section 11).

    Rolling resistance is none: it acts between the columns and what they roll on.

    Parameters
    ----------
    structure
        Podium with its devices.
    devices, rotation
        Their forces, and theta [rad], at samples.
    """
    push, pull = np.zeros(len(rotation)), np.zeros(len(rotation))
    lean, rise = structure.bearing.tendon_direction(rotation)
    for i, device in enumerate(structure.devices):
        if isinstance(device, Tendon):
            tension = structure.columns * devices.force[:, i]
            push, pull = push - np.sign(rotation) * tension * lean, pull + tension * rise
        elif not isinstance(device, RollingResistance):
            push = push + devices.force[:, i]
    return push, pull
