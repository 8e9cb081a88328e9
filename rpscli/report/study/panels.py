"""Figures of studies: panels side by side, one for each group of systems."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, TypeVar

from rpscli.analyses.result_quantities import ResultQuantity
from rpscli.report.figures import style
from rpscli.report.figures.look import FONT_SIZE, SMALL
from rpscli.report.table import large
from rpscli.sweep.names import labels
from rpscli.sweep.statistics.grouping import Grouping

if TYPE_CHECKING:
    from matplotlib.axis import Axis
    from numpy.typing import NDArray

Panel = TypeVar("Panel")

MOST_PANELS = 36  # more would be illegible; the CSV has them all

COLOURS = (
    style.BLUE, style.RED, style.GREEN, style.ORANGE, style.PINK, style.SKY,
    style.BLACK, style.GREY,
)  # fmt: skip
MARKERS = "osD^vP*X"
MOST_TICKS = 5  # on each axis of a panel: ticks take most of the time of drawing
AROUND = 1.0  # of a figure of ours, heading and labels around its panels [in]
NO_PANEL = 1.3
LEAST_HEIGHT = 0.5
"""Of a given figure what is no panel, and of each panel without its title [in]."""


def colour(place: int, count: int = 0) -> str:
    """A colour for each of so many series: distinct ones, or shades
    of a scale beyond eight.
    """
    if count <= len(COLOURS):
        return COLOURS[place % len(COLOURS)]
    from matplotlib import colormaps, colors, rcParams

    return colors.to_hex(colormaps[rcParams["image.cmap"]](place / (count - 1)))


def shaded(count: int) -> str:
    """A remark on more series than there are colours."""
    return f"{count} series, more than colours: shades of a scale" * (
        count > len(COLOURS)
    )


def look(place: int, count: int) -> dict[str, Any]:
    """Colour and marker of each of so many series."""
    return {"color": colour(place, count), "marker": MARKERS[place % len(MARKERS)]}


def corner(
    axes: style.Axes, x: str, y: str, text: str, size: float = 0.9, **look: Any
) -> None:
    """A text inside a panel, at its left or right and at its bottom or top."""
    place = {"left": 0.04, "right": 0.96, "bottom": 0.05, "top": 0.95}
    sides: dict[str, Any] = {"ha": x, "va": y, "transform": axes.transAxes}
    axes.text(place[x], place[y], text, fontsize=size * style.small(), **sides, **look)


def in_panels(
    keys: Sequence[str],
    panels: Sequence[Any],
    draw: Callable[[style.Axes, Any], None],
    **words: Any,
) -> Callable[[str], style.Draw]:
    """Panels that have `values` of keys; the last key's stand side by
    side if they fill a table.
    """
    names = [labels(keys, panel.values) for panel in panels]
    row = in_row([panel.values for panel in panels])
    return PanelFigure(names, panels, draw, in_row=row, **words)


def in_row(values: Sequence[Sequence[object]]) -> int:
    """So many panels side by side that the last key's values fill a table, else four."""
    every = dict.fromkeys(map(repr, values))
    across = len(dict.fromkeys(repr(each[-1:]) for each in values))
    return across if 1 < across <= 5 and len(every) % across == 0 else 4


def nothing(axes: style.Axes, text: str) -> None:
    """A panel in its place with nothing to draw but a remark."""
    look: dict[str, Any] = {"ha": "center", "va": "center", "color": style.GREY}
    axes.text(0.5, 0.5, text, transform=axes.transAxes, fontsize=style.small(), **look)


