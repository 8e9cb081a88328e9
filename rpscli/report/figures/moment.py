"""What drives the bearings against their rotation, over the static restoring curve."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rpscli.report.figures import style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rpscli.analyses.results import TimeHistoryResult


def moment_figure(result: TimeHistoryResult, title: str) -> bytes:
    """Moment against rotation."""

    def draw(figure: Figure) -> None:
        style.heading(figure, title, result.record.name)
        draw_moment(figure.subplots(), result)

    return style.picture(draw, 4.2, 6.0)


def draw_moment(axes: Axes, result: TimeHistoryResult) -> None:
    """Driving moment of ground and building against rotation, and 2 R W s B of the weight."""
    trace, critical = result.trace, result.structure.critical_rotation
    reach = 1.1 * max(result.max_rotation, 0.02 * critical)
    factor, prefix = style.engineering(float(np.nanmax(np.abs(trace.driving_moment))))
    axes.plot(
        trace.rotation, factor * trace.driving_moment, color=style.BLUE, lw=0.7,
        label="driving moment (ground and building)",
    )  # fmt: skip
    for k, side in enumerate((-1.0, 1.0)):
        rotation = side * np.linspace(1e-9, reach, 300)
        static = factor * result.restoring_moment(rotation)
        label = "restoring moment of the weight" if k == 0 else None
        axes.plot(rotation, static, color=style.RED, lw=2.5, zorder=1.5, label=label)
    axes.axhline(0.0, color=style.BLACK, lw=0.5)
    axes.axvline(0.0, color=style.BLACK, lw=0.5)
    axes.set_xlim(-reach, reach)
    axes.set_xlabel("rotation $\\theta$ [rad]")
    axes.set_ylabel(f"moment about the contact points [{prefix}N m]")
    style.legend_above(axes, 2)
