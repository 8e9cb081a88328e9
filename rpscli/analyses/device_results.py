"""What the devices of a structure saw in a history."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from rpscli.frozen import Frozen
from rpscli.model.podium import PodiumStructure
from rpscli.physics.core.records import Record

Array = NDArray[np.float64]
Rows: TypeAlias = slice | NDArray[np.intp]
"""Numbers of samples."""


@dataclass(frozen=True)
class DeviceDemand:
    """Largest demands of one device.

    Forces and velocities are looked at where steps end and where the tilt turns, strokes
    everywhere.
    """

    kind: str
    """Name of its law."""
    force: float
    """At the cap beam [N]: of a tendon the tension of one, of rolling resistance the horizontal
    force that does the same."""
    stroke: float
    """|u_b| [m]; of a tendon its elongation."""
    velocity: float
    """Rate of the stroke [m/s]."""
    energy: float
    """Dissipated, by all tendons together [J]."""
    remaining_prestress: float | None
    """Of a tendon at the end, upright [N]; None of others."""


def device_demands(structure: PodiumStructure, history: Record) -> tuple[DeviceDemand, ...]:
    """Demands of each device from a `state.RESULT`, in the order of the structure's."""
    rotation = np.array([history["max_theta"]])
    return tuple(
        DeviceDemand(
            device.kind,
            float(history["device_force"][i]),
            float(device.stroke(structure, rotation)[0]),
            float(history["device_velocity"][i]),
            float(history["device_energy"][i]),
            device.remaining_prestress(float(history["permanent"][i])),
        )
        for i, device in enumerate(structure.devices)
    )


@dataclass(frozen=True, eq=False)
class DeviceTrace(Frozen):
    """What each device does at the samples: arrays (samples, devices)."""

    force: Array
    """On the cap beam, positive to the right [N]; of a tendon the tension of one."""
    displacement: Array
    """u_b [m]; of a tendon the elongation of one."""
    energy: Array
    """Dissipated so far [J]."""
    stored: Array
    """Energy over what was stored at rest [J]."""

    def at(self, rows: Rows) -> DeviceTrace:
        """Only some samples."""
        return DeviceTrace(
            self.force[rows], self.displacement[rows], self.energy[rows], self.stored[rows]
        )


def cap_beam_forces(
    structure: PodiumStructure, devices: DeviceTrace, rotation: Array
) -> tuple[Array, Array]:
    """Forces of all devices on the cap beam, to the right and downwards, (samples,) [N]."""
    push, pull = np.zeros(len(rotation)), np.zeros(len(rotation))
    for i, device in enumerate(structure.devices):
        across, down = device.beam_forces(structure, rotation, devices.force[:, i])
        push, pull = push + across, pull + down
    return push, pull
