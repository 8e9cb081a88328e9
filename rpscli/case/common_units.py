"""The units of everyday engineering, whose factors need no library.

pint takes half a second to read its definitions, longer than the check of a case; it is asked for
every unit that does not stand here. A test compares the factors with pint's.
"""

from __future__ import annotations

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
    "m/s2": {"m/s2": 1.0, "cm/s2": 0.01, "mm/s2": 1e-3, "ft/s2": FOOT, "in/s2": INCH},
}
"""Factors to each SI unit of the case format; powers are written without a sign."""


def common_factor(written: str, unit: str) -> float | None:
    """Factor that turns a value in the unit `written` into `unit`; None if it is not known here.

    >>> common_factor("kN/mm", "N/m"), common_factor("cm/s^2", "m/s2"), common_factor("kt", "kg")
    (1000000.0, 0.01, None)
    """
    return COMMON_UNITS[unit].get(written.replace("**", "").replace("^", ""))
