"""HTML as a tree. What comes from a user is text in it, which is escaped when it is written."""

from __future__ import annotations

from collections.abc import Iterable
from xml.etree.ElementTree import Element, tostring

Content = str | Element | None | Iterable["Content"]


def element(tag: str, *content: Content, **attributes: str) -> Element:
    """An element with text and others in it; ``class_`` is the attribute `class`.

    >>> written(element("p", "a < b, ", element("b", "or not"), " & so on", class_="x"))
    '<p class="x">a &lt; b, <b>or not</b> &amp; so on</p>'
    """
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
    """Text without the control characters that no page may hold."""
    return "".join(sign if sign.isprintable() or sign in "\n\t" else "\ufffd" for sign in text)
