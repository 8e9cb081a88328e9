"""Moving pictures: a figure that moves, as a GIF or, with ffmpeg, as an MP4 file."""

from __future__ import annotations

import io
import math
import shutil
import subprocess
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, NamedTuple

from rpscli.errors import OutputError, UsageError
from rpscli.report.figures import style
from rpscli.report.files import require_writable_file

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.figure import Figure
    from PIL.Image import Image

RATES = {".gif": 20, ".mp4": 30}  # frames a second, by the ending of the file
USUAL_SIZE = 900  # width [pixels]
MOST_FRAMES = 3000
ENCODER = "ffmpeg"
NO_DITHER: Any = 0

Progress = Callable[[int, int], None]  # is told how many frames are drawn, and of how many


@dataclass(frozen=True)
class FilmRequest:
    """A film to be made, whose ending says the format; it is refused before the work."""

    file: Path
    size: int = USUAL_SIZE  # width [pixels]
    speed: float | None = None  # times real time; None fits the motion into some seconds
    first: float | None = None  # [s]; None where the motion begins
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
        for option, value in (("speed", self.speed), ("from", self.first), ("to", self.last)):
            if value is not None and not math.isfinite(value):
                raise UsageError(
                    f"--animate-{option} {value:g}: must be a finite number; leave it out to show"
                    " all that moves"
                )
        if self.last is not None and (self.first or 0.0) >= self.last:
            raise UsageError(
                f"--animate-to {self.last:g} must be later than --animate-from {self.first or 0:g}"
            )
        require_writable_file(self.file)

    @property
    def ending(self) -> str:
        """Of the file."""
        return self.file.suffix.lower()

    @property
    def rate(self) -> int:
        """Frames a second."""
        return RATES[self.ending]


class Motion(NamedTuple):
    """A moving figure: frames, what shows each of them, and what moves above all that does not."""

    frames: int
    show: Callable[[int], None]
    moving: Sequence[Artist]


def film(
    draw: Callable[[Figure], Motion],
    width: float,
    height: float,
    wanted: FilmRequest,
    progress: Progress = lambda *_: None,
) -> bytes:
    """The file of a film: `draw` fills a figure (width, height) [in] and says how it moves."""
    with style.in_style():
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        figure = Figure(figsize=(width, height), dpi=wanted.size / width, layout="constrained")
        canvas: Any = FigureCanvasAgg(figure)
        motion = draw(figure)
        motion.show(0)
        frames = _frames(canvas, motion, progress)
        return _mp4(frames, wanted.rate) if wanted.ending == ".mp4" else _gif(frames, wanted.rate)


def _frames(canvas: Any, motion: Motion, progress: Progress) -> Iterator[Image]:
    from PIL import Image as Pillow

    for each in motion.moving:
        each.set_animated(True)  # left out of what is drawn once
    canvas.draw()
    canvas.figure.set_layout_engine("none")
    still = canvas.copy_from_bbox(canvas.figure.bbox)
    for frame in range(motion.frames):
        canvas.restore_region(still)
        motion.show(frame)
        for each in motion.moving:
            canvas.figure.draw_artist(each)
        width, height = canvas.get_width_height()
        yield Pillow.frombuffer("RGBA", (width, height), canvas.buffer_rgba()).convert("RGB")
        progress(frame + 1, motion.frames)


def _gif(frames: Iterator[Image], rate: int) -> bytes:
    """All frames in one palette, repeated for ever."""
    import numpy as np
    from matplotlib.colors import to_rgb
    from PIL import Image as Pillow

    # The inks of the pictures, each in steps towards white: what smooth edges need.
    inks = np.array([to_rgb(each) for each in INKS])
    steps = np.linspace(0.0, 1.0, 32)[:, None, None]
    colours = np.rint(255.0 * (inks + steps * (1.0 - inks))).astype(int)
    palette = Pillow.new("P", (1, 1))
    palette.putpalette(colours.ravel().tolist())
    first, *others = (frame.quantize(palette=palette, dither=NO_DITHER) for frame in frames)
    buffer = io.BytesIO()
    first.save(
        buffer, format="GIF", save_all=True, append_images=others,
        duration=round(1000 / rate), loop=0, optimize=False,
    )  # fmt: skip
    return buffer.getvalue()


INKS = (style.BLACK, style.BLUE, style.RED, style.GREEN, style.PINK)


def _mp4(frames: Iterator[Image], rate: int) -> bytes:
    """Written beside and read again: the encoder goes back in its file."""
    first = next(frames)
    with TemporaryDirectory() as folder:
        file = Path(folder, "film.mp4")
        command = [
            shutil.which(ENCODER) or ENCODER, "-loglevel", "error",
            "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{first.width}x{first.height}",
            "-r", str(rate), "-i", "-",
            # players want halved colours, and these an even size
            "-vf", "crop=trunc(iw/2)*2:trunc(ih/2)*2", "-pix_fmt", "yuv420p", str(file),
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
