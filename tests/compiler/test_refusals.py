"""What the compiler does not know it refuses, with file, line, and what to write."""

from __future__ import annotations

import inspect
from pathlib import Path

import numpy as np
import pytest

from rpscli.compiler.functions import Program
from rpscli.compiler.objects import Entry, machine_code
from rpscli.compiler.values import DOUBLE, NotInLanguage

from .written import compiled, module_of

REFUSED = {
    "[x][0]": "write it with what the language has",
    "sum((x, y))": "not written in Python",
    "x // 2.0": "math.floor",
    "x if x > y else (x, y)": "of two kinds",
    "x and y": "no bool",
    "x is None": "compare with ==",
    "nothing + x": "has no value yet",
    "(x, y)[int(x)][0]": "index arrays",
    "x.real": "have fields",
    "math.gamma(x)": "LANGUAGE.md",
    "math.sin(x, y)": "LANGUAGE.md",
    "itself(x)": "calls itself",
    "x @ y": "use + - * /",
    "(lambda z: z)(x)": "write it with",
    "x in 'text'": "followed by a tuple",
    "1.0 < x < itself(x)": "write it with `and`",
    "min(x, y, default=1.0)": "without names",
    "two(x)": "takes a, b",
    "two(x, c=y)": "takes a, b",
    "x & y": "of bools or of ints",
    "~int(x)": "in another way",
    "float": "values of two kinds",
}
TEXT = """
def two(a, b):
    return a + b


def itself(x):
    return itself(x)


def f(x, y):
    z = x
    return {}
"""


@pytest.mark.parametrize(("expression", "said"), REFUSED.items())
def test_expressions(expression: str, said: str, tmp_path: Path) -> None:
    module = module_of(TEXT.format(expression), tmp_path)
    with pytest.raises(NotInLanguage) as caught:
        compiled(module.f, 1.0, 1.0)
    what, place = caught.value.args
    assert said in what
    line = {"calls itself": 9, "values of two kinds": 12}.get(said, 14)
    assert place == f"{Path(inspect.getfile(module)).name}:{line}"


STATEMENTS = {
    "with open('x'):\n        return x": "write it with if, for, while and return",
    "try:\n        return x\n    except ValueError:\n        return y": "`raise`",
    "for k in range(3):\n        pass\n    else:\n        return x": "`else` of a loop",
    "for k in x:\n        pass": "a range or a tuple",
    "for k in range(0, 3, int(x)):\n        pass": "a known number",
    "if x > y:\n        x = (x, y)": "use two names",
    "a, b = x": "give each its value",
    "x.real = 1.0": "numbers in records and arrays can be",
    "if x > y:\n        return x, y": "two kinds",
    "def g():\n        pass": "write it with",
    "x[0] = 1.0": "index arrays",
}


@pytest.mark.parametrize(("statement", "said"), STATEMENTS.items())
def test_statements(statement: str, said: str, tmp_path: Path) -> None:
    text = f"\ndef f(x, y):\n    {statement}\n    return x + y\n"
    with pytest.raises(NotInLanguage) as caught:
        compiled(module_of(text, tmp_path).f, 1.0, 1.0)
    what, place = caught.value.args
    assert said in what
    assert ".py:" in place


def test_a_source_that_cannot_be_read() -> None:
    names = {"__name__": "nowhere"}
    exec(compile("def f(x):\n    return x\n", "nowhere.py", "exec"), names)  # noqa: S102
    with pytest.raises(NotInLanguage, match="must stand in a file"):
        compiled(names["f"], 1.0)  # type: ignore[arg-type]


def fails(x: float, y: float) -> float:
    if x > 1.0:
        raise ValueError(f"{x} is too large")
    return x / y


def test_what_raises_is_no_number_and_what_it_was_given_is_kept() -> None:
    program = Program()
    program.add_watched(fails, 2, 3, "f")
    made = Entry(machine_code(program.text()), "f", [DOUBLE] * 3, DOUBLE, "f.refused")
    assert made(1.0, 2.0, 9.0) == 0.5
    assert made.numbers_at("f.refused", 4) == [0.0] * 4
    assert np.isnan(made(1.5, 2.0, 9.0))
    assert made.numbers_at("f.refused", 4) == [1.0, 1.5, 2.0, 9.0]
    assert made(0.5, 0.0, 7.0) == np.inf
    assert made.numbers_at("f.refused", 4) == [1.0, 0.5, 0.0, 7.0]


def test_arrays_are_checked_where_they_are_handed_over() -> None:
    with pytest.raises(TypeError, match="float64"):
        compiled(fails, np.zeros(3, int), 1.0)
    made = compiled(first_of, np.zeros((2, 2)))
    with pytest.raises(ValueError, match="one after the other"):
        made(np.zeros((4, 4))[::2, ::2])


def first_of(array: np.ndarray) -> float:
    return array[0, 0]  # type: ignore[no-any-return]
