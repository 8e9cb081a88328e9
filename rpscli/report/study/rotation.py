"""Largest rotations of systems against those of a reference, as in Figure 7 of the paper."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rpscli.report.study.labels import key_columns, label
from rpscli.report.study.panels import by_values, colour, left_out, marker, panel_figure
from rpscli.report.study.report import Report
from rpscli.report.table import Column
from rpscli.sweep.points.described import described
from rpscli.sweep.reports.rotation import (
    RotationOptions,
    RotationPanel,
    RotationReport,
    rotation_report,
    unknown_reference,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def rotation_columns(report: RotationReport) -> list[Column]:
    """One row a pair; a rotation is empty where the structure overturned."""
    pairs = [comparison for panel in report.panels for comparison in panel.comparisons]
    points = np.concatenate([pair.points for pair in pairs])
    references = np.concatenate([pair.reference_points for pair in pairs])
    table = report.table
    rows = [described(table.layout, table.layout[number]) for number in points.tolist()]
    names = list(rows[0]) if rows else []
    varied = key_columns(names, [tuple(row.values()) for row in rows])
    return [
        *varied,
        Column("outcome", "-", table.outcomes[points].tolist()),
        Column("rotation_over_alpha", "-", np.concatenate([pair.rotation for pair in pairs])),
        Column(f"reference {report.key}", "-", [report.reference] * len(rows)),
        Column("reference_outcome", "-", table.outcomes[references].tolist()),
        Column(
            "reference_rotation_over_alpha",
            "-",
            np.concatenate([pair.reference for pair in pairs]),
        ),
    ]


def rotation_figure(report: RotationReport, title: str) -> bytes:
    """Scatter of max|theta|/alpha; what overturned stands on the frame, in open markers."""
    x_top, y_top = (_top(report, side) for side in ("reference", "rotation"))

    def draw(axes: Axes, panel: RotationPanel) -> None:
        for place, comparison in enumerate(panel.comparisons):
            x, y = comparison.reference, comparison.rotation
            stood = np.isfinite(x) & np.isfinite(y)
            look: dict[str, Any] = {
                "color": colour(place),
                "marker": marker(place),
                "ls": "",
                "ms": 3.2,
            }
            axes.plot(
                x[stood], y[stood], **look, alpha=0.75, label=label(report.key, comparison.value)
            )
            axes.plot(
                np.minimum(x[~stood], x_top), np.minimum(y[~stood], y_top), **look,
                mfc="none", mew=0.7, clip_on=False, zorder=3,
            )  # fmt: skip
        axes.plot([0.0, min(x_top, y_top)], [0.0, min(x_top, y_top)], "k--", lw=0.8)

    return panel_figure(
        by_values(report.panel_keys, report.panels),
        report.panels,
        draw,
        title=title,
        x_label=rf"$|\theta_{{max}}|/\alpha$ [-], {label(report.key, report.reference)}",
        y_label=r"$|\theta_{max}|/\alpha$ [-], the others",
        limits=lambda axes: axes.set(xlim=(0.0, x_top), ylim=(0.0, y_top)),
        note="; ".join(filter(None, ["open markers: overturned", left_out(report.failed)])),
    )


def _top(report: RotationReport, side: str) -> float:
    """Where an axis ends: a little above the largest finite rotation."""
    values = [
        getattr(comparison, side) for panel in report.panels for comparison in panel.comparisons
    ]
    joined = np.concatenate([*values, np.zeros(1)])
    return 1.08 * float(joined[np.isfinite(joined)].max()) or 1.0


REPORT = Report(
    options=RotationOptions,
    numbers=lambda study, options: rotation_report(study.table, options),
    tables={"": rotation_columns},
    figure=rotation_figure,
    check=unknown_reference,
)
