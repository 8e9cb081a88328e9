"""A page of HTML: sections, figures drawn by the page itself or as images; no scripts."""

from __future__ import annotations

import base64
import io
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from html import escape
from importlib import resources
from unicodedata import category

from rpscli.report.figures.look import Look
from rpscli.report.files import Drawing, undrawn
from rpscli.report.russian import NOTE, in_russian
from rpscli.report.table import Table


class Markup(str):
    """Text that is HTML already."""

    __slots__ = ()


Content = str | None | Iterable["Content"]
VOID = frozenset(("img", "meta"))


def element(tag: str, *content: Content, **attributes: str) -> Markup:
    """An element with text and others in it; ``class_`` is the attribute `class`."""
    pairs = (f' {name.rstrip("_")}="{escape(text)}"' for name, text in attributes.items())
    begin = f"<{tag}{''.join(pairs)}>"
    return Markup(
        begin if tag in VOID else f"{begin}{''.join(map(_inside, content))}</{tag}>"
    )


def _inside(part: Content) -> str:
    if part is None or isinstance(part, Markup):
        return part or ""
    if isinstance(part, str):
        return escape(printable(part), quote=False)
    return "".join(map(_inside, part))


def printable(text: str) -> str:
    """Text without the control characters that no page may hold;
    spaces of any width stay.
    """
    return "".join(
        sign
        if sign.isprintable() or sign in "\n\t" or category(sign) == "Zs"
        else "\ufffd"
        for sign in text
    )


FORMATS = (
    "svg",
    "png",
)  # of the figures of a page: the second where the first takes too much room

COLOURS = 256  # of an image: ours, and those of their edges


@dataclass(frozen=True)
class Picture:
    """A figure of a page: its files by their ending, which are drawn
    with it, and what it shows.
    """

    files: dict[str, Drawing]
    caption: str


def page_look(look: Look) -> Look:
    """The user's look, in the formats of a page."""
    return Look(FORMATS, look.columns, look.style)


def pictures(files: Iterable[tuple[str, object]]) -> dict[str, dict[str, Drawing]]:
    """Figures among the files of an analysis: by name without ending, and by ending."""
    found: dict[str, dict[str, Drawing]] = {}
    for name, content in files:
        if isinstance(content, Drawing):
            found.setdefault(name.rpartition(".")[0], {})[content.ending] = content
    return found


def figures(shown: Sequence[Picture], room: int, word: str = "Figure") -> list[Markup]:
    """Pictures above captions; the largest drawings become images until
    there is room [letters].
    """
    drawn = [_drawing(each, f"f{number}-") for number, each in enumerate(shown, 1)]
    for place in sorted(range(len(shown)), key=lambda place: -len(drawn[place])):
        if sum(map(len, drawn)) <= room or not (png := shown[place].files["png"]()):
            break
        image = base64.b64encode(_few_colours(png)).decode()
        if len(image) < len(drawn[place]):
            source = f"data:image/png;base64,{image}"
            drawn[place] = element("img", src=source, alt=shown[place].caption)
    return [
        element(
            "figure",
            element("div", each, class_="wide"),
            element("figcaption", element("b", f"{word} {number}. "), of.caption),
        )
        for number, (each, of) in enumerate(zip(drawn, shown, strict=True), 1)
    ]


def _few_colours(image: bytes) -> bytes:
    """The image with a palette, which takes a third of the room; our
    figures have few colours.
    """
    from PIL import Image

    small = io.BytesIO()
    with Image.open(io.BytesIO(image)) as full:
        # By coverage of colours, not of pixels: a thin red line must stay red.
        palette = full.convert("RGB").quantize(COLOURS, Image.Quantize.MAXCOVERAGE)
        palette.save(small, "png", optimize=True)
    return small.getvalue()


def _drawing(of: Picture, prefix: str) -> Markup:
    """One of our own drawings, so that it can stand in HTML beside others."""
    text = printable(of.files["svg"]().decode())
    if not text:
        return element("p", *undrawn(of.files.values()), class_="notice")
    text = _UNWANTED.sub("", text[text.index("<svg") :])
    root, rest = text.split(">", 1)
    root = re.sub(r' (width|height|xmlns(:\w+)?)="[^"]*"', "", root)
    text = f'{root} role="img" aria-label="{escape(of.caption)}">{rest}'
    # Names inside are kept apart from those of other drawings, points are told to a
    # hundredth.
    text = _NAMES.sub(rf"\g<0>{prefix}", text.replace("xlink:href", "href"))
    return Markup(
        _POINTS.sub(
            lambda at: _NUMBER.sub(lambda number: f"{float(number[0]):.2f}", at[0]), text
        )
    )


_UNWANTED = re.compile(r"<!--.*?-->|<(metadata|style)\b.*?</\1>", re.DOTALL)
_NAMES = re.compile(r'(?<= id=")|(?<= href="#)|(?<=url\(#)')
_POINTS = re.compile(r'(?<= )(d|x|y)="[^"]*"')
_NUMBER = re.compile(r"-?\d+\.\d{3,}")


MOST_BYTES = 1_000_000  # of a page that can be sent by mail and read on a telephone
FOR_FIGURES = 840_000  # letters for all figures of a page together


class Listing(str):
    """Text that is typed as it stands."""

    __slots__ = ()


class Notice(str):
    """A warning to be read before the numbers are used."""

    __slots__ = ()


