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


def percent(part: float, whole: float) -> str:
    """A share of a whole.

    >>> percent(1.0, 3.0), percent(1.0, 0.0)
    ('33.3 %', '-')
    """
    return f"{100.0 * part / whole:.1f} %" if whole else "-"
