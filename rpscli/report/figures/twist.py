"""Paths of the columns of a slab that turns, seen from above, and the turn in time."""

from __future__ import annotations

import numpy as np

from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.twist import TwistResult
from rpscli.report.figures import style
from rpscli.report.figures.history import record_name

PART = 0.35
"""Of the least distance of columns: as far as the largest displacement is drawn."""


def twist_figure(result: TimeHistoryResult, title: str, figure: style.Figure) -> None:
    """The plan with the paths of its columns, enlarged, above the turn in time."""
    twist = result.twist
    assert twist is not None, "figures are drawn of slabs that turn"
    scale = enlargement(twist)
    words = (
        title,
        f"{record_name(result)}; displacements times {scale:.3g}",
        result.sampling,
    )
    style.begin(figure, words, 6.4)
    above, below = figure.subplots(2, 1, height_ratios=(3.2, 1.0))
    draw_paths(above, twist)
    below.plot(twist.time, 1e3 * twist.ways[:, 2], color=style.BLACK, lw=0.8)
    below.set(xlabel="time [s]", ylabel=r"$\psi$ [mrad]")


def enlargement(twist: TwistResult) -> float:
    """Factor on displacements, so that paths of neighbours hardly meet."""
    x, y = twist.run.places.T
    gaps = np.concatenate([np.diff(np.unique(x)), np.diff(np.unique(y))])
    farthest = twist.max_corner_displacement
    return PART * float(gaps.min()) / farthest if farthest > 0.0 else 1.0


def draw_paths(axes: style.Axes, twist: TwistResult) -> None:
    """Where heads moved, from the places of their columns; the worst one red."""
    scale = enlargement(twist)
    worst = twist.worst_column
    farthest = f"column {worst + 1}: {twist.max_corner_displacement:#.3g} m"
    another = 0 if worst else 1
    labels = {worst: farthest, another: "other columns"}
    for i, (x, y) in enumerate(twist.run.places.tolist()):
        path = twist.column_ways[:, i]
        axes.plot(
            x + scale * path[:, 0],
            y + scale * path[:, 1],
            color=style.RED if i == worst else style.SKY,
            lw=0.7,
            label=labels.get(i),
        )
        axes.plot([x], [y], "o", color=style.BLACK, ms=2.5)
    centre = twist.ways
    axes.plot(
        scale * centre[:, 0],
        scale * centre[:, 1],
        color=style.BLACK,
        lw=0.7,
        label=f"centre: {twist.max_centre_displacement:#.3g} m",
    )
    axes.set_aspect("equal", adjustable="datalim")
    axes.set(xlabel="$x$ from the centre [m]", ylabel="$y$ [m]")
    style.legend_above(axes)
