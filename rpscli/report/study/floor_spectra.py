"""Spectra of the floors of a study: fractiles, isolated beside fixed base."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from rpscli.report.figures import style
from rpscli.report.study.labels import key_columns
from rpscli.report.study.panels import by_values, left_out, over, panel_figure, remarks
from rpscli.report.study.report import Report
from rpscli.report.study.statistics import reached
from rpscli.report.table import Column
from rpscli.sweep.reports.floor_spectra import (
    FRACTILES,
    FloorSpectraOptions,
    FloorSpectraPanel,
    FloorSpectraReport,
    floor_spectra_report,
    without_floors,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

UNITS = {"pseudo_acceleration": "m/s2", "displacement": "m"}


class Floor(NamedTuple):
    """One floor of a panel, counted from 1."""

    values: tuple[object, ...]
    panel: FloorSpectraPanel
    number: int


def floor_spectra_columns(report: FloorSpectraReport) -> list[Column]:
    """One row a system, intensity, floor and period; ``inf`` where a fractile overturned."""
    rows = [
        (panel, floor, place)
        for panel in report.panels
        for floor in range(panel.isolated.displacement.shape[1])
        for place in range(len(report.periods))
    ]
    columns = [
        *key_columns(report.keys, [panel.values for panel, *_ in rows]),
        Column("floor", "-", [floor + 1 for _, floor, _ in rows]),
        Column("period", "s", [float(report.periods[place]) for *_, place in rows]),
    ]
    for state in ("isolated", "fixed_base"):
        for name, unit in UNITS.items():
            for row, share in enumerate(FRACTILES):
                values = [
                    reached(float(getattr(getattr(panel, state), name)[row, floor, place]))
                    for panel, floor, place in rows
                ]
                columns.append(Column(f"{state}_{name}_{100 * share:.0f}", unit, values))
    return columns


def floor_spectra_figure(report: FloorSpectraReport, title: str) -> bytes:
    """Median and 84 % fractile of the pseudo-acceleration, on the lowest floor and the roof."""
    floors = [
        Floor((*panel.values, number), panel, number)
        for panel in report.panels
        for number in dict.fromkeys((1, panel.isolated.displacement.shape[1]))
    ]

    def draw(axes: Axes, floor: Floor) -> None:
        for spread, colour, name in (
            (floor.panel.isolated, style.BLUE, "on bearings"),
            (floor.panel.fixed_base, style.BLACK, "fixed base"),
        ):
            for row, dashes in ((1, "-"), (2, "--")):
                values = spread.pseudo_acceleration[row, floor.number - 1]
                axes.plot(
                    report.periods, np.where(np.isfinite(values), values, np.nan), ls=dashes,
                    color=colour, lw=1.3,
                    label=f"{name}, {'median' if row == 1 else '84 % fractile'}",
                )  # fmt: skip

    def limits(axes: Axes) -> None:
        # At the end: panels are given ticks for equal steps before they are drawn.
        axes.set_xscale("log")
        axes.set(xlim=(report.periods[0], report.periods[-1]), ylim=(0.0, None))
        for each in axes.figure.axes:
            each.xaxis.set_major_formatter("{x:g}")

    overturned = sum(panel.overturned for panel in report.panels)
    return panel_figure(
        by_values((*report.keys, "floor"), floors),
        floors,
        draw,
        title=title,
        x_label="period [s]",
        y_label="pseudo-acceleration [m/s²]",
        limits=limits,
        note=remarks(
            over(report.pooled),
            "fractiles that overturned are not drawn" if overturned else "",
            left_out(sum(panel.failed for panel in report.panels)),
        ),
    )


REPORT = Report(
    options=FloorSpectraOptions,
    numbers=floor_spectra_report,
    tables={"": floor_spectra_columns},
    figure=floor_spectra_figure,
    drawable=lambda report: bool(report.panels),
    notes=lambda report: report.notes,
    requires=without_floors,
)
