"""Numbers and units of acceleration as record files and users spell them.

Fortran and its heirs print numbers ragged, glued together, with D exponents.
"""

from __future__ import annotations

import math
import re

from rpscli.units import si_factor

# Digits are matched in one way only: otherwise a long word of them is tried at every
# division.
_UNSIGNED = r"(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[EeDd][+-]?[0-9]+)?"
_NUMBER = re.compile(rf"[+-]?{_UNSIGNED}")
# Fixed columns leave no blank before a minus sign; digits glued without one stay
# unreadable.
_GLUED = re.compile(rf"[+-]?{_UNSIGNED}(?:[+-]{_UNSIGNED})*")
# `float` alone would also take nan, inf, 1_000 and the digits of other scripts.
_NUMERIC_LINE = re.compile(r"[-+.0-9EeDd,\s]*")

NUMBER_PATTERN = rf"[+-]?{_UNSIGNED}"  # a regular expression for one number
ACCELERATIONS = {
    name: si_factor(name, "m/s2")
    for name in ("g", "m/s2", "cm/s2", "mm/s2", "gal", "in/s2", "ft/s2")
}

KNOWN_UNITS = ", ".join(ACCELERATIONS)  # the canonical names, for messages
UNIT_PATTERN = (
    r"(?:[cm]?m|in|ft)\s*/\s*s(?:ec)?\s*(?:/\s*s(?:ec)?|\^\s*2|\*\*\s*2|2|²)(?![A-Za-z0-9])"
    r"|gals?(?![A-Za-z0-9])|gravity\b|g's(?![A-Za-z0-9])"
    r"|g(?![A-Za-z0-9/])"
)
"""A regular expression (ignoring case) for the spellings of
`canonical_unit` in running text."""


def to_float(numeral: str) -> float:
    """The value of one numeral, exponents written with D included."""
    return float(numeral.replace("D", "E").replace("d", "e"))


def numbers_in(line: str) -> list[float] | None:
    """The finite numbers of a line that holds nothing else, or None."""
    # Commas separate if each field holds one number: decimal commas are not read as
    # separators.
    if not _NUMERIC_LINE.fullmatch(line):
        return None
    fields = line.split()
    if "," in line:
        fields = [field.strip() for field in line.strip().removesuffix(",").split(",")]
    try:
        row = [float(field) for field in fields]
    except ValueError:
        if not all(_GLUED.fullmatch(field) for field in fields):
            return None
        row = [
            to_float(numeral) for field in fields for numeral in _NUMBER.findall(field)
        ]
    return row if all(map(math.isfinite, row)) else None


def why_no_numbers(line: str) -> str:
    """The punctuation that keeps a line from being read as
    numbers, in words; else nothing.
    """
    if re.fullmatch(r"[-+.,0-9EeDd;\s]*[0-9][-+.,0-9EeDd;\s]*", line):
        if re.search("[0-9],[0-9]", line) and ";" in line:
            return (
                " (decimal commas and semicolons: write points, and commas or blanks"
                " between)"
            )
        if re.search("[0-9],[0-9]", line):
            return " (decimal commas: write points)"
        if ";" in line:
            return " (semicolons: separate by commas or blanks)"
    return ""


def numerals_in(line: str) -> list[str]:
    """The numbers of a line of numbers, as they are printed."""
    return _NUMBER.findall(line)


def last_digit(numeral: str) -> float:
    """The unit of the last digit that is printed."""
    mantissa, _, exponent = re.sub("[dD]", "E", numeral.upper()).partition("E")
    decimals = len(mantissa.partition(".")[2])
    # Beyond these the unit is zero or infinite anyway, however many digits the exponent
    # has.
    power = float(exponent or 0.0) - decimals
    return math.pow(10.0, max(min(power, 308.0), -400.0))


def canonical_unit(text: str) -> str | None:
    """One of the known names for a unit of acceleration, or None if it is not one."""
    unit = re.sub(r"[\s()\[\]]", "", text.lower())
    unit = unit.replace("sec", "s").replace("⁻²", "-2").replace("²", "2")
    unit = re.sub(r"[·*.](?=s)", "", unit) if unit.endswith("-2") else unit
    unit = unit.replace("**", "^").replace("^", "")
    unit = re.sub(r"/s/s$", "/s2", unit)
    unit = {
        "gals": "gal",
        "gravity": "g",
        "g's": "g",
        "ms-2": "m/s2",
        "cms-2": "cm/s2",
        "mm/s/s": "mm/s2",
    }.get(unit, unit)
    return unit if unit in ACCELERATIONS else None
