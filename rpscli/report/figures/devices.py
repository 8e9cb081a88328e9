"""Force-displacement loops of the devices of a time history."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rpscli.model.devices import Tendon, name_of
from rpscli.report.figures import style
from rpscli.report.figures.arguments import require

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rpscli.analyses.results import TimeHistoryResult


def devices_figure(result: TimeHistoryResult, title: str) -> bytes:
    """The loops of all devices."""
    count = len(result.structure.devices)
    columns = min(count, 3)
    rows = -(-count // columns)

    def draw(figure: Figure) -> None:
        style.heading(figure, title, result.record.name)
        panels = figure.subplots(rows, columns, squeeze=False).ravel()
        for index, axes in enumerate(panels[:count]):
            draw_device(axes, result, index)
        for axes in panels[count:]:
            axes.set_axis_off()

    return style.picture(draw, 0.5 + 2.7 * rows, max(2.6 * columns, 4.0))


def draw_device(axes: Axes, result: TimeHistoryResult, index: int) -> None:
    """Resistance of a device against displacement, of tendons tension against elongation.

    Resistance is the force on the cap beam turned round, so that a loop that dissipates runs
    clockwise and its area is the energy.
    """
    require("devices", index, range(len(result.structure.devices)))
    trace, device = result.trace.devices, result.structure.devices[index]
    tendon = isinstance(device, Tendon)
    force = trace.force[:, index] if tendon else -trace.force[:, index]
    factor, prefix = style.engineering(float(np.nanmax(np.abs(force), initial=0.0)))
    axes.plot(trace.displacement[:, index], factor * force, color=style.BLUE, lw=0.8)
    axes.axhline(0.0, color=style.BLACK, lw=0.5)
    axes.axvline(0.0, color=style.BLACK, lw=0.5)
    axes.set_title(f"device {index}: {name_of(device).replace('_', ' ')}", fontsize=style.small())
    axes.set_xlabel("elongation of one [m]" if tendon else "$u_b$ [m]")
    axes.set_ylabel(f"{'tension of one' if tendon else 'resistance'} [{prefix}N]")
    axes.locator_params(axis="x", nbins=5)
