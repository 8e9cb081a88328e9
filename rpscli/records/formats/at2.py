"""PEER AT2 acceleration records, in the spellings that are really found,
and as they are written.

A header of three to seven lines says who recorded what, in which units, how many values
(NPTS) and how far apart (DT); then follow the values, one to eight on a line. NPTS and DT
may stand before or after their numbers, with or without "=", on one line or on two.
"""

from __future__ import annotations

import re
from dataclasses import replace

from rpscli.constants import STANDARD_GRAVITY
from rpscli.records.directions import direction_of
from rpscli.records.formats.header_lines import Facts, HeaderLines, doubts_of_header
from rpscli.records.formats.record_text import Channel, RecordText, Stated
from rpscli.records.formats.recording_words import titled_recording, upright_word
from rpscli.records.formats.statements import (
    PEAK_PATTERN,
    STATED_PATTERN,
    STEP_PATTERN,
    Statement,
    remark,
    statements,
    whole_number,
)
from rpscli.records.ground_motion import UNKNOWN, GroundMotion, Recording
from rpscli.records.quantities import NUMBER_PATTERN, UNIT_PATTERN, last_digit, numbers_in
from rpscli.version import VERSION

FORMAT = "PEER AT2"

_HEADER_LINES = 40
_NPTS = re.compile(r"\bNPTS\b", re.IGNORECASE)
_COUNT = re.compile(r"\bNPTS\s*(?:=\s*)?([0-9]+)\b", re.IGNORECASE)
_STEP = rf"\bDT{STEP_PATTERN}"
# Those that can be nothing else: a title may hold a word such as DT2, or a source with
# ?dt=.
_COUNT_GIVEN = r"\bNPTS\s*=\s*([0-9]+)\b"
_STEP_GIVEN = rf"(?<![?&])\bDT(?=\s*=){STEP_PATTERN}"
# Both numbers before both names, or behind them.
_BOTH = re.compile(
    rf"^\s*([0-9]+)[\s,]+({STATED_PATTERN})[\s,]+NPTS\b[\s,]*(?:AND\s+)?DT\b"
    rf"|\bNPTS[\s,]+DT\b\s*(?:[=:]\s*)?([0-9]+)[\s,]+({STATED_PATTERN})",
    re.IGNORECASE,
)
# What begins a row of values, spoilt ones (overflow, not a number) included.
_VALUE = re.compile(
    rf"\s*(?:{NUMBER_PATTERN}(?=[\s,+-]|$)|\*+|[+-]?(?:nan|inf))", re.IGNORECASE
)
_OTHER_SERIES = re.compile(
    r"\b(VELOCITY|DISPLACEMENT)\s+TIME\b"
    r"|\b(SPECTR(?:UM|A))\b(?!\W*(?:COMPAT|MATCH))|\b((?:RESPONSE|FOURIER"
    r"|POWER)\s+SPECTR\w+)"
    r"|^\W*(PSA|PSV|SA|SV|SD|RSA|FOURIER)\b.*\bUNITS?\b",
    re.IGNORECASE,
)
_DECLARES = r"\bUNITS?\s*(?:OF\b|IN\b|ARE\b|[=:])"
# What a title that mentions units in passing does not look like.
_UNITS_DECLARED = re.compile(
    rf"^\W*(?:ACCELERATION\b.*)?{_DECLARES}[\s(\[]*({UNIT_PATTERN})", re.IGNORECASE
)
_UNITS_LINE = re.compile(_DECLARES, re.IGNORECASE)
_UNITS = re.compile(
    rf"(?:{_DECLARES}|\bACCELERATION\b.*\bIN\b)[\s(\[]*({UNIT_PATTERN})", re.IGNORECASE
)


_OWN = re.compile("PEER AT2 LAYOUT, .* BY RPS ")
"""The first line of a file that rps wrote: titles in any words follow."""


_Header = tuple[
    Statement, Statement, int
]  # of NPTS and of DT, and the first line of values


def recognises_at2(text: RecordText) -> bool:
    """True for a text with a line that announces NPTS, with DT on it or beside it."""
    return _header(text) is not None


