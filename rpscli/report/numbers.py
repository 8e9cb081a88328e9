"""Numbers as people read them."""

from __future__ import annotations

import math


def shown(value: float | str | None, digits: int = 4) -> str:
    """A number with so many significant digits; ``-`` if there is none.

    >>> shown(0.10501282), shown(17321.4), shown(3), shown(None), shown(2.4e-9)
    ('0.1050', '17321', '3', '-', '2.400e-09')
    """
    if value is None:
        return "-"
    if isinstance(value, str | int):
        return str(value)
    if not math.isfinite(value):
        return "inf" if value > 0.0 else "-"
    size = abs(value)
    if size == 0.0:
        return "0"
    if not 1e-4 <= size < 1e7:
        return f"{value:.{digits - 1}e}"
    decimals = max(0, digits - 1 - math.floor(math.log10(size)))
    return f"{value:.{decimals}f}"


LARGE_UNITS = {"N": "kN", "J": "kJ", "kg": "t", "N/m": "kN/m"}
"""What a thousand of an SI unit is called; other units are shown as they are."""


def large(value: float | None, unit: str) -> tuple[float | None, str]:
    """A value in SI and its unit as people read them.

    >>> large(1.5e6, "N"), large(0.1, "rad"), large(None, "s"), large(0.2, "-")
    ((1500.0, 'kN'), (0.1, 'rad'), (None, 's'), (0.2, ''))
    """
    if unit in LARGE_UNITS:
        return None if value is None else value * 1e-3, LARGE_UNITS[unit]
    return value, "" if unit == "-" else unit


def measured(value: float | None, unit: str) -> str:
    """A value in SI as text with its unit.

    >>> measured(1.5e6, "N"), measured(None, "s"), measured(0.2, "-")
    ('1500 kN', '-', '0.2000')
    """
    number, name = large(value, unit)
    return shown(number) if value is None or not name else f"{shown(number)} {name}"


def percent(part: float, whole: float) -> str:
    """A share of a whole.

    >>> percent(1.0, 3.0), percent(1.0, 0.0)
    ('33.3 %', '-')
    """
    return f"{100.0 * part / whole:.1f} %" if whole else "-"
