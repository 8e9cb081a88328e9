"""Tables of a statistic: the share that overturns (paper, Table 3), or that of any demand."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from textwrap import fill
from typing import Any, NamedTuple

import numpy as np
from pydantic import Field

from rpscli.case.study.reports import ReportOptions, VariedKeys
from rpscli.report.figures import style
from rpscli.report.figures.look import SMALL
from rpscli.report.study.labels import key_columns, label, labels, plain
from rpscli.report.study.panels import left_out, over
from rpscli.report.study.report import DemandName, Found, Report, StatisticOrShare, preset
from rpscli.report.study.statistics import reached
from rpscli.report.table import Column
from rpscli.sweep.evaluation import SCALARS
from rpscli.sweep.statistics.grouping import Histories, grouping, shown_keys, statistic_words
from rpscli.sweep.table import Array, StudyResults, groups, leading_keys

MOST_ROWS = 60
MOST_COLUMNS = 12
SMALLER = 0.75
"""Second texts of cells, as a part of small letters."""


class OverturningOptions(ReportOptions):
    """Share of the points that overturn, as a table."""

    rows: VariedKeys | None = None
    """varied keys down the table; all but the columns'"""
    columns: VariedKeys | None = None
    """varied keys across; those of the last axis"""


class TableOptions(OverturningOptions):
    """A statistic of a demand, or the share that overturns, as a table."""

    result: DemandName = Field("rotation_ratio", description="of which the statistic is taken")
    statistic: StatisticOrShare = Field(
        "median",
        description="of the histories of a cell; an overturned one is larger than any demand, but"
        " for the mean, which is that of survivors; overturned: the share of them, of any result",
    )


class Cell(NamedTuple):
    """What a table has of some histories.

    `numbers` are by what follows the name of their column, `texts` two lines in the picture, and
    `shade` goes from 0 to 1.
    """

    numbers: Mapping[str, float | int | str | None]
    texts: tuple[str, str]
    shade: float


def _share(histories: Histories) -> Cell:
    """How many overturned."""
    share = histories.overturned
    ends = {";low": share.low, ";high": share.high}
    counts = {";number": share.number, ";counted": share.of, f";{share.by}": share.recordings}
    texts = (
        "-" if share.fraction is None else f"{share.fraction:.2f}",
        f"{share.number} of {share.of}, {share.interval}",
    )
    return Cell({"": share.fraction, **ends, **counts}, texts, share.fraction or 0.0)


def _statistic(histories: Histories, values: Array, wanted: float | str, largest: float) -> Cell:
    """A statistic of a demand, whose largest value of what stood is known."""
    found, fallen = histories.statistic(values, wanted), histories.overturned.number
    numbers = {"": reached(found), ";counted": len(histories), ";overturned": fallen}
    text = "-" if np.isnan(found) else "overturned" if np.isinf(found) else f"{found:.3g}"
    shade = 0.8 if np.isinf(found) else float(0.6 * found / largest)
    return Cell(numbers, (text, f"{fallen} of {len(histories)} overturned"), shade)


