"""One history of 40 s at 200 Hz: what others would run, and we.

Run from the root of the repository: ``PYTHONPATH=tests python -m benchmarks.histories``. All is
measured in one run on one core, so that the ratios mean something; accuracy stands beside speed.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from benchmarks.common import (
    ALONE,
    STEP,
    agreeing,
    installed,
    motions,
    say,
    seconds,
    settings,
    share,
    show,
    structure,
)
from benchmarks.peers.heyoka_history import HeyokaRocking
from benchmarks.peers.rocking import PeerHistory, rocking_of
from benchmarks.peers.scipy_history import ScipyRocking, compiled_rates, python_rates
from rpscli.analyses.demand import Request, demands, histories
from rpscli.analyses.kernels.history import sampled_history
from rpscli.analyses.result_quantities import HISTORY
from rpscli.model.podium import PodiumStructure
from rpscli.physics.state import IMPACT, LANES
from rpscli.records.ground_motion import GroundMotion, MotionComponents

RECORDS = 64
TIMES = 10
"""Each record is followed so often in lanes: of few histories, lanes are idle near the end."""
FEW = 8
"""Records for scipy, which takes seconds each."""
TIGHT = 8.0
"""Accuracy of the reference."""
COLUMNS = (
    "storeys",
    "program",
    "over rps, one",
    "over rps, lanes",
    "ms/history",
    "max theta to 1e-4",
    "impacts",
)


@dataclass(frozen=True)
class Contest:
    """One program: seconds, largest rotation and impacts of each of its records."""

    name: str
    times: list[float]
    rotations: list[float]
    impacts: list[int]

    def times_faster(self, other: Contest) -> float:
        """How many times faster the other one is, under the records that both have run."""
        common = min(len(self.times), len(other.times))
        return float(np.sum(self.times[:common]) / np.sum(other.times[:common]))


def run(
    name: str,
    program: Callable[[GroundMotion], PeerHistory],
    records: Sequence[GroundMotion],
    repeats: int = 5,
) -> Contest:
    """Each record by itself, the least time of some rounds through all of them."""
    program(records[0])  # may compile
    found: dict[int, PeerHistory] = {}
    times = [np.inf] * len(records)
    for _ in range(repeats):
        for i, record in enumerate(records):
            start = time.perf_counter()
            found[i] = program(record)
            times[i] = min(times[i], time.perf_counter() - start)
    answers = [found[i] for i in range(len(records))]
    return Contest(name, times, [a.max_rotation for a in answers], [a.impacts for a in answers])


def requests(
    building: PodiumStructure, records: Sequence[GroundMotion], accuracy: float = 1.0
) -> list[Request]:
    return [Request(building, MotionComponents(r), settings(accuracy)) for r in records]


def ours(building: PodiumStructure, records: Sequence[GroundMotion]) -> list[Contest]:
    """One history with its samples, one without; in lanes; with all results, as studies keep."""

    def sampled(record: GroundMotion) -> PeerHistory:
        history = sampled_history(building, MotionComponents(record), settings()).history
        return PeerHistory(float(history.max_theta), int(history.events[IMPACT]))

    def alone(record: GroundMotion) -> PeerHistory:
        (found,) = demands(requests(building, [record]), worth_lanes=ALONE)
        return PeerHistory(found.max_rotation, found.impacts)

    found = demands(requests(building, records), worth_lanes=1)
    often = requests(building, [*records] * TIMES)

    def columns() -> None:
        for _, together in histories(often):
            together.columns(HISTORY)

    def together(name: str, work: Callable[[], object]) -> Contest:
        spent = [seconds(work) / len(often)] * len(records)
        return Contest(name, spent, [d.max_rotation for d in found], [d.impacts for d in found])

    name = f"rps, {len(often)} in {LANES} lanes"
    return [
        run("rps, one with all samples", sampled, records),
        run("rps, one", alone, records),
        together(name, lambda: demands(often, worth_lanes=1)),
        together(f"{name}, results as in studies", columns),
    ]


def peers(
    building: PodiumStructure, records: Sequence[GroundMotion], *, heyoka: bool
) -> Iterator[Contest]:
    """Those that can follow the whole history."""
    podium = rocking_of(building)
    for name, rates in (
        ("scipy RK45", python_rates),
        ("scipy RK45, compiled rates", compiled_rates),
    ):
        scipy = ScipyRocking(podium, STEP, rates(podium))
        yield run(name, lambda r, s=scipy: s.history(r.acceleration), records[:FEW], 1)  # type: ignore[misc]
    for name, alone in (
        ("heyoka alone, tol 1e-4", True),
        ("heyoka, tol 1e-4, full contact given", False),
    ):
        if heyoka:
            peer = HeyokaRocking(podium, STEP, alone=alone)
            yield run(name, lambda r, p=peer: p.history(r.acceleration), records)  # type: ignore[misc]


def figure(value: float) -> str:
    """Three figures, without an exponent."""
    return f"{value:,.0f}" if abs(value) >= 100.0 else f"{value:.3g}"


def rows(storeys: int, records: Sequence[GroundMotion], *, heyoka: bool) -> Iterator[list[str]]:
    """All lines for one building."""
    building = structure(storeys)
    limit = settings().overturning_limit * building.critical_rotation
    tight = demands(requests(building, records, TIGHT), worth_lanes=1)
    exact = [d.max_rotation for d in tight]
    own = ours(building, records)
    _, alone, lanes, _ = own
    gain = alone.times_faster(lanes)
    for c in (*peers(building, records, heyoka=heyoka), *own):
        faster, spent = c.times_faster(alone), 1e3 * float(np.mean(c.times))
        close = share(*agreeing(c.rotations, exact, limit))
        numbers = map(figure, (faster, faster * gain, spent))
        yield [str(storeys), c.name, *numbers, close, f"{np.mean(c.impacts):.0f}"]
    if heyoka:
        other = HeyokaRocking(rocking_of(building), STEP, tol=1e-12)
        found = [other.history(r.acceleration).max_rotation for r in records]
        agrees = share(*agreeing(found, exact, limit))
        say(f"{storeys} storeys: heyoka at tol 1e-12 agrees with the reference in {agrees}")


def main() -> None:
    """Measure, and print one table."""
    heyoka = installed("heyoka")
    records = motions(RECORDS)
    lines = [line for n in (3, 9) for line in rows(n, records, heyoka=heyoka)]
    title = "One history of 40 s at 200 Hz on one core; ratios: times that rps is faster"
    show(title, COLUMNS, lines)


if __name__ == "__main__":
    main()
