"""The search: rounds of designs, each where the earlier ones show that the verdict changes."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from rpscli.case.case import case_from_mapping
from rpscli.case.conditions import EVENTS
from rpscli.case.design import DesignTask
from rpscli.case.study.schema import SampleSection
from rpscli.case.text.document import Fault
from rpscli.errors import CaseError
from rpscli.sweep.design.answer import Answer, Requirement, demands_of, judged_designs, weights_of
from rpscli.sweep.points.check import needs_of
from rpscli.sweep.points.combinations import unit_cube
from rpscli.sweep.points.layout import StudyPoints
from rpscli.sweep.statistics.grouping import INTENSITY, shown_keys
from rpscli.sweep.table import Array, Table

Flags = NDArray[np.bool_]

MOST_CORNERS = 4
"""Unknowns up to which all corners of the cube are in the first sample."""

MOST_NEAR = 64
"""Other designs among which the neighbours of a design are looked for."""


def first_places(unknowns: int, count: int, seed: int) -> Array:
    """(designs, unknowns): equal steps of one unknown, else corners and a Sobol sequence."""
    if unknowns == 1:
        return np.linspace(0.0, 1.0, count)[:, None]
    corners = list(itertools.product((0.0, 1.0), repeat=unknowns)) * (unknowns <= MOST_CORNERS)
    section = SampleSection.model_construct(size=count, seed=seed, ranges={})
    return np.array([*corners, *unit_cube(section, unknowns).tolist()])


def neighbours(places: Array) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Pairs of designs between which no other lies: the ball over their distance is empty.

    This is the graph of Gabriel and Sokal; on a line it joins each design with the next.

    >>> [pair.tolist() for pair in neighbours(np.array([[0.0], [1.0], [0.4]]))]
    [[0, 1], [2, 2]]
    """
    from scipy.spatial.distance import cdist

    squares = np.asarray(cdist(places, places, "sqeuclidean"))
    pairs = {
        (min(one, other), max(one, other))
        for one in range(len(places))
        for other in _around(squares, one).tolist()
    }
    first, second = np.array(sorted(pairs), dtype=np.int64).reshape(-1, 2).T
    return first, second


def _around(squares: Array, one: int) -> NDArray[np.int64]:
    """The neighbours of a design among the nearest others: whoever is between is nearer still."""
    near = np.argsort(squares[one], kind="stable")
    near = near[near != one][:MOST_NEAR]
    length = squares[one, near]
    between = length[:, None] + squares[np.ix_(near, near)] < length * (1.0 - 1e-12)
    return np.asarray(near[~between.any(axis=0)])


def next_places(
    places: Array, passes: Flags, objectives: Array, best: int, resolution: float, count: int
) -> Array:
    """(new, unknowns) designs that tell most about where the verdict changes, at most `count`.

    They halve the distance between neighbours. Every second one goes where the verdict changes,
    long distances and those first in which it changes in many resamples as well; the others go to
    the neighbours of the best design, and between designs one of which passes and the other would
    be better.

    `places` (designs, unknowns) are known, with verdicts `passes` (resamples, designs), the first
    of all records, and `objectives` (designs,); `best` is the best or least violated of them.
    Neighbours nearer than `resolution` are not parted.
    """
    first, second = neighbours(places)
    length = np.linalg.norm(places[first] - places[second], axis=1)
    change = (passes[:, first] != passes[:, second]).mean(axis=0)
    change = 0.5 * (change + (passes[0, first] != passes[0, second]))
    touches = (first == best) | (second == best)
    better = passes[0].any() & (
        np.minimum(objectives[first], objectives[second]) < objectives[best]
    )
    middle = 0.5 * (places[first] + places[second])
    parted = length > resolution
    everywhere = _ordered(middle, length * change * parted)
    chance = passes.mean(axis=0)
    promising = np.maximum(better * np.maximum(chance[first], chance[second]), 0.5 * touches)
    close = _ordered(middle, length * promising * parted)
    ends = np.repeat(places[best][None], 2 * places.shape[1], axis=0)
    for unknown in range(places.shape[1]):  # the best design, taken to the ends of its ranges
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
    return [places[place] for place in order if worth[place] > 0.0]


