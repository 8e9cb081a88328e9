"""The structure at rest, to scale with its dimensions; its
modes; its forces when pushed.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.modal import ModalResult
from rpscli.analyses.pushover import PushoverResult
from rpscli.errors import UsageError
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import Superstructure
from rpscli.report.figures import style
from rpscli.report.figures.bearing import (
    BEAM,
    COLUMN,
    draw_bearing,
    draw_end,
    measure,
    outline,
)

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
EDGE = 0.62  # of the ground on both sides, where dimensions stand, over the width


def draw_structure(axes: style.Axes, structure: PodiumStructure) -> None:
    """Columns, cap beam and storeys at rest."""
    axes.set_aspect("equal")
    axes.axis("off")
    levels = level_heights(structure)
    height = float(levels[0])
    width = 1.5 * max(height, 0.35 * float(levels[-1]))
    count = COLUMNS if structure.cap_beam_mass > 0.0 else 1
    for foot in np.linspace(-0.4, 0.4, count) * width if count > 1 else np.zeros(1):
        x, y = (outline(structure.bearing) + np.array([foot, 0.0])).T
        axes.fill(x, y, fc=COLUMN, ec=style.BLACK, lw=0.7)
    edge = EDGE * width
    axes.plot([-edge, edge], [0.0, 0.0], color=style.BLACK, lw=1.2)
    measure(axes, (-edge, 0.0), (-edge, height), f"2H = {height:.4g} m")
    columns = f"columns: {_tonnes(structure.columns_mass)}"
    if count == 1:
        axes.set_title(columns, fontsize=style.small())
        return
    thickness = 0.12 * height
    left = -0.5 * width
    top = height + thickness
    corners = [(left, height), (-left, height), (-left, top), (left, top)]
    axes.fill(*zip(*corners, strict=True), fc=BEAM, ec=style.BLACK, lw=0.7)
    beside = partial(axes.text, edge, va="center", fontsize=style.small())
    beside(0.5 * height, f" {columns}")
    beside(height + 0.5 * thickness, f" cap beam: {_tonnes(structure.cap_beam_mass)}")
    if structure.superstructure is not None:
        _draw_storeys(axes, structure.superstructure, levels, width, thickness)


def _draw_storeys(
    axes: style.Axes,
    building: Superstructure,
    levels: NDArray[np.float64],
    width: float,
    above: float,
) -> None:
    """Floors with their masses and heights, so far above `level_heights`, and walls."""
    edge = EDGE * width
    few = building.storeys <= MOST_LEVELS
    for below, level, mass in zip(levels, levels[1:], building.masses, strict=False):
        axes.plot(
            [-0.5 * width, 0.5 * width], [level + above] * 2, color=style.BLUE, lw=2.2
        )
        if few:
            text = f" {_tonnes(float(mass))}"
            axes.text(edge, level + above, text, va="center", fontsize=style.small())
        if few and building.storey_heights is not None:
            feet = (-edge, below + above), (-edge, level + above)
            measure(axes, *feet, f"{level - below:.4g} m")
    for side in (-0.5, 0.5):
        ends = [levels[0], levels[-1] + above]
        axes.plot([side * width] * 2, ends, color=style.BLUE, lw=0.8)

    scale = "heights to scale, widths not"
    if building.storey_heights is None:
        scale = "storey heights are not given: drawn as 3 m"
    axes.set_title(scale, fontsize=style.small(), color=style.GREY)


def _tonnes(mass: float) -> str:
    return f"{1e-3 * mass:.4g} t"


MOST_MODES = 3  # vibration modes that are drawn, at most
ELASTIC = "elastic shape (over the cap beam)"
NORMALISED = "shapes scaled to 1 at their largest component"


def modes_figure(result: ModalResult, title: str, figure: style.Figure) -> None:
    """The podium's own mode and the first vibration modes: one column
    a mode, one row a state.
    """
    states = list(result.uplifted)
    vibrations = min(MOST_MODES, result.structure.storeys)
    width = max(1.0 + 1.5 * (1 + vibrations), 4.0)
    style.begin(figure, (title, NORMALISED), 0.9 + 2.1 * len(states), width)
    both = [(state, mode) for state in states for mode in range(1 + vibrations)]
    draws = [
        partial(draw_mode, result=result, state=state, mode=mode) for state, mode in both
    ]
    panels = style.grid(figure, draws, 1 + vibrations, sharex=True, sharey=True)
    for axes, state in zip(panels[:: 1 + vibrations], states, strict=True):
        axes.set_ylabel(f"{state}\nheight [m]")
    reach = 1.05 * max(abs(limit) for limit in panels[0].get_xlim())
    panels[0].set_xlim(-reach, reach)
    style.legend_below(figure, [panels[vibrations]])


DOTS: dict[str, Any] = {"marker": "o", "ms": 2.5}


def draw_mode(axes: style.Axes, result: ModalResult, state: str, mode: int) -> None:
    """A mode, counted from 1, or 0 for the podium's own, `rolling` or `rocking`."""
    style.require("phases", state, result.uplifted)
    style.require("modes", mode, range(result.structure.storeys + 1))
    modes = result.uplifted[state]
    levels = np.concatenate([[0.0], level_heights(result.structure)])
    shape = modes.shapes[:, mode]
    lifts = not result.structure.bearing.is_spherical
    if mode and result.fixed_base is not None:
        full = np.concatenate([[0.0, 0.0], result.fixed_base.shapes[:, mode - 1]])
        if result.full_contact is not None:  # in which the cap beam moves as well
            full = np.concatenate([[0.0], result.full_contact.shapes[:, mode - 1]])
        name = "full contact" if lifts else "fixed base"
        axes.plot(full, levels, color=style.BLACK, ls="--", label=name, **DOTS)
    name = "uplifted" if lifts else "on bearings"
    axes.plot([0.0, *shape], levels, color=style.BLACK, label=name, **DOTS)
    if len(shape) > 1:
        elastic = [0.0, *(shape[1:] - shape[0])]
        axes.plot(elastic, levels[1:], color=style.RED, label=ELASTIC, **DOTS)
    axes.axvline(0.0, color=style.GREY, lw=0.5)
    axes.set(
        xlabel="shape [-]",
        ylabel="height [m]",
        ylim=(-0.02 * levels[-1], 1.03 * levels[-1]),
    )
    if mode == 0:
        rate = f"{modes.frequency_parameter:#.3g} rad/s"
        # Where the force is the same at every displacement, nothing grows or swings.
        rate = rate if modes.frequency_parameter else "0 (neutral)"
        axes.set_title(f"podium: $p_{{ext}}$ = {rate}")
    else:
        axes.set_title(
            f"mode {mode}: $\\omega$ = {modes.frequencies[mode - 1]:#.3g} rad/s"
        )


