"""Where a user's own files that can be made again are kept: compiled kernels, fonts."""

from __future__ import annotations

import os
import stat
import tempfile
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

VARIABLE = "RPS_CACHE_DIR"
"""Environment variable that names the place."""


def user_cache() -> Path | None:
    """A folder that this user may write to, made if needed; None if there is no such place.

    ``RPS_CACHE_DIR`` wins, then the user's cache folder, then a private one in the system's
    temporary folder.
    """
    return next((place for place in _places() if _is_writable(place)), None)


def _places() -> Iterator[Path]:
    if named := os.environ.get(VARIABLE):
        yield Path(named)
    home = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")  # noqa: PTH111
    yield Path(home) / "rps"
    # What is cached is run as code: everybody may write to the temporary folder, so a folder there
    # counts only if nobody else made it, and nobody else may write to it.
    user = os.getuid() if hasattr(os, "getuid") else 0
    place = Path(tempfile.gettempdir()) / f"rps-{user}"
    with suppress(OSError):
        place.mkdir(mode=0o700, exist_ok=True)
        found = place.lstat()
        if stat.S_ISDIR(found.st_mode) and (os.name == "nt" or _is_private(found, user)):
            yield place


def _is_private(found: os.stat_result, user: int) -> bool:
    return found.st_uid == user and not found.st_mode & (stat.S_IRWXG | stat.S_IRWXO)


def _is_writable(folder: Path) -> bool:
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return True
    except OSError:
        return False
