"""An estimate of the time that a study takes, by trying some of its points."""

from __future__ import annotations

import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from itertools import cycle, islice
from typing import Any

import numpy as np

from rpscli.analyses.demand import WORTH_LANES, DemandRequest, demands
from rpscli.analyses.kernels.systems import most_seconds
from rpscli.physics.state import LANES
from rpscli.sweep.evaluation import Point, StudyContext, run_batch
from rpscli.sweep.points import StudyPoints
from rpscli.sweep.run import batches

PROBES = 96
LONGEST_PROBING = 3.0
"""Time after which no further points are tried [s]."""


def estimated_seconds(layout: StudyPoints, jobs: int) -> tuple[float, str]:
    """Compute points spread over the study, in batches, and take
    the rest to be like them.

    Returns the time [s], and how it was found: of what may take too long
    only parts are tried.
    """
    context = layout.context
    count = len(layout)
    spent = 0.0
    points = 0
    tried = "trying some of the points"
    few = 1 if layout.plan.whole else WORTH_LANES  # by the kernel that computes the study
    numbers = sorted({count * (2 * i + 1) // (2 * PROBES) for i in range(PROBES)})
    for batch in batches(layout, numbers, jobs=1):
        probe = batch
        if len(batch) * count >= few * len(numbers):  # as many as in lanes in the study
            probe = list(islice(cycle(batch), max(few, len(batch))))
        most = [_most_seconds(layout, point) for point in batch]
        if (longest := max(most)) > 2.0 * LONGEST_PROBING:
            some = probe[: 1 if layout.plan.whole else LANES]
            each = _seconds_of_parts(layout, some, LONGEST_PROBING / longest)
            if each is None:  # not to be tried
                source = "the most steps that some points may take"
                return float(np.mean(most)) * count / min(jobs, count), source
            return each * count / min(jobs, count), "trying parts of some histories"
        first = probe[:few]
        alone = _seconds(context, first) / len(first)  # reads records, loads kernels
        if alone > 2.0 * LONGEST_PROBING:  # of which loading is little
            return alone * count / min(jobs, count), tried
        more = few * (1 + int(LONGEST_PROBING / _seconds(context, first)))
        affordable = probe[: max(more, few)]
        spent = spent + _seconds(context, affordable)
        points = points + len(affordable)
        if spent > LONGEST_PROBING:
            break
    return spent / points * count / min(jobs, count), tried


LEAST_PART = 50
"""Samples of a part of a record."""


def _seconds_of_parts(
    layout: StudyPoints, points: Sequence[Point], share: float
) -> float | None:
    """Time of one history [s], as if it went on as in a share of its record about the
    peak, with its free vibration as long as what is quiet in the record; None if none of
    the points has a history, or if a part has too few samples to tell.
    """
    requests = []
    for point in points:
        with suppress(Exception):  # which the point tells when it is computed
            requests.append(_part(layout.context.history(point), share))
    if not requests or min(of.motion.npts for of in requests) < LEAST_PART:
        return None
    if any(of.structure.twist for of in requests):
        return None
    demands(requests[:WORTH_LANES])  # loads the kernel
    began = time.thread_time()
    demands(requests)
    return (time.thread_time() - began) / len(requests) / share


def _part(request: DemandRequest, share: float) -> DemandRequest:
    """A history of a share of the record about its peak, at rest before."""
    motion = request.motion
    samples = max(int(share * motion.npts), 2)
    peak = int(np.argmax(np.abs(motion.horizontal.acceleration)))
    first = min(max(peak - samples // 2, 0), motion.npts - samples)
    cut: dict[str, Any] = {}
    for name, each in motion.named.items():
        inside = each.acceleration[first : first + samples]  # some are shorter
        padded = np.pad(inside, (0, samples - len(inside)))
        cut[name] = replace(each, acceleration=padded)
    settings = replace(request.settings, free_vibration=0.0)
    return replace(request, motion=replace(motion, **cut), settings=settings)


def _most_seconds(layout: StudyPoints, point: Point) -> float:
    """About the longest that the history of a point may take [s]."""
    if layout.plan.analysis == "timehistory":
        with suppress(Exception):  # which the point tells when it is tried
            request = layout.context.history(point)
            return most_seconds(request.structure, request.settings, request.motion)
    return 0.0


def _seconds(context: StudyContext, points: Sequence[Point]) -> float:
    began = time.thread_time()  # whatever else runs on the machine
    run_batch(context, points)
    return time.thread_time() - began
