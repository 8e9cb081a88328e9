"""Spectra of the floors, isolated beside fixed base."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rpscli.report.figures import style
from rpscli.report.figures.arguments import require

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rpscli.analyses.floor_spectra import FloorSpectra

MOST_FLOORS = 3
"""In the picture; the table has all."""


def shown_floors(count: int) -> list[int]:
    """Numbers of the floors that are drawn, from 1: the lowest, the middle one and the roof.

    >>> shown_floors(1), shown_floors(2), shown_floors(6)
    ([1], [1, 2], [1, 4, 6])
    """
    floors = np.linspace(1.0, count, min(count, MOST_FLOORS))
    return [int(floor + 0.5) for floor in floors]


def floor_spectra_figure(
    isolated: FloorSpectra, fixed: FloorSpectra | None, title: str, record: str
) -> bytes:
    """Pseudo-acceleration above, displacement below; one column a floor."""
    floors = shown_floors(len(isolated.displacement))

    def draw(figure: Figure) -> None:
        style.heading(figure, title, record, f"{style.percent(isolated.damping)} damping")
        grid = figure.subplots(2, len(floors), squeeze=False, sharex=True, sharey="row")
        for column, floor in enumerate(floors):
            for row, name in enumerate(("pseudo_acceleration", "displacement")):
                draw_floor_spectrum(grid[row, column], isolated, fixed, floor, name)
            grid[0, column].set_title(f"floor {floor}")
        for axes in grid.flat:
            axes.label_outer()
        for axes in grid[:, 0]:  # once all are drawn, since a row shares its limits
            axes.set_ylim(bottom=0.0)
        grid[0, 0].set_ylabel(style.folded(figure, "pseudo-acceleration [m/s²]"))
        grid[1, 0].set_ylabel("spectral displacement [m]")
        handles, names = grid[0, 0].get_legend_handles_labels()
        figure.legend(handles, names, loc="outside lower center", ncols=2)

    return style.picture(draw, 4.8)


def draw_floor_spectrum(
    axes: Axes,
    isolated: FloorSpectra,
    fixed: FloorSpectra | None,
    floor: int,
    name: str = "pseudo_acceleration",
) -> None:
    """The spectrum of a floor, counted from 1, or its `displacement`; beside the fixed base."""
    place = floor - 1
    require("floors", floor, range(1, len(isolated.displacement) + 1))
    axes.plot(
        isolated.periods, getattr(isolated, name)[place], color=style.BLUE, label="on bearings"
    )
    if fixed is not None:
        axes.plot(
            fixed.periods, getattr(fixed, name)[place], color=style.BLACK, ls="--",
            label="fixed base",
        )  # fmt: skip
    axes.set_xscale("log")
    axes.xaxis.set_major_formatter("{x:g}")
    axes.set_xlim(isolated.periods[0], isolated.periods[-1])
    axes.set_xlabel("period [s]")
    words = {
        "pseudo_acceleration": "pseudo-acceleration [m/s²]",
        "displacement": "spectral displacement [m]",
    }
    axes.set_ylabel(f"floor {floor}, {words[name]}")
