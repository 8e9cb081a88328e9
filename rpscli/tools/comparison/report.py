"""The report comparison: endings and maxima beside those that were observed."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import PurePath
from typing import Any, NamedTuple

import numpy as np

from rpscli.analyses.result_quantities import LIMITED
from rpscli.errors import beginning
from rpscli.report.figures import style
from rpscli.report.study import fragility, panels
from rpscli.report.study.fragility import Binned, binned
from rpscli.report.study.fragility_options import MeasureOptions
from rpscli.report.study.report import (
    Found,
    Report,
    keyed,
    reached,
)
from rpscli.report.table import Column
from rpscli.sweep.names import labels
from rpscli.sweep.points import StudyPoints
from rpscli.sweep.statistics.fractiles import Share, clustered, demand, fractiles
from rpscli.sweep.statistics.grouping import INTENSITY, Histories, grouping
from rpscli.sweep.table import (
    Array,
    Indices,
    Intensity,
    StoredPoints,
    groups,
)
from rpscli.tools.comparison.observed import OVERTURNED, Observed, comparable

MOST_PANELS = 16  # in the figure; the CSV files have all
EACH = 3.1
AROUND = 0.6
"""Heights of a panel, and of what is around all of them [in]."""
SHOWN = {
    "": (
        "counted",
        "agreed_share",
        "overturned_observed",
        "overturned_computed",
        "failed",
    ),
    "_maxima": (
        "quantity",
        "counted",
        "overturned_computed",
        "median_ratio",
        "dispersion",
    ),
}
"""Columns for readers, by what follows the report's name in that of the file."""

QUANTITIES = {quantity.name: quantity for quantity in LIMITED}

TOLD = {
    (1, 1): "both",
    (0, 1): "computed only",
    (1, 0): "observed only",
    (0, 0): "neither",
}
"""Words for observed and computed overturning."""


class ComparisonOptions(MeasureOptions):
    """Endings and maxima beside those that were observed."""


class Endings(NamedTuple):
    """Counts of both outcomes, the share of equal ones, shares that
    overturned by intensity.
    """

    both: int
    computed_only: int
    observed_only: int
    neither: int
    agreed: Share
    observed: Binned
    computed: Binned

    @property
    def overturned(self) -> tuple[int, int]:
        """Observed and computed."""
        return self.both + self.observed_only, self.both + self.computed_only


class Compared(NamedTuple):
    """One quantity of one system: 1 where overturned, or maxima [SI],
    infinite where overturned.
    """

    values: tuple[object, ...]
    quantity: str
    found: Endings | Maxima
    points: Indices  # (m,) that did not fail
    observed: Array  # (m,)
    computed: Array  # (m,)
    failed: int


def comparison(study: StoredPoints, options: ComparisonOptions) -> Found:
    """Compare every system with its observations."""
    layout = study.table.layout
    intensity = study.table.intensity(options.measure, options.period, options.damping)
    observed = layout.study.of_tools.get("observed")
    assert observed is not None, "`unpaired` was asked before"
    pairs = observed_pairs(layout, observed)
    systems = grouping(study.table)
    compared = []
    for system in systems.groups:
        of_system = np.isin(pairs.points, system.every)
        for name, values in zip(observed.quantities, pairs.values, strict=True):
            seen = of_system & np.isfinite(values)
            if seen.any():
                of = system, name, pairs.points[seen], values[seen], intensity
                compared.append(_compared(*of))
    kinds = {"": Endings, "_maxima": Maxima}
    shown = [
        s for s, kind in kinds.items() if any(isinstance(c.found, kind) for c in compared)
    ]
    figure = ComparisonFigure(systems.keys, compared, intensity)
    return Found(
        _tables(systems.keys, compared, intensity, layout),
        figure if compared else None,
        [*pairs.notes, *systems.notes],
        shown={
            suffix: dict.fromkeys((*systems.keys, *SHOWN[suffix]), "") for suffix in shown
        },
        remark="agreed: in brackets the 95 % interval of the share" * ("" in shown),
    )


