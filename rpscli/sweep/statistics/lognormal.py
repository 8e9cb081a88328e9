"""A lognormal fragility through yes-or-no data, with bands by bootstrap.

It is a probit regression on the logarithm of the intensity, P(y = 1) = Phi(a + b x), for
many weightings of the data at once. With data that some x separates the likelihood has no
maximum: b grows without end. Jeffreys' prior as a penalty, the log of the root of the
information's determinant, keeps the estimates finite, and takes away most of their bias
in small samples. But beta is then the prior's, and would be in every bootstrap sample:
such data have no bands. Where samples of other data are separated, or fall with the
intensity, they determine nothing, and count as beyond both ends of a band; if they are
more than its tails there is none.

References
----------
D. Firth, Biometrika 80, 1993; I. Kosmidis and D. Firth, Biometrika 108, 2021 (the penalty
for any link, and that its estimates are always finite).
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

LEAST_SLOPE = 0.01
"""Of a sample of the records that determines a fragility; beta is above 100 below it."""
LARGEST_ARRAY = 1_000_000
"""Resamples times points that are fitted at once: a dozen
arrays of this size are held."""

NOTHING: Band = (math.nan, math.nan)


class Bootstrap(NamedTuple):
    """Number of the samples that bands come from, the probability
    inside them, and the seed.
    """

    resamples: int
    confidence: float
    seed: int


@dataclass(frozen=True, eq=False)
class Lognormal:
    """Phi(ln(im/median)/beta); NaN where there is no fit.

    `note` tells what keeps the fit from being an ordinary one. `curve` and `band` are at
    the intensities asked for; the bands enclose the confidence asked for, and are NaN
    where they are not determined. `resampled` are median and beta, each (samples,), of
    the bootstrap samples, NaN of those that determine neither. Separated data say no more
    than that the median lies `between` an intensity up to which no point exceeds the
    limit and one from which all do.
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
    between: Band = (0.0, math.inf)

    @property
    def fitted(self) -> bool:
        """True if there is a curve."""
        return self.method != "none"


def lognormal_fit(
    intensity: Array,
    exceeded: NDArray[np.bool_],
    cluster: Indices,
    weight: float,
    grid: Array,
    bootstrap: Bootstrap,
    level: Array | None = None,
) -> Lognormal:
    """A lognormal distribution function through data (points,), at
    the intensities of a grid.
    """
    # The bootstrap draws whole clusters. A weight below 1 is that of variations that
    # share a motion; the penalty is the stronger for it. A `level` (points,) is the
    # intensity without small perturbations, which cannot tell what intensities do: by it
    # data are called separated.
    x = np.log(intensity)
    level = intensity if level is None else level
    note = _hopeless(level, exceeded)
    if note is not None:
        return _no_fit(note, grid)
    once = np.full((1, len(x)), weight)
    apart = bool(separated(level, exceeded, once)[0])
    fit = probit_fit(x, exceeded, once, np.array([apart]))
    if not fit.converged[0]:
        return _no_fit(f"the fit did not converge in {MOST_STEPS} steps", grid)
    if not fit.slope[0] > 0.0:
        return _no_fit("the share does not grow with the intensity", grid)
    median, beta = _moments(fit)
    between, note = _separation(level, exceeded) if apart else ((0.0, math.inf), None)
    fits, lost = _resampled(x, level, exceeded, cluster, weight, bootstrap, apart=apart)
    medians, betas = _moments(fits)
    return Lognormal(
        method="penalised" if apart else "maximum likelihood",
        note=note or lost,
        median=float(median[0]),
        beta=float(beta[0]),
        median_band=band(medians, bootstrap.confidence),
        beta_band=band(betas, bootstrap.confidence),
        curve=_probability(fit, grid)[0],
        band=bands(_probability(fits, grid), bootstrap.confidence),
        resampled=(medians, betas),
        between=between,
    )


def _hopeless(level: Array, y: NDArray[np.bool_]) -> str | None:
    """The reason why the data give no fragility; None if they may."""
    if not len(level):
        return "no point is left"
    if not y.any():
        return "no point exceeds the limit; larger intensities are needed"
    if y.all():
        return "every point exceeds the limit; smaller intensities are needed"
    return "all points have one intensity" if len(np.unique(level)) == 1 else None


