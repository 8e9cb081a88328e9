"""Displacements of cap beam and floors against time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rpscli.report.figures import style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rpscli.analyses.results import TimeHistoryResult

FLOOR_COLOURS = (style.RED, style.ORANGE, style.GREEN)


def displacement_figure(result: TimeHistoryResult, title: str) -> bytes:
    """Roof, floors at mid-height and cap beam over the ground; below, floors over the cap beam."""
    rows = 2 if result.structure.storeys else 1

    def draw(figure: Figure) -> None:
        style.heading(figure, title, result.record.name)
        panels = figure.subplots(rows, 1, sharex=True, squeeze=False)[:, 0]
        draw_displacements(panels[0], result)
        if rows > 1:
            draw_drifts(panels[1], result)
            panels[0].label_outer()
        figure.align_ylabels()

    return style.picture(draw, 4.8 if rows > 1 else 3.0)


def draw_displacements(axes: Axes, result: TimeHistoryResult) -> None:
    """Floors and cap beam, relative to the ground."""
    trace = result.trace
    _draw_floors(axes, result, trace.floor_displacements)
    base = "cap beam" if result.structure.cap_beam_mass > 0.0 else "top of the columns"
    line = "--" if result.structure.storeys else "-"
    axes.plot(trace.time, trace.cap_beam_displacement, color=style.BLACK, ls=line, label=base)
    axes.set_ylabel("displacement relative\nto the ground [m]")
    style.legend_above(axes, 4)


def draw_drifts(axes: Axes, result: TimeHistoryResult) -> None:
    """Floors relative to the cap beam."""
    trace = result.trace
    drifts = trace.floor_displacements - trace.cap_beam_displacement[:, None]
    _draw_floors(axes, result, drifts, lw=0.8)
    axes.set_ylabel("displacement relative\nto the cap beam [m]")


def _draw_floors(
    axes: Axes, result: TimeHistoryResult, values: NDArray[np.float64], **look: Any
) -> None:
    """Some columns of (samples, n), with time below."""
    time, storeys = result.trace.time, result.structure.storeys
    for floor, colour in zip(shown_floors(storeys), FLOOR_COLOURS, strict=False):
        name = floor_name(floor, storeys)
        axes.plot(time, values[:, floor - 1], color=colour, label=name, **look)
    axes.set_xlim(0.0, time[-1])
    axes.set_xlabel("time [s]")


def shown_floors(storeys: int) -> list[int]:
    """The roof and at most two floors below it, counted from 1 at the bottom.

    >>> shown_floors(0), shown_floors(2), shown_floors(9)
    ([], [2, 1], [9, 6, 3])
    """
    third = storeys / 3.0
    return sorted({round(third * k) for k in (1, 2, 3)} - {0}, reverse=True)


def floor_name(floor: int, storeys: int) -> str:
    """How a floor is called in a legend."""
    return "roof" if floor == storeys else f"floor {floor}"
