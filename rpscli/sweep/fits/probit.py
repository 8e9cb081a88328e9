"""Probit regression on one variable, for many weightings of the data at once.

P(y = 1) = Phi(a + b x). With data that some x separates the likelihood has no maximum: b grows
without end. Jeffreys' prior as a penalty, the log of the root of the information's determinant,
keeps the estimates finite, and takes away most of their bias in small samples.

References
----------
D. Firth, Biometrika 80, 1993; I. Kosmidis and D. Firth, Biometrika 108, 2021 (the penalty for any
link, and that its estimates are always finite).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

MOST_STEPS = 200
MOST_HALVINGS = 30
LARGEST = 25.0
"""Linear predictor beyond which probabilities are 0 or 1 to rounding, and densities vanish."""
CLOSE_ENOUGH = 1e-10
"""Change of both coefficients, in units of the standardised variable, at which a fit is over."""
CLOSE_ENOUGH_RESAMPLED = 1e-4
"""The same for fits to bootstrap samples, whose percentiles are rough anyway."""


class Probit(NamedTuple):
    """Coefficients, each (fits,), in P = Phi(intercept + slope x); no fit unless converged."""

    intercept: Array
    slope: Array
    converged: NDArray[np.bool_]


def separated(x: Array, y: NDArray[np.bool_], weights: Array) -> NDArray[np.bool_]:
    """(fits,) whether some x tells all zeros from all ones, or one kind is missing.

    Parameters
    ----------
    x, y
        (points,) variable and outcome.
    weights
        (fits, points) how often each point counts.
    """
    counts = weights > 0.0
    ones, zeros = counts & y, counts & ~y
    (low, top), (high, bottom) = _span(x, zeros), _span(x, ones)
    return np.asarray((top <= high) | (bottom <= low))


def _span(x: Array, chosen: NDArray[np.bool_]) -> tuple[Array, Array]:
    """(fits,) least and largest x of the chosen (fits, points)."""
    least, largest = np.where(chosen, x, math.inf), np.where(chosen, x, -math.inf)
    return least.min(axis=1), largest.max(axis=1)


@np.errstate(over="ignore")  # where all points have one x
def probit_fit(
    x: Array,
    y: NDArray[np.bool_],
    weights: Array,
    penalised: NDArray[np.bool_],
    close_enough: float = CLOSE_ENOUGH,
) -> Probit:
    """Fit every row of weights, with or without the penalty.

    Notes
    -----
    Fisher scoring, halving steps that lower the objective. Adjustment of the score for the
    penalty: h/2 times the logarithmic derivative of the working weight, h being the leverage.
    Data with a single x have no slope even so: they do not converge.
    """
    middle, spread = float(x.mean()), float(x.std()) or 1.0
    z = (x - middle) / spread
    penalty = penalised.astype(float)
    at = np.zeros((2, len(weights)))
    here = _evaluated(at, z, y, weights, penalty)
    low, high = _span(x, weights > 0.0)
    several = low < high
    active = several.copy()
    for _ in range(MOST_STEPS):
        rows = np.flatnonzero(active)
        if not len(rows):
            break
        step = here.step[:, rows]
        for _ in range(MOST_HALVINGS):
            there = _evaluated(at[:, rows] + step, z, y, weights[rows], penalty[rows])
            before = here.objective[rows]
            worse = ~(there.objective >= before - 1e-12 * np.abs(before))
            if not worse.any():
                break
            step[:, worse] *= 0.5
        at[:, rows] += step
        here.objective[rows], here.step[:, rows] = there
        active[rows] = np.abs(step).max(axis=0) > close_enough
    a, b = at
    return Probit(a - b * middle / spread, b / spread, several & ~active)


class _Evaluated(NamedTuple):
    """Objective (fits,), and the step of Fisher scoring from here (2, fits)."""

    objective: Array
    step: Array


def _evaluated(
    at: Array, z: Array, y: NDArray[np.bool_], weights: Array, penalty: Array
) -> _Evaluated:
    from scipy.special import ndtr

    eta = np.clip(at[0][:, None] + at[1][:, None] * z, -LARGEST, LARGEST)
    tail = ndtr(-np.abs(eta))  # the small one of both, which must not lose digits
    p, q = np.where(eta > 0.0, (1.0 - tail, tail), (tail, 1.0 - tail))
    density = np.exp(-0.5 * eta**2) / math.sqrt(2.0 * math.pi)
    pull = density / (p * q)
    working = weights * density * pull
    i0, i1, i2 = working.sum(axis=1), working @ z, working @ z**2
    determinant = np.maximum(i0 * i2 - i1**2, 1e-300)
    objective = np.sum(weights * np.log(np.where(y, p, q)), axis=1)
    score = weights * (y - p) * pull
    if penalty.any():
        objective = objective + penalty * 0.5 * np.log(determinant)
        leverage = i2[:, None] - 2.0 * i1[:, None] * z + i0[:, None] * z**2
        leverage *= working / determinant[:, None]
        growth = -2.0 * eta - pull * (q - p)
        score += penalty[:, None] * 0.5 * leverage * growth
    u0, u1 = score.sum(axis=1), score @ z
    step = np.array([i2 * u0 - i1 * u1, i0 * u1 - i1 * u0]) / determinant
    return _Evaluated(objective, step)
