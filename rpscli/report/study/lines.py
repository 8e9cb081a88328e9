"""Lines of results against varied keys, or of one list of results against another."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from rpscli.analyses.result_quantities import ResultQuantity
from rpscli.report.figures import style
from rpscli.report.study.labels import key_columns, labels, plain, symbol
from rpscli.report.study.panels import by_values, colour, left_out, over, panel_figure, remarks
from rpscli.report.study.report import Report
from rpscli.report.study.statistics import reached
from rpscli.report.table import Column
from rpscli.sweep.evaluation.results import KNOWN, quantity
from rpscli.sweep.intensities import unit_of
from rpscli.sweep.reports.lines import (
    Line,
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
    """One row a point of each line; ``inf`` where a fractile overturned."""
    rows = [
        (panel, line, place)
        for panel in report.panels
        for line in panel.lines
        for place in range(len(line.x))
    ]
    x_name = report.x_name
    columns = [
        *key_columns(report.panel_keys, [panel.values for panel, *_ in rows]),
        *key_columns(report.series_keys, [line.values for _, line, _ in rows]),
        Column("result", "-", [line.result for _, line, _ in rows]),
        Column("unit", "-", [_unit(line.result) for _, line, _ in rows]),
        Column(x_name, _unit(x_name), [line.x[place] for _, line, place in rows]),
        Column("value", _common_unit(report), [reached(line.y[i]) for _, line, i in rows]),
    ]
    if report.statistic:
        columns.append(Column("statistic", "-", [report.statistic] * len(rows)))
        columns.append(Column("counted", "-", [line.counted[i] for _, line, i in rows]))
        columns.append(Column("overturned", "-", [line.overturned[i] for _, line, i in rows]))
    return columns


def lines_figure(report: LinesReport, title: str) -> bytes:
    """One line a series and result; dashed ones are comparisons."""
    options = report.options
    series = list(dict.fromkeys(line.values for p in report.panels for line in p.lines))
    count = max(len(series), len(report.results))
    solid = [name for name in report.results if name not in options.dashed]
    words = [LEGEND.get(name, name) for name in _distinct(report.results)]
    names = dict(zip(report.results, words, strict=True))

    def draw(axes: Axes, panel: LinesPanel) -> None:
        among = _coincident(panel.lines)
        for line in panel.lines:
            place = series.index(line.values)
            if len(series) == 1:
                place = report.results.index(line.result)
            x, words = _abscissae(line.x)
            pair = (line.y, x) if options.upright else (x, line.y)
            parts = (labels(report.series_keys, line.values), names[line.result])
            axes.plot(
                *pair, lw=1.4,
                ls=_staggered(place, among) if line.dashed else _dashes(line.result, solid),
                color=colour(place, count),
                marker="o" if len(x) < 25 and not line.dashed else "", ms=3.0,
                label=", ".join(filter(None, parts)) or None,
            )  # fmt: skip
            if not options.upright:
                _say_what_is_left_out(axes, line, x, statistic=report.statistic)
            if words:
                (axes.set_yticks if options.upright else axes.set_xticks)(x, words)

    y_label = options.y_label or _axis(report.results[0])
    y_label = ", ".join(filter(None, (y_label, report.statistic)))
    axis_labels = (options.x_label or _axis(report.x_name), y_label)
    return panel_figure(
        by_values(report.panel_keys, report.panels),
        report.panels,
        draw,
        title=title,
        x_label=axis_labels[options.upright],
        y_label=axis_labels[not options.upright],
        note=remarks(over(report.pooled), _beyond(report), left_out(report.failed)),
    )


def _beyond(report: LinesReport) -> str:
    """Fractiles are larger than any demand where so many overturned."""
    lines = [line for panel in report.panels for line in panel.lines]
    unbounded = any(y == float("inf") for line in lines for y in line.y)
    return f"not drawn where the {report.statistic} overturned" if unbounded else ""


def _say_what_is_left_out(axes: Axes, line: Line, x: list[float], *, statistic: str) -> None:
    """Both counts beside every mean that leaves overturned histories out."""
    if statistic != "mean of survivors":
        return
    axes.margins(y=0.12)
    for at, y, counted, overturned in zip(x, line.y, line.counted, line.overturned, strict=True):
        if overturned:
            axes.annotate(
                f"{counted} of {counted + overturned}", (at, y), (0.0, 4.0), ha="center",
                fontsize=0.8 * style.small(), textcoords="offset points", color=style.GREY,
            )  # fmt: skip


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


def _dashes(result: str, solid: list[str]) -> str:
    """Each solid result has its own line."""
    return ("-", "-.", ":")[solid.index(result) % 3]


def _staggered(place: int, among: int) -> str | tuple[int, tuple[int, int]]:
    """Dashes that show each of so many series, up to three, that lie on each other.

    >>> _staggered(0, 1), _staggered(1, 3)
    ('--', (2, (2, 4)))
    """
    return (2 * place, (2, 2 * min(among, 3) - 2)) if among > 1 else "--"


def _coincident(lines: Iterable[Line]) -> int:
    """How many dashed lines lie on each other, if all of them do; else 1."""
    paths = [tuple(plain(y) for y in line.y) for line in lines if line.dashed]
    return len(paths) if len(set(paths)) == 1 else 1


def _axis(name: str) -> str:
    """Label of an axis: that of the result, or the varied key with its unit."""
    found = _quantity(name)
    return found.axis_label if found else f"{symbol(name)} [{unit_of(name)}]"


def _quantity(name: str) -> ResultQuantity | None:
    return next(filter(None, (quantity(analysis, name) for analysis in KNOWN)), None)


def _unit(name: str) -> str:
    found = _quantity(name)
    return (found.unit or "-") if found else unit_of(name)


def _common_unit(report: LinesReport) -> str:
    """That of all results, or SI where they differ."""
    units = {_unit(name) for name in report.results}
    return units.pop() if len(units) == 1 else "SI"


REPORT = Report(
    options=LinesOptions,
    numbers=lambda study, options: lines_report(study.table, study.stored(), options),
    tables={"": lines_columns},
    figure=lines_figure,
    notes=lambda report: report.notes,
    check=unknown_results,
    results=lambda options: (*options.y, *options.dashed),
    analyses=("timehistory", "modal", "pushover"),
)