def _compared(
    system: Histories, name: str, points: Indices, observed: Array, intensity: Intensity
) -> Compared:
    table = system.table
    results = (
        table.overturned if name == OVERTURNED else demand(table, table.columns[name])
    )
    known = ~table.failed[points]
    points = points[known]
    observed = observed[known]
    computed = np.asarray(results[points], dtype=float)
    found: Endings | Maxima
    if name != OVERTURNED:
        found = maxima(computed, observed)
    else:
        at = intensity.values[points]
        kept = np.flatnonzero(at > 0.0)
        saw, fell = both = observed == 1.0, computed == 1.0
        cells = (saw & fell, fell & ~saw, saw & ~fell, ~saw & ~fell)
        counts = (int(cell.sum()) for cell in cells)
        agreed = clustered(saw == fell, table.clusters[points])
        bins = (binned(table, points[kept], at[kept], of[kept]) for of in both)
        found = Endings._make((*counts, agreed, *bins))
    return Compared(
        system.values, name, found, points, observed, computed, int((~known).sum())
    )


def _tables(
    keys: Sequence[str],
    compared: Sequence[Compared],
    intensity: Intensity,
    layout: StudyPoints,
) -> dict[str, list[Column]]:
    """Endings, maxima, and every pair: hits and misses by record."""
    rows: dict[str, list[tuple[Any, ...]]] = {"": [], "_maxima": [], "_pairs": []}
    for each in compared:
        found = each.found
        values = each.values
        if isinstance(found, Maxima):
            ratio = found.counted, found.overturned, found.median, found.dispersion
            rows["_maxima"].append((values, each.quantity, *ratio, each.failed))
        else:
            share = found.agreed
            shares = share.of, share.number, share.fraction, share.low, share.high
            rows[""].append((values, *shares, *found.overturned, *found[:4], each.failed))
        pairs = zip(each.points.tolist(), each.observed, each.computed, strict=True)
        for point, observed, computed in pairs:
            request = layout[point].record
            assert request is not None, "points of histories have a record"
            told = (
                TOLD[int(observed), int(computed)]
                if each.quantity == OVERTURNED
                else None
            )
            at = request.source, point + 1, intensity.values[point], each.quantity
            rows["_pairs"].append((values, *at, observed, reached(computed), told))
    heads = {
        "": "counted, agreed, agreed_share, agreed_low, agreed_high, overturned_observed,"
        " overturned_computed, both, computed_only, observed_only, neither, failed",
        "_maxima": "quantity, counted, overturned_computed, median_ratio, dispersion, failed",
        "_pairs": (
            f"record, point, {intensity.name} [{intensity.unit}], quantity, observed"
            " [SI], computed [SI], told"
        ),
    }
    return {suffix: keyed(keys, heads[suffix], of) for suffix, of in rows.items()}


