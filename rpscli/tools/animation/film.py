"""Animations of a time history, true to scale but for the storey
drifts, and of mode shapes.
"""

from __future__ import annotations

import io
import shutil
import subprocess
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import partial
from itertools import chain
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.modal import ModalResult
from rpscli.analyses.results import TimeHistoryResult
from rpscli.errors import OutputError, UsageError
from rpscli.report.figures import style
from rpscli.report.figures.bearing import (
    BearingView,
    SceneDevices,
    displaced,
    frame_end,
    outline,
)
from rpscli.report.figures.history import in_plane, lean_azimuth
from rpscli.report.figures.look import ENCODER, MOST_FRAMES, USUAL, FilmRequest, Look
from rpscli.report.figures.structure import COLUMNS, level_heights, modes_figure
from rpscli.tools.animation.slab import SlabView

if TYPE_CHECKING:
    from matplotlib.lines import Line2D
    from PIL.Image import Image

Array = NDArray[np.float64]

Motion = tuple[
    int, Callable[[int], None]
]  # how many frames, and what moves to each of them
Progress = Callable[
    [int, int], None
]  # is told how many frames are drawn, and of how many

BOX_ASPECT = 0.8  # height of the picture over its width


class Scene:
    """The structure at one instant; `show` moves it to another. Of
    pairs where columns lean.
    """

    def __init__(
        self, axes: style.Axes, result: TimeHistoryResult, title: str, speed: float
    ) -> None:
        seen = "" if result.trace.y is None else "along the tilt"
        seen += ", without a turn" * (result.twist is not None)
        result = in_plane(result)
        self.result = result
        structure = result.structure
        self.levels = level_heights(structure)
        self.magnification = _magnification(result, self.levels)
        height = 2.0 * structure.bearing.half_height
        self.width = 1.6 * max(height, 0.35 * float(self.levels[-1]))
        count = COLUMNS if structure.cap_beam_mass > 0.0 else 1
        self.feet = (
            np.linspace(-0.4, 0.4, count) * self.width if count > 1 else np.zeros(1)
        )
        self.thickness = 0.12 * height
        self._draw_bodies(axes)
        base = float(self.levels[0])
        self.devices = SceneDevices(
            axes, structure.devices, self.feet, 0.5 * self.width, base
        )
        self._write_texts(axes, title, speed, seen)
        self._set_limits(axes)

    def _draw_bodies(self, axes: style.Axes) -> None:
        """Columns, cap beam and floors, without a place yet."""
        self.columns = [
            axes.fill([], [], fc="#C9C9C9", ec=style.BLACK, lw=0.8)[0] for _ in self.feet
        ]
        self.beam = axes.fill([], [], fc=style.BLUE, ec=style.BLACK, lw=0.8)[0]
        self.floors = [
            axes.plot([], [], color=style.BLUE, lw=3.0)[0] for _ in self.levels[1:]
        ]
        self.sides = (
            [axes.plot([], [], "k", lw=1.0)[0] for _ in (-1, 1)] if self.floors else []
        )

    def _write_texts(self, axes: style.Axes, title: str, speed: float, seen: str) -> None:
        """Clock, titles and scales, and the line of the ground."""
        clock: dict[str, Any] = {
            "xycoords": "axes fraction",
            "textcoords": "offset points",
        }
        self.clock = axes.annotate(
            "", (1, 1), (0, 6), ha="right", fontweight="bold", **clock
        )
        axes.figure.suptitle(title, fontsize=style.small(), parse_math=False)
        axes.axhline(0.0, color=style.BLACK, lw=1.0)
        drifts = f"; storey drifts x {self.magnification:g}" if self.floors else ""
        axes.set_title(seen, loc="left", fontsize=style.small())
        axes.set_xlabel(
            f"bearings to scale{drifts}; {_pace(speed)}", fontsize=style.small()
        )

    def _set_limits(self, axes: style.Axes) -> None:
        """Room for all of the motion, with a metre as high as it is wide."""
        trace = self.result.trace
        shift = float(np.nanmax(np.abs(trace.cap_beam_displacement)))
        reach = 0.5 * self.width + shift + 0.12 * float(self.levels[-1])
        top = float(self.levels[-1] + np.nanmax(trace.lift)) + 2.0 * self.thickness
        height = max(1.1 * top, 2.0 * reach * BOX_ASPECT)
        axes.set_xlim(-0.5 * height / BOX_ASPECT, 0.5 * height / BOX_ASPECT)
        axes.set_ylim(-0.06 * top, height - 0.06 * top)
        axes.set_box_aspect(BOX_ASPECT)
        axes.set(yticks=[], xticks=[])
        axes.grid(visible=False)

    def show(self, sample: int) -> None:
        """Move everything to where it is at a sample."""
        trace = self.result.trace
        bearing = self.result.structure.bearing
        shift = float(trace.cap_beam_displacement[sample])
        lift = float(trace.lift[sample])
        corners = outline(bearing, float(trace.rotation[sample]), shift, lift)
        for foot, column in zip(self.feet, self.columns, strict=True):
            column.set_xy(corners + np.array([foot, 0.0]))
        base = float(self.levels[0]) + lift
        half = 0.5 * self.width
        if len(self.feet) > 1:
            top = base + self.thickness
            left = shift - half
            right = shift + half
            self.beam.set_xy([(left, base), (right, base), (right, top), (left, top)])
        if self.floors:
            drift = trace.floor_displacements[sample] - shift
            x = np.concatenate([[shift], shift + self.magnification * drift])
            y = self.levels + lift + self.thickness
            for floor, at, height in zip(self.floors, x[1:], y[1:], strict=True):
                floor.set_data([at - half, at + half], [height, height])
            for side, line in zip((-half, half), self.sides, strict=True):
                line.set_data(x + side, y)
        self.devices.show(shift, lift)
        self.clock.set_text(f"t = {trace.time[sample]:.2f} s")


