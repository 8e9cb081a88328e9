"""Results as JSON: numpy made plain, no NaN, lists of numbers on one line."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Any

SCHEMA_VERSION = 1
"""Version of every JSON document that rps writes."""


def plain(value: Any) -> Any:
    """A value as JSON knows it: arrays as lists, complex numbers as [re, im], NaN as null.

    >>> plain({"a": (1.0, float("inf")), "z": 1 + 2j})
    {'a': [1.0, None], 'z': [1.0, 2.0]}
    """
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, complex):
        return [plain(value.real), plain(value.imag)]
    if isinstance(value, float):
        return value + 0.0 if math.isfinite(value) else None  # no -0.0
    return value


def json_text(document: Mapping[str, Any]) -> str:
    """The document, indented by two, with a newline at its end."""
    return _text(plain(document), "") + "\n"


def _text(value: Any, indent: str) -> str:
    deeper = indent + "  "
    if isinstance(value, dict) and value:
        items = (f"{deeper}{json.dumps(key)}: {_text(item, deeper)}" for key, item in value.items())
        return "{\n" + ",\n".join(items) + f"\n{indent}}}"
    if isinstance(value, list) and any(isinstance(item, dict | list) for item in value):
        return "[\n" + ",\n".join(deeper + _text(item, deeper) for item in value) + f"\n{indent}]"
    return json.dumps(value, allow_nan=False)
