"""The page: a title, sections of text, tables and figures, and a style sheet; no scripts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib import resources
from xml.etree.ElementTree import Element

from rpscli.report.html.elements import element, written
from rpscli.report.html.pictures import Picture, figures
from rpscli.report.table import Table

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


def page(title: str, subtitle: str, sections: Sequence[Section], name: str) -> bytes:
    """The file of a page.

    Parameters
    ----------
    title, subtitle
        What the page is about; what it is and when and by what it was made.
    sections
        In order; those without anything in them are left out.
    name
        Of the case or the study, by which a later page knows its own; see `is_about`.
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
        element("header", element("h1", title), element("p", subtitle)),
        element("nav", element("ol", links)),
        element("main", [_section(s, place, drawn) for place, s in enumerate(kept, 1)]),
    )
    root = element("html", _head(title, name), body, lang="en")
    return ("<!DOCTYPE html>\n" + written(root) + "\n").encode()


def is_about(content: bytes, name: str) -> bool:
    """Whether a file is a page about the case or the study of this name."""
    return written(_mark(name)).encode() in content[:MARK_WITHIN]


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