@dataclass(frozen=True, eq=False)
class PanelFigure:
    """A figure that waits for its title: panels with titles, so
    many of them side by side.
    """

    names: Sequence[str]
    panels: Sequence[Any]
    draw: Callable[[style.Axes, Any], None]
    in_row: int
    x_label: str | Scale
    y_label: str | Scale
    share: Literal["both", "x"] = "both"
    limits: Callable[[style.Axes], object] | None = None
    note: str = ""
    part: str = ""  # of several sheets
    columns: int = 0  # panels side by side, as in the other sheets

    def __call__(self, title: str) -> style.Draw:
        """The figure under a title."""
        return partial(self._fill, title)

    def sheets(self, room: float) -> Sequence[PanelFigure]:
        """The figure in parts of at most a page, where figures are so wide [in]."""
        columns = self._columns(room)
        shown = min(len(self.panels), MOST_PANELS)
        parts = in_sheets(shown, columns, _each(columns, room), AROUND)
        if len(parts) == 1:
            return [self]
        left = remarks(first_of(shown, len(self.panels), "panels"), self.note)
        return [
            replace(
                self,
                names=self.names[part],
                panels=self.panels[part],
                note=left,
                part=f"sheet {number} of {len(parts)}",
                columns=columns,
            )
            for number, part in enumerate(parts, start=1)
        ]

    def _fill(self, title: str, figure: style.Figure) -> None:
        columns = self._columns(style.room(figure))
        room = (style.room(figure) - style.BESIDE) / columns
        titles = [
            style.folded(style.typeset(name), room, SMALL * FONT_SIZE)
            for name in self.names
        ]
        lines = 1 + max((text.count("\n") for text in titles), default=0)
        shown, cut = first(figure, self.panels, columns, MOST_PANELS, lines)
        rows = max(1, math.ceil(len(shown) / columns))
        # A heading may be cut at its end: what is left out comes first.
        words = (title, remarks(self.part, cut, self.note))
        style.begin(figure, words, *self._size(figure, rows, columns))
        grid = figure.subplots(
            rows, columns, squeeze=False, sharex=True, sharey=self.share == "both"
        )
        for axes, panel, name in zip(grid.flat, shown, titles, strict=False):
            axes.locator_params(
                nbins=max(2, 5 - rows) if style.tight(figure) else MOST_TICKS
            )
            self._ticks(axes)
            self.draw(axes, panel)
            # Without a height matplotlib would look for ticks under the title, at great
            # length.
            axes.set_title(name, y=1.0, fontsize=style.small())
        self._label(figure, grid, len(shown))
        if self.limits is not None:
            self.limits(grid.flat[0])
        style.legend_below(figure, grid.flat)

    @property
    def _widest(self) -> int:
        """Panels side by side where there is room."""
        return max(1, min(self.in_row, len(self.panels)))

    def _columns(self, room: float) -> int:
        """Panels side by side in a figure so wide; three would leave a hole beside two."""
        if self.columns:
            return self.columns
        if room >= style.WIDTH:
            return self._widest
        return min(1 if len(self.panels) == 3 else 2, self._widest)

    def _size(self, figure: style.Figure, rows: int, columns: int) -> tuple[float, float]:
        """Height and width of a figure of ours [in]."""
        height = AROUND + _each(columns, style.room(figure)) * rows
        if rows == 1 and columns == 1:
            height = 3.8
        several = max(self._widest, self.columns) > 1
        return height, style.WIDTH if several else 0.72 * style.WIDTH

    def _ticks(self, axes: style.Axes) -> None:
        """Numbers at the axes in the units of their labels."""
        for axis, of in ((axes.xaxis, self.x_label), (axes.yaxis, self.y_label)):
            if isinstance(of, Scale):
                of.ticks(axis)

    def _label(self, figure: style.Figure, grid: NDArray[Any], shown: int) -> None:
        """Name the axes outside of the panels, and leave out places without a panel."""
        from matplotlib import rcParams

        x, y = (
            style.typeset(of.label if isinstance(of, Scale) else of)
            for of in (self.x_label, self.y_label)
        )
        rows, columns = grid.shape
        for place, axes in enumerate(grid.flat):
            if place >= shown:
                axes.set_axis_off()
            elif place + columns >= shown:
                axes.set_xlabel(x)
                axes.tick_params(labelbottom=True)
        if rows == 1:
            grid[0, 0].set_ylabel(y)
            return
        letters = rcParams["font.size"]
        room = 0.7 * style.inches(figure)[1]
        folded = style.folded(y, room, letters)
        figure.supylabel(folded, fontsize=letters, multialignment="center")


