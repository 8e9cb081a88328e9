"""What the schema says of each key, in words: the reference of the format."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Literal, NamedTuple, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from rpscli.case.schema.fields import PLAIN, Quantity, Whole
from rpscli.case.schema.known_keys import known_paths, marks_of, section_at, section_of

SECTIONS = {
    "superstructure": "7",
    "superstructure.damping": "6, 7",
    "podium": "2",
    "podium.bearing": "1, 5",
    "podium.bearing.inertia_ratio": "2",
    "podium.impact": "4",
    "podium.friction": "8",
    "podium.devices": "11",
    "record": "2",
    "record.vertical": "2, 8",
    "analysis": "10",
    "analysis.recontact_tolerance": "3, 10",
    "analysis.recontact_rule": "3, 4",
    "analysis.initial_rotation": "3",
    "analysis.overturning_limit": "3",
    "analysis.gravity": "2",
    "limits": "8",
}
"""Sections of THEORY.md in which keys enter; a key without a line has those of its parent."""


class KeyReference(NamedTuple):
    """One key.

    Parameters
    ----------
    key
        Dotted.
    meaning
        In words.
    symbol
        Letter or formula, where there is one.
    unit
        SI unit of a bare number; empty for words and sections.
    bounds
        What a number must keep.
    words
        Words that may stand there.
    default
        What holds if the key is left out; None if nothing does.
    required
        Whether its section must have it.
    keys
        What a section holds.
    sections
        Of THEORY.md.
    """

    key: str
    meaning: str
    symbol: str
    unit: str
    bounds: str
    words: tuple[str, ...]
    default: Any
    required: bool
    keys: tuple[str, ...]
    sections: str


def key_references(model: type[BaseModel]) -> Iterator[KeyReference]:
    """Every key of a format, parents before their children."""
    for path in known_paths(model):
        parent = section_at(model, path[:-1])
        assert parent is not None, "a known key has a section"
        yield _reference(".".join(map(str, path)), parent.model_fields[str(path[-1])])


def _reference(key: str, field: FieldInfo) -> KeyReference:
    marks = marks_of(field)
    quantity = next((mark for mark in marks if isinstance(mark, Quantity)), None)
    whole = next((mark for mark in marks if isinstance(mark, Whole)), None)
    section = section_of(field.annotation)
    single = quantity is not None and not (section and "at_most" not in section.model_fields)
    default = field.get_default()
    return KeyReference(
        key=key,
        meaning=field.description or "",
        symbol=quantity.symbol if quantity and single else "",
        unit=quantity.unit.replace(PLAIN, "-") if quantity and single else "",
        bounds=(quantity.rule if quantity and single else "") or (whole.rule if whole else ""),
        words=tuple(dict.fromkeys([*(quantity.words if quantity else ()), *_words(field)])),
        default=default if isinstance(default, str | int | float) else None,
        required=field.is_required(),
        keys=tuple(section.model_fields) if section else (),
        sections=_sections(key),
    )


def _sections(key: str) -> str:
    parts = key.split(".")
    parents = (".".join(parts[:length]) for length in range(len(parts), 0, -1))
    return next((SECTIONS[parent] for parent in parents if parent in SECTIONS), "")


def _words(field: FieldInfo) -> Iterator[str]:
    """Words of the literals of a field."""

    def below(annotation: Any) -> Iterator[str]:
        if get_origin(annotation) is Literal:
            yield from (word for word in get_args(annotation) if isinstance(word, str))
            return
        for part in get_args(annotation):
            yield from below(part)

    yield from below(field.annotation)
