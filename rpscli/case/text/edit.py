"""Values put into the text of a file, whose comments, order and units stay as they are."""

from __future__ import annotations

import re
from collections.abc import Mapping

from rpscli.case.text.document import Document, Path, dotted
from rpscli.case.text.yaml_text import read_value, read_yaml
from rpscli.errors import CaseError

_SCALAR = re.compile(r"""'[^']*'|"[^"]*"|[^\s,}\]#][^,}\]#]*?(?=\s*(?:[,}\]]|\s#|$))""")


def edited(text: str, name: str, values: Mapping[str, str]) -> str:
    """The text of a file with values at dotted keys, as YAML would say them on one line.

    Raises
    ------
    CaseError
        Where a key stands in a way that is not understood, such as over several lines.
    """
    for key, value in values.items():
        path: Path = tuple(int(p) if p.isdecimal() else p for p in key.split("."))
        document = read_yaml(text, name)
        changed = _replaced(text, document, path, value) or _inserted(text, document, path, value)
        if read_yaml(changed, name).at(path) != read_value(value, name):
            raise CaseError(f"{name}: {key} cannot be written there; enter it by hand: {value}")
        text = changed
    return text


def _replaced(text: str, document: Document, path: Path, value: str) -> str | None:
    """With another scalar in place of one; None if there is none."""
    place = document.values.get(path)
    if place is None or isinstance(document.at(path), dict | list):
        return None
    lines = text.splitlines(keepends=True)
    line, at = lines[place.line - 1], place.column - 1
    lines[place.line - 1] = line[:at] + _SCALAR.sub(lambda _: value, line[at:], count=1)
    return "".join(lines)


def _inserted(text: str, document: Document, path: Path, value: str) -> str:
    """With a key that is not there, in the nearest mapping that is."""
    depth = next(d for d in range(len(path), -1, -1) if d == 0 or document.has(path[:d]))
    parent = document.at(path[:depth]) if depth else document.content
    lines = text.splitlines(keepends=True)
    rest = path[depth:]
    if not isinstance(parent, dict) or not rest or not parent:
        raise CaseError(
            f"{document.name}: {dotted(path)} cannot be written; put in {value} by hand"
        )
    for key in reversed(rest[1:]):
        value = f"{{{key}: {value}}}"
    first = document.keys[(*path[:depth], next(iter(parent)))]
    line, at = lines[first.line - 1], first.column - 1
    inside = "{" in line[:at]
    new = f"{rest[0]}: {value}, " if inside else f"{rest[0]}: {value}\n{line[:at]}"
    lines[first.line - 1] = line[:at] + new + line[at:]
    return "".join(lines)
