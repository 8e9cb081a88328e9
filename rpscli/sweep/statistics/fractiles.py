"""Fractiles of demands in which an overturned history is larger than any demand."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from rpscli.sweep.table import Array, Table

HIGH = 0.84


class Spread(NamedTuple):
    """Median, 84 % fractile and largest value; infinite where so many overturned."""

    median: float
    high: float
    largest: float


def demand(table: Table, values: Array) -> Array:
    """(points,) values; infinite where the structure overturned, NaN where the point failed."""
    reached = np.where(table.overturned, np.inf, values)
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


def spread(demands: Array) -> Spread:
    """Median, 84 % fractile and largest demand; NaN where a history that stood has none."""
    if np.isnan(demands).any():
        return Spread(np.nan, np.nan, np.nan)
    return Spread(*fractiles(demands, (0.5, HIGH, 1.0)).tolist())
