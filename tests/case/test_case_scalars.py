"""Plain scalars are those of YAML 1.2, wherever they are read."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rpscli.case.text.yaml_text import read_yaml


def plain(text: str) -> Any:
    """What an unquoted scalar is read as."""
    return read_yaml(f"key: {text}", "c.yaml").content["key"]


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1e-6", 1e-6),
        ("1.0e-6", 1e-6),
        (".5", 0.5),
        ("3.", 3.0),
        ("+2", 2),
        ("012", 12),
        ("0o17", 15),
        ("0x1F", 31),
        ("1_000", "1_000"),
        ("12:30:45", "12:30:45"),
        ("2024-01-31", "2024-01-31"),
        ("0b11", "0b11"),
        ("no", "no"),
        ("on", "on"),
        ("Yes", "Yes"),
        ("y", "y"),
        ("true", True),
        ("FALSE", False),
        ("null", None),
        ("~", None),
        ("", None),
        ("-.inf", -math.inf),
        (".", "."),
        ("1e", "1e"),
        ("inf", "inf"),
        ("=", "="),
    ],
)
def test_core_schema(text: str, value: object) -> None:
    found = plain(text)
    assert found == value
    assert type(found) is type(value)


def test_not_a_number_is_a_number_to_yaml() -> None:
    assert math.isnan(plain(".NaN"))


@given(st.floats(allow_nan=False, allow_infinity=False))
@settings(deadline=None)
def test_real_numbers_come_back_exactly(number: float) -> None:
    assert plain(repr(number)) == number


@given(st.text(alphabet=st.characters(exclude_categories=["C", "Z"]), max_size=20))
@settings(deadline=None)
def test_quoted_text_stays_text(text: str) -> None:
    quoted = text.replace("'", "''")
    assert read_yaml(f"key: '{quoted}'", "c.yaml").content == {"key": text}


@given(st.from_regex(r"[a-zA-Z][a-zA-Z0-9_]{0,12}", fullmatch=True))
@settings(deadline=None)
def test_words_are_text_but_for_three(word: str) -> None:
    special = {"true": True, "false": False, "null": None}
    expected = special.get(word.lower(), word) if word.islower() or word.isupper() else word
    if word in {"True", "False", "Null"}:
        expected = special[word.lower()]
    assert plain(word) == expected
