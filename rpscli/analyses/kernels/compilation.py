"""Compilation of kernels: if it is needed, and listeners that are told before it begins."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, ExitStack, contextmanager
from threading import Lock

from rpscli.physics.state import LANES

Listener = Callable[[str], AbstractContextManager[None]]
"""Called with the name of a kernel before it is compiled; open while it is."""

_listeners: list[Listener] = []
_begun: set[str] = set()
"""Kernels that somebody compiles, or has compiled."""
_lock = Lock()
_ready: set[str] = set()
"""Kernels that are known to be compiled: a file tells, which is looked for once."""

KERNELS = {
    (1, 1): "kernel",
    (1, LANES): "kernel for many histories",
    (2, 1): "kernel for both components",
    (2, LANES): "kernel for both components of many histories",
}
"""By horizontal components and lanes."""


def announce_to(listener: Listener) -> None:
    """Have a compilation told before it begins; the last listener counts."""
    _listeners[:] = [listener]


def is_ready(ways: int, lanes: int) -> bool:
    """True if the kernel was compiled before, so that calling it starts at once."""
    from rpscli.physics.compile import is_compiled

    name = KERNELS[ways, lanes]
    if name not in _ready and is_compiled(_mark(name)):
        _ready.add(name)
    return name in _ready


def _mark(name: str) -> str:
    """A kernel of this installation: machine code is kept by the place of its sources."""
    from rpscli.physics.compile import SOURCES

    return f"{name} {hashlib.sha256(str(SOURCES).encode()).hexdigest()[:8]}"


@contextmanager
def compiled(ways: int, lanes: int) -> Iterator[None]:
    """Around a call of the kernel: announce the compilation if there is one, and remember it."""
    from rpscli.physics.compile import cache_folder, remember_compiled
    from rpscli.physics.prepare import can_prepare, compile_kernel

    name = KERNELS[ways, lanes]
    if is_ready(ways, lanes):
        yield
        return
    with _lock:
        first = name not in _begun
        _begun.add(name)
    with ExitStack() as told:
        if first:
            for listener in _listeners:
                told.enter_context(listener(name))
            compile_kernel(ways, lanes)
            if cache_folder() is not None:  # else the first call compiles
                told.close()
        yield
    if can_prepare():
        remember_compiled(_mark(name))
    else:  # there is no machine code that other processes find
        _ready.add(name)
