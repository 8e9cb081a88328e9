"""What was observed in tests or after earthquakes: the CSV file that a study may name."""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path as Folder
from typing import NamedTuple

from rpscli.analyses.result_quantities import LIMITED
from rpscli.case.schema.keys import unit as key_unit
from rpscli.case.study.axes import Axis
from rpscli.case.text.document import Document, Fault, Path, Place, shown
from rpscli.case.text.files import read_text
from rpscli.errors import CaseError, hint, listed
from rpscli.units import KINDS, in_si, si_value

RECORD, OVERTURNED = "record", "overturned"
PATH: Path = ("observed",)

_UNITS = {quantity.name: quantity.unit for quantity in LIMITED}
_YES = {"1": 1.0, "true": 1.0, "yes": 1.0, "0": 0.0, "false": 0.0, "no": 0.0}
_TITLE = re.compile(r"\s*([^\s\[]+)\s*(?:\[\s*([^\]]*?)\s*\])?\s*")
_UNITLESS = {"", "-", "1"}

Title = tuple[str, str]
"""Name and unit of a column."""


class Observation(NamedTuple):
    """One line: under which record, of which system, and what was seen.

    `system` are values of the keys as `comparable` has them; `values` are SI, 1 for overturned, and
    NaN where nothing was observed.
    """

    line: int
    record: str
    system: tuple[str, ...]
    values: tuple[float, ...]


@dataclass(frozen=True)
class Observed:
    """The whole file."""

    name: str
    keys: tuple[str, ...]
    quantities: tuple[str, ...]
    rows: tuple[Observation, ...]


def comparable(key: str, value: object) -> str:
    """A value of a varied key as text that is the same for the same value."""
    found = in_si(value, key_unit(key))
    try:
        return format(float(found), ".9g")  # type: ignore[arg-type]
    except (TypeError, ValueError):
        return str(found).strip()


def observed_of(
    document: Document, folder: Folder, axes: Sequence[Axis]
) -> tuple[Observed | None, list[Fault]]:
    """The observations that a study names, and what is wrong with them."""
    written = document.content.get("observed")
    if not isinstance(written, str):
        return None, []  # absent, or told with the other keys
    try:
        text = read_text(folder / written)
    except CaseError as error:
        return None, [Fault(PATH, f"observed: {error}")]
    lines = csv.reader(io.StringIO(text), skipinitialspace=True)
    try:
        rows = [(lines.line_num, row) for row in lines if any(cell.strip() for cell in row)]
    except csv.Error as error:
        return None, [_fault(written, lines.line_num, f"is not CSV: {error}")]
    if len(rows) < 2:
        return None, [Fault(PATH, f"observed: {written} must have a line of titles and more lines")]
    (first, heads), *rest = rows
    found = [(_TITLE.fullmatch(head), head.strip()) for head in heads]
    titles = [(match[1], match[2] or "") if match else (head, "") for match, head in found]
    known = [RECORD, "scale", *(key for axis in axes for key in axis.keys)]
    faults = list(_title_faults(written, first, titles, known))
    if not faults:
        observations = [_observation(written, line, titles, row) for line, row in rest]
        faults = [item for item in observations if isinstance(item, Fault)]
        seen = [item for item in observations if isinstance(item, Observation)]
        faults += _twice(written, seen)
    if faults:
        return None, faults
    names = [name for name, _ in titles]
    quantities = tuple(name for name in names if name in {OVERTURNED, *_UNITS})
    keys = tuple(name for name in names if name not in {RECORD, *quantities})
    return Observed(written, keys, quantities, tuple(seen)), []


def _fault(name: str, line: int, text: str) -> Fault:
    return Fault(PATH, text, place=Place(name, line, 1, rank=1))


def _title_faults(
    name: str, line: int, titles: Sequence[Title], known: Sequence[str]
) -> Iterator[Fault]:
    """Columns that are missing, unknown or twice there, and units of another kind."""
    names = [name for name, _ in titles]
    results = [OVERTURNED, *_UNITS]
    if RECORD not in names:
        yield _fault(name, line, "has no column `record`, which names the ground motion; add it")
        return  # another file than was meant, of which nothing is told
    if not set(names) & set(results):
        yield _fault(
            name, line, f"has no column of what was observed; add one of {listed(results)}"
        )
    for place, (column, unit) in enumerate(titles):
        if column in names[:place]:
            yield _fault(name, line, f"the column {shown(column)} appears twice; remove one")
        if column not in (*known, *results):
            varied = f"the study varies {listed(known, 'and')}"
            suggestion = hint(column, (*known, *results), varied)
            yield _fault(
                name, line,
                f"the column {shown(column)} is neither a varied key nor a result; {suggestion}",
            )  # fmt: skip
        elif (reason := _wrong_unit(column, unit)) is not None:
            yield _fault(name, line, f"{shown(column)} [{unit}] {reason}")


def _unit(column: str) -> str:
    """SI unit of a column."""
    return _UNITS[column] if column in _UNITS else key_unit(column)


def _wrong_unit(column: str, unit: str) -> str | None:
    if unit in _UNITLESS:
        return None
    si = _unit(column)
    if si not in KINDS:
        return "must have no unit; remove it"
    try:
        si_value(f"1 {unit}", si)
    except ValueError as error:
        return str(error)
    return None


def _observation(
    name: str, line: int, titles: Sequence[Title], row: Sequence[str]
) -> Observation | Fault:
    """A line, or what is wrong with it."""
    if len(row) != len(titles):
        return _fault(name, line, f"has {len(row)} cells and {len(titles)} titles; make them equal")
    record, system, values = "", [], []
    for (column, unit), cell in zip(titles, map(str.strip, row), strict=True):
        if column == RECORD:
            record = cell
        elif column == OVERTURNED or column in _UNITS:
            value = _value(column, unit, cell)
            if isinstance(value, str):
                return _fault(name, line, f"{column} = {shown(cell)} {value}")
            values.append(value)
        else:
            written = cell if unit in _UNITLESS else f"{cell} {unit}"
            system.append(comparable(column, written))
    return Observation(line, record, tuple(system), tuple(values))


def _value(column: str, unit: str, cell: str) -> float | str:
    """A value in SI units, NaN for an empty cell; else what is wrong with it."""
    if not cell:
        return math.nan
    if column == OVERTURNED:
        return _YES.get(cell.lower(), "must be 1 or 0, true or false, yes or no; empty: not seen")
    try:
        value = float(cell)
    except ValueError:
        value = math.nan
    if not (math.isfinite(value) and value >= 0.0):
        return "must be a number >= 0: the largest value without its sign; empty: not measured"
    return value if unit in _UNITLESS else value * si_value(f"1 {unit}", _unit(column))


def _twice(name: str, rows: Sequence[Observation]) -> Iterator[Fault]:
    """Lines of the same record and system."""
    seen: dict[tuple[object, ...], int] = {}
    for row in rows:
        before = seen.setdefault((row.record, row.system), row.line)
        if before != row.line:
            text = f"{shown(row.record)} of this system is already in line {before}"
            yield _fault(name, row.line, f"{text}; remove one, or add a column that differs")
