"""A figure: the history of a rotation in its phase plane."""

from __future__ import annotations

from typing import TYPE_CHECKING

import rpscli

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def phase_plane(axes: Axes, result: rpscli.TimeHistoryResult) -> None:
    """The rate of rotation over the rotation."""
    trace = result.trace
    axes.plot(trace.rotation, trace.rotation_rate, linewidth=0.8)
    axes.set(xlabel=r"rotation $\theta$ [rad]", ylabel=r"rate $\dot\theta$ [rad/s]")
