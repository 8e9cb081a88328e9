"""Curves of incremental dynamic analyses with their fractiles."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rpscli.report.figures import style
from rpscli.report.study.labels import key_columns
from rpscli.report.study.panels import by_values, left_out, over, panel_figure, remarks
from rpscli.report.study.report import Report
from rpscli.report.table import Column
from rpscli.sweep.evaluation.results import SCALARS
from rpscli.sweep.intensities import unit_of
from rpscli.sweep.reports.ida import (
    FRACTILES,
    IdaOptions,
    IdaPanel,
    IdaReport,
    ida_report,
    single_intensity,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MOST_CURVES = 200
LINES = ((style.BLUE, ":"), (style.BLUE, "-"), (style.BLUE, "--"))


def ida_columns(report: IdaReport) -> list[Column]:
    """One row a level of each system; a fractile is empty where so many overturned."""
    rows = [(p, level) for p in report.panels for level in range(len(p.levels))]
    name, unit = _level(report)
    demand = SCALARS["timehistory"][report.demand]
    columns = key_columns(report.panel_keys, [p.values for p, _ in rows])
    columns.append(Column(name, unit, [float(p.levels[i]) for p, i in rows]))
    for place, fractile in enumerate(FRACTILES):
        values = [float(p.fractiles[place, i]) for p, i in rows]
        columns.append(Column(f"{report.demand}_{round(100 * fractile)}", demand.unit, values))
    points = [int(np.sum(~np.isnan(p.curves[:, i]))) for p, i in rows]
    return [
        *columns,
        Column("counted", "-", points),
        Column("overturned", "-", [p.overturned[i] for p, i in rows]),
        Column(
            "failed",
            "-",
            [len(p.curves) - count for (p, _), count in zip(rows, points, strict=True)],
        ),
    ]


def ida_figure(report: IdaReport, title: str) -> bytes:
    """Demand to the right, intensity upwards; a curve runs out of the frame where it overturns."""
    finite = [p.curves[np.isfinite(p.curves)] for p in report.panels]
    edge = 1.15 * max((float(values.max()) for values in finite if len(values)), default=1.0)
    top = 1.04 * max(float(p.levels.max()) for p in report.panels)

    def draw(axes: Axes, panel: IdaPanel) -> None:
        levels = np.concatenate([[0.0], panel.levels])
        # Evenly through all of them: more would only blacken the panel.
        for curve in panel.curves[:: max(1, len(panel.curves) // MOST_CURVES)]:
            axes.plot(
                *_run_out(curve, levels, edge), color=style.GREY, lw=0.5, alpha=0.5,
                label="single curves",
            )  # fmt: skip
        for fractile, (colour, line), share in zip(panel.fractiles, LINES, FRACTILES, strict=True):
            axes.plot(
                *_run_out(fractile, levels, edge), color=colour, ls=line, lw=1.8,
                label="median" if share == 0.5 else f"{style.percent(share)} fractile",
            )  # fmt: skip

    name, unit = _level(report)
    return panel_figure(
        by_values(report.panel_keys, report.panels),
        report.panels,
        draw,
        title=title,
        x_label=SCALARS["timehistory"][report.demand].axis_label,
        y_label=f"{name} [{unit}]",
        limits=lambda axes: axes.set(xlim=(0.0, 0.97 * edge), ylim=(0.0, top)),
        note=remarks(over(report.pooled), left_out(sum(p.failed for p in report.panels))),
    )


def _run_out(
    demand: np.ndarray[tuple[int], np.dtype[np.float64]],
    levels: np.ndarray[tuple[int], np.dtype[np.float64]],
    edge: float,
) -> tuple[list[float], list[float]]:
    """A curve from the origin to the first level at which it leaves the frame."""
    x, y = [0.0], [0.0]
    for value, level in zip(demand.tolist(), levels[1:].tolist(), strict=True):
        if np.isnan(value):
            continue
        if np.isinf(value):
            # Flat at the last level that stood: a little more, and it overturns.
            x.append(edge)
            y.append(y[-1])
            break
        x.append(value)
        y.append(level)
    return x, y


def _level(report: IdaReport) -> tuple[str, str]:
    name = report.measure or "scale"
    return name, unit_of(name)


REPORT = Report(
    options=IdaOptions,
    numbers=lambda study, options: ida_report(study.table, options),
    tables={"": ida_columns},
    figure=ida_figure,
    notes=lambda report: report.notes,
    check=single_intensity,
    results=lambda options: [options.demand],
)
