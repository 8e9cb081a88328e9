"""The engines that compute batches: threads of this process, or the workers of a Dask cluster.

Threads share records and systems. The kernels let go of the interpreter while they compute, so
threads use all cores without a copy of a record, and start at once. Workers get the plan and the
points, and read records themselves; all of them must see the files of the study under the same
names, and run the same version of rps.
"""

from __future__ import annotations

import hashlib
import pickle
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Lock, Thread
from typing import Any

from rpscli.errors import RpsError, UsageError
from rpscli.sweep.evaluation.batch import run_batch
from rpscli.sweep.evaluation.context import StudyContext
from rpscli.sweep.evaluation.points import Plan, Point, solver_version
from rpscli.sweep.evaluation.results import PointResults, failures
from rpscli.sweep.run.schedule import Computed

HEARING = 0.2
"""Seconds after which who waits for a batch looks up.

A Ctrl-C that comes between the last look and the beginning of the wait, or that is given to another
thread, wakes nobody; on Windows none does.
"""

WAITING = 2
"""Batches that are kept ready for each thread of the cluster."""

PATIENCE = 10.0
"""Time to wait for a scheduler, and for its first worker [s]."""


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


_contexts: dict[str, StudyContext] = {}
_lock = Lock()


def compute(digest: str, plan: Plan, points: list[Point]) -> PointResults:
    """Results of a batch; runs on a worker, which keeps what it has read for the next one."""
    if plan.solver != solver_version():
        raise RpsError(
            f"a worker runs rps {solver_version()}, but the study was laid out by {plan.solver};"
            " install the same version on all machines"
        )
    with _lock:
        if digest not in _contexts:
            _contexts.clear()
            _contexts[digest] = StudyContext(plan)
        context = _contexts[digest]
    return run_batch(context, points)


class Cluster:
    """Computes batches on a Dask cluster, whose scheduler has an address as tcp://head:8786."""

    def __init__(self, address: str, plan: Plan) -> None:
        try:
            import distributed  # an optional extra
        except ModuleNotFoundError:
            raise UsageError('--scheduler needs Dask; run: pip install "rpscli[cluster]"') from None
        self._dask: Any = distributed
        self._plan = replace(plan, base_folder=str(Path(plan.base_folder).absolute()))
        self._digest = hashlib.sha256(pickle.dumps(self._plan)).hexdigest()
        try:
            self._client = self._dask.Client(address, timeout=PATIENCE, set_as_default=False)
            self._client.wait_for_workers(1, timeout=PATIENCE)
        except (OSError, ValueError) as error:  # a TimeoutError is an OSError
            raise UsageError(
                f"--scheduler {address}: no Dask scheduler with a worker answers there ({error})"
            ) from None
        self.jobs = max(1, sum(self._client.nthreads().values()))

    def outcomes(self, batches: Iterable[list[Point]]) -> Iterator[Computed]:
        """The batches with their results, as they come."""
        # A batch whose worker dies is computed by another; points that take every worker come as
        # failed.
        source = iter(batches)
        given: dict[Any, list[Point]] = {}
        finished = self._dask.as_completed(
            loop=self._client.loop, with_results=True, raise_errors=False
        )
        try:
            while True:
                self._hand_out(source, given, finished)
                if not given:
                    return
                future, result = next(finished)
                yield from self._computed(future, result, given, finished)
        finally:
            self._client.close()

    def _hand_out(
        self, source: Iterator[list[Point]], given: dict[Any, list[Point]], finished: Any
    ) -> None:
        while len(given) < WAITING * self.jobs:
            points = next(source, None)
            if points is None:
                return
            self._submit(points, given, finished)

    def _submit(self, points: list[Point], given: dict[Any, list[Point]], finished: Any) -> None:
        placed = [_placed(point) for point in points]
        future = self._client.submit(
            compute, self._digest, self._plan, placed, pure=False, retries=2
        )
        given[future] = points
        finished.add(future)

    def _computed(
        self, future: Any, result: Any, given: dict[Any, list[Point]], finished: Any
    ) -> list[Computed]:
        """A finished batch; points of a deadly one are tried one by one."""
        points = given.pop(future)
        if future.status == "finished":
            return [(points, result)]
        error = result[1] if isinstance(result, tuple) else result
        if isinstance(error, self._dask.KilledWorker):
            if len(points) == 1:
                message = "the workers that computed this point died, one after the other"
                return [(points, failures([message]))]
            for point in points:
                self._submit([point], given, finished)
            return []
        if isinstance(error, RpsError):
            raise error
        raise RpsError(
            f"the cluster gave up ({type(error).__name__}: {error}); what was stored is safe, the"
            " same command continues"
        )


def _placed(point: Point) -> Point:
    """The point with its record's folder as every machine sees it."""
    if point.record is None:
        return point
    folder = str(Path(point.record.folder).absolute())
    return point._replace(record=point.record._replace(folder=folder))
