"""Colours and line widths of a user's style file, brought into a figure that is drawn."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import cycle
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PARTS = ("color", "facecolor", "edgecolor", "markerfacecolor", "markeredgecolor")


def restyle(
    figure: Figure, palette: Sequence[str], width: float, settings: Mapping[str, Any]
) -> None:
    """Put the colours of the file in the place of the palette's, one by one, and so again."""
    # Lines keep their widths relative to each other; `width` is what the file's own stands for.
    from matplotlib.colors import to_rgba, to_rgba_array

    wider = float(settings.get("lines.linewidth", width)) / width
    given = settings["axes.prop_cycle"].by_key() if "axes.prop_cycle" in settings else {}
    theirs = [to_rgba(colour) for colour in given.get("color", ())]
    swap = dict(zip((to_rgba(colour)[:3] for colour in palette), cycle(theirs), strict=False))
    if not swap and wider == 1.0:
        return
    for artist in _artists(figure):
        for part in PARTS if swap else ():
            if not hasattr(artist, f"set_{part}") or not hasattr(artist, f"get_{part}"):
                continue
            rows = to_rgba_array(getattr(artist, f"get_{part}")())
            new = [(*swap.get(tuple(row[:3]), tuple(row))[:3], row[3]) for row in rows.tolist()]
            if new != [tuple(row) for row in rows.tolist()]:
                getattr(artist, f"set_{part}")(new if len(new) > 1 else new[0])
        if hasattr(artist, "set_linewidth"):
            artist.set_linewidth(_times(wider, artist.get_linewidth()))


def _artists(figure: Figure) -> Iterator[Any]:
    """What shows data, and its legends."""
    from matplotlib.axes import Axes
    from matplotlib.legend import Legend

    for axes in figure.findobj(Axes):
        assert isinstance(axes, Axes)
        yield from (*axes.lines, *axes.patches, *axes.collections, *axes.texts)
    for legend in figure.findobj(Legend):
        assert isinstance(legend, Legend)
        yield from legend.legend_handles


def _times(factor: float, widths: Any) -> Any:
    """One width or several, times a factor."""
    return factor * widths if isinstance(widths, float | int) else [factor * w for w in widths]
