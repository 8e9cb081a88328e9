"""Whether the kernel has to be compiled, and who wants to know before it happens."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, ExitStack, contextmanager
from threading import Lock

Listener = Callable[[], AbstractContextManager[None]]
"""Called before the kernel is compiled; open until it is."""

_listeners: list[Listener] = []
_first = Lock()
"""Taken by the first who compiles, and kept."""

KERNEL = "kernel"


def announce_to(listener: Listener) -> None:
    """Have a compilation told before it begins; the last listener counts."""
    _listeners[:] = [listener]


def is_ready() -> bool:
    """Whether the kernel was compiled before, so that calling it starts at once."""
    from rpscli.physics.core.compile import is_compiled

    return is_compiled(KERNEL)


@contextmanager
def compiled() -> Iterator[None]:
    """Around a call of the kernel: announce the compilation if there is one, and remember it."""
    from rpscli.physics.core.compile import remember_compiled
    from rpscli.physics.planar.prepare import compile_kernel

    if is_ready():
        yield
        return
    with ExitStack() as told:
        if _first.acquire(blocking=False):
            for listener in _listeners:
                told.enter_context(listener())
            compile_kernel()
        yield
    remember_compiled(KERNEL)
