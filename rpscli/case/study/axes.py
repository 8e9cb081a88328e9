"""What a study multiplies: its axes of case keys, and its record sources."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path as Folder
from typing import Any, NamedTuple

from rpscli.case.schema.check import schema_check
from rpscli.case.study.schema import ValueRange, spaced
from rpscli.case.text.document import Document, Fault, Path, Place, dotted, shown
from rpscli.errors import RecordError, listed
from rpscli.records.source import expand_sources

Values = tuple[Any, ...]

MOST_SOURCES = 100_000
"""Ground motions that the options of one pattern may stand for."""


@dataclass(frozen=True)
class Axis:
    """One axis of the product.

    Parameters
    ----------
    keys
        Dotted keys of the case that go together.
    rows
        Their values at each position along the axis, in the order of the keys.
    places
        Where the values of each key were written: one place for each row, or one for all.
    """

    keys: tuple[str, ...]
    rows: tuple[Values, ...]
    places: tuple[tuple[Place, ...], ...]

    def place(self, key: int, row: int) -> Place:
        """Where a value was written."""
        places = self.places[key]
        return places[row] if len(places) == len(self.rows) else places[0]


class AxisCheck(NamedTuple):
    """The axes as far as they can be read, and what is wrong with them."""

    axes: list[Axis]
    faults: list[Fault]


def axes_of(document: Document) -> AxisCheck:
    """Axes under the key `vary` of a study."""
    written = document.content.get("vary", [])
    check = AxisCheck([], [])
    if not isinstance(written, list):
        text = "vary must be a list of axes, each a mapping: `- dotted.key: [value, value]`"
        return check._replace(faults=[Fault(("vary",), text)])
    for index, item in enumerate(written):
        path: Path = ("vary", index)
        if not isinstance(item, dict) or not item:
            text = f"{dotted(path)} = {shown(item)} must be a mapping `dotted.key: [value, value]`"
            check.faults.append(Fault(path, text))
            continue
        values = {}
        for key, row in item.items():
            found = _values(document, (*path, key), row)
            check.faults.extend(fault for fault in found if isinstance(fault, Fault))
            values[key] = tuple(value for value in found if not isinstance(value, Fault))
        if not any(fault.path[:2] == path for fault in check.faults):
            check.faults.extend(_unequal(document, path, values))
            if len({len(column) for column in values.values()}) == 1:
                check.axes.append(_axis(document, path, values))
    return check


def _values(document: Document, path: Path, written: object) -> list[Any]:
    """The values of one key, or the faults among them."""
    key = dotted(path)
    if isinstance(written, dict):
        faults = part_faults(document, path)
        if faults:
            return list(faults)
        try:
            return list(spaced(ValueRange.model_validate(written)))
        except ValueError as error:
            return [Fault(path, f"{key}: {error}")]
    if not isinstance(written, list) or not written:
        text = f"{key} = {shown(written)} must be a list of values, or {{low, high, count}}"
        return [Fault(path, text)]
    empty = [i for i, value in enumerate(written) if value is None]
    if empty:
        return [Fault((*path, i), f"{key}.{i} has no value; write one") for i in empty]
    return list(written)


def part_faults(document: Document, path: Path) -> list[Fault]:
    """Faults of a mapping that must be a range of values, with their whole paths."""
    return [
        Fault((*path, *f.path), f"{dotted(path)}.{f.text}", f.at_key)
        for f in schema_check(ValueRange, document.part(*path)).faults
    ]


def _unequal(document: Document, path: Path, values: Mapping[str, Values]) -> Iterator[Fault]:
    """The keys of one axis need equally many values."""
    first, *others = values
    for key in others:
        if len(values[key]) != len(values[first]):
            yield Fault(
                (*path, key),
                f"{key} has {len(values[key])} values, but"
                f" {first}{document.where((*path, first))} has {len(values[first])}: the keys of"
                " one axis go together; give equally many, or begin another axis with `-`",
                at_key=True,
            )


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


def clashes(keys: Mapping[str, Path]) -> Iterator[Fault]:
    """A key that varies twice, or together with a part of itself."""
    names = sorted(keys)
    for name in names:
        inside = [other for other in names if other.startswith(f"{name}.")]
        if inside:
            text = f"{name} varies as a whole; {listed(inside, 'and')} inside it must not vary too"
            yield Fault(keys[name], text, at_key=True)


def sources_of(document: Document, folder: Folder) -> tuple[tuple[str, ...], list[Fault]]:
    """Single sources of the list `records`, in order, each once; and what is wrong with it.

    Whether a source exists is seen here; whether it can be read is seen when it is.
    """
    written = document.content.get("records")
    if written is None:
        return (), []
    if not isinstance(written, list) or not written:
        text = f"records = {shown(written)} must be a list of sources, as in [fema_p695:*]"
        return (), [Fault(("records",), text)]
    sources: list[str] = []
    faults: list[Fault] = []
    for index, item in enumerate(written):
        path: Path = ("records", index)
        try:
            patterns = [item] if isinstance(item, str) else _product(item, path)
            sources += expand_sources(patterns, folder=folder)
        except (RecordError, ValueError) as error:
            faults.append(Fault(path, str(error)))
    return tuple(dict.fromkeys(sources)), faults


def _product(item: object, path: Path) -> list[str]:
    """Sources of a mapping: every option may have several values, the first varies slowest."""
    source = item.get("source") if isinstance(item, dict) else None
    if not isinstance(item, dict) or not isinstance(source, str):
        raise ValueError(  # noqa: TRY004 -- a fault of the file, not of the program
            f"{dotted(path)} = {shown(item)} must be a source, or a mapping with a source and"
            " options: {source: 'pulse:sine?amplitude=1 g', period: [0.5, 1]}"
        )
    options = [
        [f"{key}={_text(value)}" for value in _several(value, (*path, key))]
        for key, value in item.items()
        if key != "source"
    ]
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


def _several(value: object, path: Path) -> list[object]:
    if isinstance(value, dict):
        try:
            return list(spaced(ValueRange.model_validate(value)))
        except ValueError:
            raise ValueError(
                f"{dotted(path)} = {shown(value)} is no range {{low, high, count, spacing}}"
            ) from None
    values = value if isinstance(value, list) else [value]
    if not values or not all(isinstance(v, int | float | str) for v in values):
        raise ValueError(f"{dotted(path)} = {shown(value)} must be a value or a list of values")
    return list(values)


def _text(value: object) -> str:
    """A value as an option is written: whole numbers without a fraction.

    >>> _text(20.0), _text(0.5), _text("0.4 g")
    ('20', '0.5', '0.4 g')
    """
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        return str(int(value))
    return str(value)
