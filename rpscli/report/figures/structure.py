"""The structure at rest, drawn to scale with its dimensions."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rpscli.model.podium import PodiumStructure
from rpscli.report.figures import style
from rpscli.report.figures.bearing import BEAM, COLUMN, leaning_outline, measure

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from rpscli.model.podium import PodiumStructure


STOREY_HEIGHT = 3.0
"""Where the case gives none [m]."""


def level_heights(structure: PodiumStructure) -> NDArray[np.float64]:
    """Heights of the cap beam and of the floors above it at rest, (n + 1,) [m]."""
    column = 2.0 * structure.bearing.half_height
    building = structure.superstructure
    if building is None:
        return np.array([column])
    heights = building.storey_heights
    storeys = np.full(building.storeys, STOREY_HEIGHT) if heights is None else heights
    return column + np.concatenate([[0.0], np.cumsum(storeys)])


COLUMNS = 3
"""Columns under a cap beam: their number and distances are not drawn to scale."""
MOST_LEVELS = 20
"""With more storeys, their heights are not written one by one."""


def structure_figure(structure: PodiumStructure, title: str) -> bytes:
    """Elevation with heights and masses."""
    return style.single(draw_structure, structure, (title,), 4.4, 5.0)


def draw_structure(axes: Axes, structure: PodiumStructure) -> None:
    """Columns, cap beam and storeys at rest."""
    axes.set_aspect("equal")
    axes.axis("off")
    levels = level_heights(structure)
    height = float(levels[0])
    width = 1.5 * max(height, 0.35 * float(levels[-1]))
    count = COLUMNS if structure.cap_beam_mass > 0.0 else 1
    outline = leaning_outline(structure.bearing, 0.0, 0.0, 0.0)
    for foot in np.linspace(-0.4, 0.4, count) * width if count > 1 else np.zeros(1):
        x, y = (outline + np.array([foot, 0.0])).T
        axes.fill(x, y, fc=COLUMN, ec=style.BLACK, lw=0.7)
    edge = 0.62 * width
    axes.plot([-edge, edge], [0.0, 0.0], color=style.BLACK, lw=1.2)
    measure(axes, (-edge, 0.0), (-edge, height), f"2H = {height:.4g} m")
    columns = f"columns: {_tonnes(structure.columns_mass)}"
    if count == 1:
        axes.set_title(columns, fontsize=style.small())
        return
    thickness = 0.12 * height
    left, top = -0.5 * width, height + thickness
    corners = [(left, height), (-left, height), (-left, top), (left, top)]
    axes.fill(*zip(*corners, strict=True), fc=BEAM, ec=style.BLACK, lw=0.7)
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
            measure(axes, *feet, f"{level - below:.4g} m")
    for side in (-0.5, 0.5):
        axes.plot([side * width] * 2, [levels[0], levels[-1] + thickness], color=style.BLUE, lw=0.8)
    scale = "heights to scale, widths not"
    if building.storey_heights is None:
        scale = "storey heights are not given: drawn as 3 m"
    axes.set_title(scale, fontsize=style.small(), color=style.GREY)


def _tonnes(mass: float) -> str:
    return f"{1e-3 * mass:.4g} t"
