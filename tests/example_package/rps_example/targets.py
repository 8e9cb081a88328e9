"""A target spectrum: constant up to a corner, then falling with the period."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rpscli.plugins import RecordError, TargetSpectrum, parse_query


def plateau(rest: str, source: str) -> TargetSpectrum:
    """Constant up to a corner, then falling with the period: `plateau:?a=0.5g&corner=0.6`."""
    query = parse_query(rest.lstrip("?"), source, ("a", "corner"))
    a, corner = query.acceleration("a"), query.quantity("corner", "time")
    if not (a > 0.0 and corner > 0.0):
        raise RecordError(f"{source}: a and corner must be > 0")

    def shape(periods: NDArray[np.float64]) -> NDArray[np.float64]:
        return a * np.minimum(1.0, corner / np.maximum(periods, corner))

    return TargetSpectrum("plateau", source, shape, pgv=None, rules="none")
