"""The text of an input file, or a message that says why there is none."""

from __future__ import annotations

import os
import select
import stat
import sys
from importlib import resources
from pathlib import Path
from typing import Any, BinaryIO

from rpscli.errors import CaseError, nearest, require_visible
from rpscli.titled_table import text_of

STDIN = "-"
LARGEST = 2_000_000
"""Bytes of a case or study file; a case of two hundred storeys has ten thousand."""
_PATIENCE = 10.0
"""Seconds that a named pipe may stay without a writer."""


def read_text(source: str | Path, *, wide: bool = False) -> str:
    """Text of a case or study file, or of a table, which may be UTF-16: `wide`.

    ``-`` reads the standard input.
    """
    if str(source) == STDIN:
        if sys.stdin is None:
            raise CaseError(
                "<stdin>: the standard input is closed; name a file, or pipe a case in"
            )
        return decoded(_bounded(sys.stdin.buffer, "<stdin>"), "<stdin>")
    require_visible(str(source), CaseError)
    path = Path(source)
    try:
        kind = path.stat().st_mode
        if stat.S_ISDIR(kind):
            example = "".join(
                f", such as {file}" for file in sorted(path.glob("*.yaml"))[:1]
            )
            raise CaseError(f"{source}: is a folder; name a file in it{example}")
        if stat.S_ISCHR(kind) or stat.S_ISBLK(kind):
            raise CaseError(
                f"{source}: is a device; name a file, or `-` for the standard input"
            )
        with _opened(path, kind) as file:
            return decoded(_bounded(file, str(source)), str(source), wide=wide)
    except FileNotFoundError:
        raise CaseError(f"{source}: there is no such file{_similar(path)}") from None
    except (OSError, ValueError) as error:
        reason = (
            error.strerror if isinstance(error, OSError) and error.strerror else error
        )
        raise CaseError(
            f"{str(source)[:200]}: cannot be read: {reason}; check the name and the"
            " permissions"
        ) from None


def opened(source: str | Path) -> dict[str, Any]:
    """Text, name in messages, and folder of relative names of a file,
    or of the standard input.
    """
    if str(source) == STDIN:
        return {"text": read_text(source), "name": "<stdin>", "folder": Path()}
    return {"text": read_text(source), "name": str(source), "folder": Path(source).parent}


def _opened(path: Path, kind: int) -> BinaryIO:
    """The file; a pipe must have a writer, for without one reading would never end."""
    if not stat.S_ISFIFO(kind):
        return path.open("rb")
    pipe = os.fdopen(os.open(path, os.O_RDONLY | os.O_NONBLOCK), "rb")
    if not select.select([pipe], [], [], _PATIENCE)[0]:
        pipe.close()
        raise CaseError(
            f"{path}: nothing writes to this pipe; name a file, or write to it first"
        )
    os.set_blocking(pipe.fileno(), True)
    return pipe


def _bounded(file: BinaryIO, name: str) -> bytes:
    data = file.read(LARGEST + 1)
    if len(data) > LARGEST:
        raise CaseError(
            f"{name}: more than {LARGEST / 1e6:g} MB is not a case or a study; records"
            " are named by their files, not written out"
        )
    return data


def decoded(data: bytes, name: str, *, wide: bool = False) -> str:
    """UTF-8 bytes as text, with or without a byte order mark; if `wide` UTF-16 too."""
    try:
        return text_of(data) if wide else data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        before = data[: error.start]
        line = before.count(b"\n") + 1
        column = len(before) - before.rfind(b"\n")
        raise CaseError(
            f"{name}:{line}:{column}: the byte 0x{data[error.start]:02x} is not UTF-8;"
            " save the file as UTF-8 text"
        ) from None


def starter_text(*, study: bool = False) -> str:
    """A commented case, or a study of one, that is valid as it stands."""
    name = "starter_study.yaml" if study else "starter.yaml"
    return resources.files("rpscli.case").joinpath(name).read_text(encoding="utf-8")


def _similar(path: Path) -> str:
    folder = path.parent
    if not folder.is_dir():
        return f"; the folder {folder} does not exist either"
    # By what stands before the dot: all cases end alike.
    names = {item.stem: item.name for item in folder.iterdir() if item.is_file()}
    if similar := nearest(path.stem, names):
        return f"; did you mean {folder / names[similar]}?"
    return (
        "; check its name"
        if path.suffix == ".csv"
        else "; `rps init` writes a case to start from"
    )
