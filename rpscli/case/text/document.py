"""A document read from a file: values, where each was written,
and what is wrong with it.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import PurePath
from typing import Any

from rpscli.case.text.file_kinds import FILE_KINDS
from rpscli.errors import CaseError

Path = tuple[str | int, ...]
"""Keys on the way to a value of a document, and indices of lists counted from 0."""


def _cut(override: str) -> str:
    """The `--set` that brought a value in, or a name, without most of a long value."""
    return override if len(override) <= 160 else f"{override[:157]}..."


@dataclass(frozen=True)
class Position:
    """Position of a key or a value; files have rank 0,
    overrides follow in their order.
    """

    source: str
    line: int = 0
    column: int = 0
    rank: int = 0

    def __str__(self) -> str:
        return (
            f"{self.source}:{self.line}:{self.column}" if self.line else _cut(self.source)
        )

    @property
    def order(self) -> tuple[int, int, int]:
        """Key by which places are sorted."""
        return self.rank, self.line, self.column

    @property
    def short(self) -> str:
        """The place as a second one in a message: ``line 14``, or the source."""
        return f"line {self.line}" if self.line else _cut(self.source)


@dataclass(frozen=True)
class Fault:
    """A sentence on what is wrong at a path; `place` if not that of its key or value."""

    path: Path
    text: str
    at_key: bool = False
    place: Position | None = None


def dotted(path: Path) -> str:
    """A path as the user writes it, long keys cut."""
    return ".".join(
        part if len(part) <= 60 else f"{part[:57]}..." for part in map(str, path)
    )


def path_of(key: str) -> Path:
    """The path of a dotted key, whose numbers are indices."""
    return tuple(int(part) if part.isdecimal() else part for part in key.split("."))


def shown(value: object, width: int = 60) -> str:
    """A value as it goes into a message: text in quotes, long ones cut."""
    if value is None or isinstance(value, bool):
        return {None: "null", True: "true", False: "false"}[value]
    if isinstance(value, dict):
        text = (
            "{" + ", ".join(f"{key}: {shown(item)}" for key, item in value.items()) + "}"
        )
    elif isinstance(value, list | tuple):
        text = "[" + ", ".join(shown(item) for item in value) + "]"
    else:
        text = repr(value) if isinstance(value, str | int | float) else str(value)
    return text if len(text) <= width else f"{text[: width - 3]}..."


MOST_FAULTS = 100
"""Most faults that are listed in one message."""

MISSING = object()
"""Stands for a value that a document does not hold (None is YAML's null)."""


@dataclass(frozen=True, eq=False)
class Document:
    """Mappings, lists and scalars, with places by path, and what was
    wrong while reading them.
    """

    name: str
    content: dict[str, Any]
    keys: dict[Path, Position] = field(default_factory=dict)
    values: dict[Path, Position] = field(default_factory=dict)
    faults: tuple[Fault, ...] = ()

    def at(self, path: Path) -> Any:
        """The value at a path, or MISSING."""
        value: Any = self.content
        for part in path:
            is_index = (
                isinstance(value, list)
                and isinstance(part, int)
                and -1 < part < len(value)
            )
            if not is_index and not (isinstance(value, dict) and part in value):
                return MISSING
            value = value[part]
        return value

    def has(self, path: Path) -> bool:
        """True if a value is written at a path."""
        return self.at(path) is not MISSING

    def key_place(self, path: Path) -> Position:
        """Position of the key of a path; its nearest parent's, if it has none itself."""
        return self._place(path, self.keys)

    def value_place(self, path: Path) -> Position:
        """Position of the value of a path; its nearest
        parent's, if it has none itself.
        """
        return self._place(path, self.values)

    def _place(self, path: Path, places: Mapping[Path, Position]) -> Position:
        if path in places:
            return places[path]
        parents = (path[:length] for length in range(len(path) - 1, -1, -1))
        known = (self.keys.get(parent) or self.values.get(parent) for parent in parents)
        return next((place for place in known if place), Position(self.name))

    def where(self, path: Path) -> str:
        """A second place for a message, in brackets: `` (line 14)``; empty if unknown."""
        return f" ({self.keys[path].short})" if path in self.keys else ""

    def part(self, *path: str | int) -> Document:
        """The mapping at a path as a document of its own, positions kept."""
        depth = len(path)

        def below(places: Mapping[Path, Position]) -> dict[Path, Position]:
            return {p[depth:]: place for p, place in places.items() if p[:depth] == path}

        inside = [fault for fault in self.faults if fault.path[:depth] == path]
        faults = tuple(replace(fault, path=fault.path[depth:]) for fault in inside)
        return Document(
            self.name, self.at(path), below(self.keys), below(self.values), faults
        )

    def refuse(self, faults: Iterable[Fault]) -> None:
        """Raise all faults together, if there are any."""
        if found := list(faults):
            raise self.refusal(found)

    def refusal(self, faults: Iterable[Fault]) -> CaseError:
        """All faults, one a line, in the order of their places."""
        placed = [
            (
                f.place or (self.key_place if f.at_key else self.value_place)(f.path),
                f.text,
            )
            for f in faults
        ]
        placed.sort(key=lambda item: item[0].order)
        lines = list(dict.fromkeys(f"{place}: {text}" for place, text in placed))
        if (more := len(lines) - MOST_FAULTS) > 0:
            lines[MOST_FAULTS:] = [
                f"{self.name}: {more} more faults; correct these first"
            ]
        return CaseError("\n".join(lines))


def format_of(document: Document) -> str:
    """The kind of file that a document is: case, study or that of a tool; or empty."""
    keys = document.content.keys()
    if "base" not in keys:
        return "case" if "superstructure" in keys else ""
    for name, kind in FILE_KINDS.items():
        if kind.marks & keys:
            return name
    return "" if "superstructure" in keys else "study"


def text_of_values(values: Mapping[str, Any], name: str) -> str:
    """Values as a file would say them: arrays of numpy become
    lists, keys what YAML knows.
    """

    def plain(value: object) -> object:
        if isinstance(value, PurePath):
            return str(value)
        if hasattr(value, "tolist"):
            return value.tolist()
        raise TypeError(f"{value!r} is not a text, number, list or mapping")

    try:
        return json.dumps(values, default=plain)
    except (TypeError, ValueError, RecursionError) as error:
        raise CaseError(
            f"{name}: cannot be written to a file: {str(error)[:200]}; use text, numbers,"
            " lists, arrays and mappings"
        ) from None
