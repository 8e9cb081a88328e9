"""One style for all figures; matplotlib is imported when the first of them is drawn."""

from __future__ import annotations

import io
import re
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias, cast

from rpscli.errors import UsageError
from rpscli.report.figures.look import (
    SMALL,
    USUAL,
    Look,
    complaints,
    quiet_matplotlib,
    read_style,
)
from rpscli.report.files import Drawing

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
COMPRESSION = (
    3  # of PNG files: a tenth larger than at the usual 6, in two thirds of the time
)
LINE = 0.15  # height of a line of small letters [in]

WIDTH = 7.0  # width of a figure [in]: a page with its margins
# width of the label and the numbers beside a row of panels, and of the margins [in]
BESIDE = 0.7
TIGHT = 4.0  # height [in]
CROWDED = 2.4  # width or height of the place of axes [in], some 60 mm
LESS = 0.8  # size of letters in these, as a part of small ones
FEW_TICKS = 4
LEGEND_SHARE = 0.3
LABEL_SHARE = 0.55
"""Of the height of such a place what a legend, or a label of an axis, may take."""
PAGE = 240.0 / 25.4  # height of a page of A4 within its margins [in]

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
    # text stays text, in the first of several fonts that a viewer has
    "svg.fonttype": "none",
    "svg.hashsalt": "rps",  # the same data give the same file
}

Artist: TypeAlias = "artist.Artist"
Axes: TypeAlias = "axes.Axes"
Figure: TypeAlias = "figure.Figure"
Target: TypeAlias = "Figure | SubFigure"
At = tuple[float, float]

SAVED: dict[str, dict[str, Any]] = {
    "png": {
        "metadata": {"Software": None},
        "pil_kwargs": {"compress_level": COMPRESSION},
    },
    "svg": {"metadata": {"Date": None}},
    "pdf": {"metadata": dict.fromkeys(("CreationDate", "Creator", "Producer"))},
}
"""Options of each format, which leave out what matplotlib says of itself and the time."""


Draw: TypeAlias = Callable[[Any], None]
"""Fills a figure, whose size and heading `begin` sets."""


def picture(draw: Draw, look: Look, ending: str) -> bytes:
    """The file of a figure with a look, in the format of an ending."""
    with in_style(look), warnings.catch_warnings():
        # Letters that the font lacks show in the picture; matplotlib prints a line for
        # each.
        warnings.filterwarnings("ignore", message="Glyph .* missing from font")
        warnings.filterwarnings("ignore", message="Matplotlib currently does not support")
        figure = drawn(draw, look)
        engine = figure.get_layout_engine()
        assert engine is not None, "it was asked for"
        # Once, and no more: matplotlib would do it in a trial drawing, and again in the
        # real one, which takes twice as long.
        engine.execute(figure)
        figure.set_layout_engine(None)
        buffer = io.BytesIO()
        figure.savefig(buffer, format=ending, **SAVED[ending])
    if ending == "svg":  # formulas name one font, and none to fall back on
        return re.sub(
            rb"(font-family: '[^',]+')(?=[;\"])", rb"\1, sans-serif", buffer.getvalue()
        )
    return buffer.getvalue()


def sheet(look: Look = USUAL) -> Figure:
    """An empty figure of ours, which knows its look."""
    from matplotlib.figure import Figure

    figure = Figure(layout="constrained")
    figure.rps_look = look  # type: ignore[attr-defined]
    return figure


def drawn(draw: Draw, look: Look = USUAL) -> Figure:
    """A figure of ours, which is no file yet."""
    with in_style(look):
        figure = sheet(look)
        draw(figure)
        fit(figure.axes)
    return figure


