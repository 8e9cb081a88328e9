"""Figures inside a page: drawn by the page itself, or as an image where that takes less room."""

from __future__ import annotations

import base64
import io
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from xml.etree import ElementTree as ET
from xml.etree.ElementTree import Element

from rpscli.report.figures.look import Look
from rpscli.report.html.elements import element, printable, written

FORMATS = ("svg", "png")
"""What a page asks for: the second where the first takes too much room."""

COLOURS = 256
"""Of an image: ours, and those of their edges."""

_NUMBER = re.compile(r"-?\d+\.\d{3,}")
_REFERENCE = re.compile(r"#([\w.-]+)")


@dataclass(frozen=True)
class Picture:
    """A figure of a page: the files that there are of it by their ending, and what it shows."""

    files: dict[str, bytes]
    caption: str


def page_look(look: Look) -> Look:
    """The user's look, in the formats of a page."""
    return Look(FORMATS, look.columns, look.style)


def pictures(files: Iterable[tuple[str, object]]) -> Iterator[tuple[str, dict[str, bytes]]]:
    """Figures among the files of an analysis: name without ending, and file by ending."""
    found: dict[str, dict[str, bytes]] = {}
    for name, content in files:
        stem, _, ending = name.rpartition(".")
        if ending in FORMATS and isinstance(content, bytes):
            found.setdefault(stem, {})[ending] = content
    yield from found.items()


def figures(shown: Sequence[Picture], room: int) -> list[Element]:
    """Pictures above their captions, numbered from 1.

    Parameters
    ----------
    shown
        In order.
    room
        Letters for all together: the largest drawings become images, if these are smaller, until
        there is room.
    """
    # Each drawing has names inside: a prefix keeps them apart from those of the others.
    drawn = [_drawing(each.files["svg"], f"f{n}-", each.caption) for n, each in enumerate(shown, 1)]
    sizes = [len(written(each)) for each in drawn]
    for place in sorted(range(len(shown)), key=lambda place: -sizes[place]):
        if sum(sizes) <= room:
            break
        image = base64.b64encode(_few_colours(shown[place].files["png"])).decode()
        if len(image) < sizes[place]:
            source, caption = f"data:image/png;base64,{image}", shown[place].caption
            drawn[place] = element("img", src=source, alt=caption)
            sizes[place] = len(image)
    pairs = zip(drawn, shown, strict=True)
    return [_figure(each, of.caption, number) for number, (each, of) in enumerate(pairs, 1)]


def _few_colours(image: bytes) -> bytes:
    """The image with a palette, which takes a third of the room; our figures have few colours."""
    from PIL import Image

    small = io.BytesIO()
    with Image.open(io.BytesIO(image)) as full:
        # By coverage of colours, not of pixels: a thin red line must stay red.
        palette = full.convert("RGB").quantize(COLOURS, Image.Quantize.MAXCOVERAGE)
        palette.save(small, "png", optimize=True)
    return small.getvalue()


def _figure(drawn: Element, caption: str, number: int) -> Element:
    below = element("figcaption", element("b", f"Figure {number}. "), caption)
    return element("figure", element("div", drawn, class_="wide"), below)


def _drawing(data: bytes, prefix: str, label: str) -> Element:
    """A drawing that can stand in HTML beside others."""
    # Our own drawing, not something from elsewhere.
    root = ET.fromstring(printable(data.decode()))  # noqa: S314
    for parent in list(root.iter()):
        for child in list(parent):
            if _local(child.tag) in {"metadata", "style"}:
                parent.remove(child)
        parent.tag = _local(parent.tag)
        parent.attrib = {
            _local(name): _renamed(_local(name), value, prefix)
            for name, value in parent.attrib.items()
        }
    for size in ("width", "height"):
        root.attrib.pop(size, None)
    root.attrib |= {"role": "img", "aria-label": label}
    return root


def _local(name: str) -> str:
    return name.rpartition("}")[2]


def _renamed(name: str, value: str, prefix: str) -> str:
    """An attribute with the names of its own drawing, and points to a hundredth."""
    if name in {"d", "x", "y"}:
        return _NUMBER.sub(lambda number: f"{float(number[0]):.2f}", value)
    if name == "id":
        return prefix + value
    if name == "href" or "url(#" in value:
        return _REFERENCE.sub(lambda found: f"#{prefix}{found[1]}", value)
    return value
