"""Spectrum of SP 14.13330.2018 (the Russian code, once SNiP II-7-81)."""

from __future__ import annotations

import numpy as np

from rpscli.errors import RecordError
from rpscli.records.query import hint, parse_query
from rpscli.records.targets.target import Array, TargetSpectrum, velocity_of

SCHEME = "sp14"

CORNERS = {"I": 0.4, "II": 0.4, "III": 0.8, "IV": 0.8}
"""End of the plateau [s] by soil category, clause 5.6."""

LEAST = 0.8
"""Of the dynamic coefficient, clause 5.6."""


def sp14_spectrum(rest: str, source: str) -> TargetSpectrum:
    """A times the dynamic coefficient beta(T) of clause 5.6, at 5 % damping.

    Parameters
    ----------
    rest : str
        What follows `sp14:`, such as `?acceleration=4 m/s2&soil=II`; the acceleration A is that of
        the site: 1, 2 and 4 m/s2 for intensities 7, 8 and 9 (clause 5.5).
    source : str
        The whole source, for messages.

    Notes
    -----
    beta = 1 + 15 T up to 0.1 s, 2.5 up to 0.4 s (categories I and II) or 0.8 s (III and IV), then
    2.5 sqrt(0.4/T) or 2.5 sqrt(0.8/T), nowhere less than 0.8. The reduction factor of structures
    that may be damaged is not in it. The code gives no peak displacement.

    Examples
    --------
    >>> target = sp14_spectrum("?acceleration=2 m/s2&soil=III", "")
    >>> target.acceleration(np.array([0.0, 0.05, 0.5, 3.2, 20.0])).round(6).tolist()
    [2.0, 3.5, 5.0, 2.5, 1.6]
    """
    query = parse_query(rest.lstrip("?"), source, ("acceleration", "soil"))
    soil = query.values.get("soil", "II").upper()
    if soil not in CORNERS:
        raise RecordError(f"{source}: soil = {soil!r} is not known; {hint(soil, [*CORNERS])}")
    A, corner = query.acceleration("acceleration"), CORNERS[soil]
    if A <= 0.0:
        raise RecordError(f"{source}: acceleration must be > 0; it is 4 m/s2 for intensity 9")

    def shape(T: Array) -> Array:
        falling = 2.5 * np.sqrt(corner / np.maximum(T, corner))
        return A * np.where(T <= 0.1, 1.0 + 15.0 * T, np.maximum(falling, LEAST))

    return TargetSpectrum(
        name=f"SP 14.13330, soil {soil}",
        source=source,
        damping=0.05,
        span=(0.0, np.inf),
        shape=shape,
        pgv=velocity_of(shape),
        pgd=None,
    )
