"""A continuous curve of two straight pieces through scattered points, by least squares."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

FEWEST = 4
"""Points with different abscissae that each piece needs."""

COARSE_SPLITS = 200
"""Splits that are tried before the search narrows."""


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

    Notes
    -----
    For every split of the sorted points two independent lines are fitted; if they cross between
    the neighbours of the split that is the best curve with its break there. Otherwise the best
    break of the interval is one of its ends, where the fit is linear. The least sum of squares of
    all counts (D. J. Hudson, J. Am. Stat. Assoc. 61, 1966); among very many points every so many
    splits are tried first.

    Examples
    --------
    >>> x = np.linspace(0.0, 1.0, 21)
    >>> fit = bilinear_fit(x, 1.0 + 2.0 * np.minimum(x, 0.43))
    >>> round(fit.break_x, 6), round(fit.break_y, 6), abs(fit.slope_after) < 1e-9
    (0.43, 1.86, True)
    """
    order = np.argsort(x, kind="stable")
    x, y = np.asarray(x)[order], np.asarray(y)[order]
    ends = np.unique(x)
    if len(ends) < 2 * FEWEST:
        return None
    best: Found | None = None
    first, last = FEWEST - 1, len(ends) - FEWEST
    step = max(1, (last - first) // COARSE_SPLITS)
    splits = range(first, last, step)
    while True:
        for split in splits:
            for knee in _candidates(x, y, ends[split], ends[split + 1]):
                found = Found(split, knee, *_fixed_break(x, y, knee))
                if best is None or found.squares < best.squares:
                    best = found
        assert best is not None, "there is a split between any two groups of points"
        if step == 1:
            return best.curve(len(x))
        splits = range(max(first, best.split - step), min(last, best.split + step))
        step = 1


class Found(NamedTuple):
    """The best curve with a given break."""

    split: int
    knee: float
    coefficients: Array
    squares: float

    def curve(self, points: int) -> Bilinear:
        """The curve, fitted to so many points."""
        start, slope, after = self.coefficients.tolist()
        return Bilinear(
            start=start,
            slope=slope,
            break_x=float(self.knee),
            break_y=float(start + slope * self.knee),
            slope_after=after,
            residual=float(np.sqrt(self.squares / max(points - 4, 1))),
        )


def _candidates(x: Array, y: Array, left: float, right: float) -> list[float]:
    """Where two free lines cross between two neighbours, or else the neighbours."""
    before = x <= left
    (a, b), (c, d) = (_line(x[side], y[side]) for side in (before, ~before))
    if b != d:
        crossing = (c - a) / (b - d)
        if left <= crossing <= right:
            return [crossing]
    return [left, right]


def _line(x: Array, y: Array) -> tuple[float, float]:
    middle = float(x.mean())
    spread = x - middle
    slope = float(spread @ (y - y.mean()) / (spread @ spread))
    return float(y.mean()) - slope * middle, slope


def _fixed_break(x: Array, y: Array, knee: float) -> tuple[Array, float]:
    """Coefficients and sum of squares with the break at a given place."""
    columns = np.column_stack([np.ones_like(x), np.minimum(x, knee), np.maximum(x - knee, 0.0)])
    coefficients = np.linalg.lstsq(columns, y, rcond=None)[0]
    return coefficients, float(np.sum((y - columns @ coefficients) ** 2))
