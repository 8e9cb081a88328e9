"""Tables of a statistic: the share that overturns (paper, Table
3), or that of any demand.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import takewhile
from typing import Any, NamedTuple

import numpy as np
from pydantic import Field

from rpscli.case.study.reports import ReportOptions, VariedKeys
from rpscli.report.figures import style
from rpscli.report.figures.look import FONT_SIZE, SMALL
from rpscli.report.study.panels import first_of, in_sheets, left_out, over
from rpscli.report.study.report import (
    DemandName,
    Found,
    Report,
    StatisticOrShare,
    key_columns,
    reached,
)
from rpscli.report.table import Column
from rpscli.sweep.evaluation import SCALARS
from rpscli.sweep.names import label_parts, labels, tick_of
from rpscli.sweep.statistics.grouping import (
    Grouping,
    Histories,
    grouping,
    shown_keys,
    statistic_words,
)
from rpscli.sweep.table import Array, StoredPoints, groups, leading_keys
from rpscli.sweep.table import PointTable as Points

MOST_ROWS = 60
MOST_COLUMNS = 12
SMALLER = 0.75  # second texts of cells, as a part of small letters
LEAST_WIDTH = 0.55  # of a column, and height of a line of its labels [in]
LINE = 0.13
LOW_ROW = 0.19  # height of a row of single texts [in]


class OverturningOptions(ReportOptions):
    """Share of the points that overturn, as a table."""

    rows: VariedKeys | None = None
    """varied keys down the table; all but the columns'"""
    columns: VariedKeys | None = None
    """varied keys across; those of the last axis"""


class TableOptions(OverturningOptions):
    """A statistic of a demand, or the share that overturns, as a table."""

    result: DemandName = Field(
        "rotation_ratio", description="of which the statistic is taken"
    )
    statistic: StatisticOrShare = Field(
        "median",
        description=(
            "of the histories of a cell; an overturned one is larger than any demand,"
            " but for the mean, which is that of survivors; overturned: the share of"
            " them, of any result"
        ),
    )


DARKEST = 1.8
"""Shade of the map's end, over that of a whole share: black letters stay legible."""


class Cell(NamedTuple):
    """A cell of a table, of some histories."""

    numbers: Mapping[
        str, float | int | str | None
    ]  # by what follows the name of their column
    texts: tuple[str, str]  # lines in the picture
    shade: float  # from 0 to 1


def _share(histories: Histories) -> Cell:
    """Share that overturned."""
    share = histories.overturned
    ends = {";low": share.low, ";high": share.high}
    counts = {
        ";number": share.number,
        ";counted": share.of,
        f";{share.by}": share.recordings,
    }
    texts = (
        "-" if share.fraction is None else f"{share.fraction:.2f}",
        f"{share.number} of {share.of}, {share.interval}",
    )
    return Cell({"": share.fraction, **ends, **counts}, texts, share.fraction or 0.0)


def _statistic(
    histories: Histories, values: Array, wanted: float | str, largest: float
) -> Cell:
    """A statistic of a demand, whose largest value of what stood is known."""
    found = histories.statistic(values, wanted)
    fallen = histories.overturned.number
    numbers = {"": reached(found), ";counted": len(histories), ";overturned": fallen}
    text = "-" if np.isnan(found) else "overturned" if np.isinf(found) else f"{found:.3g}"
    shade = 0.8 if np.isinf(found) else float(0.6 * found / largest)
    return Cell(numbers, (text, f"{fallen} of {len(histories)} overturned"), shade)


class Subject(NamedTuple):
    """The result of which cells are made: name, unit, words of the picture and of a head,
    and how.
    """

    result: str
    unit: str
    words: str
    head: str
    make: Callable[[Histories], Cell]


def _subject(table: Points, options: TableOptions) -> Subject:
    """A statistic of a demand, or the share that overturned."""
    if options.statistic == "overturned":
        words = "overturned: share, number, 95 % interval"
        every = Histories(table, (), np.arange(len(table)))
        if behind := every.overturned.behind:
            words += f", which counts{behind.removeprefix(' from')}"
        return Subject("overturned", "-", words, "overturned", _share)
    quantity = SCALARS["timehistory"][options.result]
    values = table.columns[options.result]
    stood = values[np.isfinite(values) & ~table.overturned]
    largest = stood.max(initial=0.0) or 1.0
    words = f"{quantity.in_unit(quantity.unit)}: {statistic_words(options.statistic)}"
    make = partial(_statistic, values=values, wanted=options.statistic, largest=largest)
    head = f"{quantity.label}, {statistic_words(options.statistic)}"
    return Subject(options.result, quantity.unit, words, head, make)


