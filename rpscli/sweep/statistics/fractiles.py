"""Fractiles of results in which an overturned history is worse than any result."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from rpscli.sweep.table import Array, Table

LOW, HIGH = 0.16, 0.84


class Spread(NamedTuple):
    """Median, 84 % fractile and largest value; infinite where so many overturned.

    Of a result of which small values are bad: median, 16 % fractile and least value.
    """

    median: float
    high: float
    largest: float


def demand(table: Table, values: Array, *, from_below: bool = False) -> Array:
    """(points,) values; infinite where the structure overturned, NaN where the point failed.

    Parameters
    ----------
    values
        (points,) of a result.
    from_below
        Whether small values are bad, so that an overturned history has minus infinity.
    """
    reached = np.where(table.overturned, -np.inf if from_below else np.inf, values)
    return np.where(table.failed, np.nan, reached)


def fractiles(demands: Array, shares: Sequence[float]) -> Array:
    """The least demands that so large shares of the demands do not exceed.

    They are demands of the sample themselves, so that infinite ones may stand.

    Parameters
    ----------
    demands
        (points,) infinite where overturned; NaN is left out.
    shares
        From 0 to 1.

    Examples
    --------
    >>> fractiles(np.array([3.0, np.inf, 1.0, 2.0]), [0.5, 0.75, 0.76]).tolist()
    [2.0, 3.0, inf]
    """
    known = np.sort(demands[~np.isnan(demands)])
    if not len(known):
        return np.full(len(shares), np.nan)
    return np.asarray(np.quantile(known, shares, method="inverted_cdf"))


def spread(demands: Array, *, from_below: bool = False) -> Spread:
    """Median, 84 % fractile and largest demand, or from below the 16 % fractile and the least.

    They are NaN where a history that stood has none.
    """
    if np.isnan(demands).any():
        return Spread(np.nan, np.nan, np.nan)
    shares = (0.5, LOW, 0.0) if from_below else (0.5, HIGH, 1.0)
    return Spread(*fractiles(demands, shares).tolist())
