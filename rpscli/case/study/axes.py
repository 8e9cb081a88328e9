"""Factors of the product that a study is: axes of case keys, and record sources."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path as Folder
from typing import Any

from pydantic import ValidationError

from rpscli.case.schema.fields import is_finite
from rpscli.case.schema.keys import is_whole, unit
from rpscli.case.study.schema import PLUS, RecordPattern
from rpscli.case.text.document import Document, Fault, Path, Place, dotted
from rpscli.errors import RecordError, listed
from rpscli.records.loading import expanded, repeated
from rpscli.units import in_si

Values = tuple[Any, ...]

MOST_SOURCES = 100_000
"""Ground motions that the options of one pattern may stand for."""


@dataclass(frozen=True)
class Axis:
    """Keys that go together, a row of values for each position, and where each was written."""

    keys: tuple[str, ...]
    rows: tuple[Values, ...]
    places: tuple[tuple[Place, ...], ...]

    def place(self, key: int, row: int) -> Place:
        """Position of a value in the file."""
        places = self.places[key]
        return places[row] if len(places) == len(self.rows) else places[0]


Vary = Sequence[Mapping[str, Values]]
"""Columns of values by their keys, axis by axis."""


def unequal(document: Document, vary: Vary) -> list[Fault]:
    """Keys of one axis that have not equally many values."""
    return [
        Fault(
            ("vary", index, key),
            f"{key} has {len(columns[key])} values, but"
            f" {first}{document.where(('vary', index, first))} has {len(columns[first])}: the keys"
            " of one axis go together; give equally many, or begin another axis with `-`",
            at_key=True,
        )
        for index, columns in enumerate(vary)
        for first in [next(iter(columns))]
        for key in columns
        if len(columns[key]) != len(columns[first])
    ]


def axes_of(document: Document, vary: Vary) -> tuple[Axis, ...]:
    """Axes of a study whose columns are equally long."""
    axes = []
    for index, columns in enumerate(vary):
        places = []
        for key, of in columns.items():
            path: Path = ("vary", index, key)
            inside = [path] if isinstance(document.at(path), dict) else []  # a range
            inside = inside or [(*path, row) for row in range(len(of))]
            places.append(tuple(map(document.value_place, inside)))
        rows = tuple(zip(*columns.values(), strict=True))
        axes.append(Axis(tuple(columns), rows, tuple(places)))
    return tuple(axes)


DIGITS = 6
"""Of what is linked to other values: finer cannot be built, and files stay readable."""


def linked_value(key: str, terms: Mapping[str, float], values: Sequence[float]) -> float | int:
    """A linear sum of the values of its keys, as a case takes it."""
    factors = (factor for name, factor in terms.items() if name != PLUS)
    products = (factor * value for factor, value in zip(factors, values, strict=True))
    total = sum(products, terms.get(PLUS, 0.0))
    return round(total) if is_whole(key) else float(f"{total:.{DIGITS}g}")


def with_linked(
    axes: tuple[Axis, ...], linked: Mapping[str, Mapping[str, float]], document: Document
) -> tuple[Axis, ...]:
    """The axes with keys that are linear sums of others of theirs."""
    for key, terms in linked.items():
        path, names = ("linked", key), [name for name in terms if name != PLUS]
        axis = next((each for each in axes if names and {*names} <= {*each.keys}), None)
        if axis is None:
            text = f"linked.{key} needs {listed(names or ['a key'], 'and')}, which no axis of vary"
            document.refuse([Fault(path, f"{text} has; sums are of keys of one axis")])
            continue
        columns = [(axis.keys.index(name), unit(name)) for name in names]
        rows: list[list[Any]] = [[in_si(row[at], si) for at, si in columns] for row in axis.rows]
        if not all(map(is_finite, itertools.chain(*rows))):
            document.refuse([Fault(path, f"linked.{key} is a sum of numbers; {names} are not")])
        sums = (linked_value(key, terms, row) for row in rows)
        values = tuple((*old, new) for old, new in zip(axis.rows, sums, strict=True))
        longer = Axis((*axis.keys, key), values, (*axis.places, (document.value_place(path),)))
        axes = tuple(longer if each is axis else each for each in axes)
    return axes


def sources_of(
    document: Document, folder: Folder
) -> tuple[tuple[str, ...], list[Fault], list[str]]:
    """Single sources of the list `records`, in order, each once; what is wrong, and notes."""
    records = document.content.get("records")
    sources: list[str] = []
    faults: list[Fault] = []
    notes: list[str] = []
    for index, item in enumerate(records if isinstance(records, list) else ()):
        path: Path = ("records", index)
        try:
            single = isinstance(item, str) and item.strip()
            patterns = [item] if single else _product(RecordPattern.model_validate(item), path)
            expansion = expanded(patterns, folder=folder)
            sources += expansion.sources
            notes += [f"records: {text}" for text in expansion.notes]
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
    whole = isinstance(value, float) and value.is_integer() and abs(value) < 1e15
    return f"{value:.0f}" if whole else str(value)