def drawn_into(target: Target | Axes, draw: Draw) -> Target:
    """Somebody's figure or a part of it; axes give their place to a part."""
    from matplotlib.axes import Axes

    if isinstance(target, Axes):
        if (place := target.get_subplotspec()) is None:
            raise UsageError(
                "the axes are no subplot: give a figure, or axes of plt.subplots()"
            )
        axes = target
        target = target.figure.add_subfigure(place)
        axes.remove()
    if (whole := root(target)).get_layout_engine() is None:
        whole.set_layout_engine("constrained")
    draw(cast("Figure", target))
    fit(cast("list[Axes]", target.findobj(Axes)))
    return target


def figure_files(figures: Mapping[str, Draw], look: Look) -> dict[str, Drawing]:
    """The files of figures, given by their names without ending, in
    each format that is wanted.
    """
    return {
        name: Drawing(name, partial(picture, draw, look, ending))
        for stem, draw in figures.items()
        for ending in look.endings
        for name in [f"{stem}.{ending}"]
    }


def drawable_style(path: Path) -> dict[str, Any]:
    """The settings of a style file, with which something small was drawn."""
    settings = read_style(path)

    def draw(figure: Figure) -> None:
        begin(figure, ("title", "remark"), 3.0)
        axes = figure.subplots()
        axes.plot([0.0, 1.0], label="$\\theta$ text")
        axes.legend()

    with complaints() as texts:
        try:
            for ending in SAVED:
                picture(draw, Look(style=settings), ending)
            reason = ""
        except Exception as error:  # noqa: BLE001 -- it may fail in any way
            reason = " ".join(str(error).split())[:160]
    if reason or texts:
        raise UsageError(
            f"--style {path}: cannot be drawn with:"
            f" {reason or '; '.join(dict.fromkeys(texts))}; correct the style, or install"
            " what it asks for"
        )
    return settings


def single(
    draw: Callable[[Axes, Any], None],
    shown: Any,
    words: Sequence[str],
    height: float,
    width: float = WIDTH,
) -> Draw:
    """A figure of one picture under a heading."""

    def fill(figure: Figure) -> None:
        begin(figure, words, height, width)
        draw(figure.subplots(), shown)

    return fill


