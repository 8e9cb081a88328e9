"""The best set of a pool of candidates: that of all sets, or sought by exchange."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]

WHOLE = 2_000_000  # most sets that are searched exhaustively
ROUNDS = 50  # searches, of which the best one counts
STARTS = 5  # first choices of a search at random, each improved by exchange
# times that the best of them is left by three motions at random, and improved again
KICKS = 50
ROUNDING = 2e-5  # by which a least value is passed: factors are written with six digits
SHORT = (
    10.0  # weight of what is missing to a requirement [1/ln]: more than any fit can win
)


class Pool(NamedTuple):
    """Candidates: `spectra` (m, 1 + n) under `factors` (m,), the PGA before the periods.

    Of one of the `recordings` (m,) one is chosen at most; `events`
    (m,) number the earthquakes.
    """

    spectra: Array
    factors: Array
    recordings: Numbers
    events: Numbers


@dataclass(frozen=True, eq=False)
class Goal:
    """The aim of the mean of a set, or of the mean and the deviation of ln Sa.

    `wanted` is (1 + n,), `deviation` (n,). Of the mean over `wanted` at least `least` is
    required at all periods, and 1 of the `pga`. One common factor may bring the set
    there, within the `bounds` of every single factor, unless they are `fixed`.
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

    def judged(
        self, total: Array, size: int, least: Array, most: Array
    ) -> tuple[Array, Array]:
        """Cost and logarithm of the common factor, (...), of sets
        with sums (..., features).
        """
        if self.deviation is not None:
            first, second = np.split(total / size, 2, axis=-1)
            scatter = np.sqrt(
                np.maximum(second - first**2, 0.0) * size / max(size - 1, 1)
            )
            errors = (first - np.log(self.wanted[1:])) ** 2 + (
                scatter - self.deviation
            ) ** 2
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
            common = np.clip(
                np.maximum(-offset, needed), low - np.log(least), high - np.log(most)
            )
        missing = np.maximum(needed - common, 0.0)
        cost = np.sqrt(shape.var(axis=-1) + (offset + common) ** 2) + SHORT * missing
        return cost, common

    def of_set(self, features: Array, factors: Array) -> tuple[float, float]:
        """Cost and common factor of one set, with features (size,
        ...) under factors (size,).
        """
        total = features.sum(axis=0)
        cost, common = self.judged(total, len(factors), factors.min(), factors.max())
        return float(cost), math.exp(float(common))


def best_choice(
    pool: Pool, goal: Goal, count: int, per_event: int
) -> tuple[list[int], bool]:
    """Places of the best set, in order, and whether all sets were looked at.

    Of more sets than `WHOLE` it is the best that is found, the same for the same motions.
    """
    search = _Search(pool, goal, count, per_event)
    if math.comb(len(pool.factors), count) <= WHOLE:
        return search.best_of_all(), True
    found = []
    random = np.random.default_rng(1)
    for _ in range(ROUNDS):
        best = min(search.exchanged(search.filled([], random)) for _ in range(STARTS))
        for _ in range(KICKS):
            kept = random.permutation(best[1])[min(3, count - 1) :].tolist()
            best = min(best, search.exchanged(search.filled(kept, random)))
        found.append(best)
    return min(found)[1], False


class _Search:
    """Sets of a pool, and moves among them."""

    def __init__(self, pool: Pool, goal: Goal, count: int, per_event: int) -> None:
        self.pool = pool
        self.goal = goal
        self.count = count
        self.per_event = per_event
        self.features = goal.features(pool.spectra)

    def free(self, sets: Numbers) -> NDArray[np.bool_]:
        """(..., m) what may still be chosen beside sets (..., size)."""
        _, _, recordings, events = self.pool
        taken = (recordings[sets][..., None] == recordings).any(axis=-2)
        kin = (events[sets][..., None] == events).sum(axis=-2)
        return np.asarray(~taken & (kin < self.per_event))

    def best_of_all(self) -> list[int]:
        """Places of the best of all sets that keep the rules
        about recordings and events.
        """
        _, every, recordings, events = self.pool
        choices = itertools.combinations(range(len(every)), self.count)
        best = (math.inf, list[int]())
        while block := [*itertools.islice(choices, 20_000)]:
            sets = np.array(block)
            for numbers, most in ((recordings, 1), (events, self.per_event)):
                same = numbers[sets][:, :, None] == numbers[sets][:, None, :]
                sets = sets[same.sum(axis=2).max(axis=1) <= most]
            factors = every[sets]
            total = np.zeros((len(sets), self.features.shape[1]))
            for place in range(self.count):
                total += self.features[sets[:, place]]
            cost, _ = self.goal.judged(
                total, self.count, factors.min(axis=1), factors.max(axis=1)
            )
            if len(sets):
                least = int(np.argmin(cost))
                best = min(best, (float(cost[least]), sets[least].tolist()))
        return best[1]

    def filled(self, places: list[int], random: np.random.Generator) -> list[int]:
        """These places and others at random; fewer than wanted
        where none is free any more.
        """
        while len(places) < self.count:
            free = np.flatnonzero(self.free(np.array(places, dtype=np.int64)))
            if not free.size:
                break
            places = [*places, int(random.choice(free))]
        return places

    def exchanged(self, places: list[int]) -> tuple[float, list[int]]:
        """The cost and the places after the best exchanges, until none helps."""
        every = self.pool.factors
        size = len(places)
        now = self.goal.of_set(self.features[places], every[places])[0]
        while size > 1:
            rest = np.array([np.delete(places, out) for out in range(size)])
            total = self.features[rest].sum(axis=1)[:, None] + self.features
            least = np.minimum(every[rest].min(axis=1, keepdims=True), every)
            most = np.maximum(every[rest].max(axis=1, keepdims=True), every)
            # (size, m) with another one in place of each; infinite where it is not free.
            cost, _ = self.goal.judged(total, size, least, most)
            cost = np.where(self.free(rest), cost, math.inf)
            out, other = np.unravel_index(int(np.argmin(cost)), cost.shape)
            # Rounding of the sums must not look like progress, or it would never end.
            if cost[out, other] >= now - 1e-12:
                break
            now = float(cost[out, other])
            places = [*rest[out].tolist(), int(other)]
        places = sorted(places)
        return self.goal.of_set(self.features[places], every[places])[0], places
