"""`rps ...` that is interrupted at a count of points: python interrupted.py SIGNAL sweep ...

Three batches are begun. SIGINT comes while the third one is computed, SIGKILL when its rows are
written and not yet committed. Threads wait until the points of earlier batches are stored.
"""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Sequence

from rpscli.cli import program
from rpscli.sweep import run
from rpscli.sweep.evaluation import Point, PointResults, StudyContext, run_batch
from rpscli.sweep.store import Store

LAST = 3
"""Number of the batch at which the signal comes."""

begun: list[int] = []
stored: list[int] = []
store_points = Store.add


def compute(context: StudyContext, points: Sequence[Point]) -> PointResults:
    """A batch, when all earlier ones are stored."""
    begun.append(len(points))
    while len(stored) < len(begun) - 1:
        time.sleep(0.001)
    if len(begun) == LAST and NUMBER == signal.SIGINT:
        os.kill(os.getpid(), NUMBER)
        while signal.getsignal(NUMBER) is not signal.default_int_handler:  # the first is heard
            time.sleep(0.001)
    return run_batch(context, points)


def add(store: Store, keys: Sequence[bytes], results: PointResults) -> None:
    """Store a batch."""
    if len(stored) == LAST - 1 and NUMBER == signal.SIGKILL:
        store._db.set_trace_callback(die_before_commit)
    store_points(store, keys, results)
    stored.append(1)


def die_before_commit(statement: str) -> None:
    """The rows are in the file or in its journal, and count for nothing."""
    if statement == "COMMIT":
        os.kill(os.getpid(), NUMBER)


if __name__ == "__main__":
    NUMBER = signal.Signals[sys.argv.pop(1)]
    # Shells have what runs in the background ignore SIGINT, and its children inherit that.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    run.run_batch = compute  # type: ignore[attr-defined]
    Store.add = add  # type: ignore[method-assign, assignment]
    program()
