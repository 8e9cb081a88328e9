"""What the devices of a structure saw in a history."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.kernels.history import History
from rpscli.frozen import Frozen
from rpscli.model.devices import Device, RollingResistance, Tendon, name_of
from rpscli.model.podium import PodiumStructure

Array = NDArray[np.float64]
Rows: TypeAlias = slice | NDArray[np.intp]
"""Numbers of samples."""


@dataclass(frozen=True)
class DeviceDemand:
    """Largest demands of one device, SI units.

    Parameters
    ----------
    kind
        Name of its kind.
    force
        At the cap beam [N]: of a tendon the tension of one, of rolling resistance the horizontal
        force that does the same.
    stroke, velocity
        |u_b| [m] and its rate [m/s]; of a tendon its elongation and the rate of that. Forces and
        velocities are looked at where steps end and where the tilt turns, the strokes everywhere.
    energy
        Dissipated, by all tendons together [J].
    remaining_prestress
        Of a tendon at the end, upright [N]; None of others.
    """

    kind: str
    force: float
    stroke: float
    velocity: float
    energy: float
    remaining_prestress: float | None


def device_demands(structure: PodiumStructure, history: History) -> tuple[DeviceDemand, ...]:
    """Demands of each device, in the order of the structure's.

    Parameters
    ----------
    structure
        Podium with its devices.
    history
        What its history left behind.
    """
    if not structure.devices:
        return ()
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
    """Largest force of any device of these kinds [N]; None if there is none.

    Parameters
    ----------
    structure
        Podium with its devices.
    history
        What its history left behind.
    """
    forces = [
        float(history.device_force[i])
        for i, device in enumerate(structure.devices)
        if isinstance(device, kinds)
    ]
    return max(forces, default=None)


@dataclass(frozen=True, eq=False)
class DeviceTrace(Frozen):
    """What each device does at the samples: arrays (samples, devices).

    Parameters
    ----------
    force, displacement
        Force on the cap beam, positive to the right [N], and u_b [m]; of a tendon tension and
        elongation of one.
    energy
        Dissipated so far [J].
    stored
        Energy over what was stored at rest [J].
    """

    force: Array
    displacement: Array
    energy: Array
    stored: Array

    def at(self, rows: Rows) -> DeviceTrace:
        """Only some samples.

        Parameters
        ----------
        rows
            Their numbers, or a slice.
        """
        return DeviceTrace(
            self.force[rows], self.displacement[rows], self.energy[rows], self.stored[rows]
        )


def device_trace(samples: Array) -> DeviceTrace:
    """From (samples, 4, devices) as the kernel leaves them.

    Parameters
    ----------
    samples
        (samples, 4, devices), see `physics.planar.run.Output`.
    """
    force, displacement, energy, stored = np.moveaxis(samples, 1, 0)
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
