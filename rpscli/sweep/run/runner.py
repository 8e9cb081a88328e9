"""Running a study: batches to an engine, their rows to the one writer, progress to the caller."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import takewhile
from types import FrameType

from rpscli.sweep.points.layout import StudyPoints
from rpscli.sweep.run.resume import Resume
from rpscli.sweep.run.schedule import Engine, batches
from rpscli.sweep.store import Store


@dataclass(frozen=True)
class Progress:
    """How far a study is."""

    total: int
    kept: int
    computed: int
    failed: int
    """Points of the study, stored before, of this run, and those of it that failed."""
    seconds: float
    """Since the run began."""
    first: int = 0
    first_seconds: float = 0.0
    """Points that the first batch brought, and when: kernels may have been compiled before,
    which says nothing about the rate of the others."""

    @property
    def done(self) -> int:
        """Points in the store."""
        return self.kept + self.computed

    @property
    def rate(self) -> float:
        """Points a second after the first batch; 0 before there are any."""
        seconds = self.seconds - self.first_seconds
        return (self.computed - self.first) / seconds if seconds > 0.0 else 0.0

    @property
    def seconds_left(self) -> float | None:
        """Time to the end at this rate; None before the first point."""
        return (self.total - self.done) / self.rate if self.rate > 0.0 else None


@dataclass(frozen=True)
class Finish:
    """How a run ended."""

    computed: int
    failed: int
    seconds: float
    interrupted: bool


def run(
    layout: StudyPoints,
    start: Resume,
    store: Store,
    engine: Engine,
    report: Callable[[Progress], None] = lambda _: None,
    announce: Callable[[], None] = lambda: None,
) -> Finish:
    """Compute and store points; Ctrl-C lets those under way end, a second one stops at once."""
    began = time.monotonic()
    computed = failed = 0
    first: tuple[int, float] | None = None
    with first_interrupt(announce) as interrupted:
        work = batches(layout, start.pending, engine.jobs)
        wanted = takewhile(lambda _: not interrupted.is_set(), work)
        for points, results in engine.outcomes(wanted):
            store.add([start.keys[point.number] for point in points], results)
            computed += len(points)
            failed += results.failed()
            seconds = time.monotonic() - began
            total = start.kept + len(start.pending)
            first = first or (computed, seconds)
            report(Progress(total, start.kept, computed, failed, seconds, *first))
    seconds = time.monotonic() - began
    return Finish(computed, failed, seconds, computed < len(start.pending))


@contextmanager
def first_interrupt(announce: Callable[[], None]) -> Iterator[threading.Event]:
    """An event that the first Ctrl-C sets; the second one interrupts as usual."""
    event = threading.Event()
    if threading.current_thread() is not threading.main_thread():
        yield event
        return
    before = signal.getsignal(signal.SIGINT)

    def stop(_number: int, _frame: FrameType | None) -> None:
        event.set()
        signal.signal(signal.SIGINT, signal.default_int_handler)
        announce()

    signal.signal(signal.SIGINT, stop)
    try:
        yield event
    finally:
        signal.signal(signal.SIGINT, before)
