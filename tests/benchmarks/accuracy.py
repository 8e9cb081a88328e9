"""Accuracy over an ensemble, beside what it costs: steps of half, one, two, four times as many.

Run from the root of the repository: ``PYTHONPATH=tests python -m benchmarks.accuracy``. Synthetic
records on 3, 6 and 9 storeys and three curvatures of the bearings, those that overturn left out.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from benchmarks.common import (
    STEP,
    agreeing,
    installed,
    motions,
    seconds,
    settings,
    share,
    show,
    structure,
)
from benchmarks.peers.heyoka_history import HeyokaRocking
from benchmarks.peers.rocking import rocking_of
from rpscli.analyses.demand import Request, demands
from rpscli.analyses.kernels.history import sampled_history
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

Answer = tuple[list[float], float]
"""Largest rotations of one number of storeys, and seconds for all."""

Buildings = list[PodiumStructure]


def rps(buildings: Buildings, records: list[GroundMotion], accuracy: float) -> Answer:
    """In lanes of one core."""
    requests = [
        Request(b, MotionComponents(r), settings(accuracy)) for b in buildings for r in records
    ]
    found: list[float] = []

    def work() -> None:
        found[:] = [d.max_rotation for d in demands(requests, worth_lanes=1)]

    return found, seconds(work, repeats=2)


def heyoka(buildings: Buildings, records: list[GroundMotion], tol: float) -> Answer:
    """One after the other."""
    peers = [HeyokaRocking(rocking_of(b), STEP, tol) for b in buildings]
    found: list[float] = []

    def work() -> None:
        found[:] = [p.history(r.acceleration).max_rotation for p in peers for r in records]

    return found, seconds(work, repeats=1)


def main() -> None:
    """Measure, and print one table."""
    with_heyoka = installed("heyoka")
    records = motions(RECORDS)
    ensemble = {n: [structure(n, rho) for rho in CURVATURES] for n in STOREYS}
    reference = {n: rps(ensemble[n], records, TIGHT)[0] for n in STOREYS}
    limits = {
        n: np.repeat([2.0 * b.critical_rotation for b in ensemble[n]], RECORDS) for n in STOREYS
    }

    def line(name: str, answer: Callable[[Buildings], Answer], counted: str) -> list[str]:
        answers = {n: answer(ensemble[n]) for n in STOREYS}
        counts = [agreeing(answers[n][0], reference[n], limits[n]) for n in STOREYS]
        whole = share(sum(c for c, _ in counts), sum(of for _, of in counts))
        histories = RECORDS * len(CURVATURES) * len(STOREYS)
        spent = 1e3 * sum(time for _, time in answers.values()) / histories
        return [name, whole, *(share(*c) for c in counts), f"{spent:.3g}", counted]

    def steps(accuracy: float) -> float:
        """A sample, over whole histories."""
        histories = [
            sampled_history(b, MotionComponents(r), settings(accuracy)).history
            for buildings in ensemble.values()
            for b in buildings
            for r in records[:COUNTED]
        ]
        return float(sum(h.steps for h in histories) / sum(h.intervals for h in histories))

    lines = [
        line(f"rps, accuracy {a:g}", lambda b, a=a: rps(b, records, a), f"{steps(a):.2f}")  # type: ignore[misc]
        for a in ACCURACIES
    ]
    if with_heyoka:
        lines += [
            line(f"heyoka, tol {t:.0e}", lambda b, t=t: heyoka(b, records, t), "")  # type: ignore[misc]
            for t in (1e-4, 1e-12)
        ]
    title = (
        f"Histories within 1e-4 in max|theta| of rps at accuracy {TIGHT:g}; rps in {LANES} lanes"
    )
    show(title, COLUMNS, lines)


if __name__ == "__main__":
    main()
