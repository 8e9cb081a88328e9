"""Running a study: what is stored already, batches to an engine,
their rows to the one writer.

The order of computation is not the order of the study. Points with one number of
storeys stand together, and among them those of one record, because the kernels run
fastest on them; the tallest buildings come first, so that the last batches, for which
not all threads are needed, are short. Systems come in blocks, which can be held in
memory while the records pass.
"""

from __future__ import annotations

import ctypes
import hashlib
import json
import pickle
import signal
import struct
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, CancelledError, Executor, Future, wait
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, replace
from itertools import islice, takewhile
from pathlib import Path
from types import FrameType
from typing import Any

import numpy as np

from rpscli.case.text.document import shown
from rpscli.errors import Refused, RpsError, UsageError
from rpscli.sweep.evaluation import (
    FAILED,
    Plan,
    Point,
    PointResults,
    StudyContext,
    run_batch,
    solver_version,
)
from rpscli.sweep.points import StudyPoints
from rpscli.sweep.store import Store


def all_keys(layout: StudyPoints) -> list[bytes]:
    """Digests of resolved case, record content, scale, perturbation
    and solver of all points.
    """
    plan = layout.plan
    keys = list[bytes]()
    of_system = layout.points_of_system
    tails = [b""]
    before = None
    for system, properties in enumerate(layout.properties):
        begun = hashlib.sha256(
            plan.solver.encode() + plan.analysis.encode() + properties.digest
        )
        own = properties.record, properties.scale, layout.period_of_measure(properties)
        if plan.analysis == "timehistory" and own != before:
            tails = []
            before = own
            for number in range(system * of_system, (system + 1) * of_system):
                point = layout[number]
                assert point.record is not None, "points of histories have a record"
                factor = layout.known_factor(point)
                change = struct.pack("<2d?", factor, point.restitution_change, plan.whole)
                tails.append(layout.context.records.digest(point.record) + change)
        for tail in tails:
            digest = begun.copy()
            digest.update(tail)
            keys.append(digest.digest())
    return keys


@dataclass(frozen=True, eq=False)
class Start:
    """State of a study at the beginning of a run.

    `keys` are those of all points, `pending` the points to be computed, both in the order
    of the study; equal points are computed once. `kept` are stored, `unused` are stored
    and no longer in the study: they stay, for the case that it is changed back. `notes`
    tell what changed since the last run, `facts` are those of the study for the store.
    """

    keys: list[bytes]
    pending: list[int]
    kept: int
    unused: int
    notes: tuple[str, ...]
    facts: dict[str, str]


def start(layout: StudyPoints, store: Store, *, retry_failed: bool = False) -> Start:
    """Compare a study with its store."""
    keys = all_keys(layout)
    known = store.outcomes()
    before = store.facts()
    wanted = set(keys)
    seen = {
        key
        for key, failed in known.items()
        if key in wanted and not (failed and retry_failed)
    }
    kept = sum(key in seen for key in keys)
    pending = list[int]()
    for number, key in enumerate(keys):
        if key not in seen:
            seen.add(key)
            pending.append(number)
    foreign = before and known and not wanted & known.keys()
    if foreign and (name := before["name"]) != layout.study.name:
        raise Refused(
            f"{store.path} holds the results of another study ({name}); name another"
            " folder with -o, or discard them with --fresh"
        )
    unused = len(known.keys() - wanted)
    begin = Start(keys, pending, kept, unused, (), _facts(layout))
    return replace(begin, notes=tuple(_notes(begin, before, store.path)))


def _facts(layout: StudyPoints) -> dict[str, str]:
    """The study and its case as they are written, with overrides; name and solver."""
    written = {**layout.study.document.content, "base": layout.plan.base}
    return {
        "study": json.dumps(written, sort_keys=True),
        "name": layout.study.name,
        "solver": layout.plan.solver,
    }


def _notes(begin: Start, before: dict[str, str], place: Path) -> Iterator[str]:
    """Changes since the last run in a store, if there was one, and what of it applies."""
    if not before:
        return
    if (solver := before["solver"]) != (now := begin.facts["solver"]):
        yield f"the solver changed from {solver} to {now}: nothing of it applies"
    changed = _changed_values(before["study"], begin.facts["study"])
    if changed:
        more = "; ..." if changed[6:] else ""
        yield f"the study changed: {'; '.join(changed[:6])}{more}"
    if changed or begin.unused:
        left = len(begin.keys) - begin.kept
        yield f"{begin.kept} points still apply, {left} are to be computed"
    if begin.unused:
        stay = f"they stay in {place}"
        yield f"{begin.unused} stored points are no longer in the study; {stay}"


