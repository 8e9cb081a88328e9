"""Ground motions at a glance, spectra of several, and motions chosen for a target."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from itertools import cycle
from typing import Any, Literal

import numpy as np

from rpscli.constants import STANDARD_GRAVITY
from rpscli.errors import UsageError
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.measures import ResponseSpectrum, displacement, velocity
from rpscli.records.selection import Selection
from rpscli.records.target import COMPONENTS
from rpscli.report.figures import style

LOOKS = [
    (line, colour)
    for line in ("-", "--", "-.", ":")
    for colour in (
        style.GREEN,
        style.ORANGE,
        style.SKY,
        style.PINK,
        style.BLACK,
        style.GREY,
    )
]
"""Of the spectra of motions; those of mean and target are their own."""

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


def selection_figure(selection: Selection, title: str, figure: style.Figure) -> None:
    """Spectra on the left, PGV against PGD of the scaled motions on the right."""
    note = (
        f"{len(selection.chosen)} of {selection.candidates}, {COMPONENTS[selection.of]};"
        f" misfit of the mean {selection.misfit:.3f}, factors at a bound:"
        f" {selection.clamped}"
    )
    narrow = style.narrow(figure)
    ratios = [1.6, 1.0]
    style.begin(figure, (title, note), 6.0 if narrow else 3.8, 8.0)
    way: dict[str, Any] = (
        {"height_ratios": ratios} if narrow else {"width_ratios": ratios}
    )
    left, right = figure.subplots(*((2, 1) if narrow else (1, 2)), **way)
    _draw_spectra(left, selection)
    _draw_peaks(right, selection)
    style.legend_below(figure, [left])


def _draw_spectra(axes: style.Axes, selection: Selection) -> None:
    periods = selection.periods
    wanted = selection.wanted
    for one, (line, colour) in zip(selection.chosen, cycle(LOOKS), strict=False):
        spectrum = one.factor * one.acceleration
        axes.plot(periods, spectrum, color=colour, ls=line, lw=0.8, label=one.name)
    name = selection.target.name
    drawn = [
        *axes.plot(periods, selection.mean, color=style.BLUE, lw=2.4, label="mean"),
        *axes.plot(periods, wanted, color=style.RED, lw=1.8, ls="--", label=name),
    ]
    if selection.target.deviation is not None and selection.deviation is not None:
        drawn[0].set_label("median, deviations")
        scatters = selection.deviation, selection.target.deviation(periods)
        for of, scatter, values in zip(
            drawn, scatters, (selection.mean, wanted), strict=True
        ):
            for sign in (-1.0, 1.0):
                look: dict[str, Any] = {"color": of.get_color(), "ls": of.get_linestyle()}
                axes.plot(periods, values * np.exp(sign * scatter), lw=0.9, **look)
    if (asked := selection.requirements) is not None and asked.least < 1.0:
        label = f"{style.percent(asked.least)} of it"
        axes.plot(
            periods, asked.least * wanted, color=style.RED, lw=1.2, ls=":", label=label
        )
    axes.set(
        xscale="log", yscale="log", xlim=(periods[0], periods[-1]), xlabel="period [s]"
    )
    damping = style.percent(selection.target.damping)
    axes.set_ylabel(f"pseudo-acceleration, {damping} damping [m/s²]")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter("{x:g}")
        # Between powers of ten as many labels as there is room for.
        axis.set_minor_formatter(lambda at, _: f"{at:g}" if f"{at:e}"[0] in "235" else "")


def _draw_peaks(axes: style.Axes, selection: Selection) -> None:
    velocities = [one.factor * one.pgv for one in selection.chosen]
    displacements = [one.factor * one.pgd for one in selection.chosen]
    axes.plot(velocities, displacements, "o", ms=4.0, color=style.GREY, label="motions")
    axes.plot(
        selection.mean_pgv,
        selection.mean_pgd,
        "D",
        ms=6.0,
        color=style.BLUE,
        label="mean",
    )
    dashed: dict[str, Any] = {"color": style.RED, "ls": "--", "lw": 1.4}
    if selection.target.pgv is not None:
        axes.axvline(selection.target.pgv, **dashed, label="target")
    if selection.target.pgd is not None:
        axes.axhline(selection.target.pgd, **dashed)
    axes.set_xlim(0.0, 1.15 * max(*velocities, selection.target.pgv or 0.0))
    axes.set_ylim(0.0, 1.15 * max(*displacements, selection.target.pgd or 0.0))
    axes.set(xlabel="PGV [m/s]", ylabel="PGD [m]")
    style.legend_above(axes)
