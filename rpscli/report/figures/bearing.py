"""A column with its bearings: dimensions, states, and its forces where its moment is largest."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.column_design import ColumnDemand
from rpscli.analyses.pushover import PushoverResult
from rpscli.analyses.results import TimeHistoryResult
from rpscli.errors import UsageError
from rpscli.model.bearing import Bearing
from rpscli.model.contact import Bed
from rpscli.model.podium import PodiumStructure
from rpscli.report.figures import style
from rpscli.report.figures.devices import SceneDevices
from rpscli.report.figures.history import record_name
from rpscli.report.figures.pushover import draw_force

Array = NDArray[np.float64]

ARC_POINTS = 12


def upright_outline(bearing: Bearing) -> Array:
    """Corners of the upright column about its centre, (points, 2) [m], counter-clockwise."""
    # Up to B the ends are flat, then arcs of radius r up to B', and sides are straight.
    H, B, r = bearing.half_height, bearing.half_width, bearing.radius
    turn = np.linspace(0.0, bearing.beta, ARC_POINTS if bearing.beta > 0.0 else 1)
    corner = np.column_stack([B + r * np.sin(turn), -H + r * (1.0 - np.cos(turn))])
    right = np.vstack([corner, corner[::-1] * (1.0, -1.0)])  # upwards
    return np.vstack([right, -right])


def leaning_outline(bearing: Bearing, rotation: float, displacement: float, lift: float) -> Array:
    """Corners of the column, (points, 2) [m], turned clockwise by `rotation` [rad]."""
    cosine, sine = math.cos(rotation), math.sin(rotation)
    turn = np.array([[cosine, -sine], [sine, cosine]])
    centre = (0.5 * displacement, bearing.half_height + 0.5 * lift)
    return np.asarray(upright_outline(bearing) @ turn + centre)


def contact_points(bearing: Bearing, rotation: float, displacement: float, lift: float) -> Array:
    """Contacts of a leaning column with ground and cap beam, (2, 2) [m]; arguments as above."""
    side = math.copysign(1.0, rotation)
    reach = side * (bearing.half_width + bearing.radius * min(abs(rotation), bearing.beta))
    return np.array([[reach, 0.0], [displacement - reach, 2.0 * bearing.half_height + lift]])


COLUMN, BEAM = "#DDDDDD", "#CCE3F0"

ASPECT = 1.15  # largest height of the picture of a column over its width
LEAST_ASPECT = 0.2
"""Smallest one: stops may stand far from the column, and layouts need some height."""
END_ASPECT = 1.0  # largest height of the picture of an end over its width
LOWER_HEIGHT = 2.7  # of the end of a column and the restoring force [in]
NARROW = 1.5  # width of a picture in which a title needs more lines [in]
BESIDE = 0.35  # length of the cap beam to either side of the column, over the column's width
ROOM = (0.16, 0.10, 0.03, 0.13)
"""For dimensions: left, right, below and above the column, as parts of the picture."""


class BearingView:
    """A column between ground and cap beam, to scale; `show` leans it."""

    def __init__(self, axes: style.Axes, structure: PodiumStructure) -> None:
        self.structure, bearing = structure, structure.bearing
        self.height = 2.0 * bearing.half_height
        self.half = (1.0 + 2.0 * BESIDE) * bearing.end_half_width
        self.thickness = 0.06 * self.height
        axes.axhline(0.0, color=style.BLACK, lw=1.2)
        self.column = axes.fill([], [], fc=COLUMN, ec=style.BLACK, lw=1.0)[0]
        self.beam = None
        if structure.cap_beam_mass > 0.0:
            self.beam = axes.fill([], [], fc=BEAM, ec=style.BLACK, lw=0.7)[0]
        look: dict[str, Any] = {"color": style.RED, "ms": 4.0, "zorder": 4.0}
        self.contacts = axes.plot([], [], "o", **look)[0]
        self.thrust = axes.plot([], [], ls=(0, (5, 3)), lw=0.7, color=style.RED)[0]
        self.devices = SceneDevices(axes, structure.devices, np.zeros(1), self.half, self.height)
        axes.set(xticks=[], yticks=[])
        axes.grid(visible=False)
        beam = [] if self.beam is None else [self.beam]
        parts = [self.column, *beam, self.thrust, self.contacts, *self.devices.moving]
        self.moving: list[style.Artist] = parts

    def show(self, rotation: float) -> tuple[float, float]:
        """Lean the column to a rotation [rad]; u_b and v_b there [m]."""
        # The dashed line joins the contacts: the weight restores as long as it leans the other way.
        bearing = self.structure.bearing
        _, u, v = self.structure.path(np.array([abs(rotation)]))
        shift, lift = math.copysign(float(u[0]), rotation), float(v[0])
        self.column.set_xy(leaning_outline(bearing, rotation, shift, lift))
        touching = contact_points(bearing, rotation, shift, lift)
        self.thrust.set_data(*touching.T)
        if rotation == 0.0:  # both edges of the flat part
            touching = np.array([(side * x, y) for x, y in touching for side in (1.0, -1.0)])
            self.thrust.set_data([], [])
        if self.beam is None:
            touching = touching[: len(touching) // 2]  # nothing stands on it
        self.contacts.set_data(*touching.T)
        if self.beam is not None:
            low = self.height + lift
            left, right, top = shift - self.half, shift + self.half, low + self.thickness
            self.beam.set_xy([(left, low), (right, low), (right, top), (left, top)])
        self.devices.show(shift, lift)
        return shift, lift


def bearing_figure(result: PushoverResult, title: str) -> bytes:
    """The states of a column, an end of it enlarged, and the restoring force with the states."""
    structure = result.structure
    beta, critical = structure.bearing.beta, structure.critical_rotation
    states = [0.0, *([beta] if 0.0 < beta < critical else []), critical]
    narrow = style.narrow()
    rows, columns = (2, 2) if narrow else (1, 3)

    def draw(figure: style.Figure) -> None:
        style.heading(figure, title)
        grid = figure.add_gridspec(2, 1)
        above, below = (figure.add_subfigure(grid[row]) for row in (0, 1))
        cells = above.subplots(rows, columns).ravel()
        for axes, rotation in zip(cells, states, strict=False):
            draw_bearing(axes, structure, rotation)
        if len(states) < len(cells):
            end, force = cells[len(states)], below.subplots()
        else:
            end, force = below.subplots(1, 2, width_ratios=[1.0, 2.0])
        style.blank(cells[len(states) + 1 :])
        draw_end(end, structure.bearing, structure.bed)
        draw_force(force, result)
        # As high as columns are with their titles: wide ones leave no gap.
        width = style.inches(figure)[0]
        heights = [rows * (width / columns * float(cells[0].get_box_aspect()) + 0.6), LOWER_HEIGHT]
        grid.set_height_ratios(heights)
        if style.given() is None:
            figure.set_size_inches(width, 0.3 + sum(heights))
        style.legend_below(figure, cells[: len(states)])

    return style.picture(draw, 6.2)


def draw_bearing(axes: style.Axes, structure: PodiumStructure, rotation: float = 0.0) -> None:
    """A column at a rotation [rad]: its dimensions at rest, displacement and lift if it leans."""
    if not abs(rotation) < 0.5 * math.pi:
        raise UsageError(f"rotation = {rotation:g} rad must be less than a quarter turn, 1.57 rad")
    bearing, critical = structure.bearing, structure.critical_rotation
    view = BearingView(axes, structure)
    u, v = view.show(rotation)
    height, half = view.height, view.half
    _, far, high = structure.path(np.array([max(abs(rotation), critical)]))
    posts = [half + gap for _, gap, _ in view.devices.stops]
    right, left = max(float(far[0]) + half, *posts, 0.0), max(half, *posts, 0.0)
    if rotation < 0.0:
        left, right = right, left
    corners = (-left, right, 0.0, height + float(high[0]) + view.thickness)
    _frame(axes, corners, ROOM, ASPECT)
    axes.set_axis_off()
    title = _state(bearing, critical, rotation, u, v)
    if axes.get_window_extent().width / axes.figure.dpi < NARROW:
        title = title.replace(", ", "\n").replace(": ", "\n")
    axes.set_title(title, fontsize=style.small())
    if rotation == 0.0:
        _draw_dimensions(axes, bearing)
        return
    grey: dict[str, Any] = {"color": style.GREY, "lw": 0.7, "ls": ":"}
    x, y = leaning_outline(bearing, 0.0, 0.0, 0.0).T
    axes.plot([*x, x[0]], [*y, y[0]], **grey)
    top = height + v + 2.2 * view.thickness
    for at in (0.0, u):
        axes.plot([at, at], [height, top], **grey)
    _arrow(axes, (0.0, top), (u, top), "$u_b$", (0.0, 2.0))
    at = u + math.copysign(0.75 * half, rotation)
    axes.plot([0.0, at], [height, height], **grey)
    if view.beam is None:
        axes.plot([u, at], [height + v, height + v], **grey)
    _arrow(axes, (at, height), (at, height + v), "$v_b$", (0.0, -2.0), at_end=True)


def draw_end(axes: style.Axes, bearing: Bearing, bed: Bed | None = None) -> None:
    """The lower end of a column at rest, enlarged: its widths, the radius, the edge's height."""
    half, B = bearing.end_half_width, bearing.half_width
    x, y = leaning_outline(bearing, 0.0, 0.0, 0.0).T
    axes.axhline(0.0, color=style.BLACK, lw=1.2)
    axes.fill(x, y, fc=COLUMN, ec=style.BLACK, lw=1.0)
    axes.plot([-B, B], [0.0, 0.0], color=style.RED, lw=2.5, solid_capstyle="butt")
    frame_end(axes, bearing, below=0.42)
    axes.set_axis_off()
    step = 0.08 * (axes.get_ylim()[1] - axes.get_ylim()[0])
    if B > 0.0:
        measure(axes, (-B, -step), (B, -step), f"2B = {2.0 * B:.4g} m")
    title = "an end, enlarged: flat"
    if not bearing.is_flat:
        measure(axes, (-half, -3.2 * step), (half, -3.2 * step), f"2B' = {2.0 * half:.4g} m")
        edge = bearing.radius * (1.0 - math.cos(bearing.beta))
        axes.plot([half, 1.5 * half], [edge, edge], color=style.GREY, lw=0.7, ls=":")
        middle = 0.5 * bearing.beta
        arc = (B + bearing.radius * math.sin(middle), bearing.radius * (1.0 - math.cos(middle)))
        axes.annotate(
            f"r = {bearing.radius:.4g} m\nβ = {bearing.beta:.3g} rad",
            arc, (0.0, 4.0 * step), arrowprops={"arrowstyle": "->", "lw": 0.6},
            ha="center", va="center", fontsize=style.small(),
        )  # fmt: skip
        words = f"{1e3 * edge:.3g} mm"
        style.note(axes, words, (1.06 * half, edge), (0.0, 3.0), ha="left")
        title = "an end, enlarged"
    if bed is not None and bed.contact_share is not None:
        x, y = B * (1.0 - 2.0 * bed.contact_share), -3.2 * step
        axes.plot([x, B], [y, y], color=style.RED, lw=2.5, solid_capstyle="butt")
        words = f"{1e3 * (B - x):.3g} mm in contact at α/10"
        style.note(axes, words, (B, y), (0.0, -4.0), ha="right")
    axes.set_title(title, fontsize=style.small())


