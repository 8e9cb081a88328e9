"""Incremental dynamic analysis: demand of every record against intensity, and its fractiles."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np
from pydantic import Field

from rpscli.analyses.result_quantities import DEMANDS
from rpscli.case.study.axes import Axis
from rpscli.case.study.reports import ReportOptions, ReportRequest
from rpscli.case.study.schema import Keys
from rpscli.case.text.document import Document, Fault
from rpscli.sweep.statistics.fractiles import demand, fractiles
from rpscli.sweep.statistics.grouping import INTENSITY, pooled, pooling_note
from rpscli.sweep.table import Array, Indices, Table, groups, leading_keys

FRACTILES = (0.16, 0.50, 0.84)


if TYPE_CHECKING:
    DemandName = str
else:
    DemandName = Literal[tuple(quantity.name for quantity in DEMANDS)]


class IdaOptions(ReportOptions):
    """Incremental dynamic analysis: demand against intensity, with fractiles."""

    demand: DemandName = Field("rotation_ratio", description="horizontal axis")
    panels: Keys | None = Field(None, description="varied keys, one panel for each value")


@dataclass(frozen=True, eq=False)
class IdaPanel:
    """Demands of one group of systems.

    Parameters
    ----------
    levels
        (levels,) intensities, or factors on the records, ascending.
    curves
        (curves, levels) demand of each record, sample and member; infinite where the structure
        overturned, NaN where the point failed.
    fractiles
        (3, levels) at 16, 50 and 84 % of the points that did not fail; infinite where that many
        overturned.
    """

    values: tuple[object, ...]
    levels: Array
    curves: Array
    fractiles: Array
    overturned: tuple[int, ...]
    failed: int


@dataclass(frozen=True)
class IdaReport:
    """All panels; `measure` is None where factors stand for intensities."""

    demand: str
    measure: str | None
    panel_keys: tuple[str, ...]
    panels: tuple[IdaPanel, ...]
    pooled: tuple[str, ...]
    notes: tuple[str, ...]


def ida_report(table: Table, options: IdaOptions) -> IdaReport:
    """Curves and fractiles of each system."""
    keys = options.panels if options.panels is not None else leading_keys(table.layout)
    measure = table.layout.plan.measure
    return IdaReport(
        demand=options.demand,
        measure=measure.measure if measure else None,
        panel_keys=keys,
        panels=tuple(
            _panel(table, options.demand, group.values, group.points)
            for group in groups(table.layout, keys)
        ),
        pooled=pooled(table.layout, (*keys, INTENSITY)),
        notes=tuple(pooling_note(table.layout, (*keys, INTENSITY))),
    )


def _panel(table: Table, name: str, values: tuple[object, ...], points: Indices) -> IdaPanel:
    demands = demand(table, table.columns[name])
    by_level = sorted(groups(table.layout, ["scale"], points), key=_level)
    curves = np.column_stack([demands[group.points] for group in by_level])
    return IdaPanel(
        values=values,
        levels=np.array([_level(group) for group in by_level]),
        curves=curves,
        fractiles=np.column_stack([fractiles(column, FRACTILES) for column in curves.T]),
        overturned=tuple(int(np.isinf(column).sum()) for column in curves.T),
        failed=int(table.failed[points].sum()),
    )


def _level(group: tuple[tuple[object, ...], Indices]) -> float:
    return float(str(group[0][0]))


def single_intensity(
    document: Document, _axes: Sequence[Axis], request: ReportRequest
) -> Iterator[Fault]:
    """A study without several intensities has no curves."""
    if not isinstance(document.content.get("scale"), dict | list):
        text = "the report ida needs several intensities: scale: {measure: PGV, values: [...]}"
        yield Fault(request.path, text)
