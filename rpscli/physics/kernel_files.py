"""Files of machine code that a disk has damaged: found before they are run, and thrown away.

numba believes what it finds in its cache. Of each file of machine code (``.nbc``), which never
changes once it is written, the digest is noted; an index (``.nbi``), to which every process may
add, must at least be whole.
"""

from __future__ import annotations

import json
import os
import pickle
import zlib
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

NOTES = "digests.json"


def note_files(folder: Path) -> None:
    """Note the digests of the machine code in a cache folder, after it was written."""
    with suppress(OSError):
        found = {_name(folder, file): _digest(file) for file in _files(folder, ".nbc")}
        if found != _noted(folder):
            new = folder / f"{NOTES}.{os.getpid()}"
            new.write_text(json.dumps(found))
            new.replace(folder / NOTES)


def discard_damaged(folder: Path) -> bool:
    """Empty a cache folder with a damaged file; whether there was one.

    What another process writes at this moment is not in the notes yet, and passes unless it is
    empty.

    Raises
    ------
    OSError
        If damaged files cannot be read or deleted.
    """
    noted = _noted(folder)
    whole = all(map(_is_index, _files(folder, ".nbi"))) and all(
        file.stat().st_size and noted.get(_name(folder, file)) in (None, _digest(file))
        for file in _files(folder, ".nbc")
    )
    if not whole:
        for file in [file for file in folder.rglob("*") if file.is_file()]:
            file.unlink(missing_ok=True)
    return not whole


def _files(folder: Path, suffix: str) -> Iterator[Path]:
    return folder.rglob(f"*{suffix}")


def _name(folder: Path, file: Path) -> str:
    return file.relative_to(folder).as_posix()


def _digest(file: Path) -> str:
    """A checksum: disks do damage, and nobody else writes here."""
    return f"{zlib.crc32(file.read_bytes()):08x}"


def _noted(folder: Path) -> dict[str, str]:
    """Digests by name; none if the notes are missing, or damaged themselves."""
    try:
        noted = json.loads((folder / NOTES).read_bytes())
    except (OSError, ValueError):
        return {}
    return noted if isinstance(noted, dict) else {}


def _is_index(file: Path) -> bool:
    """Whether a file consists of one or more whole pickles, as an index of numba does."""
    count = 0
    try:
        with file.open("rb") as index:
            while index.peek(1):
                pickle.load(index)  # noqa: S301 -- numba does so next
                count += 1
    except Exception:  # noqa: BLE001 -- damaged pickles raise anything
        return False
    return count > 0
