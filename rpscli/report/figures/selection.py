"""Chosen motions beside their target: spectra, and the peaks of velocity and displacement."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rpscli.report.figures import style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rpscli.records.selection import Selection


def selection_figure(selection: Selection, title: str) -> bytes:
    """Spectra on the left, PGV against PGD of the scaled motions on the right."""
    count = len(selection.chosen)
    note = f"{count} of {selection.candidates} motions, misfit of the mean {selection.misfit:.3f}"

    def draw(figure: Figure) -> None:
        style.heading(figure, title, note)
        left, right = figure.subplots(1, 2, width_ratios=[1.6, 1.0])
        _draw_spectra(left, selection)
        _draw_peaks(right, selection)

    return style.picture(draw, 3.6, 8.0)


def _draw_spectra(axes: Axes, selection: Selection) -> None:
    from matplotlib.ticker import FuncFormatter

    for place, one in enumerate(selection.chosen):
        axes.plot(
            selection.periods, one.factor * one.acceleration, color=style.GREY, lw=0.6, alpha=0.7,
            label="" if place else "motions",
        )  # fmt: skip
    axes.plot(selection.periods, selection.mean, color=style.BLUE, lw=2.0, label="mean")
    axes.plot(
        selection.periods, selection.wanted, color=style.RED, lw=1.8, ls="--",
        label=selection.target.name,
    )  # fmt: skip
    axes.set(xscale="log", yscale="log", xlim=(selection.periods[0], selection.periods[-1]))
    axes.set_xlabel("period [s]")
    axes.set_ylabel(
        f"pseudo-acceleration, {style.percent(selection.target.damping)} damping [m/s²]"
    )
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter(FuncFormatter(lambda value, _: _second_tick(value)))
    axes.legend(loc="lower left")


def _second_tick(value: float) -> str:
    """Labels between powers of ten, as many as there is room for.

    >>> _second_tick(0.2), _second_tick(0.4), _second_tick(50.0)
    ('0.2', '', '50')
    """
    return f"{value:g}" if f"{value:e}"[0] in "235" else ""


def _draw_peaks(axes: Axes, selection: Selection) -> None:
    velocities = [one.factor * one.pgv for one in selection.chosen]
    displacements = [one.factor * one.pgd for one in selection.chosen]
    axes.plot(velocities, displacements, "o", ms=4.0, color=style.GREY, label="motions")
    axes.plot(selection.mean_pgv, selection.mean_pgd, "D", ms=6.0, color=style.BLUE, label="mean")
    dashed: dict[str, Any] = {"color": style.RED, "ls": "--", "lw": 1.4}
    if selection.target.pgv is not None:
        axes.axvline(selection.target.pgv, **dashed, label="target")
    if selection.target.pgd is not None:
        axes.axhline(selection.target.pgd, **dashed)
    axes.set_xlim(0.0, 1.15 * max(*velocities, selection.target.pgv or 0.0))
    axes.set_ylim(0.0, 1.15 * max(*displacements, selection.target.pgd or 0.0))
    axes.set_xlabel("PGV [m/s]")
    axes.set_ylabel("PGD [m]")
    axes.legend()
