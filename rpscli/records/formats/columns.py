"""Plain columns of numbers: time and acceleration, acceleration alone, or several by titles.

Read are, in any line before the first number, `dt: 0.005` or `sampling interval = 5 ms`,
`units: g`, `npts: 4000`, and titles of columns such as `Time (s), Acceleration (m/s2)`. What they
leave out (units; without times also the sampling interval) the user has to give. Of several
quantities the only acceleration is taken, of several accelerations that which `?channel=` names.
"""

from __future__ import annotations

import re
from array import array
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.records.formats.record_text import RecordText, printed_resolution, uniform_step
from rpscli.records.formats.statements import (
    STEP_PATTERN,
    Channel,
    Statement,
    agreed,
    chosen_channel,
    found_steps,
    stated_count,
    stated_step,
    time_factor,
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

_STEP = re.compile(
    r"(?<![?&])\b(?:dt|(?:time|sampling)[\s_]*(?:step|interval|period)"
    rf"|equally spaced (?:at|intervals of)){STEP_PATTERN}",
    re.IGNORECASE,
)
_COUNT = re.compile(
    r"\b(?:npts|ndata|number of (?:data|points|samples|values))\b\s*[=:]\s*([0-9]+)", re.IGNORECASE
)
_UNITS_KEY = re.compile(
    r"(?<![?&])\bunits?\b\s*(?:[=:]|(?:of|in|are|is)\b)\s*([^,;]+)", re.IGNORECASE
)
_CELL = re.compile(r"([^\[(]*?)[\s_]*(?:[\[(]([^\])]*)[\])]|\bin\s+(\S.*))?", re.IGNORECASE)
_TIME = re.compile(r"time|t|seconds?|sec", re.IGNORECASE)
_ACCELERATION = re.compile(
    r"(?:ground\s*)?(?:acc(?:el(?:eration)?s?)?|a|a_?g)(?:[\s_.-]*\w{1,3})?", re.IGNORECASE
)
_SPECTRUM = re.compile(r"period|freq|spectr|\bp?sa\b", re.IGNORECASE)
_OTHER = re.compile(r"\b(?:(vel\w*)|disp\w*)\b", re.IGNORECASE)
_OTHER_UNIT = re.compile(r"(?:[cm]?m|in|ft)\s*(?:/\s*s(?:ec)?)?", re.IGNORECASE)


class _Title(NamedTuple):
    """What stands over a column: its name, the unit in brackets, the line."""

    name: str
    unit: str
    line: int

    @property
    def is_time(self) -> bool:
        return _TIME.fullmatch(self.name) is not None

    @property
    def is_acceleration(self) -> bool:
        """By its name or its unit; a name of another quantity decides."""
        if self.is_time or _OTHER.search(self.name):
            return False
        return bool(_ACCELERATION.fullmatch(self.name) or canonical_unit(self.unit or "-"))


@dataclass(frozen=True)
class _Table:
    header: tuple[Statement, ...]  # lines of text before the first number
    values: NDArray[np.float64]  # (numbers,) of all rows, one after the other
    widths: NDArray[np.int64]  # (rows,) numbers of each
    lines: NDArray[np.int64]  # (rows,) of the file


def recognises_columns(text: RecordText) -> bool:
    """Whether most lines, and the last that is no comment, hold nothing but numbers."""
    body = [_plain(line) for line in text.lines if line.strip() and not _is_comment(line)]
    numeric = sum(1 for line in body if numbers_in(line))
    return numeric >= 2 and 2 * numeric > len(body) and bool(numbers_in(body[-1]))


def read_columns(text: RecordText) -> GroundMotion:
    """Read a series of accelerations, or the rows of a bare AT2 body."""
    table = _table(text)
    _check_count(text, table)
    width = int(table.widths[0])
    titles = _titles(table, width)
    _refuse_other_quantities(text, table.header, titles)
    if np.any(table.widths != width) or (width > 2 and not titles):
        text.single_channel()
        return _wrapped_rows(text, table)
    if width == 1:
        text.single_channel()
        return _sequence(text, table, titles)
    return _columns(text, table, titles)


def _plain(line: str) -> str:
    """A line without the quotes of its cells."""
    return line.replace('"', " ") if '"' in line else line


def _titles(table: _Table, width: int) -> list[_Title]:
    """The last line that has a title for each column; empty without one."""
    for line in reversed(table.header):
        for separator in (r"[,;\t]", r"\s{2,}|\t", r"\s+"):
            cells = [_plain(cell).strip() for cell in re.split(separator, line.value.strip())]
            if len(cells) == width and all(cells) and not any(":" in cell for cell in cells):
                titles = [_title(cell, line.line) for cell in cells]
                last = line.line == table.lines[0] - 1 and width > 2
                if last or any(each.is_acceleration for each in titles):
                    return titles
                if any(_SPECTRUM.search(each.name) for each in titles) and width > 1:
                    return titles
    return []


def _title(cell: str, line: int) -> _Title:
    name, bracket, words = (_CELL.fullmatch(cell) or _CELL.match("")).groups()  # type: ignore[union-attr]
    if name is None or not (name or bracket):
        return _Title(cell, "", line)
    return _Title(name.strip(), (bracket or words or "").strip(), line)


def _is_comment(line: str) -> bool:
    return line.lstrip().startswith(("#", "%", "!", "//", "*", "|"))


def _table(text: RecordText) -> _Table:
    header: list[Statement] = []
    values, widths, lines = array("d"), array("q"), array("q")  # of records there may be millions
    for index, line in enumerate(text.lines):
        row = numbers_in(_plain(line))
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
    if len(widths) > 3 and widths[0] == 2 and set(widths[1:]) == {1}:
        _take_count_and_step(text, header, values, widths, lines)
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


def _take_count_and_step(
    text: RecordText,
    header: list[Statement],
    values: array[float],
    widths: array[int],
    lines: array[int],
) -> None:
    """Take a line with the number of the values behind it and their step for what it is."""
    count, step = numerals_in(text.lines[lines[0]])
    if count.isdigit() and int(count) == len(widths) - 1:
        header.append(Statement("count and step", f"npts: {count}, dt: {step}", lines[0]))
        del values[:2], widths[0], lines[0]
        return
    raise text.fault(
        f"{count} and {step} look like the number of values and their step, but {len(widths) - 1}"
        " values follow; correct them, or begin their line with #",
        lines[0],
    )


def _columns(text: RecordText, table: _Table, titles: list[_Title]) -> GroundMotion:
    """One of several columns, with the times of another."""
    width = int(table.widths[0])
    values = table.values.reshape(-1, width)
    place = _chosen(text, titles) if titles else 1
    times = next((i for i, title in enumerate(titles) if title.is_time and i != place), None)
    if times is None and width == 2 and not (titles and text.channel):
        times = 1 - place
    title = titles[place] if titles else None
    unit, factor = text.agreed_factor(_stated_units(text, table.header, title), _first_line(table))
    warnings: tuple[str, ...] = ()
    if times is None:
        dt = text.agreed_dt(_stated_step(text, table.header))
    else:
        dt, warnings = _step(text, table, values[:, times], times, titles)
    return GroundMotion(
        values[:, place] * factor,
        dt,
        text.name,
        text.source,
        "two-column text" if width == 2 else "columns of text",
        _description(table, unit) + (f", column {title.name}" if title and width > 2 else ""),
        warnings,
    )


def _chosen(text: RecordText, titles: list[_Title]) -> int:
    """The column that is wanted: the only acceleration, or the one that the user names."""
    series = [i for i, title in enumerate(titles) if title.is_acceleration]
    if not series:
        series = [i for i, title in enumerate(titles) if not title.is_time]
    if text.channel is None and len(series) == 1:
        return series[0]
    named = [Channel(i, titles[i].line, titles[i].name) for i in series]
    return chosen_channel(text, named).number


def _step(
    text: RecordText, table: _Table, times: NDArray[np.float64], place: int, titles: list[_Title]
) -> tuple[float, tuple[str, ...]]:
    """The step of a column of times [s], and what is to be said of them."""
    numerals = (numerals_in(_plain(text.lines[line]))[place] for line in table.lines)
    resolution = printed_resolution(times, numerals)
    title = titles[place] if titles and titles[place].is_time else None
    factor = 1.0 if title is None else time_factor(text, title.unit, title.line)
    try:
        step = factor * uniform_step(times, resolution)
    except ValueError as error:
        raise text.fault(
            f"two columns should be time and acceleration at a uniform step, but {error}"
        ) from error
    step = float(f"{step:.15g}") if factor != 1.0 else step
    header_step = _stated_step(text, table.header)
    # Rounded times know the step to one unit of their last digit over the whole record.
    coarsest = factor * float(resolution.max())
    known_to = max(1e-6, 2.0 * coarsest / (step * table.widths.size))
    if header_step is not None and abs(header_step - step) > known_to * step:
        raise text.fault(
            f"the header says dt = {header_step:g} s and the times advance by {step:g} s; "
            f"correct the one or the other"
        )
    warnings: tuple[str, ...] = ()
    if abs(factor * times[0]) > 0.5 * coarsest:
        warnings = (f"times begin at {factor * times[0]:g} s; taken as the record's zero",)
    return text.agreed_dt(step, known_to), warnings


def _sequence(
    text: RecordText, table: _Table, titles: Sequence[_Title] = (), *warnings: str
) -> GroundMotion:
    title = titles[0] if titles else None
    unit, factor = text.agreed_factor(_stated_units(text, table.header, title), _first_line(table))
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
    counted = _found(table.header, _COUNT, "npts")
    if counted and stated_count(text, counted[0]) == table.widths.size:
        raise text.fault(
            f"the header announces {table.widths.size} values, as many as there are rows of {width}"
            " numbers: name the columns in a line of titles, and one of them by ?channel=NAME"
        )
    if width == 2 or (first.size > 2 and bool(np.all(np.diff(first) > 0.0))):
        raise text.fault(
            f"rows of {width} numbers whose first one increases look like time and several "
            f"quantities; keep time and acceleration"
        )
    note = f"rows of {width} numbers were read one after the other"
    return _sequence(text, table, (), note)


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
    steps = [step for line in header for step in found_steps("dt", _STEP, line.value, line.line)]
    step = agreed(text, steps, stated_step)
    return None if step is None else stated_step(text, step)


def _stated_units(
    text: RecordText, header: Sequence[Statement], title: _Title | None
) -> str | None:
    """The canonical unit of acceleration that the header, or the title of the column, states."""
    units: set[str] = set()
    for line in header:
        for key in _UNITS_KEY.finditer(line.value):
            units.add(_unit_after_key(text, key[0], key[1], line.line))
    if title is not None and title.unit:
        if unit := canonical_unit(title.unit):
            units.add(unit)
        elif re.match(UNIT_PATTERN, title.unit, re.IGNORECASE):
            raise text.fault(
                f"the title says {title.name} in {title.unit[:40]!r}, which is not a unit of"
                f" acceleration that is known ({KNOWN_UNITS}); correct it",
                title.line,
            )
    if len(units) > 1:
        raise text.fault(
            f"the header states different units: {', '.join(sorted(units))}; correct the header"
        )
    return units.pop() if units else None


def _refuse_other_quantities(
    text: RecordText, header: Sequence[Statement], titles: Sequence[_Title]
) -> None:
    """Refuse spectra, and series of velocities or displacements."""
    for title in titles:
        if _SPECTRUM.search(title.name):
            raise text.fault(
                f"the title {title.name[:40]!r} is that of a spectrum, not of a record over time",
                title.line,
            )
    if any(title.is_acceleration for title in titles):
        return
    for line in header:
        for other in _others(line):
            name = "velocity" if other[1] else "displacement"
            raise text.fault(
                f"the header says {line.value[:60]!r}: this is a {name} record; give the"
                " acceleration record of the same station",
                line.line,
            )


def _others(line: Statement) -> Iterator[re.Match[str]]:
    """Titles of velocities and displacements: cells of their own."""
    for cell in re.split(r"[,;\t]|\s{2,}", line.value):
        title = _title(_plain(cell).strip(), line.line)
        found = _OTHER.match(title.name)
        if (
            found
            and found.end() == len(title.name)
            and (not title.unit or _OTHER_UNIT.fullmatch(title.unit))
        ):
            yield found


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