@dataclass(frozen=True, eq=False)
class ComparisonFigure:
    """One panel a system and quantity."""

    keys: Sequence[str]
    compared: Sequence[Compared]
    intensity: Intensity
    part: str = ""  # of several sheets

    def __call__(self, title: str) -> style.Draw:
        """The figure under a title."""
        return partial(self._fill, title)

    def sheets(self, room: float) -> list[ComparisonFigure]:
        """The figure in parts of at most a page, where figures are so wide [in]."""
        across = self._across(room)
        shown = min(len(self.compared), MOST_PANELS)
        parts = panels.in_sheets(shown, across, EACH, AROUND)
        if len(parts) == 1:
            return [self]
        left = panels.first_of(shown, len(self.compared), "panels")
        told = (f"sheet {number} of {len(parts)}" for number in range(1, len(parts) + 1))
        return [
            replace(self, compared=self.compared[part], part=panels.remarks(sheet, left))
            for part, sheet in zip(parts, told, strict=True)
        ]

    def _across(self, room: float) -> int:
        return 1 if len(self.compared) == 1 or room < style.WIDTH else 2

    def _fill(self, title: str, figure: style.Figure) -> None:
        across = self._across(style.room(figure))
        shown, cut = panels.first(figure, self.compared, across, MOST_PANELS, 5)
        down = -(-len(shown) // across)
        width = style.WIDTH if across > 1 else 0.7 * style.WIDTH
        style.begin(figure, (title, self.part, cut), AROUND + EACH * down, width)
        grid = figure.subplots(down, across, squeeze=False)
        style.blank(grid.flat[len(shown) :])
        for axes, each in zip(grid.flat, shown, strict=False):
            if isinstance(each.found, Endings):
                line = _draw_outcomes(axes, each, each.found, self.intensity)
            else:
                line = _draw_maxima(axes, each, each.found)
            system = labels(self.keys, each.values)
            text = f"{system}\n{line}" if system else line
            axes.set_title(text, fontsize=style.small())
        style.legend_below(figure, grid.flat)


def _draw_outcomes(
    axes: style.Axes, each: Compared, found: Endings, intensity: Intensity
) -> str:
    """Both shares by intensity; below and above, the outcomes that differ."""
    at = intensity.values[each.points]
    agreed = found.agreed
    for name, bins, colour, marker in (
        ("observed", found.observed, style.BLACK, "o"),
        ("computed", found.computed, style.BLUE, "s"),
    ):
        look: dict[str, Any] = {"color": colour, "lw": 0.8, "marker": marker, "ms": 3.2}
        axes.plot(bins.intensity, bins.share, label=name, **look)
    marks = {1.0: (1.05, "above: computed only"), -1.0: (-0.05, "below: observed only")}
    for sign, (height, name) in marks.items():
        chosen = at[each.computed - each.observed == sign]
        axes.plot(chosen, [height] * len(chosen), "|", ms=6, color=style.RED, label=name)
    axes.set_xscale("log")
    panels.log_ticks(axes.xaxis)
    name = style.typeset(f"{fragility.measure_name(intensity)} [{intensity.unit}]")
    axes.set(ylim=(-0.1, 1.1), xlabel=name, ylabel="share that overturned")
    observed, computed = found.overturned
    line = f"{100.0 * (agreed.fraction or 0.0):.1f} % of {agreed.of} agree"
    return f"{line}; overturned {computed}, observed {observed}"


def _draw_maxima(axes: style.Axes, each: Compared, found: Maxima) -> str:
    """Computed over observed maxima; overturned histories at the upper edge."""
    observed = each.observed
    computed = each.computed
    drawn = np.isfinite(computed) & (computed > 0.0) & (observed > 0.0)
    axes.plot(
        observed[drawn], computed[drawn], ls="", marker="o", ms=3.2, color=style.BLUE
    )
    if drawn.any():
        both = np.concatenate([observed[drawn], computed[drawn]])
        span = [float(both.min()), float(both.max())]
        axes.plot(span, span, color=style.GREY, lw=0.8)
        fallen = observed[np.isinf(computed) & (observed > 0.0)]
        axes.plot(fallen, [1.3 * span[1]] * len(fallen), "^", ms=4, color=style.RED)
    axes.set(xscale="log", yscale="log")
    for axis in (axes.xaxis, axes.yaxis):
        panels.log_ticks(axis)
    scale = panels.scale_of_result(QUANTITIES[each.quantity])
    for axis in (axes.xaxis, axes.yaxis):
        scale.ticks(axis)
    axes.set(xlabel=f"observed {scale.label}", ylabel=f"computed {scale.label}")
    line = f"ratio {found.median:.2f} in the median, dispersion {found.dispersion:.2f}"
    return (
        f"{line}, n = {found.counted}"
        + f"\n{found.overturned} overturned (triangles)" * bool(found.overturned)
    )


def uncomparable(layout: StudyPoints, options: ComparisonOptions) -> Iterator[str]:
    """Faults that keep a study from this report."""
    yield from unpaired(layout)
    yield from fragility.measure_without_period(layout, options)


class Pairs(NamedTuple):
    """Points (pairs,), what was observed (quantities, pairs), what was left out."""

    points: Indices
    values: Array
    notes: tuple[str, ...]


def observed_pairs(layout: StudyPoints, observed: Observed) -> Pairs:
    """Every point with the observation of its system and of its
    record by any of its names.
    """
    records = _record_numbers(layout)
    rows = {
        (records[row.record], row.system): place
        for place, row in enumerate(observed.rows)
        if row.record in records
    }
    points = []
    places = []
    for group in groups(layout, observed.keys):
        system = tuple(map(comparable, observed.keys, group.values))
        row_of = np.array([rows.get((n, system), -1) for n in range(len(layout.records))])
        place = row_of[layout.places.record[group.points]]
        points.append(group.points[place >= 0])
        places.append(place[place >= 0])
    found = np.concatenate(points)
    row = np.concatenate(places)
    order = np.argsort(found, kind="stable")
    found = found[order]
    row = row[order]
    values = np.array([seen.values for seen in observed.rows]).T[:, row]
    notes = []
    if unused := len(observed.rows) - len(np.unique(row)):
        notes.append(
            f"{unused} of {len(observed.rows)} observations in {observed.name} have no"
            " point in the study: their record, or their system, is not in it"
        )
    if len(found) < len(layout):
        notes.append(
            f"{len(layout) - len(found)} of {len(layout)} points have no observation"
        )
    return Pairs(found, values, tuple(notes))


def _record_numbers(layout: StudyPoints) -> dict[str, int]:
    """Numbers of the records by every name that one of them alone goes by."""
    sources = [record.source for record in layout.records if record is not None]
    names = [{s, PurePath(s).name, PurePath(s).stem} for s in sources]
    times = Counter(name for known in names for name in known)
    short = {
        name: n for n, known in enumerate(names) for name in known if times[name] == 1
    }
    return short | {source: number for number, source in enumerate(sources)}


def unpaired(layout: StudyPoints) -> Iterator[str]:
    """Reasons that keep a study from being compared with its observations."""
    observed = layout.study.of_tools.get("observed")
    if observed is None:
        yield "the study names no observations; add `observed: FILE.csv`"
    elif None in layout.records:
        yield "the study has no list `records`, by which observations are found; add it"
    elif len(layout.scales) > 1 and INTENSITY not in observed.keys:
        yield (
            f"the study has {len(layout.scales)} scales, and {observed.name} does not say"
            " which of them was observed; add a column `scale`, or keep one scale"
        )
    elif not len(observed_pairs(layout, observed).points):
        yield (
            f"no line of {observed.name} has a record and a system of the study, such as"
            f" {beginning(observed.rows[0].record)}; records go by their sources or the"
            " names of files"
        )


class Maxima(NamedTuple):
    """Computed over observed maxima of one quantity.

    `median` and `dispersion` (standard deviation of the logarithm) are those of the
    `counted` ratios; `overturned` histories have none.
    """

    counted: int
    overturned: int
    median: float
    dispersion: float


def maxima(computed: Array, observed: Array) -> Maxima:
    """Compare maxima; computed ones are infinite where the structure overturned."""
    stood = np.isfinite(computed) & (computed > 0.0) & (observed > 0.0)
    logs = np.log(computed[stood] / observed[stood])
    return Maxima(
        counted=len(logs),
        overturned=int(np.isinf(computed).sum()),
        median=math.exp(fractiles(logs, [0.5])[0]),
        dispersion=float(np.std(logs, ddof=1)) if len(logs) > 1 else math.nan,
    )


REPORT = Report(ComparisonOptions, comparison, requires=uncomparable)
