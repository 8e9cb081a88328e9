"""Incremental dynamic analysis: demand of every record against intensity, and its fractiles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rpscli.case.study_reports import IdaOptions
from rpscli.sweep.table import Array, Indices, Table, groups, leading_keys

FRACTILES = (0.16, 0.50, 0.84)


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


def ida_report(table: Table, options: IdaOptions) -> IdaReport:
    """Curves and fractiles of each system."""
    keys = options.panels if options.panels is not None else leading_keys(table.design)
    measure = table.design.plan.measure
    return IdaReport(
        demand=options.demand,
        measure=measure.measure if measure else None,
        panel_keys=keys,
        panels=tuple(
            _panel(table, options.demand, group.values, group.points)
            for group in groups(table.design, keys)
        ),
    )


def _panel(table: Table, name: str, values: tuple[object, ...], points: Indices) -> IdaPanel:
    demand = np.where(table.overturned, np.inf, table.columns[name])
    demand = np.where(table.failed, np.nan, demand)
    by_level = sorted(groups(table.design, ["scale"], points), key=_level)
    curves = np.column_stack([demand[group.points] for group in by_level])
    return IdaPanel(
        values=values,
        levels=np.array([_level(group) for group in by_level]),
        curves=curves,
        fractiles=np.column_stack([_fractiles(column) for column in curves.T]),
        overturned=tuple(int(np.isinf(column).sum()) for column in curves.T),
        failed=int(table.failed[points].sum()),
    )


def _level(group: tuple[tuple[object, ...], Indices]) -> float:
    return float(str(group[0][0]))


def _fractiles(demands: Array) -> Array:
    """Fractiles that are demands of the sample themselves, so that infinite ones may stand."""
    known = np.sort(demands[~np.isnan(demands)])
    if not len(known):
        return np.full(len(FRACTILES), np.nan)
    return np.quantile(known, FRACTILES, method="inverted_cdf")
