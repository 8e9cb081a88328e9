"""The keys of a format: units, meaning and bounds, and what an
unknown one was meant to be.

They are told one by one, for readers, and as JSON schemas, for
editors and other programs.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache, lru_cache
from typing import Any, Literal, NamedTuple, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo
from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue
from pydantic_core import core_schema

from rpscli.case.schema.case_file import CaseFile
from rpscli.case.schema.fields import (
    PLAIN,
    NameOf,
    OneOf,
    OwnLaws,
    Quantity,
    Several,
    ValueRange,
    Whole,
)
from rpscli.case.text.document import Fault, Path, dotted, path_of
from rpscli.errors import alike, foreign_letters, listed, nearest


def fields_of(section: type[BaseModel]) -> dict[str, FieldInfo]:
    """Fields of a section by the names of their keys."""
    return {field.alias or name: field for name, field in section.model_fields.items()}


def inside(annotation: Any) -> Iterator[Any]:
    """An annotation or a field, and all types and marks that it is made of."""
    yield annotation
    field = isinstance(annotation, FieldInfo)
    parts = (
        (annotation.annotation, *annotation.metadata) if field else get_args(annotation)
    )
    for part in parts:
        yield from inside(part)


def _is_section(annotation: Any) -> bool:
    return isinstance(annotation, type) and issubclass(annotation, BaseModel)


def _sections_of(annotation: Any) -> Iterator[type[BaseModel]]:
    for part in inside(annotation):
        if _is_section(part):
            yield part
        elif isinstance(part, Several) and part.spaced:
            yield ValueRange
        elif isinstance(part, OwnLaws):
            yield from part.loaded.values()


def section_of(annotation: Any) -> type[BaseModel] | None:
    """The first model inside an annotation or a field, if it holds one."""
    return next(_sections_of(annotation), None)


def _keys_in(annotation: Any) -> dict[str, Any]:
    """The keys of a mapping, of any of its forms; names of sections stand for these."""
    fields: dict[str, Any] = {}
    for section in _sections_of(annotation):
        fields = fields_of(section) | fields
    kinds = (part.sections for part in inside(annotation) if isinstance(part, OneOf))
    return {**fields, **next(kinds, {})}


def annotation_at(model: type[BaseModel], path: Path) -> Any:
    """Annotation of the value at a path, or None; an index stands for any element."""
    below: Any = model
    for key in (part for part in path if isinstance(part, str)):
        # Keys that the user chooses, or further options, which may be equally spaced
        # numbers.
        chosen = (
            get_args(part)[1] if get_origin(part) is dict else ValueRange
            for part in inside(below)
            if get_origin(part) is dict
            or (_is_section(part) and part.model_config.get("extra") == "allow")
        )
        below = next(chosen, None) or _keys_in(below).get(key)
    return below


def section_at(model: type[BaseModel], path: Path) -> type[BaseModel] | None:
    """The model of the mapping at a path, or None if there is
    no mapping in the format.
    """
    return section_of(annotation_at(model, path))


def field_at(model: type[BaseModel], path: Path) -> FieldInfo | None:
    """Field of the key at a path, or None if the format does not know the key."""
    return _keys_in(annotation_at(model, path[:-1])).get(str(path[-1])) if path else None


@cache
def known_paths(model: type[BaseModel], path: Path = ()) -> tuple[Path, ...]:
    """Every key of the format, parents before their children."""
    known: list[Path] = []
    for name, field in fields_of(model).items():
        inner = section_of(field.annotation)
        known += [(*path, name), *(known_paths(inner, (*path, name)) if inner else ())]
    return tuple(known)


REMOVED = {
    "analysis.recontact_rule": (
        "floors always get what the bounces left out would give them (was: limit);"
        " remove the key"
    ),
    "analysis.overturning_rotation": (
        "use overturning_displacement, where the cap beam is at this rotation, or from"
        " theta_cr on overturning_limit, the rotation over theta_cr"
    ),
    "reports.comparison.fit": (
        "the report counts outcomes of every system; choose one by them, and judge it"
        " by a study of other records; remove the key"
    ),
}
"""Keys of earlier versions, and what to do without them."""


ELEMENT = re.compile(r"\[(\d+)\]")
"""How some write an element of a list, which is ``.0`` here."""


def unknown_key(
    model: type[BaseModel], path: Path, *, suggest: bool = True
) -> tuple[Fault, Path | None]:
    """The fault of an unknown key, and the known key it was taken
    for, if one is looked for.
    """
    *above, key = path
    parent = tuple(above)
    text = f"{dotted(path)} is not a key of the format"
    named = dotted(tuple(part for part in path if isinstance(part, str)))
    meant: Path | None = None
    if not suggest:
        remedy = ""
    elif ELEMENT.search(named):
        plain = ELEMENT.sub(r".\1", dotted(path))
        meant = path_of(plain)
        remedy = f"; did you mean {plain}? elements of lists are counted from 0"
    elif now := REMOVED.get(named):
        text = f"{dotted(path)} is gone"
        remedy = f": {now}"
    elif (meant := _meant(model, parent, str(key))) is None:
        section = section_at(model, parent)
        fields = [*fields_of(section)] if section else []
        remedy = f"; known here: {listed(fields, 'and') if fields else ''}"
        if parent and len(fields) > 12:
            near = ", ".join(alike(str(key), fields, 3))
            remedy = f"; near are {near}; `rps explain {dotted(parent)}` lists all"
    elif meant[-1] != key:
        remedy = f"; did you mean {dotted(meant)}?{foreign_letters(str(key))}"
    else:
        belongs = f"{key} belongs under {dotted(meant[:-1])}" if meant[:-1] else ""
        remedy = f"; {belongs or 'it belongs at the top level'}"
    return Fault(path, f"{text}{remedy}", at_key=True), meant


def _meant(model: type[BaseModel], parent: Path, key: str) -> Path | None:
    """The known key that was probably meant: the same word, a sibling,
    a similar or longer one.
    """
    siblings = {name: (*parent, name) for name in _keys_in(annotation_at(model, parent))}
    anywhere = {str(path[-1]): path for path in reversed(known_paths(model))}
    meant = anywhere.get(key)
    for names in (siblings, anywhere):
        if meant is None and (word := nearest(key, names)):
            meant = names[word]
    if meant not in (None, (*parent, key)):  # else it is a key of another law
        return meant
    longer = (name for name in fields_of(section_at(model, parent) or model))
    return next(((*parent, name) for name in longer if f"_{key}_" in f"_{name}_"), None)


@lru_cache(maxsize=1024)
def unit(key: str) -> str:
    """SI unit of a case key; ``-`` for plain numbers and words."""
    si_unit = next(
        (mark.unit for mark in _marks_of(key) if isinstance(mark, Quantity)), "1"
    )
    return "-" if si_unit == "1" else si_unit


def is_whole(key: str) -> bool:
    """True if a case key holds whole numbers."""
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
"""Sections of THEORY.md in which keys enter; a key without a line
has those of its parent."""


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
    number = next((mark for mark in marks if isinstance(mark, Quantity | Whole)), None)
    quantity = number if isinstance(number, Quantity) else None
    literals = (get_args(part) for part in marks if get_origin(part) is Literal)
    listed_names = (mark.names for mark in marks if isinstance(mark, NameOf))
    words = (
        word
        for each in (*literals, *listed_names)
        for word in each
        if isinstance(word, str)
    )
    section = section_of(field.annotation)
    single = quantity is not None and not (
        section and "at_most" not in section.model_fields
    )
    keys = {} if section is None else fields_of(section)
    default = field.get_default()
    return KeyReference(
        key=key,
        meaning=field.description or "",
        symbol=quantity.symbol if quantity and single else "",
        unit=quantity.unit.replace(PLAIN, "-") if quantity and single else "",
        bounds=number.rule if number and (single or number is not quantity) else "",
        words=tuple(dict.fromkeys([*(quantity.words if quantity else ()), *words])),
        default=default if isinstance(default, str | int | float) else None,
        required=field.is_required(),
        keys=tuple((name, each.description or "") for name, each in keys.items()),
        sections=next((SECTIONS[parent] for parent in parents if parent in SECTIONS), ""),
    )


DIALECT = "https://json-schema.org/draft/2020-12/schema"


class PresentKeys(GenerateJsonSchema):
    """Optional keys are left out, never null: show neither null nor a default of null."""

    def nullable_schema(self, schema: core_schema.NullableSchema) -> JsonSchemaValue:
        """Schema of the value that the key has when it is written."""
        return self.generate_inner(schema["schema"])

    def default_schema(self, schema: core_schema.WithDefaultSchema) -> JsonSchemaValue:
        """Schema with the default, where there is one."""
        shown = super().default_schema(schema)
        default = shown.pop("default", None)
        if isinstance(default, dict):  # a whole section
            default = {key: value for key, value in default.items() if value is not None}
        return shown if default is None else {**shown, "default": default}

    def field_title_should_be_set(self, schema: Any) -> bool:
        """No titles: they would only repeat the keys."""
        del schema
        return False


def json_schema_of(model: type[BaseModel]) -> dict[str, Any]:
    """JSON schema of a model; ``unit`` beside a number is the
    SI unit of a bare number.
    """
    schema = model.model_json_schema(schema_generator=PresentKeys)
    for section in [schema, *schema["$defs"].values()]:
        if "description" in section:
            section["description"] = " ".join(section["description"].split())
    return {"$schema": DIALECT, **schema}


def study_json_schema(model: type[BaseModel]) -> dict[str, Any]:
    """JSON schema of a study or design file; its base may lack what keys bring."""
    study = json_schema_of(model)
    base = json_schema_of(CaseFile)
    definitions = {**base.pop("$defs"), **study.pop("$defs")}
    del base["required"], base["$schema"]
    described = study["properties"]["base"]["description"]
    study["properties"]["base"] = {
        "anyOf": [{"type": "string", "minLength": 1}, base],
        "description": described,
    }
    return {**study, "$defs": definitions}
