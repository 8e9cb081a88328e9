"""A sign of life on a terminal."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

from rpscli.commands.shell.terminal import Terminal

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
    from rich.console import Console  # noqa: PLC0415 -- other commands do without
    from rich.progress import Progress, SpinnerColumn, TimeElapsedColumn  # noqa: PLC0415

    columns = (SpinnerColumn(), what, TimeElapsedColumn())
    _shown.append(what)
    try:
        with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
            progress.add_task("", total=None)
            yield
    finally:
        _shown.remove(what)
