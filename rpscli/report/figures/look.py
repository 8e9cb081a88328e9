"""The look of figures and films: formats, width, and what a
user's own style file says.
"""

from __future__ import annotations

import logging
import os
import re
import shutil
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, cast

from rpscli.errors import UsageError
from rpscli.registry import Registry
from rpscli.report.files import require_writable_file
from rpscli.user_cache import is_writable, user_cache, users_folder

FORMATS = ("png", "svg", "pdf")
FIGURES: Registry[Callable[..., Any]] = Registry(
    "figures", {}, Callable[..., Any], taken=(*FORMATS, "none")
)
"""Panels of other packages, drawn into axes from a result; ours
are in `rpscli.figures`."""
COLUMN_WIDTHS = {1: 3.5, 2: 7.0}
"""Widths of figures [in] that fill one or two columns of a journal: 89 and 178 mm."""

FONT_SIZE = 9.0  # points, where no style file says otherwise
SMALL = 8.0 / 9.0  # numbers on axes, legends and headings, as a part of the font size


@dataclass(frozen=True)
class Look:
    """Formats, width and settings of the figures of a command."""

    formats: tuple[str, ...] | None = (
        None  # none at all if empty, None if the user did not say
    )
    columns: int | None = (
        None  # of the page that a figure fills; None leaves it its own width
    )
    style: Mapping[str, Any] = field(
        default_factory=dict
    )  # matplotlib's settings, over ours
    added: tuple[str, ...] = ()  # names of `FIGURES`

    @property
    def endings(self) -> tuple[str, ...]:
        """Formats to be written; PNG if the user did not say."""
        return ("png",) if self.formats is None else self.formats

    def width(self, usual: float) -> float:
        """Width of a figure [in]: its own, that of its columns,
        or that of the style file.
        """
        if self.columns is not None:
            return min(usual, COLUMN_WIDTHS[self.columns])
        if "figure.figsize" in self.style:
            return float(self.style["figure.figsize"][0])
        return usual

    @property
    def settings(self) -> dict[str, Any]:
        """matplotlib's settings: sizes of letters follow the font size."""
        size = float(self.style.get("font.size", FONT_SIZE))
        sizes = {
            "font.size": size,
            "axes.titlesize": size,
            "axes.labelsize": size,
            "legend.fontsize": SMALL * size,
            "xtick.labelsize": SMALL * size,
            "ytick.labelsize": SMALL * size,
        }
        return {**sizes, **self.style}


RATES = {".gif": 20, ".mp4": 30}  # frames a second, by the ending of the file
USUAL_SIZE = 900  # width [pixels]
MOST_FRAMES = 3000
ENCODER = "ffmpeg"


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
                f"--animate {self.file}: MP4 needs the program {ENCODER}, which is not on"
                f" the path; install it, or write {self.file.with_suffix('.gif')}"
            )
        if self.last is not None and (self.first or 0.0) >= self.last:
            raise UsageError(
                f"--animate-to {self.last:g} must be later than --animate-from"
                f" {self.first or 0:g}"
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


USUAL = Look()  # the look for a user who asks for nothing


def quiet_matplotlib() -> None:
    """Give matplotlib a folder for its list of fonts where its own cannot be written."""
    # Otherwise it makes a new one each time, and prints two lines about it.
    if "MPLCONFIGDIR" in os.environ or "matplotlib" in sys.modules:
        return
    # Elsewhere than on Linux the folder's name depends on the version of matplotlib.
    where = (
        ("XDG_CONFIG_HOME", "~/.config", "matplotlib")
        if sys.platform == "linux"
        else ("", "~")
    )
    usual = users_folder(*where)
    if not (usual and is_writable(usual)) and (place := user_cache()):
        os.environ["MPLCONFIGDIR"] = str(place / "matplotlib")


def font_file() -> str:
    """The font of figures, matplotlib's own where there is none of the wanted ones."""
    quiet_matplotlib()
    from matplotlib.font_manager import FontProperties, findfont

    return str(findfont(FontProperties(family=["sans-serif"])))


def read_style(path: Path) -> dict[str, Any]:
    """matplotlib's settings in a style file."""
    quiet_matplotlib()
    from matplotlib import rc_params_from_file

    with complaints() as texts:
        try:
            settings = rc_params_from_file(_regular(path), use_default_template=False)
            found = cast("dict[str, Any]", settings)
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or "is not a text"
            raise UsageError(
                f"--style {str(path)[:200]}: cannot be read: {reason}; name a style file"
                " of matplotlib"
            ) from None
    if any("axes.prop_cycle" in each for each in (*found, *texts)):
        raise UsageError(
            f"--style {path}: axes.prop_cycle is gone: colours are the program's own, and"
            " stand for things; remove the line, or draw into axes of yours with"
            " rpscli.figures"
        )
    if texts:
        # Of a file that was not meant, a line is not shown.
        tail = "" if texts[0].startswith("Bad value") else r" \(['\"].*|"
        first = re.sub(rf"{tail}(?<=^Bad key .{{20}}).*(?= in file)", "", texts[0])
        more = f" (and {len(texts) - 1} more)" if len(texts) > 1 else ""
        more += "; a # begins a remark there: write colours without it" * ("#" in first)
        raise UsageError(f"--style {path}: {first[:200]}{more}")
    # Which window figures are shown in is no matter of style: matplotlib would say so
    # each time.
    return {key: value for key, value in found.items() if key not in NO_STYLE}


NO_STYLE = frozenset(
    ("backend", "backend_fallback", "interactive", "toolbar", "webagg.port")
)


@contextmanager
def complaints() -> Iterator[list[str]]:
    """Messages that matplotlib would print, and then go on."""
    from logging.handlers import BufferingHandler

    handler = BufferingHandler(capacity=1000)
    texts = list[str]()
    handler.setLevel(logging.WARNING)
    logger = logging.getLogger("matplotlib")
    logger.addHandler(handler)
    passed_on = logger.propagate
    logger.propagate = False
    try:
        yield texts
    finally:
        logger.removeHandler(handler)
        logger.propagate = passed_on
        texts += [" ".join(record.getMessage().split()) for record in handler.buffer]


def _regular(path: Path) -> Path:
    """The path, but of a device or a pipe, which may have no end."""
    if path.exists() and not path.is_file():
        raise OSError(0, "is not a file")
    return path
