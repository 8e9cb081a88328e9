"""Running the kernel for one structure under one record."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.compilation import SINGLE, compiled
from rpscli.analyses.kernel_input import aligned
from rpscli.analyses.kernel_tables import joined, point, points, stacked_systems
from rpscli.analyses.settings import LONGEST_FREE_VIBRATION, TimeHistorySettings
from rpscli.model.podium import PodiumStructure
from rpscli.physics import layout
from rpscli.physics.parameters import Results, Shape
from rpscli.records.ground_motion import GroundMotion

FIRST_LOG = 4096
"""Rows of the event log at the first attempt; a longer history is run once more."""


@dataclass(frozen=True, eq=False)
class History:
    """What one history leaves behind besides samples and log, SI units.

    `outcome`, `motion` and the entries of `counts` are coded in `physics.layout`. `friction` is the
    largest |F|/N and `least_normal` the least normal force over the weight on it, each at the upper
    and at the lower end of the columns.
    `motion`, `rotation` and `time` are those of the end, after `intervals` of the record's steps.
    Times that never came are negative. `energies` are input, damped, lost at impacts, and stored at
    the end; the energy created at impacts counts negatively in what was lost.
    """

    outcome: int
    motion: int
    rotation: float
    time: float
    intervals: int
    max_rotation: float
    max_rotation_time: float
    critical_time: float
    storey_shears: NDArray[np.float64]
    floor_accelerations: NDArray[np.float64]
    friction: NDArray[np.float64]
    least_normal: NDArray[np.float64]
    energies: NDArray[np.float64]
    energy_created: float
    creating_impacts: int
    counts: NDArray[np.int64]
    steps: int


def history_of(numbers: NDArray[np.float64], integers: NDArray[np.int64]) -> History:
    """The history of one row of results."""
    n = (len(numbers) - layout.OUT_FLOORS) // 2
    return History(
        outcome=int(integers[layout.OUT_OUTCOME]),
        motion=int(integers[layout.OUT_MOTION]),
        rotation=float(numbers[layout.OUT_ROTATION]),
        time=float(numbers[layout.OUT_TIME]),
        intervals=int(integers[layout.OUT_INTERVALS]),
        max_rotation=float(numbers[layout.OUT_PEAK]),
        max_rotation_time=float(numbers[layout.OUT_PEAK_TIME]),
        critical_time=float(numbers[layout.OUT_CRITICAL_TIME]),
        storey_shears=numbers[layout.OUT_FLOORS : layout.OUT_FLOORS + n],
        floor_accelerations=numbers[layout.OUT_FLOORS + n :],
        friction=numbers[layout.OUT_FRICTION_TOP : layout.OUT_FRICTION_BOTTOM + 1],
        least_normal=numbers[layout.OUT_NORMAL_TOP : layout.OUT_NORMAL_BOTTOM + 1],
        energies=numbers[[layout.OUT_INPUT, layout.OUT_DAMPED, layout.OUT_LOST, layout.OUT_STORED]],
        energy_created=float(numbers[layout.OUT_CREATED]),
        creating_impacts=int(integers[layout.OUT_CREATING]),
        counts=integers[layout.OUT_COUNTS :],
        steps=int(integers[layout.OUT_STEPS]),
    )


def empty_results(points: int, storeys: int, *, samples: int = 0, events: int = 0) -> Results:
    """Room for the results of histories, and for samples and events of the first."""
    return Results(
        numbers=np.empty((points, layout.OUT_FLOORS + 2 * storeys)),
        integers=np.empty((points, layout.OUT_WHOLE_NUMBERS), dtype=np.int64),
        samples=np.empty((samples, layout.ROW_FLOORS + 2 * storeys)),
        log=np.empty((events, layout.LOG_COLUMNS)),
    )


def shape_of_one(structure: PodiumStructure) -> Shape:
    """One lane, any number of floors: a single kernel serves every structure."""
    return Shape(np.zeros(structure.storeys, np.int8), ((),), ((),), ((),), ((),))


@dataclass(frozen=True, eq=False)
class SampledHistory:
    """A history with its samples (intervals + 1, 7 + 2 n) and its event log (events, 6).

    `ground` is the horizontal acceleration, as long as the longer component [m/s2].
    """

    history: History
    ground: NDArray[np.float64]
    samples: NDArray[np.float64]
    log: NDArray[np.float64]


def sampled_history(
    structure: PodiumStructure,
    record: GroundMotion,
    vertical: GroundMotion | None,
    settings: TimeHistorySettings,
) -> SampledHistory:
    """Run one history and keep everything."""
    # Imported here: compiling or loading kernels costs time that other commands need not pay.
    from rpscli.physics.driver import integrate  # noqa: PLC0415

    along, upwards = aligned(record, vertical)
    systems = stacked_systems([(structure, settings)])
    acceleration, starts = joined([along] if upwards is None else [along, upwards])
    above = None if upwards is None else starts[1]
    given = points([point(0, along, 0, above, 1.0)])
    free = settings.free_vibration
    longest = LONGEST_FREE_VIBRATION if free is None else free
    rows = along.npts + int(np.ceil(longest / record.dt)) + 1
    events = FIRST_LOG
    while True:
        results = empty_results(1, structure.storeys, samples=rows, events=events)
        with compiled(SINGLE):
            integrate(systems, acceleration, given, shape_of_one(structure), results)
        history = history_of(results.numbers[0], results.integers[0])
        if (seen := int(history.counts.sum())) <= events:
            break
        events = seen
    kept = results.samples[: history.intervals + 1].copy()
    return SampledHistory(history, along.acceleration, kept, results.log[:seen])
