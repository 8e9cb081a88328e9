"""One history of 40 s at 200 Hz: what others would run, and we.

Run from the root of the repository: ``PYTHONPATH=tests python -m benchmarks.histories``. All is
measured in one run on one core, so that the ratios mean something; accuracy stands beside speed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from benchmarks.agreement import agreeing, share
from benchmarks.contestants import Contest, run, taylor, taylor_lanes
from benchmarks.measure import seconds
from benchmarks.peers.heyoka_history import HeyokaRocking
from benchmarks.peers.installed import installed
from benchmarks.peers.opensees_building import OpenSeesBuilding
from benchmarks.peers.rocking import PeerHistory, rocking_of
from benchmarks.peers.scipy_history import ScipyRocking, compiled_rates, python_rates
from benchmarks.structures import STEP, motions, structure
from benchmarks.tables import figure, say, show
from rpscli.analyses.demand import Request, demands, histories
from rpscli.analyses.fixed_base import fixed_base_response
from rpscli.analyses.kernels.history import sampled_history
from rpscli.analyses.largest_demands import Demand
from rpscli.analyses.result_quantities import HISTORY
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.model.podium import PodiumStructure
from rpscli.physics.state import IMPACT, LANES
from rpscli.records.ground_motion import GroundMotion, MotionComponents

RECORDS = 64
TIMES = 10
"""Each record is followed so often in lanes: of few histories, lanes are idle near the end."""
FEW = 8
"""Records for scipy, which takes seconds each."""
ALONE = 1_000_000_000
"""Histories from which on lanes would be worth while: never."""
SETTINGS = TimeHistorySettings(free_vibration=0.0)
TIGHT = TimeHistorySettings(free_vibration=0.0, accuracy=8.0)
COLUMNS = (
    "storeys",
    "program",
    "over rps, one",
    "over rps, lanes",
    "ms/history",
    "max theta to 1e-4",
    "impacts",
)


def many(
    building: PodiumStructure, records: Sequence[GroundMotion], settings: TimeHistorySettings
) -> list[Demand]:
    """All records in lanes of one core."""
    return demands(
        [Request(building, MotionComponents(r), settings) for r in records], worth_lanes=1
    )


def rps_alone(building: PodiumStructure, record: GroundMotion) -> PeerHistory:
    """One history by itself, without its samples."""
    found = demands([Request(building, MotionComponents(record), SETTINGS)], worth_lanes=ALONE)[0]
    return PeerHistory(found.max_rotation, found.impacts)


def rps_sampled(building: PodiumStructure, record: GroundMotion) -> PeerHistory:
    """One history with all of its samples and its log of events."""
    history = sampled_history(building, MotionComponents(record), SETTINGS).history
    return PeerHistory(float(history.max_theta), int(history.events[IMPACT]))


def rps_lanes(building: PodiumStructure, records: Sequence[GroundMotion]) -> Contest:
    """Side by side: only the time of all is known."""
    found, often = many(building, records, SETTINGS), [*records] * TIMES
    spent = seconds(lambda: many(building, often, SETTINGS), repeats=3) / len(often)
    return Contest(
        f"rps, {len(often)} in {LANES} lanes",
        [spent] * len(records),
        [d.max_rotation for d in found],
        [d.impacts for d in found],
    )


def rps_study(
    building: PodiumStructure, records: Sequence[GroundMotion], lanes: Contest
) -> Contest:
    """The same with every result of every history as a column, which is what studies keep."""
    often = [Request(building, MotionComponents(r), SETTINGS) for r in [*records] * TIMES]

    def columns() -> None:
        for _, together in histories(often):
            together.columns(HISTORY)

    spent = seconds(columns, repeats=3) / len(often)
    return replace(lanes, name=f"{lanes.name}, results as in studies", times=[spent] * len(records))


def peers(
    building: PodiumStructure, records: Sequence[GroundMotion], *, heyoka: bool
) -> list[Contest]:
    """Those that can follow the whole history."""
    podium = rocking_of(building)
    contests = []
    for name, rates, repeats in (
        ("scipy RK45", python_rates, 1),
        ("scipy RK45, compiled rates", compiled_rates, 1),
    ):
        scipy = ScipyRocking(podium, STEP, rates(podium))
        contests.append(
            run(name, lambda r, s=scipy: s.history(r.acceleration), records[:FEW], repeats)  # type: ignore[misc]
        )
    if heyoka:
        contests += [*taylor(podium, records), *taylor_lanes(podium, records)]
    return contests


def linear_row(
    building: PodiumStructure, records: Sequence[GroundMotion], alone: Contest, lanes: float
) -> list[str]:
    """OpenSees, whose building stands on a fixed base and is not to be compared in accuracy."""
    opensees = OpenSeesBuilding(rocking_of(building))
    times = [
        seconds(lambda r=r: opensees.base_shear(r.acceleration, r.dt, look=False))  # type: ignore[misc]
        for r in records[:FEW]
    ]
    record = records[0]
    shear = opensees.base_shear(record.acceleration, record.dt, look=True)
    exact = fixed_base_response(building, MotionComponents(record), record.npts - 1).base_shear
    linear = Contest("OpenSees, linear, no bearings", times)
    faster = linear.times_faster(alone)
    accuracy = f"(shear {shear / exact - 1.0:+.1e})"
    return row(building, linear, faster, faster * lanes, accuracy, "")


def row(
    building: PodiumStructure, c: Contest, alone: float, lanes: float, close: str, impacts: str
) -> list[str]:
    """One line of the table."""
    numbers = map(figure, (alone, lanes, c.milliseconds))
    return [str(building.storeys), c.name, *numbers, close, impacts]


def rows(
    storeys: int, records: Sequence[GroundMotion], *, heyoka: bool, opensees: bool
) -> list[list[str]]:
    """All lines for one building."""
    building = structure(storeys)
    limit = TIGHT.overturning_limit * building.critical_rotation
    exact = [d.max_rotation for d in many(building, records, TIGHT)]
    alone = run("rps, one", lambda r: rps_alone(building, r), records)
    sampled = run("rps, one with all samples", lambda r: rps_sampled(building, r), records)
    lanes = rps_lanes(building, records)
    gain = float(np.sum(alone.times) / np.sum(lanes.times))
    ours = (sampled, alone, lanes, rps_study(building, records, lanes))
    lines = []
    for c in (*peers(building, records, heyoka=heyoka), *ours):
        faster = c.times_faster(alone)
        close = share(*agreeing(c.rotations, exact, limit))
        lines.append(row(building, c, faster, faster * gain, close, f"{np.mean(c.impacts):.0f}"))
    if opensees:
        lines.insert(-len(ours), linear_row(building, records, alone, gain))
    if heyoka:
        tight = HeyokaRocking(rocking_of(building), STEP, tol=1e-12)
        other = [tight.history(r.acceleration).max_rotation for r in records]
        agrees = share(*agreeing(other, exact, limit))
        say(f"{storeys} storeys: heyoka at tol 1e-12 agrees with the reference in {agrees}")
    return lines


def main() -> None:
    """Measure, and print one table."""
    heyoka, opensees = installed("heyoka"), installed("openseespy.opensees")
    records = motions(RECORDS)
    lines = [line for n in (3, 9) for line in rows(n, records, heyoka=heyoka, opensees=opensees)]
    show(
        "One history of 40 s at 200 Hz on one core; ratios: times that rps is faster",
        COLUMNS,
        lines,
    )


if __name__ == "__main__":
    main()