class PlanView:
    """A column from above: foot, head and where it was, and the
    plane in which it leans.
    """

    def __init__(self, axes: style.Axes, result: TimeHistoryResult) -> None:
        from matplotlib.patches import Circle

        trace = result.trace
        assert trace.y is not None, "both components act"
        self.x = trace.cap_beam_displacement
        self.y = trace.y.cap_beam_displacement
        self.azimuth = lean_azimuth(trace)
        self.memory = round(MEMORY / result.record.dt)
        radius = result.structure.bearing.end_half_width
        farthest = float(np.nanmax(trace.size("cap_beam_displacement")))
        self.reach = 1.15 * (radius + farthest)
        critical, _ = displaced(result.structure, result.structure.critical_rotation)
        for size, colour, line in (
            (radius, style.BLACK, ":"),
            (critical, style.RED, "--"),
        ):
            axes.add_patch(
                Circle((0.0, 0.0), size, fill=False, ec=colour, ls=line, lw=0.8)
            )
        self.plane = axes.plot([], [], color=style.BLACK, lw=0.6, ls=(0, (6, 3)))[0]
        self.way = axes.plot([], [], color=style.BLUE, lw=1.0)[0]
        self.head = Circle((0.0, 0.0), radius, fill=False, ec=style.BLUE, lw=1.6)
        axes.add_patch(self.head)
        self.middle = axes.plot([], [], "o", color=style.BLUE, ms=3.5)[0]
        look: dict[str, Any] = {"fontsize": style.small(), "ha": "center", "va": "center"}
        self.right = axes.text(0.0, 0.0, "right", **look)
        axes.set(xlim=(-self.reach, self.reach), ylim=(-self.reach, self.reach))
        axes.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
        axes.locator_params(nbins=5)
        axes.set_title("a column from above", fontsize=style.small())

    def show(self, sample: int) -> None:
        """Move the head to where it is at a sample, and turn the
        plane in which columns lean.
        """
        at = slice(max(sample - self.memory, 0), sample + 1)
        self.way.set_data(self.x[at], self.y[at])
        self.middle.set_data(self.x[[sample]], self.y[[sample]])
        self.head.set_center((self.x[sample], self.y[sample]))
        way = self.reach * np.array(
            [np.cos(self.azimuth[sample]), np.sin(self.azimuth[sample])]
        )
        self.plane.set_data(*np.outer(way, (-2.0, 2.0)))
        # Beside the line, by more than half of the word where the line stands upright.
        self.right.set_position(
            (0.8 * way[0] - 0.2 * way[1], 0.8 * way[1] + 0.2 * way[0])
        )


def _pace(speed: float) -> str:
    """The speed of a film in words."""
    if f"{speed:.2g}" == "1":
        return "in real time"
    return (
        f"{max(speed, 1.0 / speed):.2g} times {'faster' if speed > 1.0 else 'slower'}"
        " than real"
    )


def _magnification(result: TimeHistoryResult, levels: Array) -> float:
    """A round number that lets the largest drift of the roof be seen."""
    trace = result.trace
    if not result.structure.storeys:
        return 1.0
    drift = trace.floor_displacements[:, -1] - trace.cap_beam_displacement
    wanted = 0.1 * (levels[-1] - levels[0]) / max(float(np.nanmax(np.abs(drift))), 1e-12)
    return float(next((m for m in (100, 50, 20, 10, 5, 2) if m <= wanted), 1))


