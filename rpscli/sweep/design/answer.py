"""What a search answers: designs against requirements, the best one, and what would change it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.case.conditions import EVENTS, Condition
from rpscli.case.design import DesignTask, Objective
from rpscli.sweep.design.regions import regions
from rpscli.sweep.statistics.fractiles import CONFIDENCE, Share, clustered, fractiles
from rpscli.sweep.statistics.verdicts import Verdict, decisive, judge, rate_verdict, worse
from rpscli.sweep.table import Array, Indices, Table

Demands = Mapping[str, Array]
"""(designs, records, intensities, members) of each limit by name, larger the worse: see `worse`.

Members are the histories by which a design is judged under a record: the perturbed ones, and those
of the designs within its tolerances where these were computed. Each counts as a part of the record.
NaN where a history failed or the design is not a valid case."""


class Requirement(NamedTuple):
    """A condition at one intensity: its place, measure and value, None where there is one only."""

    condition: Condition
    intensity: int
    measure: str = "scale"
    level: float | None = None
    rates: tuple[float, ...] | None = None
    """How often a year the structure overturns for a share of one at each intensity [1/year]."""

    @property
    def result(self) -> str:
        """What its demands are of."""
        return self.condition.name if self.rates is None else "overturning"

    @property
    def bound(self) -> float:
        """What the value must keep: an admissible share of an event, or a limit."""
        return self.condition.share if self.condition.name in EVENTS else self.condition.limit


class Weights(NamedTuple):
    """How often each record counts: once, in `resamples` of a bootstrap, with one cluster left out.

    Whole clusters are drawn and left out, recordings or events: see `records.clusters`.
    """

    rows: Array
    resamples: int


def weights_of(clusters: Sequence[int], resamples: int, seed: int) -> Weights:
    """The records of these clusters as they are, drawn anew, and without one cluster at a time.

    As many clusters are drawn as there are: the rule is that of so many records, of which 5 % of 20
    are one and of 19 none. The share of the draws in which a design passes is then the probability
    that it would with as many new records, were these all there are. Draws of one cluster fewer,
    which the bands of fragilities are of, scatter by sqrt(K/(K - 1)) more, as means do.
    """
    ones, count = np.ones((1, len(clusters))), len(set(clusters))
    if count < 2:
        return Weights(ones, 0)
    even = np.full(count, 1.0 / count)
    drawn = np.random.default_rng(seed).multinomial(count, even, size=resamples)
    rows = np.concatenate([drawn, 1.0 - np.eye(count)])
    return Weights(np.concatenate([ones, rows[:, np.array(clusters)]]), resamples)


def demands_of(table: Table, name: str) -> Array:
    """(designs, records, intensities, members) demands of the designs of a study on a limit."""
    layout = table.layout
    shape = len(layout.properties), len(layout.records), len(layout.scales), len(layout.members)
    return worse(table, name).reshape(shape)


@dataclass(frozen=True, eq=False)
class Judged:
    """What became of each design.

    `values` and `met` are (requirements, weightings, designs): the share of an event, or the demand
    that no more than the admissible records exceed, and whether that is enough. `excess`
    (requirements, designs) are records beyond the limit less those that may be, over all of them;
    `beyond`, (designs, histories) of each requirement, tells which are, NaN where one failed; of
    a rate those of one intensity after the other.
    `objectives` are (objectives, weightings, designs).
    """

    requirements: tuple[Requirement, ...]
    values: Array
    excess: Array
    beyond: Sequence[Array]
    met: np.typing.NDArray[np.bool_]
    objectives: Array

    @property
    def passes(self) -> np.typing.NDArray[np.bool_]:
        """(weightings, designs) whether all requirements are met."""
        return np.asarray(self.met.all(axis=0))


def judged_designs(
    task: DesignTask,
    requirements: Sequence[Requirement],
    values: Array,
    demands: Demands,
    weights: Array,
) -> Judged:
    """Judge designs with values (designs, keys) in weights (weightings, records) of the records."""
    found, excess, beyond, met = [], [], [], []
    members = next(iter(demands.values())).shape[3]
    weights = np.repeat(weights, members, axis=1) / members
    for requirement in requirements:
        condition, every = requirement.condition, demands[requirement.result]
        if requirement.rates is not None:
            event = Condition(requirement.result, 0.0, "")
            parts = [at.reshape(len(values), -1) for at in np.moveaxis(every, 2, 0)]
            judgements = [judge(at, weights, event) for at in parts]
            with np.errstate(invalid="ignore", divide="ignore"):
                shares = [each.beyond / each.total for each in judgements]
            rate = np.tensordot(requirement.rates, shares, axes=1)
            found.append(rate)
            met.append(rate <= condition.limit)
            excess.append(np.nan_to_num(rate[0] / condition.limit - 1.0, nan=np.inf))
            fallen = np.concatenate(parts, axis=1)
            beyond.append(np.where(np.isnan(fallen), np.nan, fallen > 0.0))
            continue
        at = every[:, :, requirement.intensity].reshape(len(values), -1)
        counted = judge(at, weights, condition)
        excess.append(counted.excess[0])
        beyond.append(np.where(np.isnan(at), np.nan, at > condition.sign * condition.limit))
        met.append(counted.met)
        if condition.name in EVENTS:
            with np.errstate(invalid="ignore", divide="ignore"):
                found.append(counted.beyond / counted.total)
        else:
            found.append(condition.sign * decisive(at, weights, condition))
    keys = dict(zip(task.keys, values.T, strict=True))
    objectives = [_objective(objective, keys, demands, weights) for objective in task.file.minimise]
    arrays = map(np.array, (met, objectives))
    return Judged(tuple(requirements), np.array(found), np.array(excess), beyond, *arrays)


def _objective(
    objective: Objective, keys: Mapping[str, Array], demands: Demands, weights: Array
) -> Array:
    """(weightings, designs) a sum; of a result, the largest of all intensities."""
    total = np.zeros((len(weights), len(next(iter(keys.values())))))
    for name, term in objective.items():
        if name in keys:
            total += term.times * keys[name]
            continue
        condition = Condition(name, 0.0, "", fractile=term.fractile)
        of_each = [
            decisive(at.reshape(len(at), -1), weights, condition)
            for at in np.moveaxis(demands[name], 2, 0)
        ]
        total += term.times * np.max(of_each, axis=0)
    return total


LARGE = 1e300
"""Stands for an objective that is not known."""

ROBUST = 0.9
"""Share of the resamples in which a recommended design holds, if any does in so many."""

NONE = -1
"""Place of a design that does not exist."""


class Tolerated(NamedTuple):
    """(designs,) verdicts, shares of the resamples and objectives."""

    passes: NDArray[np.bool_]
    share: Array
    objectives: Array


Interval = tuple[float, float]
"""In which a number lies in so large a part of the resamples; NaN if it has none."""


@dataclass(frozen=True, eq=False)
class Answer:
    """All that a search found.

    `places` are (designs, unknowns) in the unit cube, `values` (designs, keys) in SI units, `valid`
    says which are valid cases. `resamples` is the number of bootstrap samples of the records: the
    weightings after that of all as they are. `even` designs are of the first sample. `within` are
    the designs that were judged together with others within their tolerances, and how.
    """

    task: DesignTask
    places: Array
    values: Array
    valid: NDArray[np.bool_]
    judged: Judged
    resamples: int
    even: int = 0
    within: tuple[Indices, Judged] | None = None

    @property
    def best(self) -> int:
        """Place of the best design; NONE if none passes."""
        return int(self.chosen[0])

    @cached_property
    def closest(self) -> int:
        """Place of the least violated design: the best one where there is one."""
        if self.best != NONE:
            return self.best
        worst = self.judged.excess.max(axis=0)
        return int(np.lexsort((self.objectives, _distance(self.judged), worst))[0])

    @cached_property
    def objectives(self) -> Array:
        """(designs,) what is to be least, infinite where so many overturned or none is known."""
        return np.asarray(np.nan_to_num(self.judged.objectives[0, 0], nan=np.inf, posinf=np.inf))

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
        # A passing design whose objective is not known comes after all others.
        objectives = np.where(
            passes, np.nan_to_num(self.judged.objectives[0], nan=LARGE, posinf=LARGE), np.inf
        )
        return np.where(passes.any(axis=1), objectives.argmin(axis=1), NONE)

    @cached_property
    def tolerated(self) -> Tolerated:
        """Whether each design passes, in which share of the resamples, and its objective.

        Within the tolerances, where these were examined.
        """
        found = Tolerated(self.passes.copy(), self.passing_share.copy(), self.objectives.copy())
        if self.within is not None:
            of, judged = self.within
            found.passes[of] = judged.passes[0]
            found.objectives[of] = np.nan_to_num(judged.objectives[0, 0], nan=np.inf, posinf=np.inf)
            if self.resamples:
                found.share[of] = judged.passes[1 : 1 + self.resamples].mean(axis=0)
        return found

    @cached_property
    def holds(self) -> NDArray[np.bool_]:
        """(designs,) which pass, in nearly all resamples if any design does."""
        passes, share, _ = self.tolerated
        surely = passes & (share >= ROBUST)
        return surely if surely.any() else passes

    @property
    def sure(self) -> bool:
        """Whether the designs that hold do so in nearly all resamples."""
        return bool((self.tolerated.share[self.holds] >= ROBUST).all())

    @cached_property
    def regions(self) -> list[Indices]:
        """Designs that hold, apart where others lie between; the main region first."""
        return regions(self.places, self.holds, self.even) if self.holds.any() else []

    def least_of(self, designs: Indices) -> int:
        """Place of the best of some designs."""
        return int(designs[self.tolerated.objectives[designs].argmin()])

    @cached_property
    def robust(self) -> int:
        """The best design of the main region, which is recommended; NONE where none holds."""
        return self.least_of(self.regions[0]) if self.regions else NONE

    @property
    def headline(self) -> int:
        """Place of the recommended design, or of the least violated one."""
        return self.closest if self.robust == NONE else self.robust

    @property
    def islands(self) -> list[int]:
        """The best design of each other region that is better than the recommended one."""
        if self.robust == NONE:
            return []
        objectives = self.tolerated.objectives
        found = [self.least_of(region) for region in self.regions[1:]]
        better = [place for place in found if objectives[place] < objectives[self.robust]]
        return sorted(better, key=lambda place: float(objectives[place]))

    def judged_at(self, place: int) -> tuple[Judged, int]:
        """Where a design is judged, within its tolerances if these were examined."""
        if self.within is not None and place in (of := self.within[0].tolist()):
            return self.within[1], of.index(place)
        return self.judged, place

    def verdicts(self, place: int) -> list[Verdict]:
        """On each requirement."""
        judged, at = self.judged_at(place)
        found = []
        for row, requirement in enumerate(judged.requirements):
            condition, value = requirement.condition, float(judged.values[row, 0, at])
            beyond, exceeded = judged.beyond[row][at], not judged.met[row, 0, at]
            fractile = None if condition.fractile is None else value
            parts = np.split(beyond, len(requirement.rates or [1.0]))
            shares = [self.share_beyond(part) for part in parts]
            if requirement.rates is None:
                common = condition, (), shares[0], 0, value, "", fractile
                found.append(Verdict(*common, exceeded=bool(exceeded)))
            else:
                found.append(rate_verdict(condition, np.array(requirement.rates), shares))
        return found

    def share_beyond(self, beyond: Array) -> Share:
        """Of the histories of a design, NaN where one failed."""
        clusters = np.repeat(self.task.clusters, len(beyond) // len(self.task.clusters))
        known = ~np.isnan(beyond)
        return clustered(beyond[known] > 0.0, clusters[known], self.task.file.independent)

    @property
    def of_resamples(self) -> Indices:
        """(resamples,) the best design of each; NONE where nothing passes."""
        return self.chosen[1 : 1 + self.resamples]

    @property
    def unanswered(self) -> int:
        """Resamples in which nothing passes."""
        return int((self.of_resamples == NONE).sum())

    def interval(self, key: int) -> Interval:
        """Of a key of the best design, over the resamples that have one."""
        chosen = self.of_resamples
        return interval_of(self.values[chosen[chosen != NONE], key])

    @property
    def objective_interval(self) -> Interval:
        """Of what is to be least."""
        chosen = self.of_resamples
        rows = np.nonzero(chosen != NONE)[0]
        return interval_of(self.judged.objectives[0][1 + rows, chosen[rows]])

    @property
    def without_record(self) -> Indices:
        """(records,) the best design when one record is left out; empty with a single one."""
        return self.chosen[1 + self.resamples :]

    @property
    def front(self) -> Indices:
        """Passing designs that no other passing one betters in both objectives, by the first."""
        passing = np.nonzero(self.passes)[0]
        if len(self.judged.objectives) < 2 or not len(passing):
            return passing[:0]
        first, second = self.judged.objectives[:, 0, passing]
        order = np.lexsort((second, first))
        least = np.minimum.accumulate(second[order])
        kept = np.concatenate([[True], second[order][1:] < least[:-1]])
        return np.asarray(passing[order][kept])

    @property
    def without(self) -> list[float]:
        """The least objective if one requirement fell, for each; empty without a best design."""
        if self.best == NONE:
            return []
        met, objectives = self.judged.met[:, 0], np.where(self.valid, self.objectives, np.inf)
        return [
            float(objectives[np.delete(met, place, axis=0).all(axis=0)].min())
            for place in range(len(met))
        ]

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
    (25.0, 975.0)
    """
    if not len(values):
        return np.nan, np.nan
    tail = 0.5 * (1.0 - CONFIDENCE)
    low, high = fractiles(values, (tail, 1.0 - tail)).tolist()
    return low, high


def _distance(judged: Judged) -> Array:
    """(designs,) the worst value over its bound: tells apart what as many records exceed."""
    bounds = np.array([requirement.bound for requirement in judged.requirements])
    with np.errstate(divide="ignore", invalid="ignore"):
        ratios = judged.values[:, 0] / bounds[:, None]
        below = np.array([requirement.condition.from_below for requirement in judged.requirements])
        ratios = np.where(below[:, None], 1.0 / ratios, ratios)
    return np.asarray(np.nan_to_num(ratios, nan=np.inf).max(axis=0))
