"""The figure of motions that were chosen for a target."""

from __future__ import annotations

from itertools import cycle
from typing import Any

import numpy as np

from rpscli.records.target import COMPONENTS
from rpscli.report.figures import style
from rpscli.tools.selection.selection import Selection

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
