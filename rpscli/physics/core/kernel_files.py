"""Files of machine code that a disk has damaged: found before they are run, and thrown away.

numba believes what it finds in its cache. Of each file of machine code (``.nbc``), which never
changes once it is written, a checksum is noted; an index (``.nbi``), to which every process may
add, must be pickles from end to end if it was so when it was noted: should numba write it otherwise
one day, nothing is called damaged for that.
"""

from __future__ import annotations

import json
import os
import pickle
import zlib
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

NOTES = "checksums.json"
PICKLED = "pickled"
"""The note of an index."""


def note_files(folder: Path) -> None:
    """Note what a cache folder holds, after it was written."""
    with suppress(OSError):
        noted = _noted(folder)
        found = {_name(folder, file): _checksum(file) for file in _files(folder, ".nbc")}
        for file in _files(folder, ".nbi"):
            if noted.get(name := _name(folder, file)) == PICKLED or _is_pickled(file):
                found[name] = PICKLED
        if found != noted:
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

    def is_whole(file: Path) -> bool:
        before = noted.get(_name(folder, file))
        if file.suffix == ".nbi":
            return before != PICKLED or _is_pickled(file)
        return before in (None, _checksum(file))

    files = [*_files(folder, ".nbi"), *_files(folder, ".nbc")]
    whole = all(file.stat().st_size and is_whole(file) for file in files)
    if not whole:
        for file in [file for file in folder.rglob("*") if file.is_file()]:
            file.unlink(missing_ok=True)
    return not whole


def _files(folder: Path, suffix: str) -> Iterator[Path]:
    return folder.rglob(f"*{suffix}")


def _name(folder: Path, file: Path) -> str:
    return file.relative_to(folder).as_posix()


def _checksum(file: Path) -> str:
    """No more than a checksum: disks do damage, and nobody else writes here."""
    return f"{zlib.crc32(file.read_bytes()):08x}"


def _noted(folder: Path) -> dict[str, str]:
    """Notes by name; none if the notes are missing, or damaged themselves."""
    try:
        noted = json.loads((folder / NOTES).read_bytes())
    except (OSError, ValueError):
        return {}
    return noted if isinstance(noted, dict) else {}


def _is_pickled(file: Path) -> bool:
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
