"""`--set dotted.key=value`, and the varied keys of a study: values
put over those of a file.
"""

from __future__ import annotations

import copy
import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

from pydantic import BaseModel

from rpscli.case.schema.case_file import CaseFile
from rpscli.case.schema.keys import field_at, section_at, unknown_key
from rpscli.case.text.document import (
    Document,
    Fault,
    Path,
    Position,
    dotted,
    path_of,
    shown,
    text_of_values,
)
from rpscli.case.text.yaml_text import read_value
from rpscli.errors import CaseError


class Override(NamedTuple):
    """One value to be put at a dotted key; None takes the key away."""

    key: str
    value: Any
    place: Position


Overrides = Sequence[str | Override] | Mapping[str, object]


def apply_overrides(
    document: Document,
    overrides: Overrides,
    *,
    label: str = "--set",
    model: type[BaseModel] = CaseFile,
) -> Document:
    """A new document with values put over those that are
    written; null takes a key out.
    """
    changed = replace(
        document,
        content=copy.deepcopy(document.content),
        keys=dict(document.keys),
        values=dict(document.values),
    )
    faults = []
    for override in _parsed(overrides, label):
        path = path_of(override.key)
        if text := _unknown(path, model) or _put(changed, path, override):
            faults.append(Fault(path, text, place=override.place))
    changed.refuse(faults)
    return changed


def _parsed(overrides: Overrides, label: str) -> Iterator[Override]:
    items: Iterable[Any] = overrides
    if isinstance(overrides, Mapping):
        items = json.loads(text_of_values(overrides, label)).items()
    for rank, item in enumerate(items, start=1):
        if isinstance(item, Override):
            yield item
        elif isinstance(item, tuple):
            key, value = item
            written = value if isinstance(value, str) else shown(value)
            yield Override(key, value, Position(f"{label} {key}={written}", rank=rank))
        else:
            place = Position(f"{label} {item}", rank=rank)
            key, sign, text = item.partition("=")
            if not sign or not key.strip():
                raise CaseError(
                    f"{place}: write {label} dotted.key=value, as in podium.columns=4"
                )
            yield Override(key.strip(), read_value(text, str(place)), place)


def _unknown(path: Path, model: type[BaseModel]) -> str:
    """The first part of a path that the format does not know, in
    words; empty if it knows all.
    """
    named = tuple(part for part in path if isinstance(part, str))
    if not named:
        return "an index alone is not a key of the format"
    for end, part in enumerate(named):
        if field_at(model, named[: end + 1]) is not None:
            continue
        if section_at(model, named[:end]) is None:
            return (
                f"{dotted(named[:end])} can be set as a whole only, not {dotted(named)}"
            )
        return unknown_key(model, (*named[:end], part))[0].text
    return ""


def _put(document: Document, path: Path, override: Override) -> str:
    """Put one value in place; the reason if it cannot be put there."""
    owner: Any = document.content
    value = override.value
    (*parents, key) = path
    for depth, part in enumerate(parents):
        if text := _obstacle(owner, path[:depth], part):
            return text
        if isinstance(owner, dict) and part not in owner:
            if value is None:
                return ""  # nothing there to take out
            owner[part] = {}
            _settle(document, path[: depth + 1], override.place)
        owner = owner[part]
    if text := _obstacle(owner, tuple(parents), key):
        return text
    if value is None and isinstance(owner, list):
        return f"{dotted(path)} cannot be taken out of its list; set the whole list"
    _settle(document, path, override.place)
    if value is None:
        owner.pop(key, None)
    else:
        owner[key] = value
    return ""


def _obstacle(owner: object, path: Path, part: str | int) -> str:
    """The reason why `part` is no key or index of the value at a
    path; empty if it is one.
    """
    if isinstance(owner, list) and isinstance(part, int):
        lacks = (
            f"{dotted(path)} has {len(owner)} values, counted from 0; there is no {part}"
        )
        return lacks if part >= len(owner) else ""
    if isinstance(owner, list):
        return f"{dotted(path)} is a list, without a key {part}"
    if not isinstance(owner, dict):
        return f"{dotted(path)} = {shown(owner)} is a single value; set it as a whole"
    if isinstance(part, int):
        return f"{dotted(path) or 'the case'} is not a list; {part} is not a key of it"
    return ""


def _settle(document: Document, path: Path, place: Position) -> None:
    """From now on, everything at and below the path was written by the override."""
    for places in (document.keys, document.values):
        for old in [old for old in places if old[: len(path)] == path]:
            del places[old]
        places[path] = place
