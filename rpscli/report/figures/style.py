"""One look for all figures; matplotlib is imported when the first of them is drawn."""

from __future__ import annotations

import io
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Literal

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

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
"""Of the heading's font."""

WIDTH = 7.0
"""Width of a figure [in]: a page with its margins."""

STYLE: dict[str, Any] = {
    "font.family": "sans-serif",
    "font.size": 9.0,
    "axes.titlesize": 9.0,
    "axes.labelsize": 9.0,
    "legend.fontsize": 8.0,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
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
}


def png(
    draw: Callable[[Figure], None],
    height: float,
    width: float = WIDTH,
    layout: Literal["constrained"] | None = "constrained",
) -> bytes:
    """The PNG file of a figure.

    Parameters
    ----------
    draw
        Fills the figure, which is empty and lays itself out.
    height, width
        Size [in].
    layout
        None for a figure that places its axes itself, which draws four times as fast.
    """
    import matplotlib.style  # noqa: PLC0415
    from matplotlib.figure import Figure  # noqa: PLC0415

    # "default" first: a user's own matplotlibrc must not change what a report looks like.
    with matplotlib.style.context(["default", STYLE]):
        figure = Figure(figsize=(width, height), dpi=DPI, layout=layout)
        draw(figure)
        if (engine := figure.get_layout_engine()) is not None:
            # Once, and no more: matplotlib would do it in a trial drawing, and again in the real
            # one, which takes twice as long.
            engine.execute(figure)
            figure.set_layout_engine(None)
        buffer = io.BytesIO()
        figure.savefig(
            buffer,
            format="png",
            metadata={"Software": None},  # the same data give the same file
            pil_kwargs={"compress_level": COMPRESSION},
        )
    return buffer.getvalue()


def heading(figure: Figure, *parts: str) -> None:
    """A line above the figure that says what it belongs to, cut to its width."""
    text = "   |   ".join(part for part in parts if part)
    most = int(LETTERS_PER_INCH * figure.get_figwidth())
    if len(text) > most:
        text = f"{text[: most - 3]}..."
    # A dollar sign in a title begins no formula.
    figure.suptitle(text, fontsize=8.0, color=GREY, parse_math=False)


def legend_above(axes: Axes, columns: int) -> None:
    """A legend on top of the axes, where it covers nothing."""
    axes.legend(
        loc="lower left",
        bbox_to_anchor=(0.0, 1.0, 1.0, 0.1),
        ncols=columns,
        borderaxespad=0.1,
        columnspacing=1.4,
        handlelength=1.8,
    )


def over(unit: float) -> tuple[Callable[[Any], Any], Callable[[Any], Any]]:
    """Functions of a secondary axis that shows values as multiples of `unit`."""
    return (lambda value: value / unit), (lambda ratio: ratio * unit)


def engineering(largest: float) -> tuple[float, str]:
    """Factor and prefix that bring a value between 1 and 1000.

    >>> engineering(3.2e6), engineering(15.0), engineering(4e4)
    ((1e-06, 'M'), (1.0, ''), (0.001, 'k'))
    """
    for factor, prefix in ((1e-6, "M"), (1e-3, "k")):
        if largest * factor >= 1.0:
            return factor, prefix
    return 1.0, ""
