"""A study beside what was observed: counts, fragilities, maxima, and every pair."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from rpscli.analyses.result_quantities import LIMITED
from rpscli.case.study.observed import OVERTURNED
from rpscli.report.figures import style
from rpscli.report.study.comparison_numbers import (
    FITTED,
    Compared,
    Comparison,
    ComparisonOptions,
    Curve,
    Outcomes,
    fit_faults,
    uncomparable,
)
from rpscli.report.study.fragility import band_words, draw_fit, fit_cells, fit_units, measure_name
from rpscli.report.study.labels import keyed, labels
from rpscli.report.study.panels import log_ticks
from rpscli.report.study.report import Found, Report
from rpscli.report.study.statistics import reached
from rpscli.report.table import Column
from rpscli.sweep.statistics.observations import Agreement, Maxima
from rpscli.sweep.study_results import StudyResults

MOST_ROWS = 8
"""Systems in one figure; the CSV has them all."""

QUANTITIES = {quantity.name: quantity for quantity in LIMITED}

TOLD = {(1, 1): "both", (0, 1): "computed only", (1, 0): "observed only", (0, 0): "neither"}
"""Words for observed and computed overturning."""


def comparison(study: StudyResults, options: ComparisonOptions) -> Found:
    """Compare every system, or the best one of each group, with its observations."""
    report = Comparison(study, options)
    return Found(
        comparison_tables(report),
        (lambda title: comparison_figure(report, title)) if report.judged else None,
        list(report.notes),
        findings(report),
    )


def comparison_tables(report: Comparison) -> dict[str, list[Column]]:
    """Outcomes, fragilities, maxima, every pair, and what choices of the fit were worth."""
    measured = report.intensity
    told = (
        "counted", "agreed", "agreed_share", "agreed_low", "agreed_high", "overturned_observed",
        "overturned_computed", "both", "computed_only", "observed_only", "neither", "failed",
    )  # fmt: skip
    agreements = [
        (each, by, value, *_agreement_cells(counts), each.failed)
        for each in report.compared
        if isinstance(each.found, Outcomes)
        for by, value, counts in _ways(each.found)
    ]
    fits = [
        (each, source, measured.name, *fit_cells(curve.fit), curve.fit.note)
        for each in report.compared
        if isinstance(each.found, Outcomes)
        for source, curve in _curves(each.found)
    ]
    ratios = ("counted", "overturned_computed", "median_ratio", "dispersion", "kolmogorov_smirnov")
    rows_of_maxima = [
        (each, each.quantity, found.counted, found.overturned, found.median, found.dispersion,
         found.distance, each.failed)
        for each in report.compared
        if isinstance(found := each.found, Maxima)
    ]  # fmt: skip
    pair_heads = {
        "record": "-", "point": "-", measured.name: measured.unit, "quantity": "-",
        "observed": "SI", "computed": "SI", "told": "-",
    }  # fmt: skip
    chosen = [
        ((*row.values, *row.chosen), row.worth.misfit, row.worth.count_off, str(row.taken).lower())
        for row in report.candidates
        if report.options.fit is not None
    ]
    keys = (*report.systems.keys, *report.chosen_keys)

    def named(heads: Mapping[str, str], rows: Iterable[Sequence[Any]]) -> list[Column]:
        of_part = [((*each.values, *each.chosen), each.part, *cells) for each, *cells in rows]
        return keyed(keys, {"records": "-", **heads}, of_part)

    return {
        "": named({"told_by": "-", "threshold": "SI", **dict.fromkeys(told, "-")}, agreements),
        "_fragility": named(
            {"of": "-", "intensity": "-", **fit_units(measured.unit), "note": "-"}, fits
        ),
        "_maxima": named(dict.fromkeys(("quantity", *ratios, "failed"), "-"), rows_of_maxima),
        "_pairs": named(pair_heads, _pair_rows(report)),
        "_fit": keyed(keys, dict.fromkeys(("misfit", "count_off", "chosen"), "-"), chosen),
    }


def _ways(found: Outcomes) -> Iterator[tuple[str, float | None, Agreement]]:
    """What tells outcomes: the model, and thresholds of measures."""
    yield "model", None, found.agreement
    for way in found.thresholds:
        yield f"threshold of {way.measure}", way.value, way.agreement


def _agreement_cells(counts: Agreement) -> tuple[object, ...]:
    agreed = counts.agreed
    shares = counts.counted, agreed.number, agreed.fraction, agreed.low, agreed.high
    return (*shares, counts.observed, counts.computed, *counts[:4])


def _curves(found: Outcomes) -> tuple[tuple[str, Curve], ...]:
    return (("observed", found.observed), ("computed", found.computed))


def _pair_rows(report: Comparison) -> Iterator[tuple[Any, ...]]:
    """Every pair: hits and misses by record."""
    for each in report.compared:
        values = zip(each.points.tolist(), each.observed, each.computed, strict=True)
        for point, observed, computed in values:
            request = report.study.table.layout[point].record
            assert request is not None, "points of histories have a record"
            told = TOLD[int(observed), int(computed)] if each.quantity == OVERTURNED else None
            yield (
                each, request.source, point + 1, report.intensity.values[point], each.quantity,
                observed, reached(computed), told,
            )  # fmt: skip


def comparison_figure(report: Comparison, title: str) -> bytes:
    """One panel a system and quantity, of the records that count: held out, or all."""
    judged = report.judged
    shown = judged[: 2 * MOST_ROWS]
    across = 1 if len(shown) == 1 else 2
    down = -(-len(shown) // across)

    def draw(figure: style.Figure) -> None:
        found = [each.found for each in shown if isinstance(each.found, Outcomes)]
        fits = [curve.fit for each in found for _, curve in _curves(each)]
        notes = [f"records: {judged[0].part}"]
        notes += [band_words(report.options.confidence, fits)] * bool(fits)
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


def _head(axes: style.Axes, report: Comparison, each: Compared, line: str) -> None:
    system = labels((*report.systems.keys, *report.chosen_keys), (*each.values, *each.chosen))
    axes.set_title(f"{system}\n{line}" if system else line, fontsize=style.small())


def _draw_outcomes(axes: style.Axes, report: Comparison, each: Compared, found: Outcomes) -> None:
    """Both fragilities through their data; below and above, the outcomes that differ."""
    for (name, curve), colour, marker in zip(
        _curves(found), (style.BLACK, style.BLUE), "os", strict=True
    ):
        draw_fit(axes, curve.grid, curve.fit, curve.binned, colour, marker, name)
    intensity, differ = report.intensity.values[each.points], each.computed - each.observed
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
    _head(axes, report, each, line)
    axes.set_xscale("log")
    log_ticks(axes.xaxis)
    axes.set_ylim(-0.1, 1.1)
    axes.set_xlabel(style.typeset(f"{measure_name(report.intensity)} [{report.intensity.unit}]"))
    axes.set_ylabel("probability of overturning")
    axes.legend(
        loc="upper left", bbox_to_anchor=(0.0, 0.94), fontsize=0.9 * style.small(), handlelength=1.4
    )


def _draw_maxima(axes: style.Axes, report: Comparison, each: Compared, found: Maxima) -> None:
    """Computed over observed maxima; overturned histories at the upper edge."""
    observed, computed = each.observed, each.computed
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
    _head(axes, report, each, line)
    axes.set(xscale="log", yscale="log")
    name = QUANTITIES[each.quantity].axis_label
    axes.set(xlabel=f"observed {name}", ylabel=f"computed {name}")


def findings(report: Comparison) -> list[tuple[str, str]]:
    """The agreement in lines for the terminal."""
    lines = []
    for each in report.compared:
        chosen = labels(report.chosen_keys, each.chosen) if each.part == FITTED else ""
        system = ", ".join(filter(None, [labels(report.systems.keys, each.values), chosen]))
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
    outcomes = f"{counts.computed} computed, {counts.observed} observed"
    return f"{percent} agree, {agreed}; overturned: {outcomes}"


REPORT = Report(ComparisonOptions, comparison, check=fit_faults, requires=uncomparable)
