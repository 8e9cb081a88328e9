"""Figures of a search: requirements along one unknown, the region that passes, the front."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from rpscli.case.conditions import EVENTS, LIMITS
from rpscli.report.design.answer import aim_label, aim_unit, requirement_label
from rpscli.report.figures import style
from rpscli.report.figures.look import Draw, in_force
from rpscli.report.study.labels import symbol
from rpscli.report.study.panels import MOST_TICKS
from rpscli.sweep.design.answer import NONE, ROBUST, Answer
from rpscli.sweep.design.judgement import Requirement
from rpscli.sweep.intensities import unit_of
from rpscli.sweep.statistics.fractiles import share
from rpscli.sweep.table import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MOST_PAIRS = 6
SHARES = (0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0)
"""Of the resamples, between which the region that passes changes its colour."""

BEST: dict[str, Any] = {
    "ls": "", "marker": "*", "ms": 11.0, "color": style.ORANGE, "mec": style.BLACK, "mew": 0.6,
    "zorder": 5, "clip_on": False, "label": "best",
}  # fmt: skip


def figures(answer: Answer, title: str) -> Mapping[str, Draw]:
    """What there is to draw, by the names of the files."""
    found: dict[str, Draw] = {}
    if len(answer.task.unknowns) == 1:
        found["requirements"] = partial(requirements_figure, answer, title)
    else:
        found["region"] = partial(region_figure, answer, title)
    if len(answer.front) > 1:
        found["front"] = partial(front_figure, answer, title)
    return found


def axis_label(key: str) -> str:
    """A key with its unit, for an axis."""
    return f"{symbol(key)} [{unit_of(key)}]"


def requirements_figure(answer: Answer, title: str) -> bytes:
    """One unknown: the value of every requirement against it, with its limit and the answer."""
    order = np.argsort(answer.values[:, 0])
    key, requirements = answer.values[order, 0], answer.judged.requirements

    def draw(figure: Figure) -> None:
        style.heading(figure, title, _counts(answer))
        grid = figure.subplots(len(requirements), 1, squeeze=False, sharex=True)[:, 0]
        for row, (axes, requirement) in enumerate(zip(grid, requirements, strict=True)):
            values = answer.judged.values[row, 0, order]
            shown = np.where(np.isfinite(values), values, np.nan)
            low, high = _band(answer, row, requirement)
            axes.fill_between(key, low[order], high[order], color=style.SKY, alpha=0.3, lw=0.0,
                              label="95 % interval")  # fmt: skip
            axes.plot(key, shown, "o-", ms=3.0, color=style.BLUE, label="designs")
            axes.axhline(requirement.bound, color=style.RED, ls="--", label="admissible")
            if answer.best != NONE:
                axes.plot(answer.values[answer.best, 0], answer.judged.values[row, 0, answer.best],
                          **BEST)  # fmt: skip
                if answer.resamples:
                    axes.axvspan(*answer.interval(0), color=style.ORANGE, alpha=0.12, lw=0.0,
                                 label="best in 95 % of the resamples")  # fmt: skip
            top = np.nanmax([*np.nan_to_num(shown), 2.0 * requirement.bound, 1e-12])
            axes.set_ylim(0.0, 1.05 * float(min(top, max(10.0 * requirement.bound, 1.0))))
            name = requirement.condition.name
            words = LIMITS[name].label if name in LIMITS else name
            unit = "share of records" if name in EVENTS else LIMITS[name].axis_label
            axes.set_ylabel(unit)
            axes.set_title(style.typeset(requirement_label(requirement).replace(name, words, 1)))
        grid[-1].set_xlabel(axis_label(answer.task.keys[0]))
        style.legend_above(grid[0], 5) if len(requirements) == 1 else grid[0].legend()

    return style.picture(draw, 1.4 + 2.3 * len(requirements))


def _band(answer: Answer, row: int, requirement: Requirement) -> tuple[Array, Array]:
    """(designs,) ends of the interval of a value: exact for shares, else of the resamples."""
    if requirement.condition.name in EVENTS:
        counted = max(len(answer.task.study.sources), 1)
        shares = [share(round(value * counted), counted) if math.isfinite(value) else None
                  for value in answer.judged.values[row, 0].tolist()]  # fmt: skip
        ends = [(s.low if s.number else 0.0, s.high if s.number < s.of else 1.0) if s
                else (math.nan, math.nan) for s in shares]  # fmt: skip
        low, high = np.array(ends).T
        return low, high
    drawn = answer.judged.values[row, 1 : 1 + answer.resamples]
    if not len(drawn):
        return np.full(drawn.shape[1], np.nan), np.full(drawn.shape[1], np.nan)
    low, high = np.quantile(drawn, (0.025, 0.975), axis=0, method="inverted_cdf")
    return low, np.where(np.isfinite(high), high, 1e9)


def region_figure(answer: Answer, title: str) -> bytes:
    """Several unknowns: designs that pass and fail, for each pair of unknowns.

    With two of them the colour between the designs is the share of the resamples that pass.
    """
    pairs = list(itertools.combinations(range(len(answer.task.unknowns)), 2))
    shown = pairs[:MOST_PAIRS]
    narrow = in_force().look.width(style.WIDTH) < style.WIDTH
    columns = 1 if narrow else min(3, len(shown))
    rows = math.ceil(len(shown) / columns)

    def draw(figure: Figure) -> None:
        more = f"{MOST_PAIRS} of {len(pairs)} pairs" if len(pairs) > MOST_PAIRS else ""
        style.heading(figure, title, _counts(answer), more)
        grid = figure.subplots(rows, columns, squeeze=False)
        for axes in grid.flat[len(shown) :]:
            axes.set_axis_off()
        for axes, (x, y) in zip(grid.flat, shown, strict=False):
            axes.locator_params(nbins=MOST_TICKS)
            if len(pairs) == 1 and answer.resamples:
                _draw_shares(figure, axes, answer)
            _draw_designs(axes, answer, x, y)
        handles = grid[0][0].get_legend_handles_labels()
        figure.legend(*handles, loc="outside lower center", ncols=2 if narrow else 5)

    return style.picture(draw, 1.1 + (4.2 if len(pairs) == 1 else 2.6) * rows)


def _draw_shares(figure: Figure, axes: Axes, answer: Answer) -> None:
    """The share of the resamples in which a design passes, between the designs."""
    from matplotlib.tri import Triangulation

    # Triangles of the unit square: ranges of different sizes would make needles of them.
    triangles = Triangulation(*answer.places.T).triangles
    between = Triangulation(answer.values[:, 0], answer.values[:, 1], triangles)
    # A share of one at all corners of a triangle would be outside the last level.
    shares = np.clip(answer.passing_share, 1e-6, 1.0 - 1e-6)
    filled = axes.tricontourf(between, shares, levels=SHARES, cmap="YlGn", alpha=0.55)
    figure.colorbar(filled, ax=axes, label="share of resamples of the records that pass")


def _draw_designs(axes: Axes, answer: Answer, x: int, y: int) -> None:
    for chosen, mark in (
        (~answer.valid, {"marker": "x", "color": style.GREY, "label": "no valid case"}),
        (answer.valid & ~answer.passes, {"marker": "v", "color": style.RED, "label": "fails"}),
        (answer.passes, {"marker": "o", "color": style.BLUE, "label": "passes"}),
    ):
        if chosen.any():
            of_mark: dict[str, Any] = mark
            axes.plot(
                answer.values[chosen, x],
                answer.values[chosen, y],
                ls="",
                ms=3.2,
                clip_on=False,
                **of_mark,
            )
    _mark(axes, answer, answer.values[:, [x, y]])
    axes.set_xlabel(axis_label(answer.task.keys[x]))
    axes.set_ylabel(axis_label(answer.task.keys[y]))


def front_figure(answer: Answer, title: str) -> bytes:
    """Both aims: no passing design lies left of and below the front."""
    aims, labels = answer.judged.aims[:, 0].copy(), []
    for place, aim in enumerate(answer.task.file.minimise):
        unit = aim_unit(aim)
        largest = np.abs(aims[place][np.isfinite(aims[place])]).max(initial=0.0)
        factor, prefix = style.engineering(float(largest)) if unit == "N" else (1.0, "")
        aims[place] *= factor
        labels.append(f"{aim_label(aim)} [{prefix}{unit}]")

    def draw(figure: Figure) -> None:
        style.heading(figure, title, f"{len(answer.front)} designs on the front")
        axes = figure.subplots()
        for chosen, mark in (
            (answer.valid & ~answer.passes, {"marker": "v", "color": style.RED, "label": "fails"}),
            (answer.passes, {"marker": "o", "color": style.BLUE, "label": "passes"}),
        ):
            of_mark: dict[str, Any] = mark
            axes.plot(*aims[:, chosen], ls="", ms=3.2, alpha=0.6, **of_mark)
        axes.plot(*aims[:, answer.front], color=style.BLACK, drawstyle="steps-post", label="front")
        _mark(axes, answer, aims.T)
        axes.set_xlabel(labels[0])
        axes.set_ylabel(labels[1])
        style.legend_above(axes, 4)

    return style.picture(draw, 4.2, 6.0)


def _mark(axes: Axes, answer: Answer, at: Array) -> None:
    """The best design, and the best robust one, at their rows of (designs, 2)."""
    if answer.best != NONE:
        axes.plot(*at[answer.best], **BEST)
    if answer.robust != NONE:
        words = f"best in {100.0 * ROBUST:g} % of the resamples"
        axes.plot(*at[answer.robust], **BEST | {"marker": "D", "ms": 6.0, "label": words})


def _counts(answer: Answer) -> str:
    return f"{int(answer.passes.sum())} of {len(answer.places)} designs pass"
