"""Results over the direction of the ground motion: curves of all pairs, worst and RotD50."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rpscli.report.figures import style
from rpscli.report.study.labels import key_columns
from rpscli.report.study.panels import by_values, left_out, panel_figure, remarks
from rpscli.report.study.report import Report
from rpscli.report.study.statistics import reached
from rpscli.report.table import Column
from rpscli.sweep.reports.directions import (
    DirectionsOptions,
    DirectionsPanel,
    DirectionsReport,
    directions_report,
    without_directions,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def spread_columns(report: DirectionsReport) -> list[Column]:
    """One row a system, intensity and result: fractiles over the pairs.

    `overturned` counts the pairs that overturn it in some direction.
    """
    rows = [(panel, spread) for panel in report.panels for spread in panel.spreads]
    return [
        *key_columns(report.keys, [panel.values for panel, _ in rows]),
        Column("result", "-", [spread.quantity.name for _, spread in rows]),
        Column("unit", "-", [spread.quantity.unit for _, spread in rows]),
        Column("pairs", "-", [len(panel.curves) for panel, _ in rows]),
        Column("overturned", "-", [sum(c.overturned > 0 for c in p.curves) for p, _ in rows]),
        Column("worst_median", "SI", [reached(float(s.worst[0])) for _, s in rows]),
        Column("worst_84", "SI", [reached(float(s.worst[1])) for _, s in rows]),
        Column("rotd50_median", "SI", [reached(float(s.rotd50[0])) for _, s in rows]),
        Column("rotd50_84", "SI", [reached(float(s.rotd50[1])) for _, s in rows]),
    ]


def pair_columns(report: DirectionsReport) -> list[Column]:
    """One row a system, intensity, pair and result."""
    rows = [
        (panel, curve, result)
        for panel in report.panels
        for curve in panel.curves
        for result in curve.results
    ]
    return [
        *key_columns(report.keys, [panel.values for panel, *_ in rows]),
        Column("pair", "-", [curve.pair for _, curve, _ in rows]),
        Column("directions", "-", [len(curve.angles) for _, curve, _ in rows]),
        Column("overturned", "-", [curve.overturned for _, curve, _ in rows]),
        Column("failed", "-", [curve.failed for _, curve, _ in rows]),
        Column("result", "-", [result.quantity.name for *_, result in rows]),
        Column("unit", "-", [result.quantity.unit for *_, result in rows]),
        Column("worst", "SI", [reached(result.worst) for *_, result in rows]),
        Column("worst_angle", "deg", [result.worst_angle for *_, result in rows]),
        Column("rotd50", "SI", [reached(result.rotd50) for *_, result in rows]),
    ]


def directions_figure(report: DirectionsReport, title: str) -> bytes:
    """The result of each pair over the angle; what overturned stands on the frame, open."""
    drawn = [curve.drawn for panel in report.panels for curve in panel.curves]
    every = np.concatenate([*drawn, np.zeros(1)])
    top = 1.08 * float(every[np.isfinite(every)].max()) or 1.0

    def draw(axes: Axes, panel: DirectionsPanel) -> None:
        for curve in panel.curves:
            stood = np.isfinite(curve.drawn)
            worst = next((r for r in curve.results if r.quantity == report.drawn), None)
            axes.plot(
                curve.angles, np.where(stood, curve.drawn, np.nan), lw=0.8, alpha=0.55,
                color=style.BLUE, marker=".", ms=3.0, label="pairs",
            )  # fmt: skip
            if len(fallen := curve.angles[curve.drawn == np.inf]):
                axes.plot(
                    fallen, np.full(len(fallen), top), ls="", marker="o", ms=3.4, mfc="none",
                    color=style.RED, clip_on=False, label="overturned",
                )  # fmt: skip
            if worst is not None and np.isfinite(worst.worst):
                axes.plot(
                    worst.worst_angle, worst.worst, ls="", marker="^", ms=4.5, color=style.BLACK,
                    label="worst direction",
                )  # fmt: skip
        axes.set_xticks(range(0, 181, 45))
        _levels(axes, panel, report)

    return panel_figure(
        by_values(report.keys, report.panels),
        report.panels,
        draw,
        title=title,
        x_label="angle from the first component [deg]",
        y_label=report.drawn.axis_label,
        limits=lambda axes: axes.set(xlim=(-4.0, 184.0), ylim=(0.0, top)),
        note=remarks(_beyond(report), left_out(report.failed)),
    )


def _beyond(report: DirectionsReport) -> str:
    """A median is larger than any demand where half of the pairs overturn."""
    levels = [s for p in report.panels for s in p.spreads if s.quantity == report.drawn]
    unbounded = any(np.isinf(s.worst[0]) or np.isinf(s.rotd50[0]) for s in levels)
    return "medians are not drawn where so many overturned" if unbounded else ""


def _levels(axes: Axes, panel: DirectionsPanel, report: DirectionsReport) -> None:
    """Medians over the pairs, as levels."""
    for spread in panel.spreads:
        if spread.quantity == report.drawn:
            levels = {
                "worst direction, median of pairs": (spread.worst[0], "--"),
                "RotD50, median of pairs": (spread.rotd50[0], ":"),
            }
            for name, (level, dashes) in levels.items():
                if np.isfinite(level):
                    axes.axhline(level, ls=dashes, lw=1.4, color=style.BLACK, label=name)


REPORT = Report(
    options=DirectionsOptions,
    numbers=lambda study, options: directions_report(study.table, options),
    tables={"": spread_columns, "_pairs": pair_columns},
    figure=directions_figure,
    drawable=lambda report: any(panel.curves for panel in report.panels),
    notes=lambda report: report.notes,
    requires=without_directions,
)
