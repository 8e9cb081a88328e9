"""Where the energy of the ground motion goes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rpscli.report.figures import style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rpscli.analyses.results import TimeHistoryResult


DEVICE_COLOURS = (style.RED, style.PINK, style.BLUE, style.GREY)
"""Of what each device dissipates, from the first on."""


def energy_figure(result: TimeHistoryResult, title: str) -> bytes:
    """Input and where it went."""

    def draw(figure: Figure) -> None:
        style.heading(figure, title, result.record.name)
        draw_energy(figure.subplots(), result)

    return style.picture(draw, 3.4)


def draw_energy(axes: Axes, result: TimeHistoryResult) -> None:
    """Input against what was damped, dissipated by each device, lost at impacts and is stored.

    One stands on top of the other.
    """
    trace = result.trace
    factor, prefix = style.engineering(
        float(np.nanmax(np.abs([trace.energy_input, trace.energy_stored])))
    )
    parts = [
        (trace.energy_impact, "lost at impacts (net)", style.ORANGE),
        (trace.energy_stored, "kinetic, elastic and gravitational", style.GREEN),
    ]
    for index, device in enumerate(result.structure.devices):
        energy = trace.devices.energy[:, index]
        name = f"device {index}: {device.kind.replace('_', ' ')}"
        parts.insert(index, (energy, name, DEVICE_COLOURS[index % len(DEVICE_COLOURS)]))
    if result.structure.storeys:
        parts.insert(0, (trace.energy_damped, "damped in the building", style.SKY))
    below = np.zeros_like(trace.time)
    for part, name, colour in parts:
        above = below + factor * part
        axes.fill_between(trace.time, below, above, color=colour, lw=0.0, label=name, alpha=0.8)
        below = above
    axes.plot(trace.time, factor * trace.energy_input, color=style.BLACK, label="input")
    axes.set_xlim(0.0, trace.time[-1])
    axes.set_xlabel("time [s]")
    axes.set_ylabel(f"energy [{prefix}J]")
    style.legend_above(axes, 3 if result.structure.devices else 4)
