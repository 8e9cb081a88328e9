"""A lognormal fragility through yes-or-no data, with bands by bootstrap."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.sweep.fits.probit import (
    CLOSE_ENOUGH_RESAMPLED,
    MOST_STEPS,
    Probit,
    probit_fit,
    separated,
)

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


def lognormal_fit(
    intensity: Array,
    exceeded: NDArray[np.bool_],
    cluster: Indices,
    weight: float,
    grid: Array,
    bootstrap: Bootstrap,
) -> Lognormal:
    """Fit a lognormal distribution function.

    Parameters
    ----------
    intensity, exceeded
        (points,) data.
    cluster
        (points,) what belongs together: the bootstrap draws whole records.
    weight
        What a point counts: less than 1 where many variations share a motion, which do not tell
        as much as so many motions would. The penalty is the stronger for it.
    grid
        Intensities at which the curve is wanted.
    bootstrap
        How the bands are had.
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