def _separation(level: Array, y: NDArray[np.bool_]) -> tuple[Band, str]:
    """Between which intensities separated data change from none to
    all, and what to say of it.
    """
    top = float(level[~y].max())
    bottom = float(level[y].min())
    none = level[level < bottom]
    every = level[level > top]
    between = float(none.max(initial=0.0)), float(every.min(initial=math.inf))
    if top < bottom:
        where = f"up to {top:.4g} no point exceeds the limit, from {bottom:.4g} on all do"
    else:
        here = level == top
        below = "none at smaller ones" if len(none) else "no smaller one was computed"
        above = "all at larger ones" if len(every) else "no larger one was computed"
        counts = f"{int(y[here].sum())} of {int(here.sum())} points exceed the limit"
        where = f"at the intensity {top:.4g} alone {counts}, {below}, {above}"
    return between, (
        f"the data are separated: {where}; beta comes from a penalty (Firth), not from"
        " the data, so that there are no bands. Add records, or intensities around these"
    )


def _no_fit(note: str, grid: Array) -> Lognormal:
    nothing = np.full(len(grid), math.nan)
    band = (nothing, nothing)
    none = (np.empty(0), np.empty(0))
    return Lognormal(
        "none", note, math.nan, math.nan, NOTHING, NOTHING, nothing, band, none
    )


