"""Base shear against rotation with its bilinear summary, as in Figure 8 of the paper."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rpscli.report.figures import style
from rpscli.report.study.labels import key_columns, labels
from rpscli.report.study.panels import (
    break_if_narrow,
    by_values,
    colour,
    left_out,
    marker,
    over,
    panel_figure,
    remarks,
)
from rpscli.report.study.report import Report
from rpscli.report.table import Column
from rpscli.sweep.evaluation.results import SCALARS
from rpscli.sweep.reports.demand import DemandOptions, DemandPanel, DemandReport, demand_report

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FITTED = (
    ("saturation_rotation_ratio", "break_x"),
    ("saturation_base_shear_ratio", "break_y"),
    ("k_s", "slope_after"),
    ("slope_before", "slope"),
    ("base_shear_ratio_at_uplift", "start"),
    ("residual", "residual"),
)
COUNTS = ("counted", "at_rest", "overturned", "failed")


def demand_columns(report: DemandReport) -> list[Column]:
    """One row a panel: the bilinear curve, and the points that it went through or left out."""
    panels = report.panels
    columns = key_columns(report.panel_keys, [panel.values for panel in panels])
    for name, attribute in FITTED:
        columns.append(Column(name, "-", [getattr(p.fit, attribute, None) for p in panels]))
    columns += [Column(name, "-", [getattr(p, name) for p in panels]) for name in COUNTS]
    return [*columns, Column("note", "-", [panel.note for panel in panels])]


def demand_figure(report: DemandReport, title: str) -> bytes:
    """V_b/V_st of all that lifted off and stood against max|theta|/theta_cr."""
    highest = max(
        (s.rotation_ratio.max(initial=0.0) for p in report.panels for s in p.series), default=0.0
    )

    across = np.linspace(0.3, 1.0, 8) * highest
    top = max(
        (s.base_shear_ratio.max(initial=0.0) for p in report.panels for s in p.series), default=0.0
    )

    apart = break_if_narrow()

    def draw(axes: Axes, panel: DemandPanel) -> None:
        for place, series in enumerate(panel.series):
            axes.plot(
                series.rotation_ratio, series.base_shear_ratio, ls="", marker=marker(place),
                ms=2.4, alpha=0.55, mew=0.0, color=colour(place),
                label=labels(report.series_keys, series.values) or None,
            )  # fmt: skip
        text = "no curve: too few points"
        if (fit := panel.fit) is not None:
            x = np.array([0.0, fit.break_x, max(highest, fit.break_x)])
            axes.plot(x, fit(x), color=style.BLACK, lw=1.6, label="bilinear fit")
            text = (
                f"saturation at{apart}{fit.break_x:.3f}, {fit.break_y:.2f}"
                f"\nslope kₛ{apart}{fit.slope_after:.2f} beyond"
            )
        # Where the curve runs through the lower right, the upper left is free.
        rising = fit is not None and bool(np.min(fit(across)) < 0.25 * top)
        axes.text(
            0.04 if rising else 0.96, 0.95 if rising else 0.05, text, transform=axes.transAxes,
            ha="left" if rising else "right", va="top" if rising else "bottom",
            fontsize=0.9 * style.small(),
            bbox={"fc": "white", "ec": "none", "alpha": 0.8, "pad": 1.5},
        )  # fmt: skip

    def limits(axes: Axes) -> None:
        axes.set_xlim(0.0, 1.04 * highest or 1.0)
        axes.set_ylim(bottom=0.0)

    return panel_figure(
        by_values(report.panel_keys, report.panels),
        report.panels,
        draw,
        title=title,
        x_label=SCALARS["timehistory"]["rotation_ratio"].axis_label,
        y_label=SCALARS["timehistory"]["base_shear_ratio"].axis_label,
        limits=limits,
        note=remarks(
            over(report.pooled),
            _fallen(sum(panel.overturned for panel in report.panels)),
            left_out(sum(panel.failed for panel in report.panels)),
        ),
    )


def _fallen(overturned: int) -> str:
    return f"{overturned} overturned points left out" if overturned else ""


REPORT = Report(
    options=DemandOptions,
    numbers=lambda study, options: demand_report(study.table, options),
    tables={"": demand_columns},
    figure=demand_figure,
    notes=lambda report: report.notes,
)
