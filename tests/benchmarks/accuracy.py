"""Accuracy over an ensemble, beside what it costs: steps of half, one, two, four times as many.

Run from the root of the repository: ``PYTHONPATH=tests python -m benchmarks.accuracy``. Synthetic
records on 3, 6 and 9 storeys and three curvatures of the bearings, those that overturn left out.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import NamedTuple

import numpy as np

from benchmarks.agreement import agreeing, share
from benchmarks.measure import seconds
from benchmarks.peers.heyoka_history import HeyokaRocking
from benchmarks.peers.installed import installed
from benchmarks.peers.rocking import rocking_of
from benchmarks.structures import STEP, motions, structure
from benchmarks.tables import show
from rpscli.analyses.demand import Request, demands
from rpscli.analyses.kernels.history import sampled_history
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.model.podium import PodiumStructure
from rpscli.physics.state import LANES
from rpscli.records.ground_motion import GroundMotion, MotionComponents

RECORDS = 60
STOREYS = (3, 6, 9)
CURVATURES = (0.25, 0.5, 1.5)
ACCURACIES = (0.5, 1.0, 2.0, 4.0)
TIGHT = 16.0
COUNTED = 6
"""Records whose steps are counted: that needs single histories."""
COLUMNS = (
    "program",
    "all, to 1e-4",
    *(f"{n} storeys" for n in STOREYS),
    "ms/history",
    "steps/sample",
)

Ensemble = dict[int, list[PodiumStructure]]


class Answer(NamedTuple):
    """Largest rotations of one number of storeys, and seconds for all."""

    rotations: list[float]
    spent: float


def settings(accuracy: float) -> TimeHistorySettings:
    """Without free vibration, so that every history is as long as its record."""
    return TimeHistorySettings(free_vibration=0.0, accuracy=accuracy)


def rps(
    buildings: Iterable[PodiumStructure], records: list[GroundMotion], accuracy: float
) -> Answer:
    """All histories of one number of storeys, in lanes of one core."""
    requests = [
        Request(b, MotionComponents(r), settings(accuracy)) for b in buildings for r in records
    ]
    found: list[float] = []

    def work() -> None:
        found[:] = [d.max_rotation for d in demands(requests, worth_lanes=1)]

    return Answer(found, seconds(work, repeats=2))


def heyoka(buildings: Iterable[PodiumStructure], records: list[GroundMotion], tol: float) -> Answer:
    """The same by heyoka, one after the other."""
    peers = [HeyokaRocking(rocking_of(b), STEP, tol) for b in buildings]
    found: list[float] = []

    def work() -> None:
        found[:] = [p.history(r.acceleration).max_rotation for p in peers for r in records]

    return Answer(found, seconds(work, repeats=1))


def steps(ensemble: Ensemble, records: list[GroundMotion], accuracy: float) -> float:
    """Steps a sample, over the whole histories."""
    histories = [
        sampled_history(b, MotionComponents(r), settings(accuracy)).history
        for buildings in ensemble.values()
        for b in buildings
        for r in records[:COUNTED]
    ]
    samples = sum(h.intervals for h in histories)
    return float(sum(h.steps for h in histories) / samples)


def main() -> None:
    """Measure, and print one table."""
    with_heyoka = installed("heyoka")
    records = motions(RECORDS)
    ensemble = {n: [structure(n, rho) for rho in CURVATURES] for n in STOREYS}
    reference = {n: rps(ensemble[n], records, TIGHT).rotations for n in STOREYS}
    limits = {
        n: np.repeat([2.0 * b.critical_rotation for b in ensemble[n]], RECORDS) for n in STOREYS
    }

    def line(name: str, answer: Callable[[int], Answer], counted: str) -> list[str]:
        answers = {n: answer(n) for n in STOREYS}
        counts = [agreeing(answers[n].rotations, reference[n], limits[n]) for n in STOREYS]
        whole = share(sum(c for c, _ in counts), sum(of for _, of in counts))
        histories = RECORDS * len(CURVATURES) * len(STOREYS)
        spent = 1e3 * sum(a.spent for a in answers.values()) / histories
        return [name, whole, *(share(*c) for c in counts), f"{spent:.3g}", counted]

    lines = [
        line(
            f"rps, accuracy {accuracy:g}",
            lambda n, a=accuracy: rps(ensemble[n], records, a),  # type: ignore[misc]
            f"{steps(ensemble, records, accuracy):.2f}",
        )
        for accuracy in ACCURACIES
    ]
    if with_heyoka:
        lines += [
            line(
                f"heyoka, tol {tol:.0e}",
                lambda n, t=tol: heyoka(ensemble[n], records, t),  # type: ignore[misc]
                "",
            )
            for tol in (1e-4, 1e-12)
        ]
    title = (
        f"Histories within 1e-4 in max|theta| of rps at accuracy {TIGHT:g}; rps in {LANES} lanes"
    )
    show(title, COLUMNS, lines)


if __name__ == "__main__":
    main()
