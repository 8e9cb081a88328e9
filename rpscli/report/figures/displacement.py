"""Displacements of cap beam and floors against time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rpscli.report.figures import style

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rpscli.analyses.results import TimeHistoryResult

FLOOR_COLOURS = (style.RED, style.ORANGE, style.GREEN)


def displacement_figure(result: TimeHistoryResult, title: str) -> bytes:
    """Roof, floors at mid-height and cap beam over the ground; below, floors over the cap beam."""
    trace, floors = result.trace, shown_floors(result.structure.storeys)

    def draw(figure: Figure) -> None:
        style.heading(figure, title, result.record.name)
        panels = figure.subplots(2 if floors else 1, 1, sharex=True, squeeze=False)[:, 0]
        whole = panels[0]
        for floor, colour in zip(floors, FLOOR_COLOURS, strict=False):
            name = floor_name(floor, result.structure.storeys)
            displacement = trace.floor_displacements[:, floor - 1]
            whole.plot(trace.time, displacement, color=colour, label=name)
            elastic = displacement - trace.cap_beam_displacement
            panels[1].plot(trace.time, elastic, color=colour, label=name, lw=0.8)
        base = "cap beam" if result.structure.cap_beam_mass > 0.0 else "top of the columns"
        whole.plot(trace.time, trace.cap_beam_displacement, color=style.BLACK, ls="--", label=base)
        whole.set_ylabel("displacement relative\nto the ground [m]")
        if floors:
            panels[1].set_ylabel("displacement relative\nto the cap beam [m]")
        style.legend_above(whole, 4)
        panels[-1].set_xlim(0.0, trace.time[-1])
        panels[-1].set_xlabel("time [s]")
        figure.align_ylabels()

    return style.picture(draw, 4.8 if floors else 3.0)


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
