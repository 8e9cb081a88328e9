"""Lines of results against varied keys, or of one list of results against another."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rpscli.case.schema.key_units import unit
from rpscli.report.files.csv_text import Column
from rpscli.report.study.labels import key_columns, labels, plain, quoted, symbol
from rpscli.report.study.panels import by_values, colour, left_out, panel_figure
from rpscli.report.study.report import Report
from rpscli.sweep.evaluation.results import KNOWN, quantity
from rpscli.sweep.reports.lines import (
    LinesOptions,
    LinesPanel,
    LinesReport,
    lines_report,
    unknown_results,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LEGEND = {"frequency_parameter": "model", "frequency_parameter_rigid": "rigid estimate"}
"""Names of results that are compared in one figure, where the last word says too much."""


def lines_columns(report: LinesReport) -> list[Column]:
    """One row a point of each line."""
    rows = [
        (panel, line, x, y)
        for panel in report.panels
        for line in panel.lines
        for x, y in zip(line.x, line.y, strict=True)
    ]
    x_name = report.options.x
    return [
        *key_columns(report.panel_keys, [panel.values for panel, *_ in rows]),
        *key_columns(report.series_keys, [line.values for _, line, *_ in rows]),
        Column("result", "-", [line.result for _, line, *_ in rows]),
        Column(x_name, unit(x_name), [quoted(x) for _, _, x, _ in rows]),
        Column("value", "SI", [y for *_, y in rows]),
    ]


def lines_figure(report: LinesReport, title: str) -> bytes:
    """One line a series and result; dashed ones are comparisons."""
    options = report.options
    series = list(dict.fromkeys(line.values for p in report.panels for line in p.lines))
    count = max(len(series), len(report.results))
    solid = [name for name in report.results if name not in options.dashed]
    words = [LEGEND.get(name, name) for name in _distinct(report.results)]
    names = dict(zip(report.results, words, strict=True))

    def draw(axes: Axes, panel: LinesPanel) -> None:
        for line in panel.lines:
            place = series.index(line.values)
            if len(series) == 1:
                place = report.results.index(line.result)
            x, words = _abscissae(line.x)
            pair = (line.y, x) if options.upright else (x, line.y)
            parts = (labels(report.series_keys, line.values), names[line.result])
            axes.plot(
                *pair, _dashes(line.dashed, line.result, solid), lw=1.4,
                color=colour(place, count),
                marker="o" if len(x) < 25 and not line.dashed else "", ms=3.0,
                label=", ".join(filter(None, parts)) or None,
            )  # fmt: skip
            if words:
                (axes.set_yticks if options.upright else axes.set_xticks)(x, words)

    axis_labels = (options.x_label or _axis(options.x), options.y_label or _axis(report.results[0]))
    return panel_figure(
        by_values(report.panel_keys, report.panels),
        report.panels,
        draw,
        title=title,
        x_label=axis_labels[options.upright],
        y_label=axis_labels[not options.upright],
        note=left_out(report.failed),
    )


def _distinct(results: tuple[str, ...]) -> list[str]:
    """Names without what they have in common at both ends; empty for a single one.

    >>> _distinct(("rolling.frequency_ratio.0", "rocking.frequency_ratio.0"))
    ['rolling', 'rocking']
    """
    parts = [name.split(".") for name in results]
    for end in (0, -1):
        while all(parts) and len({names[end] for names in parts}) == 1:
            parts = [names[1:] if end == 0 else names[:-1] for names in parts]
    return [".".join(names) for names in parts]


def _abscissae(values: tuple[object, ...]) -> tuple[list[float], list[str]]:
    """Places along the axis; words take one place each."""
    if all(isinstance(value, int | float) for value in values):
        return [float(str(value)) for value in values], []
    return [float(i) for i in range(len(values))], [plain(value) for value in values]


def _dashes(dashed: bool, result: str, solid: list[str]) -> str:  # noqa: FBT001 -- of a line
    """Each solid result has its own line; comparisons are dashed."""
    return "--" if dashed else ("-", "-.", ":")[solid.index(result) % 3]


def _axis(name: str) -> str:
    """Label of an axis: that of the result, or the varied key with its unit."""
    found = next(filter(None, (quantity(analysis, name) for analysis in KNOWN)), None)
    return found.axis_label if found else f"{symbol(name)} [{unit(name)}]"


REPORT = Report(
    options=LinesOptions,
    numbers=lambda study, options: lines_report(study.table, study.stored(), options),
    tables={"": lines_columns},
    figure=lines_figure,
    check=unknown_results,
    results=lambda options: (*options.y, *options.dashed),
    analyses=("timehistory", "modal", "pushover"),
)
