"""`rps ...` that hears a Ctrl-C at a count of points: python interrupted.py sweep ...

Three batches are begun, and it comes while the third one is computed. Threads wait until the points
of earlier batches are stored.
"""

import os
import signal
import time
from itertools import count

from rpscli.cli import program
from rpscli.sweep import run
from rpscli.sweep.evaluation import run_batch
from rpscli.sweep.store import Store

LAST = 3
"""Number of the batch at which the signal comes."""

begun = count(1)
stored = []
store_points = Store.add


def compute(context, points):
    """A batch, when all earlier ones are stored."""
    number = next(begun)
    while len(stored) < number - 1:
        time.sleep(0.001)
    if number == LAST:
        os.kill(os.getpid(), signal.SIGINT)
        while (
            signal.getsignal(signal.SIGINT) is not signal.default_int_handler
        ):  # the first is heard
            time.sleep(0.001)
    return run_batch(context, points)


def add(store, keys, results):
    """Store a batch."""
    store_points(store, keys, results)
    stored.append(1)


if __name__ == "__main__":
    # Shells have what runs in the background ignore SIGINT, and its children inherit that.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    run.run_batch = compute
    Store.add = add
    program()
