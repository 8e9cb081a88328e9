"""Rotation, events, displacements, moments and energy of a time history."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, replace
from functools import partial
from itertools import cycle
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.trace import Trace
from rpscli.errors import UsageError
from rpscli.report.figures import style

Way = Literal["x", "y"]
WAYS: tuple[Way, ...] = get_args(Way)


def record_name(result: TimeHistoryResult) -> str:
    """The name of the horizontal motion."""
    name, y = result.record.name, result.motion.y
    pair, found, turned = name.partition("_both")
    if y is None or not found:
        return name if y is None else f"{name}, y: {y.name}"
    rest = "both components" if y.name.startswith(pair) else f"y: {y.name}"
    return f"{pair}{turned}, {rest}"


def lean_azimuth(trace: Trace) -> NDArray[np.float64]:
    """Of the plane in which columns lean (samples,) [rad]: no half turns, in contact in between."""
    assert trace.azimuth is not None, "both components act"
    leans = np.flatnonzero(trace.rotation > 0.0)
    if not leans.size:
        return np.zeros_like(trace.azimuth)
    # A plane has no front: passing upright leaves it where it is.
    turned = np.unwrap(trace.azimuth[leans], period=np.pi)
    return np.interp(np.arange(len(trace.azimuth)), leans, turned)


def component(result: TimeHistoryResult, way: Way) -> TimeHistoryResult:
    """The part of a history in x or in y; rotation and energies stay those of both."""
    trace = result.trace
    in_y = {} if trace.y is None or way == "x" else vars(trace.y)
    return replace(result, trace=replace(trace, **in_y, azimuth=None, y=None))


def in_plane(result: TimeHistoryResult, *, one_sided: bool = False) -> TimeHistoryResult:
    """The history where the columns lean, to both sides or to one; planar ones as they are."""
    trace = result.trace
    if trace.y is None or trace.azimuth is None:
        return result
    plane = trace.azimuth if one_sided else lean_azimuth(trace)
    along = {}
    for name in (each.name for each in fields(trace.y)):
        if getattr(trace, name) is None:
            continue
        x, y = getattr(trace, name), getattr(trace.y, name)
        cosine, sine = (of(plane).reshape(-1, *[1] * (x.ndim - 1)) for of in (np.cos, np.sin))
        along[name] = cosine * x + sine * y
    side = np.where(np.cos(trace.azimuth - plane) < 0.0, -1.0, 1.0)
    rotation, rate = side * trace.rotation, side * trace.rotation_rate
    seen = replace(trace, **along, rotation=rotation, rotation_rate=rate, azimuth=None, y=None)
    return replace(result, trace=seen)


MOST = 50_000  # samples that are drawn as they are

STRETCHES = 2_000  # more than a figure has points across


def extremes(*curves: NDArray[Any]) -> NDArray[np.intp]:
    """Samples of curves (samples,) to draw: first, last, and least and largest of each stretch."""
    count = len(curves[0])
    if count <= MOST:
        return np.arange(count)
    length = -(-count // STRETCHES)
    ends = np.array([0, count - 1])
    found = [ends]
    for curve in curves:
        rows = np.pad(curve, (0, -count % length), mode="edge").reshape(-1, length)
        starts = np.arange(len(rows)) * length
        found += [starts + rows.argmin(axis=1), starts + rows.argmax(axis=1)]
    return np.unique(np.minimum(np.concatenate(found), count - 1))


def thinned(result: TimeHistoryResult) -> TimeHistoryResult:
    """The history with the samples that its figures need; maxima stay what they are."""
    # But for those of velocities, which are of all samples, and are not drawn: these are no
    # numbers.
    trace = result.trace
    if len(trace.time) <= MOST:
        return result
    floors = [floor - 1 for floor in shown_floors(result.structure.storeys)]
    kept = extremes(
        trace.rotation, trace.phase, trace.energy_input, trace.energy_stored,
        *trace.devices.force.T, *trace.devices.displacement.T,
        *(curve for of in (trace, trace.y) if of is not None for curve in (
            of.ground_acceleration, of.cap_beam_displacement, of.driving_moment,
            *of.floor_displacements.T[floors], *(of.drifts.T if result.structure.yields else ()),
        )),
    )  # fmt: skip
    few, fixed = trace.at(kept), result.fixed_base
    few = replace(few, floor_velocities=np.full_like(few.floor_velocities, np.nan))
    if fixed is not None:
        none = np.empty((0, result.structure.storeys))
        fixed = replace(fixed, floor_displacements=none, acceleration_histories=none)
    return replace(result, trace=few, fixed_base=fixed)


FLOOR_COLOURS = (style.RED, style.ORANGE, style.GREEN)
PALE = "#B5B5B5"
"""Of what lies below something else."""


def displacement_figure(result: TimeHistoryResult, title: str) -> bytes:
    """Roof and cap beam over the ground; below, roof and floors at mid-height over the cap beam."""
    draws = [draw_displacements, draw_drifts][: 2 if result.structure.storeys else 1]
    ways = WAYS if result.trace.y is not None else WAYS[:1]
    panels = [partial(draw_one, result=result, way=way) for draw_one in draws for way in ways]
    words = title, record_name(result), result.sampling
    return style.stacked(panels, words, 1.2 + 1.8 * len(panels))


def draw_displacements(axes: style.Axes, result: TimeHistoryResult, way: Way = "x") -> None:
    """Roof and cap beam, relative to the ground: the one thin upon the other."""
    trace = component(result, way).trace
    base = "cap beam" if result.structure.cap_beam_mass > 0.0 else "top of the columns"
    wide: dict[str, Any] = {"color": PALE, "lw": 3.0} if result.structure.storeys else {}
    axes.plot(trace.time, trace.cap_beam_displacement, **{"color": style.BLACK} | wide, label=base)
    _draw_floors(axes, result, trace.floor_displacements, 1, lw=0.8)
    axes.set_ylabel(f"{_in(result, way)}displacement relative\nto the ground [m]")
    style.legend_above(axes)


def _in(result: TimeHistoryResult, way: Way) -> str:
    """Begins a label where both components act."""
    return "" if result.trace.y is None else f"{way}: "


def draw_drifts(axes: style.Axes, result: TimeHistoryResult, way: Way = "x") -> None:
    """Floors relative to the cap beam."""
    trace = component(result, way).trace
    drifts = trace.floor_displacements - trace.cap_beam_displacement[:, None]
    _draw_floors(axes, result, drifts, lw=0.8)
    axes.set_ylabel(f"{_in(result, way)}displacement relative\nto the cap beam [m]")
    style.legend_above(axes)


def _draw_floors(
    axes: style.Axes,
    result: TimeHistoryResult,
    values: NDArray[np.float64],
    most: int = 3,
    **look: Any,
) -> None:
    """Some columns of (samples, n), the roof's first, with time below."""
    time, storeys = result.trace.time, result.structure.storeys
    for floor, colour in zip(shown_floors(storeys)[:most], FLOOR_COLOURS, strict=False):
        name = "roof" if floor == storeys else f"floor {floor}"
        axes.plot(time, values[:, floor - 1], color=colour, label=name, **look)
    axes.set(xlim=(0.0, time[-1]), xlabel="time [s]")


