"""Plain columns of numbers: time and acceleration, acceleration
alone, or several by titles.

Read are, in any line before the first number, `dt: 0.005` or `sampling interval = 5 ms`,
`units: g`, `npts: 4000`, and titles of columns such as `Time (s), Acceleration (m/s2)`,
units also in a row of their own. What they leave out (units; without times also the
sampling interval) the user has to give. Of several quantities the only acceleration is
taken, of several accelerations that which `?channel=` names.
"""

from __future__ import annotations

import re
from array import array
from dataclasses import dataclass, field, replace
from typing import NamedTuple, NoReturn

import numpy as np
from numpy.typing import NDArray

from rpscli.errors import RecordError
from rpscli.records.directions import direction_in
from rpscli.records.formats.record_text import (
    Array,
    Channel,
    RecordText,
    Stated,
    printed_resolution,
    uniform_step,
)
from rpscli.records.formats.recording_words import recording_of
from rpscli.records.formats.statements import (
    PEAK_PATTERN,
    STEP_PATTERN,
    Statement,
    statements,
)
from rpscli.records.formats.titles import (
    ACCELERATION,
    ANY_UNIT,
    COUNT,
    TIME,
    UNKNOWN,
    ColumnTitle,
    beside_each_other,
    title_of,
)
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.quantities import (
    NUMBER_PATTERN,
    UNIT_PATTERN,
    canonical_unit,
    numbers_in,
    numerals_in,
    why_no_numbers,
)

_STEP = (
    r"(?<![?&])\b(?:dt|delta[\s_]*t?|Δt|(?:time|sampling)[\s_]*(?:step|interval|period)"
    rf"|equally spaced (?:at|intervals of)){STEP_PATTERN}"
)
_RATE = (
    r"(?<![?&])\b(?:sampl\w*[\s_]*(?:rate|freq\w*)|fs|sps)\b\s*(?:[(\[]\s*(?:hz|sps)\s*[)\]])?"
    rf"\s*[=:]\s*({NUMBER_PATTERN})\s*(?:hz|sps|1/s|samples?\s*/\s*s\w*)?(?![A-Za-z])"
)
_COUNT = r"\b(?:npts|ndata|number of (?:data|points|samples|values))\b\s*[=:]\s*([0-9]+)"
_UNITS_KEY = (
    r"(?<![?&])\b\w*?units?\b\s*(?:[=:]|(?:of|in|are|is)\b)"
    rf"(?:[\s(\[]*(?:({UNIT_PATTERN}))|\s*([^,;]+))"
)


class _Table(NamedTuple):
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


def recognises_columns(text: RecordText) -> bool:
    """True if most lines, and the last that is no comment, hold nothing but numbers."""
    body = [_plain(line) for line in text.lines if line.strip() and not _is_comment(line)]
    numeric = sum(1 for line in body if numbers_in(line))
    if len(body) == 1 and len(numbers_in(body[0]) or []) >= FEWEST_IN_A_LINE:
        return True
    return numeric >= 2 and 2 * numeric > len(body) and bool(numbers_in(body[-1]))


def read_columns(text: RecordText) -> GroundMotion:
    """Read a series of accelerations, or the rows of a bare AT2 body."""
    table = _table(text)
    width = int(table.widths[0])
    even = not np.any(table.widths != width)
    titles = _titles(text, table, width)
    if even and width > 2 and text.channel and not titles:  # by their places
        line = int(table.lines[0])
        titles = [
            ColumnTitle("time" if i == 0 else f"{i + 1}", "", line) for i in range(width)
        ]
    _refuse_other_quantities(text, table, titles)
    if even and width > 1 and (width == 2 or titles):
        return _columns(text, table, titles)
    text.single_channel()
    doubts = [] if width == 1 and even else [_wrapped(text, table)]
    doubts += _blank_within(text, table)
    title = titles[0] if width == 1 and titles else None
    stated = _stated(text, table, title)
    values = table.values
    text.agreed_factor(stated.unit)
    dt = text.agreed_dt(stated.step)
    # A whole number before decimal ones is a count or a flag: 4000, or 1 and then the
    # time step.
    numerals = [
        word for line in table.lines[:2] for word in numerals_in(text.lines[line])
    ]
    flagged = values[0] != 0.0 and numerals[0].isdigit() and not numerals[1].isdigit()
    if flagged or values[0] == values.size - 1 or values[1] == values.size - 2 > 0:
        raise text.fault(
            f"the first numbers, {numerals[0]} and {numerals[1]}, look like a header (a"
            " count or the time step), not like accelerations; remove them or begin"
            " their lines with #",
            int(table.lines[0]),
        )
    if values[0] == dt:
        doubts.append(f"the first value, {dt:g}, equals dt: see that it is not a header")
    return text.motion(stated, values, "one-column text", table.words, *doubts)