def table_report(study: StoredPoints, options: TableOptions) -> Found:
    """Each system, at each intensity unless the study says otherwise."""
    table = study.table
    layout = study.table.layout
    subject = _subject(table, options)
    across = options.columns
    if across is None:
        across = tuple(
            key for key in leading_keys(layout)[-1:] if key not in (options.rows or ())
        )
    rows = grouping(table, options.rows, across)
    column_keys = shown_keys(layout, across)
    columns = [group.values for group in groups(layout, across)]
    nothing = subject.make(Histories(table, (), np.empty(0, dtype=np.int64)))
    cells = []
    for row in rows.groups:
        # by their text: a value may be a list, of devices or of masses
        found = {repr(part.values): subject.make(part) for part in row.parts(across)}
        cells.append([found.get(repr(values), nothing) for values in columns])

    written = key_columns(rows.keys, [row.values for row in rows.groups])
    for place, values_across in enumerate(columns):
        named = zip(column_keys, values_across, strict=True)
        name = ";".join(f"{key}={tick_of(key, value)}" for key, value in named)
        head = ": ".join(filter(None, (labels(column_keys, values_across), subject.head)))
        of_column = [row[place] for row in cells]
        written += _cell_columns(subject, (name, head), of_column, nothing)
    written.append(Column("counted", "-", [len(row) for row in rows.groups], "histories"))
    written.append(Column("failed", "-", [row.failed for row in rows.groups]))

    heads = ["\n".join(label_parts(column_keys, values)) or "all" for values in columns]
    above = [over(rows.pooled), subject.words, left_out(rows.failed)]
    whole = [labels(rows.keys, row.values) for row in rows.groups]
    shown = ShownTable(_row_names(rows), heads, cells, above, whole)
    return Found({"": written}, shown, rows.notes)


def _cell_columns(
    subject: Subject, names: tuple[str, str], cells: Sequence[Cell], nothing: Cell
) -> list[Column]:
    """The numbers of one column of the table, whose name is for files and for readers;
    those that `nothing` has are in each.
    """
    name, head = names
    return [
        Column(
            (name or subject.result) + suffix,
            "-" if suffix else subject.unit,
            [cell.numbers[suffix] for cell in cells],
            head,
        )
        for suffix in nothing.numbers
    ]


def _row_names(rows: Grouping) -> list[str]:
    """Names of rows; those that begin like the row before tell how they go on."""
    names = []
    before = list[str]()
    for row in rows.groups:
        parts = label_parts(rows.keys, row.values)
        same = takewhile(lambda pair: len({*pair}) == 1, zip(parts, before, strict=False))
        names.append(", ".join(parts[len([*same]) :]))
        before = parts
    return names


def overturning(study: StoredPoints, options: OverturningOptions) -> Found:
    """Shares that overturned."""
    return table_report(
        study, TableOptions.model_construct(**dict(options), statistic="overturned")
    )


@dataclass(frozen=True, eq=False)
class ShownTable:
    """A table as its picture shows it, and remarks above it."""

    names: list[str]
    heads: list[str]
    cells: list[list[Cell]]
    above: list[str]
    whole: list[str]  # names of rows that do not go on from the row before
    part: str = ""  # of several sheets

    def __call__(self, title: str) -> style.Draw:
        """Its picture under a title."""
        return partial(_picture, self, title)

    @property
    def width(self) -> float:
        """That of a figure of ours [in]."""
        return min(style.WIDTH, 3.4 + 1.25 * len(self.heads))

    def sheets(self, room: float) -> list[ShownTable]:
        """The table in parts of at most a page, where figures are so wide [in]."""
        fitted = _fitted(self, min(room, self.width))
        count = len(fitted.names)
        parts = in_sheets(count, 1, fitted.height, _around(fitted))
        if len(parts) == 1:
            return [self]
        left = first_of(count, len(self.cells), "rows")
        return [
            replace(
                self,
                names=[self.whole[part.start], *self.names[part][1:]],
                cells=self.cells[part],
                whole=self.whole[part],
                part=", ".join(filter(None, (f"sheet {number} of {len(parts)}", left))),
            )
            for number, part in enumerate(parts, start=1)
        ]


def _around(fitted: _Fitted) -> float:
    """Height of heading and labels of columns [in]."""
    return 0.6 + LINE * _lines(fitted.heads)