LOWER_HEIGHT = 2.7  # of the end of a column and the restoring force [in]


def bearing_figure(result: PushoverResult, title: str, figure: style.Figure) -> None:
    """The states of a column, an end of it enlarged, and the
    restoring force with the states.
    """
    structure = result.structure
    beta = structure.bearing.beta
    critical = structure.critical_rotation
    states = [0.0, *([beta] if 0.0 < beta < critical else []), critical]
    rows, columns = (2, 2) if style.narrow(figure) else (1, 3)
    style.begin(figure, (title,), 6.2)
    grid = figure.add_gridspec(2, 1)
    above, below = (figure.add_subfigure(grid[row]) for row in (0, 1))
    cells = above.subplots(rows, columns).ravel()
    for axes, rotation in zip(cells, states, strict=False):
        draw_bearing(axes, structure, rotation)
    if len(states) < len(cells):
        end = cells[len(states)]
        force = below.subplots()
    else:
        end, force = below.subplots(1, 2, width_ratios=[1.0, 2.0])
    style.blank(cells[len(states) + 1 :])
    draw_end(end, structure.bearing, structure.bed)
    draw_force(force, result)
    # As high as columns are with their titles: wide ones leave no gap.
    width = style.inches(figure)[0]
    heights = [
        rows * (width / columns * float(cells[0].get_box_aspect()) + 0.6),
        LOWER_HEIGHT,
    ]
    grid.set_height_ratios(heights)
    figure.set_size_inches(width, 0.3 + sum(heights))
    style.legend_below(figure, cells[: len(states)])