ROUNDS = 4
"""So many rounds have as many designs as the first one."""


class Search:
    """Designs that are known, and where to look next."""

    def __init__(self, task: DesignTask) -> None:
        search, unknowns = task.file.search, len(task.unknowns)
        self.task = task
        self.first = search.first or min(512, 2 ** (unknowns + 4))
        self.most = max(search.most or ROUNDS * self.first, self.first)
        self.weights = weights_of(task.clusters, search.resamples, search.seed)
        self.requirements: tuple[Requirement, ...] = ()
        self.places: Array = np.empty((0, unknowns))
        self.values: Array = np.empty((0, len(task.keys)))
        self.valid = np.empty(0, dtype=bool)
        self.faults: dict[str, None] = {}
        self._demands: dict[str, Array] = {}

    @property
    def names(self) -> tuple[str, ...]:
        """Results that requirements and objectives name."""
        objectives = (name for objective in self.task.file.minimise for name in objective)
        named = [*(r.condition.name for r in self.requirements), *objectives]
        return tuple(name for name in dict.fromkeys(named) if name not in self.task.keys)

    def next_round(self) -> Array:
        """(designs, unknowns) in the unit cube; none at the end."""
        search = self.task.file.search
        if not len(self.places):
            return first_places(len(self.task.unknowns), self.first, search.seed)
        count = min(max(4, self.first // ROUNDS), self.most - len(self.places))
        if count <= 0:
            return self.places[:0]
        answer = self.answer()
        return next_places(
            self.places,
            answer.judged.passes[: 1 + answer.resamples],
            answer.objectives,
            answer.closest,
            search.resolution,
            count,
        )

    def valid_cases(self, values: Array) -> Flags:
        """(designs,) which values make valid cases; why others do not is kept in `faults`."""
        study, found = self.task.study, np.ones(len(values), dtype=bool)
        for place, row in enumerate(self.task.rows(values)):
            given = dict(zip(self.task.keys, row, strict=True))
            try:
                _ = case_from_mapping(
                    study.base, study.base.name, study.base_folder, given, label="variables"
                ).structure
            except CaseError as error:
                found[place] = False
                self.faults.setdefault(str(error).splitlines()[0])
        return found

    def require(self, layout: StudyPoints) -> None:
        """Take the requirements from the first designs that are laid out; refuse what cannot be."""
        document = self.task.study.document
        (measure,) = shown_keys(layout, (INTENSITY,))
        several = len(layout.scales) > 1
        self.requirements = tuple(
            Requirement(condition, place, measure, level if several else None)
            for condition in layout.properties[0].limits
            for place, level in enumerate(layout.scales)
        )
        if not self.requirements:
            text = "limits is missing: say what is required, here or in the case at the base"
            document.refuse([Fault((), f"{text}, as in `limits: {{overturning: 0.05}}`")])
        lacking = frozenset.union(*(properties.lacking for properties in layout.properties))
        for name in self.names:
            if name in lacking and name not in EVENTS:
                aimed_at = any(name in objective for objective in self.task.file.minimise)
                where = "minimise" if aimed_at else "limits"
                document.refuse([Fault((where,), f"{where}: {needs_of(name)}")])

    def add(self, places: Array, values: Array, valid: Flags, table: Table | None) -> None:
        """Take in a round; `table` has the points of its valid designs."""
        shape = len(valid), self.weights.rows.shape[1], self._intensities
        for name in self.names:
            found = np.full(shape, np.nan)
            if table is not None:
                found[valid] = demands_of(table, name)
            known = self._demands.get(name, found[:0])
            self._demands[name] = np.concatenate([known, found])
        self.places = np.concatenate([self.places, places])
        self.values = np.concatenate([self.values, values])
        self.valid = np.concatenate([self.valid, valid])

    @property
    def _intensities(self) -> int:
        return 1 + max(requirement.intensity for requirement in self.requirements)

    def answer(self) -> Answer:
        """What is known so far."""
        judged = judged_designs(
            self.task, self.requirements, self.values, self._demands, self.weights.rows
        )
        return Answer(
            self.task, self.places, self.values, self.valid, judged, self.weights.resamples
        )
