"""Units of the keys of a case, and which of them hold whole numbers."""

from __future__ import annotations

from functools import lru_cache

from rpscli.case.schema.case_file import CaseFile
from rpscli.case.schema.fields import Quantity, Whole
from rpscli.case.schema.known_keys import field_at, marks_of


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
