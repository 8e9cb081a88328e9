"""What the language has, construct by construct: machine code gives the bits that Python gives."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from pathlib import Path
from random import Random
from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rpscli.compiler.functions import inlined
from rpscli.compiler.mathematics import fma
from rpscli.compiler.values import NotInLanguage

from .random_functions import random_function
from .written import bits, compiled, module_of

CORNERS = (
    0.0,
    -0.0,
    1.0,
    -1.5,
    2.5,
    1e-308,
    -5e-324,
    1e300,
    math.inf,
    -math.inf,
    math.nan,
)
WHOLE = (0, 1, -1, 7, -7, 3, -3, 1000003)


class Pair(NamedTuple):
    """Two numbers."""

    one: float
    two: float = 2.0


TABLE = np.array([[1.5, -2.5, 0.25], [4.0, 5.0, -0.0]])
FLAGS = np.array([True, False, True])
WEIGHTS = (0.5, 0.25, 2.0)


def signs(x: float, y: float) -> float:
    return -x + 0.0 * y - (-0.0)


def compared(x: float, y: float) -> float:
    return (
        1.0 * (x < y) + 2.0 * (x <= y) + 4.0 * (x > y) + 8.0 * (x >= y) + 16.0 * (x == y)
        + 32.0 * (x != y) + 64.0 * (not x < y) + 128.0 * (not x)
    )  # fmt: skip


def least(x: float, y: float) -> float:
    return min(x, y, 1.0) + 2.0 * max(x, y) + min(1.0, x) + max(-0.0, x)


def chained(x: float, y: float) -> float:
    return 1.0 if -1.0 < x <= y < 1e3 else (2.0 if y > 0.0 > x else 3.0)


def chosen(x: float, y: float) -> float:
    return (x if x > 2.0 * y else y) + (
        math.sqrt(abs(x)) if x > 0.0 else 1.0 / (1.0 + abs(y))
    )


def decided(x: float, y: float) -> float:
    found = 0.0
    if x > 0.0 and math.sqrt(x) > 1.0 and y != 0.0:
        found += 1.0
    if x > 0.0 or y > 0.0 or math.fabs(x) > 1e3:
        found += 2.0
    if not (x > 0.0 and y > 0.0):
        found += 4.0
    return (
        found + (8.0 if x in (1.0, 2.5) else 0.0) + (16.0 if x not in (1.0, 0.0) else 0.0)
    )


def rounded(x: float, y: float) -> float:
    return np.ceil(x) + np.floor(y) + math.copysign(1.0, x) + abs(y) + fma(x, y, -x)


def finite(x: float, y: float) -> float:
    return 1.0 * math.isfinite(x) + 2.0 * math.isnan(y) + 4.0 * math.isinf(x)


def tuples(x: float, y: float) -> float:
    a, (b, c) = x, (y, (x, 2.0))
    a, b = b, a
    d = c[0] if y > 0.0 else c[1]
    pair = Pair(a, two=b) if x > y else Pair(b)
    return d + pair.one - 3.0 * pair.two + c[-1]


def early(x: float, y: float) -> float:
    if x > y:
        return x
    if x == y:
        return -1.0
    for k in range(3):
        if k * x > y:
            return float(k)
    return 2


def loops(x: float, y: float) -> float:  # noqa: C901
    found, n = 0.0, 0
    for i in range(5, -3, -2):
        for j in range(i):
            if j == 2:
                continue
            if i + j > 6:
                break
            found += x * i - j
            n += 1
    for _ in range(0):
        found = math.nan
    for k in range(3, 3):
        found = math.nan * k
    while n > 0:
        n -= 3
        found = 0.5 * found + y
        if found > 1e200:
            break
    for each in (x, y, 1.0):
        if each > 2.0:
            continue
        found += each
    return found + n


def widened(x: float, y: float) -> float:
    total = 0
    for i in range(4):
        total += i
        if x > y:
            total = total + 0.5
    return total


def two_things(x: float, y: float) -> float:
    if x > y:
        of = x, y
        found = of[0] - of[1]
    else:
        of = 2.0 * x, y, 1.0
        found = of[2] - of[0]
    for k in range(2):
        step = 1.0 + k
        found += step
    for _ in range(2):
        step = found, x
        found += step[1]
    return found


@inlined
def power(x: float, n: int) -> float:
    if n == 0:
        return 1.0
    return x if n == 1 else x * x


def inner(x: float, y: float = 3.0, flag: bool = True) -> float:
    x = x + 1.0 if flag else x - 1.0
    return x - y


def calls(x: float, y: float) -> float:
    return inner(x) + inner(y=x, x=y) + inner(x, flag=False) + power(x, 0) + power(y, 2)


def table(x: float, y: float) -> float:
    found = 0.0
    for i in range(TABLE.shape[0]):
        for j in range(3):
            if FLAGS[j]:
                found += TABLE[i, j] * x + WEIGHTS[j] * y
    return found + TABLE[1, 1] + WEIGHTS[-1]


def powers(x: float, y: float) -> float:
    return abs(x) ** 0.5 + abs(x) ** y + x**2 + x**3


REAL: list[Callable[..., float]] = [
    signs, compared, least, chained, chosen, decided, rounded, finite, tuples, early, loops,
    widened, two_things, calls, table, powers,
]  # fmt: skip


@pytest.mark.filterwarnings("ignore:invalid value")  # of numpy's numbers
@pytest.mark.parametrize("function", REAL, ids=lambda each: each.__name__)
def test_functions_of_floats(function: Callable[..., float]) -> None:
    made, known = compiled(function, 0.5, 0.5), 0
    for x, y in itertools.product(CORNERS, CORNERS):
        try:
            expected = function(x, y)
        except (ArithmeticError, ValueError):
            continue
        known += 1
        assert bits(made(x, y)) == bits(expected), (x, y)
    assert known > 60


def divided(i: int, j: int) -> float:
    return float(i // j * 1000 + i % j) + i / j + 0.5 * (-i // 2) + 0.25 * (-i % 4)


def mixed(i: int, j: int) -> float:
    k = i if i > j else -j
    bits_of = (i & 6) | (j & 1)
    return (
        k
        + abs(i) * 2
        + min(i, j, 3)
        - max(i, j)
        + bits_of
        + (i > 0)
        + int(j / 2 + 0.5)
        + float(i)
    )


@pytest.mark.parametrize("function", [divided, mixed], ids=lambda each: each.__name__)
def test_functions_of_ints(function: Callable[..., float]) -> None:
    made = compiled(function, 1, 1)
    for i, j in itertools.product(WHOLE, WHOLE):
        if j or function is mixed:
            assert bits(made(i, j)) == bits(function(i, j)), (i, j)


LIBRARY = [
    "sqrt", "fabs", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "exp",
    "expm1", "log", "log10", "log1p",
]  # fmt: skip


def test_functions_of_the_library(tmp_path: Path) -> None:
    """Python calls the same ones."""
    values = [
        *CORNERS,
        *np.random.default_rng(3).normal(size=200),
        *np.geomspace(1e-9, 500, 99),
    ]
    text = "".join(f"def {name}(x):\n    return math.{name}(x)\n" for name in LIBRARY)
    module = module_of(text, tmp_path)
    for name in LIBRARY:
        made = compiled(getattr(module, name), 0.5)
        for x in values:
            try:
                expected = getattr(math, name)(x)
            except (ArithmeticError, ValueError):
                continue
            assert bits(made(x)) == bits(expected), (name, x)


RECORD = np.dtype(
    [("x", float), ("n", np.int64), ("rows", float, (2, 3)), ("k", np.int64, (3,))]
)


def through_records(rows: Any, out: Any, first: int) -> None:
    part = rows[first : rows.shape[0]]
    for i in range(part.shape[0]):
        record = part[i]
        line = record.rows[1]
        line[2] += record.x
        record.x *= 2.0
        record.k[1], record.k[2] = record.k[2], record.n
        record.n += 1
        for j in range(out.shape[1]):
            out[i, j] = record.rows[0, j] - line[j] + record.k[j]
    row = out[0]
    row[0] += changed(row)


def changed(row: Any) -> float:
    row[0] = 5.0
    return 1.0


def test_records_rows_and_arrays() -> None:
    rows = np.zeros(4, RECORD)
    noise = np.random.default_rng(1)
    rows["x"], rows["n"] = noise.normal(size=4), noise.integers(9, size=4)
    rows["rows"], rows["k"] = noise.normal(size=(4, 2, 3)), noise.integers(9, size=(4, 3))
    both = [(rows.copy().view(np.recarray), np.zeros((4, 3))) for _ in range(2)]
    compiled(through_records, *both[0], 1, result=None)(*both[0], 1)
    through_records(*both[1], 1)
    assert both[0][0].tobytes() == both[1][0].tobytes()
    assert np.array_equal(both[0][1], both[1][1])
    assert both[1][1].any()


def test_known_branches_are_not_looked_at_and_functions_may_stand_within_others() -> None:
    size = 3

    def outer(x: float) -> float:
        if size == 2:
            return [x][0]  # not of the language
        return x * size

    assert compiled(outer, 1.0)(2.0) == outer(2.0) == 6.0
    assert compiled(lambda x: 2.0 * x + size, 1.0)(0.5) == 4.0


def two_of(one: tuple[float, float], pair: Pair) -> float:
    return one[0] - pair.two


def test_tuples_from_outside() -> None:
    assert compiled(two_of, (1.0, 2.0), Pair(1.0, 2.0))((4.0, 0.0), Pair(9.0, 1.0)) == 3.0


FUNCTIONS = {False: 60, True: 3000}


@pytest.mark.parametrize("long", [False, pytest.param(True, marks=pytest.mark.long)])
def test_random_functions(long: bool, tmp_path: Path) -> None:
    tried = []

    @settings(
        max_examples=FUNCTIONS[long], deadline=None, database=None, derandomize=not long
    )
    @given(st.integers(0, 2**32))
    def one(seed: int) -> None:
        random = Random(seed)  # noqa: S311 -- no secret
        text = random_function(random)
        module = module_of(text, tmp_path)
        try:
            made = compiled(module.f, 1.0, 1.0, 1, 1)
        except NotInLanguage as error:
            raise AssertionError(text) from error
        for _ in range(12):
            x, y = (random.choice([*CORNERS, random.gauss(0.0, 2.0)]) for _ in range(2))
            i, j = (random.choice(WHOLE[:-1]) for _ in range(2))
            try:
                expected = module.f(x, y, i, j)
            except (ArithmeticError, ValueError):
                continue
            tried.append(text)
            assert bits(made(x, y, i, j)) == bits(expected), f"{text}\n{(x, y, i, j)}"

    one()
    assert len({*tried}) > FUNCTIONS[long] / 2
