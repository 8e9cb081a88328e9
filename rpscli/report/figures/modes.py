"""Mode shapes of each state, laid out like Figure 6 of the paper."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rpscli.report.figures import style
from rpscli.report.figures.structure import level_heights

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rpscli.analyses.modal import ModalResult

MOST_MODES = 3
"""Vibration modes that are drawn, at most."""
ELASTIC = "elastic shape (over the cap beam)"
NORMALISED = "shapes scaled to 1 at their largest component"


def modes_figure(result: ModalResult, title: str) -> bytes:
    """The storey's own mode and the first vibration modes: one column a mode, one row a state."""
    width, height = modes_size(result)
    return style.picture(lambda figure: draw_modes(figure, result, title), height, width)


def modes_size(result: ModalResult) -> tuple[float, float]:
    """Width and height of the figure [in]."""
    width = 1.0 + 1.5 * (1 + min(MOST_MODES, result.structure.storeys))
    return max(width, 4.0), 0.9 + 2.1 * len(result.uplifted)


def draw_modes(figure: Figure, result: ModalResult, title: str) -> None:
    """Fill an empty figure."""
    states = list(result.uplifted)
    vibrations = min(MOST_MODES, result.structure.storeys)
    style.heading(figure, title, NORMALISED)
    panels = figure.subplots(len(states), 1 + vibrations, sharex=True, sharey=True, squeeze=False)
    for row, state in zip(panels, states, strict=True):
        for mode, axes in enumerate(row):
            draw_mode(axes, result, state, mode)
            axes.label_outer()
        row[0].set_ylabel(f"{state}\nheight [m]")
    reach = 1.05 * max(abs(limit) for limit in panels[0, 0].get_xlim())
    panels[0, 0].set_xlim(-reach, reach)
    handles, names = panels[0, -1].get_legend_handles_labels()
    narrow = style.inches(figure)[0] < modes_size(result)[0]
    figure.legend(handles, names, loc="outside lower center", ncols=1 if narrow else 3)
    for axes in panels.flat if narrow else ():
        axes.set_title(
            axes.get_title().replace(": ", "\n").replace(" rad/s", "\nrad/s").replace(" (", "\n(")
        )


def draw_mode(axes: Axes, result: ModalResult, state: str, mode: int) -> None:
    """A mode, counted from 1, or 0 for the storey's own, `rolling` or `rocking`."""
    style.require("phases", state, result.uplifted)
    style.require("modes", mode, range(result.structure.storeys + 1))
    modes = result.uplifted[state]
    levels = np.concatenate([[0.0], level_heights(result.structure)])
    shape = modes.shapes[:, mode]
    if mode and result.fixed_base is not None:
        full = np.concatenate([[0.0, 0.0], result.fixed_base.shapes[:, mode - 1]])
        axes.plot(
            full, levels, color=style.BLACK, ls="--", marker="o", ms=2.5, label="full contact"
        )
    axes.plot([0.0, *shape], levels, color=style.BLACK, marker="o", ms=2.5, label="uplifted")
    if len(shape) > 1:
        elastic = [0.0, *(shape[1:] - shape[0])]
        axes.plot(elastic, levels[1:], color=style.RED, marker="o", ms=2.5, label=ELASTIC)
    axes.axvline(0.0, color=style.GREY, lw=0.5)
    axes.set(xlabel="shape [-]", ylabel="height [m]", ylim=(-0.02 * levels[-1], 1.03 * levels[-1]))
    if mode == 0:
        rate = f"{modes.frequency_parameter:#.3g} rad/s"
        # Where the force is the same at every displacement, nothing grows or swings.
        rate = rate if modes.frequency_parameter else "0 (neutral)"
        axes.set_title(f"storey: $p_{{ext}}$ = {rate}")
    else:
        axes.set_title(f"mode {mode}: $\\omega$ = {modes.frequencies[mode - 1]:#.3g} rad/s")
