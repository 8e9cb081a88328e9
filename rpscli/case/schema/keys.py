"""The keys of a format: units, meaning and bounds, and what an unknown one was meant to be."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache, lru_cache
from typing import Any, Literal, NamedTuple, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from rpscli.case.schema.case_file import CaseFile
from rpscli.case.schema.fields import PLAIN, NameOf, OneOf, Quantity, Several, ValueRange, Whole
from rpscli.case.schema.own import OwnLaws
from rpscli.case.text.document import Fault, Path, dotted, path_of
from rpscli.errors import listed, nearest


def fields_of(section: type[BaseModel]) -> dict[str, FieldInfo]:
    """Fields of a section by the names of their keys."""
    return {field.alias or name: field for name, field in section.model_fields.items()}


def inside(annotation: Any) -> Iterator[Any]:
    """An annotation or a field, and all types and marks that it is made of."""
    yield annotation
    field = isinstance(annotation, FieldInfo)
    parts = (annotation.annotation, *annotation.metadata) if field else get_args(annotation)
    for part in parts:
        yield from inside(part)


def _is_section(annotation: Any) -> bool:
    return isinstance(annotation, type) and issubclass(annotation, BaseModel)


def sections_of(annotation: Any) -> Iterator[type[BaseModel]]:
    """The models inside an annotation (``Model | None``) or a field."""
    for part in inside(annotation):
        if _is_section(part):
            yield part
        elif isinstance(part, Several) and part.spaced:
            yield ValueRange
        elif isinstance(part, OwnLaws):
            yield from part.loaded.values()


def section_of(annotation: Any) -> type[BaseModel] | None:
    """The first model inside an annotation or a field, if it holds one."""
    return next(sections_of(annotation), None)


def _chosen_by_user(annotation: Any) -> Any:
    """Annotation of values at keys that the user chooses, if it holds such a mapping."""
    for part in inside(annotation):
        if get_origin(part) is dict:
            return get_args(part)[1]
        if _is_section(part) and part.model_config.get("extra") == "allow":
            return ValueRange  # further options, which may be equally spaced numbers
    return None


def annotation_at(model: type[BaseModel], path: Path) -> Any:
    """Annotation of the value at a path, or None; an index stands for any element."""
    below: Any = model
    for part in path:
        if not isinstance(part, int):
            below = _chosen_by_user(below) or _keys_in(below).get(part)
    return below


def _keys_in(annotation: Any) -> dict[str, Any]:
    """The keys of a mapping, of any of its forms; names of sections stand for these."""
    fields: dict[str, Any] = {}
    for section in sections_of(annotation):
        fields = fields_of(section) | fields
    kinds = (part.sections for part in inside(annotation) if isinstance(part, OneOf))
    return {**fields, **next(kinds, {})}


def section_at(model: type[BaseModel], path: Path) -> type[BaseModel] | None:
    """The model of the mapping at a path, or None if there is no mapping in the format."""
    return section_of(annotation_at(model, path))


def field_at(model: type[BaseModel], path: Path) -> FieldInfo | None:
    """Field of the key at a path, or None if the format does not know the key."""
    return _keys_in(annotation_at(model, path[:-1])).get(str(path[-1])) if path else None


@cache
def known_paths(model: type[BaseModel]) -> tuple[Path, ...]:
    """Every key of the format, parents before their children."""

    def below(section: type[BaseModel], path: Path) -> Iterator[Path]:
        for name, field in fields_of(section).items():
            yield (*path, name)
            inner = section_of(field.annotation)
            if inner:
                yield from below(inner, (*path, name))

    return tuple(below(model, ()))


def suggestion_for(model: type[BaseModel], path: Path) -> Path | None:
    """The known key that was probably meant: the same word, a sibling, a similar one."""
    *parent, key = path
    siblings = {name: (*parent, name) for name in _keys_in(annotation_at(model, tuple(parent)))}
    anywhere = {str(p[-1]): p for p in reversed(known_paths(model))}
    if str(key) in anywhere:
        return anywhere[str(key)]
    for names in (siblings, anywhere):
        suggestion = nearest(str(key), names)
        if suggestion:
            return names[suggestion]
    return None


REMOVED = {
    "analysis.recontact_rule": "floors always get what the bounces left out would give them"
    " (was: limit); remove the key",
    "analysis.overturning_rotation": "use overturning_displacement, where the cap beam is at this"
    " rotation, or from theta_cr on overturning_limit, the rotation over theta_cr",
    "reports.comparison.fit": "the report counts outcomes of every system; choose one by them, and"
    " judge it by a study of other records; remove the key",
}
"""Keys of earlier versions, and what to do without them."""


ELEMENT = re.compile(r"\[(\d+)\]")
"""How some write an element of a list, which is ``.0`` here."""


def unknown_key(model: type[BaseModel], path: Path) -> tuple[Fault, Path | None]:
    """The fault of an unknown key, and the known key it was taken for."""
    named = dotted(tuple(part for part in path if isinstance(part, str)))
    if ELEMENT.search(named):
        plain = ELEMENT.sub(r".\1", dotted(path))
        elements = "elements of lists are counted from 0"
        text = f"{dotted(path)} is not a key of the format; did you mean {plain}? {elements}"
        return Fault(path, text, at_key=True), path_of(plain)
    if now := REMOVED.get(named):
        return Fault(path, f"{dotted(path)} is gone: {now}", at_key=True), None
    suggestion = suggestion_for(model, path)
    suggestion = None if suggestion == path else suggestion  # a key of another law
    siblings = fields_of(section_at(model, path[:-1]) or model)
    longer = [name for name in siblings if f"_{path[-1]}_" in f"_{name}_"]
    if suggestion is None and longer:
        suggestion = (*path[:-1], longer[0])
    text = f"{dotted(path)} is not a key of the format"
    if suggestion is None:
        section = section_at(model, path[:-1])
        fields = [*fields_of(section)] if section else []
        if (parent := dotted(path[:-1])) and len(fields) > 12:
            fields[12:] = [f"{len(fields) - 12} more (rps explain {parent})"]
        names = listed(fields, "and") if fields else ""
        return Fault(path, f"{text}; known here: {names}", at_key=True), None
    if suggestion[-1] == path[-1]:
        parent = dotted(suggestion[:-1])
        hint = f"{path[-1]} belongs under {parent}" if parent else "it belongs at the top level"
    else:
        hint = f"did you mean {dotted(suggestion)}?"
    return Fault(path, f"{text}; {hint}", at_key=True), suggestion


@lru_cache(maxsize=1024)
def unit(key: str) -> str:
    """SI unit of a case key; ``-`` for plain numbers and words."""
    si_unit = next((mark.unit for mark in _marks_of(key) if isinstance(mark, Quantity)), "1")
    return "-" if si_unit == "1" else si_unit


def is_whole(key: str) -> bool:
    """Whether a case key holds whole numbers."""
    return any(isinstance(mark, Whole) for mark in _marks_of(key))


def _marks_of(key: str) -> list[object]:
    path = path_of(ELEMENT.sub(r".\1", key))
    field = field_at(CaseFile, tuple(part for part in path if isinstance(part, str)))
    return list(inside(field))


SECTIONS = {
    "superstructure": "7", "superstructure.damping": "6, 7", "superstructure.vertical_period": "14",
    "superstructure.yield": "15", "superstructure.y": "13", "podium": "2", "podium.bearing": "1, 5",
    "podium.bearing.inertia_ratio": "2", "podium.bearing.inertia_ratio_axial": "13",
    "podium.impact": "4", "podium.impact.contact_time": "13", "podium.friction": "8",
    "podium.contact": "12", "podium.devices": "11", "podium.plan": "8", "podium.column": "16",
    "record": "2",
    "record.vertical": "2, 8", "record.x": "13", "record.y": "13", "record.rotation": "13",
    "analysis": "10", "analysis.recontact_tolerance": "3, 10", "analysis.initial_rotation": "3",
    "analysis.overturning_limit": "3", "analysis.gravity": "2", "limits": "8, 15, 16",
}  # fmt: skip
"""Sections of THEORY.md in which keys enter; a key without a line has those of its parent."""


class KeyReference(NamedTuple):
    """One key."""

    key: str
    meaning: str
    symbol: str
    unit: str
    bounds: str
    words: tuple[str, ...]
    default: Any
    required: bool
    keys: tuple[tuple[str, str], ...]
    sections: str


def key_references(model: type[BaseModel]) -> Iterator[KeyReference]:
    """Every key of a format, parents before their children."""
    for path in known_paths(model):
        parent = section_at(model, path[:-1])
        assert parent is not None, "a known key has a section"
        yield _reference(".".join(map(str, path)), fields_of(parent)[str(path[-1])])


def _reference(key: str, field: FieldInfo) -> KeyReference:
    parents = [key.rsplit(".", depth)[0] for depth in range(key.count(".") + 1)]
    marks = list(inside(field))
    quantity = next((mark for mark in marks if isinstance(mark, Quantity)), None)
    whole = next((mark for mark in marks if isinstance(mark, Whole)), None)
    literals = (get_args(part) for part in marks if get_origin(part) is Literal)
    listed_names = (mark.names for mark in marks if isinstance(mark, NameOf))
    words = (word for each in (*literals, *listed_names) for word in each if isinstance(word, str))
    section = section_of(field.annotation)
    single = quantity is not None and not (section and "at_most" not in section.model_fields)
    keys = {} if section is None else fields_of(section)
    default = field.get_default()
    return KeyReference(
        key=key,
        meaning=field.description or "",
        symbol=quantity.symbol if quantity and single else "",
        unit=quantity.unit.replace(PLAIN, "-") if quantity and single else "",
        bounds=(quantity.rule if quantity and single else "") or (whole.rule if whole else ""),
        words=tuple(dict.fromkeys([*(quantity.words if quantity else ()), *words])),
        default=default if isinstance(default, str | int | float) else None,
        required=field.is_required(),
        keys=tuple((name, each.description or "") for name, each in keys.items()),
        sections=next((SECTIONS[parent] for parent in parents if parent in SECTIONS), ""),
    )
