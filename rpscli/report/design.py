"""The answer of a search for a design as a JSON document, CSV tables and figures."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from rpscli.case.conditions import EVENTS, LIMITS, RATE
from rpscli.case.design import DesignTask, Objective
from rpscli.report.figures import style
from rpscli.report.figures.look import Draw
from rpscli.report.study.labels import key_columns, label, symbol
from rpscli.report.study.panels import MOST_TICKS
from rpscli.report.study.statistics import limit_unit, reached, verdict_document
from rpscli.report.table import Column
from rpscli.sweep.design.answer import NONE, Answer, Requirement
from rpscli.sweep.intensities import unit_of
from rpscli.sweep.table import Array, Indices


def requirement_label(requirement: Requirement) -> str:
    """What is limited, and at which intensity."""
    words = requirement.condition.name
    if requirement.level is None:
        return words
    return f"{words} at {label(requirement.measure, requirement.level)}"


def objective_label(objective: Objective) -> str:
    """A sum in words.

    >>> from rpscli.case.design import Term
    >>> objective_label({"podium.bearing.semi_diagonal": Term(times=2.0), "max_base_shear": Term()})
    '2 R + base shear, median'
    """
    terms = []
    for name, term in objective.items():
        known = LIMITS.get(name)
        fractile = "median" if term.fractile == 0.5 else f"{100.0 * term.fractile:g} % fractile"
        words = symbol(name) if known is None else f"{known.label}, {fractile}"
        terms.append(words if term.times == 1.0 else f"{term.times:g} {words}")
    return " + ".join(terms)


def objective_unit(objective: Objective) -> str:
    """SI unit of an objective of one term; ``-`` for a sum, which may be of anything."""
    if len(objective) != 1:
        return "-"
    ((name, term),) = objective.items()
    if term.times != 1.0:
        return "-"
    return LIMITS[name].unit if name in LIMITS else unit_of(name)


def answer_document(answer: Answer) -> dict[str, Any]:
    """Everything but the designs one by one, which are in `designs.csv`."""
    found = None if answer.best == NONE else answer.best
    return {
        "designs": {
            "looked_at": len(answer.places),
            "valid": int(answer.valid.sum()),
            "passing": int(answer.passes.sum()),
            "within_tolerances": 0 if answer.within is None else len(answer.within[0]),
        },
        "tolerance": answer.task.file.tolerance,
        "least": [
            {"aim": objective_label(objective), "unit": objective_unit(objective)}
            for objective in answer.task.file.minimise
        ],
        "best": None if found is None else _design(answer, found),
        # What is recommended, and what is better than it but apart.
        "robust": None if answer.robust == NONE else _design(answer, answer.robust, built=True),
        "islands": [_design(answer, place, built=True) for place in answer.islands],
        "closest": _design(answer, answer.closest),
        "requirements": requirement_rows(answer),
        "at_bounds": [{"key": key, "end": end} for key, end in answer.at_bounds],
        "front": [_design(answer, int(place)) for place in answer.front],
        "records": {
            "resamples": answer.resamples,
            "without_answer": answer.unanswered,
            "passing_share_of_best": None if found is None else answer.passing_share[found],
            "intervals": {
                **{key: answer.interval(place) for place, key in enumerate(answer.task.keys)},
                objective_label(answer.task.file.minimise[0]): answer.objective_interval,
            },
            "independent": answer.task.file.independent,
            # The best design without one recording or event, in the order of the records.
            "without_one": [
                {"record": name, "best": None if place == NONE else _design(answer, place)}
                for name, place in zip(
                    _left_out(answer.task), answer.without_record.tolist(), strict=False
                )
            ],
        },
        "bracket": answer.bracket if found is not None and len(answer.task.unknowns) == 1 else None,
    }


def _left_out(task: DesignTask) -> list[str]:
    """Names of what is left out together: the first source, and how many more there are."""
    sources: dict[int, list[str]] = {}
    for source, number in zip(task.study.sources, task.clusters, strict=False):
        sources.setdefault(number, []).append(source)
    return [
        f"{first} and {len(others)} more" if others else first
        for first, *others in sources.values()
    ]


def _design(answer: Answer, place: int, *, built: bool = False) -> dict[str, Any]:
    """A design by itself, or with what may be built in its place."""
    judged, at = answer.judged_at(place) if built else (answer.judged, place)
    objectives = zip(
        map(objective_label, answer.task.file.minimise), judged.objectives[:, 0, at], strict=True
    )
    more: dict[str, Any] = {}
    if built:
        more["passing_share"] = float(answer.tolerated.share[place])
        more["within_tolerances"] = judged is not answer.judged
    return {
        "design": place + 1,
        "values": dict(zip(answer.task.keys, answer.values[place].tolist(), strict=True)),
        "aims": {name: float(value) for name, value in objectives},
        **more,
    }


def requirement_rows(answer: Answer) -> list[dict[str, Any]]:
    """Each requirement at the recommended design, or at the least violated one."""
    judged, place = answer.judged_at(answer.headline)
    without, best = answer.without, answer.objectives[answer.best]
    return [
        {
            "requirement": requirement_label(requirement),
            **verdict_document((), verdict),
            "level": requirement.level,
            "value": float(judged.values[row, 0, place]),
            "bound": requirement.bound,
            "records_too_many": float(judged.excess[row, place]),
            "met": not verdict.exceeded,
            "designs_that_meet_it": int(answer.judged.met[row, 0].sum()),
            "binds": without[row] < best if without else None,
            "aim_without_it": without[row] if without else None,
        }
        for row, (requirement, verdict) in enumerate(
            zip(judged.requirements, answer.verdicts(answer.headline), strict=True)
        )
    ]


def design_columns(answer: Answer, places: Indices | Sequence[int]) -> list[Column]:
    """One row a design: its keys, whether it passes, objectives, and the value of each requirement.

    `passing_share` is the share of the resamples of the records in which it passes; `region` tells
    which designs hold, and is 1 for the recommended region; a value that overturned is ``inf``, and
    cells of designs that are not valid cases are empty.
    """
    judged, passing = answer.judged, answer.passing_share
    region: list[int | None] = [None] * len(answer.places)
    for number, members in enumerate(answer.regions, 1):
        for place in members.tolist():
            region[place] = number

    def column(name: str, unit: str, values: Array) -> Column:
        return Column(name, unit, [reached(float(values[place])) for place in places])

    columns = [Column("design", "-", [int(place) + 1 for place in places])]
    columns += key_columns(answer.task.keys, [answer.values[place].tolist() for place in places])
    for name, flags in (("valid", answer.valid), ("passes", answer.passes)):
        columns.append(Column(name, "-", [str(bool(flags[place])).lower() for place in places]))
    columns.append(column("passing_share", "-", passing))
    columns.append(column("passing_share_within_tolerances", "-", answer.tolerated.share))
    columns.append(Column("region", "-", [region[place] for place in places]))
    for row, objective in enumerate(answer.task.file.minimise):
        name = objective_label(objective).replace(",", "")
        columns.append(
            column(f"least {name}", objective_unit(objective), judged.objectives[row, 0])
        )
    for row, requirement in enumerate(judged.requirements):
        name, of = requirement_label(requirement), requirement.condition.name
        columns.append(column(name, limit_unit(of), judged.values[row, 0]))
        columns.append(column(f"{name}: records too many", "-", judged.excess[row]))
    return columns


MARKS = (
    ("no valid case", "x", style.GREY), ("fails", "v", style.RED), ("passes", "o", style.BLUE),
)  # fmt: skip
MOST_PAIRS = 6
SHARES = (0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0)
"""Of the resamples, between which the region that passes changes its colour."""

BEST: dict[str, Any] = {
    "ls": "", "marker": "*", "ms": 9.0, "color": style.ORANGE, "mec": style.BLACK, "mew": 0.6,
    "zorder": 5, "clip_on": False, "label": "least that passes",
}  # fmt: skip
RINGED: dict[str, Any] = {
    "marker": "D", "ms": 10.0, "mfc": "none", "mew": 1.2, "label": "recommended",
}  # fmt: skip
"""Around the best design where both are one."""


def figures(answer: Answer, title: str) -> Mapping[str, Draw]:
    """What there is to draw, by the names of the files."""
    one = len(answer.task.unknowns) == 1
    found = {"requirements": requirements_figure} if one else {"region": region_figure}
    if len(answer.front) > 1:
        found["front"] = front_figure
    return {name: partial(draw, answer, title) for name, draw in found.items()}


def axis_label(key: str) -> str:
    """A key with its unit, for an axis."""
    return f"{symbol(key)} [{unit_of(key)}]"


def requirements_figure(answer: Answer, title: str) -> bytes:
    """One unknown: the value of every requirement against it, with its limit and the answer."""
    order = np.argsort(answer.values[:, 0])
    key, requirements = answer.values[order, 0], answer.judged.requirements

    def draw(figure: style.Figure) -> None:
        style.heading(figure, title, _counts(answer))
        grid = figure.subplots(len(requirements), 1, squeeze=False, sharex=True)[:, 0]
        for row, (axes, requirement) in enumerate(zip(grid, requirements, strict=True)):
            values = answer.judged.values[row, 0, order]
            shown = np.where(np.isfinite(values), values, np.nan)
            low, high = _band(answer, row, requirement)
            axes.fill_between(key, low[order], high[order], color=style.SKY, alpha=0.3, lw=0.0,
                              label="95 % interval")  # fmt: skip
            axes.plot(key, shown, "o", ms=3.0, color=style.BLUE, label="designs")
            axes.axhline(requirement.bound, color=style.RED, ls="--", label="admissible")
            if answer.best != NONE:
                axes.plot(answer.values[answer.best, 0], answer.judged.values[row, 0, answer.best],
                          **BEST)  # fmt: skip
                if answer.resamples:
                    axes.axvspan(*answer.interval(0), ymax=0.03, color=style.ORANGE, lw=0.0,
                                 label="of 95 % of the resamples")  # fmt: skip
            _draw_regions(axes, answer, row)
            top = np.nanmax([*np.nan_to_num(shown), 2.0 * requirement.bound, 1e-12])
            name = requirement.condition.name
            most = max(10.0 * requirement.bound, 0.0 if name == RATE else 1.0)
            end = 1.05 * float(min(top, most))
            axes.set_ylim(0.0, end)
            if (off := np.nan_to_num(values, nan=0.0) > end).any():
                axes.plot(key[off], np.full(off.sum(), end), "^", ms=4.0, color=style.RED,
                          clip_on=False, label="off the scale, or overturned")  # fmt: skip
            words = LIMITS[name].label if name in LIMITS else name
            others = {RATE: "overturned [1/year]"}
            known = LIMITS[name].axis_label if name in LIMITS else "share of records"
            axes.set_ylabel(others.get(name, known))
            axes.set_title(style.typeset(requirement_label(requirement).replace(name, words, 1)))
        grid[-1].set_xlabel(axis_label(answer.task.keys[0]))
        named = style.entries(grid)
        columns = 2 if style.narrow() else 4
        figure.legend(named.values(), named.keys(), loc="outside lower center", ncols=columns)

    return style.picture(draw, 1.9 + 2.3 * len(requirements))


def _draw_regions(axes: style.Axes, answer: Answer, row: int) -> None:
    """One unknown: regions of designs that hold, and what is recommended."""
    for number, region in enumerate(answer.regions):
        ends = answer.values[region, 0].min(), answer.values[region, 0].max()
        label = ("recommended region", "islands", None)[min(number, 2)]
        axes.axvspan(*ends, color=style.GREEN, alpha=0.08 if number else 0.25, lw=0.0, label=label)
    if answer.robust != NONE:
        judged, at = answer.judged_at(answer.robust)
        axes.plot(answer.values[answer.robust, 0], judged.values[row, 0, at],
                  **BEST | RINGED)  # fmt: skip


def _band(answer: Answer, row: int, requirement: Requirement) -> tuple[Array, Array]:
    """(designs,) ends of the interval of a value: exact for shares, else of the resamples."""
    if requirement.condition.name in EVENTS:
        shares = map(answer.share_beyond, answer.judged.beyond[row])
        low, high = np.array([(share.low, share.high) for share in shares]).T
        return low, high
    drawn = answer.judged.values[row, 1 : 1 + answer.resamples]
    if not len(drawn):
        return np.full(drawn.shape[1], np.nan), np.full(drawn.shape[1], np.nan)
    low, high = np.quantile(drawn, (0.025, 0.975), axis=0, method="inverted_cdf")
    return low, np.where(np.isfinite(high), high, 1e9)


def region_figure(answer: Answer, title: str) -> bytes:
    """Several unknowns: designs that pass and fail, for each pair of unknowns.

    With two of them the colour of a design is the share of the resamples in which it passes.
    """
    pairs = list(itertools.combinations(range(len(answer.task.unknowns)), 2))
    shown = pairs[:MOST_PAIRS]
    narrow = style.narrow()
    columns = 1 if narrow else min(3, len(shown))
    rows = math.ceil(len(shown) / columns)

    def draw(figure: style.Figure) -> None:
        more = f"{MOST_PAIRS} of {len(pairs)} pairs" if len(pairs) > MOST_PAIRS else ""
        style.heading(figure, title, _counts(answer), more)
        grid = figure.subplots(rows, columns, squeeze=False)
        for axes in grid.flat[len(shown) :]:
            axes.set_axis_off()
        for axes, (x, y) in zip(grid.flat, shown, strict=False):
            axes.locator_params(nbins=MOST_TICKS)
            by_share = len(pairs) == 1 and bool(answer.resamples)
            if by_share:
                _draw_shares(figure, axes, answer)
            hollow = (
                {"mfc": "none", "mew": 0.5, "ms": 4.6, "color": style.BLACK} if by_share else {}
            )
            _draw_designs(axes, answer, answer.values[:, [x, y]], MARKS, clip_on=False, **hollow)
            _mark(axes, answer, answer.values[:, [x, y]])
            axes.set(xlabel=axis_label(answer.task.keys[x]), ylabel=axis_label(answer.task.keys[y]))
        handles = grid[0][0].get_legend_handles_labels()
        in_row = 2 if narrow else 3 if len(handles[0]) > 5 else 5
        figure.legend(*handles, loc="outside lower center", ncols=in_row)

    return style.picture(draw, 1.1 + (4.2 if len(pairs) == 1 else 2.6) * rows)


def _draw_shares(figure: style.Figure, axes: style.Axes, answer: Answer) -> None:
    """The share of the resamples in which each design passes; nothing is said of those between."""
    from matplotlib import colormaps, rcParams
    from matplotlib.colors import BoundaryNorm

    colours = colormaps[rcParams["image.cmap"]]
    for name, marker, _ in MARKS[1:]:
        chosen = answer.valid & (answer.passes == (name == "passes"))
        x, y = answer.values[chosen, :2].T  # linked keys stand behind the two
        filled = axes.scatter(
            x, y, c=answer.passing_share[chosen], marker=marker, s=18.0,
            cmap=colours, norm=BoundaryNorm(SHARES, colours.N), lw=0.0, clip_on=False,
        )  # fmt: skip
    figure.colorbar(filled, ax=axes, label="share of resamples of the records that pass")


def _draw_designs(
    axes: style.Axes, answer: Answer, at: Array, marks: Sequence[tuple[str, str, str]], **look: Any
) -> None:
    """What became of the designs, at their rows of (designs, 2)."""
    became = np.where(answer.passes, "passes", np.where(answer.valid, "fails", "no valid case"))
    for name, marker, colour in marks:
        if len(chosen := at[became == name]):
            points: dict[str, Any] = {
                "ls": "",
                "ms": 3.2,
                "marker": marker,
                "color": colour,
                "label": name,
            }
            axes.plot(*chosen.T, **points | look)


def front_figure(answer: Answer, title: str) -> bytes:
    """Both objectives: no passing design lies left of and below the front."""
    objectives, labels = answer.judged.objectives[:, 0].copy(), []
    for place, objective in enumerate(answer.task.file.minimise):
        unit = objective_unit(objective)
        largest = np.abs(objectives[place][np.isfinite(objectives[place])]).max(initial=0.0)
        factor, prefix = style.engineering(float(largest)) if unit == "N" else (1.0, "")
        objectives[place] *= factor
        labels.append(f"{objective_label(objective)} [{prefix}{unit}]")

    def draw(figure: style.Figure) -> None:
        style.heading(figure, title, f"{len(answer.front)} designs on the Pareto front")
        axes = figure.subplots()
        _draw_designs(axes, answer, objectives.T, MARKS[1:2], ms=2.2, alpha=0.35)
        _draw_designs(axes, answer, objectives.T, MARKS[2:])
        front: dict[str, Any] = {"drawstyle": "steps-post", "label": "Pareto front"}
        axes.plot(*objectives[:, answer.front], color=style.BLACK, **front)
        _mark(axes, answer, objectives.T)
        axes.set(xlabel=labels[0], ylabel=labels[1])
        style.legend_above(axes, 4)

    return style.picture(draw, 4.2, 6.0)


def _mark(axes: style.Axes, answer: Answer, at: Array) -> None:
    """The best design, the recommended one and islands, at their rows of (designs, 2)."""
    if answer.islands:
        axes.plot(*at[answer.islands].T, **BEST | RINGED | {"marker": "s", "label": "islands"})
    if answer.robust != NONE:
        axes.plot(*at[answer.robust], **BEST | RINGED)
    if answer.best != NONE:
        axes.plot(*at[answer.best], **BEST)


def _counts(answer: Answer) -> str:
    return f"{int(answer.passes.sum())} of {len(answer.places)} designs pass"
