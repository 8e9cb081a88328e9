"""Units of the keys of a case."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, get_args

from rpscli.case.schema.case_file import CaseFile
from rpscli.case.schema.fields import Quantity
from rpscli.case.schema.known_keys import field_at


def unit(key: str) -> str:
    """SI unit of a case key; ``-`` for plain numbers and words.

    >>> unit("superstructure.period"), unit("podium.bearing.slenderness")
    ('s', '-')
    """
    path = tuple(part for part in key.split(".") if not part.isdecimal())
    field = field_at(CaseFile, path)
    marks = (*field.metadata, *_marks(field.annotation)) if field else ()
    found = next((mark.unit for mark in marks if isinstance(mark, Quantity)), "1")
    return "-" if found == "1" else found


def _marks(annotation: Any) -> Iterator[object]:
    """What stands inside `Annotated`, in any branch of a union."""
    yield from getattr(annotation, "__metadata__", ())
    for part in get_args(annotation):
        yield from _marks(part)
