"""The strict loader: positions, and a place and a remedy for whatever is not one mapping."""

from __future__ import annotations

import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rpscli.case.case import parse_case
from rpscli.case.text.document import MISSING
from rpscli.case.text.yaml_text import read_value, read_yaml
from rpscli.errors import CaseError


def refusal(text: str) -> str:
    with pytest.raises(CaseError) as error:
        parse_case(text, name="c.yaml")
    return str(error.value)


def test_positions_of_keys_and_values() -> None:
    document = read_yaml("a:\n  b: 1\n  c: [x, {d: 2}]\n", "c.yaml")
    assert document.content == {"a": {"b": 1, "c": ["x", {"d": 2}]}}
    assert str(document.key_place(("a", "c"))) == "c.yaml:3:3"
    assert str(document.value_place(("a", "c", 1, "d"))) == "c.yaml:3:14"
    assert document.at(("a", "c", 2)) is MISSING


def test_a_missing_key_is_placed_at_its_nearest_parent() -> None:
    document = read_yaml("a:\n  b: 1\n", "c.yaml")
    assert str(document.key_place(("a", "x", "y"))) == "c.yaml:1:1"
    assert str(document.key_place(("x",))) == "c.yaml:1:1"


def test_a_part_keeps_its_positions_and_faults() -> None:
    part = read_yaml("base:\n  rps: 1\n  rps: 1\nother: 2\n", "s.yaml").part("base")
    assert part.content == {"rps": 1}
    assert str(part.value_place(("rps",))) == "s.yaml:2:8"
    assert [fault.path for fault in part.faults] == [("rps",)]


def test_anchors_are_values_written_once() -> None:
    document = read_yaml("a: &one {x: 1}\nb: *one\n", "c.yaml")
    assert document.content["b"] == {"x": 1}
    assert str(document.value_place(("b", "x"))) == "c.yaml:1:13"


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("", ["c.yaml: the file is empty", "rps init"]),
        ("# only a comment\n", ["empty"]),
        ("---\n...\n", ["empty"]),
        ("- 1\n", ["c.yaml:1:1", "[1]", "not a mapping"]),
        ("text\n", ["c.yaml:1:1", "'text'", "not a mapping"]),
        ("a: 1\n\tb: 2\n", ["c.yaml:2:1", "tab", "spaces"]),
        ("a:\n  b: 1\n c: 2\n", ["c.yaml:3:2", "indentation"]),
        ("a: 1\n b: 2\n", ["c.yaml:2:3", "indent"]),
        ("a: x: y\n", ["c.yaml:1:5", "quotes"]),
        ("a: [1,\nb: 2\n", ["c.yaml:3:1", "bracket", "opens at line 1, column 4"]),
        ("{a: 1, b: 2\n", ["c.yaml:2:1", "brace is not closed"]),
        ("a: 'x\n", ["c.yaml:2:1", "quotation mark", "opens at line 1, column 4"]),
        ("a: *x\n", ["c.yaml:1:4", "anchor"]),
        ("a: @x\n", ["c.yaml:1:4", "quotes"]),
        ("a: \x07\n", ["c.yaml:1:4", "U+0007"]),
        ("a: &x [*x]\n", ["c.yaml:1:4", "alias of itself"]),
        ("a: 1\n---\nb: 1\n", ["c.yaml:3:1", "second document", "---"]),
        ("%YAML 3.0\n---\na: 1\n", ["c.yaml:1:1", "not YAML"]),
        ("a: " + "[" * 5000, ["c.yaml:1:43", "nested"]),
        ("{a: " * 5000, ["nested"]),
        ("- " * 5000, ["nested"]),
    ],
)
def test_syntax_is_refused_with_place_and_remedy(text: str, parts: list[str]) -> None:
    message = refusal(text)
    assert "\n" not in message
    for part in parts:
        assert part in message


@pytest.mark.parametrize(
    ("text", "place", "parts"),
    [
        ("a: 1\na: 2\n", "2:1", ["a is written twice", "line 1, column 1"]),
        ("b: {c: 1, c: 3}\n", "1:11", ["b.c is written twice", "line 1, column 5"]),
        ("<<: {a: 1}\n", "1:1", ["<<", "write the keys out"]),
        ("? [1]\n: 2\n", "1:3", ["a key must be a word"]),
        ("1: 2\n", "1:1", ["key 1 must be text"]),
        ("true: 2\n", "1:1", ["key true must be text"]),
        ("a: !!python/object:os.system {}\n", "1:4", ["python/object", "remove it"]),
        ("a: !local 3\n", "1:4", ["!local"]),
        ("a: !!int x\n", "1:4", ["'x' is not a YAML int"]),
        (f"a: {'9' * 5000}\n", "1:4", ["5000 digits"]),
    ],
)
def test_what_reading_survives_is_reported_with_the_rest(
    text: str, place: str, parts: list[str]
) -> None:
    lines = refusal(text).splitlines()
    assert any(line.startswith(f"c.yaml:{place}: ") and parts[0] in line for line in lines)
    assert all(part in "\n".join(lines) for part in parts)
    assert any("podium is missing" in line for line in lines)


def test_the_first_of_two_equal_keys_is_the_one_examined() -> None:
    assert read_yaml("a: 1\na: 2\n", "c.yaml").content == {"a": 1}


def test_an_alias_bomb_ends_in_a_message() -> None:
    levels = [f"l{i}: &l{i} [{', '.join([f'*l{i - 1}'] * 9)}]" for i in range(1, 9)]
    assert "aliases" in refusal("l0: &l0 [1]\n" + "\n".join(levels))


@given(st.text(alphabet=" \n\t-:[]{},&*!|>'\"%@`#?abc01.", max_size=40))
@settings(max_examples=300, deadline=None)
def test_any_text_is_read_or_refused_with_the_name(text: str) -> None:
    message = ""
    try:
        assert isinstance(read_yaml(text, "c.yaml").content, dict)
    except CaseError as error:
        message = str(error)
    assert re.match(r"c\.yaml(:\d+:\d+)?: .|$", message)


def test_a_single_value_is_read_alike() -> None:
    assert read_value("[1, 1e-6, no]", "--set x") == [1, 1e-6, "no"]
    with pytest.raises(CaseError, match="--set x: a is written twice"):
        read_value("{a: 1, a: 2}", "--set x")
