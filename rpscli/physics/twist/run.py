"""The kernel of slabs that turn as machine code, for any number of columns and storeys."""

from __future__ import annotations

import hashlib
from typing import Any

from rpscli.physics.kernels import are_interpreted, kept
from rpscli.physics.records import record_type
from rpscli.physics.twist.state import COLUMN, DAMPER, MODE, SLAB

_loaded: list[Any] = []


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


def text_of_twist() -> str:
    """The kernel as LLVM's text."""
    from rpscli.compiler.functions import Program
    from rpscli.physics.twist.follow import follow_twist

    program = Program()
    program.add(follow_twist, kinds_of_twist(), "@follow_twist")
    return program.text()


def twist_kernel() -> Any:
    """`follow.follow_twist`, compiled if it was never called before."""
    if are_interpreted():
        from rpscli.physics.twist.follow import follow_twist

        return follow_twist
    if not _loaded:
        from rpscli.compiler.objects import Entry

        code = kept().get(file_of_twist(), text_of_twist)
        _loaded.append(Entry(code, "follow_twist", kinds_of_twist(), None))
    return _loaded[0]