def read_at2(text: RecordText) -> GroundMotion:
    """Read a PEER AT2 file."""
    text.single_channel()
    header = _header(text)
    if header is None:
        raise text.fault(
            "no header line gives NPTS and DT, so this is not a PEER AT2 file; for plain"
            " columns of numbers rename it to .txt and give ?dt= and ?units="
        )
    npts, step, start = header
    stated, rounded = _stated(text, npts, step, start)
    values, end = text.series(start, text.count(npts), closed_by="")
    rest = [line for line in text.lines[end:] if line.strip()]
    first = f"first {rest[0].strip()[:40]!r}" if rest else ""
    if any(map(numbers_in, rest)):
        raise text.fault(
            f"more numbers follow after the {values.size} values and {first}; keep one"
            " record in a file",
            end,
        )
    note = [f"{len(rest)} line(s) of text after the values, {first}"] * bool(rest)
    words = "; ".join(_title(text, npts)) or "no title"
    motion = text.motion(stated, values, FORMAT, words, *filter(None, (rounded, *note)))
    unit, factor = text.agreed_factor(stated.unit)
    facts = Facts(values, unit, factor, motion.dt, values.size)
    doubts = doubts_of_header(_unread(text, start), facts)
    known = (each for each in doubts if each not in motion.warnings)
    return replace(motion, warnings=(*motion.warnings, *known))


_UNDERSTOOD = re.compile(
    "|".join(f"(?:{of})" for of in (_COUNT.pattern, _STEP, PEAK_PATTERN)), re.IGNORECASE
)


def _unread(text: RecordText, start: int) -> HeaderLines:
    """The lines above the values without what was understood; numbers in titles are not
    statements.
    """
    heads = [*enumerate(text.heads[:start])]
    if heads and _OWN.match(heads[0][1]):
        heads = heads[-2:]
    lines = [
        (index, _UNDERSTOOD.sub(";", line))
        for index, line in heads
        if not titled_recording(line) and not _BOTH.search(line)
    ]
    return HeaderLines(text, lines, loose=False)


def contents_of_at2(text: RecordText) -> list[Channel]:
    """The one channel, with earthquake, date, station and direction
    as far as titles say them.
    """
    header = _header(text)
    return [Channel(recording=_recording(_title(text, header[0])) if header else UNKNOWN)]


def _title(text: RecordText, npts: Statement) -> list[str]:
    lines = (line.strip() for line in text.heads[: npts.line])
    return [line for line in lines if line and not _UNITS.search(line)]


def _recording(title: list[str]) -> Recording:
    if "not a recording" in " ".join(title).lower():
        return UNKNOWN
    # Fewer commas are those of another sentence.
    parts = [part.strip() for line in title for part in line.split(";")]
    known = filter(None, map(titled_recording, parts))
    longer = (part for part in parts if part.count(",") > 1)
    found = next(known, None) or Recording(next(longer, ""))
    if direction_of(found.direction) is not None or (title and _OWN.match(title[0])):
        return found
    upright = next(filter(None, map(upright_word, parts)), "")
    return found._replace(direction=upright) if upright else found


def _header(text: RecordText) -> _Header | None:
    for index, line in enumerate(text.heads[:_HEADER_LINES]):
        # A comment that gives npts belongs to a file of plain columns.
        if line.lstrip().startswith("#") or not _NPTS.search(line):
            continue
        end = len(text.lines)
        start = next(
            (i for i in range(index + 1, end) if _VALUE.match(text.heads[i])), end
        )
        if both := _BOTH.search(line):
            count, step = filter(None, both.groups())
            return Statement("NPTS", count, index), Statement("DT", step, index), start
        number = _COUNT.search(line)
        nearest = (index, *range(index + 1, min(start, _HEADER_LINES)), *range(index))
        steps = statements("DT", _STEP, ((i, text.heads[i]) for i in nearest))
        if number and steps:
            return Statement("NPTS", number[1], index), steps[0], start
    return None


