"""The set of scaled spectra that meets a goal best, sought by exchange from many first choices."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]

STARTS = 100
"""First choices at most, each grown from another motion and improved by exchange."""

KICKS = 100
"""Times that the best choice is left by three motions at random, and improved again."""

ROUNDING = 2e-5
"""By which a least value is passed: factors are written with six digits."""

SHORT = 10.0
"""Weight of what is missing to a requirement [1/ln]: more than any fit can win."""


class Pool(NamedTuple):
    """What may be chosen: `spectra` (m, 1 + n) under `factors` (m,), the PGA before the periods.

    Of one of the `recordings` (m,) one is chosen at most; `events` (m,) number the earthquakes.
    """

    spectra: Array
    factors: Array
    recordings: Numbers
    events: Numbers


@dataclass(frozen=True, eq=False)
class Goal:
    """What the mean of a set is to have; or the mean and the deviation of ln Sa.

    `wanted` is (1 + n,), `deviation` (n,). Of the mean over `wanted` at least `least` is required
    at all periods, and 1 of the `pga`. One common factor may bring the set there, within the
    `bounds` of every single factor, unless they are `fixed`.
    """

    wanted: Array
    deviation: Array | None = None
    least: float = 0.0
    pga: bool = False
    bounds: tuple[float, float] = (0.0, math.inf)
    fixed: bool = False

    def features(self, spectra: Array) -> Array:
        """(m, features) of scaled spectra; the sum of those of a set decides on it."""
        if self.deviation is None:
            return spectra
        logarithms = np.log(spectra[:, 1:])
        return np.hstack([logarithms, logarithms**2])

    def judged(self, total: Array, size: int, least: Array, most: Array) -> tuple[Array, Array]:
        """Cost and logarithm of the common factor, (...), of sets with sums (..., features)."""
        if self.deviation is not None:
            first, second = np.split(total / size, 2, axis=-1)
            scatter = np.sqrt(np.maximum(second - first**2, 0.0) * size / max(size - 1, 1))
            errors = (first - np.log(self.wanted[1:])) ** 2 + (scatter - self.deviation) ** 2
            return np.sqrt(errors.mean(axis=-1)), np.zeros(errors.shape[:-1])
        ratio = np.log(total / size / self.wanted)
        shape = ratio[..., 1:]
        offset = shape.mean(axis=-1)
        needed = np.full(offset.shape, -np.inf)
        if self.least > 0.0:
            needed = math.log(self.least) + ROUNDING - shape.min(axis=-1)
        if self.pga:
            needed = np.maximum(needed, ROUNDING - ratio[..., 0])
        common = np.zeros(offset.shape)
        if not self.fixed:
            low, high = (math.log(bound) if bound else -math.inf for bound in self.bounds)
            common = np.clip(np.maximum(-offset, needed), low - np.log(least), high - np.log(most))
        missing = np.maximum(needed - common, 0.0)
        cost = np.sqrt(shape.var(axis=-1) + (offset + common) ** 2) + SHORT * missing
        return cost, common

    def of_set(self, features: Array, factors: Array) -> tuple[float, float]:
        """Cost and common factor of one set, with features (size, ...) under factors (size,)."""
        total = features.sum(axis=0)
        cost, common = self.judged(total, len(factors), factors.min(), factors.max())
        return float(cost), math.exp(float(common))


def best_choice(pool: Pool, goal: Goal, count: int, per_event: int) -> list[int]:
    """Places of the best set that is found, in order; the same for the same motions."""
    search = _Search(pool, goal, per_event)
    alone, _ = goal.judged(search.features, 1, pool.factors, pool.factors)
    first = np.argsort(alone, kind="stable")[:STARTS].tolist()
    cost, places = min(search.exchanged(search.grown([one], count)) for one in first)
    random = np.random.default_rng(1)
    for _ in range(KICKS):
        kept = random.permutation(places)[min(3, count - 1) :].tolist()
        while len(kept) < count:
            kept.append(int(random.choice(np.flatnonzero(search.free(kept)))))
        cost, places = min((cost, places), search.exchanged(kept))
    return places


class _Search:
    """Moves among the sets of a pool."""

    def __init__(self, pool: Pool, goal: Goal, per_event: int) -> None:
        self.pool, self.goal, self.per_event = pool, goal, per_event
        self.features = goal.features(pool.spectra)

    def free(self, places: list[int]) -> NDArray[np.bool_]:
        """(m,) what may still be chosen beside these places."""
        _, _, recordings, events = self.pool
        used = np.bincount(recordings[places], minlength=int(recordings.max()) + 1)
        taken = np.bincount(events[places], minlength=int(events.max()) + 1)
        return np.asarray((used[recordings] == 0) & (taken[events] < self.per_event))

    def cost(self, places: list[int]) -> float:
        """Of a set."""
        return self.goal.of_set(self.features[places], self.pool.factors[places])[0]

    def with_one_more(self, places: list[int]) -> tuple[float, int] | None:
        """The least cost of these places and another one, and that; None if none is free."""
        others = np.flatnonzero(self.free(places))
        if not len(others):
            return None
        total = self.features[places].sum(axis=0) + self.features[others]
        factors, more = self.pool.factors[places], self.pool.factors[others]
        least, most = np.minimum(factors.min(), more), np.maximum(factors.max(), more)
        cost, _ = self.goal.judged(total, len(places) + 1, least, most)
        best = int(np.argmin(cost))
        return float(cost[best]), int(others[best])

    def grown(self, places: list[int], count: int) -> list[int]:
        """These places and the best next one each time."""
        while len(places) < count and (found := self.with_one_more(places)):
            places = [*places, found[1]]
        return places

    def exchanged(self, places: list[int]) -> tuple[float, list[int]]:
        """The cost and the places after the best exchanges, until none helps."""
        now = self.cost(places)
        while len(places) > 1:
            rest = [[place for place in places if place != out] for out in places]
            moves = [(found, kept) for kept in rest if (found := self.with_one_more(kept))]
            (cost, other), kept = min(moves)
            # Rounding of the sums must not look like progress, or it would never end.
            if cost >= now - 1e-12:
                break
            now, places = cost, [*kept, other]
        return self.cost(sorted(places)), sorted(places)