def frame_end(axes: style.Axes, bearing: Bearing, below: float = 0.1) -> None:
    """Bring the lower end of a column into view; `below` the ground, as a part of the picture."""
    half = bearing.end_half_width
    _frame(axes, (-half, half, 0.0, 0.0), (0.2, 0.2, below, 1.0 - below), END_ASPECT)


def _state(bearing: Bearing, critical: float, rotation: float, u: float, v: float) -> str:
    """The title of a panel, in two lines."""
    if rotation == 0.0:
        return f"at rest\n$\\alpha$ = {bearing.alpha:.3g} rad, $R$ = {bearing.semi_diagonal:.4g} m"
    name = f"$\\theta$ = {rotation:.3g} rad"
    if rotation == bearing.beta:
        name = f"end of rolling: $\\beta$ = {rotation:.3g} rad"
    elif rotation == critical:
        name = f"critical: $\\theta_{{cr}}$ = {rotation:.3g} rad"
    return f"{name}\n$u_b$ = {u:.3g} m, $v_b$ = {1e3 * v:.3g} mm"


def _draw_dimensions(axes: style.Axes, bearing: Bearing) -> None:
    """R from the middle of the column to the edge, and the height."""
    H, B = bearing.half_height, bearing.half_width
    axes.plot([0.0, B], [H, 0.0], color=style.RED, lw=1.0)
    axes.plot([0.0, 0.0], [0.0, H], color=style.RED, lw=0.6, ls=(0, (6, 3)))
    axes.plot(0.0, H, "o", color=style.RED, ms=3.0)
    look: dict[str, Any] = {"ha": "left", "va": "baseline", "color": style.RED}
    style.note(axes, "$R$", (0.5 * B, 0.5 * H), (3.0, 0.0), **look)
    if B > 0.0:
        style.note(axes, "$\\alpha$", (0.0, 0.45 * H), (-9.0, 0.0), **look)
    start, end = axes.get_xlim()
    left = start + 0.14 * (end - start)
    measure(axes, (left, 0.0), (left, 2.0 * H), f"2H = {2.0 * H:.4g} m", turned=True)


