"""The answer of a search for a design: JSON, tables for
readers, CSV, notes and figures.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from rpscli.case.conditions import LIMITS, RATE
from rpscli.report.figures import style
from rpscli.report.limits import (
    VERDICT,
    limit_unit,
    reached_text,
    requirement_text,
    verdict_texts,
)
from rpscli.report.study import panels
from rpscli.report.study.report import axis_label, key_columns, reached
from rpscli.report.study.statistics import verdict_document
from rpscli.report.table import Column, Part, Table, large, shown
from rpscli.sweep.names import label, symbol, unit_of
from rpscli.sweep.statistics.fractiles import CONFIDENCE
from rpscli.sweep.statistics.verdicts import Verdict
from rpscli.sweep.table import Array
from rpscli.tools.design.keys import Objective
from rpscli.tools.design.search import ROBUST, Answer, Requirement

if TYPE_CHECKING:
    from matplotlib.axis import Axis
    from matplotlib.cm import ScalarMappable

DIGITS = 4


def requirement_label(requirement: Requirement) -> str:
    """Name of what is limited, with the intensity at which it is."""
    words = requirement.condition.name
    if requirement.level is None:
        return words
    return f"{words} at {label(requirement.measure, requirement.level)}"


def objective_label(objective: Objective) -> str:
    """A sum in words.

    >>> from rpscli.tools.design.keys import Term
    >>> objective_label({"podium.bearing.semi_diagonal": Term(times=2.0), "max_base_shear": Term()})
    '2 R + base shear, median'
    """
    terms = []
    for name, term in objective.items():
        known = LIMITS.get(name)
        fractile = (
            "median" if term.fractile == 0.5 else f"{100.0 * term.fractile:g} % fractile"
        )
        words = symbol(name) if known is None else f"{known.label}, {fractile}"
        terms.append(words if term.times == 1.0 else f"{term.times:g} {words}")
    return " + ".join(terms)


def objective_unit(objective: Objective) -> str:
    """SI unit of an objective of one term; ``-`` for a sum, which may be of anything."""
    ((name, term), *others) = objective.items()
    if others or term.times != 1.0:
        return "-"
    return LIMITS[name].unit if name in LIMITS else unit_of(name)


def requirement_rows(
    answer: Answer, verdicts: Sequence[Verdict]
) -> Iterator[tuple[int, Requirement, Verdict]]:
    """Each requirement with its number, and the verdict of the best
    design's own study on it.
    """
    if len(verdicts) == len(
        answer.requirements
    ):  # not where all histories at one level failed
        yield from zip(itertools.count(), answer.requirements, verdicts, strict=False)


def answer_document(answer: Answer, verdicts: Sequence[Verdict]) -> dict[str, Any]:
    """Everything but the designs one by one, which are in `designs.csv`."""
    objective = answer.task.file.minimise
    name = objective_label(objective)
    place = answer.closest
    design = {
        "design": place + 1,
        "values": dict(zip(answer.task.keys, answer.values[place].tolist(), strict=True)),
        "aims": {name: float(answer.objectives[0, place])},
        "passing_share": float(answer.passing_share[place]),
    }
    intervals = {
        key: answer.interval(column) for column, key in enumerate(answer.task.keys)
    }
    return {
        "designs": {
            "looked_at": len(answer.places),
            "valid": int(answer.valid.sum()),
            "passing": int(answer.passes[0].sum()),
        },
        "minimise": {"aim": name, "unit": objective_unit(objective)},
        "best": None if answer.best is None else design,
        "closest": design,
        "requirements": [
            {
                "requirement": requirement_label(requirement),
                **verdict_document((), replace(verdict, values=())),
                "level": requirement.level,
                "value": float(answer.results[row, 0, place]),
                "bound": requirement.bound,
                "records_too_many": float(answer.excess[row, place]),
                "met": not verdict.exceeded,
                "designs_that_meet_it": int(answer.met[row, 0].sum()),
                "binds": bool(answer.governs[row]),
            }
            for row, requirement, verdict in requirement_rows(answer, verdicts)
        ],
        "at_bounds": [{"key": key, "end": end} for key, end in answer.at_bounds],
        "records": {
            "resamples": answer.resamples,
            "without_answer": answer.resamples - len(answer.best_of_resamples[0]),
            "intervals": {**intervals, name: answer.interval()},
            "independent": answer.task.file.independent,
        },
    }


def answer_tables(answer: Answer, verdicts: Sequence[Verdict]) -> Iterator[Part]:
    """The best design, its requirements, and how it hangs on the choice of records."""
    place = answer.closest
    title = ("best", "least violated")[answer.best is None]
    heads = ("", "", title, "95 % of resamples")
    yield Table.of_texts(heads, _design_rows(answer), words=2)
    judged = []
    for row, requirement, verdict in requirement_rows(answer, verdicts):
        _, word, asked, result = verdict_texts(verdict)
        at_one = verdict.fractile is None and verdict.judged_by is None
        if verdict.condition.name in LIMITS and at_one:
            demand = float(answer.results[row, 0, place])
            result = f"{reached_text(verdict.condition, demand)}; {result}"
        met_by = f"{answer.met[row, 0].sum()}{'; governs' * bool(answer.governs[row])}"
        judged.append((requirement_label(requirement), word, asked, result, met_by))
    yield Table.of_texts((*VERDICT, "designs that meet it"), judged, words=5)
    if answer.best is not None and answer.resamples:
        share = (
            f"{100.0 * answer.passing_share[place]:.0f} % of {answer.resamples} resamples"
        )
        listing = [("the best design passes in", share)]
        if without := answer.resamples - len(answer.best_of_resamples[0]):
            listing.append(("no design passes in", f"{without} of them"))
        yield Table.listing(listing)


def _design_rows(answer: Answer) -> list[tuple[str, str, str, str]]:
    """Keys of the best or least violated design, and what it minimises, with intervals."""
    place = answer.closest
    objective = answer.task.file.minimise
    minimised = {
        name for name, term in objective.items() if len(objective) == term.times == 1
    }
    rows = []
    for column, key in enumerate(answer.task.keys):
        # As it was judged: no digit less.
        value = f"{answer.values[place, column]:.10g}"
        ends = _interval(answer.interval(column))
        rows.append(
            (axis_label(key), "minimised" if key in minimised else "", value, ends)
        )
    if not minimised & {*answer.task.keys}:
        unit = objective_unit(objective)
        factor, name = large(1.0, unit)
        head = (
            f"{objective_label(objective)} [{name}]"
            if name
            else objective_label(objective)
        )
        value = shown(large(float(answer.objectives[0, place]), unit)[0], DIGITS)
        interval = _interval(end * (factor or 1.0) for end in answer.interval())
        rows.append((head, "minimised", value, interval))
    return rows


def _interval(interval: Iterable[float]) -> str:
    return " to ".join(shown(end, 3) for end in interval if not math.isnan(end)) or "-"


def answer_notes(answer: Answer, faults: Iterable[str]) -> Iterator[str]:
    """Remarks on the answer; `faults` are those of designs without a case."""
    if invalid := int((~answer.valid).sum()):
        yield f"{invalid} designs are not valid cases and count as failing: {next(iter(faults))}"
    if not answer.resamples and answer.task.file.search.resamples:
        yield "one record only: how far the choice of records moves the answer is not known"
    if ends := list(answer.at_bounds):
        words = " and ".join(f"the {end} {key}" for key, end in ends)
        yield f"the best design has {words} of its range; better designs may lie beyond"
    if answer.best is not None:
        yield from neighbours_note(answer, answer.best)
    if answer.best is not None and answer.passing_share[answer.best] < ROBUST:
        yield (
            f"no design passes in {100.0 * ROBUST:g} % of the resamples of the records;"
            f" the best one passes in {100.0 * answer.passing_share[answer.best]:.0f} %"
            " of them"
        )


NEAREST = 6
"""Designs beside the best one that are looked at, if that many were tried."""


def best_so_far(answer: Answer) -> str:
    """The best design that is known before the next round, in a line."""
    tried = f"{len(answer.places)} designs tried"
    passing = int(np.count_nonzero(answer.passes[0]))
    at = answer.closest
    values = ", ".join(
        f"{axis_label(key)} = {value:.4g}"
        for key, value in zip(answer.task.keys, answer.values[at], strict=True)
    )
    if answer.best is None:
        return f"{tried}, none passes; the least violated so far: {values}"
    return f"{tried}, {passing} pass; the best so far: {values}"


def neighbours_note(answer: Answer, best: int) -> Iterator[str]:
    """A warning where the best design stands alone: at most one of
    those nearest to it passes.
    """
    # At the edge of what passes, where the best design lies, half of them fail.
    apart = np.linalg.norm(answer.places - answer.places[best], axis=1)
    beside = np.argsort(apart, kind="stable")[1 : NEAREST + 1]
    fail = int((~answer.passes[0, beside]).sum())
    if len(beside) == NEAREST and fail >= NEAREST - 1:
        yield (
            f"of the {NEAREST} designs tried next to the best one {fail} fail: it stands"
            " alone, and a little more of a key or of the motion may undo it; demand a"
            " margin (a stricter `limits`), more records, or `perturb` them"
        )


def nothing_passes(answer: Answer) -> str:
    """Which requirement stands in the way least, where no design passes."""
    place = answer.closest
    lines = [f"no design of {len(answer.places)} meets all requirements"]
    rows = np.flatnonzero(~answer.met[:, 0, place])
    for row in rows[np.argsort(answer.excess[rows, place], kind="stable")].tolist():
        requirement = answer.requirements[row]
        lines.append(
            f"{requirement_label(requirement)}:"
            f" {requirement_text(requirement.condition)};"
            f" {reached_text(requirement.condition, float(answer.results[row, 0, place]))}"
            f" in the least violated design, {100.0 * answer.excess[row, place]:.3g} % of"
            f" the records too many; {answer.met[row, 0].sum()} designs meet it"
        )
    return "\n".join(lines)


def design_columns(answer: Answer) -> list[Column]:
    """One row a design: its keys, whether it passes, the objective,
    and values of requirements.
    """

    def column(name: str, unit: str, values: Array) -> Column:
        return Column(name, unit, [reached(value) for value in values.tolist()])

    objective = answer.task.file.minimise
    columns = [Column("design", "-", range(1, len(answer.places) + 1))]
    columns += key_columns(answer.task.keys, answer.values.tolist())
    for name, flags in (("valid", answer.valid), ("passes", answer.passes[0])):
        columns.append(Column(name, "-", [str(flag).lower() for flag in flags.tolist()]))
    columns.append(column("passing_share", "-", answer.passing_share))
    name = objective_label(objective).replace(",", "")
    known = answer.valid
    least = np.where(known, answer.objectives[0], np.nan)
    columns.append(column(f"least {name}", objective_unit(objective), least))
    for row, requirement in enumerate(answer.requirements):
        name = requirement_label(requirement)
        unit = limit_unit(requirement.condition.name)
        columns.append(column(name, unit, answer.results[row, 0]))
        columns.append(column(f"{name}: records too many", "-", answer.excess[row]))
    return columns


MARKS = (
    ("no valid case", "x", style.GREY), ("fails", "v", style.RED), ("passes", "o", style.BLUE),
)  # fmt: skip
MOST_PAIRS = 6
SHARES = (0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0)
"""Of the resamples, between which the region that passes changes its colour."""

BEST: dict[str, Any] = {
    "ls": "", "marker": "*", "ms": 9.0, "color": style.ORANGE, "mec": style.BLACK, "mew": 0.6,
    "zorder": 5, "clip_on": False, "label": "best design",
}  # fmt: skip


def figures(answer: Answer, title: str) -> Mapping[str, style.Draw]:
    """The figure of the search, by the name of its file."""
    if len(answer.task.unknowns) == 1:
        return {"requirements": partial(requirements_figure, answer, title)}
    return {"region": partial(region_figure, answer, title)}


def requirements_figure(answer: Answer, title: str, figure: style.Figure) -> None:
    """One unknown: the value of every requirement against it, with
    its limit and the answer.
    """
    order = np.argsort(answer.values[:, 0])
    best = answer.best
    key = answer.values[order, 0]
    requirements = answer.requirements
    style.begin(figure, (title, _counts(answer)), 1.9 + 2.3 * len(requirements))
    grid = figure.subplots(len(requirements), 1, squeeze=False, sharex=True)[:, 0]
    for row, (axes, requirement) in enumerate(zip(grid, requirements, strict=True)):
        values = answer.results[row, 0, order]
        name = requirement.condition.name
        shown = np.where(np.isfinite(values), values, np.nan)
        if answer.resamples:
            ends = 0.5 * (1.0 - CONFIDENCE), 0.5 * (1.0 + CONFIDENCE)
            drawn = answer.results[row, 1:, order]
            low, high = np.quantile(drawn, ends, axis=1, method="inverted_cdf")
            axes.fill_between(key, low, np.where(np.isfinite(high), high, 1e9), alpha=0.3,
                              color=style.SKY, lw=0.0, label="95 % of resamples")  # fmt: skip
        axes.plot(key, shown, "o", ms=3.0, color=style.BLUE, label="designs")
        axes.axhline(requirement.bound, color=style.RED, ls="--", label="admissible")
        if best is not None:
            axes.plot(answer.values[best, 0], answer.results[row, 0, best], **BEST)
            if answer.resamples:
                axes.axvspan(*answer.interval(0), ymax=0.03, color=style.ORANGE, lw=0.0,
                             label="best of 95 % of resamples")  # fmt: skip
        top = np.nanmax([*np.nan_to_num(shown), 2.0 * requirement.bound, 1e-12])
        most = max(10.0 * requirement.bound, 0.0 if name == RATE else 1.0)
        end = 1.05 * float(min(top, most))
        axes.set_ylim(0.0, end)
        if (off := np.nan_to_num(values, nan=0.0) > end).any():
            axes.plot(key[off], np.full(off.sum(), end), "^", ms=4.0, color=style.RED,
                      clip_on=False, label="off the scale, or overturned")  # fmt: skip
        words = LIMITS[name].label if name in LIMITS else name
        _name_axis(axes.yaxis, _scale_of_requirement(name))
        axes.set_title(
            style.typeset(requirement_label(requirement).replace(name, words, 1))
        )
    _name_axis(grid[-1].xaxis, _scale_of_key(answer.task.keys[0]))
    style.legend_below(figure, grid)


def region_figure(answer: Answer, title: str, figure: style.Figure) -> None:
    """Designs that pass and fail for each pair of unknowns, in the
    colour of their resamples.
    """
    pairs = list(itertools.combinations(range(len(answer.task.unknowns)), 2))
    shown = pairs[:MOST_PAIRS]
    columns = 1 if style.narrow(figure) else min(3, len(shown))
    rows = math.ceil(len(shown) / columns)
    from matplotlib import colormaps, rcParams
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import BoundaryNorm

    more = f"{MOST_PAIRS} of {len(pairs)} pairs" if len(pairs) > MOST_PAIRS else ""
    height = 1.1 + (4.2 if len(pairs) == 1 else 2.6) * rows
    style.begin(figure, (title, _counts(answer), more), height)
    grid = figure.subplots(rows, columns, squeeze=False)
    colours = colormaps[rcParams["image.cmap"]]
    shares = ScalarMappable(BoundaryNorm(SHARES, colours.N), colours)
    style.blank(grid.flat[len(shown) :])
    for axes, pair in zip(grid.flat, shown, strict=False):
        _draw_region(axes, answer, pair, shares)
    if answer.resamples:
        words = "share of resamples of the records that pass"
        figure.colorbar(shares, ax=grid, label=words)
    style.legend_below(figure, [grid[0, 0]])


def _draw_region(
    axes: style.Axes, answer: Answer, pair: tuple[int, int], shares: ScalarMappable
) -> None:
    """Designs over two unknowns, and the best one, coloured by shares of resamples."""
    x, y = pair
    of = {"passes": answer.passes[0], "fails": answer.valid & ~answer.passes[0]}
    of["no valid case"] = ~answer.valid
    look: dict[str, Any] = {"s": 18.0, "linewidths": 0.5, "clip_on": False}
    axes.locator_params(nbins=panels.MOST_TICKS)
    for name, marker, colour in MARKS:
        at = answer.values[of[name]].T
        share = answer.passing_share[of[name]]
        kind: dict[str, Any] = {"color": colour}
        if answer.resamples and name != "no valid case":
            kind = {
                "c": share,
                "cmap": shares.cmap,
                "norm": shares.norm,
                "edgecolors": style.BLACK,
            }
        if len(share):
            axes.scatter(at[x], at[y], marker=marker, label=name, **look, **kind)
    if answer.best is not None:
        axes.plot(answer.values[answer.best, x], answer.values[answer.best, y], **BEST)
    for axis, place in ((axes.xaxis, x), (axes.yaxis, y)):
        _name_axis(axis, _scale_of_key(answer.task.keys[place]))


def _scale_of_key(key: str) -> panels.Scale:
    """The axis of an unknown."""
    return panels.scale_of(symbol(key), unit_of(key).strip("-"))


def _scale_of_requirement(name: str) -> panels.Scale:
    """The axis of what is limited."""
    if name in LIMITS:
        return panels.scale_of_result(LIMITS[name])
    return panels.Scale("overturned [1/year]" if name == RATE else "share of records")


def _name_axis(axis: Axis, scale: panels.Scale) -> None:
    """Label and ticks."""
    scale.ticks(axis)
    axis.set_label_text(scale.label)


def _counts(answer: Answer) -> str:
    return f"{int(answer.passes[0].sum())} of {len(answer.places)} designs pass"
