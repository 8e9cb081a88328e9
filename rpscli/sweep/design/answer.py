"""What a search answers: the best design, what it rests on, and what would change it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.case.design import DesignTask
from rpscli.sweep.design.judgement import Judged
from rpscli.sweep.statistics.fractiles import CONFIDENCE, fractiles
from rpscli.sweep.table import Array, Indices

LARGE = 1e300
"""Stands for an aim that is not known."""

ROBUST = 0.9
"""Share of the resamples in which a robust design passes."""

NONE = -1
"""Place of a design that does not exist."""


class Without(NamedTuple):
    """The least aim if one requirement fell; `binds` if it is less then."""

    requirement: int
    aim: float
    binds: bool


class Interval(NamedTuple):
    """In which a number lies in so large a part of the resamples; NaN if it has none."""

    low: float
    high: float


@dataclass(frozen=True, eq=False)
class Answer:
    """All that a search found.

    Parameters
    ----------
    task
        What was looked for.
    places, values
        (designs, unknowns) in the unit cube and (designs, keys) in SI units.
    valid
        (designs,) which are valid cases.
    judged
        What became of them.
    resamples
        Number of bootstrap samples of the records, the weightings after that of all as they are.
    """

    task: DesignTask
    places: Array
    values: Array
    valid: NDArray[np.bool_]
    judged: Judged
    resamples: int

    @property
    def best(self) -> int:
        """Place of the best design; NONE if none passes."""
        return int(self.chosen[0])

    @cached_property
    def closest(self) -> int:
        """Place of the design that fails least: the best one where there is one."""
        if self.best != NONE:
            return self.best
        worst = self.judged.excess.max(axis=0)
        return int(np.lexsort((self.aims, _distance(self.judged), worst))[0])

    @cached_property
    def aims(self) -> Array:
        """(designs,) what is to be least, infinite where so many overturned or none is known."""
        return np.asarray(np.nan_to_num(self.judged.aims[0, 0], nan=np.inf, posinf=np.inf))

    @property
    def passes(self) -> NDArray[np.bool_]:
        """(designs,) under the records as they are."""
        return np.asarray(self.judged.passes[0])

    @cached_property
    def passing_share(self) -> Array:
        """(designs,) share of the resamples in which each passes; NaN without any."""
        passes = self.judged.passes[1 : 1 + self.resamples]
        return passes.mean(axis=0) if len(passes) else np.full(len(self.places), np.nan)

    @cached_property
    def chosen(self) -> Indices:
        """(weightings,) the best design of each; NONE where nothing passes."""
        passes = self.judged.passes
        # A passing design whose aim is not known comes after all others.
        aims = np.where(passes, np.nan_to_num(self.judged.aims[0], nan=LARGE, posinf=LARGE), np.inf)
        return np.where(passes.any(axis=1), aims.argmin(axis=1), NONE)

    @cached_property
    def robust(self) -> int:
        """The best design that passes in nearly all resamples; NONE without one."""
        aims = np.where(self.passes & (self.passing_share >= ROBUST), self.aims, np.inf)
        return int(aims.argmin()) if np.isfinite(aims).any() else NONE

    @property
    def unanswered(self) -> int:
        """Resamples in which nothing passes."""
        return int((self.chosen[1 : 1 + self.resamples] == NONE).sum())

    def interval(self, key: int) -> Interval:
        """Of a key of the best design, over the resamples that have one."""
        chosen = self.chosen[1 : 1 + self.resamples]
        return interval_of(self.values[chosen[chosen != NONE], key])

    @property
    def aim_interval(self) -> Interval:
        """Of what is to be least."""
        chosen = self.chosen[1 : 1 + self.resamples]
        rows = np.nonzero(chosen != NONE)[0]
        return interval_of(self.judged.aims[0][1 + rows, chosen[rows]])

    @property
    def without_record(self) -> Indices:
        """(records,) the best design when one record is left out; empty with a single one."""
        return self.chosen[1 + self.resamples :]

    @property
    def front(self) -> Indices:
        """Passing designs that no other passing one betters in both aims, by the first."""
        passing = np.nonzero(self.passes)[0]
        if len(self.judged.aims) < 2 or not len(passing):
            return passing[:0]
        first, second = self.judged.aims[:, 0, passing]
        order = np.lexsort((second, first))
        least = np.minimum.accumulate(second[order])
        kept = np.concatenate([[True], second[order][1:] < least[:-1]])
        return np.asarray(passing[order][kept])

    @property
    def without(self) -> Iterator[Without]:
        """The best design if one requirement fell; only where there is a best one."""
        if self.best == NONE:
            return
        for place in range(len(self.judged.requirements)):
            others = np.delete(self.judged.met[:, 0], place, axis=0).all(axis=0) & self.valid
            least = float(self.aims[others].min())
            yield Without(place, least, least < self.aims[self.best])

    @property
    def at_bounds(self) -> Iterator[tuple[str, str]]:
        """Unknowns of the best design that are at an end of their range."""
        if self.best != NONE:
            for unknown, place in zip(self.task.unknowns, self.places[self.best], strict=True):
                for end, word in ((0.0, "least"), (1.0, "largest")):
                    if abs(place - end) <= self.task.file.search.resolution:
                        yield unknown.key, word

    @property
    def bracket(self) -> tuple[float | None, float | None]:
        """One unknown: the next smaller and larger values at which a design fails."""
        key = self.values[:, 0]
        failing = key[~self.passes]
        at = key[self.best]
        below, above = failing[failing < at], failing[failing > at]
        return (
            float(below.max()) if len(below) else None,
            float(above.min()) if len(above) else None,
        )


def interval_of(values: Array) -> Interval:
    """The middle part of numbers, some of which may be infinite; NaN without any.

    >>> interval_of(np.arange(1001.0))
    Interval(low=25.0, high=975.0)
    """
    if not len(values):
        return Interval(np.nan, np.nan)
    tail = 0.5 * (1.0 - CONFIDENCE)
    return Interval(*fractiles(values, (tail, 1.0 - tail)).tolist())


def _distance(judged: Judged) -> Array:
    """(designs,) the worst value over its bound: tells apart what as many records exceed."""
    bounds = np.array([requirement.bound for requirement in judged.requirements])
    with np.errstate(divide="ignore", invalid="ignore"):
        ratios = judged.values[:, 0] / bounds[:, None]
        below = np.array([requirement.condition.from_below for requirement in judged.requirements])
        ratios = np.where(below[:, None], 1.0 / ratios, ratios)
    return np.asarray(np.nan_to_num(ratios, nan=np.inf).max(axis=0))
