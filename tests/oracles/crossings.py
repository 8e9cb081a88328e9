"""Roots of a polynomial piece found between its turning points, so that none can hide in a pair."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

Array = NDArray[np.float64]

DEGREE = 7  # of the dense output of DOP853
NODES: Array = np.asarray(0.5 - 0.5 * np.cos(np.pi * np.arange(1, DEGREE + 1) / DEGREE))
_FIT = np.linalg.inv(NODES[:, None] ** np.arange(1, DEGREE + 1))


def through_nodes(start: float, values: Array) -> Array:
    """Rising coefficients of the degree-7 polynomial through (0, start) and (NODES, values).

    The value at 0 is kept exactly: a step that starts on an event starts on it exactly.
    """
    return np.concatenate(([start], _FIT @ (values - start)))


def monotone_pieces(coefficients: Array) -> list[float]:
    """0, the turning points inside (0, 1), 1."""
    rising = coefficients[1:] * np.arange(1, len(coefficients))
    if abs(rising[0]) > np.sum(np.abs(rising[1:])):
        return [0.0, 1.0]  # the slope cannot change its sign
    roots = np.roots(rising[::-1])
    # a double root is returned as a pair just off the real axis; a break too many does no harm
    inside = roots.real[(np.abs(roots.imag) < 1e-6) & (roots.real > 0.0) & (roots.real < 1.0)]
    return [0.0, *sorted(float(root) for root in inside), 1.0]


def first_crossing(
    coefficients: Array,
    pieces: list[float],
    level: float,
    direction: int,
    *,
    end: float,
    noise: float = 0.0,
) -> float | None:
    """The least argument in (0, 1] where the level is passed downwards (-1) or upwards (+1).

    A start on the level itself is no crossing. `end` is the value at 1 from which the next piece
    will start: if rounding puts the polynomial on the other side of it, the end is the crossing.
    The curve must have been off the level by more than `noise` before: one that starts on it with
    no slope seems to wave about it by rounding.
    """
    shifted = coefficients.copy()
    shifted[0] -= level

    def excess(z: float) -> float:
        return direction * float(np.polynomial.polynomial.polyval(z, shifted))

    values = [excess(z) for z in pieces]
    values[-1] = direction * (end - level)
    for left, right, a, b in zip(pieces[:-1], pieces[1:], values[:-1], values[1:], strict=True):
        if a < -noise and b >= 0.0:
            if excess(right) <= 0.0:
                return right
            return float(brentq(excess, left, right, xtol=1e-15, rtol=1e-14))
    return None
