"""Compilation of the kernels, cached where the user may write.

numba invalidates a cached function when its own file changes, not when a function that it inlines
from another file does. The cache folder is therefore named after a digest of all kernel sources:
what is found there always belongs to the program that runs.
"""

from __future__ import annotations

import atexit
import hashlib
import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar, cast

import numba
from numba.extending import register_jitable

from rpscli.physics.core.kernel_files import discard_damaged, note_files
from rpscli.user_cache import user_cache

Function = TypeVar("Function", bound=Callable[..., Any])

OPTIONS: dict[str, Any] = {
    "nogil": True,
    "error_model": "numpy",
    # The only liberty that the compiler has: a product and a sum may be rounded once.
    "fastmath": {"contract"},
    # Nothing is called from C: without these wrappers a tenth less is to be compiled. The argument
    # of numba.jit is not in its manual.
    "no_cfunc_wrapper": True,
}

SOURCES = Path(__file__).parents[1]
CONSTANTS = SOURCES.parent / "constants.py"
"""The one module outside of the sources that decides about a kernel: how large its records are."""


def sources_digest(folder: Path, *others: Path) -> str:
    """Digest of all Python sources below a folder, their places included, and of other files."""
    digest = hashlib.sha256()
    for source in sorted(folder.rglob("*.py")):
        digest.update(str(source.relative_to(folder).as_posix()).encode())
        digest.update(source.read_bytes())
    for other in others:
        digest.update(other.read_bytes())
    return digest.hexdigest()[:16]


@cache
def cache_folder() -> Path | None:
    """Folder of the compiled kernels; None if no place is writable."""
    place = user_cache()
    if place is None:
        return None
    folder = place / f"kernels-{sources_digest(SOURCES, CONSTANTS)}"
    folder.mkdir(exist_ok=True)
    return folder


@cache
def sound_cache() -> Path | None:
    """The cache folder without what a disk has damaged; None where there can be none."""
    if (folder := cache_folder()) is not None:
        try:
            discard_damaged(folder)
        except OSError:
            return None
        atexit.register(note_files, folder)
    return folder


def kernel(function: Function) -> Function:
    """Compile at the first call from Python, without the GIL; keep the machine code on disk."""
    folder, config = sound_cache(), cast("Any", numba.config)
    before, config.CACHE_DIR = config.CACHE_DIR, str(folder or "")
    try:
        return cast("Function", numba.njit(function, cache=folder is not None, **OPTIONS))
    finally:
        config.CACHE_DIR = before


def compiled(function: Function) -> Function:
    """Compile with the kernels that call it; called from Python it runs as Python."""
    return register_jitable(**OPTIONS)(function)


def inlined(function: Function) -> Function:
    """The same, merged into its callers, whose constants it then knows: for loops over lanes."""
    return register_jitable(forceinline=True, **OPTIONS)(function)


def specialised(function: Function) -> Function:
    """The same, anew for each constant that is handed to it.

    For loops over lanes: of a known number of lanes the compiler makes vector instructions.
    """
    return cast("Function", numba.njit(function, **OPTIONS))


_compiled_here: set[str] = set()


def is_compiled(name: str) -> bool:
    """Whether `remember_compiled` was told so by any process that uses the same cache folder."""
    folder = sound_cache()
    return name in _compiled_here or (folder is not None and (folder / _mark(name)).exists())


def remember_compiled(name: str) -> None:
    """Note that the machine code of a kernel is in memory and, if there is a cache, on disk."""
    _compiled_here.add(name)
    if (folder := sound_cache()) is not None:
        note_files(folder)
        (folder / _mark(name)).touch()


def _mark(name: str) -> str:
    return re.sub(r"\W+", "-", name) + ".compiled"
