"""The keys that a pydantic model knows, and what an unknown one was meant to be."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import Any, get_args

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from rpscli.case.text.faults import Fault, Path, dotted, listed
from rpscli.errors import nearest


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
