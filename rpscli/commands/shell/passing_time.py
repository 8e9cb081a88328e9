"""A sign of life on a terminal."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rpscli.commands.shell.terminal import Terminal

MANY = 5000
"""Of what takes a millisecond each."""

_shown: list[str] = []


@contextmanager
def passing_time(what: str, terminal: Terminal) -> Iterator[None]:
    """A line with the time that has passed, gone when the work is done.

    Nothing where nobody looks, or where another such line stands already.

    Parameters
    ----------
    what
        Is being done.
    terminal
        Whether it is to be quiet.
    """
    if _shown or terminal.quiet or sys.stderr is None or not sys.stderr.isatty():
        yield
        return
    from rich.console import Console
    from rich.progress import Progress, SpinnerColumn, TimeElapsedColumn

    columns = (SpinnerColumn(), what, TimeElapsedColumn())
    _shown.append(what)
    try:
        with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
            progress.add_task("", total=None)
            yield
    finally:
        _shown.remove(what)


@contextmanager
def counted(what: str, terminal: Terminal) -> Iterator[Callable[[int, int], None]]:
    """A function that shows how many of how many are done: a bar on a terminal, else one line."""
    if terminal.quiet or sys.stderr is None or not sys.stderr.isatty():
        terminal.note(what)
        yield lambda *_: None
        return
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TimeRemainingColumn,
    )

    columns = (what, BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("", total=None)
        yield lambda done, total: bar.update(task, completed=done, total=total)


def watched(what: str, terminal: Terminal, numbers: range) -> Iterator[int]:
    """The numbers; how many are done is shown where they are many."""
    if len(numbers) < MANY:
        yield from numbers
        return
    with counted(f"{len(numbers)} {what}", terminal) as tell:
        for number in numbers:
            tell(number, len(numbers))
            yield number
