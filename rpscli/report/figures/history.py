"""Rotation, events, displacements, moments, energy and orbit of a time history."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, replace
from functools import partial
from itertools import cycle, pairwise
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.trace import Trace
from rpscli.errors import UsageError
from rpscli.model.devices import Stop
from rpscli.report.figures import style

if TYPE_CHECKING:
    from matplotlib.collections import LineCollection

Array = NDArray[np.float64]

Way = Literal["x", "y"]
WAYS: tuple[Way, ...] = get_args(Way)


def record_name(result: TimeHistoryResult) -> str:
    """The name of the horizontal motion, and its factor."""
    name = result.record.name
    y = result.motion.y
    scale = result.motion.scale
    times = "" if scale == 1.0 else f", times {scale:.4g}"
    pair, found, turned = name.partition("_both")
    if y is None or not found:
        return f"{name}{times}" if y is None else f"{name}, y: {y.name}{times}"
    rest = "both components" if y.name.startswith(pair) else f"y: {y.name}"
    return f"{pair}{turned}, {rest}{times}"


def lean_azimuth(trace: Trace) -> NDArray[np.float64]:
    """Of the plane in which columns lean (samples,) [rad]: no half
    turns, in contact in between.
    """
    assert trace.azimuth is not None, "both components act"
    leans = np.flatnonzero(trace.rotation > 0.0)
    if not leans.size:
        return np.zeros_like(trace.azimuth)
    # A plane has no front: passing upright leaves it where it is.
    turned = np.unwrap(trace.azimuth[leans], period=np.pi)
    return np.interp(np.arange(len(trace.azimuth)), leans, turned)


def component(result: TimeHistoryResult, way: Way) -> TimeHistoryResult:
    """The part of a history in x or in y; rotation and energies stay those of both."""
    style.require("directions", way, ("x", "y"))
    trace = result.trace
    in_y = {} if trace.y is None or way == "x" else vars(trace.y)
    return replace(result, trace=replace(trace, **in_y, azimuth=None, y=None))


def in_plane(result: TimeHistoryResult, *, one_sided: bool = False) -> TimeHistoryResult:
    """The history where the columns lean, to both sides or to one;
    planar ones as they are.
    """
    trace = result.trace
    if trace.y is None or trace.azimuth is None:
        return result
    plane = trace.azimuth if one_sided else lean_azimuth(trace)
    along = {}
    for name in (each.name for each in fields(trace.y)):
        if getattr(trace, name) is None:
            continue
        x = getattr(trace, name)
        y = getattr(trace.y, name)
        cosine, sine = (
            of(plane).reshape(-1, *[1] * (x.ndim - 1)) for of in (np.cos, np.sin)
        )
        along[name] = cosine * x + sine * y
    side = np.where(np.cos(trace.azimuth - plane) < 0.0, -1.0, 1.0)
    rotation = side * trace.rotation
    rate = side * trace.rotation_rate
    seen = replace(
        trace, **along, rotation=rotation, rotation_rate=rate, azimuth=None, y=None
    )
    return replace(result, trace=seen)


FLOOR_COLOURS = (style.RED, style.ORANGE, style.GREEN)
PALE = "#B5B5B5"
"""Of what lies below something else."""


def displacement_figure(
    result: TimeHistoryResult, title: str, figure: style.Figure
) -> None:
    """Roof and cap beam over the ground; below, roof and floors at
    mid-height over the cap beam.
    """
    draws = [draw_displacements, draw_drifts][: 2 if result.structure.storeys else 1]
    ways = WAYS if result.trace.y is not None else WAYS[:1]
    panels = [
        partial(draw_one, result=result, way=way) for draw_one in draws for way in ways
    ]
    words = title, record_name(result), result.sampling
    style.begin(figure, words, 1.2 + 1.8 * len(panels))
    style.grid(figure, panels, sharex=True)


def draw_displacements(
    axes: style.Axes, result: TimeHistoryResult, way: Way = "x"
) -> None:
    """Roof and cap beam, relative to the ground: the one thin upon the other."""
    trace = component(result, way).trace
    base = "cap beam" if result.structure.cap_beam_mass > 0.0 else "top of the columns"
    wide: dict[str, Any] = {"color": PALE, "lw": 3.0} if result.structure.storeys else {}
    axes.plot(
        trace.time,
        trace.cap_beam_displacement,
        **{"color": style.BLACK} | wide,
        label=base,
    )
    _draw_floors(axes, result, way, trace.floor_displacements, "ground", 1)


def draw_drifts(axes: style.Axes, result: TimeHistoryResult, way: Way = "x") -> None:
    """Floors relative to the cap beam."""
    trace = component(result, way).trace
    drifts = trace.floor_displacements - trace.cap_beam_displacement[:, None]
    _draw_floors(axes, result, way, drifts, "cap beam")


def _draw_floors(
    axes: style.Axes,
    result: TimeHistoryResult,
    way: Way,
    values: Array,
    over: str,
    most: int = 3,
) -> None:
    """Some columns of (samples, n), the roof's first, with time below."""
    time = result.trace.time
    storeys = result.structure.storeys
    for floor, colour in zip(shown_floors(storeys)[:most], FLOOR_COLOURS, strict=False):
        name = "roof" if floor == storeys else f"floor {floor}"
        axes.plot(time, values[:, floor - 1], color=colour, label=name, lw=0.8)
    both = f"{way}: " * (result.trace.y is not None)
    axes.set(xlim=(0.0, time[-1]), xlabel="time [s]")
    axes.set_ylabel(f"{both}displacement relative\nto the {over} [m]")
    style.legend_above(axes)


