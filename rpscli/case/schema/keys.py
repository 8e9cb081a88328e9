"""The keys of a format: units, meaning and bounds, and what an unknown one was meant to be."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache, lru_cache
from typing import Any, Literal, NamedTuple, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from rpscli.case.schema.case_file import CaseFile
from rpscli.case.schema.fields import PLAIN, Quantity, Whole
from rpscli.case.text.document import Fault, Path, dotted
from rpscli.errors import listed, nearest


def section_of(annotation: Any) -> type[BaseModel] | None:
    """The model inside a field's annotation (``Model | None``), if it holds one."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    found = (section_of(part) for part in get_args(annotation))
    return next((model for model in found if model), None)


def section_at(model: type[BaseModel], path: Path) -> type[BaseModel] | None:
    """The model of the mapping at a path, or None if there is no mapping in the format.

    An index stands for any element of its list.
    """
    for part in path:
        if isinstance(part, int):
            continue
        field = model.model_fields.get(str(part))
        inner = section_of(field.annotation) if field else None
        if inner is None:
            return None
        model = inner
    return model


def marks_of(field: FieldInfo) -> list[object]:
    """What a field's annotation says besides its type, in any branch of a union."""

    def inside(annotation: Any) -> Iterator[object]:
        yield from getattr(annotation, "__metadata__", ())
        for part in get_args(annotation):
            yield from inside(part)

    return [*field.metadata, *inside(field.annotation)]


def field_at(model: type[BaseModel], path: Path) -> FieldInfo | None:
    """What the format says of the key at a path, or None if it does not know the key."""
    parent = section_at(model, path[:-1])
    return parent.model_fields.get(str(path[-1])) if parent and path else None


@cache
def known_paths(model: type[BaseModel]) -> tuple[Path, ...]:
    """Every key of the format, parents before their children."""

    def below(section: type[BaseModel], path: Path) -> Iterator[Path]:
        for name, field in section.model_fields.items():
            yield (*path, name)
            inner = section_of(field.annotation)
            if inner:
                yield from below(inner, (*path, name))

    return tuple(below(model, ()))


def meant(model: type[BaseModel], path: Path) -> Path | None:
    """The known key that an unknown one was probably meant to be.

    The same word under another parent comes first, then a similar word under the same parent,
    then a similar word anywhere.
    """
    *parent, key = path
    known = known_paths(model)
    named = tuple(part for part in parent if not isinstance(part, int))
    siblings = {str(p[-1]): (*parent, p[-1]) for p in known if p[:-1] == named}
    anywhere = {str(p[-1]): p for p in reversed(known)}
    if str(key) in anywhere:
        return anywhere[str(key)]
    for names in (siblings, anywhere):
        guess = nearest(str(key), names)
        if guess:
            return names[guess]
    return None


def unknown_key(model: type[BaseModel], path: Path) -> tuple[Fault, Path | None]:
    """The fault of an unknown key, and the known key it was taken for."""
    guess = meant(model, path)
    text = f"{dotted(path)} is not a key of the format"
    if guess is None:
        section = section_at(model, path[:-1])
        names = listed(section.model_fields, "and") if section else ""
        return Fault(path, f"{text}; known here: {names}", at_key=True), None
    if guess[-1] == path[-1]:
        parent = dotted(guess[:-1])
        hint = f"{path[-1]} belongs under {parent}" if parent else "it belongs at the top level"
    else:
        hint = f"did you mean {dotted(guess)}?"
    return Fault(path, f"{text}; {hint}", at_key=True), guess


@lru_cache(maxsize=1024)
def unit(key: str) -> str:
    """SI unit of a case key; ``-`` for plain numbers and words.

    >>> unit("superstructure.period"), unit("podium.bearing.slenderness")
    ('s', '-')
    """
    found = next((mark.unit for mark in _marks_of(key) if isinstance(mark, Quantity)), "1")
    return "-" if found == "1" else found


def is_whole(key: str) -> bool:
    """Whether a case key holds whole numbers.

    >>> is_whole("podium.columns"), is_whole("superstructure.period")
    (True, False)
    """
    return any(isinstance(mark, Whole) for mark in _marks_of(key))


def _marks_of(key: str) -> list[object]:
    path = tuple(part for part in key.split(".") if not part.isdecimal())
    field = field_at(CaseFile, path)
    return marks_of(field) if field else []


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
