"""A lognormal fragility through yes-or-no data, with bands by bootstrap.

It is a probit regression on the logarithm of the intensity, P(y = 1) = Phi(a + b x), for many
weightings of the data at once. With data that some x separates the likelihood has no maximum: b
grows without end. Jeffreys' prior as a penalty, the log of the root of the information's
determinant, keeps the estimates finite, and takes away most of their bias in small samples.

References
----------
D. Firth, Biometrika 80, 1993; I. Kosmidis and D. Firth, Biometrika 108, 2021 (the penalty for any
link, and that its estimates are always finite).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Method = Literal["maximum likelihood", "penalised", "none"]
Band = tuple[float, float]

LARGEST_ARRAY = 1_000_000
"""Resamples times points that are fitted at once: a dozen arrays of this size are held."""

NOTHING: Band = (math.nan, math.nan)


class Bootstrap(NamedTuple):
    """How many samples the bands come from, the probability inside them, and the seed."""

    resamples: int
    confidence: float
    seed: int


@dataclass(frozen=True, eq=False)
class Lognormal:
    """Phi(ln(im/median)/beta); NaN where there is no fit.

    `note` tells what keeps the fit from being an ordinary one. `curve` and `band` are at the
    intensities asked for; the bands enclose the confidence asked for. `resampled` are median and
    beta, each (samples,), of the bootstrap samples that could be fitted.
    """

    method: Method
    note: str | None
    median: float
    beta: float
    median_band: Band
    beta_band: Band
    curve: Array
    band: tuple[Array, Array]
    resampled: tuple[Array, Array]

    @property
    def fitted(self) -> bool:
        """Whether there is a curve."""
        return self.method != "none"


def lognormal_fit(
    intensity: Array,
    exceeded: NDArray[np.bool_],
    cluster: Indices,
    weight: float,
    grid: Array,
    bootstrap: Bootstrap,
) -> Lognormal:
    """A lognormal distribution function through data (points,), at the intensities of a grid.

    The bootstrap draws whole clusters, which are records. A point has a weight below 1 where many
    variations share a motion, which do not tell as much as so many motions would; the penalty is
    the stronger for it.
    """
    x = np.log(intensity)
    note = _hopeless(x, exceeded)
    if note is not None:
        return _no_fit(note, grid)
    once = np.full((1, len(x)), weight)
    apart = bool(separated(x, exceeded, once)[0])
    fit = probit_fit(x, exceeded, once, np.array([apart]))
    if not fit.converged[0]:
        return _no_fit(f"the fit did not converge in {MOST_STEPS} steps", grid)
    if not fit.slope[0] > 0.0:
        return _no_fit("the share does not grow with the intensity", grid)
    median, beta = _moments(fit)
    fits, lost = _resampled(x, exceeded, cluster, weight, bootstrap)
    medians, betas = _moments(fits)
    tails = (50.0 * (1.0 - bootstrap.confidence), 50.0 * (1.0 + bootstrap.confidence))
    return Lognormal(
        method="penalised" if apart else "maximum likelihood",
        note="; ".join([_separated_note(x, exceeded)] * apart + lost) or None,
        median=float(median[0]),
        beta=float(beta[0]),
        median_band=percentiles(medians, tails),
        beta_band=percentiles(betas, tails),
        curve=_probability(fit, grid)[0],
        band=_band(fits, grid, tails),
        resampled=(medians, betas),
    )


def _hopeless(x: Array, y: NDArray[np.bool_]) -> str | None:
    """Why no fragility can be had from the data."""
    if not len(x):
        return "no point is left"
    if not y.any():
        return "no point exceeds the limit; larger intensities are needed"
    if y.all():
        return "every point exceeds the limit; smaller intensities are needed"
    return "all points have one intensity" if len(np.unique(x)) == 1 else None


def _separated_note(x: Array, y: NDArray[np.bool_]) -> str:
    low, high = math.exp(x[~y].max()), math.exp(x[y].min())
    if low == high:
        where = f"below {low:.4g} no point exceeds the limit, above all do"
    else:
        where = f"up to {low:.4g} no point exceeds the limit, from {high:.4g} on all do"
    return (
        f"the data are separated: {where}; beta comes from the penalty (Firth), not from the data."
        " Add records, or intensities in between"
    )


def _no_fit(note: str, grid: Array) -> Lognormal:
    nothing = np.full(len(grid), math.nan)
    band, none = (nothing, nothing), (np.empty(0), np.empty(0))
    return Lognormal("none", note, math.nan, math.nan, NOTHING, NOTHING, nothing, band, none)


def _resampled(
    x: Array, y: NDArray[np.bool_], cluster: Indices, weight: float, bootstrap: Bootstrap
) -> tuple[Probit, list[str]]:
    """Fits to bootstrap samples of the records, and in words how many of them have none."""
    if not bootstrap.resamples:
        return Probit(np.empty(0), np.empty(0), np.empty(0, dtype=bool)), []
    generator = np.random.default_rng(bootstrap.seed)
    names, place = np.unique(cluster, return_inverse=True)
    even = np.full(len(names), 1.0 / len(names))
    drawn = generator.multinomial(len(names), even, size=bootstrap.resamples).astype(float)
    rows = max(1, LARGEST_ARRAY // len(x))
    parts = [
        _fits(x, y, weight * drawn[first : first + rows, place])
        for first in range(0, len(drawn), rows)
    ]
    found = Probit(*(np.concatenate(values) for values in zip(*parts, strict=True)))
    kept = found.converged
    lost = int((~kept).sum())
    notes = [f"{lost} of {bootstrap.resamples} bootstrap samples have no fit"] if lost else []
    return Probit(found.intercept[kept], found.slope[kept], kept[kept]), notes


def _band(fits: Probit, grid: Array, tails: tuple[float, float]) -> tuple[Array, Array]:
    if not len(fits.slope):
        nothing = np.full(len(grid), math.nan)
        return nothing, nothing
    low, high = np.percentile(_probability(fits, grid), tails, axis=0)
    return low, high


def _fits(x: Array, y: NDArray[np.bool_], weights: Array) -> Probit:
    return probit_fit(x, y, weights, separated(x, y, weights), CLOSE_ENOUGH_RESAMPLED)


def percentiles(values: Array, tails: tuple[float, float]) -> Band:
    """Percentiles [%] of the values that are finite; NaN without any."""
    known = values[np.isfinite(values)]
    if not len(known):
        return NOTHING
    low, high = np.percentile(known, tails).tolist()
    return low, high


def _moments(fit: Probit) -> tuple[Array, Array]:
    """Median and beta."""
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        return np.exp(-fit.intercept / fit.slope), 1.0 / fit.slope


def _probability(fit: Probit, grid: Array) -> Array:
    from scipy.special import ndtr

    return np.asarray(ndtr(fit.intercept[:, None] + fit.slope[:, None] * np.log(grid)))


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
    """(fits,) whether some x tells all zeros of y from all ones, or one kind is missing."""
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
