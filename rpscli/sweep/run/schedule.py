"""Batches of points that share sizes of building and records, who computes them, and how long.

The order of computation is not the order of the study. Points with one number of storeys stand
together, and among them those of one record, because the kernels run fastest on them; the tallest
buildings come first, so that the last batches, for which not all threads are needed, are short.
Systems come in blocks, so that all the systems of a block can be held in memory while the records
pass.
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby
from typing import Protocol

from rpscli.sweep.evaluation.batch import run_batch
from rpscli.sweep.evaluation.context import SYSTEMS_KEPT, StudyContext
from rpscli.sweep.evaluation.points import Point
from rpscli.sweep.evaluation.results import PointResults
from rpscli.sweep.points.layout import StudyPoints

LARGEST_BATCH = 480
"""Points; a batch takes about a second at most with common buildings, and keeps all lanes of the
kernel busy but at its end."""

SMALLEST_BATCH = 8

LARGEST_BLOCK = 100_000
"""Points that are put in order at a time."""


def batches(layout: StudyPoints, pending: Sequence[int], jobs: int) -> Iterator[list[Point]]:
    """Batches of the pending points, which are given in the order of the study."""
    # Small enough that all threads have something to do until the end.
    size = min(LARGEST_BATCH, max(SMALLEST_BATCH, len(pending) // (4 * jobs)))
    for block in _blocks(layout, pending):
        for _, alike in groupby(block, key=lambda number: _storeys(layout, number)):
            numbers = list(alike)
            for first in range(0, len(numbers), size):
                yield [layout[number] for number in numbers[first : first + size]]


def _blocks(layout: StudyPoints, pending: Sequence[int]) -> Iterator[list[int]]:
    """Pending points of some systems each, sorted by number of storeys and record."""
    of_system = layout.points_of_system
    systems = max(1, min(SYSTEMS_KEPT // 2, LARGEST_BLOCK // of_system))

    def order(number: int) -> tuple[int, int, int]:
        return -_storeys(layout, number), _record(layout, number), number

    for _, block in groupby(pending, key=lambda number: number // (of_system * systems)):
        yield sorted(block, key=order)


def _storeys(layout: StudyPoints, number: int) -> int:
    return layout.properties[number // layout.points_of_system].storeys


def _record(layout: StudyPoints, number: int) -> int:
    of_system = layout.points_of_system
    return number % of_system // (of_system // len(layout.records))


Computed = tuple[list[Point], PointResults]
"""A batch of points with its results."""


class Engine(Protocol):
    """Computes batches somewhere, several at a time."""

    @property
    def jobs(self) -> int:
        """How many batches are computed at a time."""

    def outcomes(self, batches: Iterable[list[Point]]) -> Iterator[Computed]:
        """The batches with their results, each once, as they come; taken when a worker is free."""


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
        alone = _seconds(context, batch[:1])  # reads records, loads kernels
        if alone > 2.0 * LONGEST_PROBING:  # of which loading is little
            return alone * count / min(jobs, count)
        if time.perf_counter() - began > LONGEST_PROBING:
            break
    alone = _seconds(context, probes[0][:1])
    affordable = 1 + int(LONGEST_PROBING / alone)
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
