"""How far a study is: a bar on a terminal, plain lines elsewhere."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from rpscli.commands.shell.terminal import Terminal

if TYPE_CHECKING:
    from rpscli.sweep.run.runner import Progress

Report = Callable[["Progress"], None]

FIRST_LINE = 2.0
"""Seconds until the first plain line; the next ones come after ever longer times."""
GROWTH = 1.6


@contextmanager
def progress_report(terminal: Terminal, kept: int, total: int) -> Iterator[Report]:
    """A function that shows progress on the standard error."""
    if terminal.quiet or kept == total:
        yield lambda _: None
    elif sys.stderr.isatty():
        with _bar(kept, total) as report:
            yield report
    else:
        yield _lines(terminal)


def _lines(terminal: Terminal) -> Report:
    """A line now and then, fewer as time goes on: logs stay short."""
    due = FIRST_LINE

    def report(progress: Progress) -> None:
        nonlocal due
        if progress.seconds >= due and progress.done < progress.total:
            due = progress.seconds * GROWTH
            terminal.note(progress_line(progress))

    return report


def progress_line(progress: Progress) -> str:
    """Points done, rate and time left in one line."""
    failed = f", {progress.failed} failed" if progress.failed else ""
    left = progress.seconds_left
    ahead = "" if left is None else f", {duration(left)} left"
    done = f"{progress.done} of {progress.total} points{failed}"
    rate = f", {progress.rate:.3g} points/s" if progress.rate else ""
    return f"{done}{rate}{ahead}"


def duration(seconds: float) -> str:
    """A time as people say it.

    >>> duration(7.4), duration(83.0), duration(7260.0)
    ('7 s', '1 min 23 s', '2 h 1 min')
    """
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60} s"
    return f"{whole // 3600} h {whole % 3600 // 60} min"


@contextmanager
def _bar(kept: int, total: int) -> Iterator[Report]:
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

    columns = (BarColumn(), MofNCompleteColumn(), TextColumn("{task.description}"))
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("", total=total, completed=kept)

        def report(progress: object) -> None:
            left = getattr(progress, "seconds_left", None)
            rate, failed = getattr(progress, "rate", 0.0), getattr(progress, "failed", 0)
            text = f"{rate:.3g}/s" * bool(rate) + (
                "" if left is None else f", {duration(left)} left"
            )
            text += f", {failed} failed" if failed else ""
            bar.update(task, completed=getattr(progress, "done", 0), description=text)

        yield report
