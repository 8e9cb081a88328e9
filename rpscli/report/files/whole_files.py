"""The one place that writes files: each appears whole or not at all."""

from __future__ import annotations

import os
import secrets
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import TypeAlias

from rpscli.errors import OutputError

Content: TypeAlias = bytes | Iterator[str]
"""Of a file, or its lines, which are made as they are written."""


def write_whole(contents: Mapping[Path, Content]) -> None:
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
            if isinstance(data, bytes):
                temporary.write_bytes(data)
            else:
                with temporary.open("wb") as file:
                    file.writelines(map(str.encode, data))
        for path, temporary in ready.items():
            temporary.replace(path)
    except OSError as error:
        raise _not_written(path, error) from None
    finally:
        for temporary in ready.values():
            temporary.unlink(missing_ok=True)


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Make the folder, and wait until no other process that asks writes there.

    Raises
    ------
    OutputError
        If it cannot be made.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise _not_written(folder, error) from None
    with ExitStack() as lock:
        # The system lets go when the process ends, however it ends. Where folders cannot be locked
        # (Windows, some file systems of networks), two processes must not write to one.
        with suppress(ImportError, OSError):
            import fcntl  # not on every system

            handle = os.open(folder, os.O_RDONLY)
            lock.callback(os.close, handle)
            fcntl.flock(handle, fcntl.LOCK_EX)
        yield


def require_writable(folder: Path) -> None:
    """Whether a folder can be made or written to: better known before the work than after.

    Raises
    ------
    OutputError
        If it cannot.
    """
    if "\0" in str(folder):
        raise OutputError(f"{str(folder)[:200]!r}: no path holds a zero byte; correct the name")
    try:
        existing = next(place for place in (folder, *folder.absolute().parents) if place.exists())
    except OSError as error:
        raise _not_written(folder, error) from None
    if not existing.is_dir():
        raise OutputError(f"{folder}: cannot be a folder of results, {existing} is a file")
    if not os.access(existing, os.W_OK | os.X_OK):
        raise OutputError(f"{folder}: no permission to write there; name another place with -o")


def require_writable_file(file: Path) -> None:
    """Whether a file can be made or replaced.

    Raises
    ------
    OutputError
        If it cannot.
    """
    require_writable(file.parent)
    try:
        if file.is_dir():
            raise IsADirectoryError(0, "there is a folder of this name")
    except OSError as error:
        raise _not_written(file, error) from None


def _not_written(path: Path, error: OSError) -> OutputError:
    reason = error.strerror or str(error)
    return OutputError(
        f"{str(path)[:200]}: cannot be written: {reason}; name another place with -o"
    )
