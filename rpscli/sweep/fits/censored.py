"""Linear regression of what is known to lie between bounds, with normal scatter.

By maximum likelihood: a value between `low` and `high` has the probability Phi((high - m)/sigma) -
Phi((low - m)/sigma), m being linear in the covariates. Bounds may be infinite (T. Amemiya, J.
Econometrics 24, 1984; a tobit model).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Censored(NamedTuple):
    """Mean of the values, slope on each covariate, their scatter, logarithm of the likelihood."""

    mean: float
    slopes: Array
    sigma: float
    likelihood: float


def censored_fit(low: Array, high: Array, covariates: Array | None = None) -> Censored | None:
    """A regression on covariates (values, k); None where the bounds determine no scatter."""
    from scipy.optimize import minimize
    from scipy.special import log_ndtr

    if not len(low) or low.max() <= high.min():  # one value lies between all bounds
        return None
    known = np.empty((len(low), 0)) if covariates is None else covariates
    centre, spread = known.mean(axis=0), known.std(axis=0)
    if not spread.all():  # a covariate that is the same for all
        return None
    design = np.column_stack([np.ones(len(low)), (known - centre) / spread])
    middle = np.where(np.isinf(low), high, np.where(np.isinf(high), low, 0.5 * (low + high)))

    def loss(at: Array) -> float:
        mean, sigma = design @ at[:-1], math.exp(at[-1])
        a, b = (low - mean) / sigma, (high - mean) / sigma
        a, b = np.where(a > 0.0, (-b, -a), (a, b))  # where the tail is small, and has digits
        below, above = log_ndtr(a), log_ndtr(b)
        with np.errstate(divide="ignore"):
            return float(-np.sum(above + np.log(-np.expm1(below - above))))

    start = np.linalg.lstsq(design, middle, rcond=None)[0]
    first = np.append(start, math.log(max(float((middle - design @ start).std()), 1e-3)))
    found = minimize(
        loss, first, method="Nelder-Mead", options={"xatol": 1e-8, "fatol": 1e-10, "maxiter": 5000}
    )
    slopes = found.x[1:-1] / spread
    mean, sigma = float(found.x[0]), math.exp(found.x[-1])
    return Censored(mean, slopes, sigma, -float(found.fun)) if found.success else None


def chance(without: Censored, with_one: Censored, weight: float) -> float:
    """The p-value of one further covariate, by the ratio of likelihoods."""
    # A weight below 1 is that of values which hang together in so many independent clusters.
    return math.erfc(math.sqrt(max(weight * (with_one.likelihood - without.likelihood), 0.0)))
