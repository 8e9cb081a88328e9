"""How near to a tight reference: a share of an ensemble, since single histories are chaotic."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

CLOSE = 1e-4
"""Relative error in max|theta| that counts as the same history."""


def agreeing(
    found: Sequence[float], exact: Sequence[float], limit: float | Floats
) -> tuple[int, int]:
    """How many of how many are close; those whose reference overturns are left out."""
    a, b = np.array(found), np.array(exact)[: len(found)]
    standing = b < limit
    close = np.abs(a[standing] / b[standing] - 1.0) < CLOSE
    return int(close.sum()), int(standing.sum())


def share(close: int, count: int) -> str:
    """As text."""
    return f"{close / count:.0%} of {count}" if count else "none"