def _resampled(
    x: Array,
    level: Array,
    y: NDArray[np.bool_],
    cluster: Indices,
    weight: float,
    bootstrap: Bootstrap,
    *,
    apart: bool,
) -> tuple[Probit, str | None]:
    """Fits to bootstrap samples of the records, NaN of those
    without, and how many these are.
    """
    count = 0 if apart else bootstrap.resamples
    generator = np.random.default_rng(bootstrap.seed)
    names, place = np.unique(cluster, return_inverse=True)
    even = np.full(len(names), 1.0 / len(names))
    # One fewer than there are: with all, variances are too small by that part of them.
    drawn = generator.multinomial(max(len(names) - 1, 1), even, size=count).astype(float)
    rows = max(1, LARGEST_ARRAY // len(x))
    parts = [Probit(np.empty(0), np.empty(0), np.empty(0, dtype=bool))]
    for first in range(0, count, rows):
        weights = weight * drawn[first : first + rows, place]
        unknown = separated(level, y, weights)
        fit = probit_fit(x, y, weights, unknown, CLOSE_ENOUGH_RESAMPLED)
        parts.append(fit._replace(converged=fit.converged & ~unknown))
    found = Probit(*(np.concatenate(values) for values in zip(*parts, strict=True)))
    kept = found.converged & (found.slope > LEAST_SLOPE)
    intercept, slope = (np.where(kept, values, math.nan) for values in found[:2])
    note = None
    if lost := int((~kept).sum()):
        none = (
            ""
            if lost <= 0.5 * (1.0 - bootstrap.confidence) * count
            else ": too many for bands"
        )
        note = (
            f"{lost} of {count} bootstrap samples of the records give no fragility{none}"
        )
    return Probit(intercept, slope, kept), note


def bands(values: Array, confidence: float) -> tuple[Array, Array]:
    """Ends (n,) that enclose the confidence of values (samples,
    n); NaN counts beyond both.
    """
    if not len(values):
        return (np.full(values.shape[1:], math.nan),) * 2
    tail = 50.0 * (1.0 - confidence)
    unknown = np.isnan(values)
    low = np.percentile(np.where(unknown, -np.inf, values), tail, axis=0, method="lower")
    high = np.percentile(
        np.where(unknown, np.inf, values), 100.0 - tail, axis=0, method="higher"
    )
    known = np.isfinite(low) & np.isfinite(high)
    return np.where(known, low, math.nan), np.where(known, high, math.nan)


def band(values: Array, confidence: float) -> Band:
    """Ends that enclose the confidence of single values (samples,)."""
    low, high = bands(values, confidence)
    return float(low), float(high)


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
"""Linear predictor beyond which probabilities are 0 or 1 to
rounding, and densities vanish."""
CLOSE_ENOUGH = 1e-10
"""Change of both coefficients, in units of the standardised
variable, at which a fit is over."""
CLOSE_ENOUGH_RESAMPLED = 1e-4
"""Such a change for fits to bootstrap samples, whose percentiles are rough anyway."""


class Probit(NamedTuple):
    """Coefficients, each (fits,), in P = Phi(intercept + slope x);
    no fit unless converged.
    """

    intercept: Array
    slope: Array
    converged: NDArray[np.bool_]


def separated(x: Array, y: NDArray[np.bool_], weights: Array) -> NDArray[np.bool_]:
    """(fits,) whether some x tells all zeros of y from all
    ones, or one kind is missing.
    """
    counts = weights > 0.0
    ones = counts & y
    zeros = counts & ~y
    (low, top) = _span(x, zeros)
    (high, bottom) = _span(x, ones)
    return np.asarray((top <= high) | (bottom <= low))


def _span(x: Array, chosen: NDArray[np.bool_]) -> tuple[Array, Array]:
    """(fits,) least and largest x of the chosen (fits, points)."""
    least = np.where(chosen, x, math.inf)
    largest = np.where(chosen, x, -math.inf)
    return least.min(axis=1), largest.max(axis=1)


@np.errstate(over="ignore")  # where all points have one x
def probit_fit(
    x: Array,
    y: NDArray[np.bool_],
    weights: Array,
    penalised: NDArray[np.bool_],
    close_enough: float = CLOSE_ENOUGH,
) -> Probit:
    """Fit every row of weights by Fisher scoring, with or without the penalty."""
    # The penalty adjusts the score by h/2 times the logarithmic derivative of the working
    # weight, h being the leverage. Data with a single x have no slope even so: they do
    # not converge.
    middle = float(x.mean())
    spread = float(x.std()) or 1.0
    z = (x - middle) / spread
    penalty = penalised.astype(float)
    at = np.zeros((2, len(weights)))
    objective, steps = _evaluated(at, z, y, weights, penalty)
    low, high = _span(x, weights > 0.0)
    several = low < high
    active = several.copy()
    for _ in range(MOST_STEPS):
        rows = np.flatnonzero(active)
        if not len(rows):
            break
        step = steps[:, rows]
        before = objective[rows]
        for _ in range(MOST_HALVINGS):
            there = _evaluated(at[:, rows] + step, z, y, weights[rows], penalty[rows])
            worse = ~(there[0] >= before - 1e-12 * np.abs(before))
            if not worse.any():
                break
            step[:, worse] *= 0.5
        at[:, rows] += step
        objective[rows], steps[:, rows] = there
        active[rows] = np.abs(step).max(axis=0) > close_enough
    a, b = at
    return Probit(a - b * middle / spread, b / spread, several & ~active)


def _evaluated(
    at: Array, z: Array, y: NDArray[np.bool_], weights: Array, penalty: Array
) -> tuple[Array, Array]:
    """Objective (fits,), and the step of Fisher scoring from here (2, fits)."""
    from scipy.special import ndtr

    eta = np.clip(at[0][:, None] + at[1][:, None] * z, -LARGEST, LARGEST)
    tail = ndtr(-np.abs(eta))  # the small one of both, which must not lose digits
    p, q = np.where(eta > 0.0, (1.0 - tail, tail), (tail, 1.0 - tail))
    density = np.exp(-0.5 * eta**2) / math.sqrt(2.0 * math.pi)
    pull = density / (p * q)
    working = weights * density * pull
    i0 = working.sum(axis=1)
    i1 = working @ z
    i2 = working @ z**2
    determinant = np.maximum(i0 * i2 - i1**2, 1e-300)
    objective = np.sum(weights * np.log(np.where(y, p, q)), axis=1)
    score = weights * (y - p) * pull
    if penalty.any():
        objective = objective + penalty * 0.5 * np.log(determinant)
        leverage = i2[:, None] - 2.0 * i1[:, None] * z + i0[:, None] * z**2
        leverage *= working / determinant[:, None]
        growth = -2.0 * eta - pull * (q - p)
        score += penalty[:, None] * 0.5 * leverage * growth
    u0 = score.sum(axis=1)
    u1 = score @ z
    step = np.array([i2 * u0 - i1 * u1, i0 * u1 - i1 * u0]) / determinant
    return objective, step
