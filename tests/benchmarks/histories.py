"""Milliseconds of one history: the tests' scipy integrator, one lane, and eight lanes of a core.

Run from the root of the repository: ``PYTHONPATH=tests python -m benchmarks.histories``. All is
measured in one run on one core, so that the ratios mean something; accuracy stands beside speed.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from oracles.reference_systems import podium
from oracles.second_integrator import simulate
from rich.console import Console
from rich.table import Table

from rpscli.analyses.demand import Request, demands
from rpscli.analyses.history import sampled_history
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.model.bearing import Bearing
from rpscli.model.damping import RayleighDamping
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import Superstructure, profile_stiffnesses
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.source import load_record

RECORDS = 64
SETTINGS = TimeHistorySettings(free_vibration=0.0)


def structure(storeys: int) -> PodiumStructure:
    """The paper's building on bearings of zero stiffness."""
    masses = np.full(storeys, 2e5)
    stiffnesses = profile_stiffnesses(masses, storeys / 10, "sine")
    building = Superstructure(masses, stiffnesses, RayleighDamping(0.05, (1, 2)))
    return PodiumStructure(Bearing(1.5, 0.15, 0.30, 0.5), 2e4, 2e5, building)


def motions() -> list[GroundMotion]:
    """Synthetic records of 40 s at 200 Hz, about a hundred impacts each."""
    source = "synthetic:?pga=0.5g&duration=40&dt=0.005&seed={}"
    return [load_record(source.format(seed)) for seed in range(1, RECORDS + 1)]


def seconds(work: Callable[[], object], repeats: int = 3) -> float:
    """Least time of some repeats [s]; the first call, which may compile, does not count."""
    work()
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return min(times)


def main() -> None:
    """Measure, and print one table."""
    records = motions()
    table = Table("storeys", "program", "ms/history", "ratio", "max|theta| below 1e-4")
    for storeys in (3, 9):
        building = structure(storeys)
        requests = [Request(building, record, SETTINGS) for record in records]
        tight = TimeHistorySettings(free_vibration=0.0, accuracy=8.0)
        exact = [d.max_rotation for d in demands([Request(building, r, tight) for r in records])]

        def one(building: PodiumStructure = building) -> None:
            for record in records[:8]:
                sampled_history(building, record, None, SETTINGS)

        def lanes(requests: list[Request] = requests) -> None:
            demands(requests, worth_lanes=1)

        found = [d.max_rotation for d in demands(requests, worth_lanes=1)]
        close = np.mean([abs(a / b - 1.0) < 1e-4 for a, b in zip(found, exact, strict=True)])
        system = podium(storeys, 0.15, 0.5)
        start = time.perf_counter()
        simulate(system, records[0].acceleration, 0.005, free_vibration=0.0, rtol=1e-6)
        scipy_time = time.perf_counter() - start
        single, many = seconds(one) / 8, seconds(lanes) / len(records)
        rows = (
            ("scipy DOP853, Python", scipy_time, ""),
            ("rps, one history with samples", single, f"{close:.0%}"),
            (f"rps, 8 lanes, {RECORDS} histories", many, f"{close:.0%}"),
        )
        for name, spent, share in rows:
            ratio = f"{scipy_time / spent:.0f}"
            table.add_row(str(storeys), name, f"{1e3 * spent:.2f}", ratio, share)
    Console().print(table)


if __name__ == "__main__":
    main()