def _changed_values(before: str, now: str) -> list[str]:
    """Values that differ between two studies in JSON: changed, added, dropped."""
    old, new = (dict(_leaves(json.loads(study))) for study in (before, now))
    both = [key for key in new if key in old and old[key] != new[key]]
    changed = [f"{key}: {shown(old[key])} -> {shown(new[key])}" for key in both]
    changed += [f"{key} = {shown(new[key])} added" for key in new if key not in old]
    return changed + [f"{key} dropped" for key in old if key not in new]


def _leaves(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Values of a document by their dotted paths; lists of plain values are whole."""
    if isinstance(value, list) and any(isinstance(item, dict | list) for item in value):
        value = dict(enumerate(value))
    if not isinstance(value, dict) or not value:
        yield path, value
        return
    for key, inner in value.items():
        yield from _leaves(inner, f"{path}.{key}" if path else str(key))


LARGEST_BATCH = 1000
"""Points; a batch takes about a second at most with common buildings, and keeps all lanes
of the kernel busy but at its end."""

SMALLEST_BATCH = 8

EARLY_BATCH = 32
"""Of the first two batches of each thread."""

WHOLE_BATCH = 16
"""Whole histories, which are followed one by one."""

TOGETHER = 32
"""Systems whose points are computed one record after the other: the kernels keep what
they read of the systems of a batch, near a megabyte of each."""


def batches(
    layout: StudyPoints, pending: Sequence[int], jobs: int
) -> Iterator[list[Point]]:
    """Batches of the pending points, which are given in the order of the study."""
    # Small enough that all threads have something to do until the end.
    largest = WHOLE_BATCH if layout.plan.whole else LARGEST_BATCH
    size = min(largest, max(SMALLEST_BATCH, len(pending) // (4 * jobs)))
    storeys = np.array([properties.storeys for properties in layout.properties])
    block = np.zeros_like(storeys)
    for count in np.unique(storeys):
        alike = storeys == count
        block[alike] = np.arange(np.count_nonzero(alike)) // TOGETHER
    numbers = np.array(pending, np.int64)
    systems, within = np.divmod(numbers, layout.points_of_system)
    records = within // (layout.points_of_system // len(layout.records))
    order = np.lexsort((records, block[systems], -storeys[systems]))
    numbers = numbers[order]
    systems = systems[order]
    early = 2 * jobs
    changes = np.diff(storeys[systems]) | np.diff(block[systems])
    for part in np.split(numbers, np.flatnonzero(changes) + 1):
        first = 0
        while first < len(part):
            # Small ones come first, so that a rate is soon known.
            count = size if early <= 0 else min(size, EARLY_BATCH)
            early -= 1
            yield [layout[number] for number in part[first : first + count].tolist()]
            first += count


HEARING = 0.2
"""Interval [s] at which the wait for a batch looks for a Ctrl-C.

A Ctrl-C that comes between the last look and the beginning of the wait, or that is given
to another thread, wakes nobody; on Windows none does.
"""

PATIENCE = 10.0
"""Time to wait for a scheduler, and for its first worker [s]."""


class Threads(Executor):
    """Threads of this process, one a batch, which share records and systems.

    The kernels let go of the interpreter while they compute, so threads use all cores
    without a copy of a record, and start at once. They are daemons: after a second Ctrl-C
    the process need not wait for them.
    """

    def submit(self, work: Callable[..., Any], /, *inputs: Any, **_: Any) -> Future[Any]:
        """Begin a piece of work."""
        future: Future[Any] = Future()

        def run() -> None:
            try:
                future.set_result(work(*inputs))
            except BaseException as error:  # noqa: BLE001 -- raised again where it can be told
                future.set_exception(error)

        threading.Thread(target=run, daemon=True).start()
        return future


class Engine:
    """Computes batches, several at a time: in threads of this
    process or on a Dask cluster.

    Workers of a cluster get the plan and the points, and read records themselves; all of
    them must see the files of the study under the same names, and run the same version of
    rps. `scheduler` is the address of its scheduler, as tcp://head:8786.
    """

    def __init__(
        self, context: StudyContext, jobs: int, scheduler: str | None = None
    ) -> None:
        self.jobs = jobs
        self._context = context
        self._opened = ExitStack()
        self._executor: Executor = Threads()
        self._deadly: type[BaseException] | tuple[()] = ()
        # Batches that are under way, and on a cluster kept ready for each of its threads.
        self._ahead = jobs
        if scheduler:
            self._connect(scheduler)
            return
        # Arrays that are freed go back to the system at once. glibc keeps ever larger
        # ones for later use, half of the memory of a study of 100,000 points.
        with suppress(AttributeError, OSError, TypeError):  # no glibc
            ctypes.CDLL(None).mallopt(-3, 1 << 17)  # M_MMAP_THRESHOLD

    def _connect(self, address: str) -> None:
        try:
            import distributed  # an optional extra
        except ModuleNotFoundError:
            raise UsageError(
                '--scheduler needs Dask; run: pip install "rpscli[cluster]"'
            ) from None
        dask: Any = distributed
        try:
            client = dask.Client(address, timeout=PATIENCE, set_as_default=False)
            self._opened.callback(client.close)
            client.wait_for_workers(1, timeout=PATIENCE)
        except (OSError, ValueError) as error:  # a TimeoutError is an OSError
            self._opened.close()
            raise UsageError(
                f"--scheduler {address}: no Dask scheduler with a worker answers there"
                f" ({error})"
            ) from None
        self.jobs = max(1, sum(client.nthreads().values()))
        self._ahead = 2 * self.jobs
        self._deadly = dask.KilledWorker
        # A batch whose worker dies is computed by another.
        self._executor = client.get_executor(pure=False, retries=2)
        plan = self._context.plan
        self._plan = replace(plan, base_folder=str(Path(plan.base_folder).absolute()))
        self._digest = hashlib.sha256(pickle.dumps(self._plan)).hexdigest()

    def _submit(self, points: list[Point]) -> Future[PointResults]:
        if not self._deadly:
            return self._executor.submit(run_batch, self._context, points)
        # Folders of records as every machine sees them.
        seen = [
            point._replace(
                record=of and of._replace(folder=str(Path(of.folder).absolute()))
            )
            for point in points
            for of in [point.record]
        ]
        return self._executor.submit(compute, self._digest, self._plan, seen)

    def outcomes(
        self, batches: Iterable[list[Point]]
    ) -> Iterator[tuple[list[Point], PointResults]]:
        """The batches with their results, as they come; taken
        when there is room for them.
        """
        source = iter(batches)
        under_way = dict[Future[PointResults], list[Point]]()

        def fill() -> None:
            for points in islice(source, max(self._ahead - len(under_way), 0)):
                under_way[self._submit(points)] = points

        with self._opened:
            fill()
            while under_way:
                done, _ = wait(under_way, timeout=HEARING, return_when=FIRST_COMPLETED)
                ended = [(under_way.pop(future), future) for future in done]
                fill()  # what is free goes on before the caller takes what it brought
                for points, future in ended:
                    error = CancelledError() if future.cancelled() else future.exception()
                    if error is None:
                        yield points, future.result()
                    elif not isinstance(error, self._deadly):
                        if not self._deadly or isinstance(error, RpsError):
                            raise error
                        raise RpsError(
                            f"the cluster gave up ({type(error).__name__}: {error}); what"
                            " was stored is safe, the same command continues"
                        )
                    elif len(points) == 1:
                        message = (
                            "the workers that computed this point died, one after the"
                            " other"
                        )
                        yield points, PointResults.alike(1, FAILED, message)
                    else:  # points of a deadly batch are tried one by one
                        under_way |= {self._submit([point]): [point] for point in points}


_contexts: dict[str, StudyContext] = {}
_lock = threading.Lock()


def compute(digest: str, plan: Plan, points: list[Point]) -> PointResults:
    """Results of a batch; runs on a worker, which keeps what it
    has read for the next one.
    """
    if plan.solver != solver_version():
        raise RpsError(
            f"a worker runs rps {solver_version()}, but the study was laid out by"
            f" {plan.solver}; install the same version on all machines"
        )
    with _lock:
        if digest not in _contexts:
            _contexts.clear()
            _contexts[digest] = StudyContext(plan)
        context = _contexts[digest]
    return run_batch(context, points)


@dataclass(frozen=True)
class Progress:
    """Progress of a study: points in all, stored before, of this run,
    failed ones of this run.

    `seconds` are those since the run began; `first` points were there after
    `first_seconds`, in which kernels may have been compiled: they say nothing
    about the rate of the others.
    """

    total: int
    kept: int
    computed: int
    failed: int
    seconds: float
    first: int = 0
    first_seconds: float = 0.0

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


def run(
    layout: StudyPoints,
    begin: Start,
    store: Store,
    engine: Engine,
    report: Callable[[Progress], None] = lambda _: None,
    announce: Callable[[], None] = lambda: None,
) -> Progress:
    """Compute and store points; Ctrl-C lets those under way end, a
    second one stops at once.
    """
    began = time.monotonic()
    progress = Progress(begin.kept + len(begin.pending), begin.kept, 0, 0, 0.0)
    with first_interrupt(announce) as interrupted:
        work = batches(layout, begin.pending, engine.jobs)
        wanted = takewhile(lambda _: not interrupted.is_set(), work)
        for points, results in engine.outcomes(wanted):
            store.add([begin.keys[point.number] for point in points], results)
            computed = progress.computed + len(points)
            seconds = time.monotonic() - began
            progress = replace(
                progress,
                computed=computed,
                failed=progress.failed + int((results.outcomes == FAILED).sum()),
                seconds=seconds,
                first=progress.first or computed,
                first_seconds=progress.first_seconds or seconds,
            )
            report(progress)
    return replace(progress, seconds=time.monotonic() - began)


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
