"""Plain columns of numbers: time and acceleration, or acceleration alone.

Read are `dt: 0.005` or `time step = 0.005 s`, `units: g`, `npts: 4000`, and titles of columns such
as `Time (s), Acceleration (m/s2)`, in any line before the first number. What they leave out (units;
for one column also the sampling interval) the user has to give.
"""

from __future__ import annotations

import re
from array import array
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rpscli.records.formats.record_text import RecordText, printed_resolution, uniform_step
from rpscli.records.formats.statements import (
    STATED_PATTERN,
    Statement,
    agreed,
    stated_count,
    stated_positive,
)
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.quantities import (
    KNOWN_UNITS,
    UNIT_PATTERN,
    canonical_unit,
    numbers_in,
    numerals_in,
    why_no_numbers,
)

_STEP = re.compile(rf"\b(?:dt|time\s*step)\b\s*[=:]\s*({STATED_PATTERN})", re.IGNORECASE)
_COUNT = re.compile(r"\b(?:npts|ndata)\b\s*[=:]\s*([0-9]+)", re.IGNORECASE)
_UNITS_KEY = re.compile(r"\bunits?\b\s*(?:[=:]|(?:of|in|are|is)\b)\s*([^,;]+)", re.IGNORECASE)
_COLUMN_TITLE = re.compile(
    rf"\b(?:acc|accel|acceleration|ag|a)[\s_]*(?:[\[(]|\bin\b)\s*({UNIT_PATTERN})", re.IGNORECASE
)
_OTHER_TITLE = re.compile(
    r"\b(?:(vel|velocity)|disp|displacement)[\s_]*[\[(]\s*(?:[cm]?m|in|ft)\b", re.IGNORECASE
)


@dataclass(frozen=True)
class _Table:
    header: tuple[Statement, ...]  # lines of text before the first number
    values: NDArray[np.float64]  # (numbers,) of all rows, one after the other
    widths: NDArray[np.int64]  # (rows,) numbers of each
    lines: NDArray[np.int64]  # (rows,) of the file


def recognises_columns(text: RecordText) -> bool:
    """Whether most lines, and the last that is no comment, hold nothing but numbers."""
    body = [line for line in text.lines if line.strip() and not _is_comment(line)]
    numeric = sum(1 for line in body if numbers_in(line))
    return numeric >= 2 and 2 * numeric > len(body) and bool(numbers_in(body[-1]))


def read_columns(text: RecordText) -> GroundMotion:
    """Read one or two columns, or rows of a bare AT2 body when `dt` and `units` are known."""
    text.single_channel()
    table = _table(text)
    _check_count(text, table)
    widths = np.unique(table.widths).tolist()
    if widths == [2]:
        return _two_columns(text, table)
    if widths == [1]:
        return _sequence(text, table)
    return _wrapped_rows(text, table)


def _is_comment(line: str) -> bool:
    return line.lstrip().startswith(("#", "%", "!", "//", "*", "|"))


def _table(text: RecordText) -> _Table:
    header: list[Statement] = []
    values, widths, lines = array("d"), array("q"), array("q")  # of records there may be millions
    for index, line in enumerate(text.lines):
        row = numbers_in(line)
        if row:
            values.extend(row)
            widths.append(len(row))
            lines.append(index)
        elif not widths:
            words = text.heads[index].strip().lstrip("#%!/*|").strip()
            header.append(Statement("header", words, index))
        elif row is None and not _is_comment(line):
            raise text.fault(
                f"{line.strip()[:40]!r} stands among the values and is not a row of finite "
                f"numbers{why_no_numbers(line)}; begin comments with #",
                index,
            )
    if len(widths) < 2:
        for index, line in enumerate(text.heads):
            if why := why_no_numbers(line):
                raise text.fault(f"{line.strip()[:40]!r} is not a row of numbers{why}", index)
        raise text.fault(
            f"no known format of ground motions: {len(widths)} row(s) of numbers; export the "
            f"record as PEER AT2, or as columns of time and acceleration"
        )
    return _Table(
        tuple(line for line in header if line.value),
        np.array(values),
        np.array(widths),
        np.array(lines),
    )


def _check_count(text: RecordText, table: _Table) -> None:
    stated = agreed(text, _found(table.header, _COUNT, "npts"), stated_count)
    count = None if stated is None else stated_count(text, stated)
    found = table.values.size
    if count is not None and count not in (found, table.widths.size):
        raise text.fault(
            f"the header announces {count} values and the file holds {table.widths.size} row(s)"
            f" and {found} number(s); fetch it again, or correct the header"
        )