def _each(columns: int, room: float) -> float:
    """Height of a panel of ours, with its title [in]."""
    return 2.6 if columns < 3 and room >= style.WIDTH else 2.1


def in_sheets(count: int, columns: int, height: float, around: float) -> list[slice]:
    """So many panels, or rows, in parts that are not higher than a page; all parts are
    about as long. A row is so high, and around all there is more [in].
    """
    rows = math.ceil(count / columns)
    sheets = math.ceil(rows / max(1, int((style.PAGE - around) / height)))
    each = math.ceil(rows / max(1, sheets)) * columns
    return [slice(n, min(n + each, count)) for n in range(0, count, max(each, 1))]


def first_of(shown: int, count: int, what: str) -> str:
    """A remark where not all are shown."""
    return f"the first {shown} of {count} {what}" * (shown < count)


def first(
    figure: style.Figure,
    panels: Sequence[Panel],
    columns: int,
    most: int,
    title_lines: int,
) -> tuple[Sequence[Panel], str]:
    """The panels that have room, so many in a row, and a remark on the others."""
    if style.given(figure):
        each = LEAST_HEIGHT + style.LINE * title_lines
        most = columns * max(1, int((style.inches(figure)[1] - NO_PANEL) / each))
    shown = panels[:most]
    return shown, first_of(most, len(panels), "panels")


def break_if_narrow(axes: style.Axes) -> str:
    """The sign between parts of a text inside a panel: a new line in narrow figures."""
    return "\n" if style.narrow(axes.figure) else " "


def log_ticks(axis: Axis) -> None:
    """Ticks at 1, 2 and 5, or 1 and 3, times the powers of ten, as plain numbers."""
    from matplotlib.ticker import LogLocator

    few = axis.axes.get_window_extent().width < 2.0 * axis.axes.figure.dpi
    axis.set_major_locator(LogLocator(subs=(1.0, 3.0) if few else (1.0, 2.0, 5.0)))
    axis.set_major_formatter("{x:g}")
    axis.set_minor_formatter("")


class Scale(NamedTuple):
    """An axis of values in SI: a label, and ticks in the unit of the label."""

    label: str
    factor: float = 1.0  # from SI to the numbers at the ticks

    def ticks(self, axis: Axis) -> None:
        """Numbers in the unit of the label; words at ticks are set after it."""
        if self.factor != 1.0:
            axis.set_major_formatter(lambda value, _: f"{self.factor * value:g}")

    def followed_by(self, *words: str) -> Scale:
        """With further words in the label."""
        return self._replace(label=", ".join(filter(None, (self.label, *words))))


def scale_of(words: str, unit: str) -> Scale:
    """The axis of values in an SI unit, label and ticks in that in which
    people read them; without a unit the label is the words.

    >>> scale_of("force", "N"), scale_of("share", "")
    (Scale(label='force [kN]', factor=0.001), Scale(label='share', factor=1.0))
    """
    factor, name = large(1.0, unit)
    read = (name or unit).replace("/s2", "/s²")
    return Scale(f"{words} [{read}]" if unit else words, factor or 1.0)


def scale_of_result(quantity: ResultQuantity) -> Scale:
    """The axis of a result."""
    return scale_of(quantity.symbol or quantity.label, quantity.unit)


def over(pooled: Sequence[str]) -> str:
    """A remark on what differs within a panel."""
    return f"over {' and '.join(pooled)}" if pooled else ""


def remarks(*parts: str) -> str:
    """All of them that say something, in one line."""
    return "; ".join(filter(None, parts))


def noted(found: Grouping, *parts: str, failed: int | None = None) -> str:
    """These remarks, between what a panel is over and what is left out of it."""
    count = found.failed if failed is None else failed
    return remarks(over(found.pooled), *parts, left_out(count))


def left_out(failed: int) -> str:
    """A remark on points that failed."""
    return f"{failed} failed points left out" if failed else ""
