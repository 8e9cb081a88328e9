"""Moving pictures: a figure that moves, as a GIF or, with ffmpeg, as an MP4 file."""

from __future__ import annotations

import io
import shutil
import subprocess
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, NamedTuple

from rpscli.errors import OutputError, UsageError
from rpscli.report.figures import style

if TYPE_CHECKING:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from PIL.Image import Image

RATES = {".gif": 20, ".mp4": 30}
"""Frames a second, by the ending of the file."""
USUAL_SIZE = 720
"""Width [pixels]."""
MOST_FRAMES = 3000
ENCODER = "ffmpeg"
NO_DITHER: Any = 0

Progress = Callable[[int, int], None]
"""Is told how many frames are drawn, and of how many."""


@dataclass(frozen=True)
class FilmRequest:
    """What is wanted of a film.

    Parameters
    ----------
    file
        Its ending says the format.
    size
        Width [pixels].
    speed
        Times real time; None fits the motion into some seconds.
    first, last
        The part of the history that is shown [s]; None where the motion begins or ends.

    Raises
    ------
    UsageError
        If there is no such format here, or no such part.
    """

    file: Path
    size: int = USUAL_SIZE
    speed: float | None = None
    first: float | None = None
    last: float | None = None

    def __post_init__(self) -> None:
        """Refuse before anything is computed."""
        if self.ending not in RATES:
            raise UsageError(f"--animate {self.file}: must end with {' or '.join(RATES)}")
        if self.ending == ".mp4" and shutil.which(ENCODER) is None:
            raise UsageError(
                f"--animate {self.file}: MP4 needs the program {ENCODER}, which is not on the"
                f" path; install it, or write {self.file.with_suffix('.gif')}"
            )
        if self.last is not None and (self.first or 0.0) >= self.last:
            raise UsageError(
                f"--animate-to {self.last:g} must be later than --animate-from {self.first or 0:g}"
            )

    @property
    def ending(self) -> str:
        """Of the file."""
        return self.file.suffix.lower()

    @property
    def rate(self) -> int:
        """Frames a second."""
        return RATES[self.ending]


class Motion(NamedTuple):
    """How a figure moves: so many frames, and what shows each of them, counted from 0."""

    frames: int
    show: Callable[[int], None]


def film(
    draw: Callable[[Figure], Motion],
    width: float,
    height: float,
    wanted: FilmRequest,
    progress: Progress = lambda *_: None,
) -> bytes:
    """The file of a film.

    Parameters
    ----------
    draw
        Fills the figure, and says how it moves.
    width, height
        Of the figure [in], which lays itself out once.
    """
    with style.in_style():
        from matplotlib.backends.backend_agg import FigureCanvasAgg  # noqa: PLC0415
        from matplotlib.figure import Figure  # noqa: PLC0415

        figure = Figure(figsize=(width, height), dpi=wanted.size / width, layout="constrained")
        canvas = FigureCanvasAgg(figure)
        motion = draw(figure)

        def moved() -> Iterator[None]:
            for frame in range(motion.frames):
                motion.show(frame)
                yield
                figure.set_layout_engine("none")  # the picture must not jump
                progress(frame + 1, motion.frames)

        if wanted.ending == ".mp4":
            return _mp4(figure, moved(), wanted.rate)
        return _gif(canvas, moved(), wanted.rate)


def _gif(canvas: FigureCanvasAgg, moved: Iterator[None], rate: int) -> bytes:
    """All frames in one palette, repeated for ever."""
    palette = _palette()
    frames = [_image(canvas).quantize(palette=palette, dither=NO_DITHER) for _ in moved]
    buffer = io.BytesIO()
    frames[0].save(
        buffer, format="GIF", save_all=True, append_images=frames[1:],
        duration=round(1000 / rate), loop=0, optimize=False,
    )  # fmt: skip
    return buffer.getvalue()


def _image(canvas: FigureCanvasAgg) -> Image:
    import numpy as np  # noqa: PLC0415
    from PIL import Image as Pillow  # noqa: PLC0415

    canvas.draw()  # type: ignore[no-untyped-call]
    pixels: Any = canvas.buffer_rgba()  # type: ignore[no-untyped-call]
    return Pillow.fromarray(np.asarray(pixels)[..., :3].copy())


def _palette() -> Image:
    """The inks of the pictures, each in steps towards white: what smooth edges need."""
    import numpy as np  # noqa: PLC0415
    from matplotlib.colors import to_rgb  # noqa: PLC0415
    from PIL import Image as Pillow  # noqa: PLC0415

    inks = np.array([to_rgb(ink) for ink in (style.BLACK, style.BLUE, style.RED)])
    steps = np.linspace(0.0, 1.0, 32)[:, None, None]
    colours = np.rint(255.0 * (inks + steps * (1.0 - inks))).astype(int)
    image = Pillow.new("P", (1, 1))
    image.putpalette(colours.ravel().tolist())
    return image


def _mp4(figure: Figure, moved: Iterator[None], rate: int) -> bytes:
    """Written beside and read again: the encoder goes back in its file.

    Raises
    ------
    OutputError
        If the encoder fails.
    """
    from matplotlib.animation import FFMpegWriter  # noqa: PLC0415

    writer = FFMpegWriter(fps=rate, codec="h264")
    with TemporaryDirectory() as folder:
        file = Path(folder, "film.mp4")
        try:
            with writer.saving(figure, str(file), figure.dpi):
                for _ in moved:
                    writer.grab_frame()
        except (subprocess.CalledProcessError, OSError) as error:
            raise OutputError(f"{ENCODER} could not make the film: {error}") from None
        return file.read_bytes()
