"""How long a study will take, from a few of its points."""

from __future__ import annotations

import time
from typing import NamedTuple

from rpscli.sweep.batch import Bench, run_batch
from rpscli.sweep.design import Design

PROBES = 5
LONGEST_PROBING = 3.0
"""Time after which no further point is tried [s]."""


class Estimate(NamedTuple):
    """Mean time of a point on one core [s], and of the whole study on several."""

    point_seconds: float
    seconds: float


def estimate(design: Design, bench: Bench, jobs: int) -> Estimate:
    """Compute points spread over the study, and take the rest to be like them."""
    count = len(design)
    numbers = sorted({count * (2 * i + 1) // (2 * PROBES) for i in range(PROBES)})
    run_batch(bench, [design[numbers[0]]])  # reads the record, loads the kernels
    began, tried = time.perf_counter(), 0
    for number in numbers:
        run_batch(bench, [design[number]])
        tried += 1
        if time.perf_counter() - began > LONGEST_PROBING:
            break
    mean = (time.perf_counter() - began) / tried
    return Estimate(mean, mean * count / min(jobs, count))
