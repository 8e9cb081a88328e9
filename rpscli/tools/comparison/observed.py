"""Observations in tests or after earthquakes: the CSV file that a study may name."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path as Folder
from typing import NamedTuple

from rpscli.analyses.result_quantities import LIMITED
from rpscli.case.schema.keys import unit as key_unit
from rpscli.case.study.schema import Axis
from rpscli.case.text.document import Document, Fault, Path, Position, shown
from rpscli.case.text.files import read_text
from rpscli.errors import CaseError, hint, listed
from rpscli.titled_table import titled_table
from rpscli.units import KINDS, in_si, si_value

RECORD = "record"
OVERTURNED = "overturned"
PATH: Path = ("observed",)

_UNITS = {OVERTURNED: "-"} | {quantity.name: quantity.unit for quantity in LIMITED}
"""SI units of what may be observed."""
_YES = {"1": 1.0, "true": 1.0, "yes": 1.0, "0": 0.0, "false": 0.0, "no": 0.0}


class Observation(NamedTuple):
    """One line: under which record, of which system, and what was seen.

    `system` are values of the keys as `comparable` has them; `values` are SI, 1 for
    overturned, and NaN where nothing was observed.
    """

    line: int
    record: str
    system: tuple[str, ...]
    values: tuple[float, ...]


class Observed(NamedTuple):
    """The whole file."""

    name: str
    keys: tuple[str, ...]
    quantities: tuple[str, ...]
    rows: tuple[Observation, ...]


class _Column(NamedTuple):
    """A title: name and unit, which is empty for SI and plain numbers."""

    name: str
    unit: str

    @property
    def si_unit(self) -> str:
        return _UNITS.get(self.name) or key_unit(self.name)

    def value(self, cell: str) -> float:
        """The observed value, in SI units; NaN for an empty cell."""
        if not cell:
            return math.nan
        if self.name == OVERTURNED:
            if cell.lower() not in _YES:
                raise ValueError(
                    "must be 1 or 0, true or false, yes or no; empty: not seen"
                )
            return _YES[cell.lower()]
        value = math.nan
        with suppress(ValueError):
            value = float(cell)
        if not 0.0 <= value < math.inf:
            raise ValueError(
                "must be a number >= 0: the largest value without its sign; empty: not"
                " measured"
            )
        return value * si_value(f"1 {self.unit}", self.si_unit) if self.unit else value


def comparable(key: str, value: object) -> str:
    """A value of a varied key as text that is the same for the same value."""
    si = in_si(value, key_unit(key))
    try:
        return format(float(si), ".9g")  # type: ignore[arg-type]
    except (TypeError, ValueError):
        return str(si).strip()


def read_observed(
    name: str | None, folder: Folder, axes: Sequence[Axis], document: Document
) -> Observed | None:
    """The observations that a study names; the document refuses
    what is wrong with them.
    """
    if name is None:
        return None
    try:
        table = titled_table(read_text(folder / name, wide=True), name, CaseError)
    except CaseError as error:
        raise document.refusal([Fault(PATH, f"observed: {error}")]) from None
    if not table.rows:
        text = f"observed: {name} must have a line of titles and more lines"
        raise document.refusal([Fault(PATH, text)])
    columns = [_Column(*title) for title in table.titles]
    known = [RECORD, "scale", *(key for axis in axes for key in axis.keys)]
    document.refuse(
        _fault(name, table.line, text) for text in _title_faults(columns, known)
    )
    faults = []
    seen = dict[tuple[object, ...], Observation]()
    for line, row in table.rows:
        try:
            new = _observation(line, columns, row)
            before = seen.setdefault((new.record, new.system), new)
            if before is not new:
                text = (
                    f"{shown(new.record)} of this system is already in line {before.line}"
                )
                raise ValueError(f"{text}; remove one, or add a column that differs")  # noqa: TRY301
        except ValueError as error:
            faults.append(_fault(name, line, str(error)))
    document.refuse(faults)
    names = [column.name for column in columns]
    quantities = tuple(each for each in names if each in _UNITS)
    keys = tuple(each for each in names if each not in {RECORD, *quantities})
    return Observed(name, keys, quantities, tuple(seen.values()))


def _fault(name: str, line: int, text: str) -> Fault:
    return Fault(PATH, text, place=Position(name, line, 1, rank=1))


def _title_faults(columns: Sequence[_Column], known: Sequence[str]) -> Iterator[str]:
    """Columns that are missing, unknown or twice there, and units of another kind."""
    names = [column.name for column in columns]
    if RECORD not in names:
        yield "has no column `record`, which names the ground motion; add it"
        return  # another file than was meant, of which nothing is told
    if not _UNITS.keys() & {*names}:
        yield f"has no column of what was observed; add {OVERTURNED}, or a result"
    for place, column in enumerate(columns):
        if column.name in names[:place]:
            yield f"the column {shown(column.name)} appears twice; remove one"
        if column.name not in (*known, *_UNITS):
            varied = f"the study varies {listed(known, 'and')}"
            suggestion = hint(column.name, (*known, *_UNITS), varied)
            text = "is neither a varied key nor a result"
            yield f"the column {shown(column.name)} {text}; {suggestion}"
        elif column.unit:
            try:
                if (si := column.si_unit) not in KINDS:
                    raise ValueError("must have no unit; remove it")  # noqa: TRY301
                si_value(f"1 {column.unit}", si)
            except ValueError as error:
                yield f"{shown(column.name)} [{column.unit}] {error}"


def _observation(
    line: int, columns: Sequence[_Column], row: Sequence[str]
) -> Observation:
    """A line; raises ValueError with what is wrong with it."""
    if len(row) != len(columns):
        raise ValueError(
            f"has {len(row)} cells and {len(columns)} titles; make them equal"
        )
    record = ""
    system = []
    values = []
    for column, cell in zip(columns, map(str.strip, row), strict=True):
        if column.name == RECORD:
            record = cell
        elif column.name in _UNITS:
            try:
                values.append(column.value(cell))
            except ValueError as error:
                raise ValueError(f"{column.name} = {shown(cell)} {error}") from None
        else:
            system.append(comparable(column.name, f"{cell} {column.unit}".strip()))
    return Observation(line, record, tuple(system), tuple(values))
