"""Tables of a statistic: the share that overturns (paper, Table 3), or that of any demand."""

from __future__ import annotations

from collections.abc import Callable
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
from rpscli.sweep.table import StudyResults, Table, groups, leading_keys

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


class Shown(NamedTuple):
    """What a table shows of the histories of a cell.

    `name` and `unit` are those of its numbers, `words` stand above the picture. `numbers` are a
    cell's by what follows the name of its column, `texts` two lines in the picture, and `shade`
    goes from 0 to 1.
    """

    name: str
    unit: str
    words: str
    numbers: Callable[[Histories], dict[str, float | int | str | None]]
    texts: Callable[[Histories], tuple[str, str]]
    shade: Callable[[Histories], float]


def _share(table: Table) -> Shown:
    """How many overturned."""

    def numbers(cell: Histories) -> dict[str, float | int | str | None]:
        share = cell.overturned
        ends = {";low": share.low, ";high": share.high}
        counts = {";number": share.number, ";counted": share.of, f";{share.by}": share.recordings}
        return {"": share.fraction, **ends, **counts}

    def texts(cell: Histories) -> tuple[str, str]:
        share = cell.overturned
        return f"{share.fraction:.2f}", f"{share.number} of {share.of}, {share.interval}"

    words = "overturned: share, number, 95 % interval"
    if behind := Histories(table, (), np.arange(len(table))).overturned.behind:
        words += f", which counts{behind.removeprefix(' from')}"
    return Shown("overturned", "-", words, numbers, texts, lambda c: c.overturned.fraction or 0.0)


def _statistic(table: Table, options: TableOptions) -> Shown:
    """A statistic of a demand."""
    values = table.columns[options.result]
    known = values[np.isfinite(values) & ~table.overturned]
    largest = known.max(initial=0.0) or 1.0

    def statistic(cell: Histories) -> float:
        return cell.statistic(values, options.statistic)

    def numbers(cell: Histories) -> dict[str, float | int | str | None]:
        fallen = cell.overturned.number
        return {"": reached(statistic(cell)), ";counted": len(cell), ";overturned": fallen}

    def texts(cell: Histories) -> tuple[str, str]:
        found, fallen = statistic(cell), f"{cell.overturned.number} of {len(cell)} overturned"
        words = "overturned" if np.isinf(found) else f"{found:.3g}"
        return "-" if np.isnan(found) else words, fallen

    quantity = SCALARS["timehistory"][options.result]
    words = f"{quantity.in_unit(quantity.unit)}: {statistic_words(options.statistic)}"

    def shade(cell: Histories) -> float:
        found = statistic(cell)
        return 0.8 if np.isinf(found) else float(0.6 * found / largest)

    return Shown(options.result, quantity.unit, words, numbers, texts, shade)


def table_report(study: StudyResults, options: TableOptions) -> Found:
    """Each system, at each intensity unless the study says else."""
    table = study.table
    shown = _share(table) if options.statistic == "overturned" else _statistic(table, options)
    return _table(table, options, shown)


def _table(table: Table, options: OverturningOptions, shown: Shown) -> Found:
    layout = table.layout
    across = options.columns
    if across is None:
        across = tuple(key for key in leading_keys(layout)[-1:] if key not in (options.rows or ()))
    rows, column_keys = grouping(table, options.rows, across), shown_keys(layout, across)
    columns = [group.values for group in groups(layout, across)]
    cells: list[list[Histories | None]] = []
    for row in rows.groups:
        # by their text: a value may be a list, of devices or of masses
        found = {repr(cell.values): cell for cell in row.parts(across)}
        cells.append([found.get(repr(values)) for values in columns])
    nothing = Histories(table, (), np.empty(0, dtype=np.int64))
    written = key_columns(rows.keys, [row.values for row in rows.groups])
    for place, values in enumerate(columns):
        named = zip(column_keys, values, strict=True)
        name = ";".join(f"{key}={plain(value)}" for key, value in named) or shown.name
        numbers = [shown.numbers(row[place] or nothing) for row in cells]
        for suffix in numbers[0]:
            unit = "-" if suffix else shown.unit
            written.append(Column(name + suffix, unit, [cell[suffix] for cell in numbers]))
    written.append(Column("counted", "-", [len(row) for row in rows.groups]))
    written.append(Column("failed", "-", [row.failed for row in rows.groups]))

    heads = [
        style.typeset("\n".join(map(label, column_keys, values)) or "all")
        for values in columns[:MOST_COLUMNS]
    ]
    names = [style.typeset(labels(rows.keys, row.values)) for row in rows.groups[:MOST_ROWS]]
    drawn = [row[:MOST_COLUMNS] for row in cells[:MOST_ROWS]]
    shades = [[shown.shade(cell) if cell else np.nan for cell in row] for row in drawn]
    texts = [[shown.texts(cell) if cell else ("-", "") for cell in row] for row in drawn]
    width = min(style.WIDTH, 3.4 + 1.25 * len(heads))

    def picture(title: str) -> bytes:
        rows_named = [_folded(name, 12) for name in names] if style.narrow() else names
        beside = 0.3 + max(map(len, "\n".join(rows_named).split("\n"))) / style.LETTERS_PER_INCH
        # Names may be as wide as the figure.
        letters = max(int(style.LETTERS_PER_INCH * (style.room(width) - beside) / len(heads)), 1)
        # What would run into the next column, or off the figure, goes on in further lines.
        above = ["\n".join(fill(line, letters) for line in head.split("\n")) for head in heads]
        below = [[_folded(text, int(letters / SMALLER)) for _, text in row] for row in texts]
        further = max((text.count("\n") for row in below for text in row), default=0)
        height = 0.34 + 0.11 * further  # of a row

        def draw(figure: style.Figure) -> None:
            counts = (("rows", len(drawn), len(cells)), ("columns", len(heads), len(columns)))
            notes = [f"the first {n} of {all_} {name}" for name, n, all_ in counts if n < all_]
            notes.insert(0, left_out(rows.failed))
            style.heading(figure, title, over(rows.pooled), shown.words, *notes)
            axes = figure.subplots()
            axes.imshow(shades, cmap="Blues", vmin=0.0, vmax=1.0, aspect="auto", alpha=0.75)
            small = style.small()
            inside: dict[str, Any] = {"ha": "center", "in_layout": False}
            for y, x in np.ndindex(len(texts), len(heads)):
                first, middle = texts[y][x][0], y - 0.055 * further / height
                size = small * min(1.0 / SMALL, letters / len(first))
                axes.text(x, middle, first, va="bottom", fontsize=size, **inside)
                size = SMALLER * small
                axes.text(x, middle + 0.08, below[y][x], va="top", fontsize=size, **inside)
            axes.set_xticks(range(len(heads)), above)
            axes.set_yticks(range(len(names)), rows_named)
            axes.tick_params(length=0, labeltop=True, labelbottom=False)
            axes.grid(visible=False)

        return style.picture(draw, 1.1 + height * len(texts), width)

    return Found({"": written}, picture, rows.notes)


def _folded(text: str, letters: int) -> str:
    """In lines of so many letters, of which a comma ends the first ones."""
    if len(text) <= letters:
        return text
    return "\n".join(fill(part, letters) for part in text.split(", "))


TABLE = Report(TableOptions, table_report, results=lambda options: [options.result])
OVERTURNING = preset(TABLE, OverturningOptions, statistic="overturned")
