"""The most loaded column when its moment is largest: forces at its ends and along it."""

from __future__ import annotations

import math

import numpy as np

from rpscli.analyses.column_design import ColumnDemand
from rpscli.analyses.results import TimeHistoryResult
from rpscli.model.podium import PodiumStructure
from rpscli.report.figures import style
from rpscli.report.figures.bearing import COLUMN, contact_points, leaning_outline
from rpscli.report.figures.history import record_name

POINTS = 81
LONGEST = 0.4  # of the arrow of the larger force, over the height of the column


def column_figure(result: TimeHistoryResult, title: str) -> bytes:
    """The tilted column with its end forces beside axial force, shear and moment."""
    narrow, demand = style.narrow(), result.column_demand
    assert demand is not None, "it is drawn where it was computed"

    def draw(figure: style.Figure) -> None:
        at = f"t = {demand.instants[0].time:.5g} s, θ = {demand.instants[0].rotation:.3g} rad"
        style.heading(figure, title, record_name(result), f"most loaded column at {at}")
        if narrow:
            grid = figure.add_gridspec(2, 3, height_ratios=[1.2, 1.0])
            places = [grid[0, :], *(grid[1, i] for i in range(3))]
        else:
            grid = figure.add_gridspec(1, 4, width_ratios=[2.0, 1.0, 1.0, 1.4])
            places = [grid[0, i] for i in range(4)]
        panels = [figure.add_subplot(place) for place in places]
        draw_end_forces(panels[0], result.structure, demand)
        draw_section_forces(panels[1:], result.structure, demand)

    return style.picture(draw, 6.0 if narrow else 3.6)


def draw_end_forces(axes: style.Axes, structure: PodiumStructure, demand: ColumnDemand) -> None:
    """The column to scale; arrows of the forces on it, to a scale of their own."""
    bearing, s, x = structure.bearing, demand.at_largest_moment, demand.instants[0].rotation
    _, u, v = structure.path(np.array([abs(x)]))
    shift, lift = math.copysign(float(u[0]), x), float(v[0])
    height, wide = 2.0 * bearing.half_height, bearing.end_half_width
    outline = leaning_outline(bearing, x, shift, lift)
    axes.fill(*outline.T, fc=COLUMN, ec=style.BLACK, lw=1.0)
    foot, head = contact_points(bearing, x, shift, lift)
    if x == 0.0:  # in full contact, where the forces pass beside the axis
        foot, head = (np.array([s.side * s.lever, 0.0]), np.array([-s.side * s.lever, height]))
    largest = max(abs(s.normal_bottom), abs(s.normal_top), 1.0)
    for name, place, F, N in (
        ("bottom", foot, s.shear_bottom, s.normal_bottom),
        ("top", head, -s.shear_top, -s.normal_top),
    ):
        plate = place[0] + 2.0 * wide * np.array([-1.0, 1.0])
        axes.plot(plate, place[[1, 1]], color=style.BLACK, lw=1.2)
        force = LONGEST * height * np.array([F, N]) / largest
        arrow = {"arrowstyle": "-|>", "lw": 1.2, "color": style.RED, "shrinkA": 0, "shrinkB": 0}
        axes.annotate("", place, place - force, arrowprops=arrow)
        words = "\n".join(
            f"${letter}_\\mathrm{{{name}}}$ = {1e-3 * abs(value):.4g} kN"
            for letter, value in (("N", N), ("F", F))
        )
        style.note(axes, words, place - 0.6 * force, (8.0, 0.0), color=style.RED)
    room = 1.15 * LONGEST * height
    axes.set(aspect="equal", ylim=(-room, height + lift + room))
    axes.axis("off")


def draw_section_forces(
    panels: list[style.Axes], structure: PodiumStructure, demand: ColumnDemand
) -> None:
    """P, Q and M over the height of the column from its foot."""
    bearing, mass = structure.bearing, structure.columns_mass / structure.columns
    along = np.linspace(0.0, 2.0 * bearing.half_height, POINTS)
    forces = demand.at_largest_moment.section_forces(bearing, mass, along)
    names = ("axial force $P$ [kN]", "shear $Q$ [kN]", "moment $M$ [kN m]")
    for axes, values, name in zip(panels, forces, names, strict=True):
        shown = 1e-3 * values
        axes.plot(shown, along, color=style.BLUE)
        axes.fill_betweenx(along, 0.0, shown, color=style.SKY, alpha=0.25, lw=0.0)
        axes.axvline(0.0, color=style.BLACK, lw=0.7)
        axes.margins(x=0.1)
        for end, upwards in ((0, 5.0), (-1, -5.0)):
            left = shown[end] > 0.0
            text, at = f"{shown[end]:.4g}".replace("-", "−"), (shown[end], along[end])
            style.note(axes, text, at, (-7.0 if left else 7.0, upwards))
        axes.set(xlabel=name, ylim=(0.0, along[-1]))
        if axes is not panels[0]:
            axes.tick_params(labelleft=False)
    panels[0].set_ylabel("height along the column [m]")
