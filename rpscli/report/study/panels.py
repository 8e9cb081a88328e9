"""Figures of studies: panels side by side, one for each group of systems."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from textwrap import fill
from typing import TYPE_CHECKING, Any, Literal

from rpscli.report.figures import style
from rpscli.report.study.labels import labels
from rpscli.sweep.statistics.grouping import Grouping

if TYPE_CHECKING:
    from matplotlib.axis import Axis

Place = Literal["lower center", "outside lower center"]

MOST_PANELS = 36
"""More would be illegible; the CSV has them all."""

COLOURS = (
    style.BLUE, style.RED, style.GREEN, style.ORANGE, style.PINK, style.SKY,
    style.BLACK, style.GREY,
)  # fmt: skip
MARKERS = "osD^vP*X"
MOST_TICKS = 5
"""On each axis of a panel: ticks take most of the time of drawing."""
LETTERS_AN_INCH = 16.0
"""Of the legend's font."""
LINE = 0.17
"""Height of a line of text [in]."""


def colour(place: int, count: int = 0) -> str:
    """A colour for each of so many series: distinct ones, or shades of a scale beyond eight."""
    if count <= len(COLOURS):
        return COLOURS[place % len(COLOURS)]
    from matplotlib import colormaps, colors, rcParams

    return colors.to_hex(colormaps[rcParams["image.cmap"]](place / (count - 1)))


def marker(place: int) -> str:
    """A marker for each series."""
    return MARKERS[place % len(MARKERS)]


def in_panels(
    keys: Sequence[str],
    panels: Sequence[Any],
    draw: Callable[[style.Axes, Any], None],
    **words: Any,
) -> Callable[[str], bytes]:
    """Panels that have `values` of keys; the last key's stand side by side if they fill a table."""
    across = len(dict.fromkeys(str(panel.values[-1]) for panel in panels)) if keys else 1
    fills = 1 < across <= 5 and len(panels) % across == 0
    names = [labels(keys, panel.values) for panel in panels]
    return panel_figure(names, panels, draw, in_row=across if fills else 4, **words)


def panel_figure(
    names: Sequence[str],
    panels: Sequence[Any],
    draw: Callable[[style.Axes, Any], None],
    *,
    in_row: int,
    x_label: str,
    y_label: str,
    share: Literal["both", "x"] = "both",
    limits: Callable[[style.Axes], object] | None = None,
    note: str = "",
) -> Callable[[str], bytes]:
    """A figure that waits for its title: panels with titles, so many of them side by side."""
    shown = panels[:MOST_PANELS]
    if len(panels) > len(shown):
        note = f"{note}; " * bool(note) + f"the first {len(shown)} of {len(panels)} panels"

    def picture(title: str) -> bytes:
        width = style.room(style.WIDTH)
        widest = columns = max(1, min(in_row, len(panels)))
        if width < style.WIDTH:
            columns = min(1 if len(shown) == 3 else 2, widest)  # three leave a hole
        wrapped = _wrapped(names, columns, min(width, style.WIDTH))
        rows = max(1, math.ceil(len(shown) / columns))

        def draw_all(figure: style.Figure) -> None:
            style.heading(figure, title, note)
            grid = figure.subplots(
                rows, columns, squeeze=False, sharex=True, sharey=share == "both"
            )
            for axes, panel, name in zip(grid.flat, shown, wrapped, strict=False):
                axes.locator_params(nbins=MOST_TICKS)
                draw(axes, panel)
                # Without a height matplotlib would look for ticks under the title, at great length.
                axes.set_title(style.typeset(name), y=1.0)
            _label_outside(grid, len(shown), x_label, y_label)
            if limits is not None:
                limits(grid.flat[0])
            # Somebody's figure that lays itself out does so with what is drawn into it.
            if figure.get_layout_engine() is not None:
                _legend_lines(figure, grid, "outside lower center")
            else:
                lines = _legend_lines(figure, grid, "lower center")
                _arrange(figure, grid, lines, share_y=share == "both")

        each = 2.6 if columns < 3 and width >= style.WIDTH else 2.1
        height = 3.8 if rows == 1 and columns == 1 else 1.0 + each * rows
        wide = style.WIDTH if widest > 1 else 0.72 * style.WIDTH
        return style.picture(draw_all, height, wide, None)

    return picture