def shown_floors(storeys: int) -> list[int]:
    """The roof and at most two floors below it, counted from 1 at the bottom."""
    third = storeys / 3.0
    return sorted({round(third * k) for k in (1, 2, 3)} - {0}, reverse=True)


EVENT_ROWS = (
    (("uplift",), "uplift", style.GREEN),
    (("impact",), "impact", style.BLACK),
    (("pass",), "pass", style.BLACK),
    (("recontact",), "re-contact", style.GREY),
    (("rolling_to_rocking", "rocking_to_rolling"), "passing $\\beta$", style.PINK),
    (("critical_rotation_passed", "overturning"), "critical", style.RED),
)
"""Kinds of event, their name in the figure, and its colour."""

PHASES = ((1, "rolling", style.ROLLING_SHADE), (2, "rocking", style.ROCKING_SHADE))

NEAR = 8.0  # a level up to so many times the largest rotation is brought into view


def rotation_figure(result: TimeHistoryResult, title: str, figure: style.Figure) -> None:
    """Ground acceleration, rotation with its phases, and events; of
    pairs the azimuth as well.
    """
    rows = _rows(result)
    both = result.trace.azimuth is not None
    draws: list[Callable[..., None]]
    draws = [
        draw_ground,
        draw_rotation,
        *[draw_azimuth] * both,
        *[draw_events] * bool(rows),
    ]
    heights = [1.3 if both else 1.0, 2.4, *[0.9] * both, *[0.18 * len(rows)] * bool(rows)]
    height = 4.6 + 0.15 * len(rows) + 1.3 * both + 0.6 * style.narrow(figure)
    style.begin(figure, (title, record_name(result), result.sampling), height)
    panels = [partial(draw_one, result=result) for draw_one in draws]
    style.grid(figure, panels, ratios=heights, sharex=True)
    figure.axes[-1].set_xlim(0.0, result.trace.time[-1])


def _rows(result: TimeHistoryResult) -> list[tuple[tuple[str, ...], str, str]]:
    """Kinds of event that there are."""
    return [
        row for row in EVENT_ROWS if any(event.kind in row[0] for event in result.events)
    ]


