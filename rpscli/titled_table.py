"""Tables that users give: a line of titles, `name [unit]`, over rows of cells.

The one reader of hazard curves, target spectra, observations, measurements and answers.
It takes what records take: cells between commas, semicolons or tabs, decimal commas where
commas do not separate, UTF-8 and UTF-16, units in square or round brackets, a first line
`sep=;` as spreadsheets write it, and remarks that begin with #.
"""

from __future__ import annotations

import csv
import io
import math
import re
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from rpscli.errors import RpsError, beginning

_TITLE = re.compile(r"\s*(.*?)\s*(?:[\[(]\s*([^\])]*?)\s*[\])])?\s*")
_DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+(?:[eE][+-]?\d+)?")
_SEPARATOR = re.compile(r'"?sep=(.)"?', re.IGNORECASE)

_UNITS = {
    **dict.fromkeys(("sec", "secs", "second", "seconds"), "s"),
    **dict.fromkeys(("msec", "millisecond", "milliseconds"), "ms"),
    **dict.fromkeys(("-", "1", "none"), ""),
}
"""Spellings of units in titles, beside those of `units`; a plain number has none."""


class Title(NamedTuple):
    """The title of a column: its name and its unit, empty without one."""

    name: str
    unit: str


class Row(NamedTuple):
    """A row: the number of its line, and its cells without blanks around them."""

    line: int
    cells: list[str]


@dataclass(frozen=True)
class TitledTable:
    """A table: where it is from, the line of its titles, the titles, and the rows."""

    source: str
    line: int
    titles: tuple[Title, ...]
    rows: tuple[Row, ...]
    written: str = ""  # the line of titles, cut
    remarks: tuple[
        tuple[int, str], ...
    ] = ()  # lines that begin with #, and their numbers

    @property
    def names(self) -> list[str]:
        """Names of all columns."""
        return [title.name for title in self.titles]


def text_of(data: bytes) -> str:
    """The text of a table: UTF-8, UTF-16 where it begins with its mark, else Latin-1."""
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return data.decode("utf-16")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:  # as spreadsheets write it in Western Europe
        return data.decode("latin-1")


def number_of(cell: str) -> float:
    """The number in a cell; NaN for what is none."""
    try:
        return float(cell)
    except ValueError:
        return math.nan


def titled_table(
    text: str, source: str | Path, fault: type[RpsError], *, remarks: bool = True
) -> TitledTable:
    """The table in a text; one without any line has no titles.

    With `remarks` lines that begin with # are left out. Raises `fault` for a quote that is
    not closed, and for titles that stand twice.
    """
    rows = _rows(text, source, fault, remarks=remarks)
    if not rows:
        return TitledTable(f"{source}", 1, (), ())
    first, *rest = rows
    titles = tuple(map(_title, first.cells))
    filled = (
        Row(line, cells + [""] * (len(titles) - len(cells))) for line, cells in rest
    )
    told = [
        (number, line.strip('" #'))
        for number, line in enumerate(text.removeprefix("\ufeff").splitlines(), 1)
        if remarks and _is_remark(line)
    ]
    written = beginning(",".join(first.cells))
    return TitledTable(
        f"{source}", first.line, titles, tuple(filled), written, tuple(told)
    )


def _is_remark(line: str) -> bool:
    return line.lstrip('" ').startswith("#")


def _rows(
    text: str, source: str | Path, fault: type[RpsError], *, remarks: bool
) -> list[Row]:
    """Rows that are not empty, that of the titles among them."""
    lines = text.removeprefix("\ufeff").splitlines()
    skipped = 0
    separator = ""
    if lines and (match := _SEPARATOR.fullmatch(lines[0].strip())):
        separator = match[1]
        skipped = 1
    body = ["" if remarks and _is_remark(line) else line for line in lines[skipped:]]
    head = next((line for line in body if line.strip()), "")
    separator = separator or _separator_of(head)
    reader = csv.reader(
        io.StringIO("\n".join(body)),
        delimiter=separator,
        skipinitialspace=True,
        strict=True,
    )
    try:
        rows = [
            Row(reader.line_num + skipped, _plain(cells, separator))
            for cells in reader
            if any(cell.strip() for cell in cells)
        ]
    except csv.Error as error:
        line = reader.line_num + skipped
        raise fault(
            f"{source}:{line}: is not CSV: {error}; is a quote not closed?"
        ) from None
    return rows


def _separator_of(head: str) -> str:
    """Separator of the cells of a line of titles, outside of brackets and quotes."""
    bare = re.sub(r"\"[^\"]*\"|\[[^\]]*\]|\([^)]*\)", "", head)
    return next((each for each in "\t;," if each in bare), "\t")  # one column


def _plain(cells: list[str], separator: str) -> list[str]:
    """Cells without blanks around them, decimal commas as points; none behind the last."""
    found = [cell.strip() for cell in cells]
    while found and not found[-1]:
        found.pop()
    if separator == ",":
        return found
    return [
        cell.replace(",", ".") if _DECIMAL_COMMA.fullmatch(cell) else cell
        for cell in found
    ]


def _title(cell: str) -> Title:
    match = _TITLE.fullmatch(cell)
    assert match is not None, "any text is a name"
    unit = match[2] or ""
    return Title(match[1], _UNITS.get(unit.lower(), unit))
