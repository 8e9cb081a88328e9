"""Numbers as Fortran and its heirs print them: ragged, glued together, with D exponents."""

from __future__ import annotations

import re

_UNSIGNED = r"(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[EeDd][+-]?[0-9]+)?"
_NUMBER = re.compile(rf"[+-]?{_UNSIGNED}")
# Fixed columns leave no blank before a minus sign; digits glued without one stay unreadable.
_GLUED = re.compile(rf"[+-]?{_UNSIGNED}(?:[+-]{_UNSIGNED})*")
# `float` alone would also take nan, inf, 1_000 and the digits of other scripts.
_NUMERIC_LINE = re.compile(r"[-+.0-9EeDd,\s]*")

NUMBER_PATTERN = rf"[+-]?{_UNSIGNED}"
"""A regular expression for one number."""


def to_float(numeral: str) -> float:
    """The value of one numeral, exponents written with D included."""
    return float(numeral.replace("D", "E").replace("d", "e"))


def numbers_in(line: str) -> list[float] | None:
    """The numbers of a line that holds nothing else, or None.

    Blanks separate; so do commas when each field holds one number, which keeps decimal commas
    from being read as separators.

    Examples
    --------
    >>> numbers_in("-.1234E-02-.5678E-03  .5D-1")
    [-0.001234, -0.0005678, 0.05]
    >>> numbers_in("0,005 0,123") is None, numbers_in("0.005, 0.123"), numbers_in("nan") is None
    (True, [0.005, 0.123], True)
    """
    if not _NUMERIC_LINE.fullmatch(line):
        return None
    fields = line.split()
    if "," in line:
        fields = [field.strip() for field in line.strip().removesuffix(",").split(",")]
    try:
        return [float(field) for field in fields]
    except ValueError:
        return _glued(fields)


def numerals_in(line: str) -> list[str]:
    """The numbers of a line of numbers, as they are printed."""
    return _NUMBER.findall(line)


def _glued(fields: list[str]) -> list[float] | None:
    if not all(_GLUED.fullmatch(field) for field in fields):
        return None
    return [to_float(numeral) for field in fields for numeral in _NUMBER.findall(field)]
