"""A column with its bearings and devices: dimensions, states, largest forces, loops."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.column_design import ColumnDemand
from rpscli.analyses.results import TimeHistoryResult
from rpscli.errors import UsageError
from rpscli.model import devices as laws
from rpscli.model.bearing import Bearing
from rpscli.model.contact import Bed
from rpscli.model.podium import Device, PodiumStructure
from rpscli.report.figures import style
from rpscli.report.figures.history import named_device, record_name

if TYPE_CHECKING:
    from matplotlib.lines import Line2D

Array = NDArray[np.float64]

BRACE, POSTS, CABLES, NOWHERE = range(4)  # signs for devices in pictures of the structure


class Drawn(NamedTuple):
    """The drawing of a law; resistance, the force on the cap beam
    turned round, has the sign -1.
    """

    scene: int
    force: str = "resistance"
    stroke: str = "$u_b$ [m]"
    sign: float = -1.0


DRAWN: dict[type[Device], Drawn] = {
    laws.ViscousDamper: Drawn(BRACE),
    laws.FrictionDamper: Drawn(BRACE),
    laws.OwnDamper: Drawn(BRACE),
    laws.Stop: Drawn(POSTS),
    laws.Tendon: Drawn(CABLES, "tension of one", "elongation of one [m]", 1.0),
    laws.RollingResistance: Drawn(NOWHERE),
}
"""All laws; the one place that a new one is drawn from."""

ARC_POINTS = 12


def outline(
    bearing: Bearing, rotation: float = 0.0, displacement: float = 0.0, lift: float = 0.0
) -> Array:
    """Corners of the column, (points, 2) [m], counter-clockwise; turned
    clockwise by `rotation`.
    """
    # Up to B the ends are flat, then arcs of radius r up to B', and sides are straight.
    H = bearing.half_height
    B = bearing.half_width
    r = bearing.radius
    arc = np.linspace(0.0, bearing.beta, ARC_POINTS if bearing.beta > 0.0 else 1)
    corner = np.column_stack([B + r * np.sin(arc), -H + r * (1.0 - np.cos(arc))])
    right = np.vstack([corner, corner[::-1] * (1.0, -1.0)])  # upwards
    cosine = math.cos(rotation)
    sine = math.sin(rotation)
    turned = np.vstack([right, -right]) @ np.array([[cosine, -sine], [sine, cosine]])
    return np.asarray(turned + np.array([0.5 * displacement, H + 0.5 * lift]))


def displaced(structure: PodiumStructure, rotation: float) -> tuple[float, float]:
    """u_b, to the side of the rotation [rad], and v_b [m]."""
    _, u, v = structure.path(np.array([abs(rotation)]))
    return math.copysign(float(u[0]), rotation), float(v[0])


def contact_points(
    bearing: Bearing, rotation: float, displacement: float, lift: float
) -> Array:
    """Contacts of a leaning column with ground and cap beam, (2, 2)
    [m]; arguments as above.
    """
    side = math.copysign(1.0, rotation)
    reach = side * (
        bearing.half_width + bearing.radius * min(abs(rotation), bearing.beta)
    )
    return np.array(
        [[reach, 0.0], [displacement - reach, 2.0 * bearing.half_height + lift]]
    )


COLUMN = "#DDDDDD"
BEAM = "#CCE3F0"

ASPECT = 1.15  # largest height of the picture of a column over its width
LEAST_ASPECT = 0.2
"""Smallest one: stops may stand far from the column, and layouts need some height."""
END_ASPECT = 1.0  # largest height of the picture of an end over its width
NARROW = 1.5  # width of a picture in which a title needs more lines [in]
BESIDE = (
    0.35  # length of the cap beam to either side of the column, over the column's width
)
ROOM = (0.16, 0.10, 0.03, 0.13)
"""For dimensions: left, right, below and above the column, as parts of the picture."""


class SceneDevices:
    """Devices in pictures of the structure, moved with the cap beam;
    a legend has their names.
    """

    # Posts stand at the gap of each stop, red and pushed aside beyond it; dampers share a
    # brace; cables stand where the feet of the columns do. `half` is half the width of
    # the beam, `base` the height of its underside at rest [m].
    def __init__(
        self,
        axes: style.Axes,
        devices: Sequence[Device],
        feet: Array,
        half: float,
        base: float,
    ) -> None:
        self.feet = feet
        self.half = half
        self.base = base
        by_scene: dict[int, list[Any]] = {BRACE: [], POSTS: [], CABLES: [], NOWHERE: []}
        for device in devices:
            by_scene[DRAWN[type(device)].scene].append(device)
        self.stops: list[tuple[float, float, Line2D]] = [
            (
                side,
                stop.gap,
                axes.plot([], [], color=style.BLACK, lw=2.5, label="stop")[0],
            )
            for stop in by_scene[POSTS]
            for side in (-1.0, 1.0)
        ]
        cable: dict[str, Any] = {"color": style.PINK, "lw": 1.5, "label": "tendon"}
        count = len(feet) if by_scene[CABLES] else 0
        self.tendons = [axes.plot([], [], **cable)[0] for _ in range(count)]
        kinds = dict.fromkeys(device.kind.replace("_", " ") for device in by_scene[BRACE])
        look: dict[str, Any] = {
            "color": style.GREEN,
            "lw": 1.5,
            "marker": "s",
            "markevery": [1],
        }
        look["label"] = f"{' and '.join(kinds)} damper"
        self.brace = axes.plot([], [], **look, ms=5.0)[0] if kinds else None

    def show(self, shift: float, lift: float) -> None:
        """Move them with the cap beam, displaced and lifted [m]."""
        for side, gap, post in self.stops:
            at = side * (self.half + gap)
            pushed = max(side * shift - gap, 0.0)
            post.set_data([at, at + side * pushed], [0.0, 1.06 * self.base])
            post.set_color(style.RED if pushed else style.BLACK)
            post.set_label("stop, reached" if pushed else "stop")
        for foot, tendon in zip(self.feet, self.tendons, strict=False):
            tendon.set_data([foot, foot + shift], [0.0, self.base + lift])
        if self.brace is not None:
            start = -0.75 * self.half
            end = shift - 0.45 * self.half
            top = self.base + lift
            self.brace.set_data([start, 0.5 * (start + end), end], [0.0, 0.5 * top, top])


class BearingView:
    """A column between ground and cap beam, to scale; `show` leans it."""

    def __init__(self, axes: style.Axes, structure: PodiumStructure) -> None:
        self.structure = structure
        bearing = structure.bearing
        self.height = 2.0 * bearing.half_height
        self.half = (1.0 + 2.0 * BESIDE) * bearing.end_half_width
        self.thickness = 0.06 * self.height
        axes.axhline(0.0, color=style.BLACK, lw=1.2)
        self.column = axes.fill([], [], fc=COLUMN, ec=style.BLACK, lw=1.0)[0]
        self.beam = None
        if structure.cap_beam_mass > 0.0:
            self.beam = axes.fill([], [], fc=BEAM, ec=style.BLACK, lw=0.7)[0]
        look: dict[str, Any] = {"color": style.RED, "ms": 4.0, "zorder": 4.0}
        look["label"] = "contact"
        self.contacts = axes.plot([], [], "o", **look)[0]
        self.thrust = axes.plot([], [], ls=(0, (5, 3)), lw=0.7, color=style.RED)[0]
        self.devices = SceneDevices(
            axes, structure.devices, np.zeros(1), self.half, self.height
        )
        axes.set(xticks=[], yticks=[])
        axes.grid(visible=False)

    def show(self, rotation: float) -> tuple[float, float]:
        """Lean the column to a rotation [rad]; u_b and v_b there [m]."""
        # The dashed line joins the contacts: the weight restores as long as it leans the
        # other way.
        bearing = self.structure.bearing
        shift, lift = displaced(self.structure, rotation)
        self.column.set_xy(outline(bearing, rotation, shift, lift))
        touching = contact_points(bearing, rotation, shift, lift)
        self.thrust.set_data(*touching.T)
        if rotation == 0.0:  # both edges of the flat part
            touching = np.array(
                [(side * x, y) for x, y in touching for side in (1.0, -1.0)]
            )
            self.thrust.set_data([], [])
        if self.beam is None:
            touching = touching[: len(touching) // 2]  # nothing stands on it
        self.contacts.set_data(*touching.T)
        if self.beam is not None:
            low = self.height + lift
            left = shift - self.half
            right = shift + self.half
            top = low + self.thickness
            self.beam.set_xy([(left, low), (right, low), (right, top), (left, top)])
        self.devices.show(shift, lift)
        return shift, lift


def draw_bearing(
    axes: style.Axes, structure: PodiumStructure, rotation: float = 0.0
) -> None:
    """A column at a rotation [rad]: its dimensions at rest,
    displacement and lift if it leans.
    """
    if not abs(rotation) < 0.5 * math.pi:
        raise UsageError(
            f"rotation = {rotation:g} rad must be less than a quarter turn, 1.57 rad"
        )
    bearing = structure.bearing
    critical = structure.critical_rotation
    view = BearingView(axes, structure)
    u, v = view.show(rotation)
    height = view.height
    half = view.half
    far, high = displaced(structure, max(abs(rotation), critical))
    posts = [half + gap for _, gap, _ in view.devices.stops]
    right = max(far + half, *posts, 0.0)
    left = max(half, *posts, 0.0)
    if rotation < 0.0:
        left, right = right, left
    corners = (-left, right, 0.0, height + high + view.thickness)
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
    x, y = outline(bearing).T
    axes.plot([*x, x[0]], [*y, y[0]], **grey)
    top = height + v + 2.2 * view.thickness
    for at in (0.0, u):
        axes.plot([at, at], [height, top], **grey)
    measure(axes, (0.0, top), (u, top), "$u_b$", offset=(0.0, 2.0))
    at = u + math.copysign(0.75 * half, rotation)
    axes.plot([0.0, at], [height, height], **grey)
    if view.beam is None:
        axes.plot([u, at], [height + v, height + v], **grey)
    measure(axes, (at, height), (at, height + v), "$v_b$", offset=(0.0, -2.0), part=0.0)


def draw_end(axes: style.Axes, bearing: Bearing, bed: Bed | None = None) -> None:
    """The lower end of a column at rest, enlarged: its widths, the
    radius, the edge's height.
    """
    half = bearing.end_half_width
    B = bearing.half_width
    x, y = outline(bearing).T
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
        measure(
            axes, (-half, -3.2 * step), (half, -3.2 * step), f"2B' = {2.0 * half:.4g} m"
        )
        edge = bearing.radius * (1.0 - math.cos(bearing.beta))
        axes.plot([half, 1.5 * half], [edge, edge], color=style.GREY, lw=0.7, ls=":")
        middle = 0.5 * bearing.beta
        arc = (
            B + bearing.radius * math.sin(middle),
            bearing.radius * (1.0 - math.cos(middle)),
        )
        axes.annotate(
            f"r = {bearing.radius:.4g} m\nβ = {bearing.beta:.3g} rad",
            arc, (0.0, 4.0 * step), arrowprops={"arrowstyle": "->", "lw": 0.6},
            ha="center", va="center", fontsize=style.small(),
        )  # fmt: skip
        words = f"{1e3 * edge:.3g} mm"
        style.note(axes, words, (1.06 * half, edge), (0.0, 3.0), ha="left")
        title = _curved(bearing)
    if bed is not None and bed.contact_share is not None:
        x = B * (1.0 - 2.0 * bed.contact_share)
        y = -3.2 * step
        axes.plot([x, B], [y, y], color=style.RED, lw=2.5, solid_capstyle="butt")
        words = f"{1e3 * (B - x):.3g} mm in contact at α/10"
        style.note(axes, words, (B, y), (0.0, -4.0), ha="right")
    axes.set_title(title, fontsize=style.small())


def _curved(bearing: Bearing) -> str:
    """The title of an end with arcs: how it touches, if its own shape says so."""
    if bearing.is_of_revolution:
        return "enlarged: spherical,\ntouches in a point"
    if bearing.ends:
        return "enlarged: cylindrical,\ntouches along a line"
    return "an end, enlarged"


def frame_end(axes: style.Axes, bearing: Bearing, below: float = 0.1) -> None:
    """Bring the lower end of a column into view; `below` the ground,
    as a part of the picture.
    """
    half = bearing.end_half_width
    _frame(axes, (-half, half, 0.0, 0.0), (0.2, 0.2, below, 1.0 - below), END_ASPECT)


def _state(bearing: Bearing, critical: float, rotation: float, u: float, v: float) -> str:
    """The title of a panel, in two lines."""
    if rotation == 0.0:
        return (
            f"at rest\n$\\alpha$ = {bearing.alpha:.3g} rad, $R$ ="
            f" {bearing.semi_diagonal:.4g} m"
        )
    name = f"$\\theta$ = {rotation:.3g} rad"
    if rotation == bearing.beta:
        name = f"end of rolling: $\\beta$ = {rotation:.3g} rad"
    elif rotation == critical:
        name = f"critical: $\\theta_{{cr}}$ = {rotation:.3g} rad"
    return f"{name}\n$u_b$ = {u:.3g} m, $v_b$ = {1e3 * v:.3g} mm"


def _draw_dimensions(axes: style.Axes, bearing: Bearing) -> None:
    """R from the middle of the column to the edge, and the height."""
    H = bearing.half_height
    B = bearing.half_width
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
    """Limits of one scale both ways; `room` is kept free, in its
    parts; `aspect` at most.
    """
    left, right, bottom, top = content
    across = 1.0 - room[0] - room[1]
    upwards = 1.0 - room[2] - room[3]
    width = (right - left) / across
    if upwards > 0.0:
        width = max(width, (top - bottom) / upwards / aspect)
        aspect = min(aspect, max(LEAST_ASPECT, (top - bottom) / upwards / width))
    floor = bottom - room[2] * aspect * width
    start = 0.5 * (left + right) - width * (room[0] + 0.5 * across)
    axes.set(xlim=(start, start + width), ylim=(floor, floor + aspect * width))
    axes.set_box_aspect(aspect)


def measure(
    axes: style.Axes,
    start: style.At,
    end: style.At,
    text: str,
    *,
    offset: style.At | None = None,
    part: float = 0.5,
    turned: bool = False,
) -> None:
    """A double arrow and, offset [pt] from a part of it, its
    text: on its left or below.
    """
    line = {
        "arrowstyle": "<->",
        "lw": 0.6,
        "color": style.BLACK,
        "shrinkA": 0,
        "shrinkB": 0,
    }
    axes.annotate("", end, start, arrowprops=line)
    at = start[0] + part * (end[0] - start[0]), start[1] + part * (end[1] - start[1])
    beside = (-3.0, 0.0) if start[0] == end[0] else (0.0, -3.0)
    style.note(axes, text, at, offset or beside, rotation=90.0 if turned else 0.0)


POINTS = 81
LONGEST = 0.4  # of the arrow of the larger force, over the height of the column


def column_figure(result: TimeHistoryResult, title: str, figure: style.Figure) -> None:
    """The tilted column with its end forces beside axial force, shear and moment."""
    narrow = style.narrow(figure)
    demand = result.column_demand
    assert demand is not None, "it is drawn where it was computed"
    at = f"t = {demand.instants[0].time:.5g} s, θ = {demand.instants[0].rotation:.3g} rad"
    words = title, record_name(result), f"most loaded column at {at}"
    style.begin(figure, words, 6.0 if narrow else 3.6)
    if narrow:
        panels = figure.subplot_mosaic("AAA;BCD", height_ratios=[1.2, 1.0])
    else:
        panels = figure.subplot_mosaic("ABCD", width_ratios=[2.0, 1.0, 1.0, 1.4])
    tilted, *sections = panels.values()
    draw_end_forces(tilted, result.structure, demand)
    draw_section_forces(sections, result.structure, demand)


def draw_end_forces(
    axes: style.Axes, structure: PodiumStructure, demand: ColumnDemand
) -> None:
    """The column to scale; arrows of the forces on it, to a scale of their own."""
    bearing = structure.bearing
    s = demand.at_largest_moment
    x = demand.instants[0].rotation
    shift, lift = displaced(structure, x)
    height = 2.0 * bearing.half_height
    wide = bearing.end_half_width
    axes.fill(*outline(bearing, x, shift, lift).T, fc=COLUMN, ec=style.BLACK, lw=1.0)
    foot, head = contact_points(bearing, x, shift, lift)
    if x == 0.0:  # in full contact, where the forces pass beside the axis
        foot = np.array([s.side * s.lever, 0.0])
        head = np.array([-s.side * s.lever, height])
    largest = max(abs(s.normal_bottom), abs(s.normal_top), 1.0)
    for name, place, F, N in (
        ("bottom", foot, s.shear_bottom, s.normal_bottom),
        ("top", head, -s.shear_top, -s.normal_top),
    ):
        plate = place[0] + 2.0 * wide * np.array([-1.0, 1.0])
        axes.plot(plate, place[[1, 1]], color=style.BLACK, lw=1.2)
        force = LONGEST * height * np.array([F, N]) / largest
        arrow = {
            "arrowstyle": "-|>",
            "lw": 1.2,
            "color": style.RED,
            "shrinkA": 0,
            "shrinkB": 0,
        }
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
    bearing = structure.bearing
    mass = structure.columns_mass / structure.columns
    along = np.linspace(0.0, 2.0 * bearing.half_height, POINTS)
    *forces, moments = demand.at_largest_moment.section_forces(bearing, mass, along)
    forces.append(demand.corner * moments)
    names = ("axial force $P$ [kN]", "shear $Q$ [kN]", "moment $M$ [kN m]")
    for axes, values, name in zip(panels, forces, names, strict=True):
        shown = 1e-3 * values
        axes.plot(shown, along, color=style.BLUE)
        axes.fill_betweenx(along, 0.0, shown, color=style.SKY, alpha=0.25, lw=0.0)
        axes.axvline(0.0, color=style.BLACK, lw=0.7)
        axes.margins(x=0.1)
        for end, upwards in ((0, 5.0), (-1, -5.0)):
            left = shown[end] > 0.0
            text = f"{shown[end]:.4g}".replace("-", "−")
            at = (shown[end], along[end])
            style.note(axes, text, at, (-7.0 if left else 7.0, upwards))
        axes.set(xlabel=name, ylim=(0.0, along[-1]))
        if axes is not panels[0]:
            axes.tick_params(labelleft=False)
    panels[0].set_ylabel("height along the column [m]")


def devices_figure(result: TimeHistoryResult, title: str, figure: style.Figure) -> None:
    """The loops of all devices."""
    narrow = style.narrow(figure)
    count = len(result.structure.devices)
    columns = min(count, 2 if narrow else 3)
    rows = -(-count // columns)
    words = title, record_name(result), result.sampling
    style.begin(figure, words, 0.5 + 2.7 * rows, max(2.6 * columns, 4.0))
    draws = [partial(draw_device, result=result, index=index) for index in range(count)]
    for axes in style.grid(figure, draws, columns):
        axes.locator_params(axis="x", nbins=3 if narrow else 5)


def _draw_gap(axes: style.Axes, strokes: Array, gap: float) -> None:
    """The gap of a stop, to the sides to which its stroke goes; the words, if it is not
    reached.
    """
    largest = float(np.nanmax(np.abs(strokes), initial=0.0))
    look: dict[str, Any] = {"color": style.RED, "ls": "--", "lw": 1.0}
    for side in (1.0, -1.0)[: 1 + bool((strokes < 0.0).any())]:
        axes.axvline(side * gap, **look)
    beside: dict[str, Any] = {"ha": "right", "va": "top", "rotation": 90.0}
    beside |= {"transform": axes.get_xaxis_transform(), "fontsize": style.small()}
    axes.text(gap, 0.98, f"gap {gap:.3g} m", color=style.RED, **beside)
    if largest < gap:
        axes.set(ylim=(-0.1, 1.0), yticks=[0.0])
        words = f"not reached:\n{largest:.3g} m"
        place: dict[str, Any] = {"ha": "center", "va": "center"}
        place |= {"transform": axes.transAxes, "fontsize": style.small()}
        axes.text(0.45, 0.4, words, **place)


def draw_device(axes: style.Axes, result: TimeHistoryResult, index: int) -> None:
    """Resistance of a device against displacement, of tendons
    tension against elongation.
    """
    style.require("devices", index, range(len(result.structure.devices)))
    trace = result.trace.devices
    device = result.structure.devices[index]
    drawn = DRAWN[type(device)]
    force = drawn.sign * trace.force[:, index]
    factor, prefix = style.engineering(float(np.nanmax(np.abs(force), initial=0.0)))
    axes.plot(trace.displacement[:, index], factor * force, color=style.BLUE, lw=0.8)
    style.cross(axes)
    if isinstance(device, laws.Stop):
        _draw_gap(axes, trace.displacement[:, index], device.gap)
    axes.set_title(named_device(index, device.kind), fontsize=style.small())
    stroke = (
        drawn.stroke if result.motion.y is None else drawn.stroke.replace("u_b", "|u_b|")
    )
    axes.set(xlabel=stroke, ylabel=f"{drawn.force} [{prefix}N]")
    axes.locator_params(axis="x", nbins=5)
