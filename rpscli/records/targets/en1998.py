"""Horizontal elastic response spectrum of EN 1998-1:2004."""

from __future__ import annotations

import math

import numpy as np

from rpscli.errors import RecordError
from rpscli.records.query import hint, parse_query
from rpscli.records.targets.target import Array, TargetSpectrum, velocity_of

SCHEME = "en1998"

SOILS = {
    "1": {
        "A": (1.00, 0.15, 0.4, 2.0),
        "B": (1.20, 0.15, 0.5, 2.0),
        "C": (1.15, 0.20, 0.6, 2.0),
        "D": (1.35, 0.20, 0.8, 2.0),
        "E": (1.40, 0.15, 0.5, 2.0),
    },
    "2": {
        "A": (1.00, 0.05, 0.25, 1.2),
        "B": (1.35, 0.05, 0.25, 1.2),
        "C": (1.50, 0.10, 0.25, 1.2),
        "D": (1.80, 0.10, 0.30, 1.2),
        "E": (1.60, 0.05, 0.25, 1.2),
    },
}
"""S, T_B, T_C, T_D [s] by type and ground type: tables 3.2 and 3.3, recommended values."""

LONGEST = 4.0
"""Where clause 3.2.2.2 ends [s]."""


def en1998_spectrum(rest: str, source: str) -> TargetSpectrum:
    """Elastic spectrum of clause 3.2.2.2, expressions (3.2) to (3.6).

    Parameters
    ----------
    rest : str
        What follows `en1998:`, such as `?ag=0.3g&soil=B&type=1&damping=0.05`; a_g is that of
        ground type A with the importance factor.
    source : str
        The whole source, for messages.

    Notes
    -----
    Up to T_B: a_g S (1 + T/T_B (2.5 eta - 1)); to T_C: 2.5 a_g S eta; to T_D: that times T_C/T;
    to 4 s: times T_C T_D/T^2; eta = sqrt(10/(5 + xi)) >= 0.55 with xi in per cent. The peak
    displacement is d_g = 0.025 a_g S T_C T_D, expression (3.12).

    Examples
    --------
    >>> target = en1998_spectrum("?ag=2 m/s2&soil=C", "")
    >>> target.acceleration(np.array([0.0, 0.1, 0.3, 1.2, 4.0])).round(5).tolist()
    [2.3, 4.025, 5.75, 2.875, 0.43125]
    >>> round(target.pgd, 5)
    0.069
    """
    query = parse_query(rest.lstrip("?"), source, ("ag", "soil", "type", "damping"))
    kind, soil = query.values.get("type", "1"), query.values.get("soil", "A").upper()
    for word, given, known in (("type", kind, SOILS), ("soil", soil, SOILS["1"])):
        if given not in known:
            raise RecordError(f"{source}: {word} = {given!r} is not known; {hint(given, [*known])}")
    S, T_B, T_C, T_D = SOILS[kind][soil]
    a_g, damping = query.acceleration("ag"), query.quantity("damping", "ratio", 0.05)
    if a_g <= 0.0 or not 0.0 <= damping < 1.0:
        raise RecordError(f"{source}: ag must be > 0 and damping in [0, 1); 5 % is 0.05")
    eta = max(0.55, math.sqrt(10.0 / (5.0 + 100.0 * damping)))

    def shape(T: Array, eta: float = eta) -> Array:
        rising = 1.0 + T / T_B * (2.5 * eta - 1.0)
        falling = 2.5 * eta * np.minimum(1.0, T_C / np.maximum(T, T_C))
        falling *= np.minimum(1.0, T_D / np.maximum(T, T_D))
        return a_g * S * np.where(T_B > T, rising, falling)

    return TargetSpectrum(
        name=f"EN 1998-1 type {kind}, ground {soil}",
        source=source,
        damping=damping,
        span=(0.0, LONGEST),
        shape=shape,
        pgv=velocity_of(lambda T: shape(T, 1.0)),
        pgd=0.025 * a_g * S * T_C * T_D,
    )
