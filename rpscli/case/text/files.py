"""The text of an input file, or a message that says why there is none."""

from __future__ import annotations

import sys
from importlib import resources
from pathlib import Path

from rpscli.errors import CaseError, nearest

STDIN = "-"


def read_text(source: str | Path) -> str:
    """Text of a case or study file; ``-`` reads the standard input.

    Raises
    ------
    CaseError
        If there is no such file, it is a folder, it cannot be read, or it is not UTF-8.
    """
    if str(source) == STDIN:
        if sys.stdin is None:
            raise CaseError("<stdin>: the standard input is closed; name a file, or pipe a case in")
        return decoded(sys.stdin.buffer.read(), "<stdin>")
    path = Path(source)
    if path.is_dir():
        raise CaseError(f"{source}: is a folder; name a file in it{_example(path)}")
    try:
        return decoded(path.read_bytes(), str(source))
    except FileNotFoundError:
        raise CaseError(f"{source}: there is no such file{_similar(path)}") from None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else error
        raise CaseError(f"{source}: cannot be read: {reason}") from None


def decoded(data: bytes, name: str) -> str:
    """UTF-8 bytes as text, with or without a byte order mark.

    Raises
    ------
    CaseError
        If the bytes are not UTF-8; names the first line and column that are not.
    """
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        before = data[: error.start]
        line, column = before.count(b"\n") + 1, len(before) - before.rfind(b"\n")
        raise CaseError(
            f"{name}:{line}:{column}: the byte 0x{data[error.start]:02x} is not UTF-8; save the"
            " file as UTF-8 text"
        ) from None


def starter_text() -> str:
    """A commented case that is valid as it stands."""
    return resources.files("rpscli.case").joinpath("starter.yaml").read_text(encoding="utf-8")


def _similar(path: Path) -> str:
    folder = path.parent
    if not folder.is_dir():
        return f"; the folder {folder} does not exist either"
    found = nearest(path.name, (item.name for item in folder.iterdir() if item.is_file()))
    if found:
        return f"; did you mean {folder / found}?"
    return "; `rps init` writes a case to start from"


def _example(folder: Path) -> str:
    files = sorted(folder.glob("*.yaml"))
    return f", such as {files[0]}" if files else ""
