"""Run as a program: short histories, one after the other and side by side, as JSON."""

from __future__ import annotations

import json
import sys
from dataclasses import replace
from typing import Any

import numpy as np
from paper_structures import FLAT, podium, waves

from rpscli.analyses.kernels.history import Request, run_of
from rpscli.analyses.kernels.systems import stacked_systems
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.model.devices import (
    FrictionDamper,
    RollingResistance,
    Stop,
    Tendon,
    ViscousDamper,
)
from rpscli.model.impact import ImpactLaw
from rpscli.physics.follow import integrate
from rpscli.physics.run import Run
from rpscli.records.ground_motion import MotionComponents

STOREYS = 2
DT = 0.02
ONE, TWO = waves(0.7, DT, 4.0, seed=5), waves(0.7, DT, 3.0, seed=8)
MOTIONS = [
    MotionComponents(ONE),
    MotionComponents(TWO),
    MotionComponents(ONE, TWO),
    MotionComponents(TWO, ONE),
]
SETTINGS = TimeHistorySettings(free_vibration=0.3, recontact_tolerance=1e-3)
STRUCTURES = [
    podium(STOREYS, 0.10, 0.5, R=0.4),
    podium(STOREYS, 0.15, FLAT, R=0.4, law=ImpactLaw("flexible")),
    replace(
        podium(STOREYS, 0.10, 0.5, R=0.4),
        devices=(
            FrictionDamper(6e5),
            Tendon(1e4, 2e6, 2e4),
            ViscousDamper(5e4, 0.5),
            Stop(0.02, 1e7, 1e5),
            RollingResistance(1e-4),
        ),
        columns=4,
    ),
]
REQUESTS = [
    Request(2, 0),
    Request(0, 0),
    Request(0, 2),
    Request(1, 0, scale=0.25),
    Request(0, 1, scale=0.35),
    Request(1, 3, scale=0.3),
    Request(1, 1, scale=0.01),
]
ROWS = 256
FEW = 3


def integrated(requests: list[Request], lanes: int, rows: int = 0) -> Run:
    """Follow histories."""
    systems = stacked_systems([(structure, SETTINGS) for structure in STRUCTURES])
    run = run_of(systems, MOTIONS, requests, rows=rows, events=rows)
    # lanes without a history make empty steps, of zeros
    with np.errstate(all="ignore"):
        integrate(run, lanes)
    return run


def demands_of_all(lanes: int) -> list[dict[str, Any]]:
    """What every history leaves behind."""
    return [
        {name: np.ravel(result[name]).tolist() for name in result.dtype.names}
        for result in integrated(REQUESTS, lanes).results
    ]


def sampled_history() -> dict[str, Any]:
    """The first one, with devices, with its samples and events."""
    run = integrated(REQUESTS[:1], lanes=1, rows=ROWS)
    kept = int(run.results.intervals[0]) + 1
    samples, log = run.output.samples[:kept], run.output.log[: int(run.results.events[0].sum())]
    found = {f"sampled {name}": samples[name].tolist() for name in samples.dtype.names}
    found |= {f"event {name}": log[name].tolist() for name in log.dtype.names}
    count = len(STRUCTURES[-1].devices)
    found |= {"devices": run.output.devices[:kept, :, :count].ravel().tolist()}
    return found | {"floors": run.output.floors[:kept].ravel().tolist()}


def everything(lanes: int) -> dict[str, list[dict[str, Any]]]:
    """The same histories one after the other and side by side, and the sampled one."""
    one, several = demands_of_all(1), demands_of_all(lanes)
    return {"one": one, "several": several, "sampled": [sampled_history()]}


if __name__ == "__main__":
    # Python takes its time for each lane: with few of them, they take several histories each.
    json.dump(everything(FEW), sys.stdout)
