"""The rows of a series: exactly what the header announces, and then what may follow."""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from rpscli.records.formats.record_text import RecordText
from rpscli.records.quantities import numbers_in, why_no_numbers


def series(
    text: RecordText,
    start: int,
    count: int,
    *,
    width: int | None = None,
    stop: int | None = None,
    closed_by: re.Pattern[str] | None = None,
) -> NDArray[np.float64]:
    """The numbers of consecutive lines; blank lines are skipped.

    Parameters
    ----------
    text : RecordText
        The file.
    start : int
        First line, counted from zero.
    count : int
        How many numbers there must be, exactly.
    width : int, optional
        Numbers of a row, the last one excepted; else as many as the first row has.
    stop : int, optional
        Line before which the series must end, counted from zero; else the end of the file.
    closed_by : pattern, optional
        What a line begins with that may follow the series; else nothing may.

    Returns
    -------
    array, shape (count,)

    Raises
    ------
    RecordError
        If there are fewer or more numbers, a row is not full, or other text follows.
    """
    rows: list[tuple[int, list[float]]] = []
    found = 0
    end = len(text.lines) if stop is None else min(stop, len(text.lines))
    for index in range(start, end):
        line = text.lines[index]
        row = numbers_in(line)
        if row is None:
            if closed_by is not None and closed_by.match(line):
                end = index
                break
            raise _foreign_line(text, index, found, count)
        if row:
            rows.append((index, row))
            found += len(row)
    if found != count:
        raise text.fault(
            f"the header announces {count} values, but there are {found} up to"
            f" {'the end' if end >= len(text.lines) else f'line {end}'}; the file is damaged,"
            " fetch it again"
        )
    _refuse_ragged(text, rows, width or len(rows[0][1]))
    return np.array([value for _, row in rows for value in row])


def _foreign_line(text: RecordText, index: int, found: int, count: int) -> Exception:
    line = text.lines[index].strip()[:40]
    if found >= count:
        return text.fault(
            f"the header announces {count} values, and after {found} follows {line!r}; keep one"
            " record in a file",
            index,
        )
    return text.fault(
        f"found {found} of the {count} values that the header announces, then {line!r}"
        f"{why_no_numbers(text.lines[index])}; the file is damaged or cut short",
        index,
    )


def _refuse_ragged(text: RecordText, rows: list[tuple[int, list[float]]], width: int) -> None:
    for place, (index, row) in enumerate(rows):
        last = place == len(rows) - 1
        if len(row) != width and not (last and len(row) < width):
            raise text.fault(
                f"{len(row)} value(s) in a row where the format has {width}; the file is damaged,"
                " fetch it again",
                index,
            )
