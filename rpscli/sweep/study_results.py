"""A computed study, and what else reports take from it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rpscli.sweep.evaluation.context import StudyContext
from rpscli.sweep.intensities import Asked, Intensity, intensity
from rpscli.sweep.statistics.fixed_base import FixedBaseReferences, fixed_base_references
from rpscli.sweep.store import Store, Stored
from rpscli.sweep.table import Array, Table


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

    def intensity(self, options: Asked) -> Intensity:
        """The intensity of the ground motion at every point."""
        return intensity(self.table, self.context, options)

    def floor_spectra(self, number: int, damping: float) -> Array:
        """(2, 2, n, p): isolated and fixed base; pseudo-acceleration and displacement."""
        # Samples are not stored, so that the history is run once more.
        from rpscli.analyses import floor_spectra as spectra
        from rpscli.analyses.timehistory import time_history

        given = self.context.history(self.table.layout[number])
        result = time_history(given.structure, given.motion.scaled(given.scale), given.settings)
        fixed = spectra.fixed_base_floor_spectra(result, damping=damping)
        assert fixed is not None, "every system has a building"
        both = spectra.isolated_floor_spectra(result, damping=damping), fixed
        return np.array([(each.pseudo_acceleration, each.displacement) for each in both])