def contents_of_columns(text: RecordText) -> list[Channel]:
    """The columns of accelerations, each with what header and title say of it."""
    table = _table(text)
    width = int(table.widths[0])
    recording = recording_of(line.value for line in table.header)
    titles = [] if np.any(table.widths != width) else _titles(text, table, width)
    try:
        _refuse_other_quantities(text, table, titles)
    except RecordError as error:
        return [Channel(refusal=f"{error}".partition(": ")[2])]
    held = [(i, title) for i, title in enumerate(titles) if title.kind == ACCELERATION]
    if len(held) < 2:
        return [Channel(recording=recording)]
    return [
        Channel(i + 1, title.line, title.name, recording._replace(direction=title.name))
        for i, title in held
    ]


def _plain(line: str) -> str:
    """A line of numbers without quotes, between blanks where ; or tabs part them.

    Commas are decimal ones then.
    """
    if '"' in line:
        line = line.replace('"', " ")
    if (";" in line or "\t" in line) and not re.search("[A-Za-z]{2}", line):
        return re.sub(r"(?<=\d),(?=\d)", ".", line).replace(";", " ").replace("\t", " ")
    return line


def _is_comment(line: str) -> bool:
    return line.lstrip().startswith(("#", "%", "!", "//", "*", "|"))


_IS_STATEMENT = re.compile(rf":|=\s*[+-]?\.?\d|{PEAK_PATTERN}", re.IGNORECASE)


def _titles(text: RecordText, table: _Table, width: int) -> list[ColumnTitle]:
    """Titles of the columns that the user gives, else the last line that has a title for
    each; empty without one.
    """
    if text.columns is not None:
        return _titles_given(text, text.columns, width)
    units: list[str] = []
    for line in reversed(table.header):
        for separator in (r"[,;\t]", r"\s{2,}|\t", r"\s+"):
            cells = _cells(line.value, separator)
            if len(cells) != width or any(map(_IS_STATEMENT.search, cells)):
                continue
            bare = [cell.strip("()[]") for cell in cells]
            if not units and width > 1 and all(map(ANY_UNIT.fullmatch, bare)):
                units = bare  # a row of their own below the names
                break
            titles = beside_each_other([title_of(cell, line.line) for cell in cells])
            if units:
                titles = [
                    t._replace(unit=t.unit or u)
                    for t, u in zip(titles, units, strict=True)
                ]
            above = line.line == table.above
            if _are_titles(titles, above=above, apart=separator != r"\s+"):
                return titles
    if named := _titles_behind_a_key(table, width):
        return named
    names = [
        "time" if re.fullmatch("m?s(?:ec)?", unit) else "acceleration" for unit in units
    ]
    return [
        ColumnTitle(*each, table.header[-1].line)
        for each in zip(names, units, strict=True)
    ]


def _titles_behind_a_key(table: _Table, width: int) -> list[ColumnTitle]:
    """Titles behind a key, as in `DataSequence: Time U(+); N(+); E(+)`, if all of them
    are understood.
    """
    for line in table.header:
        _, colon, words = line.value.partition(":")
        cells = [cell for cell in re.split(r"[,;\s]+", words) if cell]
        titles = [title_of(cell, line.line) for cell in cells]
        known = {*(title.kind for title in titles)} <= {TIME, ACCELERATION, COUNT}
        if colon and width > 1 and len(titles) == width and known:
            return titles
    return []


def _cells(line: str, separator: str) -> list[str]:
    """The cells of a line of titles; none where one is empty, but for one at the end."""
    cells = [_plain(cell).strip() for cell in re.split(separator, line.strip())]
    if len(cells) > 1 and not cells[-1]:  # as spreadsheets end their lines
        cells.pop()
    return cells if all(cells) else []


def _are_titles(titles: list[ColumnTitle], *, above: bool, apart: bool) -> bool:
    """True if a line of words is one of titles: by what they say, or where they stand.

    Words right `above` the numbers are titles if something other than a single blank is
    between them; else one of them has to be understood.
    """
    if len(titles) == 1:
        return titles[0].kind != UNKNOWN and (above or titles[0].kind == ACCELERATION)
    known = [title.kind for title in titles if title.kind != UNKNOWN]
    return (above and (apart or len(titles) > 2)) or len(known) > 1 or TIME in known


