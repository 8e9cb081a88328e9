"""Where a user's own files that can be made again are kept: compiled kernels, fonts."""

from __future__ import annotations

import os
import stat
import tempfile
import warnings
from collections.abc import Iterator
from pathlib import Path

VARIABLE = "RPS_CACHE_DIR"
"""Environment variable that names the place."""


def user_cache() -> Path | None:
    """A folder that only this user may write to, made if needed; None if there is no such place.

    ``RPS_CACHE_DIR`` wins, then the user's cache folder, then one in the system's temporary folder.
    """
    return next((place for place in _places() if _is_writable(place) and is_private(place)), None)


def _places() -> Iterator[Path]:
    if named := os.environ.get(VARIABLE):
        yield Path(named)
    home = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")  # noqa: PTH111
    yield Path(home) / "rps"
    user = os.getuid() if hasattr(os, "getuid") else 0
    place = Path(tempfile.gettempdir()) / f"rps-{user}"
    if not place.is_symlink():  # everybody may put one there
        yield place


def is_private(folder: Path) -> bool:
    """Whether nobody but its owner, who is this user, may write to a folder; else says so.

    What is cached is run as code.
    """
    if os.name == "nt":
        return True
    found = folder.stat()
    if found.st_uid != os.getuid():
        warnings.warn(f"{folder} belongs to somebody else and is not used", stacklevel=2)
    elif found.st_mode & (stat.S_IWGRP | stat.S_IWOTH):
        warnings.warn(
            f"others may write to {folder}, where code is kept, so it is not used;"
            f" chmod go-w {folder}",
            stacklevel=2,
        )
    else:
        return True
    return False


def _is_writable(folder: Path) -> bool:
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return True
    except OSError:
        return False