def _two_columns(text: RecordText, table: _Table) -> GroundMotion:
    unit, factor = text.agreed_factor(_stated_units(text, table.header), _first_line(table))
    values = table.values.reshape(-1, 2)
    numerals = (numerals_in(text.lines[line])[0] for line in table.lines)
    resolution = printed_resolution(values[:, 0], numerals)
    try:
        step = uniform_step(values[:, 0], resolution)
    except ValueError as error:
        raise text.fault(
            f"two columns should be time and acceleration at a uniform step, but {error}"
        ) from error
    header_step = _stated_step(text, table.header)
    # Rounded times know the step to one unit of their last digit over the whole record.
    coarsest = float(resolution.max())
    known_to = max(1e-6, 2.0 * coarsest / (step * table.widths.size))
    if header_step is not None and abs(header_step - step) > known_to * step:
        raise text.fault(
            f"the header says dt = {header_step:g} s and the times advance by {step:g} s; "
            f"correct the one or the other"
        )
    dt = text.agreed_dt(step, known_to)
    warnings: tuple[str, ...] = ()
    if abs(values[0, 0]) > 0.5 * coarsest:
        warnings = (f"times begin at {values[0, 0]:g} s; taken as the record's zero",)
    return GroundMotion(
        values[:, 1] * factor,
        dt,
        text.name,
        text.source,
        "two-column text",
        _description(table, unit),
        warnings,
    )


def _sequence(text: RecordText, table: _Table, *warnings: str) -> GroundMotion:
    unit, factor = text.agreed_factor(_stated_units(text, table.header), _first_line(table))
    dt = text.agreed_dt(_stated_step(text, table.header))
    values = table.values
    _refuse_leading_header(text, table, values)
    if values[0] == dt:
        warnings = (*warnings, f"the first value, {dt:g}, equals dt: see that it is not a header")
    return GroundMotion(
        values * factor,
        dt,
        text.name,
        text.source,
        "one-column text",
        _description(table, unit),
        warnings,
    )


def _refuse_leading_header(text: RecordText, table: _Table, values: NDArray[np.float64]) -> None:
    # A whole number before decimal ones is a count or a flag: 4000, or 1 and then the time step.
    numerals = [word for line in table.lines[:2] for word in numerals_in(text.lines[line])]
    flagged = values[0] != 0.0 and numerals[0].isdigit() and not numerals[1].isdigit()
    if flagged or values[0] == values.size - 1 or values[1] == values.size - 2 > 0:
        raise text.fault(
            f"the first numbers, {numerals[0]} and {numerals[1]}, look like a header (a count or "
            f"the time step), not like accelerations; remove them or begin their lines with #",
            int(table.lines[0]),
        )


def _wrapped_rows(text: RecordText, table: _Table) -> GroundMotion:
    width = int(table.widths[0])
    ragged = np.flatnonzero(table.widths[:-1] != width)
    if ragged.size or table.widths[-1] > width:
        bad = int(ragged[0]) if ragged.size else table.widths.size - 1
        raise text.fault(
            f"a row of {table.widths[bad]} numbers among rows of {width}; every row but the "
            f"last must be full: fetch the file again",
            int(table.lines[bad]),
        )
    first = table.values[::width]
    if width == 2 or (first.size > 2 and bool(np.all(np.diff(first) > 0.0))):
        raise text.fault(
            f"rows of {width} numbers whose first one increases look like time and several "
            f"quantities; keep time and acceleration"
        )
    note = f"rows of {width} numbers were read one after the other"
    return _sequence(text, table, note)


def _first_line(table: _Table) -> str:
    return table.header[0].value if table.header else ""


def _description(table: _Table, unit: str) -> str:
    return f"{_first_line(table)[:100] or 'no header'}; values in {unit}"


def _found(header: Sequence[Statement], pattern: re.Pattern[str], name: str) -> list[Statement]:
    return [
        Statement(name, value, line.line)
        for line in header
        for value in pattern.findall(line.value)
    ]


def _stated_step(text: RecordText, header: Sequence[Statement]) -> float | None:
    """The time step that the header states [s]; two different ones are refused."""
    step = agreed(text, _found(header, _STEP, "dt"), stated_positive)
    return None if step is None else stated_positive(text, step)


def _stated_units(text: RecordText, header: Sequence[Statement]) -> str | None:
    """The canonical unit of acceleration that the header states."""
    units: set[str] = set()
    for line in header:
        for key in _UNITS_KEY.finditer(line.value):
            units.add(_unit_after_key(text, key[0], key[1], line.line))
        for title in _COLUMN_TITLE.findall(line.value):
            if unit := canonical_unit(title):
                units.add(unit)
    if len(units) > 1:
        raise text.fault(
            f"the header states different units: {', '.join(sorted(units))}; correct the header"
        )
    if not units:
        _refuse_other_quantities(text, header)
    return units.pop() if units else None


def _refuse_other_quantities(text: RecordText, header: Sequence[Statement]) -> None:
    for line in header:
        if title := _OTHER_TITLE.search(line.value):
            raise text.fault(
                f"the header says {line.value[:60]!r}: this is a"
                f" {'velocity' if title[1] else 'displacement'} record; give the acceleration"
                " record of the same station",
                line.line,
            )


def _unit_after_key(text: RecordText, statement: str, spelling: str, line: int) -> str:
    word = re.match(rf"[\s(\[]*({UNIT_PATTERN})", spelling, re.IGNORECASE)
    unit = canonical_unit(word[1]) if word else None
    if unit is None:
        raise text.fault(
            f"the header says {statement.strip()[:60]!r}, which is not a unit of acceleration that"
            f" is known ({KNOWN_UNITS}); correct the header",
            line,
        )
    return unit
