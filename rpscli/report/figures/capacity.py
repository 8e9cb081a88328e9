"""Capacity curves of the whole structure."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rpscli.errors import UsageError
from rpscli.report.figures import style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rpscli.analyses.pushover import PushoverResult

LOOKS = ((style.BLUE, "-"), (style.RED, "--"), (style.GREEN, "-."), (style.PINK, ":"))


def capacity_figure(result: PushoverResult, title: str) -> bytes:
    """Sum of floor forces against roof displacement, whole and close to the uplift."""

    def draw(figure: Figure) -> None:
        style.heading(figure, title, "floor forces pushed to the critical rotation")
        whole, close = figure.subplots(1, 2, sharey=True, width_ratios=[1.6, 1.0])
        for axes in (whole, close):
            draw_capacity(axes, result)
        uplift = max(c.roof_displacement_at_uplift for c in result.capacity)
        close.set_xlim(0.0, 3.0 * uplift)
        close.locator_params(axis="x", nbins=5)
        whole.set_xlabel(style.folded(figure, "roof displacement [m]"))
        close.set_xlabel(style.folded(figure, "near uplift [m]"))
        close.set_ylabel("")
        columns = 5 if style.inches(figure)[0] >= style.WIDTH else 2
        legend = close.get_legend_handles_labels()
        figure.legend(*legend, loc="outside lower center", ncols=columns)

    return style.picture(draw, 3.6)


def draw_capacity(axes: Axes, result: PushoverResult) -> None:
    """Sum of floor forces against roof displacement by pattern, and where it uplifts."""
    if not result.capacity:
        raise UsageError("a structure without storeys has no capacity curve; draw `storey_curve`")
    factor, prefix = style.engineering(max(c.sum_of_floor_forces.max() for c in result.capacity))
    for k, curve in enumerate(result.capacity):
        colour, line = LOOKS[k % len(LOOKS)]
        axes.plot(
            curve.roof_displacement, factor * curve.sum_of_floor_forces,
            color=colour, ls=line, lw=1.5, label=curve.pattern.replace("_", " "),
        )  # fmt: skip
        axes.plot(
            curve.roof_displacement_at_uplift, factor * result.uplift_force, "o",
            color=colour, ms=4.5, clip_on=False,
        )  # fmt: skip
    axes.plot([], [], "o", color=style.GREY, ms=4.5, label="uplift")
    axes.set_xlim(left=0.0)
    axes.set_ylim(
        bottom=min(0.0, *(factor * np.min(c.sum_of_floor_forces) for c in result.capacity))
    )
    axes.set_xlabel("roof displacement [m]")
    axes.set_ylabel(f"sum of floor forces [{prefix}N]")
