"""PEER AT2 acceleration records, in the spellings that are really found, and as they are written.

A header of three to seven lines says who recorded what, in which units, how many values (NPTS)
and how far apart (DT); then follow the values, one to eight on a line. NPTS and DT may stand
before or after their numbers, with or without "=", on one line or on two.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from rpscli.constants import STANDARD_GRAVITY
from rpscli.errors import RecordError
from rpscli.records.formats.record_text import RecordText
from rpscli.records.formats.statements import (
    STATED_PATTERN,
    STEP_PATTERN,
    Statement,
    agreed,
    found_steps,
    remark,
    stated_count,
    stated_positive,
    stated_step,
)
from rpscli.records.ground_motion import GroundMotion, Recording
from rpscli.records.quantities import (
    KNOWN_UNITS,
    NUMBER_PATTERN,
    UNIT_PATTERN,
    canonical_unit,
    last_digit,
    numbers_in,
    why_no_numbers,
)
from rpscli.version import VERSION

FORMAT = "PEER AT2"

_HEADER_LINES = 40
_COMMAS = 3
"""Of a title that says earthquake, date, station and direction."""
_COUNT = re.compile(r"\bNPTS\s*(?:=\s*)?([0-9]+)\b", re.IGNORECASE)
_STEP = re.compile(rf"\bDT{STEP_PATTERN}", re.IGNORECASE)
# Those that can be nothing else: a title may hold a word such as DT2, or a source with ?dt=.
_COUNT_GIVEN = re.compile(r"\bNPTS\s*=\s*([0-9]+)\b", re.IGNORECASE)
_STEP_GIVEN = re.compile(rf"(?<![?&])\bDT(?=\s*=){STEP_PATTERN}", re.IGNORECASE)
_NUMBERS_FIRST = re.compile(
    rf"^\s*([0-9]+)[\s,]+({STATED_PATTERN})[\s,]+NPTS\b[\s,]*(?:AND\s+)?DT\b", re.IGNORECASE
)
_NUMBERS_LAST = re.compile(
    rf"\bNPTS[\s,]+DT\b\s*(?:[=:]\s*)?([0-9]+)[\s,]+({STATED_PATTERN})", re.IGNORECASE
)
# What begins a row of values, spoilt ones (overflow, not a number) included.
_VALUE = re.compile(rf"\s*(?:{NUMBER_PATTERN}(?=[\s,+-]|$)|\*+|[+-]?(?:nan|inf))", re.IGNORECASE)
_OTHER_SERIES = re.compile(r"\b(VELOCITY|DISPLACEMENT)\s+TIME\b", re.IGNORECASE)
# What a title that mentions units in passing does not look like.
_UNITS_DECLARED = re.compile(
    rf"^\W*(?:ACCELERATION\b.*)?\bUNITS?\s*(?:OF\b|IN\b|ARE\b|[=:])[\s(\[]*({UNIT_PATTERN})",
    re.IGNORECASE,
)
_UNITS_LINE = re.compile(r"\bUNITS?\s*(?:OF\b|IN\b|ARE\b|[=:])", re.IGNORECASE)
_UNITS = re.compile(
    rf"\b(?:UNITS?\s*(?:OF\b|IN\b|ARE\b|[=:])|ACCELERATION\b.*\bIN\b)[\s(\[]*({UNIT_PATTERN})",
    re.IGNORECASE,
)


@dataclass(frozen=True)
class _Header:
    count: Statement
    step: Statement
    start: int  # first line of values


def recognises_at2(text: RecordText) -> bool:
    """Whether the text has a line that announces NPTS, with DT on it or beside it."""
    return _find_header(text) is not None


def read_at2(text: RecordText) -> GroundMotion:
    """Read a PEER AT2 file."""
    text.single_channel()
    header = _find_header(text)
    if header is None:
        _refuse_overlong(text)
        raise text.fault(
            "no header line gives NPTS and DT, so this is not a PEER AT2 file; for plain columns "
            "of numbers rename it to .txt and give ?dt= and ?units="
        )
    _refuse_other_series(text, header)
    unit, factor = text.agreed_factor(_stated_units(text, header))
    _refuse_contradictions(text, header)
    dt, doubts = _step(text, header.step)
    values, warnings = _values(
        text, header.start, stated_count(text, header.count), header.count.line
    )
    title = [
        line.strip()
        for line in text.heads[: header.count.line]
        if line.strip() and not _UNITS.search(line)
    ]
    told = next((line.split(",") for line in title[1:] if line.count(",") == _COMMAS), [""] * 4)
    return GroundMotion(
        np.array(values) * factor,
        dt,
        text.name,
        text.source,
        FORMAT,
        f"{'; '.join(title) or 'no title'}; values in {unit}",
        (*doubts, *warnings),
        recording=Recording(station=told[2].strip(), direction=told[3].strip()),
    )


def _refuse_overlong(text: RecordText) -> None:
    """Refuse a line of NPTS that is longer than what is looked at."""
    for index, head in enumerate(text.heads[:_HEADER_LINES]):
        if "NPTS" in head and (length := len(text.lines[index])) > len(head):
            raise text.fault(
                f"the line of NPTS, {head.strip()[:40]!r}..., has {length} letters, of which a"
                f" header has {len(head)} at most; correct it, or fetch the file again",
                index,
            )


def _find_header(text: RecordText) -> _Header | None:
    for index, line in enumerate(text.heads[:_HEADER_LINES]):
        # A comment that gives npts belongs to a file of plain columns.
        if line.lstrip().startswith("#") or not re.search(r"\bNPTS\b", line, re.IGNORECASE):
            continue
        start = _first_numeric(text, index + 1)
        both = _both(line)
        if both:
            return _Header(
                Statement("NPTS", both[1], index), Statement("DT", both[2], index), start
            )
        count = _COUNT.search(line)
        elsewhere = (*range(index + 1, min(start, _HEADER_LINES)), *range(index))
        step = next(
            (
                step
                for i in (index, *elsewhere)
                for step in found_steps("DT", _STEP, text.heads[i], i)
            ),
            None,
        )
        if count and step:
            return _Header(Statement("NPTS", count[1], index), step, start)
    return None


def _both(line: str) -> re.Match[str] | None:
    return _NUMBERS_FIRST.search(line) or _NUMBERS_LAST.search(line)


def _refuse_contradictions(text: RecordText, header: _Header) -> None:
    counts, steps = [header.count], [header.step]
    for index, line in enumerate(text.heads[: header.start]):
        if _both(line):  # their numbers stand after both names
            continue
        counts += [Statement("NPTS", numeral, index) for numeral in _COUNT_GIVEN.findall(line)]
        steps += found_steps("DT", _STEP_GIVEN, line, index)
    agreed(text, counts, stated_count)
    agreed(text, steps, stated_step)


def _first_numeric(text: RecordText, start: int) -> int:
    end = len(text.lines)
    return next((index for index in range(start, end) if _VALUE.match(text.heads[index])), end)


def _refuse_other_series(text: RecordText, header: _Header) -> None:
    for index, line in enumerate(text.heads[: header.start]):
        other = _OTHER_SERIES.search(line)
        if other:
            raise text.fault(
                f"this is a {other[1].lower()} record ({line.strip()[:60]!r}); give the "
                f"acceleration record of the same station, usually the file ending in .AT2",
                index,
            )


def _stated_units(text: RecordText, header: _Header) -> str | None:
    # The line of the units stands next to that of NPTS: titles above may mention other units.
    found: Statement | None = None
    for index in range(header.start - 1, -1, -1):
        line = text.heads[index]
        spelling = _UNITS.search(line)
        if spelling and found is None:
            found = Statement("UNITS", spelling[1], index)
        elif found is not None and (declared := _UNITS_DECLARED.match(line)):
            agreed(text, [Statement("UNITS", declared[1], index), found], _unit)
        elif found is None and _UNITS_LINE.search(line):
            raise text.fault(
                f"{line.strip()[:60]!r} names no unit of acceleration that is known "
                f"({KNOWN_UNITS}); correct the line",
                index,
            )
    return None if found is None else _unit(text, found)


def _unit(_: RecordText, statement: Statement) -> str | None:
    return canonical_unit(statement.value)


def _values(
    text: RecordText, start: int, count: int, line: int
) -> tuple[list[float], tuple[str, ...]]:
    values: list[float] = []
    stop = start
    while stop < len(text.lines) and (row := numbers_in(text.lines[stop])) is not None:
        values.extend(row)
        stop += 1
    if len(values) != count:
        raise _count_fault(text, count, line, len(values), stop)
    rest = [words for words in map(str.strip, text.lines[stop:]) if words]
    if any(numbers_in(words) for words in rest):
        raise text.fault(
            f"more numbers follow after the {count} values and the text {rest[0][:40]!r}; "
            f"keep one record in a file",
            stop,
        )
    if rest:
        return values, (f"{len(rest)} line(s) of text after the values, first {rest[0][:40]!r}",)
    return values, ()


def _count_fault(text: RecordText, count: int, line: int, found: int, stop: int) -> RecordError:
    if found < count and stop < len(text.lines):
        return text.fault(
            f"NPTS = {count}, but after {found} values comes {text.lines[stop].strip()[:40]!r}, "
            f"which is not a row of finite numbers{why_no_numbers(text.lines[stop])}; "
            f"fetch the file again",
            stop,
        )
    cause = "cut short" if found < count else "longer than it says"
    return text.fault(
        f"NPTS = {count}, but the file holds {found} values: it is {cause}; fetch it "
        f"again, or write NPTS={found} in the header if all its values belong to the record",
        line,
    )


def _step(text: RecordText, statement: Statement) -> tuple[float, tuple[str, ...]]:
    # 1/256 s is printed as .0039 by PEER: a whole rate that prints the same, but is not the same.
    printed, number = stated_step(text, statement), statement.value.partition(" ")[0]
    resolution = (
        last_digit(number) * printed / stated_positive(text, statement._replace(value=number))
    )
    dt = text.agreed_dt(printed, 0.51 * resolution / printed)
    rate = max(1, round(1.0 / dt))
    if abs(rate * dt - 1.0) < 1e-9 or abs(1.0 / rate - dt) > 0.5 * resolution:
        return dt, ()
    note = (
        f"DT = {printed:g} s is not a whole number of samples a second and may be rounded; taken"
        f" as printed, times may be off by {50.0 * resolution / printed:.1g} %; if it is"
        f" 1/{rate} s, say ?dt={1.0 / rate:.9g}"
    )
    return dt, (note,)


_VALUES_PER_LINE = 5
_TITLE_WIDTH = 240
_MADE = ("synthetic", "pulse")


def at2_text(motion: GroundMotion) -> str:
    """The content of the AT2 file of a motion, in g, to eight digits."""
    # Its first line says that it is synthetic, or what it was converted from.
    made = motion.format in _MADE
    origin = (
        "SYNTHETIC, NOT A RECORDING, MADE" if made else f"CONVERTED FROM {motion.format.upper()}"
    )
    title = "; ".join(filter(None, [motion.source if made else motion.name, motion.description]))
    values = motion.acceleration / STANDARD_GRAVITY
    rows = [
        "".join(f"{value:15.7E}" for value in values[start : start + _VALUES_PER_LINE])
        for start in range(0, motion.npts, _VALUES_PER_LINE)
    ]
    header = [
        f"PEER AT2 LAYOUT, {origin} BY RPS {VERSION}",
        _one_line(title),
        "ACCELERATION TIME SERIES IN UNITS OF G",
        f"NPTS= {motion.npts:6d}, DT= {motion.dt!r} SEC",
    ]
    return "\n".join([*header, *rows]) + "\n"


def _one_line(title: str) -> str:
    # A title must not be taken for one of the header lines that carry numbers.
    line = re.sub(
        r"\b(velocity|displacement)\s+time\b", r"\1-time", remark(title), flags=re.IGNORECASE
    )
    line = re.sub(r"\b(n)(pts)\b", r"\1-\2", line, flags=re.IGNORECASE)
    return line[:_TITLE_WIDTH]
