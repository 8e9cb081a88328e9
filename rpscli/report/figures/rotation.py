"""Rotation of the bearings against time, with the ground motion above and the events below."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rpscli.report.figures import style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rpscli.analyses.results import TimeHistoryResult

EventRow = tuple[tuple[str, ...], str, str]

EVENT_ROWS: tuple[EventRow, ...] = (
    (("uplift",), "uplift", style.GREEN),
    (("impact",), "impact", style.BLACK),
    (("recontact",), "re-contact", style.GREY),
    (("rolling_to_rocking", "rocking_to_rolling"), "rolling, rocking", style.PINK),
    (("critical_rotation_passed", "overturning"), "critical", style.RED),
)
"""Kinds of event, their name in the figure, and its colour."""

PHASES = ((1, "rolling", style.ROLLING_SHADE), (2, "rocking", style.ROCKING_SHADE))

NEAR = 2.0
"""A level up to so many times the largest rotation is brought into view."""


def rotation_figure(result: TimeHistoryResult, title: str) -> bytes:
    """Ground acceleration, rotation with its phases, and events of a time history."""
    rows = _rows(result)

    def draw(figure: Figure) -> None:
        style.heading(figure, title, result.record.name)
        ground, rotation, events = figure.subplots(
            3, 1, sharex=True, height_ratios=[1.0, 2.4, 0.18 * max(len(rows), 1)]
        )
        draw_ground(ground, result)
        draw_rotation(rotation, result)
        draw_events(events, result)
        events.set_xlim(0.0, result.trace.time[-1])
        for axes in (ground, rotation):
            axes.label_outer()
        figure.align_ylabels()

    return style.picture(draw, 4.6 + 0.15 * len(rows))


def _rows(result: TimeHistoryResult) -> list[EventRow]:
    """Kinds of event that there are."""
    return [row for row in EVENT_ROWS if any(event.kind in row[0] for event in result.events)]


def draw_ground(axes: Axes, result: TimeHistoryResult) -> None:
    """Ground acceleration, and what uplifts quasi-statically."""
    limit = result.structure.uplift_acceleration
    axes.plot(result.trace.time, result.trace.ground_acceleration, color=style.BLACK, lw=0.7)
    for sign in (1.0, -1.0):
        axes.axhline(sign * limit, color=style.GREEN, lw=0.9, ls="--")
    axes.plot([], [], color=style.GREEN, ls="--", lw=0.9, label="$g\\,\\tan\\alpha$ (uplift)")
    axes.set_ylabel("ground\nacceleration [m/s²]")
    axes.set_xlabel("time [s]")
    style.legend_above(axes, 1)


def draw_rotation(axes: Axes, result: TimeHistoryResult) -> None:
    """Rotation with its phases, beta and theta_cr; over theta_cr on the right."""
    trace, critical = result.trace, result.structure.critical_rotation
    beta = result.structure.bearing.beta
    levels = [("\\beta", beta, ":", style.PINK)] if beta > 0.0 else []
    levels.append(("\\theta_{cr}", critical, "--", style.RED))
    largest = max(result.max_rotation, 1e-3 * critical)
    near = [value for _, value, *_ in levels if value < NEAR * largest]
    top = 1.12 * max(largest, *near) if near else 1.12 * largest
    axes.set_ylim(-top, top)
    for code, name, shade in PHASES:
        _shade(axes, trace.time, trace.phase == code, shade, name)
    axes.plot(trace.time, trace.rotation, color=style.BLUE)
    for symbol, value, line, colour in levels:
        _level(axes, value, line, colour, symbol)
    axes.set_ylabel("rotation $\\theta$ [rad]")
    axes.set_xlabel("time [s]")
    ratio = axes.secondary_yaxis("right", functions=style.over(critical))
    ratio.set_ylabel("$\\theta/\\theta_{cr}$ [-]")
    style.legend_above(axes, 4)


def _shade(
    axes: Axes, time: NDArray[np.float64], inside: NDArray[np.bool_], colour: str, name: str
) -> None:
    """Vertical bands where `inside` holds; one entry in the legend."""
    if inside.any():
        axes.fill_between(
            time, 0.0, 1.0, where=inside, step="post", color=colour, lw=0.0, label=name,
            transform=axes.get_xaxis_transform(),
        )  # fmt: skip


def _level(axes: Axes, value: float, line: str, colour: str, symbol: str) -> None:
    """A pair of horizontal lines; outside the axes, their value in the legend alone."""
    label = f"${symbol}$ = {value:.3f} rad"
    if value > axes.get_ylim()[1]:
        axes.plot([], [], color=colour, ls=line, label=f"{label} (outside)")
        return
    axes.axhline(value, color=colour, ls=line, label=label)
    axes.axhline(-value, color=colour, ls=line)


def draw_events(axes: Axes, result: TimeHistoryResult) -> None:
    """Marks at the times of the events, one row a kind."""
    rows = _rows(result)
    axes.set_yticks(range(len(rows)), [name for _, name, _ in rows])
    axes.tick_params(axis="y", length=0.0, labelsize=0.9 * style.small())
    axes.set_ylim(len(rows) - 0.4, -0.6)
    axes.grid(visible=False)
    for row, (kinds, _, colour) in enumerate(rows):
        times = [event.time for event in result.events if event.kind in kinds]
        axes.plot(times, [row] * len(times), "|", color=colour, ms=6.0, mew=0.7)
    axes.set_xlabel("time [s]")
