"""Folder of a user's own files that can be made again: compiled kernels, fonts."""

from __future__ import annotations

import os
import stat
import tempfile
import warnings
from collections.abc import Iterator
from contextlib import ExitStack, closing, contextmanager, suppress
from pathlib import Path

VARIABLE = "RPS_CACHE_DIR"
"""Environment variable that names the place."""


def user_cache() -> Path | None:
    """The first place that only this user may write to, made if
    needed; None if there is none.
    """
    return next(
        (each for each in cache_places() if is_writable(each) and is_private(each)), None
    )


def cache_places() -> list[Path]:
    """Folder that ``RPS_CACHE_DIR`` names, the user's cache, one
    in the temporary folder.
    """
    places = [users_folder(VARIABLE), users_folder("XDG_CACHE_HOME", "~/.cache", "rps")]
    user = os.getuid() if hasattr(os, "getuid") else 0
    with suppress(FileNotFoundError):  # not even temporary files can be written
        place = Path(tempfile.gettempdir()) / f"rps-{user}"
        places += [] if place.is_symlink() else [place]  # everybody may put one there
    return [place for place in places if place]


def users_folder(variable: str, usual: str = "", *below: str) -> Path | None:
    """Folder that a variable names, else the usual one; None
    without either, or a home.
    """
    path = os.path.expanduser(os.environ.get(variable) or usual)  # noqa: PTH111 -- which raises
    return None if path[:1] in {"", "~"} else Path(path, *below)


def is_private(folder: Path) -> bool:
    """True if only this user may write to a folder, from which
    code is run; else a warning.
    """
    if os.name == "nt":
        return True
    state = folder.stat()
    amiss = ""
    if state.st_uid != os.getuid():
        amiss = f"{folder} belongs to somebody else"
    elif state.st_mode & (stat.S_IWGRP | stat.S_IWOTH):
        amiss = f"others may write to {folder}, where code is kept: chmod go-w {folder}"
    if amiss:
        warnings.warn(f"{amiss}; it is not used", stacklevel=2)
    return not amiss


def is_writable(folder: Path) -> bool:
    """True if files can be made in a folder, which is made if needed."""
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return True
    except OSError:
        return False


@contextmanager
def alone_in(folder: Path) -> Iterator[None]:
    """One process at a time, where files can be locked; a lock ends with its process."""
    import sqlite3

    with ExitStack() as held:
        with suppress(sqlite3.Error):
            connection = sqlite3.connect(folder / "saving", timeout=60.0)
            held.enter_context(closing(connection)).execute("BEGIN EXCLUSIVE")
        yield
