"""The structure at rest, drawn to scale with its dimensions; and its modes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.modal import ModalResult
from rpscli.model.podium import PodiumStructure
from rpscli.report.figures import style
from rpscli.report.figures.bearing import BEAM, COLUMN, leaning_outline, measure

STOREY_HEIGHT = 3.0  # drawn for a case that gives none [m]


def level_heights(structure: PodiumStructure) -> NDArray[np.float64]:
    """Heights of the cap beam and of the floors above it at rest, (n + 1,) [m]."""
    column = 2.0 * structure.bearing.half_height
    building = structure.superstructure
    if building is None:
        return np.array([column])
    heights = building.storey_heights
    storeys = np.full(building.storeys, STOREY_HEIGHT) if heights is None else heights
    return column + np.concatenate([[0.0], np.cumsum(storeys)])


COLUMNS = 3  # columns under a cap beam: their number and distances are not drawn to scale
MOST_LEVELS = 20  # with more storeys, their heights are not written one by one


def structure_figure(structure: PodiumStructure, title: str) -> bytes:
    """Elevation with heights and masses."""
    return style.single(draw_structure, structure, (title,), 4.4, 5.0)


def draw_structure(axes: style.Axes, structure: PodiumStructure) -> None:
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


MOST_MODES = 3  # vibration modes that are drawn, at most
ELASTIC = "elastic shape (over the cap beam)"
NORMALISED = "shapes scaled to 1 at their largest component"


def modes_figure(result: ModalResult, title: str) -> bytes:
    """The storey's own mode and the first vibration modes: one column a mode, one row a state."""
    width, height = modes_size(result)
    return style.picture(lambda figure: draw_modes(figure, result, title), height, width)


def modes_size(result: ModalResult) -> tuple[float, float]:
    """Width and height of the figure [in]."""
    width = 1.0 + 1.5 * (1 + min(MOST_MODES, result.structure.storeys))
    return max(width, 4.0), 0.9 + 2.1 * len(result.uplifted)


def draw_modes(figure: style.Figure, result: ModalResult, title: str) -> None:
    """Fill an empty figure."""
    states = list(result.uplifted)
    vibrations = min(MOST_MODES, result.structure.storeys)
    style.heading(figure, title, NORMALISED)
    panels = figure.subplots(len(states), 1 + vibrations, sharex=True, sharey=True, squeeze=False)
    for row, state in zip(panels, states, strict=True):
        for mode, axes in enumerate(row):
            draw_mode(axes, result, state, mode)
            axes.label_outer()
        row[0].set_ylabel(f"{state}\nheight [m]")
    reach = 1.05 * max(abs(limit) for limit in panels[0, 0].get_xlim())
    panels[0, 0].set_xlim(-reach, reach)
    style.legend_below(figure, [panels[0, -1]])


def draw_mode(axes: style.Axes, result: ModalResult, state: str, mode: int) -> None:
    """A mode, counted from 1, or 0 for the storey's own, `rolling` or `rocking`."""
    style.require("phases", state, result.uplifted)
    style.require("modes", mode, range(result.structure.storeys + 1))
    modes = result.uplifted[state]
    levels = np.concatenate([[0.0], level_heights(result.structure)])
    shape = modes.shapes[:, mode]
    if mode and result.fixed_base is not None:
        full = np.concatenate([[0.0, 0.0], result.fixed_base.shapes[:, mode - 1]])
        if result.full_contact is not None:  # in which the cap beam moves as well
            full = np.concatenate([[0.0], result.full_contact.shapes[:, mode - 1]])
        axes.plot(
            full, levels, color=style.BLACK, ls="--", marker="o", ms=2.5, label="full contact"
        )
    axes.plot([0.0, *shape], levels, color=style.BLACK, marker="o", ms=2.5, label="uplifted")
    if len(shape) > 1:
        elastic = [0.0, *(shape[1:] - shape[0])]
        axes.plot(elastic, levels[1:], color=style.RED, marker="o", ms=2.5, label=ELASTIC)
    axes.axvline(0.0, color=style.GREY, lw=0.5)
    axes.set(xlabel="shape [-]", ylabel="height [m]", ylim=(-0.02 * levels[-1], 1.03 * levels[-1]))
    if mode == 0:
        rate = f"{modes.frequency_parameter:#.3g} rad/s"
        # Where the force is the same at every displacement, nothing grows or swings.
        rate = rate if modes.frequency_parameter else "0 (neutral)"
        axes.set_title(f"storey: $p_{{ext}}$ = {rate}")
    else:
        axes.set_title(f"mode {mode}: $\\omega$ = {modes.frequencies[mode - 1]:#.3g} rad/s")
