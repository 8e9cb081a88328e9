"""Which kernels have to be compiled, and who wants to know before it happens."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Lock

from rpscli.model.podium import PodiumStructure

SINGLE = "histories one by one"
"""The kernel of single histories: it serves every structure."""

Listener = Callable[[str], None]

_listeners: list[Listener] = []
_announced: set[str] = set()
_lock = Lock()


def announce_to(listener: Listener) -> None:
    """Have the name of each kernel told before it is compiled; the last listener counts."""
    _listeners[:] = [listener]


def lanes_of(structure: PodiumStructure, lanes: int) -> str:
    """Name of the kernel that follows many histories of such structures side by side."""
    return f"{structure.storeys} storeys in {lanes} lanes"


def is_ready(name: str) -> bool:
    """Whether a kernel was compiled before, so that calling it starts at once."""
    from rpscli.physics.jit import is_compiled  # noqa: PLC0415 -- numba is slow

    return is_compiled(name)


@contextmanager
def compiled(name: str) -> Iterator[None]:
    """Around a call of a kernel: announce the compilation if there is one, and remember it."""
    from rpscli.physics.jit import remember_compiled  # noqa: PLC0415 -- numba is slow

    if is_ready(name):
        yield
        return
    with _lock:
        new = name not in _announced
        _announced.add(name)
    if new:
        for listener in _listeners:
            listener(name)
    yield
    remember_compiled(name)
