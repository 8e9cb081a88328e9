"""A ground motion at a glance: acceleration, velocity, displacement, response spectrum."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from rpscli.records.measures import displacement, velocity
from rpscli.report.figures import style
from rpscli.report.figures.arguments import require
from rpscli.report.figures.thinned import extremes

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rpscli.records.ground_motion import GroundMotion
    from rpscli.records.spectrum import ResponseSpectrum


Quantity = Literal["acceleration", "velocity", "displacement"]

QUANTITIES: dict[Quantity, tuple[str, str]] = {
    "acceleration": ("m/s²", style.BLACK),
    "velocity": ("m/s", style.BLUE),
    "displacement": ("m", style.GREEN),
}


def record_figure(motion: GroundMotion, spectrum: ResponseSpectrum) -> bytes:
    """Time histories on the left, the spectrum on the right."""

    def draw(figure: Figure) -> None:
        style.heading(figure, motion.name, motion.description[:90])
        left, right = figure.subfigures(1, 2, width_ratios=[1.45, 1.0], squeeze=False)[0]
        for axes, quantity in zip(left.subplots(3, 1, sharex=True), QUANTITIES, strict=True):
            draw_motion(axes, motion, quantity)
            axes.label_outer()
        left.align_ylabels()
        draw_spectrum(right.subplots(), spectrum)

    return style.picture(draw, 4.2, 8.0)


def draw_motion(axes: Axes, motion: GroundMotion, quantity: Quantity = "acceleration") -> None:
    """Acceleration, velocity or displacement of the ground against time, and the peak."""
    require("quantities of a motion", quantity, QUANTITIES)
    unit, colour = QUANTITIES[quantity]
    values = motion.acceleration
    if quantity != "acceleration":
        integral = velocity if quantity == "velocity" else displacement
        values = integral(values, motion.dt)
    time, peak = motion.time, int(np.argmax(np.abs(values)))
    kept = extremes(values)
    axes.plot(time[kept], values[kept], color=colour, lw=0.7)
    axes.plot(time[peak], values[peak], "o", color=style.RED, ms=4.0)
    axes.set_xlim(0.0, motion.duration)
    axes.set_xlabel("time [s]")
    axes.set_ylabel(f"{quantity}\n[{unit}]")
    axes.set_title(
        f"peak {abs(values[peak]):.3g} at {time[peak]:.2f} s", loc="right", fontsize=style.small()
    )


def draw_spectrum(axes: Axes, spectrum: ResponseSpectrum) -> None:
    """Pseudo-acceleration against period."""
    axes.plot(spectrum.periods, spectrum.pseudo_acceleration, color=style.RED, lw=1.3)
    axes.set_xlabel("period [s]")
    axes.set_ylabel(f"pseudo-acceleration, {style.percent(spectrum.damping)} damping [m/s²]")
    axes.set_xlim(0.0, spectrum.periods[-1])
    axes.set_ylim(bottom=0.0)
