"""Results as JSON: numpy made plain, no NaN, lists of numbers on one line."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from rpscli.analyses.result_quantities import plain

SCHEMA_VERSION = 1
"""Version of every JSON document that rps writes."""


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
