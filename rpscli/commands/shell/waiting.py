"""Signs of life on the standard error: what takes long, how far it is, and how long it may take."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, ExitStack, contextmanager, nullcontext
from typing import TYPE_CHECKING, Any

from rpscli.commands.shell.terminal import Terminal
from rpscli.user_cache import VARIABLE

if TYPE_CHECKING:
    from rpscli.case.case import Case
    from rpscli.sweep.run import Progress

MANY = 5000
"""Of what takes a millisecond each."""
LONG = 10.0
"""Time that is worth a word [s]."""
USUALLY = "half a minute, some minutes on a busy machine"
FIRST_LINE, GROWTH = 2.0, 1.6
"""Seconds until the first plain line; the next ones come after ever longer times."""

_standing: list[Any] = []
"""Bars on the terminal; other work that takes time becomes a line of the last."""


def _looked_at(terminal: Terminal) -> bool:
    return not terminal.quiet and sys.stderr is not None and sys.stderr.isatty()


@contextmanager
def _bar(*columns: Any) -> Iterator[Any]:
    """A line on the terminal that is gone when the work is done."""
    from rich.console import Console
    from rich.progress import Progress

    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        _standing.append(bar)
        try:
            yield bar
        finally:
            _standing.remove(bar)


@contextmanager
def passing_time(what: str, terminal: Terminal) -> Iterator[None]:
    """A line with the work in progress and the time that has passed, where somebody looks."""
    if not _looked_at(terminal):
        yield
        return
    from rich.progress import SpinnerColumn, TextColumn, TimeElapsedColumn

    with ExitStack() as opened:
        if _standing:
            bar = _standing[-1]
        else:
            columns = SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn()
            bar = opened.enter_context(_bar(*columns))
        task = bar.add_task(what, total=None)
        try:
            yield
        finally:
            bar.remove_task(task)


@contextmanager
def counted(what: str, terminal: Terminal) -> Iterator[Callable[[int, int], None]]:
    """A function that shows how many of how many are done: a bar on a terminal, else one line."""
    if not _looked_at(terminal):
        terminal.note(what)
        yield lambda *_: None
        return
    from rich.progress import BarColumn, MofNCompleteColumn, TimeRemainingColumn

    with _bar(what, BarColumn(), MofNCompleteColumn(), TimeRemainingColumn()) as bar:
        task = bar.add_task("", total=None)
        yield lambda done, total: bar.update(task, completed=done, total=total)


def filmed(film: Callable[[Callable[[int, int], None]], bytes], terminal: Terminal) -> bytes:
    """A film, which tells how many of its frames are drawn."""
    with counted("drawing the animation", terminal) as progress:
        return film(progress)


def watched(what: str, terminal: Terminal, numbers: range, *, many: int = MANY) -> Iterator[int]:
    """The numbers; how many are done is shown where they are many."""
    if len(numbers) < many:
        yield from numbers
        return
    with counted(f"{len(numbers)} {what}", terminal) as tell:
        for number in numbers:
            tell(number, len(numbers))
            yield number


def patience(case: Case, duration: float, terminal: Terminal) -> AbstractContextManager[None]:
    """Around a history under a record of a duration [s]: what a long one costs is said before."""
    from rpscli.analyses.kernels.systems import most_seconds, most_steps

    seconds = most_seconds(case.structure, case.analysis, duration)
    if seconds < LONG:
        return nullcontext()
    steps = most_steps(case.structure, case.analysis, duration)
    terminal.note(
        f"a long history: up to {steps:.2g} steps of {case.structure.storeys} modes, {seconds:.0f}"
        " s if it does not come to rest before; analysis.free_vibration shortens it"
    )
    return passing_time("computing", terminal)


def announce_compilation(terminal: Terminal) -> None:
    """Say so if a kernel has to be compiled, and how long that takes."""
    from rpscli.analyses.kernels.compilation import announce_to

    @contextmanager
    def announced(kernel: str) -> Iterator[None]:
        from rpscli.physics.compile import cache_folder

        nowhere = f"each time: no folder that is yours alone can be written; name one in {VARIABLE}"
        often = "once for this version" if cache_folder() else nowhere
        terminal.note(f"compiling the {kernel}, {often}: {USUALLY}")
        with passing_time(f"compiling the {kernel} ({USUALLY})", terminal):
            yield

    announce_to(announced)


@contextmanager
def progress_report(
    terminal: Terminal, kept: int, total: int
) -> Iterator[Callable[[Progress], None]]:
    """A function that shows how far a study is: a bar on a terminal, else a line now and then."""
    if terminal.quiet or kept == total:
        yield lambda _: None
        return
    if not _looked_at(terminal):
        due = FIRST_LINE

        def tell(progress: Progress) -> None:
            nonlocal due  # later and later: logs stay short
            if progress.seconds >= due and progress.done < progress.total:
                due = progress.seconds * GROWTH
                terminal.note(progress_line(progress))

        yield tell
        return
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn

    columns = BarColumn(20), MofNCompleteColumn(), TextColumn("{task.description}")
    with _bar(*columns, TimeElapsedColumn()) as bar:
        task = bar.add_task("", total=total, completed=kept)
        yield lambda progress: bar.update(
            task, completed=progress.done, description=", ".join(_pace(progress))
        )


def progress_line(progress: Progress) -> str:
    """Points done, rate and time left in one line."""
    return ", ".join((f"{progress.done} of {progress.total} points", *_pace(progress)))


def _pace(progress: Progress) -> Iterator[str]:
    """Failures, rate and time left, as far as they are known."""
    if progress.failed:
        yield f"{progress.failed} failed"
    if progress.rate:
        yield f"{progress.rate:.3g} points/s"
    if progress.seconds_left is not None:
        yield f"{duration(progress.seconds_left)} left"


def duration(seconds: float) -> str:
    """A time as people say it."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60} s"
    return f"{whole // 3600} h {whole % 3600 // 60} min"
