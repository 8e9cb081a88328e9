"""What a header announces, taken at its word: numbers, channels, and the rows that follow."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.records.formats.record_text import RecordText
from rpscli.records.quantities import NUMBER_PATTERN, numbers_in, to_float, why_no_numbers

STATED_PATTERN = rf"{NUMBER_PATTERN}(?:,[0-9]+)?"
"""A number as a header states it; one with a decimal comma is then refused by name."""

STEP_PATTERN = (
    r"\s*(?:[\[(]\s*([A-Za-z]+)\.?\s*[\])])?\s*[=:]?\s*"
    rf"({STATED_PATTERN}[.0-9]*)\s*((?!(?:dt|npts)\b)[A-Za-z]+)?"
)
"""What follows the name of a time step: a unit in brackets, the number, a unit behind it."""

_TIME_UNITS = {
    "": 1.0,
    **dict.fromkeys(("s", "sec", "secs", "second", "seconds"), 1.0),
    **dict.fromkeys(("ms", "msec", "msecs", "millisecond", "milliseconds"), 1e-3),
}
_OTHER_TIMES = re.compile(r"(?:us|usec|ns|min|minutes?|hz|h|hours?|days?|years?)", re.IGNORECASE)

MOST_VALUES = 10_000_000
"""Of one series: more than a day at a hundred samples a second."""

_SHOWN = 40  # letters of a value in a message


class Statement(NamedTuple):
    """What a header says: the name of the quantity, its value as printed, the line (from zero)."""

    name: str
    value: str
    line: int


def stated_number(text: RecordText, statement: Statement) -> float:
    """The finite number that a header states."""
    name, numeral = statement.name, statement.value.strip()
    if re.fullmatch(r"[+-]?[0-9]*,[0-9]+", numeral):
        raise text.fault(
            f"{name} = {numeral[:_SHOWN]} has a decimal comma; write"
            f" {numeral[:_SHOWN].replace(',', '.')}",
            statement.line,
        )
    if not re.fullmatch(NUMBER_PATTERN, numeral) or not math.isfinite(to_float(numeral)):
        raise text.fault(
            f"{name} = {numeral[:_SHOWN]!r} is not a finite number; correct the header, or fetch"
            " the file again",
            statement.line,
        )
    return to_float(numeral)


def stated_positive(text: RecordText, statement: Statement) -> float:
    """The positive number that a header states."""
    value = stated_number(text, statement)
    if value <= 0.0:
        raise text.fault(
            f"{statement.name} = {statement.value.strip()[:_SHOWN]} must be positive; correct the"
            " header",
            statement.line,
        )
    return value


def found_steps(name: str, pattern: re.Pattern[str], line: str, place: int) -> list[Statement]:
    """Time steps that a line states, with their units; the pattern ends as `STEP_PATTERN`."""
    return [
        Statement(name, f"{match[2]} {match[1] or match[3] or ''}".strip(), place)
        for match in pattern.finditer(line)
    ]


def stated_step(text: RecordText, statement: Statement) -> float:
    """The time step that a header states [s]."""
    number, _, unit = statement.value.partition(" ")
    value = stated_positive(text, statement._replace(value=number))
    factor = time_factor(text, unit, statement.line)
    return value if factor == 1.0 else float(f"{factor * value:.15g}")


def time_factor(text: RecordText, unit: str, line: int) -> float:
    """The size of a unit of time [s]; words that are none say nothing."""
    if (factor := _TIME_UNITS.get(unit.strip(" .").lower())) is not None:
        return factor
    if _OTHER_TIMES.fullmatch(unit.strip(" .")):
        raise text.fault(f"a time in {unit!r} is not known; write seconds, or ms", line)
    return 1.0


_STATES = re.compile(
    r"(?<![?&])\b(u|d|n|t|s|e)"
    r"(nits?|t|pts|data|ime\s*step|ampling\s*\w+|umber of \w+|qually spaced)"
    r"(?=[\s\[(]*(?:[a-z]+[\s\])]*)?[=:]|\s*(?:of|in|are|is|at|intervals)\b)",
    re.IGNORECASE,
)


def remark(text: str) -> str:
    """A text in one line that states nothing to those who read the file again."""
    line = "".join(letter for letter in " ".join(text.split()) if letter.isprintable())
    return _STATES.sub(r"\1-\2", line)


def stated_count(text: RecordText, statement: Statement) -> int:
    """The number of values that a header announces."""
    numeral = statement.value.strip()
    count = int(numeral) if re.fullmatch("[0-9]{1,9}", numeral) else 0
    if not 0 < count <= MOST_VALUES:
        raise text.fault(
            f"{statement.name} = {numeral[:_SHOWN]!r} should be a number of values, a whole number"
            f" from 1 to {MOST_VALUES}; correct the header",
            statement.line,
        )
    return count


def agreed(
    text: RecordText,
    statements: Sequence[Statement],
    meaning: Callable[[RecordText, Statement], object],
) -> Statement | None:
    """The one thing that several statements of a header say; None if there is none."""
    if not statements:
        return None
    first = statements[0]
    said = meaning(text, first)
    for other in statements[1:]:
        if meaning(text, other) != said:
            raise text.fault(
                f"{other.name} = {other.value.strip()[:_SHOWN]} contradicts"
                f" {first.name} = {first.value.strip()[:_SHOWN]} of line {first.line + 1}; correct"
                " the header",
                other.line,
            )
    return first


def refuse_other_duration(
    text: RecordText, stated: Statement, count: int, dt: float, rounding: float
) -> None:
    """Refuse a header whose duration [s] is not that of its values, give or take an interval."""
    duration = stated_number(text, stated)
    if abs(duration - (count - 0.5) * dt) > 0.51 * dt + rounding:
        raise text.fault(
            f"{stated.name} = {stated.value.strip()[:_SHOWN]} s, but {count} values {dt:g} s apart"
            f" last {count * dt:g} s; correct the header, or fetch the file again",
            stated.line,
        )


@dataclass(frozen=True)
class Channel:
    """A channel of a file: its number, the line where it begins, what it calls itself."""

    number: int
    line: int
    label: str


def chosen_channel(text: RecordText, channels: Sequence[Channel]) -> Channel:
    """The channel whose number the user asked for, or the only one."""
    if not channels:
        raise text.fault(
            "no series of accelerations begins in this file; if it is of another format than its"
            " name says, give it another ending (.txt for columns of numbers)"
        )
    listing = "; ".join(f"{channel.number}: {channel.label[:60]}" for channel in channels)
    if text.channel is None:
        if len(channels) == 1:
            return channels[0]
        raise text.fault(
            f"the file holds {len(channels)} channels; say which one by "
            f"?channel={channels[0].number} after the file name ({listing})"
        )
    asked = text.channel.strip().lower()
    wanted = [of for of in channels if asked in (str(of.number), of.label.strip().lower())]
    if not wanted:
        raise text.fault(f"there is no channel {text.channel[:60]}; the file has {listing}")
    if len(wanted) > 1:
        raise text.fault(f"channel {text.channel[:60]} comes {len(wanted)} times: {listing}")
    return wanted[0]


def peak_warnings(values: NDArray[np.float64], stated: float, last_digit: float) -> tuple[str, ...]:
    """A warning if the peak of the values has not the size that the header states."""
    peak = float(np.max(np.abs(values)))
    if abs(peak - abs(stated)) <= 0.51 * last_digit + 1e-3 * abs(stated):
        return ()
    return (f"the values peak at {peak:.6g} and the header says {abs(stated):.6g}",)


def series(
    text: RecordText,
    start: int,
    count: int,
    *,
    width: int | None = None,
    stop: int | None = None,
    closed_by: re.Pattern[str] | None = None,
) -> NDArray[np.float64]:
    """Exactly `count` numbers of the lines from `start` on; blank lines are skipped."""
    # Rows have `width` numbers, or as many as the first one, but for the last.
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
    width = width or len(rows[0][1])
    for index, row in rows:
        if len(row) != width and not (index == rows[-1][0] and len(row) < width):
            raise text.fault(
                f"{len(row)} value(s) in a row where the format has {width}; the file is damaged,"
                " fetch it again",
                index,
            )
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
