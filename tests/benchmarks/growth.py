"""How cost grows: with storeys, length of the record, impacts, points and cores.

Run from the root of the repository: ``PYTHONPATH=tests python -m benchmarks.growth``. The exponent
is the slope between neighbouring rows on log-log axes: 1 is linear.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

from benchmarks.common import ALONE, SECONDS, STEP, motion, seconds, settings, show, structure
from rpscli.analyses.demand import Request, demands
from rpscli.analyses.kernels.history import sampled_history
from rpscli.model.podium import PodiumStructure
from rpscli.physics.state import LANES
from rpscli.records.ground_motion import GroundMotion, MotionComponents

SEEDS = range(1, 5)
STOREYS = (1, 2, 3, 5, 10, 20, 50, 100)
LENGTHS = (10, 20, 40, 80, 160)
PEAKS = ("0.1g", "0.2g", "0.3g", "0.4g", "0.5g", "0.6g", "0.7g")
POINTS = (10, 100, 1000)
CORE_POINTS = 512


def exponents(sizes: Sequence[float], costs: Sequence[float]) -> list[str]:
    """Log-log slopes to the row before."""
    pairs = zip(sizes[:-1], sizes[1:], costs[:-1], costs[1:], strict=True)
    slopes = [math.log(d / c) / math.log(b / a) for a, b, c, d in pairs]
    return ["", *(f"{slope:.2f}" for slope in slopes)]


def texts(form: str, values: Iterable[float]) -> list[str]:
    return [format(value, form) for value in values]


class Work(NamedTuple):
    """What histories of one kind cost, a history that overturns counted as far as it goes."""

    milliseconds: float
    steps: float
    impacts: float


def work_of(building: PodiumStructure, records: Sequence[GroundMotion]) -> Work:
    """Time [ms a record], steps [a sample] and impacts, one history at a time."""
    requests = [Request(building, MotionComponents(r), settings()) for r in records]
    spent = 1e3 * seconds(lambda: demands(requests, worth_lanes=ALONE))
    found = [sampled_history(building, MotionComponents(r), settings()).history for r in records]
    samples = sum(h.intervals for h in found)
    whole = samples / (records[0].npts - 1)
    impacts = sum(d.impacts for d in demands(requests, worth_lanes=ALONE))
    return Work(spent / whole, sum(h.steps for h in found) / samples, impacts / whole)


def of_single_histories() -> None:
    """Two kernels serve every number of storeys; beyond ten the period stays at one second.

    Steps then shorten with the highest mode, so a history grows faster than a step. Full contact
    and events are in the time of a step. Records of other lengths have the same peak and shake all
    along; under stronger ones more of the time is uplifted, with more impacts.
    """
    records = [motion(seed, peak="0.4g") for seed in SEEDS]
    works = [work_of(structure(n, period=min(n / 10, 1.0)), records) for n in STOREYS]
    costs = [w.milliseconds for w in works]
    each = [1e6 * w.milliseconds / (w.steps * SECONDS / STEP) for w in works]
    columns: tuple[str, ...]
    columns = ("storeys", "ns/step", "exponent", "steps/sample", "ms/history", "exponent")
    rows = zip(
        map(str, STOREYS),
        texts(".0f", each),
        exponents(STOREYS, each),
        texts(".2f", [w.steps for w in works]),
        texts(".3g", costs),
        exponents(STOREYS, costs),
        strict=True,
    )
    show("One history of 40 s with storeys", columns, rows)
    building = structure(9)
    works = [work_of(building, [motion(s, duration=t) for s in SEEDS]) for t in LENGTHS]
    costs = [w.milliseconds for w in works]
    columns = ("record, s", "ms/history", "exponent", "steps/sample", "impacts")
    rows = zip(
        map(str, LENGTHS),
        texts(".3g", costs),
        exponents(LENGTHS, costs),
        texts(".2f", [w.steps for w in works]),
        texts(".0f", [w.impacts for w in works]),
        strict=True,
    )
    show("One history of nine storeys with the record's length", columns, rows)
    works = [work_of(building, [motion(s, peak=peak) for s in SEEDS]) for peak in PEAKS]
    lines = [
        (peak, f"{w.impacts:.0f}", f"{w.steps:.2f}", f"{w.milliseconds:.3g}")
        for peak, w in zip(PEAKS, works, strict=True)
    ]
    columns = ("peak", "impacts", "steps/sample", "ms/history")
    show("One history of 40 s and nine storeys with impacts", columns, lines)


def study(points: int) -> list[Request]:
    """A study's points: sixteen records, scaled differently each time."""
    building, records = structure(3), [MotionComponents(motion(seed)) for seed in range(1, 17)]
    return [
        Request(building, records[i % 16], settings(), scale=0.8 + 0.4 * i / points)
        for i in range(points)
    ]


def of_studies() -> None:
    """In lanes of one core, and in blocks of 32 on threads of one process, without the GIL."""
    costs = []
    for points in POINTS:
        requests = study(points)
        costs.append(seconds(lambda r=requests: demands(r, worth_lanes=1)))  # type: ignore[misc]
    each = [1e3 * c / p for c, p in zip(costs, POINTS, strict=True)]
    columns = ("points", "ms/point", "exponent")
    rows = zip(map(str, POINTS), texts(".3g", each), exponents(POINTS, costs), strict=True)
    show(f"Points of three storeys in {LANES} lanes of a core", columns, rows)
    requests, costs = study(CORE_POINTS), []
    blocks = [requests[i : i + 32] for i in range(0, len(requests), 32)]
    threads = sorted({1, 2, os.cpu_count() or 1})
    for count in threads:

        def work(count: int = count) -> None:
            with ThreadPoolExecutor(count) as pool:
                list(pool.map(lambda block: demands(block, worth_lanes=1), blocks))

        costs.append(seconds(work))
    rows = zip(
        map(str, threads),
        texts(".3g", [1e3 * c / CORE_POINTS for c in costs]),
        texts(".2f", [costs[0] / c for c in costs]),
        strict=True,
    )
    show(f"{CORE_POINTS} points on threads", ("threads", "ms/point", "times faster"), rows)


def main() -> None:
    """Measure, and print five tables."""
    of_single_histories()
    of_studies()


if __name__ == "__main__":
    main()
