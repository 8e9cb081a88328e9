"""Numbers written with a unit, turned into SI.

The units of everyday engineering stand here: pint takes half a second to read its definitions,
longer than the check of a case. It is asked for every other unit, and to explain mistakes. A test
compares the factors with pint's.
"""

from __future__ import annotations

import math
import re
from functools import cache
from typing import TYPE_CHECKING, Any

from rpscli.case.text.document import listed
from rpscli.constants import STANDARD_GRAVITY
from rpscli.errors import hint

if TYPE_CHECKING:
    import pint

WITH_UNIT = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*([^\s\d_,'].*?)?\s*$")
_POWER = r"[A-Za-zµ]{1,20}(?:(?:\^|\*\*)?-?\d)?"
UNIT_TEXT = re.compile(rf"{_POWER}(?:(?:\s*[*/·]\s*|\s){_POWER}){{0,5}}\Z")
"""Products and quotients of units with powers; pint understands more than anybody needs here."""
EXPONENT = re.compile(r"(?<=[A-Za-z])(-?\d)")

KINDS = {
    "m": ("a length", ("m", "cm", "mm", "in", "ft")),
    "kg": ("a mass", ("kg", "t", "lb")),
    "s": ("a time", ("s", "ms")),
    "N/m": ("a stiffness", ("N/m", "kN/m", "kN/mm", "MN/m", "kip/in")),
    "N s/m": ("a damping coefficient", ("N s/m", "kN s/m", "MN s/m", "kN s/mm")),
    "m/s2": ("an acceleration", ("m/s2", "cm/s2", "g")),
    "m/s": ("a velocity", ("m/s", "cm/s", "ft/s")),
    "N": ("a force", ("N", "kN", "MN", "kip")),
    "rad": ("an angle", ("rad", "mrad", "deg")),
}
"""What each SI unit of the format measures, and units it is usually written in."""

OTHER_KINDS = {"Pa": "a pressure", "Hz": "a frequency"}

FOOT, INCH = 0.3048, 0.0254
"""In metres, by definition."""
POUND = 0.45359237
"""In kilogrammes, by definition."""
POUND_FORCE = 4.4482216152605
"""In newtons: a pound under standard gravity."""

COMMON_UNITS: dict[str, dict[str, float]] = {
    "m": {"m": 1.0, "dm": 0.1, "cm": 0.01, "mm": 1e-3, "km": 1e3, "ft": FOOT, "in": INCH},
    "kg": {"kg": 1.0, "t": 1e3, "Mg": 1e3, "lb": POUND},
    "s": {"s": 1.0, "ms": 1e-3, "min": 60.0},
    "N/m": {
        "N/m": 1.0,
        "kN/m": 1e3,
        "MN/m": 1e6,
        "GN/m": 1e9,
        "N/cm": 1e2,
        "kN/cm": 1e5,
        "MN/cm": 1e8,
        "N/mm": 1e3,
        "kN/mm": 1e6,
        "MN/mm": 1e9,
        "lbf/in": POUND_FORCE / INCH,
        "lbf/ft": POUND_FORCE / FOOT,
        "kip/in": 1e3 * POUND_FORCE / INCH,
        "kip/ft": 1e3 * POUND_FORCE / FOOT,
    },
    "N s/m": {"N s/m": 1.0, "kN s/m": 1e3, "MN s/m": 1e6, "kN s/mm": 1e6},
    "m/s2": {
        "g": STANDARD_GRAVITY,
        "m/s2": 1.0,
        "cm/s2": 0.01,
        "mm/s2": 1e-3,
        "ft/s2": FOOT,
        "in/s2": INCH,
    },
    "m/s": {"m/s": 1.0, "cm/s": 0.01, "mm/s": 1e-3, "ft/s": FOOT, "in/s": INCH},
    "N": {"N": 1.0, "kN": 1e3, "MN": 1e6, "lbf": POUND_FORCE, "kip": 1e3 * POUND_FORCE},
    "rad": {"rad": 1.0, "mrad": 1e-3, "deg": math.pi / 180.0},
}
"""Factors to each SI unit of the format; powers are written without a sign."""


def si_value(text: str, unit: str) -> float:
    """Value in the SI unit `unit` of a text such as ``200 t`` or ``30 kN/mm``.

    Raises
    ------
    ValueError
        If the text is no number with a unit, or the unit measures something else. The message
        continues a sentence that names the field and the text.

    Examples
    --------
    >>> si_value("200 t", "kg")
    200000.0
    """
    kind, units = KINDS[unit]
    match = WITH_UNIT.match(text)
    if match is None:
        raise ValueError(
            f"must be {kind}: a number in {unit}, or a number with its unit in quotes, such as"
            f" '1.5 {units[1]}'{_grouped(text)}"
        )
    number, written = match.groups()
    if written is None:
        raise ValueError(f"is text without a unit; write {number} ({unit}) without quotes")
    factor = _factor(written, unit)
    return float(number) * factor


def in_si(value: object, unit: str) -> object:
    """A value that a file gives at a key of this unit: texts with a unit as SI numbers.

    What is no such text stays as it is, elements of lists too.

    >>> in_si("50 t", "kg"), in_si(["1 m", 2.0], "m"), in_si("critical", "-"), in_si("auto", "s")
    (50000.0, [1.0, 2.0], 'critical', 'auto')
    """
    if isinstance(value, list | tuple):
        return [in_si(item, unit) for item in value]
    if not isinstance(value, str) or unit not in KINDS:
        return value
    try:
        # Twelve digits, so that 500 mm are 0.5 m.
        return float(f"{si_value(value, unit):.12g}")
    except ValueError:
        return value


def _refuse_ton(written: str) -> None:
    if written.lower() in {"ton", "tons"}:
        raise ValueError(
            f"has the unit {written!r}, which is 1000 kg to some and 907 kg or 1016 kg to others;"
            " write t for 1000 kg, or use lb"
        )


def common_factor(written: str, unit: str) -> float | None:
    """Factor that turns a value in the unit `written` into `unit`; None if it is not known here.

    >>> common_factor("kN/mm", "N/m"), common_factor("cm/s^2", "m/s2"), common_factor("kt", "kg")
    (1000000.0, 0.01, None)
    """
    return COMMON_UNITS[unit].get(written.replace("**", "").replace("^", ""))


def _factor(written: str, unit: str) -> float:
    is_unit_text = UNIT_TEXT.match(written) is not None
    if is_unit_text and (factor := common_factor(written, unit)) is not None:
        return factor
    kind, units = KINDS[unit]
    _refuse_ton(written)
    found = _parsed(written) if is_unit_text else None
    if found is None:
        meant = hint(written, units, f"use {listed(units)}")
        raise ValueError(f"has the unknown unit {written!r}; it must be {kind}: {meant}")
    if found.dimensionality != _parsed(unit).dimensionality:
        raise ValueError(f"is {_kind(found)}, but must be {kind}: {listed(units)}{_hint(found)}")
    return float(found.to(_parsed(unit).units).magnitude)


@cache
def _registry() -> pint.UnitRegistry[Any]:
    import pint  # half a second, for unusual units only

    return pint.UnitRegistry()


@cache
def _parsed(written: str) -> Any:
    """One of the unit as a pint quantity, or None if there is no such unit."""
    import pint

    text = EXPONENT.sub(r"**\1", written.replace("·", "*").replace("µ", "u"))
    try:
        return _registry().Quantity(1.0, _registry().parse_units(text))
    except (pint.PintError, KeyError):
        # The latter is pint's answer to a unit to the power of zero, such as g0.
        return None


def _kind(quantity: Any) -> str:
    known = {unit: kind for unit, (kind, _) in KINDS.items()} | OTHER_KINDS
    for unit, kind in known.items():
        if quantity.dimensionality == _parsed(unit).dimensionality:
            return kind
    return f"of dimension {quantity.dimensionality}"


def _hint(quantity: Any) -> str:
    if quantity.dimensionality == _parsed("N").dimensionality:
        return "; the mass of a weight W is W/g"
    return ""


def _grouped(text: str) -> str:
    # 1,500 is more than a thousand; 0,3 and 12,5 and 0,300 are no groups.
    comma = text.count(",") == 1 and re.match(r"\d+,\d", text)
    if comma and not re.match(r"[1-9]\d{0,2},\d{3}\b", text):
        return f"; a decimal comma: write {text.replace(',', '.')}"
    digits = re.sub(r"(?<=\d)[_, '](?=\d)", "", text)
    return f"; digits are not grouped, write {digits}" if digits != text else ""
