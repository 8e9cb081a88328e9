"""The strict text layer: positions, scalars of YAML 1.2, a place and a remedy for what is wrong."""

import math
import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rpscli.case.text.document import MISSING
from rpscli.case.text.yaml_text import read_value, read_yaml
from rpscli.errors import CaseError

from .conftest import refusal


def test_positions_of_keys_and_values():
    document = read_yaml(
        "a:\n  b: 1\n  c: [x, {d: 2}]\ne: &one {x: 1}\nf: *one\n", "c.yaml"
    )
    assert document.content["a"] == {"b": 1, "c": ["x", {"d": 2}]}
    assert str(document.key_place(("a", "c"))) == "c.yaml:3:3"
    assert str(document.value_place(("a", "c", 1, "d"))) == "c.yaml:3:14"
    assert document.at(("a", "c", 2)) is MISSING
    # a missing key has the position of its nearest parent, an alias that of its anchor
    assert str(document.key_place(("a", "x", "y"))) == "c.yaml:1:1"
    assert str(document.key_place(("x",))) == "c.yaml:1:1"
    assert document.content["f"] == {"x": 1}
    assert str(document.value_place(("f", "x"))) == "c.yaml:4:13"


def test_a_part_keeps_its_positions_and_faults():
    part = read_yaml("base:\n  rps: 1\n  rps: 2\nother: 2\n", "s.yaml").part("base")
    assert part.content == {"rps": 1}  # the first of two equal keys
    assert str(part.value_place(("rps",))) == "s.yaml:2:8"
    assert [fault.path for fault in part.faults] == [("rps",)]


BOMB = [f"l{i}: &l{i} [{', '.join([f'*l{i - 1}'] * 9)}]" for i in range(1, 9)]


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("", ["c.yaml: the file is empty", "rps init"]),
        ("# only a comment\n", ["empty"]),
        ("---\n...\n", ["empty"]),
        ("- 1\n", ["c.yaml:1:1", "[1]", "not a mapping"]),
        ("text\n", ["c.yaml:1:1", "'text'", "not a mapping"]),
        ("a: 1\n\tb: 2\n", ["c.yaml:2:1", "tab", "spaces"]),
        ("a: 1\nb:\t2\n", ["c.yaml:2:3", "a tab behind the text here; write a blank"]),
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
        ("- " * 60, ["five levels deep: close brackets, or remove indentation"]),
        ("\n".join(" " * n + "a:" for n in range(60)), ["five levels deep"]),
        (
            "rps: 1\nperiod: [" + "1," * 50_000 + "1]",
            ["no case or study has so many values"],
        ),
        ("l0: &l0 [1]\n" + "\n".join(BOMB), ["more than 20000 values; do aliases"]),
    ],
)
def test_syntax_is_refused_with_place_and_remedy(text, parts):
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
        ("a: [0,15, 0.2, 0,25]\n", "1:4", ["a: 0,15 has a decimal comma", "write 0.15"]),
        ("a: [200,5 t, 3 t]\n", "1:4", ["write 200.5 t, or for two numbers a blank"]),
    ],
)
def test_what_reading_survives_is_told_as_well(text, place, parts):
    lines = refusal(text).splitlines()
    assert any(
        line.startswith(f"c.yaml:{place}: ") and parts[0] in line for line in lines
    )
    assert all(part in "\n".join(lines) for part in parts)
    assert any("podium is missing" in line for line in lines)


def test_lists_without_a_decimal_comma_are_read():
    read = read_yaml(
        "a: [1,2]\nb: [1,2,3, 4]\nc: [1.5,2, 0.5]\nd: [a,1, b]\n", "c.yaml"
    ).content
    assert [len(read[key]) for key in "abcd"] == [2, 4, 3, 3]


@given(st.text(alphabet=" \n\t-:[]{},&*!|>'\"%@`#?abc01.", max_size=40))
@settings(max_examples=300)
def test_any_text_is_read_or_refused_with_the_name(text):
    message = ""
    try:
        assert isinstance(read_yaml(text, "c.yaml").content, dict)
    except CaseError as error:
        message = str(error)
    assert re.match(r"c\.yaml(:\d+:\d+)?: .|$", message)


def test_a_single_value_is_read_alike():
    assert read_value("[1, 1e-6, no]", "--set x") == [1, 1e-6, "no"]
    with pytest.raises(CaseError, match="--set x: a is written twice"):
        read_value("{a: 1, a: 2}", "--set x")


def plain(text):
    """What an unquoted scalar is read as."""
    return read_yaml(f"key: {text}", "c.yaml").content["key"]


SCALARS = {
    "1e-6": 1e-6, "1.0e-6": 1e-6, ".5": 0.5, "3.": 3.0, "+2": 2, "012": 12, "0o17": 15, "0x1F": 31,
    "-.inf": -math.inf, "1_000": "1_000", "12:30:45": "12:30:45", "2024-01-31": "2024-01-31",
    "0b11": "0b11", "no": "no", "on": "on", "Yes": "Yes", "y": "y", ".": ".", "1e": "1e",
    "inf": "inf", "=": "=", "true": True, "FALSE": False, "null": None, "~": None, "": None,
    '"\\ud83c\\udfd7"': "\U0001f3d7",  # as JSON writes it
}  # fmt: skip


@pytest.mark.parametrize(("text", "value"), SCALARS.items())
def test_core_schema(text, value):
    found = plain(text)
    assert found == value
    assert type(found) is type(value)


def test_not_a_number_is_a_number_to_yaml():
    assert math.isnan(plain(".NaN"))


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_real_numbers_come_back_exactly(number):
    assert plain(repr(number)) == number


@given(st.text(alphabet=st.characters(exclude_categories=["C", "Z"]), max_size=20))
def test_quoted_text_stays_text(text):
    quoted = text.replace("'", "''")
    assert read_yaml(f"key: '{quoted}'", "c.yaml").content == {"key": text}


@given(st.from_regex(r"[a-zA-Z][a-zA-Z0-9_]{0,12}", fullmatch=True))
def test_words_are_text_but_for_three(word):
    special = {"true": True, "false": False, "null": None}
    is_special = word in {word.lower(), word.upper(), word.capitalize()}
    assert plain(word) == (special.get(word.lower(), word) if is_special else word)
