"""One style for all figures; matplotlib is imported when the first of them is drawn."""

from __future__ import annotations

import io
import re
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, TypeVar, cast

from rpscli.errors import UsageError
from rpscli.report.figures.look import (
    SMALL,
    Look,
    complaints,
    drawn_with,
    in_force,
    quiet_matplotlib,
    read_style,
)

if TYPE_CHECKING:
    from matplotlib import artist, axes, figure
    from matplotlib.figure import SubFigure

# Okabe and Ito's colours: told apart by every kind of colour vision, and in grey.
BLACK = "#000000"
BLUE = "#0072B2"
RED = "#D55E00"
GREEN = "#009E73"
ORANGE = "#E69F00"
SKY = "#56B4E9"
PINK = "#CC79A7"
GREY = "#7F7F7F"

ROLLING_SHADE = "#DCEBF7"
ROCKING_SHADE = "#FBE3D0"

DPI = 150
COMPRESSION = 3
"""Of PNG files: a tenth larger than at the usual 6, in two thirds of the time."""
LETTERS_PER_INCH = 15.0
"""Of letters of 8 points."""

WIDTH = 7.0
"""Width of a figure [in]: a page with its margins."""

STYLE: dict[str, Any] = {
    "font.family": "sans-serif",
    "figure.dpi": DPI,
    "axes.linewidth": 0.7,
    "axes.axisbelow": True,
    "axes.grid": True,
    "grid.color": "#E3E3E3",
    "grid.linewidth": 0.5,
    "lines.linewidth": 1.1,
    "legend.frameon": False,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "agg.path.chunksize": 20000,
    "pdf.fonttype": 42,  # TrueType: journals refuse the other kind
    "svg.fonttype": "none",  # text stays text, in the first of several fonts that a viewer has
    "svg.hashsalt": "rps",  # the same data give the same file
}

Entry = TypeVar("Entry")
Artist: TypeAlias = "artist.Artist"
Axes: TypeAlias = "axes.Axes"
Figure: TypeAlias = "figure.Figure"
Target: TypeAlias = "Figure | SubFigure"

SAVED: dict[str, dict[str, Any]] = {
    "png": {"metadata": {"Software": None}, "pil_kwargs": {"compress_level": COMPRESSION}},
    "svg": {"metadata": {"Date": None}},
    "pdf": {"metadata": dict.fromkeys(("CreationDate", "Creator", "Producer"))},
}
"""Options of each format, which leave out what matplotlib says of itself and the time."""


def picture(
    draw: Callable[[Figure], None],
    height: float,
    width: float = WIDTH,
    layout: Literal["constrained"] | None = "constrained",
) -> bytes:
    """The file of a figure (width, height) [in], with the look and in the format in force."""
    if (kept := _kept.get()) is not None and kept.target is not None:
        draw(cast("Figure", kept.target))
        return b""
    now = in_force()
    with in_style(), _no_noise():
        from matplotlib.figure import Figure

        figure = Figure(figsize=(now.look.width(width), height), layout=layout)
        draw(figure)
        if kept is not None:
            kept.target = figure
            return b""
        if (engine := figure.get_layout_engine()) is not None:
            # Once, and no more: matplotlib would do it in a trial drawing, and again in the real
            # one, which takes twice as long.
            engine.execute(figure)
            figure.set_layout_engine(None)
        buffer = io.BytesIO()
        figure.savefig(buffer, format=now.ending, **SAVED[now.ending])
    if now.ending == "svg":  # formulas name one font, and none to fall back on
        return re.sub(rb"(font-family: '[^',]+')(?=[;\"])", rb"\1, sans-serif", buffer.getvalue())
    return buffer.getvalue()


def drawable_style(path: Path) -> dict[str, Any]:
    """The settings of a style file, with which something small was drawn."""
    settings = read_style(path)

    def draw(figure: Figure) -> None:
        axes = figure.subplots()
        axes.plot([0.0, 1.0], label="$\\theta$ text")
        axes.legend()
        heading(figure, "title", "remark")

    with complaints() as texts:
        try:
            for ending in SAVED:
                drawn_with(Look(style=settings), ending, lambda: picture(draw, 3.0))
            reason = ""
        except Exception as error:  # noqa: BLE001 -- it may fail in any way
            reason = " ".join(str(error).split())[:160]
    if reason or texts:
        raise UsageError(
            f"--style {path}: cannot be drawn with: {reason or '; '.join(dict.fromkeys(texts))};"
            " correct the style, or install what it asks for"
        )
    return settings


def single(
    draw: Callable[[Axes, Any], None],
    shown: Any,
    words: Sequence[str],
    height: float,
    width: float = WIDTH,
) -> bytes:
    """The file of a figure of one picture under a heading."""

    def fill(figure: Figure) -> None:
        heading(figure, *words)
        draw(figure.subplots(), shown)

    return picture(fill, height, width)


@dataclass
class Kept:
    """A figure that is to be kept, in place of becoming a file."""

    target: Target | None


_kept: ContextVar[Kept | None] = ContextVar("kept", default=None)


def kept_figure(draw: Callable[[], bytes], target: Target | Axes | None = None) -> Target:
    """The figure that `draw` would make a file of; drawn into the target if there is one."""
    from matplotlib.axes import Axes

    kept = Kept(_in_place_of(target) if isinstance(target, Axes) else target)
    token = _kept.set(kept)
    try:
        draw()
    finally:
        _kept.reset(token)
    assert kept.target is not None, "something was drawn"
    return kept.target