DISPLACEMENT = "cap beam displacement $u_b$ [m]"


def storey_curve_figure(result: PushoverResult, title: str, figure: style.Figure) -> None:
    """Force and lift of the cap beam against its displacement,
    to the critical rotation.
    """
    style.begin(figure, (title, "podium alone"), 4.8, 5.8)
    panels = [partial(draw_one, result=result) for draw_one in (draw_force, draw_lift)]
    style.grid(figure, panels, ratios=[2.6, 1.0], sharex=True)


def draw_force(axes: style.Axes, result: PushoverResult) -> None:
    """Force against displacement, rolling and rocking, and back where
    the way back is another.
    """
    curve = result.curve
    beta = result.structure.bearing.beta
    factor, prefix = style.engineering(float(np.max(curve.force)))
    u = curve.displacement
    F = factor * curve.force
    back = factor * curve.unloading_force
    returns = bool(np.any(back != F))
    lifts = not result.structure.bearing.is_spherical
    if returns:
        axes.axhline(0.0, color=style.GREY, lw=0.6)
    if F[0] > 0.0:
        name = "full contact" if lifts else "held upright"
        axes.plot([0.0, 0.0], [0.0, F[0]], color=style.BLACK, lw=2.0, label=name)
    for inside, colour, name in _phases(result):
        axes.plot(u[inside], F[inside], color=colour, lw=2.0, label=name)
        if returns:
            axes.plot(u[inside], back[inside], color=colour, lw=1.5, ls="--")
    if returns:
        axes.plot([], [], color=style.GREY, lw=1.5, ls="--", label="on the way back")
    rises = F[1] > F[0] > 0.15 * F.max()  # and there is room below
    # Above the name of beta, if that stands to the left of its point.
    higher = 18.0 if returns else 6.0
    if F[0] > 0.0:
        begins = "uplift" if lifts else "rolling begins"
        _mark(axes, 0.0, F[0], begins, (8.0, -4.0 if rises else higher))
    if 0.0 < beta < result.critical_rotation:
        at = int(np.searchsorted(curve.rotation, beta))
        side = (-7.0 if F[at + 1] > F[at] else 7.0, 6.0)
        _mark(axes, u[at], F[at], f"$\\beta$ = {beta:.3f} rad", side)
    critical = f"$\\theta_{{cr}}$ = {result.critical_rotation:.3f} rad"
    _mark(axes, u[-1], F[-1], critical, (-44.0, 3.0))
    low = min(0.0, back.min()) if returns or result.structure.bed else 0.0
    axes.set(xlim=(-0.02 * u[-1], 1.04 * u[-1]), ylim=(1.1 * low, 1.18 * F.max()))
    axes.set(xlabel=DISPLACEMENT, ylabel=f"force at the cap beam [{prefix}N]")
    if result.structure.uplift_force > 0.0:
        uplift = factor * result.structure.uplift_force
        over = (lambda force: force / uplift), (lambda ratio: ratio * uplift)
        ratio = axes.secondary_yaxis("right", functions=over)
        ratio.set_ylabel("$F/(W \\tan\\alpha)$ [-]")
    style.legend_above(axes)


def draw_lift(axes: style.Axes, result: PushoverResult) -> None:
    """Lift against displacement."""
    u = result.curve.displacement
    lift = 1e3 * result.curve.lift
    for inside, colour, _ in _phases(result):
        axes.plot(u[inside], lift[inside], color=colour, lw=2.0)
    axes.set(ylim=(0.0, None), ylabel="lift [mm]", xlabel=DISPLACEMENT)


def _phases(result: PushoverResult) -> Iterator[tuple[NDArray[np.bool_], str, str]]:
    """Points of the curve in each phase that there is, its colour and its name."""
    rotation = result.curve.rotation
    beta = result.structure.bearing.beta
    phases = (
        (rotation <= beta, style.BLUE, "rolling"),
        (rotation >= beta, style.RED, "rocking"),
    )
    yield from (phase for phase in phases if np.count_nonzero(phase[0]) > 1)


