"""Ground motions at a glance, and spectra of several."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Literal

import numpy as np

from rpscli.constants import STANDARD_GRAVITY
from rpscli.errors import UsageError
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.measures import ResponseSpectrum, displacement, velocity
from rpscli.report.figures import style

Quantity = Literal["acceleration", "velocity", "displacement"]

QUANTITIES: dict[Quantity, tuple[str, str]] = {
    "acceleration": ("m/s²", style.BLACK),
    "velocity": ("m/s", style.BLUE),
    "displacement": ("m", style.GREEN),
}


def record_figure(
    motion: GroundMotion,
    spectrum: ResponseSpectrum,
    period: float | None,
    figure: style.Figure,
) -> None:
    """Time histories, and the spectrum with the first period of a
    building [s] if it is known.
    """
    narrow = style.narrow(figure)
    style.begin(
        figure, (motion.name, motion.description[:90]), 6.4 if narrow else 4.2, 8.0
    )
    rows, columns = (2, 1) if narrow else (1, 2)
    left, right = figure.subfigures(
        rows, columns, width_ratios=[1.45, 1.0][:columns], height_ratios=[1.6, 1.0][:rows],
        squeeze=False,
    ).flat  # fmt: skip
    draws = [partial(draw_motion, motion=motion, quantity=q) for q in QUANTITIES]
    style.grid(left, draws, sharex=True)
    axes = right.subplots()
    draw_spectrum(axes, spectrum)
    if period is not None:
        axes.axvline(period, color=style.BLUE, ls="--", label=f"$T_1$ = {period:.3g} s")
        style.legend_above(axes)


def draw_motion(
    axes: style.Axes, motion: GroundMotion, quantity: Quantity = "acceleration"
) -> None:
    """Acceleration, velocity or displacement of the ground against time, and the peak."""
    style.require("quantities of a motion", quantity, QUANTITIES)
    unit, colour = QUANTITIES[quantity]
    values = motion.acceleration
    if quantity != "acceleration":
        integral = velocity if quantity == "velocity" else displacement
        values = integral(values, motion.dt)
    time = motion.time
    peak = int(np.argmax(np.abs(values)))
    axes.plot(time, values, color=colour, lw=0.7)
    axes.plot(time[peak], values[peak], "o", color=style.RED, ms=4.0)
    axes.set(
        xlim=(0.0, motion.duration), xlabel="time [s]", ylabel=f"{quantity}\n[{unit}]"
    )
    text = f"peak {abs(values[peak]):.3g} at {time[peak]:.2f} s"
    if quantity == "acceleration":
        text = f"{text}, {motion.pga / STANDARD_GRAVITY:.3g} g"
    axes.set_title(text, loc="right", fontsize=style.small())


def draw_spectrum(axes: style.Axes, spectrum: ResponseSpectrum) -> None:
    """Pseudo-acceleration against period."""
    axes.plot(spectrum.periods, spectrum.pseudo_acceleration, color=style.RED, lw=1.3)
    _frame(axes, spectrum)


def _frame(axes: style.Axes, spectrum: ResponseSpectrum) -> None:
    damping = style.percent(spectrum.damping)
    axes.set_ylabel(f"pseudo-acceleration, {damping} damping [m/s²]")
    axes.set(xlabel="period [s]", xlim=(0.0, spectrum.periods[-1]), ylim=(0.0, None))


def draw_spectra(axes: style.Axes, spectra: Sequence[ResponseSpectrum]) -> None:
    """Pseudo-acceleration against period: each record thin, the median thick."""
    if not spectra:
        raise UsageError(
            "no spectra to be drawn; give `response_spectrum` of a record at least"
        )
    periods = spectra[0].periods
    values = np.array([spectrum.pseudo_acceleration for spectrum in spectra])
    for place, each in enumerate(values):
        label = f"{len(values)} records" if place == 0 else None
        axes.plot(periods, each, color=style.GREY, lw=0.6, alpha=0.7, label=label)
    axes.plot(periods, np.median(values, axis=0), color=style.RED, lw=1.6, label="median")
    _frame(axes, spectra[0])
    style.legend_above(axes)