def _titles_given(text: RecordText, columns: str, width: int) -> list[ColumnTitle]:
    """Titles that the user gives in place of those of the file."""
    titles = [title_of(cell, 0) for cell in columns.split(",")]
    if len(titles) != width:
        raise text.fault(
            f"columns = {columns[:60]} names {len(titles)}, and rows have {width} numbers;"
            " name each, `-` for one that is not used"
        )
    return titles


@dataclass
class _Rows:
    """A table while it is read: of rows and their values there may be millions."""

    header: list[Statement] = field(default_factory=list)
    values: array[float] = field(default_factory=lambda: array("d"))
    widths: array[int] = field(default_factory=lambda: array("q"))
    lines: array[int] = field(default_factory=lambda: array("q"))
    above: int = -1


def _table(text: RecordText) -> _Table:
    """The rows of numbers of a text, held against what its header announces."""
    rows = _rows(text)
    widths = rows.widths
    if len(widths) > 3 and widths[0] == 2 and set(widths[1:]) == {1}:
        _move_count_and_step(text, rows)
    if len(widths) < 2:
        _refuse_without_rows(text, rows)

    kept = tuple(line for line in rows.header if line.value)
    said = statements("npts", _COUNT, ((of.line, of.value) for of in kept))
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
    return _Table(
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
        row = numbers_in(_plain(line))
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
        elif row is None and not _is_comment(line):
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


def _blank_within(text: RecordText, table: _Table) -> list[str]:
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
    count, step = numerals_in(text.lines[line])
    following = len(rows.widths) - 1
    if not (count.isdigit() and int(count) == following):
        raise text.fault(
            f"{count} and {step} look like the number of values and their step, but"
            f" {following} values follow; correct them, or begin their line"
            " with #",
            line,
        )
    rows.header.append(Statement("count and step", f"npts: {count}, dt: {step}", line))
    del rows.values[:2], rows.widths[0], rows.lines[0]


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


def _columns(text: RecordText, table: _Table, titles: list[ColumnTitle]) -> GroundMotion:
    """One of several columns, with the times of another."""
    width = int(table.widths[0])
    values = table.values.reshape(-1, width)
    series = [i for i, title in enumerate(titles) if title.kind == ACCELERATION]
    series = series or [i for i, title in enumerate(titles) if title.kind != TIME]
    place = series[0] if titles else 1
    if titles and (text.channel is not None or len(series) != 1):
        unknown = [i for i, each in enumerate(titles) if each.kind == UNKNOWN]
        open_to = sorted({*series, *(unknown if text.channel else ())})
        named = [Channel(i + 1, titles[i].line, titles[i].name) for i in open_to]
        place = text.chosen(named).number - 1
    times = next(
        (i for i, title in enumerate(titles) if title.kind == TIME and i != place), None
    )
    if times is None and width == 2 and not (titles and text.channel):
        times = 1 - place
    title = titles[place] if titles else None
    stated = _stated(text, table, title)
    late: list[str] = []
    if times is not None and not _are_counts(text, values[:, times]):
        stated, late = _timed(text, table, stated, values[:, times], times, titles)
    words = table.words + (f", column {title.name}" if title and width > 2 else "")
    form = "two-column text" if width == 2 else "columns of text"
    return text.motion(stated, values[:, place], form, words, *late)


def _are_counts(text: RecordText, times: Array) -> bool:
    """True of numbers of samples in the place of times, where the user gives the step."""
    return text.dt not in (None, 1.0) and bool(np.all(np.diff(times) == 1.0))


def _timed(
    text: RecordText,
    table: _Table,
    stated: Stated,
    times: Array,
    place: int,
    titles: list[ColumnTitle],
) -> tuple[Stated, list[str]]:
    """The step of a column of times, and what is to be said of them."""
    numerals = (numerals_in(_plain(text.lines[line]))[place] for line in table.lines)
    resolution = printed_resolution(times, numerals)
    title = titles[place] if titles and titles[place].kind == TIME else None
    factor = (
        1.0 if title is None else text.time_factor(title.unit, title.line, is_unit=True)
    )
    try:
        step = factor * uniform_step(times, resolution)
    except ValueError as error:
        raise text.fault(
            f"two columns should be time and acceleration at a uniform step, but {error}"
        ) from error
    step = float(f"{step:.15g}") if factor != 1.0 else step
    # Rounded times know the step to one unit of their last digit over the whole record.
    coarsest = factor * float(resolution.max())
    known_to = max(1e-6 * step, 2.0 * coarsest / table.widths.size)
    if stated.step is not None and abs(stated.step - step) > known_to:
        raise text.fault(
            f"the header says dt = {stated.step:g} s and the times advance by {step:g} s;"
            " correct the one or the other"
        )
    begin = factor * times[0]
    late = [f"times begin at {begin:g} s; taken as the record's zero"]
    late = late * bool(abs(begin) > 0.5 * coarsest)
    return replace(stated, step=step, resolution=known_to / 0.51), late


def _wrapped(text: RecordText, table: _Table) -> str:
    """A note on rows that were read one after the other; refuses
    rows that look otherwise.
    """
    width = int(table.widths[0])
    ragged = np.flatnonzero(table.widths[:-1] != width)
    if ragged.size or table.widths[-1] > width:
        bad = int(ragged[0]) if ragged.size else table.widths.size - 1
        raise text.fault(
            f"a row of {table.widths[bad]} numbers among rows of {width}; every row but"
            " the last must be full: fetch the file again",
            int(table.lines[bad]),
        )
    first = table.values[::width]
    if table.announced == table.widths.size:
        raise text.fault(
            f"the header announces {table.announced} values, as many as there are rows of"
            f" {width} numbers: name the columns in a line of titles, and one of them by"
            " ?channel=NAME"
        )
    if width == 2 or (first.size > 2 and bool(np.all(np.diff(first) > 0.0))):
        raise text.fault(
            f"rows of {width} numbers whose first one increases look like time and"
            " several quantities; keep time and acceleration, or take one column by its"
            " place, ?channel=2"
        )
    return f"rows of {width} numbers were read one after the other"


def _stated(text: RecordText, table: _Table, title: ColumnTitle | None) -> Stated:
    """Statements of the header and of the title; two units, or steps, are refused."""
    lines = [(of.line, of.value) for of in table.header]
    units = statements("units", _UNITS_KEY, lines)
    text.refuse_multiples(lines, _UNITS_KEY)
    steps = text.understood_steps(statements("dt", _STEP, lines))
    steps += [
        each._replace(value=f"{1.0 / text.number(each, positive=True):.15g}")
        for each in statements("the sampling rate", _RATE, lines)
    ]
    peak = next(iter(statements("peak", PEAK_PATTERN, lines)), None)
    if title and title.unit and (canonical_unit(title.unit) or not title.remarks):
        units.append(Statement(f"the title {title.name}", title.unit, title.line))
    recording = recording_of(line for _, line in lines)
    if title and direction_in(title.name) is not None:
        recording = recording._replace(direction=title.name)
    return Stated(
        text.unit(units), text.agreed(steps, text.step), peak=peak, recording=recording
    )


COLUMNS = "?columns=time,acceleration [g]"
"""What says all of two columns."""


def _refuse_other_quantities(
    text: RecordText, table: _Table, titles: list[ColumnTitle]
) -> None:
    """Refuse columns of other quantities, and titles that are not understood."""
    kinds = [title.kind for title in titles]
    for title, kind in zip(titles, kinds, strict=True):
        if kind == "a spectrum":
            raise text.fault(
                f"the title {title.name[:40]!r} is that of a spectrum, not of a record"
                " over time; give the acceleration record of the same station",
                title.line,
            )
    if ACCELERATION not in kinds:
        _refuse_other_series(text, table)
    if titles and (ACCELERATION not in kinds or _lacks_time(titles, kinds)):
        _refuse_titles(text, titles, kinds)


def _refuse_other_series(text: RecordText, table: _Table) -> None:
    """Refuse velocities and displacements by a title anywhere in the header."""
    for line in table.header:
        for cell in re.split(r"[,;\t]|\s{2,}", line.value):
            title = title_of(_plain(cell), line.line)
            is_title = title.name and not re.search(r"[\d:=]", cell)
            if is_title and title.kind in ("velocity", "displacement"):
                raise text.fault(
                    f"the header says {line.value[:60]!r}: this is a {title.kind} record;"
                    " give the acceleration record of the same station",
                    line.line,
                )


def _lacks_time(titles: list[ColumnTitle], kinds: list[str]) -> bool:
    """True of two columns of which one is no acceleration, no time and no count."""
    return len(titles) == 2 and not {*kinds} <= {TIME, ACCELERATION, COUNT}


def _refuse_titles(
    text: RecordText, titles: list[ColumnTitle], kinds: list[str]
) -> NoReturn:
    """Say what was understood of titles, what not, and what to write."""
    said = [
        f"{title.name[:30] or title.unit!r} is {kind or 'not understood'}"
        for title, kind in zip(titles, kinds, strict=True)
    ]
    wanted = ",".join(["time", "acceleration [g]", *["-"] * (len(titles) - 2)])
    raise text.fault(
        f"the titles are not those of a record over time: {'; '.join(said[:4])}; if it is"
        f" one, say what the columns are: ?columns={wanted}",
        titles[0].line,
    )