def draw_ground(axes: style.Axes, result: TimeHistoryResult) -> None:
    """Ground acceleration, and what uplifts quasi-statically."""
    limit = result.structure.uplift_acceleration
    trace = result.trace
    name = None
    if trace.y is not None:
        name = "in x"
        size = trace.size("ground_acceleration")
        axes.fill_between(
            trace.time, -size, size, color="#DADADA", lw=0.0, label="± resultant"
        )
        axes.plot(
            trace.time, trace.y.ground_acceleration, color=style.RED, lw=0.7, label="in y"
        )
    axes.plot(
        trace.time, trace.ground_acceleration, color=style.BLACK, lw=0.7, label=name
    )
    axes.set(ylabel="ground\nacceleration [m/s²]", xlabel="time [s]")
    if limit > 0.0:
        for sign in (1.0, -1.0):
            axes.axhline(sign * limit, color=style.GREEN, lw=0.9, ls="--")
        axes.plot(
            [],
            [],
            color=style.GREEN,
            ls="--",
            lw=0.9,
            label="$g\\,\\tan\\alpha$ (uplift)",
        )
    if limit > 0.0 or name:
        style.legend_above(axes)


def draw_azimuth(axes: style.Axes, result: TimeHistoryResult) -> None:
    """Towards which columns lean, from x towards y; half a turn further at each pass."""
    azimuth = result.trace.azimuth
    leans = result.trace.rotation > 0.0
    if azimuth is None:
        raise UsageError(
            "a panel of azimuth: needs a history under both horizontal components"
        )
    shown = np.where(leans, np.degrees(azimuth), np.nan)
    jumps = np.flatnonzero(np.abs(np.diff(shown)) > QUARTER) + 1
    time = np.insert(result.trace.time, jumps, np.nan)
    axes.plot(time, np.insert(shown, jumps, np.nan), color=style.BLUE, lw=0.9)
    axes.set(ylim=(-190.0, 190.0), yticks=(-180, -90, 0, 90, 180))
    axes.set(ylabel="azimuth\n$\\varphi$ [deg]", xlabel="time [s]")


QUARTER = 90.0  # turns between two samples that are larger are not drawn as a line [deg]


ROOM = 1.12  # about what is farthest out


def levels(
    result: TimeHistoryResult, near: float = NEAR
) -> tuple[list[tuple[str, float, str, str]], float]:
    """Of beta and theta_cr symbol, value, line and colour; how far to
    look to see the near ones.
    """
    critical = result.structure.critical_rotation
    beta = result.structure.bearing.beta
    found = [("\\beta", beta, ":", style.PINK)] if beta > 0.0 else []
    found.append(("\\theta_{cr}", critical, "--", style.RED))
    largest = max(result.max_rotation, 1e-3 * critical)
    return found, ROOM * max(
        largest, *(v for _, v, *_ in found if v < near * largest), 0.0
    )


def draw_rotation(axes: style.Axes, result: TimeHistoryResult) -> None:
    """Rotation with its phases, beta and theta_cr; over theta_cr on the right."""
    trace = result.trace
    critical = result.structure.critical_rotation
    found, top = levels(result)
    one_sided = trace.azimuth is not None
    axes.set_ylim(0.0 if one_sided else -top, top)
    for code, name, shade in PHASES:
        if (inside := trace.phase == code).any():
            axes.fill_between(
                trace.time, 0.0, 1.0, where=inside, step="post", color=shade, lw=0.0, label=name,
                transform=axes.get_xaxis_transform(),
            )  # fmt: skip
    axes.plot(trace.time, trace.rotation, color=style.BLUE)
    for symbol, value, line, colour in found:
        # Outside the axes, their value stands in the legend alone.
        label = f"${symbol}$ = {value:.3f} rad"
        if value > axes.get_ylim()[1]:
            axes.plot([], [], color=colour, ls=line, label=f"{label} (outside)")
            continue
        axes.axhline(value, color=colour, ls=line, label=label)
        if not one_sided:
            axes.axhline(-value, color=colour, ls=line)
    axes.set(ylabel="rotation $\\theta$ [rad]", xlabel="time [s]")
    over = (lambda rotation: rotation / critical), (lambda ratio: ratio * critical)
    ratio = axes.secondary_yaxis("right", functions=over)
    ratio.set_ylabel("$\\theta/\\theta_{cr}$ [-]")
    style.legend_above(axes)


