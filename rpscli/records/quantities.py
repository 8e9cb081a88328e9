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
    **{
        name: si_factor(name, "m/s2")
        for name in ("g", "m/s2", "cm/s2", "mm/s2", "gal", "in/s2", "ft/s2")
    },
    "mg": 0.001 * si_factor("g", "m/s2"),
    "%g": 0.01 * si_factor("g", "m/s2"),
}
"""The one table of units of acceleration, by their canonical names [m/s2]."""

TIME_UNITS = {
    **dict.fromkeys(
        ("", "s", "sec", "secs", "second", "seconds", "sn", "seg", "с", "sek"), 1.0
    ),
    **dict.fromkeys(("сек", "saniye", "segundos", "secondes", "secondi", "秒"), 1.0),
    **dict.fromkeys(("sekunde", "sekunden", "segundo", "seconde", "secondo"), 1.0),
    **dict.fromkeys(("ms", "msec", "msecs", "millisec", "millisecs", "мс"), 1e-3),
    **dict.fromkeys(
        ("millisecond", "milliseconds", "milisegundos", "mseg", "millisecondi"), 1e-3
    ),
    **dict.fromkeys(("us", "usec", "μs", "microsec", "microseconds", "мкс"), 1e-6),
}
"""The one table of units of time, in small letters without accents [s]."""

HERTZ_PATTERN = "(?:hz|гц|1/s|ヘルツ|赫兹)"

KNOWN_UNITS = ", ".join(ACCELERATIONS)  # the canonical names, for messages
_PER_SECOND_TWICE = (
    r"\s*(?:/\s*(?:s(?:ec|n)?|с(?:ек)?)\.?\s*"
    r"(?:/\s*(?:s(?:ec|n)?|с(?:ек)?)|\^\s*\{?2\}?|\*\*\s*2|2|²)"
    r"|\s*[·*.]?\s*s(?:ec)?\s*\^?\s*\{?(?:[-−]\s*2|⁻²)\}?)(?!\w)"
)
UNIT_PATTERN = (
    rf"(?:[cm]?ms?|in|ft|[см]?м){_PER_SECOND_TWICE}"
    r"|(?:milli[- ]?|m)g(?![\w/])|%\s*(?:of\s+)?(?:g|gravity)(?![\w/])"
    r"|(?:10\s*\^\s*[-−]\s*3|1e-0?3)\s*\*?\s*g(?![\w/])|g\s*/\s*1000(?!\d)"
    r"|gals?(?!\w)|ms⁻²|cms⁻²|гал(?!\w)|ガル|伽|gravity\b|g's(?!\w)"
    r"|g(?![\w/])"
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
    """One of the known names for a unit of acceleration, or None if it is not one.

    >>> canonical_unit("CMS/SEC/SEC"), canonical_unit("milli-g"), canonical_unit("% g")
    ('cm/s2', 'mg', '%g')
    """
    unit = re.sub(r"[\s()\[\]{}]", "", text.lower()).replace("−", "-")
    unit = unit.replace("²", "2").replace("⁻", "-")
    if match := _CYRILLIC.fullmatch(unit):
        unit = f"{match[1].translate(_LENGTHS)}/s2"
    unit = re.sub(r"(?<=[/.·*m])(?:sec|sn)\b\.?|(?<=/)(?:sec|sn)(?=[\^*2])", "s", unit)
    unit = re.sub(r"[·*.](?=s)", "", unit) if unit.endswith("-2") else unit
    unit = unit.replace("**", "^").replace("^", "")
    unit = re.sub(r"/s/s$", "/s2", unit)
    unit = re.sub(r"^([cm]?m)s(?=/)", r"\1", unit)  # CMS/SEC/SEC
    unit = re.sub(r"^([cm]?m|in|ft)s(?:ec)?-2$", r"\1/s2", unit)
    unit = _SPELT.get(unit, unit)
    return unit if unit in ACCELERATIONS else None


_CYRILLIC = re.compile(r"([см]?м)/с(?:ек)?(?:\*{0,2}\^?2|/с(?:ек)?)")
_LENGTHS = str.maketrans("см", "cm")
_SPELT = {
    **dict.fromkeys(("gals", "гал", "ガル", "伽"), "gal"),
    **dict.fromkeys(("gravity", "g's"), "g"),
    **dict.fromkeys(("millig", "milli-g", "10-3g", "10-3*g", "1e-3g", "1e-03g"), "mg"),
    **dict.fromkeys(("g/1000", "0.001g", "mgs"), "mg"),
    **dict.fromkeys(("%ofg", "0.01g", "percentg"), "%g"),
    "sm/s2": "cm/s2",
}
