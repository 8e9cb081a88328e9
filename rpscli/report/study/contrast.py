"""Maps of how far results change with one key: a colour for each pair of systems."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal

import numpy as np

from rpscli.analyses.result_quantities import LIMITED
from rpscli.report.figures import style
from rpscli.report.study.labels import Values, key_columns, labels, plain, symbol
from rpscli.report.study.panels import left_out
from rpscli.report.study.report import Report
from rpscli.report.table import Column
from rpscli.sweep.intensities import unit_of
from rpscli.sweep.reports.contrast import (
    Contrast,
    ContrastOptions,
    ContrastReport,
    contrast_report,
)
from rpscli.sweep.reports.rotation import unknown_reference
from rpscli.sweep.table import Array

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SCALES = (2.0, 5.0, 10.0, 20.0, 30.0)
"""Changes at which the colours may end [%]."""
FEW_COLUMNS = 4
"""Of a map, whose names have room side by side."""

NAMES = {quantity.name: quantity.label for quantity in LIMITED}


def contrast_columns(report: ContrastReport) -> list[Column]:
    """One row a cell: fractiles of the ratios, shares that overturn."""
    options, cells = report.options, report.cells
    keys = (*report.panel_keys, *options.rows, *options.columns)
    columns = key_columns(keys, [cell.values for cell in cells])
    columns.append(Column("pairs", "-", [cell.pairs for cell in cells]))
    for place, name in enumerate(options.results):
        for fractile, words in enumerate(("16 %", "median", "84 %")):
            ratios = [float(cell.ratios[place, fractile]) for cell in cells]
            columns.append(Column(f"ratio of {name}; {words}", "-", ratios))
    return [
        *columns,
        Column("overturned", "-", [cell.overturned for cell in cells]),
        Column("reference_overturned", "-", [cell.reference_overturned for cell in cells]),
    ]


def contrast_figure(report: ContrastReport, title: str) -> bytes:
    """One map a result and group of systems; the last row of maps is overturning."""
    options, ahead = report.options, len(report.panel_keys)
    down = ahead + len(options.rows)
    panels, rows, columns = (
        list(dict.fromkeys(cell.values[part] for cell in report.cells))
        for part in (slice(ahead), slice(ahead, down), slice(down, None))
    )
    names = [*(NAMES[name] for name in options.results), "overturned, of 100"]
    changes = np.full((len(names), len(panels), len(rows), len(columns)), np.nan)
    for cell in report.cells:
        values = cell.values
        place = panels.index(values[:ahead]), rows.index(values[ahead:down])
        changes[:, *place, columns.index(values[down:])] = _changes(cell)

    largest = np.nanmax(np.abs(changes), initial=0.0)
    strongest = next((end for end in SCALES if end >= largest), SCALES[-1])

    ends: Literal["both", "neither"] = "both" if largest > strongest else "neither"

    def draw(figure: Figure) -> None:
        about = f"{plain(report.value)} over {plain(report.reference)}, median over the motions"
        style.heading(figure, title, about, left_out(report.failed))
        grid = figure.subplots(len(names), len(panels), squeeze=False, sharex=True, sharey=True)
        for (line, place), axes in np.ndenumerate(grid):
            image = axes.imshow(
                changes[line, place], cmap="RdBu_r", vmin=-strongest, vmax=strongest, aspect="auto"
            )
            axes.grid(visible=False)
            axes.tick_params(length=0)
            if line == 0:
                axes.set_title(labels(report.panel_keys, panels[place]))
            if place == 0:
                axes.set_ylabel(f"{names[line]}\n{_named(options.rows)}")
        small = style.small()
        turned = 90 if len(columns) > FEW_COLUMNS else 0
        ticks = [_ticked(column) for column in columns]
        for axes in grid[:, 0]:
            axes.set_yticks(range(len(rows)), [_ticked(row) for row in rows], fontsize=small)
        for axes in grid[-1]:
            axes.set_xticks(range(len(columns)), ticks, fontsize=small, rotation=turned)
            axes.set_xlabel(_named(options.columns))
        figure.colorbar(image, ax=grid, label="change [%]", shrink=0.6, extend=ends)

    return style.picture(draw, 1.0 + len(names) * max(1.4, 0.12 * len(rows)))


def _changes(cell: Contrast) -> Array:
    """Of each result and of the share that overturns [%]."""
    overturning = cell.overturned - cell.reference_overturned
    return 100.0 * np.append(cell.ratios[:, 1] - 1.0, overturning)


def _named(keys: Sequence[str]) -> str:
    return ", ".join(
        symbol(key) if unit_of(key) == "-" else f"{symbol(key)} [{unit_of(key)}]" for key in keys
    )


def _ticked(values: Values) -> str:
    return ", ".join(plain(value) for value in values)


REPORT = Report(
    options=ContrastOptions,
    numbers=lambda study, options: contrast_report(study.table, options),
    tables={"": contrast_columns},
    figure=contrast_figure,
    check=unknown_reference,
    results=lambda options: options.results,
)
