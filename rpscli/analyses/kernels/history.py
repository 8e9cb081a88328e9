"""Running the kernel: histories of structures under records."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.kernels.compilation import compiled
from rpscli.analyses.kernels.step_lengths import most_steps
from rpscli.analyses.kernels.systems import stacked_systems
from rpscli.analyses.settings import LONGEST_FREE_VIBRATION, TimeHistorySettings
from rpscli.errors import CaseError
from rpscli.frozen import Frozen
from rpscli.model.podium import PodiumStructure
from rpscli.physics.core.records import NO_RECORD, Record, records
from rpscli.physics.planar.run import Output, Run, empty_block
from rpscli.physics.planar.state import EVENT, REQUEST, RESULT, SAMPLE
from rpscli.records.ground_motion import GroundMotion, MotionComponents

MOST_NUMBERS = 1e9
"""Of one history and what follows from it: 8 GB, of which those that are reached are taken."""

MOST_STEPS = 1e10
"""Of one history: more than an hour."""

FIRST_LOG = 4096
"""Rows of the event log at the first attempt; a longer history is run once more."""


@dataclass(frozen=True, eq=False)
class History(Frozen):
    """What one history leaves behind besides samples and log, SI units.

    Parameters
    ----------
    outcome, phase
        At the end, coded in `physics.planar.state`.
    rotation, time
        theta [rad] and time [s] at the end.
    intervals
        Sampling intervals that were followed.
    max_rotation, max_rotation_time
        max |theta| [rad], and when [s].
    critical_time
        When theta_cr was first passed [s]; negative if never.
    storey_shears, floor_accelerations
        (n,) largest k_i d_i [N] and absolute accelerations [m/s2].
    friction, least_normal
        (2,) largest |F|/N, and least normal force over the weight on it, at the upper and at the
        lower end of the columns.
    energy_input, energy_damped
        By the ground, in the building [J]; known of sampled histories only.
    energy_lost, energy_stored
        At impacts, where energy created counts negatively, and stored at the end [J].
    energy_created, creating_impacts
        Energy created at impacts [J], and how many did.
    counts
        Of events, by the codes of `physics.planar.state`.
    steps
        Taylor steps.
    device_force, device_velocity, device_energy
        (slots,) largest force [N], largest rate [m/s], dissipated energy [J].
    device_stored, permanent
        (slots,) what is stored at the end over the start [J], plastic elongation of a tendon [m].
    """

    outcome: int
    phase: int
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
    energy_input: float
    energy_damped: float
    energy_lost: float
    energy_stored: float
    energy_created: float
    creating_impacts: int
    counts: NDArray[np.int64]
    steps: int
    device_force: NDArray[np.float64]
    device_velocity: NDArray[np.float64]
    device_energy: NDArray[np.float64]
    device_stored: NDArray[np.float64]
    permanent: NDArray[np.float64]


def histories_of(results: Record, storeys: int) -> list[History]:
    """The histories of some `state.RESULT`.

    Parameters
    ----------
    results
        Records of `state.RESULT`.
    storeys
        n of their structures.
    """
    # Fields by attribute take numpy ten times as long.
    plain = results.view(np.dtype((np.void, results.dtype)), np.ndarray)
    return [_history_of(result, storeys) for result in plain]


def _history_of(result: Any, storeys: int) -> History:
    return History(
        outcome=int(result["outcome"]),
        phase=int(result["phase"]),
        rotation=float(result["rotation"]),
        time=float(result["time"]),
        intervals=int(result["intervals"]),
        max_rotation=float(result["max_theta"]),
        max_rotation_time=float(result["max_theta_time"]),
        critical_time=float(result["critical_time"]),
        storey_shears=result["storey_shear"][:storeys].copy(),
        floor_accelerations=result["floor_acceleration"][:storeys].copy(),
        friction=np.array([result["friction_top"], result["friction_bottom"]]),
        least_normal=np.array([result["normal_top"], result["normal_bottom"]]),
        energy_input=float(result["energy_input"]),
        energy_damped=float(result["energy_damped"]),
        energy_lost=float(result["energy_lost"]),
        energy_stored=float(result["energy_stored"] + result["device_stored"].sum()),
        energy_created=float(result["energy_created"]),
        creating_impacts=int(result["creating_impacts"]),
        counts=result["events"].copy(),
        steps=int(result["steps"]),
        device_force=result["device_force"].copy(),
        device_velocity=result["device_velocity"].copy(),
        device_energy=result["device_energy"].copy(),
        device_stored=result["device_stored"].copy(),
        permanent=result["permanent"].copy(),
    )


@dataclass(frozen=True)
class Request:
    """A history to run: numbers of its structure and its records among all, and a factor.

    Parameters
    ----------
    system, record, vertical
        Numbers of its structure and of the two components among all; no vertical one if None.
    scale
        Multiplies both components.
    """

    system: int
    record: int
    vertical: int | None = None
    scale: float = 1.0


def run_of(
    systems: Record,
    motions: Sequence[GroundMotion],
    requests: Sequence[Request],
    *,
    rows: int = 0,
    events: int = 0,
) -> Run:
    """What the kernel needs to run histories, and room for their results.

    Parameters
    ----------
    systems
        (S,) records, see `stacked_systems`.
    motions
        Records of the ground; those of the two components of a motion are equally long.
    requests
        The histories.
    rows, events
        Samples and events of the first history for which there is room.
    """
    n = int(systems.n[0])
    starts = np.cumsum([0] + [motion.npts for motion in motions])
    given = records(REQUEST, count=len(requests))
    along = [motions[request.record] for request in requests]
    above = [request.vertical for request in requests]
    given.system = [request.system for request in requests]
    given.record = [starts[request.record] for request in requests]
    given.vertical = [NO_RECORD if number is None else starts[number] for number in above]
    given.npts, given.dt = [motion.npts for motion in along], [motion.dt for motion in along]
    given.scale = [request.scale for request in requests]
    return Run(
        systems=systems,
        requests=given,
        acceleration=np.concatenate([motion.acceleration for motion in motions]),
        results=records(RESULT, count=len(requests)),
        output=Output(
            samples=records(SAMPLE, count=rows),
            floors=np.empty((rows, 2, n)),
            log=records(EVENT, count=events),
            devices=np.empty((rows, 4, int(systems.devices.max()))),
        ),
        block=empty_block(n),
    )


@dataclass(frozen=True, eq=False)
class SampledHistory:
    """A history with its samples and events, records of `physics.planar.state`.

    Parameters
    ----------
    history
        What is left behind at the end.
    ground, vertical
        Horizontal and vertical acceleration, as long as the longer component [m/s2].
    samples
        (intervals + 1,).
    floors
        (intervals + 1, 2, n) displacements [m] and velocities [m/s] relative to the ground.
    log
        (events,).
    devices
        (intervals + 1, 4, devices), see `physics.planar.run.Output`.
    """

    history: History
    ground: NDArray[np.float64]
    vertical: NDArray[np.float64] | None
    samples: Record
    floors: NDArray[np.float64]
    log: Record
    devices: NDArray[np.float64]


def longest_history(settings: TimeHistorySettings, record: GroundMotion) -> int:
    """Samples of a history that never comes to rest.

    Parameters
    ----------
    settings
        Of these the free vibration.
    record
        Horizontal ground acceleration.
    """
    free = settings.free_vibration
    longest = LONGEST_FREE_VIBRATION if free is None else free
    return record.npts + math.ceil(longest / record.dt) + 1


def numbers_of_a_sample(structure: PodiumStructure) -> int:
    """What is known at each sample of a history with everything that follows from it.

    Parameters
    ----------
    structure
        Podium, bearings and building.
    """
    # Of a floor u, u', u'', drift and shear, and u, u'' on a fixed base; of the podium time,
    # ground, u_b, v_b, moment, four forces of all columns and of one, and what is stored.
    return 7 * structure.storeys + len(SAMPLE) + 14 + 4 * len(structure.devices)


def refuse_endless(
    structure: PodiumStructure, settings: TimeHistorySettings, record: GroundMotion
) -> None:
    """Refuse a history that may take more memory or time than anybody has.

    Parameters
    ----------
    structure
        Podium, bearings and building.
    settings
        Of these the accuracy and the free vibration.
    record
        Horizontal ground acceleration.

    Raises
    ------
    CaseError
        If it may have more than `MOST_NUMBERS` or `MOST_STEPS`.
    """
    remedy = "give a shorter analysis.free_vibration"
    numbers = float(longest_history(settings, record)) * numbers_of_a_sample(structure)
    if numbers > MOST_NUMBERS:
        raise CaseError(
            f"the history may have {longest_history(settings, record)} samples of"
            f" {structure.storeys} storeys, {8e-9 * numbers:.3g} GB, which must not be more than"
            f" {8e-9 * MOST_NUMBERS:.3g} GB; {remedy}, or resample the record, whose dt is"
            f" {record.dt:g} s"
        )
    refuse_steps(most_steps(structure, settings, record.duration))


def refuse_steps(steps: float) -> None:
    """Refuse a history of more than `MOST_STEPS`: raises CaseError."""
    if steps > MOST_STEPS:
        raise CaseError(
            f"the history may take {steps:.3g} steps, which must not be more than {MOST_STEPS:.3g}:"
            " the record is too long, or the highest modes of the building are too stiff or too"
            " strongly damped; give a shorter analysis.free_vibration, damp by `modal`, or use"
            " fewer storeys"
        )


def sampled_history(
    structure: PodiumStructure,
    record: GroundMotion,
    vertical: GroundMotion | None,
    settings: TimeHistorySettings,
) -> SampledHistory:
    """Run one history and keep everything.

    Parameters
    ----------
    structure, settings
        What is followed, and how.
    record, vertical
        Components of the ground acceleration, with the same time step.

    Raises
    ------
    RecordError
        If the time steps differ.
    """
    # Imported here: compiling or loading kernels costs time that other commands need not pay.
    from rpscli.physics.planar.driver import integrate

    along, upwards = MotionComponents(record, vertical).of_one_length
    motions = [along] if upwards is None else [along, upwards]
    request = Request(0, 0, None if upwards is None else 1)
    systems = stacked_systems([(structure, settings)])
    refuse_endless(structure, settings, along)
    rows = longest_history(settings, along)
    events = FIRST_LOG
    while True:
        run = run_of(systems, motions, [request], rows=rows, events=events)
        with compiled(equipped=bool(structure.devices)):
            integrate(run, lanes=1)
        history = histories_of(run.results, structure.storeys)[0]
        if (seen := int(history.counts.sum())) <= events:
            break
        events = seen
        del run  # before there is room for another
    kept, output = history.intervals + 1, run.output
    # Shortened in place, which nothing else looks at: a copy would take as much again.
    for array in (output.floors, output.devices):
        array.resize((kept, *array.shape[1:]), refcheck=False)
    return SampledHistory(
        history,
        along.acceleration,
        None if upwards is None else upwards.acceleration,
        output.samples[:kept].copy(),
        output.floors,
        output.log[:seen],
        output.devices,
    )
