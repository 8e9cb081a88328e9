"""A bilinear curve through points: start, slope, break, and the slope beyond."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rpscli.sweep.table import Array

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

    For every split of the sorted points two independent lines are fitted; if they cross
    between the neighbours of the split that is the best curve with its break there.
    Otherwise the best break of the interval is one of its ends, where the fit is linear.
    The least sum of squares of all counts (D. J. Hudson, J. Am. Stat. Assoc. 61, 1966).
    """
    order = np.argsort(x, kind="stable")
    x = np.asarray(x)[order]
    y = np.asarray(y)[order]
    ends = np.unique(x)
    if len(ends) < 2 * FEWEST:
        return None
    inner = ends[FEWEST - 1 : len(ends) - FEWEST + 1]
    # n, sums of x, y, x^2, x y and y^2 over the points up to each, about the mean of all.
    middle = float(x.mean())
    centred = x - middle
    level = y - y.mean()
    columns = [np.ones_like(x), centred, level, centred**2, centred * level, level**2]
    running = np.cumsum(columns, axis=1)
    total = np.sum(columns, axis=1)[:, None]

    def sums(breaks: Array) -> tuple[Array, Array]:
        """(6, breaks) up to and beyond each break."""
        before = running[:, np.searchsorted(x, breaks, side="right") - 1]
        return before, total - before

    left = inner[:-1]
    right = inner[1:]
    (a, b), (c, d) = map(_lines, sums(left))
    with np.errstate(divide="ignore", invalid="ignore"):
        crossing = middle + (c - a) / (b - d)
    crossing = np.where((left <= crossing) & (crossing <= right), crossing, left)
    breaks = np.concatenate([crossing, inner])
    best_first = breaks[
        np.argsort(_squares(breaks - middle, *sums(breaks)), kind="stable")
    ]
    curves = [
        _curve(x, y, at) for at in [*dict.fromkeys(best_first.tolist())][:FINALISTS]
    ]
    return min(curves, key=lambda curve: curve.residual)


def _lines(sums: Array) -> tuple[Array, Array]:
    """Intercept and slope of the best lines."""
    n, x, y, xx, xy, _ = sums
    slope = (xy - x * y / n) / (xx - x * x / n)
    return (y - slope * x) / n, slope


def _squares(k: Array, before: Array, after: Array) -> Array:
    """Sum of squares of the best a + b min(x, k) + c max(x - k, 0), at given breaks k."""
    (n, x, y, xx, xy, yy) = before
    (m, u, v, uu, uv, vv) = after
    low = x + m * k
    beyond = u - m * k
    both = k * (u - m * k)
    rows = (
        (n + m, low, beyond),
        (low, xx + m * k * k, both),
        (beyond, both, uu - k * (u + beyond)),
    )
    matrix = np.moveaxis(np.array(rows), 2, 0)
    load = np.stack([y + v, xy + k * v, uv - k * v], axis=1)
    found = np.linalg.solve(matrix, load[:, :, None])[:, :, 0]
    return np.asarray(yy + vv - np.sum(found * load, axis=1))


def _curve(x: Array, y: Array, knee: float) -> Bilinear:
    """The best curve with its break at a given place."""
    columns = np.column_stack(
        [np.ones_like(x), np.minimum(x, knee), np.maximum(x - knee, 0.0)]
    )
    coefficients = np.linalg.lstsq(columns, y, rcond=None)[0]
    residual = np.sqrt(np.sum((y - columns @ coefficients) ** 2) / max(len(x) - 4, 1))
    start, slope, after = coefficients.tolist()
    return Bilinear(start, slope, knee, start + slope * knee, after, float(residual))
