"""Seen from above: the way of the cap beam under both components, and the moment that drives it."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.results import TimeHistoryResult
from rpscli.errors import UsageError
from rpscli.report.figures import style
from rpscli.report.figures.history import levels, record_name

if TYPE_CHECKING:
    from matplotlib.collections import LineCollection

Array = NDArray[np.float64]

PIECES = 240  # of a path, each of one colour
NEAR = 3.0  # a circle up to so many times the largest displacement is brought into view
DARK = 0.88  # colours up to this part of a map can be seen on white


def orbit_figure(result: TimeHistoryResult, title: str) -> bytes:
    """The orbit of the cap beam beside that of the driving moment, time in colour."""
    narrow = style.narrow()

    def draw(figure: style.Figure) -> None:
        style.heading(figure, title, record_name(result), result.sampling)
        panels = figure.subplots(*((2, 1) if narrow else (1, 2)))
        lines = draw_path(panels[0], result)
        draw_push(panels[1], result)
        place: dict[str, Any] = {"location": "bottom", "shrink": 0.6, "aspect": 40, "pad": 0.03}
        figure.colorbar(lines, ax=panels, label="time [s]", **place)

    return style.picture(draw, 7.6 if narrow else 4.7)


def draw_orbit(axes: style.Axes, result: TimeHistoryResult) -> None:
    """The orbit of the cap beam with the circles of beta and theta_cr, and what colours mean."""
    axes.figure.colorbar(draw_path(axes, result), ax=axes, label="time [s]")


def draw_path(axes: style.Axes, result: TimeHistoryResult) -> LineCollection:
    """The orbit, without what its colours mean."""
    trace = result.trace
    if trace.y is None:
        raise UsageError("a panel of orbit: needs a history under both horizontal components")
    drawn = (trace.cap_beam_displacement, trace.y.cap_beam_displacement)
    found, reach = levels(result, NEAR)
    ends = result.structure.path(np.array([reach, *(value for _, value, *_ in found)]))[1]
    circles = [
        (float(u), f"${symbol}$: {u:.3g} m", line, colour)
        for u, (symbol, _, line, colour) in zip(ends[1:], found, strict=True)
    ]
    lines = _in_colours(axes, result, drawn, float(ends[0]), circles)
    axes.set(xlabel="cap beam $u_{b,x}$ [m]", ylabel="cap beam $u_{b,y}$ [m]")
    return lines


def draw_push(axes: style.Axes, result: TimeHistoryResult) -> None:
    """Moment of ground and building about the contacts, x against y, with the uplift circle."""
    trace, structure = result.trace, result.structure
    assert trace.y is not None, "both components act"
    both = np.array([trace.driving_moment, trace.y.driving_moment])
    lifts = np.finfo(float).tiny if structure.bed is None else structure.bed.uplift_rotation
    least = float(result.restoring_moment(np.array([lifts]))[0])
    factor, prefix = style.engineering(max(least, float(np.nanmax(np.hypot(*both)))))
    alone = structure.devices or result.motion.vertical is not None
    name = f"uplift{', by the weight alone' if alone else ''}: {factor * least:.3g} {prefix}N m"
    circles = [(factor * least, name, "--", style.BLACK)]
    if structure.bearing.is_spherical:
        circles = []  # they roll from the first moment on
    reach = 1.08 * factor * max(least, float(np.nanmax(np.abs(both))))
    _in_colours(axes, result, (factor * both[0], factor * both[1]), reach, circles)
    axes.set(xlabel=f"driving moment, x [{prefix}N m]", ylabel=f"driving moment, y [{prefix}N m]")


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
    lines = LineCollection([points[a : b + 1] for a, b in pieces], cmap=ListedColormap(shades))
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
