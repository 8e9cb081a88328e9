"""A page: HTML as a tree, figures drawn by the page itself or as images, sections; no scripts."""

from __future__ import annotations

import base64
import io
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib import resources
from unicodedata import category
from xml.etree import ElementTree as ET
from xml.etree.ElementTree import Element, tostring

from rpscli.report.figures.look import Look
from rpscli.report.table import Table

Content = str | Element | None | Iterable["Content"]


def element(tag: str, *content: Content, **attributes: str) -> Element:
    """An element with text and others in it; ``class_`` is the attribute `class`."""
    made = Element(tag, {name.rstrip("_"): text for name, text in attributes.items()})
    for part in content:
        _append(made, part)
    return made


def written(root: Element) -> str:
    """The element as HTML."""
    return tostring(root, encoding="unicode", method="html")


def _append(parent: Element, part: Content) -> None:
    if isinstance(part, str):
        last = parent[-1] if len(parent) else None
        if last is None:
            parent.text = (parent.text or "") + printable(part)
        else:
            last.tail = (last.tail or "") + printable(part)
    elif isinstance(part, Element):
        parent.append(part)
    elif part is not None:
        for each in part:
            _append(parent, each)


def printable(text: str) -> str:
    """Text without the control characters that no page may hold; spaces of any width stay."""

    def known(sign: str) -> bool:
        return sign.isprintable() or sign in "\n\t" or category(sign) == "Zs"

    return "".join(sign if known(sign) else "\ufffd" for sign in text)


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
    """Pictures above captions; the largest drawings become images until there is room [letters]."""
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


MOST_BYTES = 1_000_000
"""Of a page that can be sent by mail and read on a telephone."""
FOR_FIGURES = 840_000
"""Letters for all figures of a page together."""


@dataclass(frozen=True)
class Code:
    """What is typed as it stands."""

    text: str


@dataclass(frozen=True)
class Notice:
    """What must be read before the numbers are used."""

    text: str


Block = str | Table | Picture | Code | Notice


@dataclass(frozen=True)
class Section:
    """A heading and what stands under it."""

    title: str
    blocks: Sequence[Block]


def page(
    title: str,
    subtitle: str,
    sections: Sequence[Section],
    name: str,
    signed: Mapping[str, str | None] | None = None,
) -> bytes:
    """The file of a page: sections that hold something; by `name` a later page knows its own.

    `signed` says who answers for it; what is not known is left to be filled in on paper.
    """
    kept = [section for section in sections if section.blocks]
    shown = [block for s in kept for block in s.blocks if isinstance(block, Picture)]
    drawn = iter(figures(shown, FOR_FIGURES))
    links = [
        element("li", element("a", section.title, href=f"#s{place}"))
        for place, section in enumerate(kept, 1)
    ]
    body = element(
        "body",
        element("header", element("h1", title), element("p", subtitle), _signatures(signed or {})),
        element("nav", element("ol", links)),
        element("main", [_section(s, place, drawn) for place, s in enumerate(kept, 1)]),
    )
    root = element("html", _head(title, name), body, lang="en")
    return ("<!DOCTYPE html>\n" + written(root) + "\n").encode("utf-8", "backslashreplace")


def _signatures(signed: Mapping[str, str | None]) -> Element | None:
    """Who made and who checked the page, with room for dates and signatures; else on paper only."""
    if not signed:
        return None

    def cells(name: str, text: str) -> list[Element]:
        if name == "project":
            return [element("td", text, colspan="2")]
        return [element("td", text), element("td", "date, signature:")]

    rows = [
        element("tr", element("th", name), cells(name, text or "")) for name, text in signed.items()
    ]
    return element("table", rows, class_="signed" if any(signed.values()) else "signed paper")


def is_about(content: bytes, name: str) -> bool:
    """Whether a file is a page about the case or the study of this name."""
    return written(_mark(name)).encode("utf-8", "backslashreplace") in content[:MARK_WITHIN]


MARK_WITHIN = 2000


def _mark(name: str) -> Element:
    return element("meta", name="generator", content=f"rps report of {name}")


def _head(title: str, name: str) -> Element:
    sheet = resources.files(__package__).joinpath("page.css").read_text(encoding="utf-8")
    return element(
        "head",
        element("meta", charset="utf-8"),
        _mark(name),
        element("meta", name="viewport", content="width=device-width, initial-scale=1"),
        # Nothing is fetched and nothing runs, whatever a title may say.
        element(
            "meta",
            **{
                "http-equiv": "Content-Security-Policy",
                "content": "default-src 'none'; style-src 'unsafe-inline'; img-src data:",
            },
        ),
        element("title", title),
        element("style", sheet),
    )


def _section(section: Section, place: int, drawn: Iterator[Element]) -> Element:
    blocks = [_block(block, drawn) for block in section.blocks]
    return element("section", element("h2", f"{place}  {section.title}"), blocks, id=f"s{place}")


def _block(block: Block, drawn: Iterator[Element]) -> Element:
    match block:
        case Table():
            return _table(block)
        case Picture():
            return next(drawn)
        case Code():
            return element("pre", block.text)
        case Notice():
            return element("p", block.text, class_="notice")
        case str():
            return element("p", block)


def _table(table: Table) -> Element:
    def row(tag: str, texts: Sequence[str]) -> Element:
        cells = [
            element(tag, text, class_=_kind(text) if place < table.words else "number")
            for place, text in enumerate(texts)
        ]
        return element("tr", cells)

    heads = table.heads
    head = element("thead", row("th", heads)) if any(heads) else None
    body = element("tbody", [row("td", texts) for texts in table.rows])
    return element("div", element("table", head, body), class_="wide")


def _kind(text: str) -> str:
    """How a cell of words may be broken: long ones need room, very long words break anywhere."""
    if any(len(word) > LONGEST_WORD for word in text.split()):
        return "long"
    return "sentence" if len(text) > LONG_TEXT and " " in text else "word"


LONGEST_WORD, LONG_TEXT = 36, 24
"""Letters."""
