"""Moving pictures of a time history and of mode shapes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.errors import UsageError
from rpscli.report.figures import style
from rpscli.report.figures.bearing import BearingView, frame_end
from rpscli.report.figures.film import MOST_FRAMES, FilmRequest, Motion, Progress, film
from rpscli.report.figures.modes import draw_modes, modes_size
from rpscli.report.figures.scene import Scene

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rpscli.analyses.modal import ModalResult
    from rpscli.analyses.results import TimeHistoryResult

USUAL_LENGTH = 9.0
"""Of a film whose speed nobody asked for, at most [s]."""
SWING = 2.0
"""Time in which mode shapes swing there and back [s]."""


class Plan(NamedTuple):
    """Which samples become frames, and how much faster than in reality they follow."""

    samples: NDArray[np.int64]
    speed: float


def frame_plan(result: TimeHistoryResult, wanted: FilmRequest) -> Plan:
    """Evenly spaced samples of the wanted part, by default from the first motion to the last.

    Raises
    ------
    UsageError
        If the history ends before that part, or there are too many frames.
    """
    time, rotation = result.trace.time, np.abs(result.trace.rotation)
    moving = np.flatnonzero(rotation > 0.01 * rotation.max()) if rotation.any() else np.empty(0)
    first = max(time[int(moving[0])] - 0.5, 0.0) if moving.size else 0.0
    last = min(time[int(moving[-1])] + 0.5, time[-1]) if moving.size else time[-1]
    last = last if wanted.last is None else min(wanted.last, time[-1])
    first = min(first, last) if wanted.first is None else wanted.first
    if first >= time[-1] or first < 0.0:
        raise UsageError(
            f"--animate-from {first:g}: must be >= 0 and before the end at {time[-1]:g} s"
        )
    last = last if last > first else time[-1]
    length = (last - first) / wanted.speed if wanted.speed else min(last - first, USUAL_LENGTH)
    count = length * wanted.rate
    if count > MOST_FRAMES:
        raise UsageError(
            f"--animate-speed {wanted.speed:g}: {last - first:.4g} s make {count:.5g} frames, and"
            f" {MOST_FRAMES} are the most; let it run faster, or show a part with --animate-from"
            " and --animate-to"
        )
    frames = max(int(count), 2)
    at = np.linspace(first, last, frames)
    samples = np.minimum(np.searchsorted(time, at), len(time) - 1)
    return Plan(samples, float((last - first) * wanted.rate / frames))


def history_film(
    result: TimeHistoryResult,
    title: str,
    wanted: FilmRequest,
    progress: Progress = lambda *_: None,
) -> bytes:
    """The structure, a column's end enlarged, and the record below.

    Bearings and cap beam move to scale, storey drifts are magnified.
    """
    plan = frame_plan(result, wanted)

    def draw(figure: Figure) -> Motion:
        panels = figure.subplot_mosaic(
            [["scene", "end"], ["record", "record"]], width_ratios=[1.7, 1.0],
            height_ratios=[4.2, 1.0],
        )  # fmt: skip
        scene = Scene(panels["scene"], result, title, plan.speed)
        end = BearingView(panels["end"], result.structure)
        frame_end(panels["end"], result.structure.bearing)
        panels["end"].set_title("lower end of a column, enlarged", fontsize=style.small())
        cursor = _draw_record(panels["record"], result, plan)

        def show(frame: int) -> None:
            sample = int(plan.samples[frame])
            scene.show(sample)
            end.show(float(result.trace.rotation[sample]))
            cursor.set_xdata([result.trace.time[sample]] * 2)

        return Motion(len(plan.samples), show, [*scene.moving, *end.moving, cursor])

    return film(draw, 8.0, 5.2, wanted, progress)


def modes_film(
    result: ModalResult, title: str, wanted: FilmRequest, progress: Progress = lambda *_: None
) -> bytes:
    """The figure of the modes, its shapes swinging, all at one pace."""

    def draw(figure: Figure) -> Motion:
        draw_modes(figure, result, f"{title}   |   all modes at one pace")
        lines = [line for axes in figure.axes for line in axes.lines]
        shapes = [np.asarray(line.get_xdata(), dtype=float) for line in lines]
        frames = int(SWING * wanted.rate)

        def show(frame: int) -> None:
            for line, shape in zip(lines, shapes, strict=True):
                line.set_xdata(shape * np.cos(2.0 * np.pi * frame / frames))

        return Motion(frames, show, lines)

    return film(draw, *modes_size(result), wanted, progress)


def _draw_record(axes: Axes, result: TimeHistoryResult, plan: Plan) -> Any:
    trace = result.trace
    axes.plot(trace.time, trace.ground_acceleration, color=style.BLACK, lw=0.6)
    first, last = trace.time[plan.samples[0]], trace.time[plan.samples[-1]]
    axes.set_xlim(first, last)
    axes.set_ylabel("$a_g$ [m/s²]")
    axes.set_xlabel("time [s]")
    return axes.axvline(first, color=style.RED, lw=1.2)
