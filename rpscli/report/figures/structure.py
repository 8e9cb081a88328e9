"""The structure at rest, drawn to scale with its dimensions, and one column enlarged."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from rpscli.report.figures import style
from rpscli.report.figures.column_outline import leaning_outline
from rpscli.report.figures.levels import level_heights

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rpscli.model.bearing import Bearing
    from rpscli.model.podium import PodiumStructure

COLUMNS = 3
"""Columns under a cap beam: their number and distances are not drawn to scale."""
MOST_LEVELS = 20
"""With more storeys, their heights are not written one by one."""
GREY_FACE = "#DDDDDD"


def structure_figure(structure: PodiumStructure, title: str) -> bytes:
    """Elevation on the left, a column on the right, each with a scale of its own."""

    def draw(figure: Figure) -> None:
        style.heading(figure, title)
        left, right = figure.subplots(1, 2, width_ratios=[1.25, 1.0])
        _draw_elevation(left, structure)
        _draw_column(right, structure.bearing)
        for axes in (left, right):
            axes.set_aspect("equal")
            axes.axis("off")

    return style.picture(draw, 4.4)


def _draw_elevation(axes: Axes, structure: PodiumStructure) -> None:
    levels = level_heights(structure)
    height = float(levels[0])
    width = 1.5 * max(height, 0.35 * float(levels[-1]))
    count = COLUMNS if structure.cap_beam_mass > 0.0 else 1
    outline = leaning_outline(structure.bearing, 0.0, 0.0, 0.0)
    for foot in np.linspace(-0.4, 0.4, count) * width if count > 1 else np.zeros(1):
        x, y = (outline + np.array([foot, 0.0])).T
        axes.fill(x, y, fc=GREY_FACE, ec=style.BLACK, lw=0.7)
    edge = 0.62 * width
    axes.plot([-edge, edge], [0.0, 0.0], color=style.BLACK, lw=1.2)
    _measure(axes, (-edge, 0.0), (-edge, height), f"2H = {height:.4g} m")
    columns = f"columns: {_tonnes(structure.columns_mass)}"
    if count == 1:
        axes.set_title(columns, fontsize=style.small())
        return
    thickness = 0.12 * height
    _beam(axes, width, height, thickness)
    for at, text in (
        (0.5 * height, columns),
        (height + 0.5 * thickness, f"cap beam: {_tonnes(structure.cap_beam_mass)}"),
    ):
        axes.text(edge, at, f" {text}", va="center", fontsize=style.small())
    building = structure.superstructure
    if building is None:
        return
    few = building.storeys <= MOST_LEVELS
    for below, level, mass in zip(levels, levels[1:], building.masses, strict=False):
        axes.plot([-0.5 * width, 0.5 * width], [level + thickness] * 2, color=style.BLUE, lw=2.2)
        if few:
            text = f" {_tonnes(float(mass))}"
            axes.text(edge, level + thickness, text, va="center", fontsize=style.small())
        if few and building.storey_heights is not None:
            feet = (-edge, below + thickness), (-edge, level + thickness)
            _measure(axes, *feet, f"{level - below:.4g} m")
    for side in (-0.5, 0.5):
        axes.plot([side * width] * 2, [levels[0], levels[-1] + thickness], color=style.BLUE, lw=0.8)
    scale = "heights to scale, widths not"
    if building.storey_heights is None:
        scale = "storey heights are not given: drawn as 3 m"
    axes.set_title(scale, fontsize=style.small(), color=style.GREY)


def _beam(axes: Axes, width: float, height: float, thickness: float) -> None:
    left, top = -0.5 * width, height + thickness
    corners = [(left, height), (-left, height), (-left, top), (left, top)]
    axes.fill(*zip(*corners, strict=True), fc="#CCE3F0", ec=style.BLACK, lw=0.7)


def _draw_column(axes: Axes, bearing: Bearing) -> None:
    H, B = bearing.half_height, bearing.half_width
    x, y = leaning_outline(bearing, 0.0, 0.0, 0.0).T
    half = float(x.max())
    axes.fill(x, y, fc=GREY_FACE, ec=style.BLACK, lw=1.0)
    axes.plot([-2.2 * half, 2.2 * half], [0.0, 0.0], color=style.BLACK, lw=1.2)
    axes.plot([0.0, B], [H, 0.0], color=style.RED, lw=1.0)
    axes.plot([0.0, 0.0], [0.0, H], color=style.RED, lw=0.6, ls=(0, (6, 3)))
    axes.plot(0.0, H, "o", color=style.RED, ms=3.0)
    mid = (0.5 * B, 0.5 * H)
    note: dict[str, Any] = {"fontsize": style.small(), "color": style.RED}
    axes.annotate(
        f"R = {bearing.semi_diagonal:.4g} m\nα = {math.degrees(bearing.alpha):.4g}°",
        mid,
        (1.7 * half, 0.62 * H),
        arrowprops={"arrowstyle": "-", "color": style.RED, "lw": 0.5},
        va="center",
        **note,
    )
    gap = 0.08 * H
    _measure(axes, (-1.6 * half, 0.0), (-1.6 * half, 2.0 * H), f"2H = {2.0 * H:.4g} m")
    _measure(axes, (-B, -gap), (B, -gap), f"2B = {2.0 * B:.4g} m")
    title = "a column to scale, with flat ends"
    if not bearing.is_flat:
        _measure(axes, (-half, -4.2 * gap), (half, -4.2 * gap), f"2B' = {2.0 * half:.4g} m")
        end = (half, bearing.radius * (1.0 - math.cos(bearing.beta)))
        axes.annotate(
            f"r = {bearing.radius:.4g} m\nup to β = {math.degrees(bearing.beta):.4g}°",
            end,
            (1.7 * half, 0.28 * H),
            arrowprops={"arrowstyle": "->", "color": style.BLACK, "lw": 0.6},
            fontsize=style.small(),
            va="center",
        )
        title = "a column to scale"
    axes.set_title(title, fontsize=style.small(), color=style.GREY)
    axes.margins(x=0.22)
    axes.set_ylim(-7.5 * gap, 2.0 * H + gap)


def _measure(axes: Axes, start: tuple[float, float], end: tuple[float, float], text: str) -> None:
    """A dimension line with arrows at both ends and its text beside."""
    arrow = {"arrowstyle": "<->", "lw": 0.6, "color": style.BLACK, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", end, start, arrowprops=arrow)
    middle = (0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1]))
    if start[0] == end[0]:
        axes.text(*middle, f"{text} ", ha="right", va="center", fontsize=style.small())
    else:
        axes.annotate(
            text,
            middle,
            (0.0, -3.0),
            textcoords="offset points",
            ha="center",
            va="top",
            fontsize=style.small(),
        )


def _tonnes(mass: float) -> str:
    return f"{1e-3 * mass:.4g} t"
