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
    """(n,) largest absolute velocities [m/s], see
    `TimeHistoryResult.floor_velocities`."""
    floor_displacements: Array  # (samples, n) relative to the ground [m]
    drifts: Array  # (n,) largest storey drifts [m]
    acceleration_histories: (
        Array  # (samples, n) absolute accelerations of the floors [m/s2]
    )
    y: FixedBaseResponse | None = None
    """In y, where both components act: largest values above are then
    resultants, histories in x."""

    @property
    def base_shear(self) -> float:
        """Largest elastic base shear [N]."""
        return float(self.storey_shears[0])


def fixed_base_response(
    structure: PodiumStructure, motion: MotionComponents, intervals: int
) -> FixedBaseResponse:
    """Run the building of a structure on a fixed base for a number of sampling intervals.

    Under both components the largest values are resultants of cubics through the samples,
    looked at in `PARTS` of each interval: 0.3 % low at most for periods from 5 dt.
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
    """Response in one direction; drifts, shears, accelerations and
    velocities with their rates.
    """
    shears, accelerations, floors = _followed(building, record, intervals)
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
    after = math.ceil(
        max(float(each.periods[0]) for each in (building, across)) / motion.dt
    )
    shaken = [each.npts for name, each in motion.named.items() if name != "vertical"]
    intervals = max(shaken) - 1 + after
    if motion.y is not None:
        return fixed_base_response(structure, motion, intervals).storey_shears
    return _largest_shears(_moved(building, motion.horizontal, intervals))


STEP_ANGLE = 0.5
"""Largest step times the highest frequency: cubics between its ends
then keep 2e-4 of that mode."""


@dataclass(frozen=True, eq=False)
class _Moved:
    """Modes of a building in steps that are fine enough for cubics between their ends."""

    building: Superstructure
    # (n, 2, steps + 1) displacements [m] and velocities [m/s] of unit participation
    modes: Array
    ground: Array  # (steps + 1,) acceleration [m/s2]
    dt: float  # step [s]
    parts: int  # steps in a sampling interval

    @property
    def floors(self) -> Array:
        """Displacements [m] and velocities [m/s] to the ground, (n, 2, steps + 1)."""
        return np.tensordot(self._shapes, self.modes, axes=1)

    @property
    def shears(self) -> Array:
        """Of the storeys [N] and their rates [N/s], (n, 2, steps + 1)."""
        of_modes = np.diff(self._shapes, axis=0, prepend=0.0)
        return np.tensordot(
            self.building.stiffnesses[:, None] * of_modes, self.modes, axes=1
        )

    @property
    def _shapes(self) -> Array:
        return self.building.shapes * self.building.participation


def _moved(building: Superstructure, record: GroundMotion, intervals: int) -> _Moved:
    parts = max(math.ceil(record.dt * float(building.frequencies[-1]) / STEP_ANGLE), 1)
    dt = record.dt / parts
    times = np.arange((record.npts - 1) * parts + 1) / parts
    fine = np.interp(times, np.arange(record.npts), record.acceleration)
    ground = prolonged(fine, intervals * parts + 1)
    modes = np.empty((building.storeys, 2, len(ground)))
    for r, mode in enumerate(modes):
        mode[:] = oscillator(
            ground, dt, building.frequencies[r], building.damping_ratios[r]
        )
    return _Moved(building, modes, ground, dt, parts)


def _followed(
    building: Superstructure, record: GroundMotion, intervals: int
) -> tuple[Array, Array, Array]:
    """Largest shears and accelerations (n,); displacements,
    velocities (samples, 2, n).
    """
    moved = _moved(building, record, intervals)
    shears = _largest_shears(moved)
    fine = moved.floors.T
    ground = moved.ground
    dt = moved.dt
    parts = moved.parts
    del moved  # of a long record its modes are much memory
    return (
        shears,
        _largest_accelerations(building, fine, ground, dt),
        fine[::parts].copy(),
    )


def _largest_shears(moved: _Moved) -> Array:
    """Of the storeys (n,) [N], from the bottom."""
    return np.array(
        [largest_of_cubics(shear, rate, moved.dt) for shear, rate in moved.shears]
    )


def _largest_accelerations(
    building: Superstructure, floors: Array, ground: Array, dt: float
) -> Array:
    """Absolute ones of the floors (n,) [m/s2], which move by `floors` (samples, 2, n)."""
    values = _accelerations(building, floors)
    rates = np.stack((floors[:, 1], values - ground[:, None]), axis=1)
    slopes = _accelerations(building, rates)
    both = zip(values.T, slopes.T, strict=True)
    return np.array([largest_of_cubics(*each, dt) for each in both])


@lru_cache(maxsize=4096)  # records of a study share their time step
def _grown(k: float, xi: float) -> Array:
    """Displacement, velocity, ground and its slope after a step,
    from those before, (4, 4).
    """
    from scipy.linalg import expm

    # The step is the unit of time: formulae would lose all digits where k is small.
    rates = np.zeros((4, 4))
    rates[0, 1] = rates[2, 3] = 1.0
    rates[1, :3] = -(k**2), -2.0 * xi * k, -1.0
    return np.asarray(expm(rates))


def oscillator(ground: Array, dt: float, omega: float, xi: float) -> tuple[Array, Array]:
    """Exact displacement and velocity from rest, the ground (samples,)
    [m/s2] linear in each step.

    N. C. Nigam and P. C. Jennings, BSSA 59 (1969) 909-922: the state obeys a recurrence,
    each of its components alone one of second order, which is a digital filter.
    """
    from scipy.signal import lfilter

    grown = _grown(float(omega * dt), float(xi))
    a = grown[:2, :2]
    start = grown[:2, 2] - grown[:2, 3]
    slope = grown[:2, 3]
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


def largest_velocities(
    relative: Array, accelerations: Array, record: GroundMotion
) -> Array:
    """Largest absolute velocities of floors (n,) [m/s], from those to
    the ground at the samples.
    """
    floors = zip(floor_speeds(relative, record).T, accelerations.T, strict=True)
    return np.array([largest_of_cubics(floor, rate, record.dt) for floor, rate in floors])


def floor_speeds(relative: Array, record: GroundMotion) -> Array:
    """Absolute velocities of floors (samples, n) [m/s], from
    those relative to the ground.
    """
    ground = velocity(record.acceleration, record.dt)[: len(relative)]
    return (
        relative + np.pad(ground, (0, len(relative) - len(ground)), mode="edge")[:, None]
    )


BEYOND = 4.0 / 27.0 * (1.0 + 1e-9)
"""Of h |x'|: what a cubic passes the ends of its step by at most,
and a margin for rounding."""


def largest_of_cubics(values: Array, rates: Array, dt: float) -> float:
    """Largest absolute value of cubics through values (samples,) with these rates."""
    at = np.abs(values)
    slopes = np.abs(rates)
    largest = np.max(at)
    # The polynomials that take up the rates reach 4/27: most steps cannot pass the
    # largest end.
    reach = np.maximum(at[1:], at[:-1]) + BEYOND * dt * (slopes[1:] + slopes[:-1])
    passing = np.flatnonzero(reach >= largest)
    values, after = values[passing], values[passing + 1]
    first = dt * rates[passing]
    last = dt * rates[passing + 1]
    change = after - values
    square = 3.0 * change - 2.0 * first - last
    cube = first + last - 2.0 * change
    root = np.sqrt(np.maximum(square * square - 3.0 * cube * first, 0.0))
    for divisor in (-square - root, root - square):  # where the slope is zero, if within
        within = np.flatnonzero(np.abs(first) < np.abs(divisor))
        t = first[within] / divisor[within]
        turned = values[within] + t * (
            first[within] + t * (square[within] + t * cube[within])
        )
        largest = np.max(np.abs(turned), where=t > 0.0, initial=largest)
    return float(largest)
