"""Locks of the kernel cache, by which test workers share compilations out."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator

from rpscli.physics.compile import cache_folder


@contextlib.contextmanager
def locked(name: str, *, wait: bool = True) -> Iterator[bool]:
    """Whether no other process that uses the same cache has this lock; Windows has none."""
    if os.name != "posix" or (folder := cache_folder()) is None:
        yield True
        return
    import fcntl

    with (folder / f"{name}.lock").open("w") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX if wait else fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            yield False
        else:
            yield True
