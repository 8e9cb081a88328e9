"""Factors on a record that are usual: beyond them its duration and frequencies do not fit."""

from __future__ import annotations

LEAST, MOST = 0.25, 4.0
"""Factors between these are usual."""


def is_usual(factor: float) -> bool:
    """Whether a factor on a recorded motion is usual; its sign does not matter.

    >>> is_usual(0.25), is_usual(-4.0), is_usual(4.01)
    (True, True, False)
    """
    return LEAST <= abs(factor) <= MOST


def scale_warning(name: str, factor: float) -> str:
    """What to say of a record under a factor that is not usual.

    >>> scale_warning("quake.at2", 1720.0)[:56]
    'quake.at2 is scaled by 1720, beyond the usual 0.25 to 4:'
    """
    return (
        f"{name} is scaled by {factor:.4g}, beyond the usual {LEAST:g} to {MOST:g}: records of"
        " another size differ in more than their amplitude"
    )
