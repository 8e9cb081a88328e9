"""Spectra of the floors of a study: fractiles over the records, isolated beside fixed base."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from rpscli.analyses.floor_spectra import (
    DAMPING,
    PERIODS,
    fixed_base_floor_spectra,
    isolated_floor_spectra,
)
from rpscli.case.study.reports import ReportOptions
from rpscli.case.study.schema import DampingRatio
from rpscli.sweep.points.layout import StudyPoints
from rpscli.sweep.statistics.grouping import apart, pooled, pooling_note, shown_keys
from rpscli.sweep.study_results import StudyResults
from rpscli.sweep.table import Array, computed_groups, leading_keys

FRACTILES = (0.16, 0.50, 0.84)


class FloorSpectraOptions(ReportOptions):
    """Spectra of equipment on the floors: fractiles, isolated beside fixed base."""

    damping: DampingRatio = Field(DAMPING, description="of the equipment")


@dataclass(frozen=True, eq=False)
class Spread:
    """Fractiles (3, n, p) over the histories of floors and periods; infinite if overturned.

    Pseudo-accelerations [m/s2] and displacements relative to the floor [m].
    """

    pseudo_acceleration: Array
    displacement: Array


@dataclass(frozen=True, eq=False)
class FloorSpectraPanel:
    """One system at one intensity; `counted` histories, of which `overturned`."""

    values: tuple[object, ...]
    isolated: Spread
    fixed_base: Spread
    counted: int
    overturned: int
    failed: int


@dataclass(frozen=True)
class FloorSpectraReport:
    """All systems and intensities, over the same periods (p,) [s]."""

    keys: tuple[str, ...]
    periods: Array
    panels: tuple[FloorSpectraPanel, ...]
    pooled: tuple[str, ...]
    notes: tuple[str, ...]


def floor_spectra_report(study: StudyResults, options: FloorSpectraOptions) -> FloorSpectraReport:
    """Run the histories once more for their samples, which are not stored."""
    table, layout = study.table, study.table.layout
    keys = apart(layout, leading_keys(layout))
    panels = []
    for group, points in computed_groups(table, keys):
        spectra = np.array([_spectra(study, int(p), options.damping) for p in points])
        # An overturned history is larger than any demand; its building on a fixed base is not.
        spectra[table.overturned[points], 0] = np.inf
        spread = np.quantile(spectra, FRACTILES, axis=0, method="inverted_cdf")
        panels.append(
            FloorSpectraPanel(
                group.values,
                Spread(spread[:, 0, 0], spread[:, 0, 1]),
                Spread(spread[:, 1, 0], spread[:, 1, 1]),
                counted=len(points),
                overturned=int(table.overturned[points].sum()),
                failed=len(group.points) - len(points),
            )
        )
    return FloorSpectraReport(
        keys=shown_keys(layout, keys),
        periods=PERIODS,
        panels=tuple(panels),
        pooled=pooled(layout, keys),
        notes=tuple(pooling_note(layout, keys)),
    )


def _spectra(study: StudyResults, number: int, damping: float) -> NDArray[np.float64]:
    """(2, 2, n, p) isolated and fixed base; pseudo-acceleration and displacement."""
    from rpscli.analyses.timehistory import time_history

    given = study.context.history(study.table.layout[number])
    result = time_history(given.structure, given.motion.scaled(given.scale), given.settings)
    fixed = fixed_base_floor_spectra(result, damping=damping)
    assert fixed is not None, "every system has a building"
    both = isolated_floor_spectra(result, damping=damping), fixed
    return np.array([(spectra.pseudo_acceleration, spectra.displacement) for spectra in both])


def without_floors(layout: StudyPoints, _options: FloorSpectraOptions) -> Iterator[str]:
    """Systems without a building, or with different ones in a sample."""
    storeys = np.array([properties.storeys for properties in layout.properties])
    by_sample = storeys.reshape(layout.combinations.shape)
    if not storeys.all():
        yield "a system has no superstructure, and so no floors; leave out storeys: 0"
    elif (np.ptp(by_sample, axis=-1) > 0).any():
        yield "the sample varies the number of storeys; vary it in an axis instead"