MEMORY = 2.0  # time for which the way of a column's head is seen [s]
USUAL_LENGTH = 9.0  # of a film whose speed nobody asked for, at most [s]
SWING = 2.0  # time in which mode shapes swing there and back [s]


FramePlan: TypeAlias = tuple[NDArray[np.int64], float]
"""Samples that become frames, and how much faster than real time they follow."""


def frame_plan(result: TimeHistoryResult, wanted: FilmRequest) -> FramePlan:
    """Frames of a history, by default of all its motion; a
    UsageError if they are too many.
    """
    time = result.trace.time
    rotation = np.abs(result.trace.rotation)
    moving = (
        np.flatnonzero(rotation > 0.01 * rotation.max())
        if rotation.any()
        else np.empty(0)
    )
    first = max(time[int(moving[0])] - 0.5, 0.0) if moving.size else 0.0
    last = min(time[int(moving[-1])] + 0.5, time[-1]) if moving.size else time[-1]
    last = last if wanted.last is None else min(wanted.last, time[-1])
    first = min(first, last) if wanted.first is None else wanted.first
    if first >= time[-1] or first < 0.0:
        raise UsageError(
            f"--animate-from {first:g}: must be >= 0 and before the end at {time[-1]:g} s"
        )
    last = last if last > first else time[-1]
    length = (
        (last - first) / wanted.speed if wanted.speed else min(last - first, USUAL_LENGTH)
    )
    count = length * wanted.rate
    if count > MOST_FRAMES:
        raise UsageError(
            f"--animate-speed {wanted.speed:g}: {last - first:.4g} s make {count:.5g}"
            f" frames, and {MOST_FRAMES} are the most; let it run faster, or show a part"
            " with --animate-from and --animate-to"
        )
    frames = max(int(count), 2)
    at = np.linspace(first, last, frames)
    samples = np.minimum(np.searchsorted(time, at), len(time) - 1)
    return samples, float((last - first) * wanted.rate / frames)


def history_film(
    result: TimeHistoryResult,
    title: str,
    wanted: FilmRequest,
    plan: FramePlan,
    look: Look = USUAL,
    progress: Progress = lambda *_: None,
) -> bytes:
    """The structure where its columns lean, an end enlarged or one
    from above, and the record.
    """
    samples, speed = plan

    def draw(figure: style.Figure) -> Motion:
        figure.set_size_inches(6.2, 4.4)
        panels = figure.subplot_mosaic(
            [["scene", "detail"], ["record", "record"]], width_ratios=[1.7, 1.0],
            height_ratios=[4.2, 1.0],
        )  # fmt: skip
        scene = Scene(panels["scene"], result, title, speed)
        detail, shown = _detail(panels["detail"], result, samples)
        cursor = _draw_record(panels["record"], result, samples)
        time = result.trace.time

        def show(frame: int) -> None:
            sample = int(samples[frame])
            scene.show(sample)
            detail.show(shown[frame])
            cursor.set_xdata([time[sample]] * 2)

        return len(samples), show

    return film(draw, wanted, look, progress)


def _detail(
    axes: style.Axes, result: TimeHistoryResult, samples: NDArray[np.int64]
) -> tuple[SlabView | PlanView | BearingView, NDArray[Any]]:
    """The slab from above where it turns, a column for other pairs, else an end of it;
    and what each frame shows of it.
    """
    if result.twist is not None:
        times = result.trace.time[samples]
        return SlabView(axes, result.twist), np.searchsorted(result.twist.time, times)
    if result.trace.y is not None:
        return PlanView(axes, result), samples
    detail = BearingView(axes, result.structure)
    frame_end(axes, result.structure.bearing)
    axes.set_title("lower end of a column, enlarged", fontsize=style.small())
    return detail, result.trace.rotation[samples]


def _draw_record(
    axes: style.Axes, result: TimeHistoryResult, samples: NDArray[np.int64]
) -> Line2D:
    """The ground acceleration of the part that is shown; returns its cursor."""
    trace = result.trace
    for name, of, colour in (("y", trace.y, style.RED), ("x", trace, style.BLACK)):
        if of is not None:
            axes.plot(
                trace.time, of.ground_acceleration, color=colour, lw=0.6, label=name
            )
    if trace.y is not None:
        axes.legend(loc="upper right", ncols=2, borderaxespad=0.1)
    first, last = trace.time[samples[[0, -1]]]
    axes.set(xlim=(first, last), ylabel="$a_g$ [m/s²]", xlabel="time [s]")
    return axes.axvline(first, color=style.RED, lw=1.2)


def of_history(
    result: TimeHistoryResult, title: str, wanted: FilmRequest, look: Look
) -> Callable[[Callable[[int, int], None]], bytes]:
    """Function that draws a history; refuses a part that it does not have."""
    return partial(history_film, result, title, wanted, frame_plan(result, wanted), look)


