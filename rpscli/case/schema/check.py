"""Check a document against a pydantic model, and tell its faults in the user's words."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TypeVar

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from rpscli.case.schema.fields import CHECKED_BY_ITSELF
from rpscli.case.schema.keys import (
    annotation_at,
    field_at,
    fields_of,
    section_at,
    unknown_key,
)
from rpscli.case.text.document import MOST_FAULTS, Document, Fault, Path, dotted, shown
from rpscli.errors import listed, nearest

Model = TypeVar("Model", bound=BaseModel)

KEYS_SHOWN = 12
"""Keys of a section in a message; `rps explain` has all."""


def checked(model: type[Model], document: Document) -> Model:
    """The sections of a document, each valid in itself; raises
    CaseError with all faults.
    """
    read = None
    errors = list[ErrorDetails]()
    try:
        read = model.model_validate(document.content)
    except ValidationError as error:
        errors = error.errors(include_url=False)
    document.refuse(_told(model, document, errors))
    assert read is not None, "without faults the document is read"
    return read


def _told(
    model: type[BaseModel], document: Document, errors: list[ErrorDetails]
) -> Iterator[Fault]:
    """Faults: those found in reading, keys with nothing behind them, and the others that
    pydantic reports.
    """
    known = fields_of(model)
    by_itself = {
        key for key, field in known.items() if CHECKED_BY_ITSELF in field.metadata
    }
    inside = {key: of for key, of in document.content.items() if key not in by_itself}
    # Among the values of a varied key null takes the key out.
    empty = [
        p for p in _nulls(inside, ()) if p[0] != "vary" or [*map(type, p[3:])] != [int]
    ]
    announced = {fault.path for fault in document.faults}.intersection(empty)
    unknown = list[Path]()
    missing = list[Path]()
    yield from document.faults
    for path in (path for path in empty if path not in announced):
        if annotation_at(model, path) is not None:  # else it is unknown
            text = f"{dotted(path)} has no value; write one, or remove the key"
            yield Fault(path, text, at_key=isinstance(path[-1], str))
    for error in errors:
        path = _path(error, document)
        kind = error["type"]
        if kind == "extra_forbidden":
            unknown += [path] * (path not in announced)
        elif any(path == inner[: len(path)] for inner in empty):
            continue  # faulty by what is told already
        elif kind == "missing":
            missing.append(path)
        elif kind != "too_short" or not document.at(
            path
        ):  # else its values are refused one by one
            text = f"{shown(document.at(path))} {_rule(error, path, model)}"
            yield Fault(path, f"{dotted(path)} = {text}")
    if "rps" in known and inside.keys().isdisjoint(known):
        unknown = []  # of another file
    yield from _misnamed(model, unknown, missing)


def _misnamed(
    model: type[BaseModel], unknown: list[Path], missing: list[Path]
) -> Iterator[Fault]:
    """Unknown keys, and missing ones that none of these was taken for."""
    meant = set[Path | None]()
    for number, path in enumerate(unknown):
        fault, suggestion = unknown_key(model, path, suggest=number < MOST_FAULTS)
        yield fault
        meant.add(suggestion)
    for path in (path for path in missing if path not in meant):
        field = field_at(model, path)
        text = f"{dotted(path)} is missing: {field.description if field else 'write it'}"
        yield Fault(path, text, at_key=True)


def _nulls(value: object, path: Path) -> Iterator[Path]:
    if value is None:
        yield path
    elif isinstance(value, dict | list):
        for key, item in value.items() if isinstance(value, dict) else enumerate(value):
            yield from _nulls(item, (*path, key))


def _path(error: ErrorDetails, document: Document) -> Path:
    """Path in the document: pydantic's location without its names
    for branches of a union.
    """
    missing = error["type"] == "missing"
    path: Path = ()
    for part in error["loc"][:-1] if missing else error["loc"]:
        if document.has((*path, part)):
            path = (*path, part)
    return (*path, error["loc"][-1]) if missing else path


def _rule(error: ErrorDetails, path: Path, model: type[BaseModel]) -> str:
    kind = error["type"]
    if kind == "literal_error":
        words = re.findall(r"'([^']*)'", error["ctx"]["expected"])
        suggestion = nearest(str(error["input"]), words)
        some = [*words[:KEYS_SHOWN], f"one of {len(words) - KEYS_SHOWN} more"]
        known = listed(some if len(words) > KEYS_SHOWN + 1 else words)
        return f"must be {known}" + (
            f"; did you mean {suggestion}?" if suggestion else ""
        )
    if kind in {"model_type", "model_attributes_type"}:
        section = section_at(model, path)
        keys = [*fields_of(section)] if section else []
        more = f" and {len(keys) - KEYS_SHOWN} more" * (len(keys) > KEYS_SHOWN)
        names = ", ".join(keys[:KEYS_SHOWN]) + more if more else listed(keys, "and")
        return f"must be a mapping with keys among {names}"
    if kind == "dict_type":
        return "must be a mapping, `key: value`"
    if kind in {"tuple_type", "list_type"}:
        return "must be a list"
    if kind == "too_short":
        return "must not be an empty list"
    message = error["msg"]
    return message if kind == "rps" else message[0].lower() + message[1:]
