"""Check a document against a pydantic model, and tell its faults in the user's words."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any, Generic, NamedTuple, TypeVar

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from rpscli.case.schema.fields import CHECKED_BY_ITSELF
from rpscli.case.schema.keys import annotation_at, field_at, fields_of, section_at, unknown_key
from rpscli.case.text.document import MOST_FAULTS, Document, Fault, Path, dotted, shown
from rpscli.errors import listed, nearest

Model = TypeVar("Model", bound=BaseModel)


class SchemaCheck(NamedTuple, Generic[Model]):
    """Faults of a document, known keys taken for unknown ones, sound content, and what was read."""

    faults: list[Fault]
    suggested: set[Path]
    sound: dict[str, Any]
    read: Model | None


def schema_check(model: type[Model], document: Document) -> SchemaCheck[Model]:
    """Faults of a document in the eyes of a model, key by key."""
    later = {key for key, f in fields_of(model).items() if CHECKED_BY_ITSELF in f.metadata}
    content = {key: value for key, value in document.content.items() if key not in later}
    empty = dict.fromkeys(_nulls(content, ()))
    announced = {fault.path for fault in document.faults}
    check: SchemaCheck[Model] = SchemaCheck([*document.faults], set(), {}, None)
    for path in empty:
        if path not in announced:
            _empty_value(check, model, path, content)
    content = document.pruned(empty, elements=True)
    read, errors = _read(model, content)
    if not (errors or check.faults):
        return check._replace(sound=content, read=read)
    bad = [*empty]
    for error in errors:
        path = _path(error, document)
        if error["type"] == "too_short" and document.at(path):
            continue  # its values are refused one by one
        if error["type"] == "extra_forbidden":
            _unknown(check, model, path, content)
        elif any(path == inner[: len(path)] for inner in empty if path != inner):
            continue  # it may be faulty because of what it lacks, which is told
        elif error["type"] != "missing":
            text = f"{dotted(path)} = {shown(document.at(path))} {_rule(error, path, model)}"
            check.faults.append(Fault(path, text))
        elif path not in empty:
            field = field_at(model, path)
            text = f"{dotted(path)} is missing: {field.description if field else 'write it'}"
            check.faults.append(Fault(path, text, at_key=True, needs=(path,)))
            continue
        bad.append(path)
    faults = [fault for fault in check.faults if not check.suggested.intersection(fault.needs)]
    return check._replace(faults=faults, sound=document.pruned(bad))


def _unknown(
    check: SchemaCheck[Any], model: type[BaseModel], path: Path, content: dict[str, Any]
) -> None:
    if "rps" in (known := fields_of(model)) and content.keys().isdisjoint(known):
        return  # another file than was meant, of which nothing is told
    # Beyond what is told at once there is no use in looking for what was meant.
    if len(check.faults) > MOST_FAULTS:
        check.faults.append(Fault(path, f"{dotted(path)} is not a key of the format", at_key=True))
        return
    fault, suggestion = unknown_key(model, path)
    check.faults.append(fault)
    if suggestion:
        check.suggested.add(suggestion)


def _empty_value(
    check: SchemaCheck[Any], model: type[BaseModel], path: Path, content: dict[str, Any]
) -> None:
    """A key with nothing behind it; its name may be wrong besides."""
    named = tuple(part for part in path if isinstance(part, str))
    known = [
        annotation_at(model, named[:length]) is not None for length in range(1, len(named) + 1)
    ]
    if all(known):
        text = f"{dotted(path)} has no value; write one, or remove the key"
        check.faults.append(Fault(path, text, at_key=isinstance(path[-1], str)))
    elif all(known[:-1]):  # otherwise the unknown key further up is told of
        _unknown(check, model, named, content)


def _read(model: type[Model], content: dict[str, Any]) -> tuple[Model | None, list[ErrorDetails]]:
    try:
        return model.model_validate(content), []
    except ValidationError as error:
        return None, error.errors(include_url=False)


def _nulls(value: object, path: Path) -> Iterator[Path]:
    if value is None:
        yield path
    elif isinstance(value, dict):
        for key, item in value.items():
            yield from _nulls(item, (*path, key))
    elif isinstance(value, list):
        for index, item in enumerate(value):
            yield from _nulls(item, (*path, index))


def _path(error: ErrorDetails, document: Document) -> Path:
    """Where in the document: pydantic's location without its names for branches of a union."""
    missing = error["type"] == "missing"
    path: Path = ()
    for part in error["loc"][:-1] if missing else error["loc"]:
        if document.has((*path, part)):
            path = (*path, part)
    return (*path, error["loc"][-1]) if missing else path


KEYS_SHOWN = 12
"""Of a section in a message; `rps explain` has all."""


def _rule(error: ErrorDetails, path: Path, model: type[BaseModel]) -> str:
    kind = error["type"]
    if kind == "literal_error":
        words = re.findall(r"'([^']*)'", error["ctx"]["expected"])
        suggestion = nearest(str(error["input"]), words)
        some = [*words[:KEYS_SHOWN], f"one of {len(words) - KEYS_SHOWN} more"]
        known = listed(some if len(words) > KEYS_SHOWN + 1 else words)
        return f"must be {known}" + (f"; did you mean {suggestion}?" if suggestion else "")
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
