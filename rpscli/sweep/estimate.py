"""How long a study will take, from a few of its points."""

from __future__ import annotations

import time
from typing import NamedTuple

from rpscli.sweep.batch import Bench, run_batch
from rpscli.sweep.design import Design
from rpscli.sweep.schedule import batches

PROBES = 96
LONGEST_PROBING = 3.0
"""Time after which no further batch is tried [s]."""


class Estimate(NamedTuple):
    """Mean time of a point on one core [s], and of the whole study on several."""

    point_seconds: float
    seconds: float


def estimate(design: Design, bench: Bench, jobs: int) -> Estimate:
    """Compute points spread over the study, in batches, and take the rest to be like them."""
    count = len(design)
    tried = min(PROBES, count)
    numbers = sorted({count * (2 * i + 1) // (2 * tried) for i in range(tried)})
    probes = list(batches(design, numbers, jobs=1))
    for batch in probes:
        run_batch(bench, batch[:1])  # reads records, loads kernels
    began, points = time.perf_counter(), 0
    for batch in probes:
        run_batch(bench, batch)
        points += len(batch)
        if time.perf_counter() - began > LONGEST_PROBING:
            break
    mean = (time.perf_counter() - began) / points
    return Estimate(mean, mean * count / min(jobs, count))
