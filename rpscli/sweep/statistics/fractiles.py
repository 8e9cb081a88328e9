"""Shares of histories with their intervals; fractiles in which an
overturned one is the worst.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.records.recordings import By
from rpscli.sweep.table import Array, Indices, Outcomes

CONFIDENCE = 0.95
LEAST_SHOWN = 5e-4
"""Lower ends of intervals below this are shown as 0."""
LOW = 0.16
HIGH = 0.84
THREE = (LOW, 0.50, HIGH)
"""Fractiles of bands about a median."""
ROUNDING = 1e-9
"""Of shares times numbers of histories, which are meant as whole numbers."""


class Share(NamedTuple):
    """A count out of a number of histories, and the interval of the
    probability; NaN without any.

    The interval is that of Clopper and Pearson, exact for independent histories, see
    `clustered` for others: `recordings` are behind them, or events if `by` says so. Where
    none or all are counted it has one end only, which then has the whole confidence.
    """

    number: int
    of: int
    low: float
    high: float
    recordings: int
    by: By = "recordings"
    effective: float = float("nan")
    """So many independent histories tell as much, if these are not."""

    @property
    def fraction(self) -> float | None:
        """The share; None without histories."""
        return self.number / self.of if self.of else None

    @property
    def interval(self) -> str:
        """The interval in words."""
        if not self.of:
            return "-"
        if self.number in {0, self.of}:
            return f"above {self.low:#.2g}" if self.number else f"below {self.high:#.2g}"
        low = f"{self.low:#.2g}" if self.low >= LEAST_SHOWN else "0"
        return f"{low} to {self.high:#.2g}"

    def __str__(self) -> str:
        """Counts and interval."""
        return (
            f"{self.number} of {self.of}{self.behind} ({100.0 * CONFIDENCE:g} %:"
            f" {self.interval})"
        )

    @property
    def behind(self) -> str:
        """Number of recordings or events behind the histories, where these are fewer."""
        if self.recordings == self.of:
            return ""
        return (
            f" from {self.recordings} {self.by[:-1] if self.recordings == 1 else self.by}"
        )


def share(number: int, of: int) -> Share:
    """The share of independent histories in which something happened."""
    return Share(number, of, *_interval(number, of), of)


def clustered(
    happened: NDArray[np.bool_], cluster: Indices, by: By = "recordings"
) -> Share:
    """The share of histories (m,) of clusters (m,), whose histories
    need not be independent.

    The interval is that of fewer, independent ones: their number is divided by how much
    more the counts of clusters scatter than those of independent histories would (the
    effective sample size of E. L. Korn and B. I. Graubard, Survey Methodology 24,
    1998), but by no more than if all histories of a cluster ended alike. What few
    clusters show of their scatter is little, and nothing where none or all are counted;
    so two more are taken in for it, one in which it happened in all histories, and one
    in which it happened in none.
    """
    number = int(happened.sum())
    of = len(happened)
    names, place = np.unique(cluster, return_inverse=True)
    if len(names) == of:
        return share(number, of)._replace(by=by)
    sizes = np.bincount(place).astype(float)
    alike = of**2 / float(np.sum(sizes**2))
    mean = of / len(names)
    counts = np.append(np.bincount(place, happened), [mean, 0.0])
    sizes = np.append(sizes, [mean, mean])
    total = sizes.sum()
    several = len(sizes)
    p = counts.sum() / total
    scatter = (
        several / (several - 1.0) * float(np.sum((counts - p * sizes) ** 2)) / total**2
    )
    effective = min(max(of * p * (1.0 - p) / total / scatter, alike), of)
    low, high = _interval(number * effective / of, effective)
    return Share(number, of, low, high, len(names), by, effective)


def share_of(table: Outcomes, points: Indices, happened: NDArray[np.bool_]) -> Share:
    """The share of some points (m,) in which something happened (m,)."""
    return clustered(happened, table.clusters[points], table.independent)


@lru_cache(maxsize=65_536)
def _interval(number: float, of: float) -> tuple[float, float]:
    """Clopper's and Pearson's; the numbers need not be whole."""
    # Not `scipy.stats.binomtest`, whose import takes as long as a thousand histories.
    from scipy.special import betaincinv

    if not of:
        return float("nan"), float("nan")
    beyond = 1.0 - CONFIDENCE
    end = beyond if number in {0, of} else 0.5 * beyond
    low = betaincinv(number, of - number + 1, end) if number else 0.0
    high = betaincinv(number + 1, of - number, 1.0 - end) if number < of else 1.0
    return float(low), float(high)


@lru_cache(maxsize=4096)
def shown_by(found: Share, admissible: float) -> int:
    """Number of recordings that would end the interval at an
    admissible share, no more beyond.
    """
    effective = found.of if math.isnan(found.effective) else found.effective
    number = (
        found.number if effective == found.of else found.number * effective / found.of
    )
    each = found.recordings / effective
    most = math.ceil(number) + 1
    while _interval(number, most)[1] > admissible:
        most *= 2
    counts = range(math.ceil(number) + 1, most)
    least = bisect_left(counts, -admissible, key=lambda of: -_interval(number, of)[1])
    return math.ceil((counts.start + least) * each)


class Spread(NamedTuple):
    """Median, 84 % fractile, largest value and mean; infinite where so many overturned.

    Of a result of which small values are bad: median, 16 % fractile, least
    value and mean. `low_stands` and `high_stands` are the least and the
    largest that did not overturn.
    """

    median: float
    high: float
    largest: float
    mean: float
    low_stands: float
    high_stands: float


def demand(table: Outcomes, values: Array, *, from_below: bool = False) -> Array:
    """(points,) of a result; overturned infinite (minus, if small is bad), failed NaN."""
    reached = np.where(table.overturned, -np.inf if from_below else np.inf, values)
    return np.where(table.failed, np.nan, reached)


def fractiles(demands: Array, shares: Sequence[float]) -> Array:
    """The smallest demand not exceeded by each share; NaN is left out."""
    known = np.sort(demands[~np.isnan(demands)])
    if not len(known):
        return np.full(len(shares), np.nan)
    return np.asarray(known[_places(tuple(shares), len(known))])


@lru_cache(maxsize=4096)
def _places(shares: tuple[float, ...], total: int) -> list[int]:
    """Places of the least of so many ordered values that so
    large shares do not exceed.
    """
    return [max(math.ceil(share * total - ROUNDING), 1) - 1 for share in shares]


def spread(demands: Array, *, from_below: bool = False) -> Spread:
    """Median, fractile, worst and mean of demands; NaN where a
    history that stood has none.
    """
    if np.isnan(demands).any() or not len(demands):
        return Spread(*[np.nan] * len(Spread._fields))
    shares = (0.5, LOW, 0.0) if from_below else (0.5, HIGH, 1.0)
    median, high, largest = fractiles(demands, shares).tolist()
    standing = demands[np.isfinite(demands)]
    ends = [float(end(standing)) if len(standing) else np.nan for end in (np.min, np.max)]
    return Spread(median, high, largest, float(np.mean(demands)), *ends)
