"""Response of the building without bearings, for comparison."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TypeAlias

import numpy as np

from rpscli.analyses.trace import prolonged
from rpscli.model.podium import Array, PodiumStructure
from rpscli.model.superstructure import Superstructure
from rpscli.records.ground_motion import GroundMotion, MotionComponents
from rpscli.records.measures import velocity
from rpscli.shown import Shown


@dataclass(frozen=True, eq=False, repr=False)
class FixedBaseResponse(Shown):
    """Exact linear response of the building on a fixed base."""

    storey_shears: Array  # (n,) largest k_i d_i [N], from the bottom
    floor_accelerations: Array  # (n,) largest absolute accelerations [m/s2]
    floor_velocities: Array
    """(n,) largest absolute velocities [m/s], see `TimeHistoryResult.floor_velocities`."""
    floor_displacements: Array  # (samples, n) relative to the ground [m]
    drifts: Array  # (n,) largest storey drifts [m]
    acceleration_histories: Array  # (samples, n) absolute accelerations of the floors [m/s2]
    y: FixedBaseResponse | None = None
    """In y, where both components act: largest values above are then resultants, histories in x."""

    @property
    def base_shear(self) -> float:
        """Largest elastic base shear [N]."""
        return float(self.storey_shears[0])


def fixed_base_response(
    structure: PodiumStructure, motion: MotionComponents, intervals: int
) -> FixedBaseResponse:
    """Run the building of a structure on a fixed base for a number of sampling intervals.

    Under both components the largest values are resultants of cubics through the samples, looked at
    in `PARTS` of each interval: 0.3 % low at most for periods from 5 dt.
    """
    if structure.superstructure is None:
        raise ValueError("a structure without superstructure has no fixed-base response")
    x, of_x = _in_direction(structure.superstructure, motion.horizontal, intervals)
    if motion.y is None:
        return x
    building = structure.superstructure_y or structure.superstructure
    y, of_y = _in_direction(building, motion.y, intervals)
    drifts, shears, accelerations, velocities = (
        largest_resultants(both, motion.dt) for both in zip(of_x, of_y, strict=True)
    )
    return replace(
        x,
        storey_shears=shears,
        floor_accelerations=accelerations,
        floor_velocities=velocities,
        drifts=drifts,
        y=y,
    )


Moving: TypeAlias = tuple[Array, Array]
"""Values (samples, n) and their rates."""


def _in_direction(
    building: Superstructure, record: GroundMotion, intervals: int
) -> tuple[FixedBaseResponse, list[Moving]]:
    """Response in one direction; drifts, shears, accelerations and velocities with their rates."""
    shears, accelerations, floors = _follow(building, record, intervals)
    histories = _accelerations(building, floors)
    response = FixedBaseResponse(
        storey_shears=shears,
        floor_accelerations=accelerations,
        floor_velocities=largest_velocities(floors[:, 1], histories, record),
        floor_displacements=floors[:, 0],
        drifts=shears / building.stiffnesses,
        acceleration_histories=histories,
    )
    drifts, rates = (np.diff(floors[:, i], axis=1, prepend=0.0) for i in range(2))
    ground = prolonged(record.acceleration, intervals + 1)[:, None]
    jerks = _accelerations(building, np.stack((floors[:, 1], histories - ground), axis=1))
    k = building.stiffnesses
    return response, [
        (drifts, rates), (k * drifts, k * rates), (histories, jerks),
        (floor_speeds(floors[:, 1], record), histories),
    ]  # fmt: skip


PARTS = 8


def largest_resultants(both: Sequence[Moving], dt: float) -> Array:
    """Largest sqrt(x^2 + y^2) (n,) of cubics through values with their rates."""
    from scipy.interpolate import CubicHermiteSpline

    samples = len(both[0][0])
    times = dt / PARTS * np.arange((samples - 1) * PARTS + 1)
    cubics = [CubicHermiteSpline(times[::PARTS], *moving)(times) for moving in both]
    return np.asarray(np.hypot(*cubics).max(axis=0))


def reference_shears(structure: PodiumStructure, motion: MotionComponents) -> Array:
    """Largest storey shears (n,) [N] from the bottom, of a pair resultants."""
    building = structure.superstructure
    assert building is not None, "only buildings have a response"
    across = structure.superstructure_y or building
    # The largest shear after the end of the record comes within a period.
    after = math.ceil(max(float(each.periods[0]) for each in (building, across)) / motion.dt)
    shaken = [each.npts for name, each in motion.named.items() if name != "vertical"]
    intervals = max(shaken) - 1 + after
    if motion.y is not None:
        return fixed_base_response(structure, motion, intervals).storey_shears
    return _follow(building, motion.horizontal, intervals)[0]


STEP_ANGLE = 0.5
"""Largest step times the highest frequency: cubics between its ends then keep 2e-4 of that mode."""


def _follow(
    building: Superstructure, record: GroundMotion, intervals: int
) -> tuple[Array, Array, Array]:
    """Largest shears and accelerations (n,); displacements, velocities (samples, 2, n)."""
    parts = max(math.ceil(record.dt * float(building.frequencies[-1]) / STEP_ANGLE), 1)
    dt = record.dt / parts
    times = np.arange((record.npts - 1) * parts + 1) / parts
    fine = np.interp(times, np.arange(record.npts), record.acceleration)
    ground = prolonged(fine, intervals * parts + 1)
    n, states = building.storeys, np.zeros((len(ground), 2, building.storeys))
    for r in range(n):
        shape = building.participation[r] * building.shapes[:, r]
        for into, mode in enumerate(
            oscillator(ground, dt, building.frequencies[r], building.damping_ratios[r])
        ):
            states[:, into] += mode[:, None] * shape
    floors, k = states[::parts].copy(), building.stiffnesses
    below, shears = np.zeros((len(ground), 2)), np.empty(n)
    for i in range(n):
        shear = k[i] * (states[:, :, i] - below)
        shears[i] = largest_of_cubics(shear[:, 0], shear[:, 1], dt)
        below = states[:, :, i]
    values = _accelerations(building, states)
    states[:, 0], states[:, 1] = states[:, 1], values - ground[:, None]
    slopes = _accelerations(building, states)
    largest = [largest_of_cubics(*each, dt) for each in zip(values.T, slopes.T, strict=True)]
    return shears, np.array(largest), floors


@lru_cache(maxsize=4096)  # records of a study share their time step
def _grown(k: float, xi: float) -> Array:
    """Displacement, velocity, ground and its slope after a step, from those before, (4, 4)."""
    from scipy.linalg import expm

    # The step is the unit of time: formulae would lose all digits where k is small.
    rates = np.zeros((4, 4))
    rates[0, 1] = rates[2, 3] = 1.0
    rates[1, :3] = -(k**2), -2.0 * xi * k, -1.0
    return np.asarray(expm(rates))


def oscillator(ground: Array, dt: float, omega: float, xi: float) -> tuple[Array, Array]:
    """Exact displacement and velocity from rest, the ground (samples,) [m/s2] linear in each step.

    N. C. Nigam and P. C. Jennings, BSSA 59 (1969) 909-922: the state obeys a recurrence, each of
    its components alone one of second order, which is a digital filter.
    """
    from scipy.signal import lfilter

    grown = _grown(float(omega * dt), float(xi))
    a, start, slope = grown[:2, :2], grown[:2, 2] - grown[:2, 3], grown[:2, 3]
    recursion = np.array([1.0, -np.trace(a), a[0, 0] * a[1, 1] - a[0, 1] * a[1, 0]])
    other = np.array([[-a[1, 1], a[0, 1]], [a[1, 0], -a[0, 0]]])
    weights = np.array([slope, start + other @ slope, other @ start])
    responses = []
    for i, unit in enumerate((dt * dt, dt)):
        # Rest at the first sample, which may be a jump, fixes the state of the filter.
        rest = np.array([-weights[0, i], -(other @ slope)[i]]) * ground[0]
        responses.append(unit * lfilter(weights[:, i], recursion, ground, zi=rest)[0])
    return responses[0], responses[1]


def _accelerations(building: Superstructure, floors: Array) -> Array:
    """Absolute ones (samples, n) [m/s2]."""
    accelerations = floors[:, 0] @ building.stiffness_matrix
    accelerations += floors[:, 1] @ building.damping_matrix
    accelerations /= -building.masses
    return accelerations


def largest_velocities(relative: Array, accelerations: Array, record: GroundMotion) -> Array:
    """Largest absolute velocities of floors (n,) [m/s], from those to the ground at the samples."""
    floors = zip(floor_speeds(relative, record).T, accelerations.T, strict=True)
    return np.array([largest_of_cubics(floor, rate, record.dt) for floor, rate in floors])


def floor_speeds(relative: Array, record: GroundMotion) -> Array:
    """Absolute velocities of floors (samples, n) [m/s], from those relative to the ground."""
    ground = velocity(record.acceleration, record.dt)[: len(relative)]
    return relative + np.pad(ground, (0, len(relative) - len(ground)), mode="edge")[:, None]


def largest_of_cubics(values: Array, rates: Array, dt: float) -> float:
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
