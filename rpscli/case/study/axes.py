"""What a study multiplies: its axes of case keys, and its record sources."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path as Folder
from typing import Any

from pydantic import TypeAdapter, ValidationError

from rpscli.case.study.schema import Axes, RecordPattern, Source
from rpscli.case.text.document import Document, Fault, Path, Place, dotted
from rpscli.errors import RecordError
from rpscli.records.loading import expanded, repeated

Values = tuple[Any, ...]

_AXES: TypeAdapter[tuple[dict[str, Values], ...]] = TypeAdapter(Axes)
_SOURCE: TypeAdapter[str | RecordPattern] = TypeAdapter(Source)

MOST_SOURCES = 100_000
"""Ground motions that the options of one pattern may stand for."""


@dataclass(frozen=True)
class Axis:
    """Keys that go together, a row of values for each position, and where each was written."""

    keys: tuple[str, ...]
    rows: tuple[Values, ...]
    places: tuple[tuple[Place, ...], ...]

    def place(self, key: int, row: int) -> Place:
        """Where a value was written."""
        places = self.places[key]
        return places[row] if len(places) == len(self.rows) else places[0]


def axes_of(document: Document) -> tuple[list[Axis], list[Fault]]:
    """Axes under the key `vary` of a study as far as they can be read, and what is unequal."""
    try:
        read = _AXES.validate_python(document.content.get("vary", []))
    except ValidationError:
        return [], []  # told key by key
    axes: list[Axis] = []
    faults: list[Fault] = []
    for index, values in enumerate(read):
        path: Path = ("vary", index)
        first, *others = values
        faults += [
            Fault(
                (*path, key),
                f"{key} has {len(values[key])} values, but"
                f" {first}{document.where((*path, first))} has {len(values[first])}: the keys of"
                " one axis go together; give equally many, or begin another axis with `-`",
                at_key=True,
            )
            for key in others
            if len(values[key]) != len(values[first])
        ]
        if len({len(column) for column in values.values()}) == 1:
            axes.append(_axis(document, path, values))
    return axes, faults


def _axis(document: Document, path: Path, values: Mapping[str, Values]) -> Axis:
    def places(key: str, count: int) -> tuple[Place, ...]:
        if isinstance(document.at((*path, key)), dict):
            return (document.value_place((*path, key)),)
        return tuple(document.value_place((*path, key, row)) for row in range(count))

    return Axis(
        keys=tuple(values),
        rows=tuple(zip(*values.values(), strict=True)),
        places=tuple(places(key, len(column)) for key, column in values.items()),
    )


def sources_of(
    document: Document, folder: Folder
) -> tuple[tuple[str, ...], list[Fault], list[str]]:
    """Single sources of the list `records`, in order, each once; what is wrong, and notes."""
    written = document.content.get("records")
    sources: list[str] = []
    faults: list[Fault] = []
    notes: list[str] = []
    for index, item in enumerate(written if isinstance(written, list) else ()):
        path: Path = ("records", index)
        try:
            read = _SOURCE.validate_python(item)
            patterns = [read] if isinstance(read, str) else _product(read, path)
            single, told = expanded(patterns, folder=folder)
            sources += single
            notes += [f"records: {text}" for text in told]
        except ValidationError:
            continue  # told key by key
        except (RecordError, ValueError) as error:
            faults.append(Fault(path, str(error)))
    notes += [f"records: {text}" for text in repeated(sources)]
    return tuple(dict.fromkeys(sources)), faults, [*dict.fromkeys(notes)]


def _product(pattern: RecordPattern, path: Path) -> list[str]:
    """Sources of a mapping: every option may have several values, the first varies slowest."""
    source, extra = pattern.source, pattern.model_extra or {}
    options = [[f"{key}={_text(value)}" for value in values] for key, values in extra.items()]
    if (count := math.prod(map(len, options))) > MOST_SOURCES:
        raise ValueError(
            f"{dotted(path)} stands for {count} ground motions, which must not be more than"
            f" {MOST_SOURCES}; use fewer values of its options"
        )
    mark = "&" if "?" in source and not source.endswith("?") else "?" * (not source.endswith("?"))
    return [
        f"{source}{mark if chosen else ''}{'&'.join(chosen)}"
        for chosen in itertools.product(*options)
    ]


def _text(value: object) -> str:
    """A value as an option is written: whole numbers without a fraction."""
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        return str(int(value))
    return str(value)
