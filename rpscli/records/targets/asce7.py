"""Design response spectrum of ASCE/SEI 7-16."""

from __future__ import annotations

import numpy as np

from rpscli.errors import RecordError
from rpscli.records.query import hint, parse_query
from rpscli.records.targets.target import Array, TargetSpectrum, velocity_of

SCHEME = "asce7"

LEVELS = {"design": 1.0, "mcer": 1.5}
"""Factors on the design spectrum: clauses 11.4.6 and 11.4.7."""


def asce7_spectrum(rest: str, source: str) -> TargetSpectrum:
    """Design spectrum of clause 11.4.6, equations (11.4-5) to (11.4-7), at 5 % damping.

    Parameters
    ----------
    rest : str
        What follows `asce7:`, such as `?sds=1.0g&sd1=0.6g&tl=8`; `level=mcer` is 1.5 times that.
    source : str
        The whole source, for messages.

    Notes
    -----
    Up to T_0 = 0.2 T_S: S_DS (0.4 + 0.6 T/T_0); to T_S = S_D1/S_DS: S_DS; to T_L: S_D1/T (with
    S_D1 as the acceleration at 1 s); beyond: S_D1 T_L/T^2. The code gives no peak displacement.

    Examples
    --------
    >>> target = asce7_spectrum("?sds=10 m/s2&sd1=6 m/s2&tl=4", "")
    >>> target.acceleration(np.array([0.0, 0.06, 0.3, 1.2, 4.0, 8.0])).round(6).tolist()
    [4.0, 7.0, 10.0, 5.0, 1.5, 0.375]
    """
    query = parse_query(rest.lstrip("?"), source, ("sds", "sd1", "tl", "level"))
    level = query.values.get("level", "design").lower()
    if level not in LEVELS:
        raise RecordError(f"{source}: level = {level!r} is not known; {hint(level, [*LEVELS])}")
    short, long = (LEVELS[level] * query.acceleration(key) for key in ("sds", "sd1"))
    T_L = query.quantity("tl", "time")
    if not (short > 0.0 and 0.0 < long / short < T_L):
        raise RecordError(f"{source}: sds and sd1 must be > 0, and sd1/sds, in s, below tl")
    T_S = long / short
    T_0 = 0.2 * T_S

    def shape(T: Array) -> Array:
        rising = short * (0.4 + 0.6 * T / T_0)
        falling = long / np.maximum(T, T_S) * np.minimum(1.0, T_L / np.maximum(T, T_L))
        return np.where(T_0 > T, rising, falling)

    return TargetSpectrum(
        name=f"ASCE 7, {'MCE_R' if level == 'mcer' else 'design'}",
        source=source,
        damping=0.05,
        span=(0.0, np.inf),
        shape=shape,
        pgv=velocity_of(shape),
        pgd=None,
    )
