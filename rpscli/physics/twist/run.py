"""The kernel of slabs that turn as machine code, for any number of columns and storeys."""

from __future__ import annotations

import hashlib
from threading import Lock
from typing import Any

from rpscli.physics.kernels import are_interpreted, kept, machine_kernel
from rpscli.physics.records import record_type
from rpscli.physics.twist.state import COLUMN, DAMPER, MODE, SLAB

_loaded: list[Any] = []
_loading = Lock()


def file_of_twist() -> str:
    """Name of the kernel's file for this processor."""
    from rpscli.compiler.objects import processor

    sizes = [record_type(of).itemsize for of in (SLAB, COLUMN, MODE, DAMPER)]
    digest = hashlib.sha256(f"{processor()} {sizes}".encode()).hexdigest()
    return f"twist-{digest[:16]}.o"


def is_twist_ready() -> bool:
    """True if calling the kernel starts at once."""
    return bool(are_interpreted() or _loaded or kept().find(file_of_twist()) is not None)


def kinds_of_twist() -> tuple[Any, ...]:
    """Kinds of what `follow.follow_twist` is called with."""
    rows = [("Rows", record_type(of)) for of in (SLAB, COLUMN, MODE, DAMPER)]
    return (*rows, *[("Matrix", 2)] * 3)


def twist_kernel() -> Any:
    """`follow.follow_twist`, compiled if it was never called before."""
    from rpscli.physics.twist.follow import follow_twist

    if are_interpreted():
        return follow_twist
    with _loading:
        if not _loaded:
            kernel = machine_kernel(follow_twist, kinds_of_twist(), file_of_twist())
            _loaded.append(kernel)
        return _loaded[0]
