"""How long a study will take, from a few of its points."""

from __future__ import annotations

import time

from rpscli.sweep.design.layout import Design
from rpscli.sweep.evaluation.batch import run_batch
from rpscli.sweep.evaluation.context import StudyContext
from rpscli.sweep.run.schedule import batches

PROBES = 96
LONGEST_PROBING = 3.0
"""Time after which no further batch is tried [s]."""


def estimated_seconds(design: Design, context: StudyContext, jobs: int) -> float:
    """Compute points spread over the study, in batches, and take the rest to be like them."""
    count = len(design)
    tried = min(PROBES, count)
    numbers = sorted({count * (2 * i + 1) // (2 * tried) for i in range(tried)})
    probes = list(batches(design, numbers, jobs=1))
    for batch in probes:
        run_batch(context, batch[:1])  # reads records, loads kernels
    began, points = time.perf_counter(), 0
    for batch in probes:
        run_batch(context, batch)
        points += len(batch)
        if time.perf_counter() - began > LONGEST_PROBING:
            break
    mean = (time.perf_counter() - began) / points
    return mean * count / min(jobs, count)
