"""Outcomes and demands of each system at each intensity."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rpscli.analyses.result_quantities import LIMITED, ResultQuantity
from rpscli.sweep.statistics.fixed_base import FixedBaseReferences
from rpscli.sweep.statistics.fractiles import Spread, demand, spread
from rpscli.sweep.statistics.grouping import grouping
from rpscli.sweep.statistics.share import Share
from rpscli.sweep.table import Array, Indices, Table

REDUCTION = next(quantity for quantity in LIMITED if quantity.name == "fixed_base_ratio")


@dataclass(frozen=True, eq=False)
class SummaryRow:
    """Histories of one system at one intensity.

    `points` are those that did not fail, `spreads` belong to the quantities of the summary.
    """

    values: tuple[object, ...]
    points: Indices
    failed: int
    overturned: Share
    spreads: tuple[Spread, ...]


@dataclass(frozen=True, eq=False)
class Summary:
    """All rows; `pooled` says what differs within a row besides the record, `notes` warn of it."""

    keys: tuple[str, ...]
    pooled: tuple[str, ...]
    notes: tuple[str, ...]
    quantities: tuple[ResultQuantity, ...]
    rows: tuple[SummaryRow, ...]


def summary(table: Table, fixed: FixedBaseReferences) -> Summary:
    """Count and order the histories of each system at each intensity.

    Parameters
    ----------
    table
        Of time histories.
    fixed
        Storey shears on a fixed base, as a reference.
    """
    columns = {quantity: table.columns[quantity.name] for quantity in LIMITED}
    columns[REDUCTION] = shear_over_fixed_base(table, fixed)
    known = {
        q: demand(table, v, from_below=q.from_below)
        for q, v in columns.items()
        if not np.isnan(v).all()
    }
    found = grouping(table)
    rows = (
        SummaryRow(
            values=group.values,
            points=group.points,
            failed=group.failed,
            overturned=group.overturned,
            spreads=tuple(
                spread(column[group.points], from_below=q.from_below) for q, column in known.items()
            ),
        )
        for group in found.groups
    )
    return Summary(found.keys, found.pooled, found.notes, tuple(known), tuple(rows))


def shear_over_fixed_base(table: Table, fixed: FixedBaseReferences) -> Array:
    """(points,) base shear over that of the same building on a fixed base; NaN without one."""
    layout = table.layout
    within = layout.points_of_system // len(layout.records)
    reference = np.full(len(layout), np.nan)
    for system, properties in enumerate(layout.properties):
        for place, record in enumerate(layout.records):
            request = record or properties.record
            if request is not None and (system, request) in fixed:
                first = system * layout.points_of_system + place * within
                reference[first : first + within] = fixed[system, request][0]
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(table.columns["max_base_shear"] / (np.abs(table.scale) * reference))
