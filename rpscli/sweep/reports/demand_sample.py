"""Demands of every storey and floor under each record, as programs for losses take them."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from rpscli.case.study.reports import ReportOptions
from rpscli.sweep.run.schedule import LARGEST_BATCH
from rpscli.sweep.statistics.grouping import apart, shown_keys
from rpscli.sweep.study_results import StudyResults
from rpscli.sweep.table import Array, Indices, computed_groups, leading_keys


class DemandSampleOptions(ReportOptions):
    """Demands of storeys and floors for loss assessment, as pelicun reads them."""


@dataclass(frozen=True, eq=False)
class DemandSample:
    """One system at one intensity: a row for each history that did not fail.

    Parameters
    ----------
    values
        Of the keys of the report.
    points
        (m,) places in the study.
    accelerations
        (m, n + 1) largest absolute ones of ground and floors [m/s2].
    drifts
        (m, n) largest drift ratios of the storeys.
    displacements
        (m,) largest ones of the cap beam [m].
    residual_rotations
        (m,) of the columns [rad]; the building is linear, and keeps no drift.
    overturned
        (m,) 1 where it overturned; the other demands are those until then.
    """

    values: tuple[object, ...]
    points: Indices
    accelerations: Array
    drifts: Array
    displacements: Array
    residual_rotations: Array
    overturned: Array
    failed: int


@dataclass(frozen=True)
class DemandSampleReport:
    """All systems and intensities with a history that did not fail."""

    keys: tuple[str, ...]
    samples: tuple[DemandSample, ...]


def demand_sample_report(study: StudyResults, _options: DemandSampleOptions) -> DemandSampleReport:
    """Run the histories once more for the demands of single floors, which are not stored."""
    table, layout = study.table, study.table.layout
    keys = apart(layout, leading_keys(layout))
    samples = []
    for group, points in computed_groups(table, keys):
        floors, drifts = _of_floors(study, points.tolist())
        columns = {name: table.columns[name][points] for name in COLUMNS}
        samples.append(
            DemandSample(
                values=group.values,
                points=points,
                accelerations=np.column_stack([columns["pga"], floors]),
                drifts=drifts,
                displacements=columns["max_cap_beam_displacement"],
                residual_rotations=np.abs(columns["residual_rotation"]),
                overturned=table.overturned[points].astype(float),
                failed=len(group.points) - len(points),
            )
        )
    return DemandSampleReport(shown_keys(layout, keys), tuple(samples))


COLUMNS = ("pga", "max_cap_beam_displacement", "residual_rotation")


def _of_floors(study: StudyResults, numbers: Sequence[int]) -> tuple[Array, Array]:
    """(m, n) largest accelerations of the floors [m/s2] and drift ratios of the storeys."""
    from rpscli.analyses.demand import demands

    requests = [study.context.history(study.table.layout[number]) for number in numbers]
    parts = [requests[f : f + LARGEST_BATCH] for f in range(0, len(requests), LARGEST_BATCH)]
    with ThreadPoolExecutor(study.jobs) as pool:
        found = [demand for part in pool.map(demands, parts) for demand in part]
    ratios = []
    for demand in found:
        building = demand.structure.superstructure
        assert building is not None, "every system has a drift ratio"
        ratios.append(building.drift_ratios(demand.max_drifts))
    accelerations = [demand.floor_accelerations for demand in found]
    return np.array(accelerations), np.array(ratios, dtype=float)
