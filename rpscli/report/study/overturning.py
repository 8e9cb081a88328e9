"""The overturning table, laid out as Table 3 of the paper."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rpscli.report.figures import style
from rpscli.report.study.labels import key_columns, label, labels, plain
from rpscli.report.study.panels import left_out, over
from rpscli.report.study.report import Report
from rpscli.report.table import Column
from rpscli.sweep.reports.overturning import (
    Cell,
    OverturningOptions,
    OverturningTable,
    overturning_table,
)
from rpscli.sweep.statistics.fractiles import share

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST_ROWS = 60


def overturning_columns(table: OverturningTable) -> list[Column]:
    """One row a system; share, interval and counts for each value of the last axis."""
    columns = key_columns(table.row_keys, table.rows)
    for place, values in enumerate(table.columns):
        named = zip(table.column_keys, values, strict=True)
        name = ";".join(f"{key}={plain(value)}" for key, value in named) or "overturned"
        cells = [row[place] for row in table.cells]
        shares = [cell.overturned if cell else share(0, 0) for cell in cells]
        columns.append(Column(name, "-", [share.fraction for share in shares]))
        columns.append(Column(f"{name};low", "-", [share.low for share in shares]))
        columns.append(Column(f"{name};high", "-", [share.high for share in shares]))
        columns.append(Column(f"{name};number", "-", [share.number for share in shares]))
        columns.append(Column(f"{name};counted", "-", [share.of for share in shares]))
    counted = [sum(c.overturned.of for c in row if c) for row in table.cells]
    failed = [sum(c.failed for c in row if c) for row in table.cells]
    return [*columns, Column("counted", "-", counted), Column("failed", "-", failed)]


def overturning_figure(table: OverturningTable, title: str) -> bytes:
    """The table as a picture, darker where more overturn."""
    rows = table.rows[:MOST_ROWS]
    cells = table.cells[:MOST_ROWS]

    def draw(figure: Figure) -> None:
        notes = [left_out(table.failed)]
        if len(table.rows) > MOST_ROWS:
            notes.append(f"the first {MOST_ROWS} of {len(table.rows)} rows")
        words = "overturned: share, number, 95 % interval"
        style.heading(figure, title, over(table.pooled), words, *notes)
        axes = figure.subplots()
        shares = [[_share(cell) for cell in row] for row in cells]
        axes.imshow(shares, cmap="Blues", vmin=0.0, vmax=1.0, aspect="auto", alpha=0.75)
        for y, row in enumerate(cells):
            for x, cell in enumerate(row):
                first, second = _texts(cell)
                axes.text(x, y, first, ha="center", va="bottom")
                axes.text(x, y + 0.08, second, ha="center", va="top", fontsize=0.75 * style.small())
        axes.set_xticks(
            range(len(table.columns)),
            [style.typeset(_stacked(table.column_keys, values)) for values in table.columns],
        )
        names = [style.typeset(labels(table.row_keys, values)) for values in rows]
        axes.set_yticks(range(len(rows)), names)
        axes.tick_params(length=0, labeltop=True, labelbottom=False)
        axes.grid(visible=False)

    return style.picture(
        draw, 1.1 + 0.34 * len(rows), min(style.WIDTH, 3.4 + 1.25 * len(table.columns))
    )


def _share(cell: Cell | None) -> float:
    fraction = cell.overturned.fraction if cell else None
    return float("nan") if fraction is None else fraction


def _texts(cell: Cell | None) -> tuple[str, str]:
    """The share, and below it what it rests on."""
    if cell is None or not cell.overturned.of:
        return "-", ""
    found = cell.overturned
    return f"{found.fraction:.2f}", f"{found.number} of {found.of}, {found.interval}"


def _stacked(keys: tuple[str, ...], values: tuple[object, ...]) -> str:
    if not keys:
        return "all"
    return "\n".join(label(key, value) for key, value in zip(keys, values, strict=True))


REPORT = Report(
    options=OverturningOptions,
    numbers=lambda study, options: overturning_table(study.table, options),
    tables={"": overturning_columns},
    figure=overturning_figure,
    notes=lambda table: table.notes,
)
