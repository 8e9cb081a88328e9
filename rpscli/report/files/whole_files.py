"""The one place that writes files: each appears whole or not at all."""

from __future__ import annotations

import os
import secrets
from collections.abc import Mapping
from pathlib import Path

from rpscli.errors import OutputError


def write_whole(contents: Mapping[Path, bytes]) -> None:
    """Write files so that each appears whole or not at all, in folders that are made if needed.

    Raises
    ------
    OutputError
        If one cannot be written; then none has been replaced.
    """
    ready: dict[Path, Path] = {}
    path = Path()
    try:
        for path, data in contents.items():
            path.parent.mkdir(parents=True, exist_ok=True)
            if path.is_dir():
                raise IsADirectoryError(0, "there is a folder of this name")
            temporary = path.with_name(f".{path.name}.{secrets.token_hex(4)}")
            ready[path] = temporary
            temporary.write_bytes(data)
        for path, temporary in ready.items():
            temporary.replace(path)
    except OSError as error:
        raise _not_written(path, error) from None
    finally:
        for temporary in ready.values():
            temporary.unlink(missing_ok=True)


def require_writable(folder: Path) -> None:
    """Whether a folder can be made or written to: better known before the work than after.

    Raises
    ------
    OutputError
        If it cannot.
    """
    try:
        existing = next(place for place in (folder, *folder.absolute().parents) if place.exists())
    except OSError as error:
        raise _not_written(folder, error) from None
    if not existing.is_dir():
        raise OutputError(f"{folder}: cannot be a folder of results, {existing} is a file")
    if not os.access(existing, os.W_OK | os.X_OK):
        raise OutputError(f"{folder}: no permission to write there; name another place with -o")


def _not_written(path: Path, error: OSError) -> OutputError:
    reason = error.strerror or str(error)
    return OutputError(
        f"{str(path)[:200]}: cannot be written: {reason}; name another place with -o"
    )