def _label_outside(grid: Any, panels: int, x_label: str, y_label: str) -> None:
    """Label axes that have no panel below them or to their left; places without a panel go."""
    columns = grid.shape[1]
    for place, axes in enumerate(grid.flat):
        if place >= panels:
            axes.set_axis_off()
            continue
        if place + columns >= panels:
            letters = LETTERS_AN_INCH * (style.inches(axes.figure)[0] - 0.7) / columns
            axes.set_xlabel(fill(style.typeset(x_label), int(letters)))
            axes.tick_params(labelbottom=True)
        if place % columns == 0:
            axes.set_ylabel(style.typeset(y_label))


def _legend_lines(figure: style.Figure, grid: Any, place: Place) -> int:
    """One legend for all panels, below them; returns its number of lines."""
    found = style.entries(grid.flat)
    if not found:
        return 0
    widest = max(len(name) for name in found)
    room = style.inches(figure)[0] * LETTERS_AN_INCH
    most = max(1, min(len(found), 5, int(room / (widest + 7))))
    columns = math.ceil(len(found) / math.ceil(len(found) / most))  # so that rows are even
    names = [style.typeset(name) for name in found]
    handles = [*found.values()]
    if columns > 2:  # two columns are read downwards
        handles, names = style.in_rows(handles, columns), style.in_rows(names, columns)
    figure.legend(handles, names, loc=place, ncols=columns)
    return math.ceil(len(found) / columns)


def _arrange(figure: style.Figure, grid: Any, legend_lines: int, *, share_y: bool) -> None:
    """Place the axes by hand: the automatic layout would take longer than the drawing."""
    from matplotlib.ticker import FixedLocator

    rows, columns = grid.shape
    titles = [axes.get_title() for axes in grid.flat]
    title_lines = max(title.count("\n") for title in titles) + any(titles)
    further_lines = figure.get_suptitle().count("\n")
    label_lines = max(axes.get_xlabel().count("\n") for axes in grid.flat)
    width, height = style.inches(figure)
    if style.given() is None:  # else it is somebody's figure, or a part of one
        height += LINE * (max(legend_lines - 1, 0) + further_lines + label_lines)
        figure.set_size_inches(width, height)
    # Words in the place of numbers take more room.
    named = (a for a in grid[:, 0] if isinstance(a.yaxis.get_major_locator(), FixedLocator))
    words = [label.get_text() for axes in named for label in axes.get_yticklabels()]
    left, right = max(0.62, *(0.2 + len(word) / 14.0 for word in words), 0.0), 0.14
    bottom = 0.52 + LINE * (legend_lines + label_lines) + (0.06 if legend_lines else 0.0)
    top = 0.32 + LINE * (title_lines + further_lines)
    # Where axes are shared, room for half of the last number of one and of the first of the next.
    across = 0.32 if share_y else 0.36
    down = 0.14 + LINE * title_lines
    figure.suptitle(
        figure.get_suptitle(), y=1.0 - 0.08 / height, fontsize=style.small(), color=style.GREY
    )
    figure.subplots_adjust(
        left=left / width,
        right=1.0 - right / width,
        bottom=bottom / height,
        top=1.0 - top / height,
        # Gaps are wanted in parts of the mean size of the axes.
        wspace=across / ((width - left - right - across * (columns - 1)) / columns),
        hspace=down / ((height - bottom - top - down * (rows - 1)) / rows),
    )


def _wrapped(names: Sequence[str], columns: int, width: float) -> list[str]:
    """Titles on two lines where panels are narrow: the last key below the others."""
    widest = max((len(name) for name in names), default=0)
    if widest * columns <= width * LETTERS_AN_INCH * 0.7:
        return list(names)
    return ["\n".join(name.rsplit(", ", 1)) for name in names]


def break_if_narrow() -> str:
    """The sign between parts of a text inside a panel: a new line in narrow figures."""
    return "\n" if style.narrow() else " "


def log_ticks(axis: Axis) -> None:
    """Ticks at 1, 2 and 5 times the powers of ten, as plain numbers."""
    from matplotlib.ticker import LogLocator

    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.set_major_formatter("{x:g}")
    axis.set_minor_formatter("")


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
