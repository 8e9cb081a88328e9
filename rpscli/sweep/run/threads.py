"""The engine of one machine: threads that share records and systems.

The kernels let go of the interpreter while they compute, so threads use all cores without a copy
of a record, and start at once.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import suppress
from queue import Empty, SimpleQueue
from threading import Lock, Thread

from rpscli.sweep.evaluation.batch import run_batch
from rpscli.sweep.evaluation.context import StudyContext
from rpscli.sweep.evaluation.points import Point
from rpscli.sweep.run.schedule import Computed

HEARING = 0.2
"""Seconds after which who waits for a batch looks up.

A Ctrl-C that comes between the last look and the beginning of the wait, or that is given to another
thread, wakes nobody; on Windows none does.
"""


class Threads:
    """Computes batches in threads of this process.

    Each thread takes its next batch when it is done with the last one, so that nothing is under
    way but what is being computed. The threads are daemons: after a second Ctrl-C the process
    need not wait for them.
    """

    def __init__(self, context: StudyContext, jobs: int) -> None:
        self._context = context
        self.jobs = jobs
        self._done: SimpleQueue[Computed | BaseException | None] = SimpleQueue()
        self._taking = Lock()

    def outcomes(self, batches: Iterable[list[Point]]) -> Iterator[Computed]:
        """The batches with their results, as they come."""
        source = iter(batches)
        for _ in range(self.jobs):
            Thread(target=self._compute, args=(source,), daemon=True).start()
        computing = self.jobs
        while computing:
            item = self._said()
            if item is None:
                computing -= 1
            elif isinstance(item, BaseException):
                raise item
            else:
                yield item

    def _said(self) -> Computed | BaseException | None:
        """What a thread says next: a batch, what ended it before its time, or that it is done."""
        while True:
            with suppress(Empty):
                return self._done.get(timeout=HEARING)

    def _compute(self, source: Iterator[list[Point]]) -> None:
        try:
            while (batch := self._next(source)) is not None:
                self._done.put((batch, run_batch(self._context, batch)))
        except BaseException as error:  # noqa: BLE001 -- raised again where it can be told
            self._done.put(error)
        else:
            self._done.put(None)

    def _next(self, source: Iterator[list[Point]]) -> list[Point] | None:
        with self._taking:
            return next(source, None)
