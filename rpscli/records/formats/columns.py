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
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from rpscli.errors import RecordError
from rpscli.records.directions import direction_in
from rpscli.records.formats.header_lines import (
    Facts,
    HeaderLines,
    doubts_of_header,
    raw_doubts,
)
from rpscli.records.formats.no_motions import refuse_other_quantities, refuse_other_steps
from rpscli.records.formats.record_text import (
    Array,
    Channel,
    RecordText,
    Stated,
    printed_resolution,
    uniform_step,
)
from rpscli.records.formats.recording_words import recording_of, without_recording
from rpscli.records.formats.statements import (
    PEAK_PATTERN,
    STEP_PATTERN,
    Statement,
    statements,
)
from rpscli.records.formats.tables import (
    COUNT_PATTERN,
    FEWEST_IN_A_LINE,
    Table,
    blank_within,
    is_comment,
    plain_line,
    table_of,
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
    ACCELERATIONS,
    NUMBER_PATTERN,
    UNIT_PATTERN,
    canonical_unit,
    numbers_in,
    numerals_in,
)
from rpscli.records.words import NO_SERIES, speaks_of

_STEP = (
    r"(?<![?&])\b(?:dt|delta[\s_]*t?|Δt|(?:time|sampling)[\s_]*(?:step|interval|period)"
    rf"|equally spaced (?:at|intervals of)){STEP_PATTERN}"
)
_PER_SECOND = r"(?:samples?|scans?|points?)\s*(?:/|per)\s*s"
_RATE = (
    r"(?<![?&])\b(?:sampl\w*[\s_]*(?:rate|freq\w*)|fs|sps)\b\s*(?:[(\[]\s*(?:hz"
    r"|sps)\s*[)\]])?"
    rf"\s*[=:]?\s*({NUMBER_PATTERN})\s*(k?hz|sps|1/s|samples?\s*/\s*s\w*)?(?![A-Za-z\d])"
    rf"|(?<![\w.])({NUMBER_PATTERN})\s*(?:sps\b|{_PER_SECOND}\w*)"
    rf"|\b{_PER_SECOND}(?:ec\w*)?\s*[=:]\s*({NUMBER_PATTERN})"
)
_UNITS_KEY = (
    r"(?<![?&])\b\w*?units?\b\s*(?:[=:]|(?:of|in|are|is)\b)"
    rf"(?:[\s(\[]*(?:({UNIT_PATTERN}))|\s*([^,;]+))"
)


def recognises_columns(text: RecordText) -> bool:
    """True if most lines, and the last that is no comment, hold nothing but numbers."""
    body = [
        plain_line(line) for line in text.lines if line.strip() and not is_comment(line)
    ]
    numeric = sum(1 for line in body if numbers_in(line))
    if len(body) == 1 and len(numbers_in(body[0]) or []) >= FEWEST_IN_A_LINE:
        return True
    return numeric >= 2 and 2 * numeric > len(body) and bool(numbers_in(body[-1]))


def read_columns(text: RecordText) -> GroundMotion:
    """Read a series of accelerations, or the rows of a bare AT2 body."""
    table = table_of(text)
    width = int(table.widths[0])
    even = not np.any(table.widths != width)
    titles = _titles(text, table, width)
    if even and width > 2 and text.channel and not titles:  # by their places
        line = int(table.lines[0])
        titles = [
            ColumnTitle("time" if i == 0 else f"acc {i + 1}", "", line)
            for i in range(width)
        ]
    refuse_other_quantities(text, table, titles)
    if even and width > 1 and (width == 2 or titles):
        return _columns(text, table, titles)
    text.single_channel()
    doubts = [] if width == 1 and even else [_wrapped(text, table)]
    doubts += blank_within(text, table)
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
    read = _Read("one-column text", table.words, tuple(doubts))
    return _motion(text, table, stated, values, read, titles)


def contents_of_columns(text: RecordText) -> list[Channel]:
    """The columns of accelerations, each with what header and title say of it."""
    table = table_of(text)
    width = int(table.widths[0])
    recording = recording_of(line.value for line in table.header)
    if any(raw_doubts(line.value) for line in table.header):
        return [Channel(refusal="the header says that values are not corrected")]
    titles = [] if np.any(table.widths != width) else _titles(text, table, width)
    try:
        refuse_other_quantities(text, table, titles)
    except RecordError as error:
        return [Channel(refusal=f"{error}".partition(": ")[2])]
    held = [(i, titles[i]) for i in _accelerations(titles)]
    if len(held) < 2:
        return [Channel(recording=recording)]
    return [
        Channel(i + 1, title.line, title.name, recording._replace(direction=title.name))
        for i, title in held
    ]


