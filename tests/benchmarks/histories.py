"""One history of 40 s at 200 Hz: what others would run, and we.

Run from the root of the repository: ``PYTHONPATH=tests python -m benchmarks.histories``. All is
measured in one run on one core, so that the ratios mean something; accuracy stands beside speed.
"""

from __future__ import annotations

import importlib
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from rich import box
from rich.console import Console
from rich.table import Table

from benchmarks.heyoka_history import HeyokaRocking, PeerHistory
from rpscli.analyses.demand import Request, demands
from rpscli.analyses.kernels.history import sampled_history
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.model.bearing import Bearing
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import RayleighDamping, Superstructure, profile_stiffnesses
from rpscli.physics.state import IMPACT, LANES
from rpscli.records.ground_motion import GroundMotion, MotionComponents
from rpscli.records.loading import load_record

RECORDS = 64
TIMES = 10
"""Each record is followed so often in lanes: of few histories, lanes are idle near the end."""
STEP = 0.005
TIGHT = 8.0
"""Accuracy of the reference."""
ALONE = 1_000_000_000
"""Histories from which on lanes would be worth while: never."""
CLOSE = 1e-4
"""Relative error in max|theta| that counts as the same history: single ones are chaotic."""
COLUMNS = (
    "storeys", "program", "over rps, one", "over rps, lanes", "ms/history", "max theta to 1e-4",
    "impacts",
)  # fmt: skip
_CONSOLE = Console(width=132, highlight=False)


def installed(module: str) -> bool:
    """Whether a peer can be imported; says so at once if not."""
    try:
        importlib.import_module(module)
    except (ImportError, OSError, RuntimeError) as error:  # of system libraries that are missing
        _CONSOLE.print(f"{module} is left out: {error} (pip install -e '.[bench]' brings all)")
        return False
    return True


def structure(storeys: int) -> PodiumStructure:
    """The paper's building: T_1 = n/10 s, gamma = 10, eta = n, the rigid law."""
    masses = np.full(storeys, 2e5)
    stiffnesses = profile_stiffnesses(masses, storeys / 10, "sine")
    building = Superstructure(masses, stiffnesses, RayleighDamping(0.05, (1, 2)))
    return PodiumStructure(Bearing(1.5, 0.15, 0.30, 0.5), 2e4, 2e5, building, ImpactLaw("rigid"))


@dataclass(frozen=True)
class Contest:
    """One program: seconds, largest rotation and impacts of each of its records."""

    name: str
    times: list[float]
    rotations: list[float]
    impacts: list[int]

    def close(self, exact: Sequence[float], limit: float) -> str:
        """Share of those that agree with a reference, whose overturned ones are left out."""
        standing = np.array(exact) < limit
        off = np.abs(np.array(self.rotations) / exact - 1.0)[standing]
        return f"{np.mean(off < CLOSE):.0%} of {off.size}" if off.size else "none"


def run(
    name: str, program: Callable[[GroundMotion], PeerHistory], records: Sequence[GroundMotion]
) -> Contest:
    """Each record by itself, the least time of five rounds through all of them."""
    program(records[0])  # may compile
    found: dict[int, PeerHistory] = {}
    times = [np.inf] * len(records)
    for _ in range(5):
        for i, record in enumerate(records):
            start = time.perf_counter()
            found[i] = program(record)
            times[i] = min(times[i], time.perf_counter() - start)
    answers = [found[i] for i in range(len(records))]
    return Contest(name, times, [a.max_rotation for a in answers], [a.impacts for a in answers])


def contests(
    building: PodiumStructure, records: Sequence[GroundMotion], *, heyoka: bool
) -> Iterator[Contest]:
    """A peer; one history of ours with its samples, one without, and in lanes."""

    def requests(chosen: Sequence[GroundMotion]) -> list[Request]:
        # without free vibration every history is as long as its record
        settings = TimeHistorySettings(free_vibration=0.0)
        return [Request(building, MotionComponents(r), settings) for r in chosen]

    def sampled(record: GroundMotion) -> PeerHistory:
        (request,) = requests([record])
        history = sampled_history(building, request.motion, request.settings).history
        return PeerHistory(float(history.max_theta), int(history.events[IMPACT]))

    def alone(record: GroundMotion) -> PeerHistory:
        (found,) = demands(requests([record]), worth_lanes=ALONE)
        return PeerHistory(found.max_rotation, found.impacts)

    if heyoka:
        peer = HeyokaRocking(building, STEP)
        yield run("heyoka, tol 1e-4", lambda r: peer.history(r.acceleration), records)
    yield run("rps, one with all samples", sampled, records)
    yield run("rps, one", alone, records)
    often = requests([*records] * TIMES)
    spent = []
    for _ in range(4):
        start = time.perf_counter()
        found = demands(often, worth_lanes=1)[: len(records)]
        spent.append(time.perf_counter() - start)
    rotations, impacts = [d.max_rotation for d in found], [d.impacts for d in found]
    each = [min(spent) / len(often)] * len(records)
    yield Contest(f"rps, {len(often)} in {LANES} lanes", each, rotations, impacts)


def rows(storeys: int, records: Sequence[GroundMotion], *, heyoka: bool) -> Iterator[list[str]]:
    """All lines for one building."""
    building = structure(storeys)
    settings = TimeHistorySettings(free_vibration=0.0, accuracy=TIGHT)
    limit = settings.overturning_limit * building.critical_rotation
    tight = demands([Request(building, MotionComponents(r), settings) for r in records])
    exact = [d.max_rotation for d in tight]
    found = [*contests(building, records, heyoka=heyoka)]
    one, lanes = (float(np.sum(c.times)) for c in found[-2:])
    for c in found:
        spent = float(np.sum(c.times))
        numbers = (f"{z:.3g}" for z in (spent / one, spent / lanes, 1e3 * float(np.mean(c.times))))
        impacts = f"{np.mean(c.impacts):.0f}"
        yield [str(storeys), c.name, *numbers, c.close(exact, limit), impacts]


def main() -> None:
    """Measure, and print one table that Markdown understands."""
    heyoka = installed("heyoka")
    sources = (f"synthetic:?pga=0.5g&duration=40&dt={STEP}&seed={i}" for i in range(1, RECORDS + 1))
    records = [load_record(source) for source in sources]
    title = "One history of 40 s at 200 Hz on one core; ratios: times that rps is faster"
    table = Table(*COLUMNS, title=title, title_justify="left", box=box.MARKDOWN)
    for storeys in (3, 9):
        for row in rows(storeys, records, heyoka=heyoka):
            table.add_row(*row)
    _CONSOLE.print(table)


if __name__ == "__main__":
    main()
