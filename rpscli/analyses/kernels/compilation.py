"""Which kernels have to be compiled, and who wants to know before it happens."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, ExitStack, contextmanager
from threading import Lock

Listener = Callable[[str], AbstractContextManager[None]]
"""Told the name of a kernel; open while it is compiled."""

_listeners: list[Listener] = []
_announced: set[str] = set()
_lock = Lock()


def announce_to(listener: Listener) -> None:
    """Have the name of each kernel told before it is compiled; the last listener counts."""
    _listeners[:] = [listener]


def kernel_name(storeys: int) -> str:
    """Name of the kernel for buildings of so many storeys.

    >>> kernel_name(6)
    'buildings of up to 32 storeys'
    """
    from rpscli.physics.state import capacity  # noqa: PLC0415 -- numpy is slow

    return f"buildings of up to {capacity(storeys)} storeys"


def is_ready(storeys: int) -> bool:
    """Whether a kernel was compiled before, so that calling it starts at once."""
    from rpscli.physics.compile import is_compiled  # noqa: PLC0415 -- numba is slow

    return is_compiled(kernel_name(storeys))


@contextmanager
def compiled(storeys: int) -> Iterator[None]:
    """Around a call of a kernel: announce the compilation if there is one, and remember it."""
    from rpscli.physics.compile import remember_compiled  # noqa: PLC0415 -- numba is slow
    from rpscli.physics.prepare import compile_beside  # noqa: PLC0415 -- numba is slow

    if is_ready(storeys):
        yield
        return
    name = kernel_name(storeys)
    with _lock:
        new = name not in _announced
        _announced.add(name)
    if new:
        with ExitStack() as told:
            for listener in _listeners:
                told.enter_context(listener(name))
            compile_beside(storeys)
            yield
    else:
        yield
    remember_compiled(name)
