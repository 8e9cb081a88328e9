"""Any result against a varied key, or one list of results against another."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np
from pydantic import Field, StrictBool

from rpscli.case.schema.fields import Quantity, Text
from rpscli.case.study.axes import Axis
from rpscli.case.study.reports import ReportOptions, ReportRequest
from rpscli.case.study.schema import Keys
from rpscli.case.text.document import Document, Fault, Path, dotted
from rpscli.errors import hint, listed
from rpscli.sweep.evaluation.results import KNOWN, quantity
from rpscli.sweep.intensities import unit_of
from rpscli.sweep.statistics.fractiles import fractiles
from rpscli.sweep.statistics.grouping import (
    INTENSITY,
    apart,
    pooled,
    pooling_note,
    shown_keys,
)
from rpscli.sweep.store import Stored
from rpscli.sweep.table import Indices, Table, groups, leading_keys
from rpscli.units import in_si

Values = dict[str, list[Any]]
"""Some results of all points, by name; None where a point has none."""


class LinesOptions(ReportOptions):
    """Any result against a varied key, or one list of results against another."""

    x: Text = Field(description="a varied key, or a result that is a list")
    y: Keys = Field(description="results, such as rolling.frequency_ratio.0")
    dashed: Keys = Field((), description="results drawn dashed, as a comparison")
    series: Keys | None = Field(None, description="varied keys, one line for each value")
    panels: Keys | None = Field(None, description="varied keys, one panel for each value")
    statistic: Annotated[
        float | Literal["mean", "median", "largest"],
        Quantity(symbol="a fractile", above=0, below=1, words=("mean", "median", "largest")),
    ] = Field(
        "mean",
        description="of points with one abscissa: the mean of survivors; or, with overturned"
        " histories as larger than any demand, the median, the largest, or a fractile as 0.84",
    )
    upright: StrictBool = Field(default=False, description="draw x upwards, as floors are")
    x_label: Text | None = Field(None, description="in place of the name of x")
    y_label: Text | None = Field(None, description="in place of the name of y")


class Line(NamedTuple):
    """One line: a result of the points of one series.

    `x` holds numbers, or words if the varied key has any. Where points share an abscissa,
    `counted` of them stood and `overturned` did not, one number for each abscissa.
    """

    values: tuple[object, ...]
    result: str
    dashed: bool
    x: tuple[Any, ...]
    y: tuple[float, ...]
    counted: tuple[int, ...] = ()
    overturned: tuple[int, ...] = ()


@dataclass(frozen=True)
class LinesPanel:
    """Lines of one group of systems."""

    values: tuple[object, ...]
    lines: tuple[Line, ...]


@dataclass(frozen=True)
class LinesReport:
    """All panels. `failed` points are left out."""

    options: LinesOptions
    series_keys: tuple[str, ...]
    panel_keys: tuple[str, ...]
    panels: tuple[LinesPanel, ...]
    failed: int
    x_name: str
    pooled: tuple[str, ...]
    pooling: tuple[str, ...]

    @property
    def statistic(self) -> str:
        """What stands for points with one abscissa, in words; empty where each stands alone."""
        lines = [line for panel in self.panels for line in panel.lines]
        if not any(c + o > 1 for x in lines for c, o in zip(x.counted, x.overturned, strict=True)):
            return ""
        chosen = self.options.statistic
        if chosen == "mean":
            return "mean of survivors"
        return chosen if isinstance(chosen, str) else f"{100.0 * chosen:g} % fractile"

    @property
    def notes(self) -> list[str]:
        """What is pooled, and what means leave out."""
        notes = list(self.pooling)
        if self.statistic == "mean of survivors":
            first = {repr((p.values, x.values)): x for p in self.panels for x in reversed(p.lines)}
            overturned = sum(sum(line.overturned) for line in first.values())
            of = overturned + sum(sum(line.counted) for line in first.values())
            if overturned:
                notes.append(
                    f"means are those of survivors: {overturned} of {of} histories overturned and"
                    " are left out; `statistic: median` counts them"
                )
        return notes

    @property
    def results(self) -> tuple[str, ...]:
        """Names of all results, the dashed ones last."""
        return (*self.options.y, *self.options.dashed)


def lines_report(table: Table, stored: Stored, options: LinesOptions) -> LinesReport:
    """The lines of every series of every panel.

    Where several points share an abscissa (the records of a study) the line is the statistic that
    the options name; failed points are left out.
    """
    layout = table.layout
    panels, series = options.panels or (), options.series
    if series is None:
        taken = {*panels, *_together(table, options.x)}
        series = tuple(key for key in leading_keys(layout) if key not in taken)
        if INTENSITY not in taken:
            series = apart(layout, series)
    names = (*options.y, *options.dashed)
    varied = bool(_together(table, options.x))
    values = _collected(table, stored, names if varied else (*names, options.x))
    found = []
    for panel in groups(layout, panels):
        lines = [
            line
            for name in names
            for group in groups(layout, series, panel.points)
            for line in _lines(table, values, options, group.values, group.points, name)
        ]
        found.append(LinesPanel(panel.values, tuple(lines)))
    keys = (options.x, *series, *panels)
    return LinesReport(
        options=options,
        series_keys=shown_keys(layout, series),
        panel_keys=shown_keys(layout, panels),
        panels=tuple(found),
        failed=int(table.failed.sum()),
        x_name=shown_keys(layout, (options.x,))[0],
        pooled=pooled(layout, keys) if varied else (),
        pooling=tuple(pooling_note(layout, keys)) if varied else (),
    )


def _together(table: Table, key: str) -> tuple[str, ...]:
    """The keys of the axis in which a key varies; none if it is a result."""
    if key in {"record", "scale"}:
        return (key,)
    axes = (axis.keys for axis in table.layout.study.axes)
    return next((keys for keys in axes if key in keys), ())


def _collected(table: Table, stored: Stored, names: Iterable[str]) -> Values:
    """Results of all points: numbers, lists, or None."""
    wanted = tuple(names)
    columns, analysis = stored(wanted).columns, table.layout.plan.analysis
    values: Values = {}
    for name in wanted:
        column, of = columns.get(name), quantity(analysis, name)
        rows = [None] * len(table) if column is None else column.tolist()
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


def _lines(
    table: Table,
    values: Values,
    options: LinesOptions,
    of_series: tuple[object, ...],
    points: Indices,
    name: str,
) -> list[Line]:
    """Lines of one result of one series: one, or one for each point if results are lists."""
    dashed = name in options.dashed
    usable = [n for n in points.tolist() if values[name][n] is not None]
    if options.x in values:
        curves = [(values[options.x][n], values[name][n]) for n in usable]
        whole = [c for c in curves if isinstance(c[0], list) and isinstance(c[1], list)]
        if whole:
            return [Line(of_series, name, dashed, tuple(x), tuple(y)) for x, y in whole]
        pairs = sorted(c for c in curves if c[0] is not None)
        x, y = ([pair[side] for pair in pairs] for side in (0, 1))
        return [Line(of_series, name, dashed, tuple(x), tuple(y))] if pairs else []
    at = []
    for group in groups(table.layout, [options.x], points):
        stood = group.points[~table.overturned[group.points]].tolist()
        known = [values[name][n] for n in stood if isinstance(values[name][n], int | float)]
        fallen = int(table.overturned[group.points].sum())
        found = _statistic(known, fallen, options.statistic)
        if not math.isnan(found):
            at.append((in_si(group.values[0], unit_of(options.x)), found, len(known), fallen))
    return [Line(of_series, name, dashed, *zip(*at, strict=True))] if at else []


def _statistic(known: Sequence[float], fallen: int, wanted: float | str) -> float:
    """Mean of what stood, or a fractile in which what overturned is larger than any; else NaN."""
    if wanted == "mean":
        return math.fsum(known) / len(known) if known else math.nan
    share = {"median": 0.5, "largest": 1.0}.get(str(wanted)) or float(wanted)
    demands = np.array([*known, *[math.inf] * fallen])
    return float(fractiles(demands, [share])[0])


def unknown_results(
    document: Document, axes: Sequence[Axis], request: ReportRequest
) -> Iterator[Fault]:
    """Results that the analysis does not have."""
    options, analysis = request.options, document.content.get("analysis", "timehistory")
    assert isinstance(options, LinesOptions), "requests have the options of their kind"
    varied = {key for axis in axes for key in axis.keys} | {"record", "scale"}
    named = [("x", options.x)] if options.x not in varied else []
    named += [("y", name) for name in options.y] + [("dashed", name) for name in options.dashed]
    for option, name in named:
        if quantity(analysis, name) is None:
            path: Path = (*request.path, request.kind, option)
            meant = hint(name, KNOWN[analysis], f"known are {listed(KNOWN[analysis])}")
            text = f"{dotted(path)} = {name} is no result of {analysis}"
            yield Fault(path, f"{text}{' and does not vary' * (option == 'x')}; {meant}")