def draw_events(axes: style.Axes, result: TimeHistoryResult) -> None:
    """Marks at the times of the events, one row a kind, with their
    number: marks may merge.
    """
    rows = _rows(result)
    axes.tick_params(axis="y", length=0.0, labelsize=0.9 * style.small())
    axes.set_ylim(len(rows) - 0.4, -0.6)
    axes.grid(visible=False)
    names = []
    for row, (kinds, name, colour) in enumerate(rows):
        times = [event.time for event in result.events if event.kind in kinds]
        axes.plot(times, [row] * len(times), "|", color=colour, ms=6.0, mew=0.35)
        names.append(f"{name}: {len(times)}")
    axes.set_yticks(range(len(rows)), names)
    axes.set_xlabel("time [s]")


def draw_moment(axes: style.Axes, result: TimeHistoryResult) -> None:
    """Driving moment of ground and building against rotation, and
    2 R W s B of the weight.
    """
    one_sided = result.trace.y is not None
    result = in_plane(result, one_sided=True)
    trace = result.trace
    critical = result.structure.critical_rotation
    reach = 1.1 * max(result.max_rotation, 0.02 * critical)
    factor, prefix = style.engineering(float(np.nanmax(np.abs(trace.driving_moment))))
    # Upright there is no tilt that the moment of a pair could be along.
    shown = np.where(one_sided & (trace.rotation == 0.0), np.nan, trace.driving_moment)
    driving = "driving moment (ground and building)"
    axes.plot(trace.rotation, factor * shown, color=PALE, lw=0.5, label=driving)
    _draw_longest(axes, result, factor)
    name: str | None = "restoring moment of the weight"
    for side in (1.0,) if one_sided else (-1.0, 1.0):
        rotation = side * np.linspace(1e-9, reach, 300)
        static = factor * result.restoring_moment(rotation)
        axes.plot(rotation, static, color=style.RED, lw=2.5, zorder=1.5, label=name)
        name = None
    style.cross(axes)
    axes.set_xlim(0.0 if one_sided else -reach, reach)
    axes.locator_params(axis="x", nbins=5)
    axes.set_xlabel("rotation $\\theta$ [rad]")
    axes.set_ylabel(f"moment about the contact points [{prefix}N m]")
    style.legend_above(axes)


def _draw_longest(axes: style.Axes, result: TimeHistoryResult, factor: float) -> None:
    """The swing to one side that turns the columns most, with its
    times and its direction.
    """
    time = result.trace.time
    rotation = result.trace.rotation
    peak = int(np.nanargmax(np.abs(rotation)))
    ends = np.flatnonzero(rotation * rotation[peak] <= 0.0)
    if result.both_components:  # where it comes nearest to upright
        nearest = (rotation[1:-1] < rotation[:-2]) & (rotation[1:-1] <= rotation[2:])
        ends = np.union1d(ends, np.flatnonzero(nearest) + 1)
    if rotation[peak] == 0.0 or not ends[ends < peak].size:
        return
    first = ends[ends < peak][-1] + 1
    last = min([*ends[ends > peak], len(time)])
    x = rotation[first:last]
    y = factor * result.trace.driving_moment[first:last]
    label = f"the largest swing, {time[first]:.2f} to {time[last - 1]:.2f} s"
    axes.plot(x, y, color=style.BLUE, lw=1.4, label=label)
    for place in np.linspace(0, len(x) - 2, 7).astype(int)[1:-1]:
        line = {
            "arrowstyle": "-|>",
            "color": style.BLUE,
            "lw": 0.0,
            "mutation_scale": 10.0,
        }
        axes.annotate(
            "", (x[place + 1], y[place + 1]), (x[place], y[place]), arrowprops=line
        )


YIELDED = "#882255"
"""What storeys dissipate by yielding; no device has this colour."""

DEVICE_COLOURS = (style.RED, style.PINK, style.BLUE, style.GREY)
"""Of what each device dissipates, from the first on."""


MOST = 20_000
"""Samples of an area at most: matplotlib thins out lines, not areas."""


def named_device(index: int, kind: str) -> str:
    """A device as people count, from 1."""
    return f"device {index + 1}: {kind.replace('_', ' ')}"


