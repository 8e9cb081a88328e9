"""The wait at the first time history of a new version."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from rpscli.commands.shell.passing_time import passing_time
from rpscli.commands.shell.terminal import Terminal
from rpscli.user_cache import VARIABLE

NOWHERE = f"no folder for it can be written; name one in {VARIABLE}"


def announce_compilation(terminal: Terminal, *, moving: bool = False) -> None:
    """Say so if the kernel has to be compiled.

    Parameters
    ----------
    terminal
        Where to say it.
    moving
        Show on a terminal that something goes on; not where a bar shows it already.
    """
    from rpscli.analyses.kernels.compilation import announce_to

    @contextmanager
    def told() -> Iterator[None]:
        from rpscli.physics.core.compile import cache_folder

        often = "once for this version" if cache_folder() else f"each time: {NOWHERE}"
        terminal.note(f"compiling the kernel, {often}: half a minute")
        if moving:
            with passing_time("compiling", terminal):
                yield
        else:
            yield

    announce_to(told)
