"""The search: rounds of designs, each placed by what the earlier ones showed."""

from __future__ import annotations

import numpy as np

from rpscli.case.case import case_from_mapping
from rpscli.case.conditions import EVENTS
from rpscli.case.design import DesignTask
from rpscli.case.text.document import Fault
from rpscli.errors import CaseError
from rpscli.sweep.design.answer import Answer
from rpscli.sweep.design.judgement import Requirement, demands_of, judged_designs, weights_of
from rpscli.sweep.design.space import Flags, first_places, next_places, usual_count
from rpscli.sweep.points.check import needs_of
from rpscli.sweep.points.layout import StudyPoints
from rpscli.sweep.statistics.grouping import INTENSITY, shown_keys
from rpscli.sweep.table import Array, Table

ROUNDS = 4
"""So many rounds have as many designs as the first one."""


class Search:
    """Designs that are known, and where to look next.

    Parameters
    ----------
    task
        What is looked for.
    """

    def __init__(self, task: DesignTask) -> None:
        search, unknowns = task.file.search, len(task.unknowns)
        self.task = task
        self.first = search.first or usual_count(unknowns)
        self.most = max(search.most or ROUNDS * self.first, self.first)
        self.weights = weights_of(max(len(task.study.sources), 1), search.resamples, search.seed)
        self.requirements: tuple[Requirement, ...] = ()
        self.places: Array = np.empty((0, unknowns))
        self.values: Array = np.empty((0, len(task.keys)))
        self.valid = np.empty(0, dtype=bool)
        self.faults: dict[str, None] = {}
        self._demands: dict[str, Array] = {}

    @property
    def names(self) -> tuple[str, ...]:
        """Results that requirements and aims name."""
        aims = (name for aim in self.task.file.minimise for name in aim)
        named = [*(r.condition.name for r in self.requirements), *aims]
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
            answer.aims,
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
        """Take the requirements from the first designs that are laid out.

        Raises
        ------
        CaseError
            If there are none, or an aim needs a result that the structure cannot have.
        """
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
                where = (
                    "minimise" if any(name in aim for aim in self.task.file.minimise) else "limits"
                )
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
