"""Numbers written with a unit, turned into SI. pint is imported for unusual units and mistakes."""

from __future__ import annotations

import re
from functools import cache
from typing import TYPE_CHECKING, Any

from rpscli.case.common_units import common_factor
from rpscli.case.faults import listed, nearest

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
    "m/s2": ("an acceleration", ("m/s2", "cm/s2", "ft/s2")),
}
"""What each SI unit of the format measures, and units it is usually written in."""

OTHER_KINDS = {"N": "a force", "Pa": "a pressure", "Hz": "a frequency", "rad": "an angle"}


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


def _factor(written: str, unit: str) -> float:
    is_unit_text = UNIT_TEXT.match(written) is not None
    if is_unit_text and (factor := common_factor(written, unit)) is not None:
        return factor
    kind, units = KINDS[unit]
    found = _parsed(written) if is_unit_text else None
    if found is None:
        guess = nearest(written, units)
        hint = f"did you mean {guess}?" if guess else f"use {listed(units)}"
        raise ValueError(f"has the unknown unit {written!r}; it must be {kind}: {hint}")
    if found.dimensionality != _parsed(unit).dimensionality:
        raise ValueError(f"is {_kind(found)}, but must be {kind}: {listed(units)}{_hint(found)}")
    return float(found.to(_parsed(unit).units).magnitude)


@cache
def _registry() -> pint.UnitRegistry[Any]:
    import pint  # noqa: PLC0415 -- half a second, for unusual units only

    return pint.UnitRegistry()


@cache
def _parsed(written: str) -> Any:
    """One of the unit as a pint quantity, or None if there is no such unit."""
    import pint  # noqa: PLC0415 -- see above

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
    if str(quantity.units) == "gram":
        return "; g is the gram here, write 9.80665 m/s2 for gravity"
    return ""


def _grouped(text: str) -> str:
    digits = re.sub(r"(?<=\d)[_, '](?=\d)", "", text)
    return f"; digits are not grouped, write {digits}" if digits != text else ""