def shown_floors(storeys: int) -> list[int]:
    """The roof and at most two floors below it, counted from 1 at the bottom."""
    third = storeys / 3.0
    return sorted({round(third * k) for k in (1, 2, 3)} - {0}, reverse=True)


EventRow = tuple[tuple[str, ...], str, str]

EVENT_ROWS: tuple[EventRow, ...] = (
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


def rotation_figure(result: TimeHistoryResult, title: str) -> bytes:
    """Ground acceleration, rotation with its phases, and events; of pairs the azimuth as well."""
    rows, both = _rows(result), result.trace.azimuth is not None
    draws: list[Callable[..., None]]
    draws = [draw_ground, draw_rotation, *[draw_azimuth] * both, *[draw_events] * bool(rows)]
    heights = [1.3 if both else 1.0, 2.4, *[0.9] * both, *[0.18 * len(rows)] * bool(rows)]

    def draw_last(axes: style.Axes) -> None:
        draws[-1](axes, result)
        axes.set(xlim=(0.0, result.trace.time[-1]), xlabel="time [s]")

    panels = [partial(draw_one, result=result) for draw_one in draws[:-1]]
    words = title, record_name(result), result.sampling
    height = 4.6 + 0.15 * len(rows) + 1.3 * both + 0.6 * style.narrow()
    return style.stacked([*panels, draw_last], words, height, ratios=heights)


def _rows(result: TimeHistoryResult) -> list[EventRow]:
    """Kinds of event that there are."""
    return [row for row in EVENT_ROWS if any(event.kind in row[0] for event in result.events)]


def draw_ground(axes: style.Axes, result: TimeHistoryResult) -> None:
    """Ground acceleration, and what uplifts quasi-statically."""
    limit, trace = result.structure.uplift_acceleration, result.trace
    name = None
    if trace.y is not None:
        name = "in x"
        size = trace.size("ground_acceleration")
        axes.fill_between(trace.time, -size, size, color="#DADADA", lw=0.0, label="± resultant")
        axes.plot(trace.time, trace.y.ground_acceleration, color=style.RED, lw=0.7, label="in y")
    axes.plot(trace.time, trace.ground_acceleration, color=style.BLACK, lw=0.7, label=name)
    axes.set(ylabel="ground\nacceleration [m/s²]", xlabel="time [s]")
    if limit > 0.0:
        for sign in (1.0, -1.0):
            axes.axhline(sign * limit, color=style.GREEN, lw=0.9, ls="--")
        axes.plot([], [], color=style.GREEN, ls="--", lw=0.9, label="$g\\,\\tan\\alpha$ (uplift)")
    if limit > 0.0 or name:
        style.legend_above(axes)


def draw_azimuth(axes: style.Axes, result: TimeHistoryResult) -> None:
    """Towards which columns lean, from x towards y; half a turn further at each pass."""
    azimuth, leans = result.trace.azimuth, result.trace.rotation > 0.0
    if azimuth is None:
        raise UsageError("a panel of azimuth: needs a history under both horizontal components")
    shown = np.where(leans, np.degrees(azimuth), np.nan)
    jumps = np.flatnonzero(np.abs(np.diff(shown)) > QUARTER) + 1
    time = np.insert(result.trace.time, jumps, np.nan)
    axes.plot(time, np.insert(shown, jumps, np.nan), color=style.BLUE, lw=0.9)
    axes.set(ylim=(-190.0, 190.0), yticks=(-180, -90, 0, 90, 180))
    axes.set(ylabel="azimuth\n$\\varphi$ [deg]", xlabel="time [s]")


QUARTER = 90.0  # turns between two samples that are larger are not drawn as a line [deg]

Level = tuple[str, float, str, str]  # symbol, rotation [rad], line and colour


def levels(result: TimeHistoryResult, near: float = NEAR) -> tuple[list[Level], float]:
    """beta and theta_cr, and how far to look to see the motion and those that are near [rad]."""
    critical, beta = result.structure.critical_rotation, result.structure.bearing.beta
    found = [("\\beta", beta, ":", style.PINK)] if beta > 0.0 else []
    found.append(("\\theta_{cr}", critical, "--", style.RED))
    largest = max(result.max_rotation, 1e-3 * critical)
    return found, 1.12 * max(largest, *(v for _, v, *_ in found if v < near * largest), 0.0)


def draw_rotation(axes: style.Axes, result: TimeHistoryResult) -> None:
    """Rotation with its phases, beta and theta_cr; over theta_cr on the right."""
    trace, critical = result.trace, result.structure.critical_rotation
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
    ratio = axes.secondary_yaxis("right", functions=style.over(critical))
    ratio.set_ylabel("$\\theta/\\theta_{cr}$ [-]")
    style.legend_above(axes)


def draw_events(axes: style.Axes, result: TimeHistoryResult) -> None:
    """Marks at the times of the events, one row a kind, with their number: marks may merge."""
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


def moment_figure(result: TimeHistoryResult, title: str) -> bytes:
    """Moment against rotation."""
    note = "" if result.trace.y is None else "along the tilt, where going round drives too"
    return style.single(draw_moment, result, (title, record_name(result), note), 4.2, 6.0)


def draw_moment(axes: style.Axes, result: TimeHistoryResult) -> None:
    """Driving moment of ground and building against rotation, and 2 R W s B of the weight."""
    one_sided, result = result.trace.y is not None, in_plane(result, one_sided=True)
    trace, critical = result.trace, result.structure.critical_rotation
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
    """The swing to one side that turns the columns most, with its times and its direction."""
    time, rotation = result.trace.time, result.trace.rotation
    peak = int(np.nanargmax(np.abs(rotation)))
    ends = np.flatnonzero(rotation * rotation[peak] <= 0.0)
    if result.both_components:  # where it comes nearest to upright
        nearest = (rotation[1:-1] < rotation[:-2]) & (rotation[1:-1] <= rotation[2:])
        ends = np.union1d(ends, np.flatnonzero(nearest) + 1)
    if rotation[peak] == 0.0 or not ends[ends < peak].size:
        return
    first, last = ends[ends < peak][-1] + 1, min([*ends[ends > peak], len(time)])
    x, y = rotation[first:last], factor * result.trace.driving_moment[first:last]
    label = f"the largest swing, {time[first]:.2f} to {time[last - 1]:.2f} s"
    axes.plot(x, y, color=style.BLUE, lw=1.4, label=label)
    for place in np.linspace(0, len(x) - 2, 7).astype(int)[1:-1]:
        line = {"arrowstyle": "-|>", "color": style.BLUE, "lw": 0.0, "mutation_scale": 10.0}
        axes.annotate("", (x[place + 1], y[place + 1]), (x[place], y[place]), arrowprops=line)


YIELDED = "#882255"
"""What storeys dissipate by yielding; no device has this colour."""

DEVICE_COLOURS = (style.RED, style.PINK, style.BLUE, style.GREY)
"""Of what each device dissipates, from the first on."""


def energy_figure(result: TimeHistoryResult, title: str) -> bytes:
    """Input and where it went."""
    return style.single(draw_energy, result, (title, record_name(result)), 3.4)


def draw_energy(axes: style.Axes, result: TimeHistoryResult) -> None:
    """Input against what is stored and lost on the way, one on top of the other."""
    trace, made = result.trace, result.structure
    largest = np.nanmax(np.abs([trace.energy_input, trace.energy_stored]))
    factor, prefix = style.engineering(float(largest))
    passes = result.both_components and not result.structure.passes_smoothly
    devices = [
        (energy, f"device {index}: {device.kind.replace('_', ' ')}", colour)
        for index, (device, energy, colour) in enumerate(
            zip(made.devices, trace.devices.energy.T, cycle(DEVICE_COLOURS), strict=False)
        )
    ]
    parts = [
        *[(trace.energy_damped, "damped in the building", style.SKY)] * bool(made.storeys),
        *[(trace.energy_damped_vertical, "damped vertically", style.PINK)] * bool(made.upwards),
        *[(trace.energy_bed, "dissipated in the joints", style.BLUE)] * bool(made.bed),
        *[(trace.energy_yielded, "yielding of storeys", YIELDED)] * made.yields,
        *devices,
        (trace.energy_impact, f"lost at {'passes' if passes else 'impacts'} (net)", style.ORANGE),
        (trace.energy_stored, "kinetic, elastic and gravitational", style.GREEN),
    ]
    below = np.zeros_like(trace.time)
    for part, name, colour in parts:
        above = below + factor * part
        axes.fill_between(trace.time, below, above, color=colour, lw=0.0, label=name, alpha=0.8)
        below = above
    axes.plot(trace.time, factor * trace.energy_input, color=style.BLACK, label="input")
    axes.set(xlim=(0.0, trace.time[-1]), xlabel="time [s]", ylabel=f"energy [{prefix}J]")
    style.legend_above(axes)
