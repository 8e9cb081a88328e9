"""Running the kernel: histories of structures under records."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, ExitStack
from dataclasses import dataclass, replace
from itertools import accumulate
from threading import Lock
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.kernels.systems import (
    longest_free_vibration,
    most_seconds,
    most_steps,
    stacked_systems,
    steps_a_second,
)
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.errors import CaseError
from rpscli.model.podium import PodiumStructure
from rpscli.physics.interface import EVENT, REQUEST, RESULT, SAMPLE
from rpscli.physics.records import record_type, records
from rpscli.physics.run import KernelOutput, KernelRun
from rpscli.physics.state import LANES, NO_RECORD, Record
from rpscli.records.ground_motion import MotionComponents

MOST_NUMBERS = 1e9
"""Of one history and what follows from it: 8 GB, of which those
that are reached are taken."""

MOST_STEPS = 1e10
"""Of one history: more than an hour."""

WORTH_A_THREAD = 0.5
"""Histories that may take longer [s] can be interrupted."""

FIRST_LOG = 4096
"""Rows of the event log at the first attempt; a longer history is run once more."""


class HistoryRequest(NamedTuple):
    """A history to run: numbers of its structure and its motion
    among all, and a factor.
    """

    system: int
    motion: int
    scale: float = 1.0


def run_of(
    systems: Record,
    motions: Sequence[MotionComponents],
    requests: Sequence[HistoryRequest],
    *,
    pairs: bool = False,
    rows: int = 0,
    events: int = 0,
    finer: int = 1,
) -> KernelRun:
    """Input of the kernel, with room for results, and rows and
    events of the first history.

    With `pairs` all motions have two horizontal components, and
    systems are those of pairs.
    """
    first = systems.view(np.ndarray)
    n = int(first["n"][0])
    devices = int(first["devices"].max())
    samples = [motion.samples.ravel() for motion in motions]
    return KernelRun(
        systems=systems,
        requests=_request_records(motions, requests),
        acceleration=np.concatenate(samples),
        results=np.zeros(len(requests), record_type(RESULT)).view(np.recarray),
        output=KernelOutput(
            samples=records(SAMPLE, rows),
            floors=np.empty((rows, 4, n * int(first["axes"][0]) if rows else 0)),
            log=records(EVENT, events),
            devices=np.empty((rows, 4, devices)),
            finer=finer,
        ),
        ways=2 if pairs else 1,
    )


def _request_records(
    motions: Sequence[MotionComponents], requests: Sequence[HistoryRequest]
) -> Record:
    """Requests as the kernel reads them, with places in the samples
    of all motions one behind the other.
    """
    starts = [0, *accumulate(motion.samples.size for motion in motions)]
    placed = []
    for motion, start in zip(motions, starts, strict=False):
        up = motion.row("vertical")
        above = NO_RECORD if up is None else start + up * motion.npts
        second = NO_RECORD if motion.y is None else start + motion.npts
        placed.append((start, second, above, motion.npts, motion.dt))

    given = np.zeros(len(requests), record_type(REQUEST))
    for row, (system, number, scale) in zip(given, requests, strict=True):
        row["system"] = system
        row["scale"] = scale
        place = "record", "record_y", "vertical", "npts", "dt"
        for name, value in zip(place, placed[number], strict=True):
            row[name] = value
    return given.view(np.recarray)


def follow(run: KernelRun, lanes: int, *, interruptible: bool = False) -> None:
    """Follow every history of a run, of one component or of
    pairs; writes `run.results`.
    """
    from rpscli.physics.integrate import integrate

    prepare(run.ways, lanes)
    integrate(run, lanes, interruptible=interruptible)


@dataclass(frozen=True, eq=False)
class SampledHistory:
    """A history with its samples and events, records of `physics.state`."""

    history: Record  # A `interface.RESULT`: what is left behind at the end
    motion: MotionComponents  # Of the ground, as dense as the samples
    samples: Record  # (intervals + 1,)
    floors: NDArray[np.float64]
    """(intervals + 1, 3, n) displacements [m] and velocities [m/s] relative to the
    ground, absolute accelerations [m/s2]; behind those in x come those in y of
    pairs, and upwards on springs."""
    log: Record  # (events,)
    devices: NDArray[np.float64]  # (intervals + 1, 4, devices), see `physics.run.Output`


def longest_history(
    structure: PodiumStructure, settings: TimeHistorySettings, motion: MotionComponents
) -> int:
    """Samples of a history that never comes to rest."""
    longest = longest_free_vibration(structure, settings)
    return motion.npts + math.ceil(longest / motion.dt) + 1


def numbers_of_a_sample(structure: PodiumStructure) -> int:
    """Count of the numbers at each sample of a history and all that follows from it."""
    # Of a floor u, u', u'', drift and shear, and u, u'' on a fixed base; of the podium
    # time, ground, u_b, v_b, moment, four forces of all columns and of one, and what is
    # stored.
    return 7 * structure.storeys + len(SAMPLE) + 14 + 4 * len(structure.devices)


def refuse_endless(
    structure: PodiumStructure,
    settings: TimeHistorySettings,
    motion: MotionComponents,
    finer: int = 1,
) -> None:
    """Refuse a history that may take more memory or time than anybody has."""
    remedy = "give a shorter analysis.free_vibration"
    samples = longest_history(structure, settings, motion) * finer
    numbers = float(samples) * numbers_of_a_sample(structure)
    if numbers > MOST_NUMBERS:
        raise CaseError(
            f"the history may have {samples} samples of {structure.storeys} storeys,"
            f" {8e-9 * numbers:.3g} GB, which must not be more than"
            f" {8e-9 * MOST_NUMBERS:.3g} GB; {remedy}, or resample the record, whose dt"
            f" is {motion.dt:g} s"
        )
    refuse_steps(most_steps(structure, settings, motion.duration), structure)


def refuse_steps(steps: float, structure: PodiumStructure) -> None:
    """Refuse a history of more than `MOST_STEPS`: raises CaseError."""
    if steps <= MOST_STEPS:
        return
    cause = (
        "the record is too long, or the highest modes of the building are too stiff or"
        " too strongly damped; give a shorter analysis.free_vibration, damp by `modal`,"
        " or use fewer storeys"
    )
    alone = steps_a_second(replace(structure, devices=()))
    each = [steps_a_second(replace(structure, devices=(d,))) for d in structure.devices]
    if each and max(each) > 2.0 * alone:
        i = each.index(max(each))
        cause = (
            f"podium.devices.{i} ({structure.devices[i].kind}) is so stiff, or damps so"
            " strongly, that steps must be short; use less of it, a larger exponent, or"
            " a friction damper"
        )
    raise CaseError(
        f"the history may take {steps:.3g} steps, which must not be more than"
        f" {MOST_STEPS:.3g}: {cause}"
    )


def sampled_history(
    structure: PodiumStructure,
    motion: MotionComponents,
    settings: TimeHistorySettings,
    finer: int = 1,
) -> SampledHistory:
    """Run one history and keep everything, at so many even parts
    of each sampling interval.
    """
    pairs = motion.y is not None
    systems = stacked_systems([(structure, settings)], pairs=pairs)
    refuse_endless(structure, settings, motion, finer)
    rows = longest_history(structure, settings, motion) * finer
    seconds = most_seconds(structure, settings, motion)
    events = FIRST_LOG
    while True:
        run = run_of(
            systems,
            [motion],
            [HistoryRequest(0, 0)],
            pairs=pairs,
            rows=rows,
            events=events,
            finer=finer,
        )
        follow(run, lanes=1, interruptible=seconds > WORTH_A_THREAD)
        history = run.results[0]
        if (seen := int(history.events.sum())) <= events:
            break
        events = seen
        del run  # before there is room for another
    kept = int(history.intervals) * finer + 1
    output = run.output
    # Shortened in place, which nothing else looks at: a copy would take as much again.
    for array in (output.floors, output.devices):
        array.resize((kept, *array.shape[1:]), refcheck=False)
    return SampledHistory(
        history,
        motion.finer(finer),
        output.samples[:kept].copy(),
        output.floors,
        output.log[:seen],
        output.devices,
    )


Listener = Callable[[str], AbstractContextManager[None]]
"""Called with the name of a kernel before it is compiled; open while it is."""

_listeners: list[Listener] = []
_begun: set[str] = set()
"""Kernels that somebody compiles, or has compiled."""
_lock = Lock()

KERNELS = {
    (1, 1): "kernel",
    (1, LANES): "kernel for many histories",
    (2, 1): "kernel for both components",
    (2, LANES): "kernel for both components of many histories",
}
"""By horizontal components and lanes."""


def announce_to(listener: Listener) -> None:
    """Have a compilation told before it begins; the last listener counts."""
    _listeners[:] = [listener]


def prepare(ways: int, lanes: int) -> None:
    """Compile a kernel that is not compiled yet, and tell of it."""
    from rpscli.physics.kernels import is_ready, kernel

    name = KERNELS.get((ways, lanes), "kernel")
    prepare_kernel(name, lambda: is_ready(ways, lanes), lambda: kernel(ways, lanes))


def prepare_kernel(
    name: str, is_ready: Callable[[], bool], make: Callable[[], object]
) -> None:
    """Make a kernel that is not ready yet, and tell of it by its name."""
    from rpscli.physics.integrate import in_background

    if is_ready():
        return
    with _lock:
        first = name not in _begun
        _begun.add(name)
    with ExitStack() as told:
        for listener in _listeners if first else ():
            told.enter_context(listener(name))
        in_background(make)
