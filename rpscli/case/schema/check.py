"""Check a document against a pydantic model, and tell its faults in the user's words."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from rpscli.case.schema.fields import CHECKED_BY_ITSELF
from rpscli.case.schema.keys import annotation_at, field_at, fields_of, section_at, unknown_key
from rpscli.case.text.document import MOST_FAULTS, Document, Fault, Path, dotted, shown
from rpscli.errors import listed, nearest

Model = TypeVar("Model", bound=BaseModel)

KEYS_SHOWN = 12
"""Keys of a section in a message; `rps explain` has all."""


def checked(model: type[Model], document: Document) -> Model:
    """The sections of a document, each valid in itself; raises CaseError with all faults."""
    content = dict(document.content)
    by_itself = {
        key: content.pop(key)
        for key, field in fields_of(model).items()
        if CHECKED_BY_ITSELF in field.metadata and key in content
    }
    faults, empty = _Faults(model, document, content), [*_nulls(content, ())]
    announced = {fault.path for fault in document.faults}
    for path in (path for path in empty if path not in announced):
        faults.add_empty(path)
    read, errors = _read(model, _without_nulls(content) | by_itself)
    for error in errors:
        path = _path(error, document)
        lacks = any(path == inner[: len(path)] for inner in empty)
        if not lacks or error["type"] == "extra_forbidden":  # else faulty by what is told already
            faults.add(error, path)
    document.refuse(faults.told())
    assert read is not None, "without faults the document is read"
    return read


class _Faults:
    """Faults of one document as they are met."""

    def __init__(self, model: type[BaseModel], document: Document, content: dict[str, Any]) -> None:
        self._model, self._document, self._all = model, document, [*document.faults]
        self._missing, self._meant = set[Fault](), set[Path | None]()
        known = fields_of(model)
        self._of_another_file = "rps" in known and content.keys().isdisjoint(known)

    def told(self) -> list[Fault]:
        """All of them, but for missing keys that were suggested for an unknown one."""
        instead = {fault for fault in self._missing if fault.path in self._meant}
        return [fault for fault in self._all if fault not in instead]

    def add(self, error: ErrorDetails, path: Path) -> None:
        """Add what pydantic says of the value at a path."""
        value, kind = self._document.at(path), error["type"]
        if kind == "extra_forbidden":
            self._add_unknown(path)
        elif kind == "missing":
            field = field_at(self._model, path)
            text = f"{dotted(path)} is missing: {field.description if field else 'write it'}"
            self._all.append(Fault(path, text, at_key=True))
            self._missing.add(self._all[-1])
        elif kind != "too_short" or not value:  # else its values are refused one by one
            text = f"{dotted(path)} = {shown(value)} {_rule(error, path, self._model)}"
            self._all.append(Fault(path, text))

    def add_empty(self, path: Path) -> None:
        """Add a key with nothing behind it; its name may be wrong besides."""
        named = tuple(part for part in path if isinstance(part, str))
        known = [annotation_at(self._model, named[: n + 1]) is not None for n in range(len(named))]
        if all(known):
            text = f"{dotted(path)} has no value; write one, or remove the key"
            self._all.append(Fault(path, text, at_key=isinstance(path[-1], str)))
        elif all(known[:-1]):  # otherwise the unknown key further up is told of
            self._add_unknown(named)

    def _add_unknown(self, path: Path) -> None:
        if self._of_another_file:
            return
        if len(self._all) > MOST_FAULTS:  # there is no use in what was meant
            fault = Fault(path, f"{dotted(path)} is not a key of the format", at_key=True)
            self._all.append(fault)
            return
        fault, suggestion = unknown_key(self._model, path)
        self._all.append(fault)
        self._meant.add(suggestion)


def _read(model: type[Model], content: Any) -> tuple[Model | None, list[ErrorDetails]]:
    try:
        return model.model_validate(content), []
    except ValidationError as error:
        return None, error.errors(include_url=False)


def _nulls(value: object, path: Path) -> Iterator[Path]:
    if value is None:
        yield path
    elif isinstance(value, dict | list):
        for key, item in value.items() if isinstance(value, dict) else enumerate(value):
            yield from _nulls(item, (*path, key))


def _without_nulls(value: Any) -> Any:
    """A value without keys that hold null; an element that is null takes its list with it."""
    if isinstance(value, list):
        return [_without_nulls(item) for item in value]
    if not isinstance(value, dict):
        return value
    return {key: _without_nulls(item) for key, item in value.items() if not _holds_null(item)}


def _holds_null(value: object) -> bool:
    return value is None or (isinstance(value, list) and any(map(_holds_null, value)))


def _path(error: ErrorDetails, document: Document) -> Path:
    """Path in the document: pydantic's location without its names for branches of a union."""
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
