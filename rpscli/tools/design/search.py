"""The search for a design: an even sample, halving where the verdict
changes, the best that holds.

Verdicts are those of a study, under the records as they are and under each resample of
them. A design *holds* if it passes in nearly all resamples or, where none does, under the
records as they are; the best one that holds is the answer.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.case.case import case_from_mapping
from rpscli.case.conditions import EVENTS, RATE, Condition
from rpscli.case.study.schema import SampleSection
from rpscli.case.text.document import Fault
from rpscli.errors import CaseError
from rpscli.sweep.points import StudyPoints, lay_out
from rpscli.sweep.statistics.fractiles import CONFIDENCE, fractiles
from rpscli.sweep.statistics.grouping import INTENSITY, shown_keys
from rpscli.sweep.statistics.verdicts import decisive, judge, rates_of_levels, worse
from rpscli.sweep.systems import needs_of, unit_cube
from rpscli.sweep.table import Array, Indices, PointTable
from rpscli.tools.design.keys import DesignTask

Flags = NDArray[np.bool_]
Interval = tuple[float, float]

ROBUST = 0.9
"""Share of the resamples in which the answer passes, if any design passes in so many."""
LARGE = 1e300
"""Stands for an objective that is not known."""
MOST_CORNERS = 4
"""Unknowns up to which all corners of the cube are in the first sample."""
ROUNDS = 4
"""So many rounds have as many designs as the first one."""
MOST_NEAR = 64
"""Other designs among which the neighbours of a design are looked for."""


class Requirement(NamedTuple):
    """A condition at one intensity; `measure` and `level` name it
    where there are several.

    `rates` are annual rates of overturning for a share of one at each intensity [1/year].
    """

    condition: Condition
    intensity: int
    measure: str = "scale"
    level: float | None = None
    rates: tuple[float, ...] | None = None

    @property
    def result(self) -> str:
        """The result that it is on."""
        return self.condition.name if self.rates is None else "overturning"

    @property
    def bound(self) -> float:
        """The most that the value may be: an admissible share of an event, or a limit."""
        return (
            self.condition.share
            if self.condition.name in EVENTS
            else self.condition.limit
        )

    def judged(self, demands: Array, weights: Array) -> tuple[Array, Flags, Array]:
        """Value and verdict (weightings, designs), and the excess
        (designs,) over all records.

        The value is the share of an event, or the demand that no more than the admissible
        records exceed; the excess is the share of the records beyond the limit less those
        that may be. `demands` are (intensities, designs, histories), `weights`
        (weightings, histories).
        """
        if self.rates is not None:
            event = Condition(self.result, 0.0, "")
            value = np.tensordot(
                self.rates, [_share(at, weights, event) for at in demands], axes=1
            )
            excess = np.nan_to_num(value[0] / self.condition.limit - 1.0, nan=np.inf)
            return value, value <= self.condition.limit, excess
        at = demands[self.intensity]
        condition = self.condition
        counted = judge(at, weights, condition)
        if condition.name in EVENTS:
            value = _share(at, weights, condition)
        else:
            value = condition.sign * decisive(at, weights, condition)
        return value, counted.met, counted.excess[0]


def _share(demands: Array, weights: Array, event: Condition) -> Array:
    counted = judge(demands, weights, event)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(counted.beyond / counted.total)


def requirements_of(task: DesignTask, layout: StudyPoints) -> tuple[Requirement, ...]:
    """Requirements in the order of verdicts; refuse a design that requires nothing."""
    recordings = len(np.unique(layout.clusters))
    limits = [limit.under(recordings) for limit in layout.properties[0].limits]
    several = len(layout.scales) > 1
    (measure,) = shown_keys(layout, (INTENSITY,))
    found = [
        Requirement(limit, place, measure, level if several else None)
        for place, level in enumerate(layout.scales)
        for limit in limits
        if limit.name != RATE
    ]
    of_rate = [limit for limit in limits if limit.name == RATE]
    rates = tuple(rates_of_levels(layout)[0].tolist()) if of_rate else ()
    found += (Requirement(limit, 0, rates=rates) for limit in of_rate)
    if not found:
        text = "limits is missing: say what is required, here or in the case at the base"
        task.study.document.refuse(
            [Fault((), f"{text}, as in `limits: {{overturning: 0.05}}`")]
        )
    lacking = frozenset.union(*(properties.lacking for properties in layout.properties))
    for owner, names in (
        ("limits", [requirement.result for requirement in found]),
        ("minimise", [*task.file.minimise]),
    ):
        task.study.document.refuse(
            Fault((owner,), f"{owner}: {needs_of(name)}")
            for name in names
            if name in lacking
        )
    return tuple(found)


def weights_of(clusters: Sequence[int], resamples: int, seed: int) -> Array:
    """(1 + resamples, records) weights: each record once, then whole clusters drawn anew.

    As many clusters are drawn as there are: the rule is that of so many records, of which
    5 % of 20 are one and of 19 none. The share of the draws in which a design passes is
    then the probability that it would with as many new records, were these all there are.
    Draws of one cluster fewer, which the bands of fragilities are of, scatter by
    sqrt(K/(K - 1)) more, as means do.
    """
    ones = np.ones((1, len(clusters)))
    count = len(set(clusters))
    if count < 2:
        return ones
    even = np.full(count, 1.0 / count)
    drawn = np.random.default_rng(seed).multinomial(count, even, size=resamples)
    return np.concatenate([ones, drawn[:, np.array(clusters)]])


@dataclass(frozen=True, eq=False)
class Answer:
    """All designs that were looked at, and how each is judged.

    `places` (designs, unknowns) are in the unit cube, `values` (designs, keys) in SI
    units, `valid` (designs,) those which are valid cases. `results`, see
    `Requirement.judged`, and `met` are (requirements, weightings, designs); `excess`
    (requirements, designs) is the share of the records that is beyond a limit and may not
    be; `objectives` (weightings, designs) is what is minimised, infinite where so many
    overturned or none is known.
    """

    task: DesignTask
    requirements: tuple[Requirement, ...]
    places: Array
    values: Array
    valid: Flags
    results: Array
    met: Flags
    excess: Array
    objectives: Array

    def with_more(self, other: Answer) -> Answer:
        """With the designs of a further round."""
        joined: dict[str, Any] = {
            name: np.concatenate([getattr(self, name), getattr(other, name)], axis)
            for name, axis in AXES.items()
        }
        return replace(self, **joined)

    @cached_property
    def passes(self) -> Flags:
        """(weightings, designs) which meet all requirements."""
        return np.asarray(self.met.all(axis=0))

    @property
    def resamples(self) -> int:
        """Number of the bootstrap samples of the records."""
        return len(self.passes) - 1

    @cached_property
    def passing_share(self) -> Array:
        """(designs,) share of the resamples in which each passes; NaN without any."""
        drawn = self.passes[1:]
        return drawn.mean(axis=0) if len(drawn) else np.full(drawn.shape[1], np.nan)

    @cached_property
    def holds(self) -> Flags:
        """(designs,) which pass, in nearly all resamples if any design does."""
        surely = self.passes[0] & (self.passing_share >= ROBUST)
        return np.asarray(surely if surely.any() else self.passes[0])

    @cached_property
    def best(self) -> int | None:
        """Place of the best design that holds; None where none does."""
        objectives = np.minimum(self.objectives[0], LARGE)
        return (
            int(np.where(self.holds, objectives, np.inf).argmin())
            if self.holds.any()
            else None
        )

    @cached_property
    def closest(self) -> int:
        """Place of the best design or, where none holds, of the least violated one."""
        if self.best is not None:
            return self.best
        bounds = np.array([requirement.bound for requirement in self.requirements])[
            :, None
        ]
        below = np.array([[r.condition.from_below] for r in self.requirements])
        with np.errstate(divide="ignore", invalid="ignore"):
            ratios = self.results[:, 0] / bounds
            # Tells apart what as many records exceed.
            worst = np.nan_to_num(np.where(below, 1.0 / ratios, ratios), nan=np.inf).max(
                axis=0
            )
        keys = self.objectives[0], worst, self.excess.max(axis=0), ~self.valid
        return int(np.lexsort(keys)[0])

    @cached_property
    def best_of_resamples(self) -> tuple[Indices, Indices]:
        """Weightings of the resamples in which any design
        passes, and the best of each.
        """
        rows = 1 + np.flatnonzero(self.passes[1:].any(axis=1))
        known = np.minimum(self.objectives[rows], LARGE)
        return rows, np.where(self.passes[rows], known, np.inf).argmin(axis=1)

    def interval(self, key: int | None = None) -> Interval:
        """Of a key of the best design, or of its objective, over
        resamples; NaN without any.
        """
        rows, designs = self.best_of_resamples
        if not len(rows):
            return np.nan, np.nan
        found = (
            self.objectives[rows, designs] if key is None else self.values[designs, key]
        )
        tail = 0.5 * (1.0 - CONFIDENCE)
        low, high = fractiles(found, (tail, 1.0 - tail)).tolist()
        return low, high

    @property
    def governs(self) -> Flags:
        """(requirements,) without which a better design would pass."""
        met = self.met[:, 0]
        known = np.where(self.valid, self.objectives[0], np.inf)
        least = np.min(known, where=self.passes[0], initial=np.inf)
        others = (np.delete(met, row, axis=0).all(axis=0) for row in range(len(met)))
        return np.array([np.min(known, where=w, initial=np.inf) < least for w in others])

    @property
    def at_bounds(self) -> Iterator[tuple[str, str]]:
        """Unknowns of the best design that are at an end of their range."""
        if self.best is not None:
            for unknown, place in zip(
                self.task.unknowns, self.places[self.best], strict=True
            ):
                for end, word in ((0.0, "least"), (1.0, "largest")):
                    if abs(place - end) <= self.task.file.search.resolution:
                        yield unknown.key, word


AXES = {
    "places": 0,
    "values": 0,
    "valid": 0,
    "results": 2,
    "met": 2,
    "excess": 1,
    "objectives": 1,
}
"""That of the designs in each array of an answer."""


class Round(NamedTuple):
    """Designs that are looked at together; the points of those that are
    valid cases, if any are.
    """

    places: Array
    values: Array
    valid: Flags
    layout: StudyPoints | None


class Search:
    """A search whose `first` round is laid out, with which the
    file is checked to its end.
    """

    def __init__(self, task: DesignTask) -> None:
        search = task.file.search
        unknowns = len(task.unknowns)
        self.task = task
        self.faults = dict[str, None]()
        self.weights = weights_of(task.clusters, search.resamples, search.seed)
        size = search.first or min(512, 2 ** (unknowns + 4))
        size = min(size, search.most or size)
        self.most = search.most or ROUNDS * size
        self.size = max(4, size // ROUNDS)
        self.first = self._round(first_places(unknowns, size, search.seed)[: self.most])
        # If no design is a valid case, the first one tells why, at its place in the file.
        self.layout = self.first.layout or lay_out(task.study_of(self.first.values[:1]))
        self.requirements = requirements_of(task, self.layout)

    @property
    def most_rounds(self) -> int:
        """Rounds that there may be, the first one included."""
        return 1 + max(-(-(self.most - len(self.first.places)) // self.size), 0)

    def run(
        self,
        evaluate: Callable[[StudyPoints], PointTable],
        tell: Callable[[Answer], None] = lambda _: None,
    ) -> Answer:
        """Look at designs round by round; `evaluate` computes points, and `tell` hears
        what is known before each further round.
        """
        answer = self._judged(self.first, evaluate)
        while (count := min(self.size, self.most - len(answer.places))) > 0:
            places = next_places(answer, count)
            if not len(places):
                break
            tell(answer)
            answer = answer.with_more(self._judged(self._round(places), evaluate))
        return answer

    def _round(self, places: Array) -> Round:
        values = self.task.values(places)
        valid = self.valid_cases(values)
        layout = lay_out(self.task.study_of(values[valid])) if valid.any() else None
        return Round(places, values, valid, layout)

    def valid_cases(self, values: Array) -> Flags:
        """(designs,) which values make valid cases; why others do
        not is kept in `faults`.
        """
        study = self.task.study
        found = np.ones(len(values), dtype=bool)
        where = study.base, study.base.name, study.base_folder
        for place, row in enumerate(self.task.rows(values)):
            given = dict(zip(self.task.keys, row, strict=True))
            try:
                _ = case_from_mapping(*where, given, label="variables").structure
            except CaseError as error:
                found[place] = False
                self.faults.setdefault(str(error).splitlines()[0])
        return found

    def _judged(self, of: Round, evaluate: Callable[[StudyPoints], PointTable]) -> Answer:
        """The designs of a round; those that are no valid cases fail."""
        table = None if of.layout is None else evaluate(of.layout)
        scales = len(self.layout.scales)
        members = len(self.layout.members)
        shape = len(of.valid), self.weights.shape[1], scales, members
        weights = (
            np.repeat(self.weights, members, axis=1) / members
        )  # parts of their record

        def demands(name: str) -> Array:
            """(intensities, designs, histories), larger the worse;
            NaN where a history failed.
            """
            found = np.full(shape, np.nan)
            if table is not None:
                found[of.valid] = worse(table, name).reshape(-1, *shape[1:])
            return np.moveaxis(found, 2, 0).reshape(scales, len(of.valid), -1)

        judged = [
            each.judged(demands(each.result), weights) for each in self.requirements
        ]
        results, met, excess = map(np.array, zip(*judged, strict=True))
        columns = dict(zip(self.task.keys, of.values.T, strict=True))
        objectives = np.zeros((len(self.weights), len(of.valid)))
        for name, term in self.task.file.minimise.items():
            if name in columns:
                objectives += term.times * columns[name]
                continue
            condition = Condition(name, 0.0, "", fractile=term.fractile)
            found = [decisive(at, weights, condition) for at in demands(name)]
            objectives += term.times * np.max(found, axis=0)
        objectives = np.nan_to_num(objectives, nan=np.inf, posinf=np.inf, neginf=np.inf)
        known = of.places, of.values, of.valid, results, met, excess, objectives
        return Answer(self.task, self.requirements, *known)


def first_places(unknowns: int, count: int, seed: int) -> Array:
    """(designs, unknowns): equal steps of one unknown, else
    corners and a Sobol sequence.
    """
    if unknowns == 1:
        return np.linspace(0.0, 1.0, count)[:, None]
    corners = list(itertools.product((0.0, 1.0), repeat=unknowns)) * (
        unknowns <= MOST_CORNERS
    )
    section = SampleSection.model_construct(size=count, seed=seed, ranges={})
    return np.array([*corners, *unit_cube(section, unknowns).tolist()])


def next_places(answer: Answer, count: int) -> Array:
    """(new, unknowns) designs that tell most about where the verdict
    changes, at most `count`.

    They halve the distance between neighbours that are farther apart than the resolution.
    Every second one goes where the verdict changes, long distances and those first in
    which it changes in many resamples as well; the others go to the neighbours of the
    best design, to the ends of its ranges, and between designs one of which passes and
    the other would be better.
    """
    places = answer.places
    aim = answer.closest
    resolution = answer.task.file.search.resolution
    objectives = answer.objectives[0]
    passes = np.concatenate([answer.holds[None], answer.passes[1:]])
    first, second = neighbours(places)
    length = np.linalg.norm(places[first] - places[second], axis=1)
    change = (passes[:, first] != passes[:, second]).mean(axis=0)
    change = 0.5 * (change + (passes[0, first] != passes[0, second]))
    touches = (first == aim) | (second == aim)
    chance = passes.mean(axis=0)
    better = np.minimum(objectives[first], objectives[second]) < objectives[aim]
    better = better * answer.holds.any() * np.maximum(chance[first], chance[second])
    parted = length * (length > resolution)
    middle = 0.5 * (places[first] + places[second])
    everywhere = _ordered(middle, parted * change)
    close = _ordered(middle, parted * np.maximum(better, 0.5 * touches))
    ends = np.repeat(places[aim][None], 2 * places.shape[1], axis=0)
    for unknown in range(places.shape[1]):
        ends[2 * unknown : 2 * unknown + 2, unknown] = 0.0, 1.0
    chosen: list[Array] = []
    for pair in itertools.zip_longest(everywhere, [*ends, *close]):
        for place in pair:
            if place is not None and len(chosen) < count:
                known = np.array([*places, *chosen])
                if np.linalg.norm(known - place, axis=1).min() > 0.49 * resolution:
                    chosen.append(place)
    return np.array(chosen).reshape(-1, places.shape[1])


def _ordered(places: Array, worth: Array) -> list[Array]:
    """Places of some worth, the worthiest first."""
    order = np.argsort(-worth, kind="stable")
    return list(places[order[worth[order] > 0.0]])


def neighbours(places: Array) -> tuple[Indices, Indices]:
    """Pairs of designs between which no other lies: the ball over
    their distance is empty.

    This is the graph of Gabriel and Sokal; on a line it joins each design with the next.

    >>> [pair.tolist() for pair in neighbours(np.array([[0.0], [1.0], [0.4]]))]
    [[0, 1], [2, 2]]
    """
    from scipy.spatial.distance import cdist

    squares = np.asarray(cdist(places, places, "sqeuclidean"))
    pairs = set[tuple[int, int]]()
    for one in range(len(places)):
        # Whoever is between is nearer still.
        near = np.argsort(squares[one], kind="stable")
        near = near[near != one][:MOST_NEAR]
        length = squares[one, near]
        between = length[:, None] + squares[np.ix_(near, near)] < length * (1.0 - 1e-12)
        others = near[~between.any(axis=0)].tolist()
        pairs |= {(min(one, other), max(one, other)) for other in others}
    first, second = np.array(sorted(pairs), dtype=np.int64).reshape(-1, 2).T
    return first, second
