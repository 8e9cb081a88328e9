"""Fragility curves with their bands and the data they go through."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rpscli.case.conditions import LIMITS
from rpscli.report.figures import style
from rpscli.report.study.labels import key_columns, labels
from rpscli.report.study.panels import (
    Layout,
    colour,
    left_out,
    marker,
    over,
    panel_figure,
    remarks,
)
from rpscli.report.study.report import Report
from rpscli.report.study.statistics import share_columns
from rpscli.report.table import Column
from rpscli.sweep.intensities import Intensity, measure_without_period
from rpscli.sweep.reports.fragility import (
    Fragility,
    FragilityOptions,
    FragilityReport,
    LimitState,
    fragility_report,
    limit_states,
)
from rpscli.sweep.statistics.fractiles import share

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
        Column("limit", "-", [c.limit.label for c in curves]),
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
        Column("overturned_among_them", "-", [c.overturned for c in curves]),
        Column("failed", "-", [c.failed for c in curves]),
        Column("note", "-", [c.fit.note for c in curves]),
    ]


def curve_columns(report: FragilityReport) -> list[Column]:
    """The curves, one row a point of each; those that could not be fitted are left out."""
    fitted = [c for c in report.curves if c.fitted]
    rows = [(c, place) for c in fitted for place in range(len(c.grid))]
    curves = [c for c, _ in rows]
    return [
        *key_columns(report.series_keys, [c.values for c in curves]),
        Column("limit", "-", [c.limit.label for c in curves]),
        Column(report.intensity.measure, report.intensity.unit, [c.grid[i] for c, i in rows]),
        Column("probability", "-", [c.fit.curve[i] for c, i in rows]),
        Column("low", "-", [c.fit.band[0][i] for c, i in rows]),
        Column("high", "-", [c.fit.band[1][i] for c, i in rows]),
    ]


def observed_columns(report: FragilityReport) -> list[Column]:
    """The data: one row an intensity of each curve, or a bin of intensities."""
    rows = [(c, place) for c in report.curves for place in range(len(c.observed.intensity))]
    shares = [share(round(c.observed.share[i] * n), n) for c, i in rows for n in [_points(c, i)]]
    return [
        *key_columns(report.series_keys, [c.values for c, _ in rows]),
        Column("limit", "-", [c.limit.label for c, _ in rows]),
        Column(
            report.intensity.measure,
            report.intensity.unit,
            [float(c.observed.intensity[i]) for c, i in rows],
        ),
        Column("counted", "-", [found.of for found in shares]),
        *share_columns("exceeded", shares),
    ]


def _points(curve: Fragility, place: int) -> int:
    return int(curve.observed.points[place])


def fragility_figure(report: FragilityReport, title: str) -> bytes:
    """One panel a limit state; markers are observed shares, shades the bootstrap bands.

    Curves that could not be fitted are not drawn, nor are limit states without any.
    """
    values = list(dict.fromkeys(c.values for c in report.curves))
    place_of, count = {each: place for place, each in enumerate(values)}, len(values)
    limits = [limit for limit in report.limits if report.fitted(limit)]
    panels = [report.fitted(limit) for limit in limits]

    def shade(place: int) -> str:
        return colour(place, count)

    def draw(axes: Axes, curves: list[Fragility]) -> None:
        for curve in curves:
            place = place_of[curve.values]
            dashes = "--" if curve.fit.method == "penalised" else "-"
            axes.plot(
                curve.grid, curve.fit.curve, dashes, color=shade(place), lw=1.4,
                marker=marker(place), ms=3.2, markevery=[],  # the legend shows both
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

    notes = ["markers: observed", f"bands: {style.percent(report.confidence)}"]
    if any(c.fit.method == "penalised" for c in report.curves):
        notes.append("dashed: separated data, penalised fit")
    if any(limit.threshold is not None for limit in limits):
        notes.append("overturning exceeds every limit")
    if missing := sum(not c.fitted for c in report.curves):
        notes.append(f"{missing} of {len(report.curves)} curves without a fit, see CSV")
    notes += [over(report.pooled), left_out(sum(c.failed for c in panels[0]) if panels else 0)]
    return panel_figure(
        Layout([limit_name(limit) for limit in limits], side_by_side(len(panels))),
        panels,
        draw,
        title=title,
        x_label=f"{measure_name(report.intensity)} [{report.intensity.unit}]",
        y_label="probability of exceedance",
        note=remarks(*notes),
    )


def limit_name(limit: LimitState) -> str:
    """The limit state in the words of the results.

    >>> limit_name(LimitState("drift_ratio", 0.002)), limit_name(LimitState("max_lift", 0.1))
    ('drift ratio > 0.002', 'lift of the building > 0.1 m')
    """
    if limit.result not in LIMITS:
        return limit.label
    known = LIMITS[limit.result]
    unit = f" {known.unit}" if known.unit not in {"", "-"} else ""
    return limit.label.replace(limit.result, known.label, 1) + unit


def side_by_side(panels: int) -> int:
    """How many panels of limit states stand in a row."""
    return 2 if panels == 4 else max(1, min(3, panels))


def measure_name(intensity: Intensity) -> str:
    """The measure with its period."""
    if intensity.measure != "Sa":
        return intensity.measure
    return "Sa(T1)" if intensity.period is None else f"Sa({intensity.period:g} s)"


REPORT = Report(
    options=FragilityOptions,
    numbers=lambda study, options: fragility_report(study.table, study.intensity(options), options),
    tables={"": fragility_columns, "_curves": curve_columns, "_observed": observed_columns},
    figure=fragility_figure,
    drawable=lambda report: any(curve.fitted for curve in report.curves),
    notes=lambda report: report.notes,
    requires=measure_without_period,
    results=lambda options: [limit.result for limit in limit_states(options)],
)
