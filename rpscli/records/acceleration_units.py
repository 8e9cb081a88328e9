"""Units of acceleration as record files and users spell them."""

from __future__ import annotations

import re

from rpscli.constants import STANDARD_GRAVITY

_FACTORS = {
    "g": STANDARD_GRAVITY,
    "m/s2": 1.0,
    "cm/s2": 0.01,
    "mm/s2": 0.001,
    "gal": 0.01,
    "in/s2": 0.0254,
    "ft/s2": 0.3048,
}

KNOWN_UNITS = ", ".join(_FACTORS)
"""The canonical names, for messages."""

UNIT_PATTERN = (
    r"(?:[cm]?m|in|ft)\s*/\s*s(?:ec)?\s*(?:/\s*s(?:ec)?|\^\s*2|\*\*\s*2|2|²)(?![A-Za-z0-9])"
    r"|gals?(?![A-Za-z0-9])"
    r"|g(?![A-Za-z0-9/])"
)
"""A regular expression (ignoring case) for the spellings of `canonical_unit` in running text."""


def canonical_unit(text: str) -> str | None:
    """One of the known names for a unit of acceleration, or None if it is not one.

    Examples
    --------
    >>> canonical_unit("CM/SEC/SEC"), canonical_unit("m/s^2"), canonical_unit("cm/s")
    ('cm/s2', 'm/s2', None)
    """
    unit = re.sub(r"[\s()\[\]]", "", text.lower())
    unit = unit.replace("sec", "s").replace("²", "2").replace("**", "^").replace("^", "")
    unit = re.sub(r"/s/s$", "/s2", unit)
    unit = "gal" if unit == "gals" else unit
    return unit if unit in _FACTORS else None


def unit_factor(unit: str) -> float:
    """The size of a canonical unit in m/s2.

    Examples
    --------
    >>> unit_factor("g"), unit_factor("gal")
    (9.80665, 0.01)
    """
    return _FACTORS[unit]
