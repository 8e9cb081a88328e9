"""Storey shears over the height, isolated and on a fixed base, as in Figure 9 of the paper."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rpscli.analyses.result_quantities import STOREY_SHEARS
from rpscli.report.figures import style
from rpscli.report.study.labels import key_columns
from rpscli.report.study.panels import (
    break_if_narrow,
    by_values,
    left_out,
    over,
    panel_figure,
    remarks,
)
from rpscli.report.study.report import Report
from rpscli.report.table import Column
from rpscli.sweep.reports.storey_shear import (
    StoreyProfile,
    StoreyShearOptions,
    StoreyShearReport,
    storey_shear_report,
    unlike_buildings,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LOOKS = (
    ("mean", "mean of survivors", style.BLACK, "-"),
    ("largest", "largest of survivors", style.RED, "-"),
    ("fixed_mean", "mean, fixed base", style.BLACK, "--"),
    ("fixed_largest", "largest, fixed base", style.RED, "--"),
)


def storey_shear_columns(report: StoreyShearReport) -> list[Column]:
    """One row a storey of each system, from the bottom."""
    rows = [(p, storey) for p in report.profiles for storey in range(len(p.mean))]
    columns = key_columns(report.panel_keys, [p.values for p, _ in rows])
    columns.append(Column("storey", "-", [storey + 1 for _, storey in rows]))
    for attribute, *_ in LOOKS:
        ratios = [float(getattr(p, attribute)[storey]) for p, storey in rows]
        columns.append(Column(f"{attribute}_shear_ratio", "-", ratios))
    for attribute, *_ in LOOKS:
        shears = [float(getattr(p, attribute)[storey] * p.static_base_shear) for p, storey in rows]
        columns.append(Column(f"{attribute}_shear", "N", shears))
    for name in ("counted", "overturned", "failed"):
        columns.append(Column(name, "-", [getattr(p, name) for p, _ in rows]))
    return columns


def storey_shear_figure(report: StoreyShearReport, title: str) -> bytes:
    """Mean and largest shears of survivors, with both counts; the scale is common."""
    in_kn = report.unit == "kN"

    apart = break_if_narrow()

    def draw(axes: Axes, profile: StoreyProfile) -> None:
        edges = np.arange(len(profile.mean) + 1)
        for attribute, name, colour, line in LOOKS:
            values = getattr(profile, attribute)
            if in_kn:
                axes.locator_params(axis="x", nbins=3)  # long numbers
                values = values * profile.static_base_shear * 1e-3
            # The shear is the same all the way up a storey.
            axes.stairs(
                values, edges, orientation="horizontal", color=colour, ls=line, lw=1.3, label=name
            )
        axes.set_ylim(0.0, len(profile.mean))
        axes.locator_params(axis="y", integer=True)
        every = profile.counted + profile.overturned
        axes.text(
            0.96, 0.95, f"{profile.counted} survivors{apart}of {every}",
            transform=axes.transAxes, ha="right", va="top", fontsize=0.9 * style.small(),
        )  # fmt: skip

    return panel_figure(
        by_values(report.panel_keys, report.profiles),
        report.profiles,
        draw,
        title=title,
        x_label=STOREY_SHEARS.in_unit("kN", STOREY_SHEARS.symbol) if in_kn else "$V_i/V_{st}$ [-]",
        y_label="level (0 = cap beam)",
        share="x",
        limits=lambda axes: axes.set_xlim(left=0.0),
        note=remarks(over(report.pooled), left_out(sum(p.failed for p in report.profiles))),
    )


REPORT = Report(
    options=StoreyShearOptions,
    numbers=lambda study, options: storey_shear_report(study.table, study.fixed_base, options),
    tables={"": storey_shear_columns},
    figure=storey_shear_figure,
    notes=lambda report: report.notes,
    requires=unlike_buildings,
)