_IS_STATEMENT = re.compile(rf":|=\s*[+-]?\.?\d|{PEAK_PATTERN}", re.IGNORECASE)
_ENDS_IN_A_NUMBER = re.compile(
    rf"\w\s.*(?<![\w.])\d[\d.,]*\s*(?:{UNIT_PATTERN}|[^\s\d()\[\]]{{1,8}})?$",
    re.IGNORECASE,
)
"""Words above one column that state a number, and are no title."""
_OWN_TITLES = "Time (s)  Acceleration (m/s2)"
"""Of a file that rps wrote: its first line is a title in any words."""


def _titles(text: RecordText, table: Table, width: int) -> list[ColumnTitle]:
    """Titles of the columns that the user gives, held against those of the file, else
    these.
    """
    own = _titles_of_file(table, width)
    if text.columns is None:
        return own
    given = _titles_given(text, text.columns, width)
    if own and text.multiple is None:
        _compare(text, given, own)
    return given


def _compare(text: RecordText, given: list[ColumnTitle], own: list[ColumnTitle]) -> None:
    """Refuse titles of the user that contradict units of those that are understood."""
    for mine, title in zip(given, own, strict=True):
        known = {mine.kind, title.kind} in ({ACCELERATION}, {TIME})
        sizes = [
            ACCELERATIONS.get(canonical_unit(each.unit or "-") or "") or each.unit.lower()
            for each in (mine, title)
        ]
        if known and all(sizes) and sizes[0] != sizes[1]:
            raise text.fault(
                f"the columns that are given say {mine.unit} for {mine.name!r}, and"
                f" the title"
                f" {title.name!r} says {title.unit}; leave them out, or say what a"
                f" value is:"
                f" &units=1 {mine.unit}",
                title.line,
            )


def _titles_of_file(table: Table, width: int) -> list[ColumnTitle]:
    """The last line that has a title for each column; empty without one."""
    units: list[str] = []
    for line in reversed(table.header):
        for separator in (r"[,;\t]", r"\s{2,}|\t", r"\s+"):
            cells = _cells(line.value, separator)
            if len(cells) != width or any(map(_IS_STATEMENT.search, cells)):
                continue
            if width == 1 and _ENDS_IN_A_NUMBER.search(line.value[-80:]):
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


def _titles_behind_a_key(table: Table, width: int) -> list[ColumnTitle]:
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
    """The cells of a line of titles; none where one is empty, but for one at the end, and
    that of an index at the beginning.
    """
    cells = [plain_line(cell).strip() for cell in re.split(separator, line.strip())]
    if len(cells) > 1 and not cells[-1]:  # as spreadsheets end their lines
        cells.pop()
    return cells if all(cells[1:]) and (cells[0] or len(cells) > 2) else []


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
            f"columns = {columns[:60]} names {len(titles)}, and rows have {width}"
            f" numbers;"
            " name each, `-` for one that is not used"
        )
    return titles


def _columns(text: RecordText, table: Table, titles: list[ColumnTitle]) -> GroundMotion:
    """One of several columns, with the times of another."""
    if table.announced not in (None, table.widths.size):
        raise text.fault(
            f"the header announces {table.announced} values and the file holds"
            f" {table.widths.size} rows; fetch it again, or correct the header"
        )
    width = int(table.widths[0])
    values = table.values.reshape(-1, width)
    series = _accelerations(titles)
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
    index = titles[times] if titles and times is not None else None
    if times is not None and not _are_counts(text, values[:, times], stated, index):
        stated, late = _timed(text, table, stated, values[:, times], times, titles)
    words = table.words + (f", column {title.name}" if title and width > 2 else "")
    form = "two-column text" if width == 2 else "columns of text"
    read = _Read(form, words, tuple(late))
    return _motion(text, table, stated, values[:, place], read, titles)


MANY = 50
"""Values of a motion, of which some are negative."""


AT_REST = 0.05
"""Of the peak."""


class _Read(NamedTuple):
    """How a motion was read: its form, words of it, and doubts."""

    form: str
    words: str
    doubts: tuple[str, ...]


def _motion(
    text: RecordText,
    table: Table,
    stated: Stated,
    values: Array,
    read: _Read,
    titles: list[ColumnTitle],
) -> GroundMotion:
    """The motion of values, held against all that the header says."""
    at_rest = abs(values[0]) <= AT_REST * np.abs(values).max()  # as a pulse begins
    positive = values.size >= MANY and values.min() >= 0.0 and not at_rest
    if positive and text.multiple is None:
        raise text.fault(
            "no value is negative, as in a spectrum or another curve; if these are"
            f" accelerations, say what a value is: ?units=1 {stated.unit or 'g'}"
        )
    motion = text.motion(stated, values, read.form, read.words, *read.doubts)
    unit, factor = text.agreed_factor(stated.unit)
    facts = Facts(values, unit, factor, motion.dt, table.values.size)
    doubts = doubts_of_header(_unread(text, table, titles), facts)
    doubts += [
        doubt for of in table.header for doubt in raw_doubts(of.value)
    ]  # titles too
    known = (each for each in dict.fromkeys(doubts) if each not in motion.warnings)
    return replace(motion, warnings=(*motion.warnings, *known))


