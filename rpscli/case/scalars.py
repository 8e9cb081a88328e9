"""Plain scalars of the YAML 1.2 core schema: what `1e-6`, `no` and `012` mean."""

from __future__ import annotations

import re

Scalar = None | bool | int | float | str

TAG = "tag:yaml.org,2002:"

NULL = re.compile(r"(?:null|Null|NULL|~|)\Z")
BOOL = re.compile(r"(?:true|True|TRUE|false|False|FALSE)\Z")
INT = re.compile(r"(?:[-+]?[0-9]+|0o[0-7]+|0x[0-9a-fA-F]+)\Z")
FLOAT = re.compile(
    r"(?:[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?"
    r"|[-+]?\.(?:inf|Inf|INF)|\.(?:nan|NaN|NAN))\Z"
)
PATTERNS = {"null": NULL, "bool": BOOL, "int": INT, "float": FLOAT}
"""Tried in this order; what matches none of them is text."""


def tagged_scalar(tag: str, text: str) -> Scalar:
    """Value of a scalar whose tag (``int``, ``float``, ...) is known.

    Raises
    ------
    ValueError
        If the text does not have the form of the tag (an explicit ``!!int abc``).
    """
    if tag == "str":
        return text
    if not PATTERNS[tag].match(text):
        raise ValueError(f"{text!r} is not a YAML {tag}")
    if tag == "null":
        return None
    if tag == "bool":
        return text.lower() == "true"
    return _integer(text) if tag == "int" else _real(text)


def core_scalar(text: str) -> Scalar:
    """Value of an unquoted scalar.

    >>> core_scalar("1e-6"), core_scalar("no"), core_scalar("012"), core_scalar("1_000")
    (1e-06, 'no', 12, '1_000')
    """
    tag = next((tag for tag, pattern in PATTERNS.items() if pattern.match(text)), "str")
    return tagged_scalar(tag, text)


def _integer(text: str) -> int:
    base = {"0o": 8, "0x": 16}.get(text[:2], 10)
    if len(text) > 400:  # far outside every quantity, and slow to convert
        raise ValueError(f"a whole number of {len(text)} digits is too long")
    return int(text, base)


def _real(text: str) -> float:
    return float(text.lower().replace(".inf", "inf").replace(".nan", "nan"))
