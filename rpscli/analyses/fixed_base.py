"""The same building without bearings, for comparison."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.kernels.systems import CONTACT_ANGLE, building_system
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import Superstructure
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.measures import velocity
from rpscli.shown import Shown


@dataclass(frozen=True, eq=False, repr=False)
class FixedBaseResponse(Shown):
    """Exact linear response of the building on a fixed base."""

    storey_shears: NDArray[np.float64]
    """(n,) largest k_i d_i [N], from the bottom."""
    floor_accelerations: NDArray[np.float64]
    """(n,) largest absolute accelerations [m/s2]."""
    floor_velocities: NDArray[np.float64]
    """(n,) largest absolute velocities [m/s], see `TimeHistoryResult.floor_velocities`."""
    floor_displacements: NDArray[np.float64]
    """(samples, n) relative to the ground [m]."""
    drifts: NDArray[np.float64]
    """(n,) largest storey drifts [m]."""
    acceleration_histories: NDArray[np.float64]
    """(samples, n) absolute accelerations of the floors [m/s2]."""

    @property
    def base_shear(self) -> float:
        """Largest elastic base shear [N]."""
        return float(self.storey_shears[0])


def fixed_base_response(
    structure: PodiumStructure, record: GroundMotion, intervals: int
) -> FixedBaseResponse:
    """Run the building of a structure on a fixed base for a number of sampling intervals."""
    building = structure.superstructure
    if building is None:
        raise ValueError("a structure without superstructure has no fixed-base response")
    floors = np.empty((intervals + 1, 2, building.storeys))
    shears, accelerations = _follow(building, record, intervals, floors)
    histories = _accelerations(building, floors)
    return FixedBaseResponse(
        storey_shears=shears,
        floor_accelerations=accelerations,
        floor_velocities=largest_velocities(floors[:, 1], histories, record),
        floor_displacements=floors[:, 0].copy(),
        drifts=shears / building.stiffnesses,
        acceleration_histories=histories,
    )


def fixed_base_shears(
    building: Superstructure, record: GroundMotion, intervals: int
) -> NDArray[np.float64]:
    """Largest storey shears (n,) [N] from the bottom, without all that needs every sample."""
    nowhere = np.empty((0, 2, building.storeys))
    shears: NDArray[np.float64] = _follow(building, record, intervals, nowhere)[0]
    return shears


def _follow(
    building: Superstructure, record: GroundMotion, intervals: int, floors: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Largest shears and accelerations (2, n); displacements and velocities go to `floors`."""
    from rpscli.physics.planar.full_contact.modal_block import integrate_fixed_base
    from rpscli.physics.planar.run import empty_block

    largest = np.zeros((2, building.storeys))
    integrate_fixed_base(
        record.acceleration,
        record.dt,
        max(math.ceil(record.dt * float(building.frequencies[-1]) / CONTACT_ANGLE), 1),
        intervals + 1,
        building_system(building),
        empty_block(building.storeys),
        floors,
        largest,
    )
    return largest


def _accelerations(building: Superstructure, floors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Absolute ones (samples, n) [m/s2]."""
    found = floors[:, 0] @ building.stiffness_matrix
    found += floors[:, 1] @ building.damping_matrix
    found /= -building.masses
    return found


def largest_velocities(
    relative: NDArray[np.float64], accelerations: NDArray[np.float64], record: GroundMotion
) -> NDArray[np.float64]:
    """Largest absolute velocities of floors (n,) [m/s], from those to the ground at the samples."""
    ground = velocity(record.acceleration, record.dt)[: len(relative)]
    ground = np.pad(ground, (0, len(relative) - len(ground)), mode="edge")
    floors = zip(relative.T, accelerations.T, strict=True)
    return np.array([largest_of_cubics(floor + ground, rate, record.dt) for floor, rate in floors])


def largest_of_cubics(values: NDArray[np.float64], rates: NDArray[np.float64], dt: float) -> float:
    """Largest absolute value of cubics through values (samples,) with these rates."""
    first, last = dt * rates[:-1], dt * rates[1:]
    change = values[1:] - values[:-1]
    square, cube = 3.0 * change - 2.0 * first - last, first + last - 2.0 * change
    root = np.sqrt(np.maximum(square * square - 3.0 * cube * first, 0.0))
    largest = np.max(np.abs(values))
    for divisor in (-square - root, root - square):  # where the slope is zero, if within
        within = np.flatnonzero(np.abs(first) < np.abs(divisor))
        t = first[within] / divisor[within]
        turned = values[within] + t * (first[within] + t * (square[within] + t * cube[within]))
        largest = np.max(np.abs(turned), where=t > 0.0, initial=largest)
    return float(largest)
