"""A study beside what was observed: counts, fragilities, maxima, and every pair."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from rpscli.analyses.result_quantities import LIMITED
from rpscli.case.study.observed import OVERTURNED
from rpscli.report.figures import style
from rpscli.report.study.fragility import measure_name
from rpscli.report.study.labels import key_columns, labels
from rpscli.report.study.panels import log_ticks
from rpscli.report.study.report import Report
from rpscli.report.table import Column
from rpscli.sweep.reports.comparison import (
    FITTED,
    Compared,
    ComparisonOptions,
    ComparisonReport,
    Curve,
    Outcomes,
    comparison_report,
    fit_faults,
    uncomparable,
)
from rpscli.sweep.statistics.agreement import Agreement, Maxima
from rpscli.sweep.statistics.fractiles import CONFIDENCE

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MOST_ROWS = 8
"""Systems in one figure; the CSV has them all."""

QUANTITIES = {quantity.name: quantity for quantity in LIMITED}

MODEL = "model"

Row = tuple[Compared, str, str, float | None, Agreement]


def agreement_columns(report: ComparisonReport) -> list[Column]:
    """Outcomes: one row a system, part and way to tell them, the model or a threshold."""
    rows: list[Row] = []
    for each in report.compared:
        if isinstance(each.found, Outcomes):
            rows.append((each, MODEL, "-", None, each.found.agreement))
            rows += [
                (each, f"threshold of {found.measure}", found.unit, found.value, found.agreement)
                for found in each.found.thresholds
            ]
    counts = [row[4] for row in rows]
    agreed = [found.agreed for found in counts]
    return [
        *_named(report, [row[0] for row in rows]),
        Column("told_by", "-", [row[1] for row in rows]),
        Column("threshold", "SI", [row[3] for row in rows]),
        Column("counted", "-", [found.counted for found in counts]),
        Column("agreed", "-", [found.number for found in agreed]),
        Column("agreed_share", "-", [found.fraction for found in agreed]),
        Column("agreed_low", "-", [found.low for found in agreed]),
        Column("agreed_high", "-", [found.high for found in agreed]),
        Column("overturned_observed", "-", [found.observed for found in counts]),
        Column("overturned_computed", "-", [found.computed for found in counts]),
        Column("both", "-", [found.both for found in counts]),
        Column("computed_only", "-", [found.computed_only for found in counts]),
        Column("observed_only", "-", [found.observed_only for found in counts]),
        Column("neither", "-", [found.neither for found in counts]),
        Column("failed", "-", [row[0].failed for row in rows]),
    ]


def _named(report: ComparisonReport, rows: Sequence[Compared]) -> list[Column]:
    """Columns that say of what a row is."""
    return [
        *key_columns(report.system_keys, [row.values for row in rows]),
        *key_columns(report.fit_keys, [row.chosen for row in rows]),
        Column("records", "-", [row.part for row in rows]),
    ]


def fragility_columns(report: ComparisonReport) -> list[Column]:
    """Both fragilities of every system and part."""
    rows = [
        (each, source, curve.fit)
        for each in report.compared
        if isinstance(each.found, Outcomes)
        for source, curve in _curves(each.found)
    ]
    fits = [row[2] for row in rows]
    unit = report.intensity.unit
    return [
        *_named(report, [row[0] for row in rows]),
        Column("of", "-", [row[1] for row in rows]),
        Column("intensity", "-", [report.intensity.measure] * len(rows)),
        Column("method", "-", [fit.method for fit in fits]),
        Column("median", unit, [fit.median for fit in fits]),
        Column("median_low", unit, [fit.median_band[0] for fit in fits]),
        Column("median_high", unit, [fit.median_band[1] for fit in fits]),
        Column("beta", "-", [fit.beta for fit in fits]),
        Column("beta_low", "-", [fit.beta_band[0] for fit in fits]),
        Column("beta_high", "-", [fit.beta_band[1] for fit in fits]),
        Column("note", "-", [fit.note for fit in fits]),
    ]


def _curves(found: Outcomes) -> tuple[tuple[str, Curve], ...]:
    return (("observed", found.observed), ("computed", found.computed))


def maxima_columns(report: ComparisonReport) -> list[Column]:
    """Computed over observed maxima: one row a system, part and quantity."""
    rows = [(each, each.found) for each in report.compared if isinstance(each.found, Maxima)]
    found = [row[1] for row in rows]
    return [
        *_named(report, [row[0] for row in rows]),
        Column("quantity", "-", [row[0].quantity for row in rows]),
        Column("counted", "-", [each.counted for each in found]),
        Column("overturned_computed", "-", [each.overturned for each in found]),
        Column("median_ratio", "-", [each.median for each in found]),
        Column("dispersion", "-", [each.dispersion for each in found]),
        Column("kolmogorov_smirnov", "-", [each.distance for each in found]),
        Column("failed", "-", [row[0].failed for row in rows]),
    ]


def pair_columns(report: ComparisonReport) -> list[Column]:
    """Every pair: hits and misses by record."""
    rows = [
        (each, report.quantities.index(each.quantity), int(place))
        for each in report.compared
        for place in each.pairs
    ]
    points = [int(report.pairs.points[place]) for _, _, place in rows]
    computed = [float(report.computed[quantity, place]) for _, quantity, place in rows]
    observed = [float(report.pairs.values[quantity, place]) for _, quantity, place in rows]
    requests = [report.table.layout[point].record for point in points]
    return [
        *_named(report, [row[0] for row in rows]),
        Column("record", "-", [request.source for request in requests if request]),
        Column("point", "-", [point + 1 for point in points]),
        Column(
            report.intensity.measure,
            report.intensity.unit,
            [float(report.intensity.values[point]) for point in points],
        ),
        Column("quantity", "-", [row[0].quantity for row in rows]),
        Column("observed", "SI", observed),
        Column("computed", "SI", ["inf" if value == np.inf else value for value in computed]),
        Column("told", "-", list(map(_told, rows, observed, computed))),
    ]


def _told(row: tuple[Compared, int, int], observed: float, computed: float) -> str | None:
    if row[0].quantity != OVERTURNED:
        return None
    words = {(1, 1): "both", (0, 1): "computed only", (1, 0): "observed only", (0, 0): "neither"}
    return words[int(observed), int(computed)]


def candidate_columns(report: ComparisonReport) -> list[Column]:
    """What every choice of the fitted keys was worth on the records that it was fitted to."""
    rows = report.candidates
    return [
        *key_columns(report.system_keys, [row.values for row in rows]),
        *key_columns(report.fit_keys, [row.chosen for row in rows]),
        Column("misfit", "-", [row.worth.misfit for row in rows]),
        Column("count_off", "-", [row.worth.count_off for row in rows]),
        Column("chosen", "-", [str(row.taken).lower() for row in rows]),
    ]


def comparison_figure(report: ComparisonReport, title: str) -> bytes:
    """One panel a system and quantity, of the records that count: held out, or all."""
    judged = report.judged
    shown = judged[: 2 * MOST_ROWS]
    across = 1 if len(shown) == 1 else 2
    down = -(-len(shown) // across)

    def draw(figure: Figure) -> None:
        notes = [f"records: {judged[0].part}", f"bands: {style.percent(report.confidence)}"]
        if len(judged) > len(shown):
            notes.append(f"the first {len(shown)} of {len(judged)} panels")
        style.heading(figure, title, *notes)
        grid = figure.subplots(down, across, squeeze=False)
        for axes in grid.flat[len(shown) :]:
            axes.set_axis_off()
        for axes, each in zip(grid.flat, shown, strict=False):
            if isinstance(each.found, Outcomes):
                _draw_outcomes(axes, report, each, each.found)
            else:
                _draw_maxima(axes, report, each, each.found)

    return style.picture(draw, 0.6 + 3.1 * down, style.WIDTH if across > 1 else 0.7 * style.WIDTH)


def _heading_of(report: ComparisonReport, each: Compared, line: str) -> str:
    chosen = labels(report.fit_keys, each.chosen)
    system = ", ".join(filter(None, [labels(report.system_keys, each.values), chosen]))
    return f"{system}\n{line}" if system else line


def _draw_outcomes(axes: Axes, report: ComparisonReport, each: Compared, found: Outcomes) -> None:
    """Both fragilities through their data; below and above, the outcomes that differ."""
    for (name, curve), colour, marker in zip(
        _curves(found), (style.BLACK, style.BLUE), "os", strict=True
    ):
        if curve.fitted:
            axes.plot(
                curve.grid, curve.fit.curve, color=colour, lw=1.4, label=name,
                marker=marker, ms=3.2, markevery=[],  # the legend shows both
            )  # fmt: skip
            axes.fill_between(curve.grid, *curve.fit.band, color=colour, alpha=0.15, lw=0)
        axes.plot(
            curve.binned.intensity, curve.binned.share, ls="", marker=marker, ms=3.2, color=colour
        )
    intensity = report.intensity.values[report.pairs.points[each.pairs]]
    quantity = report.quantities.index(each.quantity)
    differ = report.computed[quantity, each.pairs] - report.pairs.values[quantity, each.pairs]
    for sign, height, name in (
        (1.0, 1.05, "above: computed only"),
        (-1.0, -0.05, "below: observed only"),
    ):
        chosen = intensity[differ == sign]
        axes.plot(
            chosen, np.full(len(chosen), height), ls="", marker="|", ms=6, color=style.RED,
            label=f"{name} ({len(chosen)})",
        )  # fmt: skip
    counts = found.agreement
    percent = 100.0 * (counts.agreed.fraction or 0.0)
    line = f"{percent:.1f} % of {counts.counted} agree"
    line += f"; overturned {counts.computed}, observed {counts.observed}"
    axes.set_title(_heading_of(report, each, line), fontsize=style.small())
    axes.set_xscale("log")
    log_ticks(axes.xaxis)
    axes.set_ylim(-0.1, 1.1)
    axes.set_xlabel(style.typeset(f"{measure_name(report.intensity)} [{report.intensity.unit}]"))
    axes.set_ylabel("probability of overturning")
    axes.legend(
        loc="upper left", bbox_to_anchor=(0.0, 0.94), fontsize=0.9 * style.small(), handlelength=1.4
    )


def _draw_maxima(axes: Axes, report: ComparisonReport, each: Compared, found: Maxima) -> None:
    """Computed over observed maxima; overturned histories at the upper edge."""
    quantity = report.quantities.index(each.quantity)
    observed = report.pairs.values[quantity, each.pairs]
    computed = report.computed[quantity, each.pairs]
    drawn = np.isfinite(computed) & (computed > 0.0) & (observed > 0.0)
    axes.plot(observed[drawn], computed[drawn], ls="", marker="o", ms=3.2, color=style.BLUE)
    if drawn.any():
        span = [
            float(min(observed[drawn].min(), computed[drawn].min())),
            float(max(observed[drawn].max(), computed[drawn].max())),
        ]
        axes.plot(span, span, color=style.GREY, lw=0.8)
        fallen = observed[np.isinf(computed) & (observed > 0.0)]
        axes.plot(
            fallen, np.full(len(fallen), 1.3 * span[1]), ls="", marker="^", ms=4, color=style.RED
        )
    line = (
        f"ratio {found.median:.2f} in the median, dispersion {found.dispersion:.2f},"
        f" n = {found.counted}"
    )
    if found.overturned:
        line += f"\n{found.overturned} overturned (triangles)"
    axes.set_title(_heading_of(report, each, line), fontsize=style.small())
    axes.set_xscale("log")
    axes.set_yscale("log")
    name = QUANTITIES[each.quantity].axis_label
    axes.set_xlabel(f"observed {name}")
    axes.set_ylabel(f"computed {name}")


def findings(report: ComparisonReport) -> list[tuple[str, str]]:
    """The agreement in lines for the terminal."""
    lines = []
    for each in report.compared:
        chosen = labels(report.fit_keys, each.chosen) if each.part == FITTED else ""
        system = ", ".join(filter(None, [labels(report.system_keys, each.values), chosen]))
        head = ", ".join(filter(None, [system, f"{each.part} records"]))
        lines.append((head, _sentence(each)))
        if isinstance(each.found, Outcomes):
            lines += [
                (f"  {way.measure} >= {way.value:.4g} {way.unit}", _counts(way.agreement))
                for way in each.found.thresholds
            ]
    return lines


def _sentence(each: Compared) -> str:
    found = each.found
    if isinstance(found, Outcomes):
        return _counts(found.agreement)
    return (
        f"{each.quantity}: ratio {found.median:.3g} in the median, dispersion"
        f" {found.dispersion:.3g}, Kolmogorov-Smirnov {found.distance:.3g}, n = {found.counted},"
        f" {found.overturned} overturned"
    )


def _counts(counts: Agreement) -> str:
    agreed = counts.agreed
    percent = "-" if agreed.fraction is None else f"{100.0 * agreed.fraction:.1f} %"
    return (
        f"{percent} agree, {agreed.number} of {agreed.of} ({100.0 * CONFIDENCE:g} %:"
        f" {agreed.interval}); overturned: {counts.computed} computed, {counts.observed} observed"
    )


REPORT = Report(
    options=ComparisonOptions,
    numbers=comparison_report,
    tables={
        "": agreement_columns,
        "_fragility": fragility_columns,
        "_maxima": maxima_columns,
        "_pairs": pair_columns,
        "_fit": candidate_columns,
    },
    figure=comparison_figure,
    drawable=lambda report: bool(report.judged),
    notes=lambda report: report.notes,
    findings=findings,
    check=fit_faults,
    requires=uncomparable,
)