class _Fitted(NamedTuple):
    """The first rows and columns of a table, with texts folded into their cells."""

    names: list[str]
    heads: list[str]
    cells: list[list[Cell]]
    below: list[list[str]]  # second texts of the cells
    room: float  # width of a column [in]
    height: float  # of a row [in]

    def lower(self) -> _Fitted:
        """Rows without second texts, where these leave no room for all rows."""
        below = [[""] * len(row) for row in self.below]
        height = max(LOW_ROW, 0.1 + LINE * _lines(self.names))
        return self._replace(below=below, height=min(height, self.height))


SIZE = SMALL * FONT_SIZE


def _wide(texts: Iterable[str]) -> float:
    """Width of the widest text [in]."""
    return max((style.width_of(text, SIZE) for text in texts if text), default=0.0)


def _lines(texts: Iterable[str]) -> int:
    """Lines of the text that has most of them."""
    return 1 + max(text.count("\n") for text in texts)


def _fitted(shown: ShownTable, width: float) -> _Fitted:
    """Rows and columns for a figure of some width [in], which may be higher than it is."""
    # Names may be as wide as the figure; what would run into the next column goes on
    # below.
    names = [
        style.folded(style.typeset(name), 0.4 * width, SIZE)
        for name in shown.names[:MOST_ROWS]
    ]
    beside = 0.4 + _wide(names)
    fitting = int((width - beside) / LEAST_WIDTH)
    columns = max(1, min(MOST_COLUMNS, len(shown.heads), fitting))
    room = max((width - beside) / columns, 0.2)
    cells = [row[:columns] for row in shown.cells[: len(names)]]
    heads = [
        style.folded(style.typeset(head), 0.95 * room, SIZE)
        for head in shown.heads[:columns]
    ]
    below = [
        [style.folded(cell.texts[1], 0.95 * room / SMALLER, SIZE) for cell in row]
        for row in cells
    ]
    height = max(0.19 + 0.11 * max(map(_lines, below)), 0.1 + LINE * _lines(names))
    return _Fitted(names, heads, cells, below, room, height)


def _picture(shown: ShownTable, title: str, figure: style.Figure) -> None:
    """The first rows and columns, on cells that are the darker
    the larger their numbers.
    """
    own = shown.width
    fitted = _fitted(shown, style.room(figure, own))
    columns = len(fitted.heads)
    other = _around(fitted)
    most = len(fitted.names)
    alone = ""
    if style.given(figure):
        room = style.inches(figure)[1] - other
        if most * fitted.height > room:
            fitted = fitted.lower()
            alone = "in cells the first value alone"
        most = min(most, max(1, int(room / fitted.height)))
    counts = ("rows", most, len(shown.cells)), ("columns", columns, len(shown.heads))
    cut = [first_of(some, of, what) for what, some, of in counts]
    words = (title, shown.part, *cut, *shown.above, alone)
    style.begin(figure, words, other + most * fitted.height, own)
    axes = figure.subplots()
    shades = [[cell.shade for cell in row] for row in fitted.cells[:most]]
    axes.pcolormesh(shades, cmap="Blues", vmin=0.0, vmax=DARKEST, alpha=0.75)
    for y, x in np.ndindex(most, columns):
        _write_cell(axes, fitted, y, x)
    axes.set_xticks(np.arange(columns) + 0.5, fitted.heads)
    axes.set_yticks(np.arange(most) + 0.5, fitted.names[:most])
    axes.tick_params(length=0, labeltop=True, labelbottom=False, labelsize=SIZE)
    axes.invert_yaxis()
    axes.grid(visible=False)


def _write_cell(axes: style.Axes, fitted: _Fitted, y: int, x: int) -> None:
    """Both texts of a cell, as large as there is room for them."""
    inside: dict[str, Any] = {"ha": "center", "in_layout": False}
    height = fitted.height
    first = fitted.cells[y][x].texts[0]
    further = fitted.below[y][x]
    up = 0.055 * _lines([further]) * bool(further)
    size = SIZE * min(1.0 / SMALL, 0.95 * fitted.room / _wide([first]))
    at = y + 0.5
    axes.text(
        x + 0.5, at - (up - 0.07) / height, first, va="bottom", fontsize=size, **inside
    )
    axes.text(
        x + 0.5, at - (up - 0.08) / height, further, va="top", fontsize=SMALLER * SIZE,
        **inside,
    )  # fmt: skip


TABLE = Report(TableOptions, table_report, results=lambda options: [options.result])
OVERTURNING = Report(OverturningOptions, overturning)
