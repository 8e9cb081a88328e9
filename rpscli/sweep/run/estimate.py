"""How long a study will take, from a few of its points."""

from __future__ import annotations

import time
from collections.abc import Sequence

from rpscli.sweep.evaluation.batch import run_batch
from rpscli.sweep.evaluation.context import StudyContext
from rpscli.sweep.evaluation.points import Point
from rpscli.sweep.points.layout import StudyPoints
from rpscli.sweep.run.schedule import batches

PROBES = 96
LONGEST_PROBING = 3.0
"""Time after which no further points are tried [s]."""


def estimated_seconds(layout: StudyPoints, context: StudyContext, jobs: int) -> float:
    """Compute points spread over the study, in batches, and take the rest to be like them."""
    count = len(layout)
    tried = min(PROBES, count)
    numbers = sorted({count * (2 * i + 1) // (2 * tried) for i in range(tried)})
    probes = list(batches(layout, numbers, jobs=1))
    began = time.perf_counter()
    for batch in probes:
        _seconds(context, batch[:1])  # reads records, loads kernels
        if time.perf_counter() - began > LONGEST_PROBING:
            break
    affordable = 1 + int(LONGEST_PROBING / _seconds(context, probes[0][:1]))
    spent, points = 0.0, 0
    for batch in probes:
        spent += _seconds(context, batch[:affordable])
        points += len(batch[:affordable])
        if spent > LONGEST_PROBING:
            break
    mean = spent / points
    return mean * count / min(jobs, count)


def _seconds(context: StudyContext, points: Sequence[Point]) -> float:
    began = time.perf_counter()
    run_batch(context, points)
    return time.perf_counter() - began