def _in_place_of(axes: Axes) -> SubFigure:
    place = axes.get_subplotspec()
    if place is None:
        raise UsageError("the axes are no subplot: give a figure, or axes of plt.subplots()")
    part: SubFigure = axes.figure.add_subfigure(place)
    axes.remove()
    return part


def given() -> Target | None:
    """Somebody's figure that is to be drawn into."""
    kept = _kept.get()
    return None if kept is None else kept.target


def room(usual: float) -> float:
    """Width that a figure will have [in]; its own one, where nothing else is said."""
    target = given()
    return in_force().look.width(usual) if target is None else inches(target)[0]


def narrow() -> bool:
    """True if the figure will be narrower than a page."""
    return room(WIDTH) < WIDTH


@contextmanager
def in_style() -> Iterator[None]:
    """Figures that are made inside look like those that the program writes."""
    quiet_matplotlib()
    import matplotlib.style

    # "default" first: a user's own matplotlibrc must not change what a report looks like.
    with matplotlib.style.context(["default", STYLE, in_force().look.settings]):
        yield


@contextmanager
def _no_noise() -> Iterator[None]:
    """Letters that the font lacks show in the picture; matplotlib prints a line for each."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Glyph .* missing from font")
        warnings.filterwarnings("ignore", message="Matplotlib currently does not support")
        yield


def inches(figure: Target) -> tuple[float, float]:
    """Width and height of a figure, or of a part of it [in]."""
    return figure.bbox.width / figure.dpi, figure.bbox.height / figure.dpi


def small() -> float:
    """Size of small letters [pt], inside a figure that is being drawn."""
    import matplotlib as mpl

    return SMALL * float(mpl.rcParams["font.size"])


def heading(figure: Figure, *parts: str) -> None:
    """Title and remarks above a figure: a line, and a few below it."""
    title, *others = [part for part in parts if part] or [""]
    width = inches(figure)[0]
    narrow, most = width < WIDTH, int(LETTERS_PER_INCH * width * 8.0 / small())
    lines = ["   |   ".join((title, *others))]
    if others and len(lines[0]) > most:
        remarks = "   |   ".join(others)
        lines = wrap(title, most, max_lines=2, placeholder="...") if narrow else [title]
        lines += wrap(remarks, most, max_lines=6 if narrow else 2, placeholder="...")
    cut = [line if len(line) <= most else f"{line[: most - 3]}..." for line in lines]
    # A dollar sign in a title begins no formula.
    figure.suptitle("\n".join(cut), fontsize=small(), color=GREY, parse_math=False)


def percent(share: float) -> str:
    """A share in per cent."""
    return f"{100.0 * share:.3g} %"


def typeset(text: str) -> str:
    """A text of tables as figures show it."""
    return text.replace("m/s2", "m/s²")


def in_rows(entries: Sequence[Entry], columns: int) -> list[Entry]:
    """Entries in the order in which a legend that fills column by column reads row by row."""
    return [entry for column in range(columns) for entry in entries[column::columns]]


def entries(panels: Iterable[Axes]) -> dict[str, Any]:
    """Entries of the legends of several axes by name, each once."""
    found: dict[str, Any] = {}
    for axes in panels:
        for handle, name in zip(*axes.get_legend_handles_labels(), strict=True):
            found.setdefault(name, handle)
    return found


def legend_above(axes: Axes, columns: int) -> None:
    """A legend on top of the axes, where it covers nothing; folded where the figure is narrow."""
    width, _ = inches(axes.figure)
    if width < WIDTH:
        widest = max(_letters(str(text)) for text in axes.get_legend_handles_labels()[1])
        room = (width - 0.5) / (0.4 + widest / LETTERS_PER_INCH)
        columns = max(1, min(columns, int(room)))
    handles, names = axes.get_legend_handles_labels()
    axes.legend(
        in_rows(handles, columns),
        in_rows(names, columns),
        loc="lower right" if width < WIDTH else "lower left",
        bbox_to_anchor=(0.0, 1.0, 1.0, 0.1),
        ncols=columns,
        borderaxespad=0.1,
        columnspacing=1.4,
        handlelength=1.8,
    )


def _letters(text: str) -> int:
    """Number of letters that a text with formulas shows, about."""
    return len(re.sub(r"[${}_^]", "", re.sub(r"\\[A-Za-z]+", "x", text)))


def folded(figure: Figure, text: str) -> str:
    """A label of one of several axes side by side: in a narrow figure, one word a line."""
    return text if inches(figure)[0] >= WIDTH else text.replace(" ", "\n")


def over(unit: float) -> tuple[Callable[[Any], Any], Callable[[Any], Any]]:
    """Functions of a secondary axis that shows values as multiples of `unit`."""
    return (lambda value: value / unit), (lambda ratio: ratio * unit)


def engineering(largest: float) -> tuple[float, str]:
    """Factor and prefix that bring a value between 1 and 1000."""
    for factor, prefix in ((1e-6, "M"), (1e-3, "k")):
        if largest * factor >= 1.0:
            return factor, prefix
    return 1.0, ""


def require(what: str, value: object, known: Iterable[object]) -> None:
    """Refuse what is not there: an index from the end would draw another panel than is wanted."""
    there = list(known)
    if value not in there:
        names = ", ".join(map(str, there[:3])) + (f" to {there[-1]}" if len(there) > 3 else "")
        raise UsageError(
            f"{str(value)[:60]!r} is none of the {what}; there are {names or 'none to be drawn'}"
        )