def draw_energy(axes: style.Axes, result: TimeHistoryResult) -> None:
    """Input against what is stored and lost on the way, one on top of the other."""
    trace = result.trace
    made = result.structure
    largest = np.nanmax(np.abs([trace.energy_input, trace.energy_stored]))
    factor, prefix = style.engineering(float(largest))
    passes = result.both_components and not result.structure.passes_smoothly
    names = [
        named_device(index, device.kind) for index, device in enumerate(made.devices)
    ]
    parts = [
        *[(trace.energy_damped, "damped in the building", style.SKY)]
        * bool(made.storeys),
        *[(trace.energy_damped_vertical, "damped vertically", style.PINK)]
        * bool(made.upwards),
        *[(trace.energy_bed, "dissipated in the joints", style.BLUE)] * bool(made.bed),
        *[(trace.energy_yielded, "yielding of storeys", YIELDED)] * made.yields,
    ]
    taken = {colour for *_, colour in parts}
    free = [colour for colour in DEVICE_COLOURS if colour not in taken]
    parts += zip(trace.devices.energy.T, names, cycle(free), strict=False)
    impacts = [
        (
            trace.energy_impact,
            f"lost at {'passes' if passes else 'impacts'} (net)",
            style.ORANGE,
        )
    ]
    parts += [
        *impacts * (not made.bearing.is_spherical),
        (trace.energy_stored, "kinetic, elastic and gravitational", style.GREEN),
    ]
    few = slice(None, None, 1 + len(trace.time) // MOST)
    below = np.zeros_like(trace.time[few])
    for part, name, colour in parts:
        above = below + factor * part[few]
        axes.fill_between(
            trace.time[few], below, above, color=colour, lw=0.0, label=name, alpha=0.8
        )
        below = above
    axes.plot(trace.time, factor * trace.energy_input, color=style.BLACK, label="input")
    axes.set(xlim=(0.0, trace.time[-1]), xlabel="time [s]", ylabel=f"energy [{prefix}J]")
    style.legend_above(axes)


PIECES = 240  # of a path, each of one colour
CIRCLE_NEAR = (
    3.0  # a circle up to so many times the largest displacement is brought into view
)
DARK = 0.88  # colours up to this part of a map can be seen on white


def orbit_figure(result: TimeHistoryResult, title: str, figure: style.Figure) -> None:
    """The orbit of the cap beam beside that of the driving moment, time in colour."""
    narrow = style.narrow(figure)
    words = title, record_name(result), result.sampling
    style.begin(figure, words, 7.6 if narrow else 4.7)
    panels = figure.subplots(*((2, 1) if narrow else (1, 2)))
    lines = draw_path(panels[0], result)
    draw_push(panels[1], result)
    place: dict[str, Any] = {
        "location": "bottom",
        "shrink": 0.6,
        "aspect": 40,
        "pad": 0.03,
    }
    figure.colorbar(lines, ax=panels, label="time [s]", **place)


def draw_orbit(axes: style.Axes, result: TimeHistoryResult) -> None:
    """The orbit of the cap beam with the circles of beta and
    theta_cr, and what colours mean.
    """
    axes.figure.colorbar(draw_path(axes, result), ax=axes, label="time [s]")


def draw_path(axes: style.Axes, result: TimeHistoryResult) -> LineCollection:
    """The orbit, without what its colours mean."""
    trace = result.trace
    if trace.y is None:
        raise UsageError(
            "a panel of orbit: needs a history under both horizontal components"
        )
    drawn = (trace.cap_beam_displacement, trace.y.cap_beam_displacement)
    found, farthest = levels(result, CIRCLE_NEAR)
    ends = result.structure.path(
        np.array([farthest, *(value for _, value, *_ in found)])
    )[1]
    circles = [
        (float(u), f"${symbol}$: {u:.3g} m", line, colour)
        for u, (symbol, _, line, colour) in zip(ends[1:], found, strict=True)
    ]
    devices = result.structure.devices
    gaps = sorted({float(device.gap) for device in devices if isinstance(device, Stop)})
    circles += [(gap, f"stop: {gap:.3g} m", "-.", style.BLACK) for gap in gaps]
    near = [gap for gap in gaps if gap < CIRCLE_NEAR * result.max_cap_beam_displacement]
    reach = max(float(ends[0]), *(ROOM * gap for gap in near), 0.0)
    lines = _in_colours(axes, result, drawn, reach, circles)
    axes.set(xlabel="cap beam $u_{b,x}$ [m]", ylabel="cap beam $u_{b,y}$ [m]")
    return lines


def draw_push(axes: style.Axes, result: TimeHistoryResult) -> None:
    """Moment of ground and building about the contacts, x against
    y, with the uplift circle.
    """
    trace = result.trace
    structure = result.structure
    assert trace.y is not None, "both components act"
    both = np.array([trace.driving_moment, trace.y.driving_moment])
    lifts = (
        np.finfo(float).tiny if structure.bed is None else structure.bed.uplift_rotation
    )
    least = float(result.restoring_moment(np.array([lifts]))[0])
    factor, prefix = style.engineering(max(least, float(np.nanmax(np.hypot(*both)))))
    alone = structure.devices or result.motion.vertical is not None
    name = (
        f"uplift{', by the weight alone' if alone else ''}: {factor * least:.3g}"
        f" {prefix}N m"
    )
    circles = [(factor * least, name, "--", style.BLACK)]
    if structure.bearing.is_spherical:
        circles = []  # they roll from the first moment on
    reach = 1.08 * factor * max(least, float(np.nanmax(np.abs(both))))
    _in_colours(axes, result, (factor * both[0], factor * both[1]), reach, circles)
    axes.set(
        xlabel=f"driving moment, x [{prefix}N m]",
        ylabel=f"driving moment, y [{prefix}N m]",
    )


def _in_colours(
    axes: style.Axes,
    result: TimeHistoryResult,
    path: tuple[Array, Array],
    reach: float,
    circles: list[tuple[float, str, str, str]],
) -> LineCollection:
    """A path and circles about the origin, of one scale both ways."""
    import matplotlib as mpl
    from matplotlib.collections import LineCollection
    from matplotlib.colors import ListedColormap
    from matplotlib.patches import Circle
    from matplotlib.patheffects import withStroke

    time = result.trace.time
    leans = np.flatnonzero(result.trace.rotation > 0.0)
    first, last = (max(leans[0] - 1, 0), leans[-1]) if leans.size else (0, len(time) - 1)
    edges = np.unique(np.linspace(first, last, PIECES + 1).astype(int))
    points = np.column_stack(path)
    pieces = list(pairwise(edges))
    shades = mpl.colormaps[str(mpl.rcParams["image.cmap"])](np.linspace(0.0, DARK, 256))
    lines = LineCollection(
        [points[a : b + 1] for a, b in pieces], cmap=ListedColormap(shades)
    )
    lines.set(linewidth=0.7, capstyle="round")
    lines.set_array(np.array([0.5 * (time[a] + time[b]) for a, b in pieces]))
    lines.set_clim(time[first], time[last])
    axes.add_collection(lines)
    for radius, label, line, colour in circles:
        outside = " (outside)" * (radius > 1.4 * reach)
        axes.plot([], [], color=colour, ls=line, label=f"{label}{outside}")
        look: dict[str, Any] = {"ec": colour, "ls": line, "lw": 1.3, "zorder": 3.0}
        look["path_effects"] = [withStroke(linewidth=3.0, foreground="white")]
        axes.add_patch(Circle((0.0, 0.0), radius, fill=False, **look))
    axes.axhline(0.0, color=style.GREY, lw=0.4)
    axes.axvline(0.0, color=style.GREY, lw=0.4)
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach))
    axes.set_aspect("equal", adjustable="box")
    axes.locator_params(nbins=5)
    if axes.get_window_extent().width < 2.6 * axes.figure.dpi:
        end = float(f"{0.7 * reach:.0e}")
        axes.set(xticks=(-end, end), yticks=(-end, 0.0, end))
    style.legend_above(axes)
    return lines
