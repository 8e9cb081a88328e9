"""The overturning table, laid out as Table 3 of the paper."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rpscli.report.figures import style
from rpscli.report.files.csv_text import Column
from rpscli.report.study.labels import key_columns, label, labels, plain
from rpscli.report.study.panels import left_out
from rpscli.report.study.report import Report
from rpscli.sweep.reports.overturning import OverturningOptions, OverturningTable, overturning_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST_ROWS = 60


def overturning_columns(table: OverturningTable) -> list[Column]:
    """One row a system, one column for each value of the last axis, shares from 0 to 1."""
    columns = key_columns(table.row_keys, table.rows)
    for place, values in enumerate(table.columns):
        named = zip(table.column_keys, values, strict=True)
        name = ";".join(f"{key}={plain(value)}" for key, value in named) or "overturned"
        cells = [row[place] for row in table.cells]
        columns.append(Column(name, "-", [cell.fraction if cell else None for cell in cells]))
    for name in ("counted", "failed"):
        counts = [sum(getattr(c, name) for c in row if c) for row in table.cells]
        columns.append(Column(name, "-", counts))
    return columns


def overturning_figure(table: OverturningTable, title: str) -> bytes:
    """The table as a picture, darker where more overturn."""
    rows = table.rows[:MOST_ROWS]
    cells = table.cells[:MOST_ROWS]

    def draw(figure: Figure) -> None:
        notes = [left_out(table.failed)]
        if len(table.rows) > MOST_ROWS:
            notes.append(f"the first {MOST_ROWS} of {len(table.rows)} rows")
        style.heading(figure, title, "share of points that overturn", *notes)
        axes = figure.subplots()
        shares = [[_share(cell) for cell in row] for row in cells]
        axes.imshow(shares, cmap="Blues", vmin=0.0, vmax=1.0, aspect="auto", alpha=0.75)
        for y, row in enumerate(shares):
            for x, share in enumerate(row):
                text = "-" if share != share else f"{share:.2f}"  # noqa: PLR0124 -- NaN
                axes.text(x, y, text, ha="center", va="center")
        axes.set_xticks(
            range(len(table.columns)),
            [_stacked(table.column_keys, values) for values in table.columns],
        )
        axes.set_yticks(range(len(rows)), [labels(table.row_keys, values) for values in rows])
        axes.tick_params(length=0, labeltop=True, labelbottom=False)
        axes.grid(visible=False)

    return style.picture(
        draw, 1.1 + 0.28 * len(rows), min(style.WIDTH, 2.6 + 1.1 * len(table.columns))
    )


def _share(cell: object) -> float:
    fraction = getattr(cell, "fraction", None)
    return float("nan") if fraction is None else float(fraction)


def _stacked(keys: tuple[str, ...], values: tuple[object, ...]) -> str:
    if not keys:
        return "all"
    return "\n".join(label(key, value) for key, value in zip(keys, values, strict=True))


REPORT = Report(
    options=OverturningOptions,
    numbers=lambda study, options: overturning_table(study.table, options),
    tables={"": overturning_columns},
    figure=overturning_figure,
)
