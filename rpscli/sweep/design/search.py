"""The search: rounds of designs, each where the earlier ones show that the verdict changes."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from rpscli.case.case import case_from_mapping
from rpscli.case.conditions import EVENTS, RATE
from rpscli.case.design import DesignTask
from rpscli.case.study.schema import SampleSection
from rpscli.case.text.document import Fault
from rpscli.errors import CaseError
from rpscli.sweep.design.answer import (
    NONE,
    Answer,
    Requirement,
    demands_of,
    judged_designs,
    weights_of,
)
from rpscli.sweep.design.regions import neighbours
from rpscli.sweep.points.check import needs_of
from rpscli.sweep.points.combinations import unit_cube
from rpscli.sweep.points.layout import StudyPoints
from rpscli.sweep.statistics.grouping import INTENSITY, shown_keys
from rpscli.sweep.statistics.verdicts import rates_of_levels
from rpscli.sweep.table import Array, Table

Flags = NDArray[np.bool_]

MOST_CORNERS = 4
"""Unknowns up to which all corners of the cube are in the first sample."""


def first_places(unknowns: int, count: int, seed: int) -> Array:
    """(designs, unknowns): equal steps of one unknown, else corners and a Sobol sequence."""
    if unknowns == 1:
        return np.linspace(0.0, 1.0, count)[:, None]
    corners = list(itertools.product((0.0, 1.0), repeat=unknowns)) * (unknowns <= MOST_CORNERS)
    section = SampleSection.model_construct(size=count, seed=seed, ranges={})
    return np.array([*corners, *unit_cube(section, unknowns).tolist()])


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

AROUND = 8
"""Designs within the tolerances of one of several unknowns, besides itself."""

AT_ONCE = 4
"""Designs that are judged within their tolerances in a round."""

FAR = 0.05
"""Distance in the unit cube within which a recommended design has neighbours that hold."""


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
        self.checked: list[int] = []
        self._within_record = 1, 1
        self._demands: dict[str, Array] = {}
        self._within: dict[str, Array] = {}

    @property
    def names(self) -> tuple[str, ...]:
        """Results that requirements and objectives name."""
        objectives = (name for objective in self.task.file.minimise for name in objective)
        named = [*(requirement.result for requirement in self.requirements), *objectives]
        return tuple(name for name in dict.fromkeys(named) if name not in self.task.keys)

    def next_round(self) -> Array:
        """(designs, unknowns) in the unit cube; none at the end."""
        search = self.task.file.search
        if not len(self.places):
            return first_places(len(self.task.unknowns), self.first, search.seed)
        size = max(4, self.first // ROUNDS)
        count, turn = (
            min(size, self.most - len(self.places)),
            (len(self.places) - self.first) // size,
        )
        if count <= 0:
            return self.places[:0]
        answer = self.answer()
        passes, aim = answer.judged.passes[: 1 + answer.resamples], answer.closest
        if turn % 2 and answer.robust != NONE:  # every second round looks for what holds
            passes, aim = np.concatenate([answer.holds[None], passes[1:]]), answer.robust
        return next_places(self.places, passes, answer.objectives, aim, search.resolution, count)

    def next_checks(self) -> Array:
        """(designs, unknowns) that are to be judged within their tolerances; none at the end.

        The best ones of the main region; with one unknown all of it, and what lies between. Then
        what lies between the best of them and better designs that fail.
        """
        answer, one = self.answer(), self.places.shape[1] == 1
        if answer.robust == NONE:
            return self.places[:0]
        region = answer.regions[0][answer.tolerated.objectives[answer.regions[0]].argsort()]
        new = [place for place in region.tolist() if place not in self.checked]
        asked = [*self.places[new if one or region[0] in new else new[:0]]]
        if one:
            asked += self._between(np.sort(self.places[region, 0]))
        known = {tuple(row) for row in self.values[self.checked].tolist()}
        asked = asked if one else asked[:AT_ONCE]
        for places in (asked, self._refined(answer) if not asked else []):
            found = np.array(places).reshape(-1, self.places.shape[1])
            kept = [tuple(row) not in known for row in self.task.values(found).tolist()]
            if any(kept):
                return found[kept][: self.most - len(self.checked)]
        return self.places[:0]

    def _between(self, line: Array) -> list[Array]:
        """Places between those of one unknown that are farther apart than tolerances reach."""
        found = []
        for low, high in itertools.pairwise(line.tolist()):
            reach = 2.0 * float(self.task.tolerances(np.array([[low]]))[0, 0])
            parts = math.ceil((high - low) / max(reach, self.task.file.search.resolution) - 1e-9)
            found += [np.array([low + (high - low) * n / parts]) for n in range(1, parts)]
        return found

    def _refined(self, answer: Answer) -> list[Array]:
        """Better designs that fail by themselves; then halfway to those, and to ones far away."""
        best, (first, second) = answer.robust, neighbours(self.places)
        others = np.concatenate([second[first == best], first[second == best]])
        length = np.linalg.norm(self.places[others] - self.places[best], axis=1)
        objectives = answer.tolerated.objectives
        better = ~answer.holds[others] & (objectives[others] < objectives[best])
        alone = better & (length <= FAR) & ~np.isin(others, self.checked)
        if alone.any():
            return [*self.places[others[alone]]]
        far = answer.holds[others] & (length > FAR)
        chosen = others[(better & (length > self.task.file.search.resolution)) | far]
        return [*(0.5 * (self.places[chosen] + self.places[best]))]

    def around(self, places: Array) -> Array:
        """(designs times members, unknowns): each design, and what is within its tolerances."""
        unknowns = places.shape[1]
        section = SampleSection.model_construct(size=AROUND, seed=1, ranges={})
        cube = np.linspace(0.0, 1.0, 5)[:, None] if unknowns == 1 else unit_cube(section, unknowns)
        offsets = np.concatenate([np.zeros((1, unknowns)), 2.0 * cube - 1.0])
        offsets = offsets[np.sort(np.unique(offsets, axis=0, return_index=True)[1])]
        members = places[:, None] + offsets * self.task.tolerances(places)[:, None]
        return np.clip(members, 0.0, 1.0).reshape(-1, unknowns)

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
        self._within_record = len(layout.scales), len(layout.members)
        several = len(layout.scales) > 1
        found: list[Requirement] = []
        for condition in layout.properties[0].limits:
            if condition.name == RATE:
                rates = tuple(rates_of_levels(layout)[0].tolist())
                found.append(Requirement(condition, 0, rates=rates))
                continue
            found += (
                Requirement(condition, place, measure, level if several else None)
                for place, level in enumerate(layout.scales)
            )
        self.requirements = tuple(found)
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
        for name, found in self._demands_of(valid, table, np.nan):
            known = self._demands.get(name, found[:0])
            self._demands[name] = np.concatenate([known, found])
        self.places = np.concatenate([self.places, places])
        self.values = np.concatenate([self.values, values])
        self.valid = np.concatenate([self.valid, valid])

    def add_checks(self, places: Array, values: Array, valid: Flags, table: Table | None) -> None:
        """Take in designs with what is `around` them; what is no valid case there fails."""
        members = len(values) // len(places)
        own, known = values[::members], {tuple(row) for row in self.values.tolist()}
        new = np.array([tuple(row) not in known for row in own.tolist()])
        for name, found in self._demands_of(valid, table, np.inf):
            parts = np.moveaxis(found.reshape(len(places), members, *found.shape[1:]), 1, 3)
            parts = parts.reshape(*parts.shape[:3], -1)
            earlier = self._within.get(name, parts[:0])
            self._within[name] = np.concatenate([earlier, parts])
            alone = np.where(valid[::members, None, None, None], found[::members], np.nan)
            self._demands[name] = np.concatenate([self._demands[name], alone[new]])
        self.places = np.concatenate([self.places, places[new]])
        self.values = np.concatenate([self.values, own[new]])
        self.valid = np.concatenate([self.valid, valid[::members][new]])
        of = {tuple(row): n for n, row in enumerate(self.values.tolist())}
        self.checked += [of[tuple(row)] for row in own.tolist()]

    def _demands_of(
        self, valid: Flags, table: Table | None, invalid: float
    ) -> Iterator[tuple[str, Array]]:
        """Of every result that is needed; `invalid` ones of designs that are not valid cases."""
        shape = len(valid), self.weights.rows.shape[1], *self._within_record
        for name in self.names:
            found = np.full(shape, invalid)
            if table is not None:
                found[valid] = demands_of(table, name)
            yield name, found

    def answer(self) -> Answer:
        """What is known so far."""
        rows, checked = self.weights.rows, self.checked
        judged = judged_designs(self.task, self.requirements, self.values, self._demands, rows)
        within = None
        if checked:
            values, demands = self.values[checked], self._within
            near = judged_designs(self.task, self.requirements, values, demands, rows)
            within = np.array(checked), near
        return Answer(
            self.task,
            self.places,
            self.values,
            self.valid,
            judged,
            self.weights.resamples,
            self.first,
            within,
        )