def of_modes(
    result: ModalResult, title: str, wanted: FilmRequest, look: Look
) -> Callable[[Callable[[int, int], None]], bytes]:
    """Function that draws the modes."""
    return partial(modes_film, result, title, wanted, look)


def modes_film(
    result: ModalResult,
    title: str,
    wanted: FilmRequest,
    look: Look = USUAL,
    progress: Progress = lambda *_: None,
) -> bytes:
    """The figure of the modes, its shapes swinging, all at one pace."""

    def draw(figure: style.Figure) -> Motion:
        modes_figure(result, f"{title}   |   all modes at one pace", figure)
        lines = [line for axes in figure.axes for line in axes.lines]
        shapes = [np.asarray(line.get_xdata(), dtype=float) for line in lines]
        frames = int(SWING * wanted.rate)

        def show(frame: int) -> None:
            for line, shape in zip(lines, shapes, strict=True):
                line.set_xdata(shape * np.cos(2.0 * np.pi * frame / frames))

        return frames, show

    return film(draw, wanted, look, progress)


def film(
    draw: Callable[[style.Figure], Motion],
    wanted: FilmRequest,
    look: Look = USUAL,
    progress: Progress = lambda *_: None,
) -> bytes:
    """The file of a film: `draw` fills a figure and says how it moves."""
    with style.in_style(look):
        from matplotlib.backends.backend_agg import FigureCanvasAgg

        figure = style.sheet()
        canvas: Any = FigureCanvasAgg(figure)
        count, show = draw(figure)
        # The encoder takes even numbers of pixels alone.
        width, height = figure.get_size_inches()
        pixels = 2.0 * np.round(0.5 * wanted.size * np.array([1.0, height / width]))
        figure.set_dpi(wanted.size / width)
        figure.set_size_inches(*(pixels / figure.dpi))
        show(0)
        frames = _frames(canvas, count, show, progress)
        return (_mp4 if wanted.ending == ".mp4" else _gif)(frames, wanted.rate)


def _frames(
    canvas: Any, count: int, show: Callable[[int], None], progress: Progress
) -> Iterator[Image]:
    """Frames of which only what moves is drawn: a tenth of the time of all of it."""
    from PIL import Image as Pillow

    figure = canvas.figure
    figure.draw_without_rendering()  # which gives all their places
    figure.set_layout_engine("none")
    show(count - 1)
    drawn = (
        each for axes in figure.axes for each in (*axes.lines, *axes.patches, *axes.texts)
    )
    moving = sorted((each for each in drawn if each.stale), key=lambda each: each.zorder)
    for each in moving:
        each.set_animated(True)  # left out of what is drawn once
    canvas.draw()
    still = canvas.copy_from_bbox(figure.bbox)
    for frame in range(count):
        canvas.restore_region(still)
        show(frame)
        for each in moving:
            figure.draw_artist(each)
        size = canvas.get_width_height()
        yield Pillow.frombuffer("RGBA", size, canvas.buffer_rgba()).convert("RGB")
        progress(frame + 1, count)


def _gif(frames: Iterator[Image], rate: int) -> bytes:
    """Repeated for ever."""
    from PIL.Image import Quantize

    first, *others = (frame.quantize(method=Quantize.FASTOCTREE) for frame in frames)
    file = io.BytesIO()
    milliseconds = round(1000 / rate)
    first.save(
        file, "GIF", save_all=True, append_images=others, duration=milliseconds, loop=0
    )
    return file.getvalue()


def _mp4(frames: Iterator[Image], rate: int) -> bytes:
    """Written beside and read again: the encoder goes back in its file."""
    first = next(frames)
    with TemporaryDirectory() as folder:
        file = Path(folder, "film.mp4")
        command = [
            shutil.which(ENCODER) or ENCODER, "-loglevel", "error",
            "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{first.width}x{first.height}",
            "-r", str(rate), "-i", "-", "-pix_fmt", "yuv420p", str(file),
        ]  # fmt: skip
        pipe = subprocess.PIPE
        with subprocess.Popen(command, stdin=pipe, stderr=pipe) as encoder:  # noqa: S603 -- ours
            assert encoder.stdin is not None, "it is a pipe"
            with suppress(BrokenPipeError):  # it says why it ended
                for frame in chain([first], frames):
                    encoder.stdin.write(frame.tobytes())
            _, complaint = encoder.communicate()
        if encoder.returncode:
            reason = complaint.decode(errors="replace").strip()
            reason = reason or f"it ends with {encoder.returncode}"
            raise OutputError(f"{ENCODER} could not make the film: {reason}")
        return file.read_bytes()
