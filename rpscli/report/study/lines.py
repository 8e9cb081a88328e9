"""Lines: any result against a varied key, a list against another,
demands against intensity.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from pydantic import AliasChoices, Field

from rpscli.analyses.result_quantities import ResultQuantity
from rpscli.case.schema.fields import Text
from rpscli.case.study.reports import ReportOptions, ReportRequest, VariedKeys
from rpscli.case.study.schema import AnyKeys, Axis, Keys
from rpscli.case.text.document import Document, Fault, Path, dotted
from rpscli.errors import hint, listed
from rpscli.report.figures import style
from rpscli.report.study import panels
from rpscli.report.study.report import (
    DemandName,
    Found,
    Report,
    Statistic,
    keyed,
    reached,
)
from rpscli.report.table import Column
from rpscli.sweep.evaluation import KNOWN, SCALARS, quantity
from rpscli.sweep.names import cell_of, labels, plain, symbol, tick_of, unit_of
from rpscli.sweep.statistics.fractiles import THREE, demand, fractiles
from rpscli.sweep.statistics.grouping import (
    INTENSITY,
    Grouping,
    Histories,
    axis_keys,
    grouping,
    own_keys,
    shown_keys,
    statistic_words,
)
from rpscli.sweep.table import Array, StoredPoints

LEGEND = {"frequency_parameter": "model", "frequency_parameter_rigid": "rigid estimate"}
"""Names of results that are compared in one figure, where the last word says too much."""

MEAN = statistic_words("mean")
MOST_NAMED = 2  # results whose names stand on the axis; the legend has those of more


class LinesOptions(ReportOptions):
    """Any result against a varied key, or one list of results against another."""

    x: Text = Field(description="a varied key, or a result that is a list")
    result: Keys = Field(
        description="one result or several, such as rolling.frequency_ratio.0",
        validation_alias=AliasChoices("result", "y"),
    )
    dashed: AnyKeys = Field((), description="results drawn dashed, as a comparison")
    series: VariedKeys | None = Field(
        None, description="varied keys, one line for each value"
    )
    panels: VariedKeys | None = Field(
        None, description="varied keys, one panel for each value"
    )
    statistic: Statistic = Field(
        "mean",
        description=(
            "of points with one abscissa: the mean of survivors; or, with overturned"
            " histories as larger than any demand, the median, the largest, or a"
            " fractile as 0.84"
        ),
    )


class Line(NamedTuple):
    """One line: a result of the points of one series."""

    values: tuple[object, ...]
    result: str
    x: tuple[Any, ...]  # numbers, or words if the varied key has any
    y: tuple[float, ...]
    stood: tuple[int, ...] = ()  # of the points that share an abscissa
    overturned: tuple[int, ...] = ()

    def counts(self, place: int) -> tuple[int, int, int]:
        """Points behind one ordinate that did not fail; those of them that overturned and
        that stood.
        """
        stood = self.stood[place]
        overturned = self.overturned[place]
        return stood + overturned, overturned, stood


class Panel(NamedTuple):
    """Lines of one group of systems."""

    values: tuple[object, ...]
    lines: list[Line]


class Chart(NamedTuple):
    """The lines of a report, and in words the statistic that they are, if they are one."""

    options: LinesOptions
    panels: list[Panel]
    series: tuple[str, ...]  # keys that tell lines of a result apart
    statistic: str
    x_key: str

    @property
    def results(self) -> tuple[str, ...]:
        """Names of the results, dashed ones last."""
        return (*self.options.result, *self.options.dashed)

    @property
    def every(self) -> list[Line]:
        """The lines of all panels."""
        return [line for panel in self.panels for line in panel.lines]


def lines(study: StoredPoints, options: LinesOptions) -> Found:
    """The lines of every series of every panel; a statistic where
    points share an abscissa.
    """
    layout = study.table.layout
    together = axis_keys(layout, options.x)
    panel_keys = options.panels or ()
    series = options.series
    if series is None:
        series = own_keys(layout, (*panel_keys, *together))
    found = grouping(study.table, panel_keys, (*series, options.x))
    chart = _chart(study, options, found, series)
    notes = [*found.notes] if together else []
    if chart.statistic == MEAN and (fallen := _left_out_of_means(chart.panels)):
        notes.append(fallen)

    x_name = shown_keys(layout, (options.x,))[0]
    pooled = panels.over(found.pooled) if together else ""
    figure = _figure(found, chart, x_name, pooled)
    return Found({"": _columns(found.keys, chart, x_name)}, figure, notes)


def _chart(
    study: StoredPoints, options: LinesOptions, found: Grouping, series: tuple[str, ...]
) -> Chart:
    """The lines of all groups, of points or of the statistic of those that go together."""
    layout = study.table.layout
    names = (*options.result, *options.dashed)
    stored = names if axis_keys(layout, options.x) else (*names, options.x)
    columns = study.stored(stored).columns
    shown = []
    for group in found.groups:
        parts = itertools.product(names, group.parts(series))
        of_group = [
            line for name, part in parts for line in _lines(columns, options, part, name)
        ]
        shown.append(Panel(group.values, of_group))
    single = all(
        c + o < 2
        for panel in shown
        for line in panel.lines
        for c, o in zip(line.stood, line.overturned, strict=True)
    )
    statistic = "" if single else statistic_words(options.statistic)
    (x_key,) = shown_keys(layout, (options.x,))
    return Chart(options, shown, shown_keys(layout, series), statistic, x_key)


def _columns(panel_keys: Sequence[str], chart: Chart, x_name: str) -> list[Column]:
    """One row a point of a line, with what its statistic counts."""
    statistic = chart.statistic
    rows = [
        (
            (*panel.values, *line.values), line.result, _unit(line.result), line.x[i],
            reached(line.y[i]), *(statistic and (statistic, *line.counts(i))),
        )
        for panel in chart.panels
        for line in panel.lines
        for i in range(len(line.x))
    ]  # fmt: skip
    units = {_unit(name) for name in chart.results}
    unit = units.pop() if len(units) == 1 else "SI"
    heads = f"result, unit, {x_name} [{_unit(x_name)}], value [{unit}]"
    heads += ", statistic, counted, overturned, stood" * bool(statistic)
    return keyed((*panel_keys, *chart.series), heads, rows)


def _figure(
    found: Grouping, chart: Chart, x_name: str, pooled: str
) -> Callable[[str], style.Draw]:
    """A figure of all panels; `pooled` is the remark on what differs within one."""
    statistic = chart.statistic
    every = chart.every
    hollow = statistic == MEAN and any(any(line.overturned) for line in every)
    return panels.in_panels(
        found.keys,
        chart.panels,
        partial(_draw, chart=chart),
        x_label=_scale(x_name),
        y_label=_together(chart.results).followed_by(statistic),
        note=panels.remarks(
            pooled,
            "hollow: means without those that overturned, counts in the CSV" * hollow,
            panels.shaded(max(len(_series(every)), len(chart.results))),
            f"not drawn where the {statistic} overturned"
            * any(math.inf in line.y for line in every),
            panels.left_out(found.failed),
        ),
    )


def _left_out_of_means(shown: Sequence[Panel]) -> str:
    """The note on the histories that all means leave out."""
    first = {
        repr((p.values, line.values)): line for p in shown for line in reversed(p.lines)
    }
    overturned = sum(sum(line.overturned) for line in first.values())
    of = overturned + sum(sum(line.stood) for line in first.values())
    if not overturned:
        return ""
    return (
        f"means are those of survivors: {overturned} of {of} histories overturned and"
        " are left out; `statistic: median` counts them"
    )


def _lines(
    columns: Mapping[str, Array], options: LinesOptions, series: Histories, name: str
) -> list[Line]:
    """Lines of one result of one series: one, or one for each
    point if results are lists.
    """
    x = columns.get(options.x)
    y = columns.get(name)
    points: list[list[Any]] = [[]]
    if y is not None and x is not None:
        for n in series.every.tolist():
            pairs = zip(*(np.atleast_1d(of[n]).tolist() for of in (x, y)), strict=True)
            points.append([pair for pair in pairs if not math.isnan(sum(pair))])
        if x.ndim == 1:
            points = [sorted(itertools.chain(*points))]
    elif y is not None and y.ndim == 1:
        for group in series.parts([options.x]):
            found = group.statistic(y, options.statistic)
            if not math.isnan(found):
                known = int((~np.isnan(y[group.survivors])).sum())
                at = cell_of(options.x, *group.values)
                points[0].append((at, found, known, group.overturned.number))
    return [
        Line(series.values, name, *zip(*each, strict=True)) for each in points if each
    ]


def _series(every: Sequence[Line]) -> list[tuple[object, ...]]:
    """Values of each series once; they may be lists or mappings."""
    return [*{repr(line.values): line.values for line in every}.values()]


def _draw(axes: style.Axes, panel: Panel, chart: Chart) -> None:
    """One line a series and result; dashed ones are comparisons."""
    options = chart.options
    results = chart.results
    series = _series(chart.every)
    words = (LEGEND.get(name, name) for name in _distinct(results))
    names = dict(zip(results, words, strict=True))
    dashed = [line for line in panel.lines if line.result in options.dashed]
    paths = {tuple(plain(y) for y in line.y) for line in dashed}
    among = len(dashed) if len(paths) == 1 else 1
    count = max(len(series), len(results))
    for line in panel.lines:
        place = series.index(line.values)
        if len(series) == 1:
            place = results.index(line.result)
        x: Sequence[float] = line.x
        if not all(
            isinstance(value, int | float) for value in line.x
        ):  # each word has a place
            x = range(len(line.x))
            axes.set_xticks(x, [tick_of(chart.x_key, value) for value in line.x])
        parts = (labels(chart.series, line.values), names[line.result])
        name = ", ".join(filter(None, parts)) or None
        shade = panels.colour(place, count)
        look: dict[str, Any] = {"ls": _staggered(place, among), "color": shade}
        if line.result not in options.dashed:
            look = {"ls": ("-", "-.", ":")[options.result.index(line.result) % 3]}
            look |= panels.look(place, count) if len(x) < 25 else {"color": shade}
        axes.plot(x, line.y, lw=1.4, ms=3.0, label=name, **look)
        if chart.statistic == MEAN:
            fallen = [n for n, overturned in enumerate(line.overturned) if overturned]
            at = [[values[n] for n in fallen] for values in (x, line.y)]
            axes.plot(*at, "o", color="white", mec=shade, ms=4.5, zorder=3.0)


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


def _together(names: Sequence[str]) -> panels.Scale:
    """The axis of one or two kinds of result, or of values that a
    legend tells apart; of several units in SI.
    """
    alike = len({*map(_unit, names)}) == 1
    scales = dict.fromkeys(map(_scale if alike else _in_si, names))
    if len(scales) <= MOST_NAMED:
        first, *others = scales
        return first.followed_by(*(each.label for each in others))
    return panels.scale_of("value", _unit(names[0]) if alike else "SI units")


def _scale(name: str) -> panels.Scale:
    """The axis of a result, or of a varied key."""
    if found := _quantity(name):
        return panels.scale_of_result(found)
    return panels.scale_of(symbol(name), unit_of(name))


def _in_si(name: str) -> panels.Scale:
    """The axis of a result in its SI unit, as it stands beside others."""
    found = _quantity(name)
    return panels.Scale(
        found.axis_label if found else f"{symbol(name)} [{unit_of(name)}]"
    )


def _quantity(name: str) -> ResultQuantity | None:
    return next(filter(None, (quantity(analysis, name) for analysis in KNOWN)), None)


def _unit(name: str) -> str:
    found = _quantity(name)
    return (found.unit or "-") if found else unit_of(name)


def unknown_results(
    document: Document, axes: Sequence[Axis], request: ReportRequest
) -> Iterator[Fault]:
    """Results that the analysis does not have."""
    options = request.options
    analysis = document.content.get("analysis", "timehistory")
    assert isinstance(options, LinesOptions), "requests have the options of their kind"
    varied = {key for axis in axes for key in axis.keys} | {"record", "scale"}
    named = [("x", options.x)] if options.x not in varied else []
    named += [("result", name) for name in options.result]
    named += [("dashed", name) for name in options.dashed]
    for option, name in named:
        if quantity(analysis, name) is None:
            path: Path = (*request.path, request.kind, option)
            meant = hint(
                name, KNOWN[analysis], f"`rps {analysis} CASE --json` has all names"
            )
            text = f"{dotted(path)} = {name} is not a result of {analysis}"
            yield Fault(path, f"{text}{' and does not vary' * (option == 'x')}; {meant}")


MOST_CURVES = 200
LINES = ((style.BLUE, ":"), (style.BLUE, "-"), (style.BLUE, "--"))


class IdaOptions(ReportOptions):
    """Incremental dynamic analysis: demand against intensity, with fractiles."""

    result: DemandName = Field(
        "rotation_ratio",
        description="horizontal axis",
        validation_alias=AliasChoices("result", "demand"),
    )
    panels: VariedKeys | None = Field(
        None, description="varied keys, one panel for each value"
    )
    series: VariedKeys = Field(
        (), description="varied keys, median and fractile of each value in one panel"
    )


class Ida(NamedTuple):
    """Demands of one group at ascending intensities, or
    factors; infinite is overturned.
    """

    values: tuple[object, ...]
    levels: list[Histories]
    heights: Array
    curves: (
        Array  # (curves, levels) of each record, sample and member, NaN where it failed
    )
    fractiles: Array  # (3, levels) of the points that did not fail


def ida(study: StoredPoints, options: IdaOptions) -> Found:
    """Curves and fractiles of each system."""
    table = study.table
    apart = options.panels
    if apart is None:
        apart = own_keys(table.layout, (*options.series, INTENSITY))
    series = [key for key in options.series if key not in apart]
    found = grouping(table, (*apart, *series), (INTENSITY,))
    demands = demand(table, table.columns[options.result])
    shown = [_ida_of(group, demands) for group in found.groups]
    (name,) = shown_keys(table.layout, (INTENSITY,))
    of = SCALARS["timehistory"][options.result]
    level_name = f"{name} [{unit_of(name)}]"
    three = [f"{options.result}_{round(100 * share)} [{of.unit}]" for share in THREE]
    heads = f"{level_name}, {', '.join(three)}, counted, overturned, failed"
    rows = [
        (panel.values, at, *spread, len(level), level.overturned.number, level.failed)
        for panel in shown
        for level, at, spread in zip(
            panel.levels, panel.heights.tolist(), panel.fractiles.T.tolist(), strict=True
        )
    ]
    level = panels.scale_of(name, unit_of(name))
    figure = _ida_figure(found, len(apart), shown, of, level)
    return Found({"": keyed(found.keys, heads, rows)}, figure, found.notes)


def _ida_of(group: Histories, demands: Array) -> Ida:
    """Curves and fractiles of one group."""
    levels = sorted(group.parts([INTENSITY]), key=_height)
    curves = np.column_stack([demands[level.every] for level in levels])
    spread = np.column_stack([fractiles(column, THREE) for column in curves.T])
    return Ida(group.values, levels, np.array([*map(_height, levels)]), curves, spread)


class IdaPanel(NamedTuple):
    """Groups of one panel by what tells them apart in it; alone, all of their curves."""

    values: tuple[object, ...]
    groups: dict[str, Ida]  # by their names in the legend


def _ida_figure(
    found: Grouping,
    apart: int,
    shown: Sequence[Ida],
    of: ResultQuantity,
    level: panels.Scale,
) -> Callable[[str], style.Draw]:
    """Groups that differ in the first keys have panels, as far to the right as what
    stood.
    """
    by_panel: dict[str, IdaPanel] = {}
    for each in shown:
        values = each.values[:apart]
        panel = by_panel.setdefault(repr(values), IdaPanel(values, {}))
        panel.groups[labels(found.keys[apart:], each.values[apart:])] = each
    names = [*dict.fromkeys(n for panel in by_panel.values() for n in panel.groups)]
    several = len(names) > 1
    finite = np.concatenate([panel.curves[np.isfinite(panel.curves)] for panel in shown])
    edge = 1.15 * float(finite.max()) if len(finite) else 1.15
    top = 1.04 * max(float(panel.heights.max()) for panel in shown)
    numbers = sorted({str(len(panel.curves)) for panel in shown})
    draw = _draw_medians if several else _draw_ida
    return panels.in_panels(
        found.keys[:apart],
        [*by_panel.values()],
        partial(draw, edge=edge, names=names),
        x_label=panels.scale_of_result(of),
        y_label=level,
        limits=lambda axes: axes.set(xlim=(0.0, 0.97 * edge), ylim=(0.0, top)),
        note=panels.noted(
            found,
            f"fractiles of {listed(numbers)} curves",
            "solid: medians, dashed: 84 % fractiles" * several,
            panels.shaded(len(names)),
            "level to the right: overturned at the next intensity"
            if found.overturned
            else "",
            "back to the left: stronger motions, smaller demands",
        ),
    )


def _draw_medians(
    axes: style.Axes, shown: IdaPanel, edge: float, names: Sequence[str]
) -> None:
    """Median and 84 % fractile of several groups."""
    for name, panel in shown.groups.items():
        levels = np.concatenate([[0.0], panel.heights])
        shade = panels.colour(names.index(name), len(names))
        for fractile, dashes, width in zip(
            panel.fractiles[1:], ("-", "--"), (1.8, 1.0), strict=True
        ):
            line = _run_out(fractile, levels, edge)
            label = name if dashes == "-" else None
            axes.plot(*line, color=shade, ls=dashes, lw=width, label=label)


def _draw_ida(
    axes: style.Axes, shown: IdaPanel, edge: float, names: Sequence[str]
) -> None:
    """Single curves, and fractiles over them."""
    panel = shown.groups[names[0]]
    levels = np.concatenate([[0.0], panel.heights])
    # Evenly through all of them: more would only blacken the panel.
    for curve in panel.curves[:: max(1, len(panel.curves) // MOST_CURVES)]:
        line = _run_out(curve, levels, edge)
        axes.plot(*line, color=style.GREY, lw=0.8, label="single curves")
    for fractile, (colour, dashes), share in zip(
        panel.fractiles, LINES, THREE, strict=True
    ):
        label = "median" if share == 0.5 else f"{style.percent(share)} fractile"
        line = _run_out(fractile, levels, edge)
        axes.plot(*line, color=colour, ls=dashes, lw=1.8, label=label)


def _height(level: Histories) -> float:
    """The factor or the intensity of a level."""
    return float(str(level.values[0]))


def _run_out(
    values: Array, levels: Array, edge: float
) -> tuple[list[float], list[float]]:
    """A curve from the origin to the first level at which it leaves the frame."""
    x = [0.0]
    y = [0.0]
    for value, level in zip(values.tolist(), levels[1:].tolist(), strict=True):
        if np.isinf(value):
            # Flat at the last level that stood: a little more, and it overturns.
            return [*x, edge], [*y, y[-1]]
        if not np.isnan(value):
            x.append(value)
            y.append(level)
    return x, y


def single_intensity(
    document: Document, _axes: Sequence[Axis], request: ReportRequest
) -> Iterator[Fault]:
    """A study without several intensities has no curves."""
    if not isinstance(document.content.get("scale"), dict | list):
        wanted = "several intensities: scale: {measure: PGV, values: [...]}"
        yield Fault(request.path, f"the report {request.kind} needs {wanted}")


REPORT = Report(
    LinesOptions,
    lines,
    check=unknown_results,
    results=lambda options: (*options.result, *options.dashed),
    analyses=("timehistory", "modal", "pushover"),
)
IDA = Report(
    IdaOptions, ida, check=single_intensity, results=lambda options: [options.result]
)
