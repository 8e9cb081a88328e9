"""The kernel as machine code: compiled at its first use, kept where the user may write.

Files are named after a digest of all sources that decide about them, of the processor and
of LLVM: what is found there always belongs to the program that runs.
"""

from __future__ import annotations

import hashlib
import os
import warnings
from collections.abc import Callable
from functools import cache
from pathlib import Path
from threading import Lock
from typing import Any

from rpscli.errors import OutputError
from rpscli.physics.interface import EVENT, REQUEST, RESULT, SAMPLE, SYSTEM
from rpscli.physics.records import record_type
from rpscli.physics.run import KernelOutput
from rpscli.physics.state import STATE
from rpscli.user_cache import VARIABLE, alone_in, is_private, user_cache

SOURCES = Path(__file__).parent
OTHERS = SOURCES.parent / "constants.py", SOURCES.parent / "compiler"
"""What decides about a kernel beside the sources: how large its
records are, and the compiler."""

INTERPRETED = "RPS_INTERPRETED", "NUMBA_DISABLE_JIT"
"""Environment variables with which kernels run as Python; the
second is of earlier versions."""

Kernel = Callable[..., Any]

_loaded: dict[tuple[int, int], Kernel] = {}
_loading = Lock()


def are_interpreted() -> bool:
    """True if kernels run as Python, for a debugger."""
    return any(os.environ.get(name, "0") not in {"", "0"} for name in INTERPRETED)


def sources_digest(*places: Path) -> str:
    """Digest of Python sources: of files, and of all below
    folders, their places included.
    """
    digest = hashlib.sha256()
    for place in places:
        for source in sorted(place.rglob("*.py")) if place.is_dir() else [place]:
            digest.update(str(source.relative_to(place.parent).as_posix()).encode())
            digest.update(source.read_bytes())
    return digest.hexdigest()[:16]


@cache
def cache_folder() -> Path | None:
    """Folder of the compiled kernels; None if no place is writable,
    or others may write there.
    """
    if (place := user_cache()) is None:
        return None
    folder = place / f"kernels-{sources_digest(SOURCES, *OTHERS)}"
    try:
        folder.mkdir(mode=0o700, exist_ok=True)
    except OSError:
        return None
    return folder if is_private(folder) else None


@cache
def not_kept(folder: Path, error: OSError) -> None:
    """Say once why machine code is not kept."""
    warnings.warn(
        f"{folder}: {error.strerror or error}: compiled kernels are not kept there, and"
        f" compiled each time; make room, or name another place in {VARIABLE}",
        stacklevel=2,
    )


def file_of(ways: int, lanes: int) -> str:
    """Name of the file of a kernel for this processor."""
    from rpscli.compiler.objects import processor

    digest = hashlib.sha256(
        f"{processor()} {program_sizes(ways, lanes)}".encode()
    ).hexdigest()
    return f"{ways}-{lanes}-{digest[:16]}.o"


def program_sizes(ways: int, lanes: int) -> str:
    """Sizes of the records of a kernel."""
    return " ".join(
        str(record_type(of, ways, lanes).itemsize) for of in (STATE, SYSTEM, RESULT)
    )


def kept() -> Any:
    """Machine code on disk."""
    from rpscli.compiler.objects import Kept

    return Kept(cache_folder(), alone_in, not_kept)


def is_ready(ways: int, lanes: int) -> bool:
    """True if calling a kernel starts at once: it is loaded, kept on
    disk, or runs as Python.
    """
    if are_interpreted() or (ways, lanes) in _loaded:
        return True
    return kept().find(file_of(ways, lanes)) is not None


def kinds_of_arguments(ways: int, lanes: int) -> tuple[Any, ...]:
    """Kinds of what `follow` is called with."""
    state = "Rows", record_type(STATE, ways, lanes)
    system, request, result, sample, event = (
        ("Rows", record_type(of)) for of in (SYSTEM, REQUEST, RESULT, SAMPLE, EVENT)
    )
    output = "tuple", (sample, ("Matrix", 3), event, ("Matrix", 3), "i64"), KernelOutput
    return state, system, request, ("Matrix", 1), result, output


def program_text(function: Kernel, kinds: tuple[Any, ...]) -> str:
    """A kernel for arguments of such kinds, as LLVM's text."""
    from rpscli.compiler.functions import Program
    from rpscli.compiler.values import NotInLanguage

    program = Program()
    try:
        program.add(function, kinds, f"@{function.__name__}")
    except NotInLanguage as error:
        said = ": ".join(reversed(error.args))
        raise OutputError(
            f"the kernel cannot be compiled: {said}; install rps with its sources, in a"
            " folder"
        ) from None
    return program.text()


def kernel(ways: int, lanes: int) -> Kernel:
    """`follow.follow` for so many directions and lanes, compiled if it
    was never called before.
    """
    from rpscli.physics.follow import follow

    if are_interpreted():
        return follow
    with _loading:
        if (ways, lanes) not in _loaded:
            kinds = kinds_of_arguments(ways, lanes)
            _loaded[ways, lanes] = machine_kernel(follow, kinds, file_of(ways, lanes))
        return _loaded[ways, lanes]


def machine_kernel(function: Kernel, kinds: tuple[Any, ...], file: str) -> Kernel:
    """A kernel as machine code, of its file if that is there."""
    from rpscli.compiler.objects import Entry

    code = kept().get(file, lambda: program_text(function, kinds))
    return Entry(code, function.__name__, kinds, None)
