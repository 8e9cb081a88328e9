"""How cost grows: with storeys, length of the record, impacts, points and cores.

Run from the root of the repository: ``PYTHONPATH=tests python -m benchmarks.growth``. The exponent
is the slope between neighbouring rows on log-log axes: 1 is linear.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

from benchmarks.measure import seconds
from benchmarks.structures import SECONDS, STEP, motion, structure
from benchmarks.tables import show
from rpscli.analyses.demand import Request, demands
from rpscli.analyses.kernels.history import sampled_history
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.model.podium import PodiumStructure
from rpscli.physics.state import LANES
from rpscli.records.ground_motion import GroundMotion, MotionComponents

SEEDS = range(1, 5)
STOREYS = (1, 2, 3, 5, 10, 20, 50, 100)
LENGTHS = (10, 20, 40, 80, 160)
PEAKS = ("0.1g", "0.2g", "0.3g", "0.4g", "0.5g", "0.6g", "0.7g")
POINTS = (10, 100, 1000)
CORE_POINTS = 512
ALONE = 1_000_000_000
"""Histories from which on lanes would be worth while: never."""
SETTINGS = TimeHistorySettings(free_vibration=0.0)


def exponents(sizes: Sequence[float], costs: Sequence[float]) -> list[str]:
    """Log-log slopes to the row before."""
    pairs = zip(sizes[:-1], sizes[1:], costs[:-1], costs[1:], strict=True)
    slopes = [math.log(d / c) / math.log(b / a) for a, b, c, d in pairs]
    return ["", *(f"{slope:.2f}" for slope in slopes)]


class Work(NamedTuple):
    """What histories of one kind cost, a history that overturns counted as far as it goes."""

    milliseconds: float
    steps: float
    impacts: float

    @property
    def nanoseconds_each(self) -> float:
        """Time over steps: full contact and events are in it too."""
        return 1e6 * self.milliseconds / (self.steps * SECONDS / STEP)


def work_of(building: PodiumStructure, records: Sequence[GroundMotion]) -> Work:
    """Time [ms a record], steps [a sample] and impacts, one history at a time."""
    requests = [Request(building, MotionComponents(r), SETTINGS) for r in records]
    spent = 1e3 * seconds(lambda: demands(requests, worth_lanes=ALONE))
    found = [sampled_history(building, MotionComponents(r), SETTINGS).history for r in records]
    samples = sum(h.intervals for h in found)
    whole = samples / (records[0].npts - 1)
    impacts = sum(d.impacts for d in demands(requests, worth_lanes=ALONE))
    return Work(spent / whole, sum(h.steps for h in found) / samples, impacts / whole)


def with_storeys() -> None:
    """Two kernels serve every number of storeys; beyond ten the period stays at one second.

    Steps then shorten with the highest mode, so a history grows faster than a step.
    """
    records = [motion(seed, peak="0.4g") for seed in SEEDS]
    works = [work_of(structure(n, period=min(n / 10, 1.0)), records) for n in STOREYS]
    costs, each = [w.milliseconds for w in works], [w.nanoseconds_each for w in works]
    rows = zip(
        map(str, STOREYS),
        [f"{e:.0f}" for e in each],
        exponents(STOREYS, each),
        [f"{w.steps:.2f}" for w in works],
        [f"{c:.3g}" for c in costs],
        exponents(STOREYS, costs),
        strict=True,
    )
    columns = ("storeys", "ns/step", "exponent", "steps/sample", "ms/history", "exponent")
    show("One history of 40 s with storeys", columns, rows)


def with_length() -> None:
    """Records of the same peak; the synthetic ones shake all along."""
    building = structure(9)
    works = [work_of(building, [motion(s, duration=t) for s in SEEDS]) for t in LENGTHS]
    costs = [w.milliseconds for w in works]
    rows = zip(
        map(str, LENGTHS),
        [f"{c:.3g}" for c in costs],
        exponents(LENGTHS, costs),
        [f"{w.steps:.2f}" for w in works],
        [f"{w.impacts:.0f}" for w in works],
        strict=True,
    )
    columns = ("record, s", "ms/history", "exponent", "steps/sample", "impacts")
    show("One history of nine storeys with the record's length", columns, rows)


def with_impacts() -> None:
    """Stronger shaking: more of the time uplifted, and more impacts."""
    building = structure(9)
    rows = []
    for peak in PEAKS:
        work = work_of(building, [motion(s, peak=peak) for s in SEEDS])
        numbers = (f"{work.impacts:.0f}", f"{work.steps:.2f}", f"{work.milliseconds:.3g}")
        rows.append((peak, *numbers))
    columns = ("peak", "impacts", "steps/sample", "ms/history")
    show("One history of 40 s and nine storeys with impacts", columns, rows)


def study(points: int) -> list[Request]:
    """A study's points: sixteen records, scaled differently each time."""
    building, records = structure(3), [motion(seed) for seed in range(1, 17)]
    return [
        Request(building, MotionComponents(records[i % 16]), SETTINGS, scale=0.8 + 0.4 * i / points)
        for i in range(points)
    ]


def with_points() -> None:
    """Points of a study in lanes of one core."""
    costs = []
    for points in POINTS:
        requests = study(points)
        costs.append(seconds(lambda r=requests: demands(r, worth_lanes=1)))  # type: ignore[misc]
    rows = zip(
        map(str, POINTS),
        [f"{1e3 * c / p:.3g}" for c, p in zip(costs, POINTS, strict=True)],
        exponents(POINTS, costs),
        strict=True,
    )
    title = f"Points of three storeys in {LANES} lanes of a core"
    show(title, ("points", "ms/point", "exponent"), rows)


def on_threads(threads: int) -> Callable[[], None]:
    """The same points shared out to threads in blocks of 32, as studies do."""
    requests = study(CORE_POINTS)
    blocks = [requests[i : i + 32] for i in range(0, len(requests), 32)]

    def work() -> None:
        with ThreadPoolExecutor(threads) as pool:
            list(pool.map(lambda block: demands(block, worth_lanes=1), blocks))

    return work


def with_cores() -> None:
    """Threads of one process: kernels run without the GIL."""
    threads = sorted({1, 2, os.cpu_count() or 1})
    costs = [seconds(on_threads(count)) for count in threads]
    rows = zip(
        map(str, threads),
        [f"{1e3 * c / CORE_POINTS:.3g}" for c in costs],
        [f"{costs[0] / c:.2f}" for c in costs],
        strict=True,
    )
    show(f"{CORE_POINTS} points on threads", ("threads", "ms/point", "times faster"), rows)


def main() -> None:
    """Measure, and print five tables."""
    with_storeys()
    with_length()
    with_impacts()
    with_points()
    with_cores()


if __name__ == "__main__":
    main()
