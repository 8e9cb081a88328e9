"""Any result against a varied key, or one list of results against another."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from pydantic import AliasChoices, Field, StrictBool

from rpscli.analyses.result_quantities import ResultQuantity
from rpscli.case.schema.fields import Text
from rpscli.case.study.reports import ReportOptions, ReportRequest, VariedKeys
from rpscli.case.study.schema import AnyKeys, Axis, Keys
from rpscli.case.text.document import Document, Fault, Path, dotted
from rpscli.errors import hint
from rpscli.report.figures import style
from rpscli.report.study import panels
from rpscli.report.study.labels import keyed, labels, plain, symbol
from rpscli.report.study.report import Found, Report, Statistic
from rpscli.report.study.statistics import reached
from rpscli.report.table import LARGE_UNITS
from rpscli.sweep.evaluation import KNOWN, quantity
from rpscli.sweep.statistics import grouping as of_groups
from rpscli.sweep.statistics.grouping import Histories, shown_keys, statistic_words
from rpscli.sweep.table import StudyResults, unit_of
from rpscli.units import in_si

LEGEND = {"frequency_parameter": "model", "frequency_parameter_rigid": "rigid estimate"}
"""Names of results that are compared in one figure, where the last word says too much."""

MEAN = statistic_words("mean")
MOST_NAMED = 2  # results whose names stand on the axis; the legend has those of more

Values = dict[str, list[Any]]  # some results of all points, by name; None where a point has none


class LinesOptions(ReportOptions):
    """Any result against a varied key, or one list of results against another."""

    x: Text = Field(description="a varied key, or a result that is a list")
    result: Keys = Field(
        description="one result or several, such as rolling.frequency_ratio.0",
        validation_alias=AliasChoices("result", "y"),
    )
    dashed: AnyKeys = Field((), description="results drawn dashed, as a comparison")
    series: VariedKeys | None = Field(None, description="varied keys, one line for each value")
    panels: VariedKeys | None = Field(None, description="varied keys, one panel for each value")
    statistic: Statistic = Field(
        "mean",
        description="of points with one abscissa: the mean of survivors; or, with overturned"
        " histories as larger than any demand, the median, the largest, or a fractile as 0.84",
    )
    upright: StrictBool = Field(default=False, description="draw x upwards, as floors are")
    x_label: Text | None = Field(None, description="in place of the name of x")
    y_label: Text | None = Field(None, description="in place of the names of the results")


class Line(NamedTuple):
    """One line: a result of the points of one series."""

    values: tuple[object, ...]
    result: str
    x: tuple[Any, ...]  # numbers, or words if the varied key has any
    y: tuple[float, ...]
    counted: tuple[int, ...] = ()  # of the points that share an abscissa, those that stood
    overturned: tuple[int, ...] = ()


class Panel(NamedTuple):
    """Lines of one group of systems."""

    values: tuple[object, ...]
    lines: list[Line]


def lines(study: StudyResults, options: LinesOptions) -> Found:
    """The lines of every series of every panel; a statistic where points share an abscissa."""
    layout, together = study.table.layout, of_groups.axis_keys(study.table.layout, options.x)
    panel_keys, series = options.panels or (), options.series
    if series is None:
        series = of_groups.own_keys(layout, (*panel_keys, *together))
    names = (*options.result, *options.dashed)
    found = of_groups.grouping(study.table, panel_keys, (*series, options.x))
    values = _collected(study, names if together else (*names, options.x))
    shown = []
    for group in found.groups:
        parts = itertools.product(names, group.parts(series))
        of_group = [line for name, part in parts for line in _lines(values, options, part, name)]
        shown.append(Panel(group.values, of_group))
    every = [line for panel in shown for line in panel.lines]
    single = all(c + o < 2 for x in every for c, o in zip(x.counted, x.overturned, strict=True))
    statistic = "" if single else statistic_words(options.statistic)
    x_name, series_keys = shown_keys(layout, (options.x,))[0], shown_keys(layout, series)
    rows = [
        (
            (*panel.values, *line.values), line.result, _unit(line.result), line.x[i],
            reached(line.y[i]), *(statistic and (statistic, line.counted[i], line.overturned[i])),
        )
        for panel in shown
        for line in panel.lines
        for i in range(len(line.x))
    ]  # fmt: skip
    units = {_unit(name) for name in names}
    heads = {
        "result": "-", "unit": "-", x_name: _unit(x_name),
        "value": units.pop() if len(units) == 1 else "SI",
    }  # fmt: skip
    if statistic:
        heads |= {"statistic": "-", "counted": "-", "overturned": "-"}
    notes = [*found.notes] if together else []
    if statistic == MEAN and (fallen := _left_out_of_means(shown)):
        notes.append(fallen)

    y_label = ", ".join(filter(None, (options.y_label or _together(names), statistic)))
    both = (options.x_label or _axis(x_name), y_label)
    unbounded = any(math.inf in line.y for line in every)
    hollow = statistic == MEAN and any(any(line.overturned) for line in every)
    note = panels.remarks(
        panels.over(found.pooled) if together else "",
        "hollow: means without those that overturned, counts in the CSV" * hollow,
        panels.shaded(max(len({line.values for line in every}), len(names))),
        f"not drawn where the {statistic} overturned" if unbounded else "",
        panels.left_out(found.failed),
    )

    def draw(axes: style.Axes, panel: Panel) -> None:
        _draw(axes, panel, every, options, series_keys, statistic)

    x, y = reversed(both) if options.upright else both
    return Found(
        {"": keyed((*found.keys, *series_keys), heads, rows)},
        panels.in_panels(found.keys, shown, draw, x_label=x, y_label=y, note=note),
        notes,
    )


def _left_out_of_means(shown: Sequence[Panel]) -> str:
    """The note on the histories that all means leave out."""
    first = {repr((p.values, line.values)): line for p in shown for line in reversed(p.lines)}
    overturned = sum(sum(line.overturned) for line in first.values())
    of = overturned + sum(sum(line.counted) for line in first.values())
    if not overturned:
        return ""
    return (
        f"means are those of survivors: {overturned} of {of} histories overturned and"
        " are left out; `statistic: median` counts them"
    )


def _collected(study: StudyResults, names: Iterable[str]) -> Values:
    """Results of all points: numbers, lists, or None."""
    wanted = tuple(names)
    columns, analysis = study.stored(wanted).columns, study.table.layout.plan.analysis
    values: Values = {}
    for name in wanted:
        column, of = columns.get(name), quantity(analysis, name)
        rows = [None] * len(study.table) if column is None else column.tolist()
        values[name] = [_value(row, whole=of is not None and of.whole) for row in rows]
    return values


def _value(value: Any, *, whole: bool) -> Any:
    """A number, a list without what is NaN behind its end, or None."""
    if isinstance(value, list):
        found = [_value(item, whole=whole) for item in value]
        while found and found[-1] is None:
            found.pop()
        return found or None
    if value is None or math.isnan(value):
        return None
    return int(value) if whole else value


def _lines(values: Values, options: LinesOptions, series: Histories, name: str) -> list[Line]:
    """Lines of one result of one series: one, or one for each point if results are lists."""
    if options.x in values:
        usable = [n for n in series.every.tolist() if values[name][n] is not None]
        curves = [(values[options.x][n], values[name][n]) for n in usable]
        whole = [c for c in curves if isinstance(c[0], list) and isinstance(c[1], list)]
        if whole:
            return [Line(series.values, name, tuple(x), tuple(y)) for x, y in whole]
        pairs = sorted(c for c in curves if c[0] is not None)
        return [Line(series.values, name, *zip(*pairs, strict=True))] if pairs else []
    numbers = np.array([v if isinstance(v, int | float) else np.nan for v in values[name]])
    at = []
    for group in series.parts([options.x]):
        found = group.statistic(numbers, options.statistic)
        if not math.isnan(found):
            known = int((~np.isnan(numbers[group.survivors])).sum())
            x = in_si(group.values[0], unit_of(options.x))
            at.append((x, found, known, group.overturned.number))
    return [Line(series.values, name, *zip(*at, strict=True))] if at else []


def _draw(
    axes: style.Axes,
    panel: Panel,
    every: Sequence[Line],
    options: LinesOptions,
    series_keys: Sequence[str],
    statistic: str,
) -> None:
    """One line a series and result; dashed ones are comparisons."""
    results = (*options.result, *options.dashed)
    series = list(dict.fromkeys(line.values for line in every))
    words = (LEGEND.get(name, name) for name in _distinct(results))
    names = dict(zip(results, words, strict=True))
    dashed = [line for line in panel.lines if line.result in options.dashed]
    paths = {tuple(plain(y) for y in line.y) for line in dashed}
    among, count = len(dashed) if len(paths) == 1 else 1, max(len(series), len(results))
    of_x, of_y = (axes.yaxis, axes.xaxis) if options.upright else (axes.xaxis, axes.yaxis)
    panels.large_axis(of_x, _unit(options.x))
    panels.large_axis(of_y, _unit(results[0]))
    for line in panel.lines:
        place = series.index(line.values)
        if len(series) == 1:
            place = results.index(line.result)
        x, words_at = list(map(float, range(len(line.x)))), [plain(value) for value in line.x]
        if all(isinstance(value, int | float) for value in line.x):  # else each word has a place
            x, words_at = [float(str(value)) for value in line.x], []
        pair = (line.y, x) if options.upright else (x, line.y)
        parts = (labels(series_keys, line.values), names[line.result])
        look: dict[str, Any] = {"ls": _staggered(place, among)}
        if line.result not in options.dashed:
            look = {"ls": ("-", "-.", ":")[options.result.index(line.result) % 3]}
            look["marker"] = "o" if len(x) < 25 else ""
        name, shade = ", ".join(filter(None, parts)) or None, panels.colour(place, count)
        axes.plot(*pair, lw=1.4, color=shade, ms=3.0, label=name, **look)
        if statistic == MEAN:
            fallen = [n for n, overturned in enumerate(line.overturned) if overturned]
            at = [[values[n] for n in fallen] for values in pair]
            axes.plot(*at, "o", color="white", mec=shade, ms=4.5, zorder=3.0)
        if words_at:
            (axes.set_yticks if options.upright else axes.set_xticks)(x, words_at)


def _distinct(results: tuple[str, ...]) -> list[str]:
    """Names without what they have in common at both ends; empty for a single one."""
    parts = [name.split(".") for name in results]
    for end in (0, -1):
        while all(parts) and len({names[end] for names in parts}) == 1:
            parts = [names[1:] if end == 0 else names[:-1] for names in parts]
    return [".".join(names) for names in parts]


def _staggered(place: int, among: int) -> str | tuple[int, tuple[int, int]]:
    """Dashes that show each of so many series, up to three, that lie on each other."""
    return (2 * place, (2, 2 * min(among, 3) - 2)) if among > 1 else "--"


def _together(names: Sequence[str]) -> str:
    """Label of the axis of one or two kinds of result, or of values that a legend tells apart."""
    labels, units = [{*map(of, names)} for of in (_axis, _unit)]
    if len(labels) <= MOST_NAMED:
        return ", ".join(dict.fromkeys(map(_axis, names)))
    (unit,) = units if len(units) == 1 else ("SI units",)
    return f"value [{LARGE_UNITS.get(unit, (unit,))[0]}]"


def _axis(name: str) -> str:
    """Label of an axis: that of the result, or the varied key with its unit."""
    found = _quantity(name)
    return panels.large_label(found) if found else f"{symbol(name)} [{unit_of(name)}]"


def _quantity(name: str) -> ResultQuantity | None:
    return next(filter(None, (quantity(analysis, name) for analysis in KNOWN)), None)


def _unit(name: str) -> str:
    found = _quantity(name)
    return (found.unit or "-") if found else unit_of(name)


def unknown_results(
    document: Document, axes: Sequence[Axis], request: ReportRequest
) -> Iterator[Fault]:
    """Results that the analysis does not have."""
    options, analysis = request.options, document.content.get("analysis", "timehistory")
    assert isinstance(options, LinesOptions), "requests have the options of their kind"
    varied = {key for axis in axes for key in axis.keys} | {"record", "scale"}
    named = [("x", options.x)] if options.x not in varied else []
    named += [("result", name) for name in options.result]
    named += [("dashed", name) for name in options.dashed]
    for option, name in named:
        if quantity(analysis, name) is None:
            path: Path = (*request.path, request.kind, option)
            meant = hint(name, KNOWN[analysis], f"`rps {analysis} CASE --json` has all names")
            text = f"{dotted(path)} = {name} is not a result of {analysis}"
            yield Fault(path, f"{text}{' and does not vary' * (option == 'x')}; {meant}")


REPORT = Report(
    LinesOptions,
    lines,
    check=unknown_results,
    results=lambda options: (*options.result, *options.dashed),
    analyses=("timehistory", "modal", "pushover"),
)