def _frame(
    axes: style.Axes,
    content: tuple[float, float, float, float],
    room: tuple[float, float, float, float],
    aspect: float,
) -> None:
    """Limits of one scale both ways; `room` is kept free, in its parts; `aspect` at most."""
    left, right, bottom, top = content
    across, upwards = 1.0 - room[0] - room[1], 1.0 - room[2] - room[3]
    width = (right - left) / across
    if upwards > 0.0:
        width = max(width, (top - bottom) / upwards / aspect)
        aspect = min(aspect, max(LEAST_ASPECT, (top - bottom) / upwards / width))
    floor = bottom - room[2] * aspect * width
    start = 0.5 * (left + right) - width * (room[0] + 0.5 * across)
    axes.set(xlim=(start, start + width), ylim=(floor, floor + aspect * width))
    axes.set_box_aspect(aspect)


def measure(
    axes: style.Axes, start: style.At, end: style.At, text: str, *, turned: bool = False
) -> None:
    """A dimension line with arrows at both ends and its text beside: on its left or below."""
    offset = (-3.0, 0.0) if start[0] == end[0] else (0.0, -3.0)
    _arrow(axes, start, end, text, offset, turned=turned)


def _arrow(
    axes: style.Axes,
    start: style.At,
    end: style.At,
    text: str,
    offset: style.At,
    *,
    turned: bool = False,
    at_end: bool = False,
) -> None:
    """A double arrow with a text, offset [pt] from its middle or from its start."""
    line = {"arrowstyle": "<->", "lw": 0.6, "color": style.BLACK, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", end, start, arrowprops=line)
    at = start if at_end else (0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1]))
    style.note(axes, text, at, offset, rotation=90.0 if turned else 0.0)


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