@dataclass(frozen=True)
class Attachment:
    """A text file that readers save or copy from the page."""

    name: str
    text: str


Block = str | Table | Picture | Listing | Notice | Attachment


@dataclass(frozen=True)
class ReportSection:
    """A heading and what stands under it."""

    title: str
    blocks: Sequence[Block]


Tell = Callable[[str], str]
LANGUAGES: dict[str, Tell] = {"en": str, "ru": in_russian}
"""What is told of a text, by the language of a page."""


def _told(section: ReportSection, tell: Tell) -> ReportSection:
    """A section in the words of a language; commands, files and numbers as they are."""
    return ReportSection(
        tell(section.title), [_block_told(b, tell) for b in section.blocks]
    )


def _block_told(block: Block, tell: Tell) -> Block:
    match block:
        case Table():
            words = block.words
            rows = [(*map(tell, row[:words]), *row[words:]) for row in block.rows]
            heads = [*map(tell, block.heads)]
            return Table.of_texts(heads, rows, words=words, keys=block.keys)
        case Picture():
            return replace(block, caption=tell(block.caption))
        case Notice():
            return Notice(tell(block))
        case Listing() | Attachment():
            return block
    return tell(block)


def page(
    title: str,
    subtitle: str,
    sections: Sequence[ReportSection],
    name: str,
    signed: Mapping[str, str | None] | None = None,
    language: str = "en",
) -> bytes:
    """The file of a page: sections that hold something; by `name` a
    later page knows its own.
    """
    tell = LANGUAGES[language]
    kept = [section for section in sections if section.blocks]
    if language != "en":
        kept = [_told(section, tell) for section in kept]
    shown = [block for s in kept for block in s.blocks if isinstance(block, Picture)]
    drawn = iter(figures(shown, FOR_FIGURES, tell("Figure")))
    links = []
    written = []
    for place, section in enumerate(kept, 1):
        links.append(element("li", element("a", section.title, href=f"#s{place}")))
        blocks = [_block(block, drawn) for block in section.blocks]
        head = element("h2", f"{place}  {section.title}")
        written.append(element("section", head, blocks, id=f"s{place}"))
    header = element(
        "header",
        element("h1", title),
        element("p", subtitle),
        element("p", NOTE) if language == "ru" else None,
        _signatures(signed or {}, tell),
    )
    contents = element("nav", element("ol", links))
    body = element("body", header, contents, element("main", written))
    root = element("html", _head(title, name), body, lang=language)
    return f"<!DOCTYPE html>\n{root}\n".encode("utf-8", "backslashreplace")


def _head(title: str, name: str) -> Markup:
    """The head of a page: its mark, its title, its style sheet, and what it may load."""
    sheet = resources.files(__package__).joinpath("page.css").read_text(encoding="utf-8")
    # Nothing is fetched and nothing runs, whatever a title may say.
    policy = "default-src 'none'; style-src 'unsafe-inline'; img-src data:"
    return element(
        "head",
        element("meta", charset="utf-8"),
        _mark(name),
        element("meta", name="viewport", content="width=device-width, initial-scale=1"),
        element("meta", **{"http-equiv": "Content-Security-Policy", "content": policy}),
        element("title", title),
        element("style", Markup(sheet)),
    )


def _signatures(signed: Mapping[str, str | None], tell: Tell) -> Markup | None:
    """Who made and who checked the page, with room for dates and
    signatures; else on paper only.
    """
    rows = []
    for name, text in signed.items():
        wide = {"colspan": "2"} if name == "project" else {}
        cells = [element("td", text or "", **wide)]
        cells += [] if wide else [element("td", tell("date, signature:"))]
        rows.append(element("tr", element("th", tell(name)), cells))
    of = "signed" if any(signed.values()) else "signed paper"
    return element("table", rows, class_=of) if rows else None


def is_about(content: bytes, name: str) -> bool:
    """True if a file is a page about the case or the study of this name."""
    return _mark(name).encode("utf-8", "backslashreplace") in content[:2000]


def _mark(name: str) -> Markup:
    return element("meta", name="generator", content=f"rps report of {name}")


def _block(block: Block, drawn: Iterator[Markup]) -> Markup:
    match block:
        case Table():
            return _table(block)
        case Picture():
            return next(drawn)
        case Listing():
            return element("pre", block)
        case Attachment():
            return _attachment(block)
        case Notice():
            return element("p", block, class_="notice")
        case str():
            return element("p", block)


def _attachment(file: Attachment) -> Markup:
    """A link that saves the file, which is in the page, and its text to copy."""
    content = base64.b64encode(file.text.encode("utf-8", "replace")).decode()
    link = element(
        "a",
        f"save {file.name}",
        href=f"data:text/plain;charset=utf-8;base64,{content}",
        download=file.name,
    )
    shown = element("pre", file.text, class_="copied")
    summary = element("summary", f"text of {file.name}, to copy")
    return element(
        "div", element("p", link), element("details", summary, shown), class_="attachment"
    )


def _table(table: Table) -> Markup:
    def row(tag: str, texts: Sequence[str]) -> Markup:
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
    """The class of a cell of words: long ones need room, very
    long words break anywhere.
    """
    if any(len(word) > LONGEST_WORD for word in text.split()):
        return "long"
    return "sentence" if len(text) > LONG_TEXT and " " in text else "word"


LONGEST_WORD = 36  # letters
LONG_TEXT = 24
