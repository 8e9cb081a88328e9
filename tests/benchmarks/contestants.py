"""Programs that follow one history each, under the same records, and what they found and took."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from benchmarks.measure import seconds
from benchmarks.peers.heyoka_batch import HeyokaBatch, empty_batch_step_seconds
from benchmarks.peers.heyoka_history import HeyokaRocking, empty_step_seconds
from benchmarks.peers.rocking import PeerHistory, Rocking
from rpscli.records.ground_motion import GroundMotion

Program = Callable[[GroundMotion], PeerHistory]


@dataclass(frozen=True)
class Contest:
    """One program: seconds, largest rotation and impacts of each of its records."""

    name: str
    times: list[float]
    rotations: list[float] = field(default_factory=list)
    impacts: list[int] = field(default_factory=list)

    @property
    def milliseconds(self) -> float:
        """Mean of a history."""
        return 1e3 * float(np.mean(self.times))

    def times_faster(self, other: Contest) -> float:
        """How many times faster the other one is, under the records that both have run."""
        common = min(len(self.times), len(other.times))
        return float(np.sum(self.times[:common]) / np.sum(other.times[:common]))


def run(name: str, program: Program, records: Sequence[GroundMotion], repeats: int = 5) -> Contest:
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


def taylor(podium: Rocking, records: Sequence[GroundMotion]) -> list[Contest]:
    """heyoka, one history after the other: all of it, uplifted only, and its machine code alone.

    The last are its uplifted steps, less what calling them from Python costs; full contact,
    impacts and the bookkeeping at samples are not in it.
    """
    dt = records[0].dt
    alone = HeyokaRocking(podium, dt, alone=True)
    entire = run("heyoka alone, tol 1e-4", lambda r: alone.history(r.acceleration), records)
    peer, call = HeyokaRocking(podium, dt), empty_step_seconds()
    name = "heyoka, tol 1e-4, full contact given"
    whole = run(name, lambda r: peer.history(r.acceleration), records)
    peer.clocked = True
    times = [np.inf] * len(records)
    for _ in range(5):
        for i, record in enumerate(records):
            peer.history(record.acceleration)
            times[i] = min(times[i], peer.inside - call * peer.steps)
    return [entire, whole, replace(whole, name="heyoka, its steps alone", times=times)]


def taylor_lanes(podium: Rocking, records: Sequence[GroundMotion]) -> list[Contest]:
    """The same in heyoka's batch mode, 8 histories at once."""
    peer, call = HeyokaBatch(podium, records[0].dt), empty_batch_step_seconds()
    rows, count = np.array([r.acceleration for r in records]), len(records)
    found: list[PeerHistory] = []

    def work() -> None:
        found[:] = peer.histories(rows)

    whole, alone = seconds(work, repeats=5) / count, np.inf
    for _ in range(5):
        peer.histories(rows, clocked=True)
        alone = min(alone, (peer.inside - call * peer.steps) / count)
    rotations, impacts = [f.max_rotation for f in found], [f.impacts for f in found]
    return [
        Contest(name, [spent] * count, rotations, impacts)
        for name, spent in (
            ("heyoka, batch of 8, tol 1e-4", whole),
            ("heyoka, its batch steps alone", float(alone)),
        )
    ]
