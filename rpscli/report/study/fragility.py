"""Fragility curves with their bands and the data they go through."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rpscli.report.files.csv_text import Column
from rpscli.report.study.labels import key_columns, labels, quoted
from rpscli.report.study.panels import Layout, colour, left_out, marker, panel_figure
from rpscli.report.study.report import Report
from rpscli.sweep.reports.fragility import (
    Fragility,
    FragilityOptions,
    FragilityReport,
    fragility_report,
    limit_states,
)
from rpscli.sweep.reports.intensities import Intensity

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MOST_BANDS = 4
"""Curves in one panel beyond which bands would hide each other."""


def fragility_columns(report: FragilityReport) -> list[Column]:
    """One row a curve: median and beta with their bands, counts, and how the fit was had."""
    curves, unit = report.curves, report.intensity.unit
    im = report.intensity.measure
    return [
        *key_columns(report.series_keys, [c.values for c in curves]),
        Column("limit", "-", [quoted(c.limit.label) for c in curves]),
        Column("intensity", "-", [im] * len(curves)),
        Column("method", "-", [c.fit.method for c in curves]),
        Column("median", unit, [c.fit.median for c in curves]),
        Column("median_low", unit, [c.fit.median_band[0] for c in curves]),
        Column("median_high", unit, [c.fit.median_band[1] for c in curves]),
        Column("beta", "-", [c.fit.beta for c in curves]),
        Column("beta_low", "-", [c.fit.beta_band[0] for c in curves]),
        Column("beta_high", "-", [c.fit.beta_band[1] for c in curves]),
        Column("counted", "-", [c.counted for c in curves]),
        Column("exceeded", "-", [c.exceeded for c in curves]),
        Column("failed", "-", [c.failed for c in curves]),
        Column("note", "-", [quoted(c.fit.note) for c in curves]),
    ]


def curve_columns(report: FragilityReport) -> list[Column]:
    """The curves, one row a point of each."""
    rows = [(c, place) for c in report.curves for place in range(len(c.grid))]
    curves = [c for c, _ in rows]
    return [
        *key_columns(report.series_keys, [c.values for c in curves]),
        Column("limit", "-", [quoted(c.limit.label) for c in curves]),
        Column(report.intensity.measure, report.intensity.unit, [c.grid[i] for c, i in rows]),
        Column("probability", "-", [c.fit.curve[i] for c, i in rows]),
        Column("low", "-", [c.fit.band[0][i] for c, i in rows]),
        Column("high", "-", [c.fit.band[1][i] for c, i in rows]),
    ]


def fragility_figure(report: FragilityReport, title: str) -> bytes:
    """One panel a limit state; markers are observed shares, shades the bootstrap bands."""
    panels = [[c for c in report.curves if c.limit == limit] for limit in report.limits]
    count = len(panels[0]) if panels else 0
    place_of = {c.values: place for place, c in enumerate(panels[0])} if panels else {}

    def shade(place: int) -> str:
        return colour(place, count)

    def draw(axes: Axes, curves: list[Fragility]) -> None:
        for curve in curves:
            place = place_of[curve.values]
            dashes = "--" if curve.fit.method == "penalised" else "-"
            axes.plot(
                curve.grid, curve.fit.curve, dashes, color=shade(place), lw=1.4,
                label=labels(report.series_keys, curve.values) or None,
            )  # fmt: skip
            if len(curves) <= MOST_BANDS:
                axes.fill_between(curve.grid, *curve.fit.band, color=shade(place), alpha=0.15, lw=0)
            axes.plot(
                curve.observed.intensity, curve.observed.share, ls="", color=shade(place),
                marker=marker(place), ms=3.2, alpha=0.8,
            )  # fmt: skip
        axes.set_ylim(-0.02, 1.02)
        axes.set_xlim(left=0.0, auto=True)

    notes = [f"bands: {report.confidence:.0%}"]
    if any(c.fit.method == "penalised" for c in report.curves):
        notes.append("dashed: separated data, penalised fit")
    notes.append(left_out(sum(c.failed for c in panels[0]) if panels else 0))
    return panel_figure(
        Layout([limit.label for limit in report.limits], _side_by_side(len(panels))),
        panels,
        draw,
        title=title,
        x_label=f"{measure_name(report.intensity)} [{report.intensity.unit}]",
        y_label="probability of exceeding",
        note="; ".join(filter(None, notes)),
    )


def _side_by_side(panels: int) -> int:
    return 2 if panels == 4 else max(1, min(3, panels))


def measure_name(intensity: Intensity) -> str:
    """The measure with its period."""
    if intensity.measure != "Sa":
        return intensity.measure
    return "Sa(T1)" if intensity.period is None else f"Sa({intensity.period:g} s)"


REPORT = Report(
    options=FragilityOptions,
    numbers=lambda study, options: fragility_report(study.table, study.intensity(options), options),
    tables={"": fragility_columns, "_curves": curve_columns},
    figure=fragility_figure,
    notes=lambda report: report.notes,
    results=lambda options: [limit.result for limit in limit_states(options)],
)
