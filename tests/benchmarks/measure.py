"""Wall time: the least of some repeats, since nothing makes a run faster than it can be."""

from __future__ import annotations

import time
from collections.abc import Callable


def seconds(work: Callable[[], object], repeats: int = 3, *, warm: bool = True) -> float:
    """Least wall time of some repeats [s]; with `warm`, a first call, which may compile, is lost.

    Garbage collection stays on: it is part of what a user waits for.
    """
    if warm:
        work()
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return min(times)
