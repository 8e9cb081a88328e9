"""The numbers of a document by dotted names."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import Any

MADE_ANEW = frozenset(
    ("files", "rps_version", "case", "verdicts", "passed", "exit_code", "command")
)
"""Keys of a document that are no results."""


def leaves(value: object, name: str = "") -> Iterator[tuple[str, Any]]:
    """Values of nested mappings and of lists of mappings under dotted names; other lists whole."""
    if isinstance(value, list) and any(isinstance(item, dict) for item in value):
        value = {str(index): item for index, item in enumerate(value)}
    if not isinstance(value, dict) or not value:
        yield name, value
        return
    for key, item in value.items():
        yield from leaves(item, f"{name}.{key}" if name else key)


def results_of(document: Mapping[str, Any]) -> dict[str, Any]:
    """The results of a document by dotted name."""
    return dict(leaves({key: document[key] for key in document if key not in MADE_ANEW}))


def as_text(value: object) -> str:
    """A value of a document for a table, cut where it is long."""
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) < 60 else f"{text[:57]}..."
