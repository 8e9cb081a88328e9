"""Check a document against a pydantic model, and tell its faults in the user's words."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any, NamedTuple

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from rpscli.case.document import Document
from rpscli.case.faults import Fault, Path, dotted, listed, nearest, shown
from rpscli.case.known_keys import field_at, section_at, unknown_key


class SchemaCheck(NamedTuple):
    """What a model makes of a document.

    Parameters
    ----------
    faults
        Everything wrong with single keys and values.
    meant
        Known keys for which unknown ones were taken: they count as given, so that one slip is
        not reported twice.
    sound
        The content without its faulty values.
    """

    faults: list[Fault]
    meant: set[Path]
    sound: dict[str, Any]


def schema_check(model: type[BaseModel], document: Document) -> SchemaCheck:
    """Faults of a document in the eyes of a model, key by key."""
    empty = list(_nulls(document.content, ()))
    told = {fault.path for fault in document.faults}
    check = SchemaCheck([*document.faults], set(), {})
    for path in empty:
        if path not in told:
            _empty_value(check, model, path)
    bad = [*empty]
    for error in _errors(model, document.pruned(empty)):
        path = _path(error, document)
        if error["type"] == "extra_forbidden":
            _unknown(check, model, path)
        elif error["type"] != "missing":
            text = f"{dotted(path)} = {shown(document.at(path))} {_rule(error, path, model)}"
            check.faults.append(Fault(path, text))
        elif path not in empty:
            field = field_at(model, path)
            text = f"{dotted(path)} is missing: {field.description if field else 'write it'}"
            check.faults.append(Fault(path, text, at_key=True, needs=(path,)))
            continue
        bad.append(path)
    return check._replace(sound=document.pruned(bad))


def _unknown(check: SchemaCheck, model: type[BaseModel], path: Path) -> None:
    fault, guess = unknown_key(model, path)
    check.faults.append(fault)
    if guess:
        check.meant.add(guess)


def _empty_value(check: SchemaCheck, model: type[BaseModel], path: Path) -> None:
    """A key with nothing behind it; its name may be wrong besides."""
    named = tuple(part for part in path if isinstance(part, str))
    known = [field_at(model, named[:length]) is not None for length in range(1, len(named) + 1)]
    if all(known):
        text = f"{dotted(path)} has no value; write one, or take the key out"
        check.faults.append(Fault(path, text, at_key=isinstance(path[-1], str)))
    elif all(known[:-1]):  # otherwise the unknown key further up is told of
        _unknown(check, model, named)


def _errors(model: type[BaseModel], content: dict[str, Any]) -> list[ErrorDetails]:
    try:
        model.model_validate(content)
    except ValidationError as error:
        return error.errors(include_url=False)
    return []


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


def _rule(error: ErrorDetails, path: Path, model: type[BaseModel]) -> str:
    kind = error["type"]
    if kind == "literal_error":
        words = re.findall(r"'([^']*)'", error["ctx"]["expected"])
        guess = nearest(str(error["input"]), words)
        return f"must be {listed(words)}" + (f"; did you mean {guess}?" if guess else "")
    if kind in {"model_type", "model_attributes_type"}:
        section = section_at(model, path)
        names = listed(section.model_fields, "and") if section else ""
        return f"must be a mapping with keys among {names}"
    if kind == "too_short":
        return "must not be an empty list"
    message = error["msg"]
    return message if kind == "rps" else message[0].lower() + message[1:]
