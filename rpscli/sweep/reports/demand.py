"""Base shear against rotation, with its bilinear summary (paper, Figure 8)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from pydantic import Field

from rpscli.case.study.reports import ReportOptions
from rpscli.case.study.schema import Keys
from rpscli.sweep.fits.bilinear import FEWEST, Bilinear, bilinear_fit
from rpscli.sweep.statistics.grouping import INTENSITY, apart, pooled, pooling_note, shown_keys
from rpscli.sweep.table import Array, Indices, Table, groups, leading_keys


class DemandOptions(ReportOptions):
    """Base shear against rotation with its bilinear summary."""

    panels: Keys | None = Field(None, description="varied keys, one panel for each value")
    series: Keys | None = Field(None, description="varied keys, one colour for each value")


@dataclass(frozen=True, eq=False)
class DemandSeries:
    """Points of one colour: theta/theta_cr and V_b/V_st, (points,)."""

    values: tuple[object, ...]
    points: Indices
    rotation_ratio: Array
    base_shear_ratio: Array


@dataclass(frozen=True, eq=False)
class DemandPanel:
    """Points that lifted off and stood, and the curve through all of them.

    `fit` is None where there are too few points, and `note` says so. `at_rest`, `overturned` and
    `failed` count the points that were left out.
    """

    values: tuple[object, ...]
    series: tuple[DemandSeries, ...]
    fit: Bilinear | None
    note: str | None
    counted: int
    at_rest: int
    overturned: int
    failed: int


@dataclass(frozen=True)
class DemandReport:
    """All panels."""

    panel_keys: tuple[str, ...]
    series_keys: tuple[str, ...]
    panels: tuple[DemandPanel, ...]
    pooled: tuple[str, ...]
    pooling: tuple[str, ...]

    @property
    def notes(self) -> list[str]:
        """What is pooled, and where there is no curve."""
        notes = list(self.pooling)
        without = [panel.note for panel in self.panels if panel.note]
        if without:
            count = f"{len(without)} of {len(self.panels)} panels have no curve"
            notes.append(f"{count}: {without[0]}")
        return notes


def demand_report(table: Table, options: DemandOptions) -> DemandReport:
    """Group the points and fit each panel.

    By default the axis in the middle of three gives the colours, the others and the intensity give
    the panels.
    """
    layout = table.layout
    leading = leading_keys(layout)
    series = options.series if options.series is not None else leading[1:-1]
    panels = options.panels
    if panels is None:
        panels = tuple(key for key in leading if key not in series)
        if INTENSITY not in series:
            panels = apart(layout, panels)
    found = tuple(
        _panel(table, group.values, group.points, series) for group in groups(layout, panels)
    )
    apart_by = (*panels, *series)
    return DemandReport(
        panel_keys=shown_keys(layout, panels),
        series_keys=shown_keys(layout, series),
        panels=found,
        pooled=pooled(layout, apart_by),
        pooling=tuple(pooling_note(layout, apart_by)),
    )


def too_few(points: int) -> str:
    """Why there is no curve of two pieces."""
    return f"{points} different rotations of survivors; the curve needs {2 * FEWEST}"


def _panel(
    table: Table, values: tuple[object, ...], points: Indices, series: tuple[str, ...]
) -> DemandPanel:
    x, y = table.columns["rotation_ratio"], table.columns["base_shear_ratio"]
    kept = points[(table.outcomes[points] == "survived") & np.isfinite(y[points])]
    return DemandPanel(
        values=values,
        series=tuple(
            DemandSeries(group.values, group.points, x[group.points], y[group.points])
            for group in groups(table.layout, series, kept)
        ),
        fit=(fit := bilinear_fit(x[kept], y[kept])),
        note=None if fit else too_few(len(np.unique(x[kept]))),
        counted=len(kept),
        at_rest=int((table.outcomes[points] == "at_rest").sum()),
        overturned=int(table.overturned[points].sum()),
        failed=int(table.failed[points].sum()),
    )