def grid(
    figure: Figure,
    draws: Sequence[Callable[[Axes], None]],
    columns: int = 1,
    ratios: Sequence[float] | None = None,
    **shared: Any,
) -> list[Axes]:
    """Panels in rows, the last maybe not full; labels of `shared` axes stand outside."""
    rows = -(-len(draws) // columns)
    cells = figure.subplots(
        rows, columns, squeeze=False, height_ratios=ratios, **shared
    ).ravel()
    blank(cells[len(draws) :])
    for place, (axes, draw) in enumerate(zip(cells, draws, strict=False)):
        draw(axes)
        if shared:
            label = axes.get_xlabel()
            axes.label_outer()
            if place + columns >= len(draws):  # maybe above a place that stays empty
                axes.set_xlabel(label)
                axes.tick_params(labelbottom=True)
    if columns == 1:
        figure.align_ylabels([axes for axes in cells if axes.get_ylabel()])
    return [*cells[: len(draws)]]


def note(axes: Axes, text: str, at: At, offset: At, **look: Any) -> None:
    """A small text, offset [pt] from a place in the axes to the side
    on which it then stands.
    """
    sides: dict[str, Any] = {
        "ha": "left" if offset[0] > 0.0 else "right" if offset[0] else "center",
        "va": "bottom" if offset[1] > 0.0 else "top" if offset[1] else "center",
    }
    of: dict[str, Any] = (
        {"textcoords": "offset points", "fontsize": small()} | sides | look
    )
    axes.annotate(text, at, offset, **of)


def blank(panels: Iterable[Axes]) -> None:
    """Leave places of a grid empty."""
    for axes in panels:
        axes.set_axis_off()


def cross(axes: Axes) -> None:
    """Lines through the origin."""
    axes.axhline(0.0, color=BLACK, lw=0.5)
    axes.axvline(0.0, color=BLACK, lw=0.5)


def root(of: Target) -> Figure:
    """The whole figure."""
    return of.canvas.figure


def given(figure: Target) -> bool:
    """True of somebody's figure, whose size is theirs."""
    return not hasattr(root(figure), "rps_look")


def room(figure: Target, usual: float = WIDTH) -> float:
    """Width of somebody's figure, or that of ours of a usual width [in]."""
    look: Look | None = getattr(root(figure), "rps_look", None)
    return inches(figure)[0] if look is None else look.width(usual)


def tight(figure: Target) -> bool:
    """True of a figure of somebody in which there is no room
    for numbers inside panels.
    """
    return given(figure) and inches(figure)[1] < TIGHT


def narrow(figure: Target) -> bool:
    """True if the figure is narrower than a page."""
    return room(figure) < WIDTH


@contextmanager
def in_style(look: Look = USUAL) -> Iterator[None]:
    """Figures that are made inside look like those that the program writes."""
    quiet_matplotlib()
    import matplotlib.style

    # "default" first: a user's own matplotlibrc must not change what a report looks like.
    with matplotlib.style.context(["default", STYLE, look.settings]):
        yield


def inches(figure: Target) -> tuple[float, float]:
    """Width and height of a figure, or of a part of it [in]."""
    return figure.bbox.width / figure.dpi, figure.bbox.height / figure.dpi


def small() -> float:
    """Size of small letters [pt], inside a figure that is being drawn."""
    import matplotlib as mpl

    return SMALL * float(mpl.rcParams["font.size"])


def begin(
    figure: Figure, words: Sequence[str], height: float, width: float = WIDTH
) -> None:
    """Size of a figure of ours [in]; title and remarks above it, in one
    line or the title above.
    """
    if not given(figure):
        figure.set_size_inches(room(figure, width), height)
    title, *others = [part for part in words if part] or [""]
    across, upwards = inches(figure)
    lines = ["   |   ".join((title, *others))]
    if width_of(lines[0], small()) > across - 0.2:
        lines = folded(title, across - 0.2, small()).split("\n")[:2]
        lines += folded("   |   ".join(others), across - 0.2, small()).split("\n")
    most = max(2, int(0.15 * upwards / LINE)) if given(figure) else len(lines)
    if len(lines) > most:
        lines = [*lines[: most - 1], f"{lines[most - 1][:-3]}..."]
    grow(figure, len(lines) - 2)
    # A dollar sign in a title begins no formula.
    figure.suptitle("\n".join(lines), fontsize=small(), color=GREY, parse_math=False)


def grow(figure: Figure, lines: int) -> None:
    """Make room for further lines of text, up to a page, unless the figure is
    somebody's.
    """
    if not given(figure) and lines > 0:
        width, height = inches(figure)
        figure.set_size_inches(width, min(height + LINE * lines, max(height, PAGE)))


def width_of(text: str, size: float) -> float:
    """Of a text in letters of a size [pt], with formulas [in]."""
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import text_to_path

    def points(line: str) -> float:
        with suppress(ValueError):  # it is no formula
            return float(
                measure(line, font, line.count("$") % 2 == 0 < line.count("$"))[0]
            )
        return float(measure(line, font, ismath=False)[0])

    font = FontProperties(size=size)
    measure = text_to_path.get_text_width_height_descent
    return max(map(points, text.split("\n"))) / 72.0


def folded(text: str, room: float, size: float) -> str:
    """A text in lines that fit into a room [in], broken at commas or
    words, never in formulas.
    """
    lines = []
    for line in text.split("\n"):
        pieces = _PARTS.findall(line)
        if any(width_of(piece.rstrip(), size) > room for piece in pieces):
            pieces = _WORDS.findall(line)
        begun = ""
        for piece in pieces:
            if begun and width_of((begun + piece).rstrip(), size) > room:
                lines.append(begun.rstrip())
                begun = ""
            begun += piece
            while (
                "$" not in begun
                and len(begun) > 1
                and width_of(begun.rstrip(), size) > room
            ):
                fits = max(1, int(len(begun) * room / width_of(begun, size)))
                lines.append(begun[:fits])
                begun = begun[fits:]
        lines.append(begun.rstrip())
    return "\n".join(lines)


_WORDS = re.compile(r"(?:\$[^$]*\$|\[[^\]$]*\]|[^\s$])+\s*|\$|\s+")
_PARTS = re.compile(r"(?:\$[^$]*\$|[^$,]|,(?!\s))+(?:,\s+|$)|\$|,\s+")


def fit(panels: Iterable[Axes]) -> None:
    """Fold titles and labels that are longer than their axes."""
    from matplotlib.text import Text

    for axes in panels:
        if crowded(axes):
            _lessen(axes)
        # Labels are centred on panels, and each of a row gives some width to what is
        # beside it.
        across = _room(axes) * (1.0 - BESIDE / inches(axes.figure)[0])
        # Layouts of others make room for legends above, by less height.
        share = (0.6 if tight(axes.figure) else 0.75) if given(axes.figure) else 1.3
        upwards = share * axes.get_window_extent().height / axes.figure.dpi
        if crowded(axes):
            upwards = max(upwards, LABEL_SHARE * _place_of(axes)[1])
        # Beside its texts the children of axes are three titles.
        inside = (each for each in axes.get_children() if each not in axes.texts)
        for text in (
            *(each for each in inside if isinstance(each, Text)),
            axes.xaxis.label,
        ):
            text.set_text(folded(text.get_text(), across, float(text.get_fontsize())))
        for each in (axes, *axes.child_axes):
            if "\n" in (label := each.yaxis.label).get_text():
                continue  # by hand
            label.set_text(folded(label.get_text(), upwards, float(label.get_fontsize())))


def _lessen(axes: Axes) -> None:
    """Smaller letters and fewer ticks."""
    from matplotlib.ticker import MaxNLocator

    size = LESS * small()
    for text in axes.texts:
        text.set_fontsize(min(LESS * size, float(text.get_fontsize())))
    for each in (axes, *axes.child_axes):
        for text in (each.xaxis.label, each.yaxis.label, each.title):
            text.set_fontsize(min(size, float(text.get_fontsize())))
        each.tick_params(labelsize=size, pad=2.0)
        for axis in (each.xaxis, each.yaxis):
            axis.labelpad = 1.0
            if isinstance(locator := axis.get_major_locator(), MaxNLocator):
                locator.set_params(nbins=FEW_TICKS)


def percent(share: float) -> str:
    """A share in per cent."""
    return f"{100.0 * share:.3g} %"


def typeset(text: str) -> str:
    """A text of tables as figures show it."""
    return text.replace("m/s2", "m/s²")


def entries(panels: Iterable[Axes]) -> dict[str, Any]:
    """Entries of the legends of several axes by name, each once."""
    found: dict[str, Any] = {}
    for axes in panels:
        for handle, name in zip(*axes.get_legend_handles_labels(), strict=True):
            found.setdefault(name, handle)
    return found


def legend_above(axes: Axes) -> None:
    """A legend on top of the axes, where it covers nothing;
    folded where they are narrow.
    """
    room = _room(axes)
    if not (found := entries([axes])):
        return
    most = None
    size = small()
    if crowded(axes):
        size *= LESS
        most = max(2, int(LEGEND_SHARE * _place_of(axes)[1] / (LINE * LESS)))
    place = axes.get_subplotspec()
    engine = root(axes.figure).get_layout_engine()
    if engine is None and place is not None and place.rowspan.start:
        axes.legend(fontsize=small(), loc="best")  # nothing makes room below other axes
        return
    axes.legend(
        **_arranged(found, room - 0.5, most, size),
        loc="lower right" if room < WIDTH else "lower left",
        bbox_to_anchor=(0.0, 1.0, 1.0, 0.1),
        borderaxespad=0.1,
    )


def _room(axes: Axes) -> float:
    """Width of the place of axes, with what is beside them [in]."""
    return _place_of(axes)[0]


def _place_of(axes: Axes) -> tuple[float, float]:
    """Width and height of the place of axes, with what is around them [in]."""
    if (place := axes.get_subplotspec()) is None:
        extent = axes.get_window_extent()
        return extent.width / axes.figure.dpi, extent.height / axes.figure.dpi
    of = place.get_gridspec()
    widths: Any = of.get_width_ratios()
    heights: Any = of.get_height_ratios()
    sides = (widths, place.colspan), (heights, place.rowspan)
    across, upwards = (
        sum([*ratios][span.start : span.stop]) / sum(ratios) for ratios, span in sides
    )
    width, height = inches(axes.figure)
    return float(across * width), float(upwards * height)


def crowded(axes: Axes) -> bool:
    """True of somebody's axes that are so small that letters of usual size would leave no
    room for what they show.
    """
    return given(axes.figure) and min(_place_of(axes)) < CROWDED


def legend_below(figure: Figure, panels: Iterable[Axes]) -> None:
    """One legend for several axes, below them; the first entries where not all have room,
    in somebody's figure a seventh of it.
    """
    if found := entries(panels):
        width, height = inches(figure)
        room = (
            0.15 * height if given(figure) else 0.5 * PAGE
        )  # what is left is the figure's
        arranged = _arranged(found, width - 0.1, max(1, int(room / LINE)))
        rows = -(-len(arranged["labels"]) // arranged["ncols"])
        grow(figure, rows * max(1 + name.count("\n") for name in arranged["labels"]) - 1)
        figure.legend(**arranged, loc="outside lower center")


def _arranged(
    found: dict[str, Any], room: float, most: int | None, size: float = 0.0
) -> dict[str, Any]:
    """Handles, names and columns of a legend in a room [in], whose
    last entry says what is cut.
    """
    from matplotlib.lines import Line2D

    size = size or small()
    beside = 4.0 * size / 72.0  # handle and gaps
    found = {folded(typeset(name), room - beside, size): of for name, of in found.items()}
    widths = [beside + width_of(name, size) for name in found]
    columns = next(
        (
            n
            for n in range(len(found), 1, -1)
            if sum(max(widths[c::n]) for c in range(n)) <= room
        ),
        1,
    )
    rows = -(-len(found) // columns)
    columns = -(-len(found) // rows)  # so that rows are even
    if most is not None and rows * max(1 + name.count("\n") for name in found) > most:
        most = max(1, most // max(1 + name.count("\n") for name in found))
        kept = most * columns - 1
        names = dict.fromkeys([f"and {len(found) - kept} more"], Line2D([], [], ls=""))
        found = dict(list(found.items())[:kept]) | names
    # A legend fills column by column, and is read row by row.
    order = [name for column in range(columns) for name in [*found][column::columns]]
    return {
        "handles": [found[name] for name in order], "labels": order, "ncols": columns,
        "columnspacing": 1.4, "handlelength": 1.8, "fontsize": size,
    }  # fmt: skip


def engineering(largest: float) -> tuple[float, str]:
    """Factor and prefix that bring a value between 1 and 1000."""
    for factor, prefix in ((1e-6, "M"), (1e-3, "k")):
        if largest * factor >= 1.0:
            return factor, prefix
    return 1.0, ""


def require(what: str, value: object, known: Iterable[object]) -> None:
    """Refuse what is not there: an index from the end would draw
    another panel than is wanted.
    """
    there = list(known)
    if value not in there:
        names = ", ".join(map(str, there[:3])) + (
            f" to {there[-1]}" if len(there) > 3 else ""
        )
        raise UsageError(
            f"{str(value)[:60]!r} is none of the {what}; there are"
            f" {names or 'none to be drawn'}"
        )