def _mark(axes: style.Axes, x: float, y: float, text: str, offset: style.At) -> None:
    """A point with its name, offset [pt] to the side on which no curve runs."""
    axes.plot(x, y, "o", color=style.BLACK, ms=5.0, zorder=5, clip_on=False)
    style.note(axes, text, (x, y), offset)


LOOKS = ((style.SKY, "-"), (style.RED, "-"), (style.BLACK, "-"), (style.PINK, ":"))


def capacity_figure(result: PushoverResult, title: str, figure: style.Figure) -> None:
    """Sum of floor forces against roof displacement, whole and close to the uplift."""
    lifts = np.array([curve.roof_displacement_at_uplift for curve in result.capacity])
    never = bool(np.isnan(lifts).all())
    ending = "a mechanism" if never else "the critical rotation"
    style.begin(figure, (title, f"floor forces pushed to {ending}"), 3.6)
    ratios = [1.6] if never else [1.6, 1.0]
    panels = figure.subplots(1, len(ratios), width_ratios=ratios, squeeze=False)[0]
    for axes in panels:
        draw_capacity(axes, result)
    if not never:
        whole, close = panels
        uplift = float(np.nanmax(lifts))
        close.set_xlim(0.0, 3.0 * uplift or 0.1 * whole.get_xlim()[1])
        close.locator_params(axis="x", nbins=3 if style.narrow(figure) else 5)
        close.set_ylim(whole.get_ylim()[0], _largest_within(close, result))
        close.set(ylabel="", title=f"near {begins_with(result)}")
    style.legend_below(figure, panels[-1:])


def begins_with(result: PushoverResult) -> str:
    """What the motion of the columns begins with."""
    lifts = result.uplift_force and not result.structure.bearing.is_spherical
    return "uplift" if lifts else "the beginning of rolling"


def _largest_within(axes: style.Axes, result: PushoverResult) -> float:
    """Upper end of an axis of forces that holds all curves within its displacements."""
    factor, _ = style.engineering(
        max(c.sum_of_floor_forces.max() for c in result.capacity)
    )
    end = axes.get_xlim()[1]
    inside = [
        factor * curve.sum_of_floor_forces[curve.roof_displacement <= end]
        for curve in result.capacity
    ]
    return 1.15 * max(float(each.max(initial=0.0)) for each in inside) or 1.0


def draw_capacity(axes: style.Axes, result: PushoverResult) -> None:
    """Sum of floor forces against roof displacement by pattern, and where it uplifts."""
    if not result.capacity:
        raise UsageError(
            "a structure without storeys has no capacity curve; draw `storey_curve`"
        )
    factor, prefix = style.engineering(
        max(c.sum_of_floor_forces.max() for c in result.capacity)
    )
    for k, curve in enumerate(result.capacity):
        colour, line = LOOKS[
            k % len(LOOKS)
        ]  # curves may coincide: the first is the widest
        axes.plot(
            curve.roof_displacement, factor * curve.sum_of_floor_forces,
            color=colour, ls=line, lw=3.6 / (k + 1), label=curve.pattern.replace("_", " "),
        )  # fmt: skip
        axes.plot(
            curve.roof_displacement_at_uplift, factor * result.uplift_force, "o",
            color=colour, ms=4.5, clip_on=False,
        )  # fmt: skip
        for force in sorted(curve.yielding.values())[:1]:
            at = int(np.argmax(curve.sum_of_floor_forces >= force))
            roof = curve.roof_displacement[at]
            axes.plot(roof, factor * force, "D", color=colour, ms=4.5, clip_on=False)
    if any(curve.roof_displacement_at_uplift >= 0.0 for curve in result.capacity):
        axes.plot([], [], "o", color=style.GREY, ms=4.5, label=begins_with(result))
    if any(curve.yielding for curve in result.capacity):
        axes.plot([], [], "D", color=style.GREY, ms=4.5, label="first yield of a storey")
    lowest = min(0.0, *(factor * np.min(c.sum_of_floor_forces) for c in result.capacity))
    axes.set(xlim=(0.0, None), ylim=(lowest, None), xlabel="roof displacement [m]")
    axes.set_ylabel(f"sum of floor forces [{prefix}N]")