def table_report(study: StudyResults, options: TableOptions) -> Found:
    """Each system, at each intensity unless the study says else."""
    table, layout = study.table, study.table.layout
    make: Callable[[Histories], Cell] = _share
    result, unit, words = "overturned", "-", "overturned: share, number, 95 % interval"
    if options.statistic != "overturned":
        quantity, values = SCALARS["timehistory"][options.result], table.columns[options.result]
        stood = values[np.isfinite(values) & ~table.overturned]
        largest = stood.max(initial=0.0) or 1.0
        result, unit = options.result, quantity.unit
        words = f"{quantity.in_unit(unit)}: {statistic_words(options.statistic)}"
        make = partial(_statistic, values=values, wanted=options.statistic, largest=largest)
    elif behind := Histories(table, (), np.arange(len(table))).overturned.behind:
        words += f", which counts{behind.removeprefix(' from')}"
    across = options.columns
    if across is None:
        across = tuple(key for key in leading_keys(layout)[-1:] if key not in (options.rows or ()))
    rows, column_keys = grouping(table, options.rows, across), shown_keys(layout, across)
    columns = [group.values for group in groups(layout, across)]
    nothing = make(Histories(table, (), np.empty(0, dtype=np.int64)))
    cells: list[list[Cell | None]] = []
    for row in rows.groups:
        # by their text: a value may be a list, of devices or of masses
        found = {repr(part.values): make(part) for part in row.parts(across)}
        cells.append([found.get(repr(values)) for values in columns])
    written = key_columns(rows.keys, [row.values for row in rows.groups])
    for place, values_across in enumerate(columns):
        named = zip(column_keys, values_across, strict=True)
        name = ";".join(f"{key}={plain(value)}" for key, value in named) or result
        written += [
            Column(
                name + suffix,
                "-" if suffix else unit,
                [(row[place] or nothing).numbers[suffix] for row in cells],
            )
            for suffix in nothing.numbers
        ]
    written.append(Column("counted", "-", [len(row) for row in rows.groups]))
    written.append(Column("failed", "-", [row.failed for row in rows.groups]))

    heads = ["\n".join(map(label, column_keys, values)) or "all" for values in columns]
    names = [labels(rows.keys, row.values) for row in rows.groups]
    counts = ("rows", MOST_ROWS, len(names)), ("columns", MOST_COLUMNS, len(heads))
    notes = [f"the first {most} of {of} {what}" for what, most, of in counts if most < of]
    above = [over(rows.pooled), words, left_out(rows.failed), *notes]
    return Found({"": written}, partial(_picture, names, heads, cells, above), rows.notes)


def _picture(
    names: list[str],
    heads: list[str],
    cells: list[list[Cell | None]],
    above: list[str],
    title: str,
) -> bytes:
    """The first rows and columns, on cells that are the darker the larger their numbers."""
    names = [style.typeset(name) for name in names[:MOST_ROWS]]
    heads = [style.typeset(head) for head in heads[:MOST_COLUMNS]]
    drawn = [[cell or Cell({}, ("-", ""), np.nan) for cell in row] for row in cells]
    drawn = [row[:MOST_COLUMNS] for row in drawn[:MOST_ROWS]]
    width = min(style.WIDTH, 3.4 + 1.25 * len(heads))
    names = [_folded(name, 12) for name in names] if style.narrow() else names
    beside = 0.3 + max(map(len, "\n".join(names).split("\n"))) / style.LETTERS_PER_INCH
    # Names may be as wide as the figure.
    letters = max(int(style.LETTERS_PER_INCH * (style.room(width) - beside) / len(heads)), 1)
    # What would run into the next column, or off the figure, goes on in further lines.
    heads = ["\n".join(fill(line, letters) for line in head.split("\n")) for head in heads]
    below = [[_folded(cell.texts[1], int(letters / SMALLER)) for cell in row] for row in drawn]
    further = max((text.count("\n") for row in below for text in row), default=0)
    height = 0.34 + 0.11 * further  # of a row

    def draw(figure: style.Figure) -> None:
        style.heading(figure, title, *above)
        axes, small = figure.subplots(), style.small()
        shades = [[cell.shade for cell in row] for row in drawn]
        axes.imshow(shades, cmap="Blues", vmin=0.0, vmax=1.0, aspect="auto", alpha=0.75)
        inside: dict[str, Any] = {"ha": "center", "in_layout": False}
        for y, x in np.ndindex(len(drawn), len(heads)):
            first, middle = drawn[y][x].texts[0], y - 0.055 * further / height
            size = small * min(1.0 / SMALL, letters / len(first))
            axes.text(x, middle, first, va="bottom", fontsize=size, **inside)
            size = SMALLER * small
            axes.text(x, middle + 0.08, below[y][x], va="top", fontsize=size, **inside)
        axes.set_xticks(range(len(heads)), heads)
        axes.set_yticks(range(len(names)), names)
        axes.tick_params(length=0, labeltop=True, labelbottom=False)
        axes.grid(visible=False)

    return style.picture(draw, 1.1 + height * len(drawn), width)


def _folded(text: str, letters: int) -> str:
    """In lines of so many letters, of which a comma ends the first ones."""
    if len(text) <= letters:
        return text
    return "\n".join(fill(part, letters) for part in text.split(", "))


TABLE = Report(TableOptions, table_report, results=lambda options: [options.result])
OVERTURNING = preset(TABLE, OverturningOptions, statistic="overturned")
