"""Rows of numbers of a plain file, with the lines above them."""

from __future__ import annotations

import re
from array import array
from dataclasses import dataclass, field
from typing import NamedTuple, NoReturn

import numpy as np
from numpy.typing import NDArray

from rpscli.records.formats.record_text import Array, RecordText
from rpscli.records.formats.statements import Statement, statements
from rpscli.records.quantities import numbers_in, numerals_in, why_no_numbers

COUNT_PATTERN = (
    r"\b(?:npts|ndata|number of (?:data|points|samples|values))\b\s*[=:]\s*"
    r"([0-9]{1,3}(?:,[0-9]{3})+(?![0-9])|[0-9]+)"
)


class Table(NamedTuple):
    """Lines of text before the first number, numbers of all rows, one
    after the other, and rows.

    Of rows the number of values and the line of the file; `above` is the line
    of the words above the first number, but for rulers, `announced` the
    number of values or rows.
    """

    header: tuple[Statement, ...]
    values: Array
    widths: NDArray[np.int64]
    lines: NDArray[np.int64]
    above: int
    announced: int | None

    @property
    def words(self) -> str:
        """The first line of the header."""
        return self.header[0].value[:100] if self.header else "no header"


_QUOTED_COMMA = re.compile(r'"\s*([+-]?\d*),(\d+(?:[eE][+-]?\d+)?)\s*"')
_CLOCK = re.compile(
    r"^\s*\"?(?:(?:\d{4}[-/]\d{1,2}[-/]\d{1,2}|\d{1,2}[./]\d{1,2}[./]\d{4})[ T])?"
    r"(?:(\d{1,2}):(\d{2}):(\d{2})([.,]\d+)?|()(\d{1,2}):(\d{2})([.,]\d+))Z?\"?"
    r"(?=[\s,;]+[-+.\d])"
)


def plain_line(line: str) -> str:
    """A line of numbers without quotes, between blanks where ; or tabs part them.

    Commas are decimal ones then, and in quotes; a clock time before other numbers is one
    of seconds.
    """
    if ":" in line and (match := _CLOCK.match(line)):
        own = match.groups()[:4] if match[1] else match.groups()[4:]
        hour, minute, second = (int(each or 0) for each in own[:3])
        part = (own[3] or "").replace(",", ".")
        line = f"{3600 * hour + 60 * minute + second}{part}{line[match.end() :]}"
    if '"' in line:
        line = _QUOTED_COMMA.sub(r"\1.\2", line).replace('"', " ")
    if (";" in line or "\t" in line) and not re.search("[A-Za-z]{2}", line):
        return re.sub(r"(?<=\d),(?=\d)", ".", line).replace(";", " ").replace("\t", " ")
    return line


def is_comment(line: str) -> bool:
    """True of a line that begins like a comment."""
    return line.lstrip().startswith(("#", "%", "!", "//", "*", "|"))


@dataclass
class _Rows:
    """A table while it is read: of rows and their values there may be millions."""

    header: list[Statement] = field(default_factory=list)
    values: array[float] = field(default_factory=lambda: array("d"))
    widths: array[int] = field(default_factory=lambda: array("q"))
    lines: array[int] = field(default_factory=lambda: array("q"))
    above: int = -1


def table_of(text: RecordText) -> Table:
    """The rows of numbers of a text, held against what its header announces."""
    rows = _rows(text)
    widths = rows.widths
    following = {*widths[1:-1]}
    if len(widths) > 3 and widths[0] == 2 and len(following) == 1 and following != {2}:
        _move_count_and_step(text, rows)
    if len(widths) > 3 and widths[0] > 1 and {*widths} == {widths[0]}:
        _move_numbers_of_columns(text, rows)
    if len(widths) < 2:
        _refuse_without_rows(text, rows)

    kept = tuple(line for line in rows.header if line.value)
    said = statements("npts", COUNT_PATTERN, ((of.line, of.value) for of in kept))
    values = rows.values
    if (announced := text.agreed(said, text.count)) not in (
        None,
        len(values),
        len(widths),
    ):
        raise text.fault(
            f"the header announces {announced} values and the file holds {len(widths)}"
            f" row(s) and {len(values)} number(s); fetch it again, or correct the header"
        )
    return Table(
        kept,
        np.array(values),
        np.array(widths),
        np.array(rows.lines),
        rows.above,
        announced,
    )


