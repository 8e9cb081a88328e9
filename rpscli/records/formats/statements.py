"""What headers state: numbers that are read strictly, and refused where they contradict."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from rpscli.records.formats.record_text import RecordText
from rpscli.records.quantities import NUMBER_PATTERN, to_float

STATED_PATTERN = rf"{NUMBER_PATTERN}(?:,[0-9]+)?"
"""A number as a header states it; one with a decimal comma is then refused by name."""

MOST_VALUES = 10_000_000
"""Of one series: more than a day at a hundred samples a second."""

_SHOWN = 40  # letters of a value in a message


@dataclass(frozen=True)
class Statement:
    """What a header says: the name of the quantity, its value as printed, the line (from zero)."""

    name: str
    value: str
    line: int


def stated_number(text: RecordText, statement: Statement) -> float:
    """The finite number that a header states.

    Raises
    ------
    RecordError
        If it is none, or has a decimal comma.
    """
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
    """The one thing that several statements of a header say; None if there is none.

    Parameters
    ----------
    text : RecordText
        The file.
    statements : sequence of Statement
        In the order of the file.
    meaning : callable
        Turns a statement into what it says, so that 0.01 and .010 agree.

    Raises
    ------
    RecordError
        If two contradict each other; both lines are named.
    """
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
    """Refuse a header whose duration is not that of its values and their spacing.

    Parameters
    ----------
    text : RecordText
        The file.
    stated : Statement [s]
        The duration; agencies count the last interval or leave it out.
    count : int
        How many values are announced.
    dt : float [s]
        Their spacing.
    rounding : float [s]
        How far the statement may be rounded.
    """
    duration = stated_number(text, stated)
    if abs(duration - (count - 0.5) * dt) > 0.51 * dt + rounding:
        raise text.fault(
            f"{stated.name} = {stated.value.strip()[:_SHOWN]} s, but {count} values {dt:g} s apart"
            f" last {count * dt:g} s; correct the header, or fetch the file again",
            stated.line,
        )
