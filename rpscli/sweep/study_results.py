"""A computed study, and what else reports take from it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from rpscli.sweep.evaluation.context import StudyContext
from rpscli.sweep.intensities import Intensity, MeasureOptions, intensity
from rpscli.sweep.statistics.fixed_base import FixedBaseReferences, fixed_base_references
from rpscli.sweep.store import Store, Stored
from rpscli.sweep.table import Table


@dataclass(frozen=True, eq=False)
class StudyResults:
    """Results of all points as a table, and the ways to what is not in it."""

    table: Table
    keys: list[bytes]
    store: Store
    context: StudyContext
    jobs: int

    def stored(self) -> Stored:
        """Everything that is stored of each point by name, lists too."""
        return self.store.stored(self.keys)

    @cached_property
    def fixed_base(self) -> FixedBaseReferences:
        """Storey shears on a fixed base; computed if they are not stored."""
        return fixed_base_references(self.table.layout, self.context, self.store, self.jobs)

    def intensity(self, options: MeasureOptions) -> Intensity:
        """The intensity of the ground motion at every point."""
        return intensity(self.table, self.context, options)