def _rows(text: RecordText) -> _Rows:
    """Rows of numbers, with the lines above the first of them."""
    rows = _Rows()
    for index, line in enumerate(text.lines):
        row = numbers_in(plain_line(line))
        if row:
            rows.values.extend(row)
            rows.widths.append(len(row))
            rows.lines.append(index)
        elif not rows.widths:
            words = text.heads[index].strip().lstrip("#%!/*|").strip()
            rows.header.append(Statement("header", words, index))
            if any(map(str.isalpha, words)):
                rows.above = index
            elif not line.strip():
                rows.above = -1
        elif row is None and not is_comment(line):
            raise text.fault(
                f"{line.strip()[:40]!r} stands among the values and is not a row of"
                f" finite numbers{why_no_numbers(line)}; begin comments with #",
                index,
            )
    if len(rows.widths) == 1 and rows.widths[0] >= FEWEST_IN_A_LINE:
        _part(rows)
    return rows


FEWEST_IN_A_LINE = 16
"""Values of a record that stands in one line."""


def _part(rows: _Rows) -> None:
    """Make of one line of values as many rows of one."""
    count = rows.widths[0]
    rows.widths = array("q", [1] * count)
    rows.lines = array("q", [rows.lines[0]] * count)


def blank_within(text: RecordText, table: Table) -> list[str]:
    """A doubt about blank lines that part the values, as two records in one file do."""
    behind = np.flatnonzero(np.diff(table.lines) > 1)
    blank = [
        int(table.lines[place])
        for place in behind
        if not text.lines[int(table.lines[place]) + 1].strip()
    ]
    if not blank:
        return []
    doubt = f"a blank line behind line {blank[0] + 1} parts the values, which are read as"
    return [f"{doubt} one record: keep one record in a file"]


def _move_count_and_step(text: RecordText, rows: _Rows) -> None:
    """Take a first row, of the count of values and their step, to the header."""
    line = rows.lines[0]
    one, other = numerals_in(text.lines[line])
    count, step = (one, other) if one.isdigit() else (other, one)
    following = len(rows.values) - 2
    if not (count.isdigit() and int(count) == following):
        raise text.fault(
            f"{one} and {other} look like the number of values and their step, but"
            f" {following} values follow; correct them, or begin their line"
            " with #",
            line,
        )
    rows.header.append(Statement("count and step", f"npts: {count}, dt: {step}", line))
    del rows.values[:2], rows.widths[0], rows.lines[0]


def _move_numbers_of_columns(text: RecordText, rows: _Rows) -> None:
    """Take a first row 1, 2, 3 above decimal numbers to the header: it has titles."""
    width = rows.widths[0]
    above, below = (numerals_in(text.lines[line]) for line in rows.lines[:2])
    if above != [f"{i + 1}" for i in range(width)] or all(map(str.isdigit, below)):
        return
    rows.above = rows.lines[0]
    rows.header.append(Statement("header", text.lines[rows.above].strip(), rows.above))
    del rows.values[:width], rows.widths[0], rows.lines[0]


def _refuse_without_rows(text: RecordText, rows: _Rows) -> NoReturn:
    """Refuse a text with fewer than two rows of numbers, at what is nearly one."""
    odd = next((i for i, line in enumerate(text.heads) if why_no_numbers(line)), None)
    if odd is not None:
        line = text.heads[odd]
        why = why_no_numbers(line)
        raise text.fault(f"{line.strip()[:40]!r} is not a row of numbers{why}", odd)
    raise text.fault(
        f"no known format of ground motions: {len(rows.widths)} row(s) of numbers; export"
        " the record as PEER AT2, or as columns of time and acceleration"
    )