_UNDERSTOOD = re.compile(
    "|".join(
        f"(?:{of})" for of in (_STEP, _RATE, COUNT_PATTERN, _UNITS_KEY, PEAK_PATTERN)
    ),
    re.IGNORECASE,
)


def _unread(text: RecordText, table: Table, titles: list[ColumnTitle]) -> HeaderLines:
    """The lines above the values without titles and what else was understood."""
    own = titles if text.columns is None else _titles_of_file(table, int(table.widths[0]))
    titled = {title.line for title in own}
    if any(of.value == _OWN_TITLES for of in table.header):
        titled.add(table.header[0].line)
    lines = [
        (of.line, _UNDERSTOOD.sub(";", without_recording(of.value)))
        for of in table.header
        if of.line not in titled and not _is_row_of_units(of.value)
    ]
    return HeaderLines(text, lines)


def _is_row_of_units(line: str) -> bool:
    cells = [cell.strip("()[]") for cell in re.split(r"[,;\s]+", line.strip()) if cell]
    return len(cells) > 1 and all(map(ANY_UNIT.fullmatch, cells))


def _accelerations(titles: list[ColumnTitle]) -> list[int]:
    """Places of columns of accelerations, and of such as are not understood beside them.

    A third column beside two components is not dropped because of its title.
    """
    known = [i for i, title in enumerate(titles) if title.kind == ACCELERATION]
    unknown = [
        i
        for i, title in enumerate(titles)
        if title.kind == UNKNOWN and (not title.unit or canonical_unit(title.unit))
    ]
    named = all(re.fullmatch(r"[^\W\d][\w .°+-]*", titles[i].name) for i in unknown)
    like = len(unknown) > 1 or any(titles[i].unit for i in unknown)
    several = named and (len(known) > 1 or (known and like))
    return sorted([*known, *unknown]) if several else known


def _are_counts(
    text: RecordText, times: Array, stated: Stated, title: ColumnTitle | None
) -> bool:
    """True of numbers of samples in the place of times, where the step is told.

    Refuses a column that is called a number, and holds none.
    """
    by_one = bool(np.all(np.diff(times) == 1.0))
    if title is not None and title.kind == COUNT:
        if not by_one:
            raise text.fault(
                f"the title {title.name!r} is that of numbers of samples, and its column"
                f" advances by {times[1] - times[0]:g}; if it is time, say so:"
                " ?columns=time,acceleration [UNIT]",
                title.line,
            )
        return True
    told = text.dt if text.dt is not None else stated.step
    return by_one and told not in (None, 1.0)


def _timed(
    text: RecordText,
    table: Table,
    stated: Stated,
    times: Array,
    place: int,
    titles: list[ColumnTitle],
) -> tuple[Stated, list[str]]:
    """The step of a column of times, and what is to be said of them."""
    numerals = (numerals_in(plain_line(text.lines[line]))[place] for line in table.lines)
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


def _wrapped(text: RecordText, table: Table) -> str:
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


def _stated(text: RecordText, table: Table, title: ColumnTitle | None) -> Stated:
    """Statements of the header and of the title; two units, or steps, are refused."""
    lines = [(of.line, of.value) for of in table.header]
    unread = _unread(text, table, [title] if title else [])
    units = [*statements("units", _UNITS_KEY, lines), *unread.units()]
    text.refuse_multiples(lines, _UNITS_KEY)
    steps = text.understood_steps(statements("dt", _STEP, lines)) + unread.steps()
    steps += [
        each._replace(value=f"{_step_of_rate(text, each):.15g}")
        for each in statements("the sampling rate", _RATE, lines)
    ]
    if text.dt is None:
        refuse_other_steps(text, steps, lines)
    steps = steps if text.dt is None or not text.dt_counts else []
    told = [each for each in lines if not speaks_of(each[1], NO_SERIES)]
    peak = next(iter(statements("peak", PEAK_PATTERN, told)), None)
    if title and title.unit and (canonical_unit(title.unit) or not title.remarks):
        units.append(Statement(f"the title {title.name}", title.unit, title.line))
    recording = recording_of(line for _, line in lines)
    if title and direction_in(title.name) is not None:
        recording = recording._replace(direction=title.name)
    return Stated(
        text.unit(units), text.agreed(steps, text.step), peak=peak, recording=recording
    )


def _step_of_rate(text: RecordText, rate: Statement) -> float:
    """The step of a rate of samples, perhaps in kHz [s]."""
    number, _, unit = rate.value.partition(" ")
    factor = 1e-3 if unit.lower().startswith("k") else 1.0
    return factor / text.number(rate._replace(value=number), positive=True)
