"""Numbers written with a unit, turned into SI: the one table of units,
of cases and of records.
"""

from __future__ import annotations

import math
import re
from functools import cache
from typing import NamedTuple, Self

from rpscli.constants import STANDARD_GRAVITY
from rpscli.errors import hint, listed

WITH_UNIT = re.compile(
    r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*((?:1/)?[^\s\d_,'].*?)?\s*$"
)
_POWER = r"([A-Za-zµ]{1,20})(?:(?:\^|\*\*)?(-?[1-9]))?"
_FACTOR = re.compile(rf"\s*([*/·]|\s|^)\s*{_POWER}")
UNIT_TEXT = re.compile(rf"{_POWER}(?:(?:\s*[*/·]\s*|\s){_POWER}){{0,5}}\Z")
"""Products and quotients of units with powers."""

KINDS = {
    "m": ("a length", ("m", "cm", "mm", "in", "ft")),
    "kg": ("a mass", ("kg", "t", "lb")),
    "s": ("a time", ("s", "ms")),
    "N/m": ("a stiffness", ("N/m", "kN/m", "kN/mm", "MN/m", "kip/in")),
    "N s/m": ("a damping coefficient", ("N s/m", "kN s/m", "MN s/m", "kN s/mm")),
    "m/s2": ("an acceleration", ("m/s2", "cm/s2", "g")),
    "m/s": ("a velocity", ("m/s", "cm/s", "ft/s")),
    "N": ("a force", ("N", "kN", "MN", "kip")),
    "N m": ("a moment", ("N m", "kN m", "MN m")),
    "Pa": ("a pressure", ("Pa", "MPa", "GPa", "N/mm2")),
    "rad": ("an angle", ("rad", "mrad", "deg")),
    "deg": ("a direction", ("deg", "rad")),
    "1/s": ("a rate", ("1/s", "1/min")),
    "rad/s": ("an angular velocity", ("rad/s", "deg/s", "rpm")),
    "N s2/m2": ("a force over a squared velocity", ("N s2/m2", "kN s2/m2")),
}
"""Quantity that each SI unit of the formats measures, and units
it is usually written in."""

OTHER_KINDS = {"Hz": "a frequency"}

OF_TURNS = {"rad/s": r"(?i)hz|hertz", "1/s": r"(?i)hz|hertz|rad|deg|rpm|turn|gon"}
"""Units with the dimension of these that differ by a turn, or may."""

FOOT = 0.3048
INCH = 0.0254
"""In metres, by definition."""
POUND = 0.45359237
"""In kilogrammes, by definition."""
POUND_FORCE = 4.4482216152605
"""In newtons: a pound under standard gravity."""
DEGREE = math.pi / 180.0
PSI = POUND_FORCE / INCH**2

LENGTH = (1, 0, 0)
MASS = (0, 1, 0)
TIME = (0, 0, 1)
ANGLE = (0, 0, 0)
VELOCITY = (1, 0, -1)
ACCELERATION = (1, 0, -2)
FREQUENCY = (0, 0, -1)
FORCE = (1, 1, -2)
PRESSURE = (-1, 1, -2)
ENERGY = (2, 1, -2)
POWER = (2, 1, -3)


class Written(float):
    """A number in SI that was given as a text with a unit, which
    is what readers are shown.
    """

    text: str

    @property
    def unit(self) -> str:
        """That of the text; empty for a number without one."""
        match = WITH_UNIT.match(self.text)
        return (match and match[2]) or ""

    def __new__(cls, value: float, text: str = "") -> Self:
        """The number and its text."""
        made = super().__new__(cls, value)
        made.text = text.strip()
        return made


MOST_DIGITS = 12
"""Significant digits up to which two numbers are told apart; beyond is rounding."""


def digits_beside(value: float, limit: float, digits: int) -> int:
    """Significant digits of a value beside its limit: so many, or more where both would
    print alike and are not the same.

    >>> [digits_beside(value, 0.5, 4) for value in (0.5, 0.49, 0.50004, 0.499996)]
    [4, 4, 5, 6]
    """
    for more in range(digits, MOST_DIGITS + 1):
        if f"{value:.{more - 1}e}" != f"{limit:.{more - 1}e}":
            return more
    return digits


class Unit(NamedTuple):
    """A factor to SI, mantissa times a power of ten, and powers
    of length, mass and time.
    """

    mantissa: float
    tens: int
    dimension: tuple[int, ...]

    @property
    def factor(self) -> float:
        """To SI; powers of ten are exact, so that mm are 1e-3 m to the last digit."""
        tens = 10.0 ** abs(self.tens)
        return self.mantissa * tens if self.tens >= 0 else self.mantissa / tens


METRIC = {
    "m meter metre": Unit(1.0, 0, LENGTH), "g gram": Unit(1.0, -3, MASS),
    "t tonne": Unit(1.0, 3, MASS), "s sec second": Unit(1.0, 0, TIME),
    "N newton": Unit(1.0, 0, FORCE), "lbf": Unit(POUND_FORCE, 0, FORCE),
    "pond": Unit(STANDARD_GRAVITY, -3, FORCE), "Pa pascal": Unit(1.0, 0, PRESSURE),
    "bar": Unit(1.0, 5, PRESSURE), "J joule": Unit(1.0, 0, ENERGY), "W watt": Unit(1.0, 0, POWER),
    "rad radian": Unit(1.0, 0, ANGLE), "Hz hertz": Unit(1.0, 0, FREQUENCY),
    "Gal gal": Unit(1.0, -2, ACCELERATION),
}  # fmt: skip
"""Units that take a prefix."""

OTHERS = {
    "ft foot feet": Unit(FOOT, 0, LENGTH), "in inch inches": Unit(INCH, 0, LENGTH),
    "yd yard": Unit(3.0 * FOOT, 0, LENGTH), "mi mile": Unit(5280.0 * FOOT, 0, LENGTH),
    "lb pound": Unit(POUND, 0, MASS), "oz ounce": Unit(POUND / 16.0, 0, MASS),
    "slug": Unit(POUND_FORCE / FOOT, 0, MASS), "min minute": Unit(60.0, 0, TIME),
    "h hr hour": Unit(3600.0, 0, TIME), "d day": Unit(86400.0, 0, TIME),
    "kip": Unit(1e3 * POUND_FORCE, 0, FORCE), "kgf": Unit(STANDARD_GRAVITY, 0, FORCE),
    "tf": Unit(STANDARD_GRAVITY, 3, FORCE), "dyn dyne": Unit(1.0, -5, FORCE),
    "psi": Unit(PSI, 0, PRESSURE), "ksi": Unit(PSI, 3, PRESSURE),
    "atm": Unit(101325.0, 0, PRESSURE), "deg degree": Unit(DEGREE, 0, ANGLE),
    "arcmin": Unit(DEGREE / 60.0, 0, ANGLE), "gon grad": Unit(math.pi / 200.0, 0, ANGLE),
    "turn": Unit(2.0 * math.pi, 0, ANGLE), "rpm": Unit(math.pi / 30.0, 0, FREQUENCY),
    "kph": Unit(1.0 / 3.6, 0, VELOCITY), "mph": Unit(5280.0 * FOOT / 3600.0, 0, VELOCITY),
    "kt knot": Unit(1852.0 / 3600.0, 0, VELOCITY),
}  # fmt: skip

PREFIXES = {
    "n nano": -9, "u µ micro": -6, "m milli": -3, "c centi": -2, "d deci": -1,
    "da deca": 1,
    "h hecto": 2, "k kilo": 3, "M mega": 6, "G giga": 9, "T tera": 12,
}  # fmt: skip
"""Powers of ten."""

_WORDS = {
    prefix + word + plural: unit._replace(tens=unit.tens + tens)
    for prefixes, tens in {"": 0, **PREFIXES}.items()
    for prefix in prefixes.split() or [""]
    for words, unit in METRIC.items()
    for word in words.split()
    for plural in ("", "s" * (len(word) > 2))  # newtons, but neither kNs nor mms
}
_WORDS |= {
    word + plural: unit
    for words, unit in OTHERS.items()
    for word in words.split()
    for plural in ("", "s" * (len(word) > 1))
}


@cache
def unit_of_text(written: str) -> Unit | None:
    """The unit that a text such as ``kN s/m`` names, or None."""
    if written.startswith("1/"):
        under = unit_of_text(written[2:]) if written[2:].isalpha() else None
        return under and Unit(
            1.0 / under.mantissa, -under.tens, tuple(-each for each in under.dimension)
        )
    if not UNIT_TEXT.match(written):
        return None
    mantissa = 1.0
    tens = 0
    dimension: tuple[int, ...] = ANGLE
    for sign, word, exponent in _FACTOR.findall(written):
        if (unit := _WORDS.get(word)) is None:
            return None
        power = int(exponent or 1) * (-1 if sign == "/" else 1)
        factor = unit.mantissa ** abs(power)
        mantissa = mantissa * factor if power > 0 else mantissa / factor
        tens += power * unit.tens
        dimension = tuple(
            a + power * b for a, b in zip(dimension, unit.dimension, strict=True)
        )
    return Unit(mantissa, tens, dimension)


def si_value(text: str, unit: str) -> float:
    """Value in the SI unit `unit` of a text such as ``200 t`` or ``30 kN/mm``."""
    # A ValueError's message continues a sentence that names the field and the text.
    kind, units = KINDS[unit]
    match = WITH_UNIT.match(text)
    if match is None:
        raise ValueError(
            f"must be {kind}: a number in {unit}, or a number with its unit in quotes,"
            f" such as '1.5 {units[1]}'{_grouped(text)}"
        )
    number, written = match.groups()
    if written is None:
        raise ValueError(
            f"is text without a unit; write {number} ({unit}) without quotes"
        )
    return float(number) * si_factor(written, unit)


def computed_remedy(text: str, unit: str) -> str:
    """Hint at what a value of another kind perhaps meant, in the SI unit; or nothing.

    >>> computed_remedy("8.5 deg", "1"), computed_remedy("2.5 Hz", "s")
    ('; an angle? tan(8.5 deg) = 0.149', '; a frequency? 1/(2.5 Hz) = 0.4 s')
    >>> computed_remedy("500 kN", "kg")
    '; a weight? 500 kN/g = 50.99 t'
    """
    match = WITH_UNIT.match(text)
    found = unit_of_text(match[2]) if match and match[2] else None
    if match is None or found is None:
        return ""
    value = float(match[1]) * found.factor
    hertz = unit_of_text("Hz")
    if unit == "1" and found.dimension == ANGLE and abs(value) < 0.5 * math.pi:
        return f"; an angle? tan({text}) = {math.tan(value):.3g}"
    if unit == "s" and hertz and found.dimension == hertz.dimension and value > 0.0:
        return f"; a frequency? 1/({text}) = {1.0 / value:.4g} s"
    if unit == "kg" and found.dimension == FORCE and value > 0.0:
        return f"; a weight? {text}/g = {1e-3 * value / STANDARD_GRAVITY:.4g} t"
    return ""


def bare_or_si(text: str, unit: str) -> float:
    """A number in the SI unit, or one with its own unit."""
    try:
        return float(text)
    except ValueError:
        if unit not in KINDS:
            raise ValueError("must be a number") from None
        return si_value(text, unit)


def si_factor(written: str, unit: str) -> float:
    """Factor from the unit `written` to the SI unit `unit`."""
    if written == "g" and unit == "m/s2":  # elsewhere a gram
        return STANDARD_GRAVITY
    if unit in OF_TURNS and re.search(OF_TURNS[unit], written):
        raise ValueError(
            f"has the unit {written!r}, which counts turns or angles otherwise; write"
            f" it in {unit}: a turn is 2 pi rad"
        )
    kind, units = KINDS[unit]
    if written.lower() in {"ton", "tons"}:
        raise ValueError(
            f"has the unit {written!r}, which is 1000 kg to some and 907 kg or 1016 kg to"
            " others; write t for 1000 kg, or use lb"
        )
    found = unit_of_text(written)
    wanted = unit_of_text(unit)
    if found is None or wanted is None:
        meant = hint(written, units, f"use {listed(units)}")
        raise ValueError(f"has the unknown unit {written!r}; it must be {kind}: {meant}")
    if found.dimension != wanted.dimension:
        weight = "; the mass of a weight W is W/g" * (
            found.dimension == FORCE and unit == "kg"
        )
        raise ValueError(
            f"is {_kind(found.dimension)}, but must be {kind}: {listed(units)}{weight}"
        )
    return found.factor / wanted.factor


def in_si(value: object, unit: str) -> object:
    """A value that a file gives at a key of this unit: texts with a unit as SI numbers.

    What is no such text stays as it is, elements of lists too.
    """
    if isinstance(value, list | tuple):
        return [in_si(item, unit) for item in value]
    if not isinstance(value, str) or unit not in KINDS:
        return value
    try:
        # Twelve digits, so that 500 mm are 0.5 m.
        return Written(float(f"{si_value(value, unit):.12g}"), value)
    except ValueError:
        return value


def as_written(value: float, unit: str) -> str:
    """A number in SI as its file has it, with its unit."""
    return (
        value.text
        if isinstance(value, Written)
        else f"{value:g} {unit}".removesuffix(" -")
    )


def _kind(dimension: tuple[int, ...]) -> str:
    """Kind of a quantity of these dimensions, in words."""
    for unit, kind in (
        OTHER_KINDS | {unit: kind for unit, (kind, _) in KINDS.items()}
    ).items():
        if (known := unit_of_text(unit)) and known.dimension == dimension:
            return kind
    return "another quantity"


def _grouped(text: str) -> str:
    # 1,500 is more than a thousand; 0,3 and 12,5 and 0,300 are no groups.
    comma = text.count(",") == 1 and re.match(r"\d+,\d", text)
    if comma and not re.match(r"[1-9]\d{0,2},\d{3}\b", text):
        return f"; a decimal comma: write {text.replace(',', '.')}"
    digits = re.sub(r"(?<=\d)[_, '](?=\d)", "", text)
    return f"; digits are not grouped, write {digits}" if digits != text else ""
