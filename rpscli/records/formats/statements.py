"""Statements of a header, as it is printed: names, numbers, units behind them."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import NamedTuple

from rpscli.records.quantities import NUMBER_PATTERN, UNIT_PATTERN, to_float

STATED_PATTERN = rf"{NUMBER_PATTERN}(?:,[0-9]+)?"
"""A number as a header states it; one with a decimal comma is then refused by name."""

_POWER = r"(?:\s*(?:[x×*·]\s*10\s*)?(?:\^|\*\*)\s*[({]?[-+−]?[0-9]+[)}]?|\s*/\s*[0-9.]+)"
STEP_PATTERN = (
    r"\s*(?:[\[(]\s*([A-Za-z]+)\.?\s*[\])])?\s*[=:]?\s*"
    rf"({STATED_PATTERN}[.0-9]*{_POWER}?)"
    r"\s*[\[(]?\s*((?!(?:dt|npts)\b)[A-Za-z]+\b(?!\s*[=:]))?"
)
"""The words behind the name of a time step: a unit in brackets, the number, perhaps times
a power of ten or as a fraction, a unit behind it, also in brackets."""


class Statement(NamedTuple):
    """One thing that a header says: its name, its value as
    printed, the line (from zero).
    """

    name: str
    value: str
    line: int


_OF_ACCELERATION = (
    r"(?:PGA|PHA|A_?max|peak(?:\s*value)?(?=\s*[=:])"
    r"|(?:abs[\w.]*[\s_]*)?(?:peak|max[\w.]*)[\s_]*(?:ground[\s_]*)?acc[\w.]*)"
)
_PEAK = rf"{NUMBER_PATTERN}(?:,[0-9]+)?"
_OF_SOMETHING = r"(?:(?:abs\w*[\s_]*)?(?:peak|max\w*)(?:[\s_]*(?:value|ampl\w*))?)"
PEAK_PATTERN = (
    rf"(?<!\w){_OF_ACCELERATION}(?:\s*value)?"
    rf"(?:\s*[\[(]\s*({UNIT_PATTERN})\s*[\])]\s*[=:]?\s*({_PEAK})"
    rf"|\s*[=:]?\s*({_PEAK})\s*({UNIT_PATTERN})"
    rf"|\s*[=:]\s*({_PEAK})(?![\d.]|,\d))"
    rf"|(?<!\w){_OF_SOMETHING}\s*[=:]?\s*({_PEAK})\s*({UNIT_PATTERN})"
)
"""A largest acceleration; where words do not say of what it is, its unit has to."""


def statements(
    name: str, pattern: str, lines: Iterable[tuple[int, str]]
) -> list[Statement]:
    """Statements of one thing in numbered lines: a value, and a
    unit before or behind it.
    """

    def value(match: re.Match[str]) -> str:
        return " ".join(
            sorted(filter(None, match.groups()), key=lambda word: word[0].isalpha())
        )

    found = (
        (i, each)
        for i, line in lines
        for each in re.finditer(pattern, line, re.IGNORECASE)
    )
    return [Statement(name, value(each).strip(), i) for i, each in found]


def unit_behind(value: str) -> str:
    """The words behind a stated number, in small letters."""
    return value.partition(" ")[2].strip(" .").lower()


def whole_number(value: str) -> str:
    """A stated number with its power of ten or as a fraction as one number, and its unit.

    >>> whole_number("5 x 10^-3 s"), whole_number("1/200"), whole_number("0.01 sec")
    ('0.005 s', '0.005', '0.01 sec')
    """
    if of_ten := _POWER_OF_TEN.fullmatch(value.strip()):
        value = f"1 x 10^{of_ten[1]} {of_ten[2]}"
    match = _WHOLE.fullmatch(value.strip())
    if match is None:
        return value
    number, power, below, unit = match.groups()
    if power:
        number = f"{to_float(number) * 10.0 ** int(power.replace('−', '-')):.15g}"
    if below:
        number = f"{to_float(number) / to_float(below):.15g}"
    return f"{number} {unit or ''}".strip()


_POWER_OF_TEN = re.compile(r"10\s*(?:\^|\*\*)\s*[({]?([-+−]?[0-9]+)[)}]?\s*([A-Za-z]*)")
_WHOLE = re.compile(
    rf"({NUMBER_PATTERN})\s*(?:[x×*·]\s*10\s*(?:\^|\*\*)\s*[({{]?([-+−]?[0-9]+)[)}}]?"
    rf"|/\s*({NUMBER_PATTERN}))\s*([A-Za-z]*)"
)


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