def _stated(
    text: RecordText, npts: Statement, dt: Statement, start: int
) -> tuple[Stated, str]:
    """Statements of the header, each once or alike, and a note on a
    step that may be rounded.
    """
    counts = [npts]
    steps = [dt]
    for index, line in enumerate(text.heads[:start]):
        if other := _OTHER_SERIES.search(line):
            raise text.fault(
                f"this is a {other[other.lastindex or 1].lower()} record"
                f" ({line.strip()[:60]!r}); give the acceleration record of the same"
                " station, usually the file ending in .AT2",
                index,
            )
        if not _BOTH.search(line):
            counts += statements("NPTS", _COUNT_GIVEN, [(index, line)])
            steps += statements("DT", _STEP_GIVEN, [(index, line)])
    heads = [*enumerate(text.heads[:start])]
    text.refuse_multiples(heads, _UNITS.pattern)
    plain = replace(_unread(text, start), loose=True)
    unit = text.unit(_units(heads) or plain.units())
    text.agreed(counts, text.count)
    text.agreed(text.understood_steps(steps), text.step)
    # 1/256 s is printed as .0039 by PEER: a whole rate that prints the same, but is not
    # the same.
    step = text.step(dt)
    numeral = whole_number(dt.value).partition(" ")[0]
    resolution = last_digit(numeral) * step / text.number(dt._replace(value=numeral))
    peak = next(iter(statements("the peak", PEAK_PATTERN, heads)), None)
    recording = _recording(_title(text, npts))
    stated = Stated(unit, step, resolution, peak=peak, recording=recording)
    agreed = text.agreed_dt(step, 0.51 * resolution / step)
    rate = max(1, round(1.0 / agreed))
    if abs(rate * agreed - 1.0) < 1e-9 or abs(1.0 / rate - agreed) > 0.5 * resolution:
        return stated, ""
    return stated, (
        f"DT = {step:g} s is not a whole number of samples a second and may be rounded;"
        f" taken as printed, times may be off by {50.0 * resolution / step:.1g} %; if it"
        f" is 1/{rate} s, say ?dt={1.0 / rate:.9g}"
    )


def _units(heads: list[tuple[int, str]]) -> list[Statement]:
    """Statements of the unit: titles above the line of NPTS may mention other units, and
    that next to it decides.
    """
    units: list[Statement] = []
    for index, line in reversed(heads):
        if spelling := (_UNITS_DECLARED if units else _UNITS).search(line):
            units.insert(0, Statement("UNITS", spelling[1], index))
        elif not units and _UNITS_LINE.search(line):
            units.append(Statement("the header", line, index))  # which names none
    return units


_VALUES_PER_LINE = 5
_TITLE_WIDTH = 240


def _recording_line(of: Recording) -> list[str]:
    """The line `event, date, station, direction` of a recording; none if all is
    unknown.
    """
    event, _, date = of.event.rpartition(",")
    if not event:
        event, date = date, ""
    fields = (event, of.origin or date, of.station, of.direction)
    if not (of.station or of.direction or of.origin):
        return []
    return [
        ", ".join(
            remark(re.sub(r"\s*,\s*", " ", field)).strip() or "-" for field in fields
        )
    ]


def at2_text(motion: GroundMotion) -> str:
    """The content of the AT2 file of a motion, in g, to eight digits."""
    # Its first line says that it is synthetic, or what it was converted from.
    made = motion.format in ("synthetic", "pulse")
    origin = (
        "SYNTHETIC, NOT A RECORDING, MADE"
        if made
        else f"CONVERTED FROM {motion.format.upper()}"
    )
    title = "; ".join(
        filter(None, [motion.source if made else motion.name, motion.description])
    )
    # A title must not be taken for one of the header lines that carry numbers, or say
    # what these are.
    for words in (
        r"\b(velocity|displacement)\s+(time)\b",
        r"\b(n)(pts)\b",
        r"\b(spectr)(\w+)",
        r"\b(u)(nits?)\b",
    ):
        title = re.sub(words, r"\1-\2", remark(title), flags=re.IGNORECASE)
    values = motion.acceleration / STANDARD_GRAVITY
    rows = [
        "".join(f"{value:15.7E}" for value in values[start : start + _VALUES_PER_LINE])
        for start in range(0, motion.npts, _VALUES_PER_LINE)
    ]
    header = [
        f"PEER AT2 LAYOUT, {origin} BY RPS {VERSION}",
        *([] if made else _recording_line(motion.recording)),
        title[:_TITLE_WIDTH],
        "ACCELERATION TIME SERIES IN UNITS OF G",
        f"NPTS= {motion.npts:6d}, DT= {motion.dt!r} SEC",
    ]
    return "\n".join([*header, *rows]) + "\n"
