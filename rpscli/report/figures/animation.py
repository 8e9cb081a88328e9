"""A moving picture of a time history: columns leaning, building swaying."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.report.figures import style
from rpscli.report.figures.scene import Scene

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from PIL.Image import Image

    from rpscli.analyses.results import TimeHistoryResult

FRAMES_PER_SECOND = 20
MOST_FRAMES = 180
NO_DITHER: Any = 0


class Plan(NamedTuple):
    """Which samples become frames, and how much faster than in reality they follow."""

    samples: NDArray[np.int64]
    speed: float


def frame_plan(result: TimeHistoryResult) -> Plan:
    """Evenly spaced samples from the first motion to the last, at most `MOST_FRAMES`."""
    time, rotation = result.trace.time, np.abs(result.trace.rotation)
    moving = np.flatnonzero(rotation > 0.01 * rotation.max()) if rotation.any() else np.empty(0)
    first = max(time[int(moving[0])] - 0.5, 0.0) if moving.size else 0.0
    last = min(time[int(moving[-1])] + 0.5, time[-1]) if moving.size else time[-1]
    frames = int(np.clip((last - first) * FRAMES_PER_SECOND, 2, MOST_FRAMES))
    at = np.linspace(first, last, frames)
    samples = np.minimum(np.searchsorted(time, at), len(time) - 1)
    return Plan(samples, float((last - first) * FRAMES_PER_SECOND / frames))


def animation_gif(result: TimeHistoryResult, title: str) -> bytes:
    """The GIF file. Bearings and cap beam move to scale, storey drifts are magnified."""
    import matplotlib.style  # noqa: PLC0415
    from matplotlib.backends.backend_agg import FigureCanvasAgg  # noqa: PLC0415
    from matplotlib.figure import Figure  # noqa: PLC0415

    plan = frame_plan(result)
    with matplotlib.style.context(["default", style.STYLE]):
        figure = Figure(figsize=(5.4, 6.2), dpi=90, layout="constrained")
        canvas = FigureCanvasAgg(figure)
        picture, record = figure.subplots(2, 1, height_ratios=[5.6, 1.0])
        scene = Scene(picture, result, title, plan.speed)
        cursor = _draw_record(record, result, plan)
        images = []
        for sample in plan.samples:
            scene.show(int(sample))
            cursor.set_xdata([result.trace.time[sample]] * 2)
            canvas.draw()  # type: ignore[no-untyped-call]
            images.append(_image(canvas))
            figure.set_layout_engine("none")  # laid out once: the picture must not jump
    return _gif(images)


def _draw_record(axes: Axes, result: TimeHistoryResult, plan: Plan) -> Any:
    trace = result.trace
    axes.plot(trace.time, trace.ground_acceleration, color=style.BLACK, lw=0.6)
    first, last = trace.time[plan.samples[0]], trace.time[plan.samples[-1]]
    axes.set_xlim(first, last)
    axes.set_ylabel("$a_g$ [m/s²]")
    axes.set_xlabel("time [s]")
    return axes.axvline(first, color=style.RED, lw=1.2)


def _image(canvas: Any) -> Image:
    from PIL import Image as Pillow  # noqa: PLC0415

    return Pillow.fromarray(np.asarray(canvas.buffer_rgba())[..., :3].copy())


def _gif(images: list[Image]) -> bytes:
    """All frames in one palette, repeated for ever."""
    palette = _palette()
    frames = [image.quantize(palette=palette, dither=NO_DITHER) for image in images]
    buffer = io.BytesIO()
    frames[0].save(
        buffer, format="GIF", save_all=True, append_images=frames[1:],
        duration=round(1000 / FRAMES_PER_SECOND), loop=0, optimize=False,
    )  # fmt: skip
    return buffer.getvalue()


def _palette() -> Image:
    """The inks of the picture, each in steps towards white: what smooth edges need."""
    from matplotlib.colors import to_rgb  # noqa: PLC0415
    from PIL import Image as Pillow  # noqa: PLC0415

    inks = np.array([to_rgb(ink) for ink in (style.BLACK, style.BLUE, style.RED)])
    steps = np.linspace(0.0, 1.0, 32)[:, None, None]
    colours = np.rint(255.0 * (inks + steps * (1.0 - inks))).astype(int)
    image = Pillow.new("P", (1, 1))
    image.putpalette(colours.ravel().tolist())
    return image
