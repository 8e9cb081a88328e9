"""A continuous curve of two straight pieces through scattered points, by least squares."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

FEWEST = 4
"""Points with different abscissae that each piece needs."""

FINALISTS = 8
"""Breaks that are compared once more without the rounding of long sums."""


@dataclass(frozen=True)
class Bilinear:
    """y = start + slope x up to the break, then onwards with the second slope."""

    start: float
    slope: float
    break_x: float
    break_y: float
    slope_after: float
    residual: float
    """Standard deviation of the points about the curve."""

    def __call__(self, x: Array) -> Array:
        """The curve."""
        before = self.start + self.slope * np.minimum(x, self.break_x)
        return np.asarray(before + self.slope_after * np.maximum(x - self.break_x, 0.0))


def bilinear_fit(x: Array, y: Array) -> Bilinear | None:
    """The bilinear curve of least squares; None where there are too few points.

    For every split of the sorted points two independent lines are fitted; if they cross between
    the neighbours of the split that is the best curve with its break there. Otherwise the best
    break of the interval is one of its ends, where the fit is linear. The least sum of squares of
    all counts (D. J. Hudson, J. Am. Stat. Assoc. 61, 1966).
    """
    order = np.argsort(x, kind="stable")
    x, y = np.asarray(x)[order], np.asarray(y)[order]
    ends = np.unique(x)
    if len(ends) < 2 * FEWEST:
        return None
    inner, sums = ends[FEWEST - 1 : len(ends) - FEWEST + 1], _Sums(x, y)
    knees = np.concatenate([_crossings(sums, inner[:-1], inner[1:]), inner])
    best_first = knees[np.argsort(_squares_at(sums, knees), kind="stable")].tolist()
    curves = [_curve(x, y, knee) for knee in [*dict.fromkeys(best_first)][:FINALISTS]]
    return min(curves, key=lambda curve: curve.residual)


class _Sums:
    """Sums over all points up to an abscissa, about the mean of all."""

    def __init__(self, x: Array, y: Array) -> None:
        self.x = x
        self.middle = float(x.mean())
        centred, level = x - self.middle, y - y.mean()
        columns = (np.ones_like(x), centred, level, centred**2, centred * level, level**2)
        self.total = np.array([[column.sum()] for column in columns])
        self._running = np.vstack([np.cumsum(column) for column in columns])

    def up_to(self, abscissae: Array) -> Array:
        """n, sums of x, y, x^2, x y, y^2 over the points up to each abscissa, (6, splits)."""
        return np.asarray(self._running[:, np.searchsorted(self.x, abscissae, side="right") - 1])


def _crossings(sums: _Sums, left: Array, right: Array) -> Array:
    """Where two free lines cross; the left neighbour of the split if not between both."""
    before = sums.up_to(left)
    (a, b), (c, d) = _lines(before), _lines(sums.total - before)
    with np.errstate(divide="ignore", invalid="ignore"):
        crossing = sums.middle + (c - a) / (b - d)
    return np.where((left <= crossing) & (crossing <= right), crossing, left)


def _lines(sums: Array) -> tuple[Array, Array]:
    """Intercept and slope of the best lines."""
    n, x, y, xx, xy, _ = sums
    slope = (xy - x * y / n) / (xx - x * x / n)
    return (y - slope * x) / n, slope


def _squares_at(sums: _Sums, knees: Array) -> Array:
    """Sum of squares of the best a + b min(x, k) + c max(x - k, 0), at given breaks k."""
    k = knees - sums.middle
    n, x, y, xx, xy, _ = sums.up_to(knees)
    m, u, v, uu, uv, _ = sums.total - sums.up_to(knees)
    low, beyond = x + m * k, u - m * k
    matrix = np.empty((len(k), 3, 3))
    matrix[:, 0, 0] = n + m
    matrix[:, 0, 1] = matrix[:, 1, 0] = low
    matrix[:, 0, 2] = matrix[:, 2, 0] = beyond
    matrix[:, 1, 1] = xx + m * k * k
    matrix[:, 1, 2] = matrix[:, 2, 1] = k * beyond
    matrix[:, 2, 2] = uu - 2.0 * k * u + m * k * k
    load = np.stack([y + v, xy + k * v, uv - k * v], axis=1)
    found = np.linalg.solve(matrix, load[:, :, None])[:, :, 0]
    return np.asarray(sums.total[5] - np.sum(found * load, axis=1))


def _curve(x: Array, y: Array, knee: float) -> Bilinear:
    """The best curve with its break at a given place."""
    columns = np.column_stack([np.ones_like(x), np.minimum(x, knee), np.maximum(x - knee, 0.0)])
    coefficients = np.linalg.lstsq(columns, y, rcond=None)[0]
    squares = float(np.sum((y - columns @ coefficients) ** 2))
    start, slope, after = coefficients.tolist()
    return Bilinear(
        start=start,
        slope=slope,
        break_x=knee,
        break_y=start + slope * knee,
        slope_after=after,
        residual=float(np.sqrt(squares / max(len(x) - 4, 1))),
    )
