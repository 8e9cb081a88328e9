"""Functions of numbers: those of `math` and of Python that processors, LLVM or C's
library have.

`fma` and `call_at` are what every program may call beside them.
"""

from __future__ import annotations

import ast
import math
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np

from rpscli.compiler.values import (
    BOOL,
    DOUBLE,
    INT,
    Code,
    Kind,
    Known,
    Number,
    Value,
    elements_of,
    is_number,
    joined,
    kind_of,
    refuse,
)


def fma(a: float, b: float, c: float) -> float:
    """The sum a b + c, rounded once: in machine code one instruction,
    in Python the same number.
    """
    if (there := getattr(math, "fma", None)) is not None:  # Python 3.13
        return float(there(a, b, c))
    plain = float(a) * float(b) + float(c)
    if not math.isfinite(plain):
        return plain
    return float(Fraction(float(a)) * Fraction(float(b)) + Fraction(float(c))) or plain


AT: dict[int, Callable[..., float]] = {}
"""What Python calls in place of the code at an address."""


def call_at(address: int, numbers: tuple[float, ...]) -> float:
    """Call a function of doubles by its address."""
    return float(AT[int(address)](*numbers))


def known(function: Callable[..., Any], *arguments: Value) -> Known | None:
    """Result of Python for known numbers; None if they are not, or if it raises."""
    given = [
        each.value
        for each in arguments
        if isinstance(each, Known) and is_number(each.value)
    ]
    if len(given) < len(arguments):
        return None
    try:
        return Known(function(*given))
    except (ArithmeticError, ValueError):
        return None


def two(body: Code, instruction: str, kind: str, one: Value, other: Value) -> str:
    """An instruction of two numbers of a kind."""
    x = body.number(one, kind)
    y = body.number(other, kind)
    return body.get(f"{instruction} {kind} {x}, {y}")


def whole_division(body: Code, of: type, x: str, y: str) -> Number:
    """Division of ints towards minus infinity, or its rest; by zero as by 1."""
    turns = body.get(f"icmp eq i64 {y}, -1")
    none = body.get(f"icmp eq i64 {y}, 0")
    either = body.get(f"or i1 {turns}, {none}")
    sign = body.get(f"select i1 {turns}, i64 -1, i64 1")
    x = body.get(f"mul i64 {x}, {sign}")
    y = body.get(f"select i1 {either}, i64 1, i64 {y}")  # else the process might end
    rest = body.get(f"srem i64 {x}, {y}")
    signs = body.get(f"xor i64 {rest}, {y}")
    differ = body.get(f"icmp slt i64 {signs}, 0")
    left = body.get(f"icmp ne i64 {rest}, 0")
    below = body.get(f"and i1 {differ}, {left}")
    if of is ast.Mod:
        more = body.get(f"select i1 {below}, i64 {y}, i64 0")
        return Number(INT, body.get(f"add i64 {rest}, {more}"))
    quotient = body.get(f"sdiv i64 {x}, {y}")
    one = body.get(f"zext i1 {below} to i64")
    return Number(INT, body.get(f"sub i64 {quotient}, {one}"))


INTRINSICS = {
    "sqrt": ("sqrt", 1), "fabs": ("fabs", 1), "absolute": ("fabs", 1), "ceil": ("ceil", 1),
    "floor": ("floor", 1), "copysign": ("copysign", 2), "fma": ("fma", 3),
}  # fmt: skip
"""Functions of `math` and numpy that processors have: their names
in LLVM, how many numbers."""

EXTERNALS = {
    "sin": 1, "cos": 1, "tan": 1, "asin": 1, "acos": 1, "atan": 1, "atan2": 2, "sinh": 1, "cosh": 1,
    "tanh": 1, "exp": 1, "expm1": 1, "log": 1, "log10": 1, "log1p": 1, "pow": 2, "fmod": 2,
}  # fmt: skip
"""Functions of C's library, which Python calls as well, and
how many numbers they take."""


def intrinsic(body: Code, name: str, arguments: list[Value]) -> Number:
    """Call a function that LLVM has."""
    given = ", ".join(f"double {body.number(each, DOUBLE)}" for each in arguments)
    return Number(DOUBLE, body.get(f"call double @llvm.{name}.f64({given})"))


def external(body: Code, name: str, arguments: list[Value]) -> Number:
    """Call a function of C's library; LLVM is not to replace it by
    what rounds in another way.
    """
    given = ", ".join(f"double {body.number(each, DOUBLE)}" for each in arguments)
    return Number(DOUBLE, body.get(f"call double @{name}({given}) nobuiltin"))


def least_or_most(body: Code, function: Any, arguments: list[Value]) -> Value:
    """`min` or `max` as Python has them: the first, unless a later one is beyond it."""
    kind: Kind = kind_of(arguments[0])
    for each in arguments:
        kind = joined(kind, kind_of(each))
    if not isinstance(kind, str):
        refuse("`min` and `max` are of numbers")
    test = ("fcmp o" if kind == DOUBLE else "icmp s") + (
        "lt" if function is min else "gt"
    )
    kind = INT if kind == BOOL else kind
    found = body.number(arguments[0], kind)
    for each in arguments[1:]:
        other = body.number(each, kind)
        beyond = body.get(f"{test} {kind} {other}, {found}")
        found = body.get(f"select i1 {beyond}, {kind} {other}, {kind} {found}")
    return Number(kind, found)


def size(body: Code, function: Any, arguments: list[Value]) -> Value:
    """`abs`."""
    (value,) = arguments
    if kind_of(value) == DOUBLE:
        return intrinsic(body, "fabs", arguments)
    whole = body.number(value, INT)
    negative = body.get(f"icmp slt i64 {whole}, 0")
    turned = body.get(f"sub nsw i64 0, {whole}")
    return Number(INT, body.get(f"select i1 {negative}, i64 {turned}, i64 {whole}"))


def converted(body: Code, function: Any, arguments: list[Value]) -> Value:
    """`bool`, `int` or `float` of a number."""
    kind = {bool: BOOL, int: INT, float: DOUBLE}[function]
    return Number(kind, body.number(arguments[0], kind))


def whole(body: Code, function: Any, arguments: list[Value]) -> Value:
    """`math.floor` and `math.ceil`, which are ints."""
    return Number(INT, body.number(intrinsic(body, function.__name__, arguments), INT))


def finite(body: Code, function: Any, arguments: list[Value]) -> Value:
    """`math.isfinite`, `isinf` and `isnan`."""
    name = intrinsic(body, "fabs", arguments).name
    test = {"isfinite": "olt", "isinf": "oeq", "isnan": "uno"}[function.__name__]
    infinity = body.number(Known(math.inf), DOUBLE)
    return Number(BOOL, body.get(f"fcmp {test} double {name}, {infinity}"))


def at_address(body: Code, function: Any, arguments: list[Value]) -> Value:
    """`call_at`."""
    address, numbers = arguments
    place = body.get(f"inttoptr i64 {body.number(address, INT)} to ptr")
    given = ", ".join(
        f"double {body.number(each, DOUBLE)}" for each in elements_of(numbers) or ()
    )
    return Number(DOUBLE, body.get(f"call double {place}({given})"))


BUILT_IN: dict[Any, Callable[[Code, Any, list[Value]], Value]] = {
    **dict.fromkeys((min, max), least_or_most),
    abs: size,
    **dict.fromkeys((bool, int, float), converted),
    **dict.fromkeys((math.ceil, math.floor), whole),
    **dict.fromkeys((math.isfinite, math.isinf, math.isnan), finite),
    call_at: at_address,
}


TAKEN: dict[Any, Any] = {min: range(2, 99), max: range(2, 99), call_at: {2}}
"""How many arguments functions take that do not take one."""


def call_of_numbers(
    body: Code, function: Any, given: list[Value], by_name: dict[str, Value]
) -> Value:
    """The call of a function that processors, LLVM or C's library have."""
    name = getattr(function, "__name__", "")
    if by_name or not given:
        refuse(f"`{name}` is given numbers, without names")
    if (found := known(function, *given)) is not None:
        return found
    if function in BUILT_IN:
        if len(given) not in TAKEN.get(function, {1}):
            refuse(f"`{name}` of {len(given)} numbers")
        return BUILT_IN[function](body, function, given)
    inside, takes = INTRINSICS.get(name, ("", 0))
    if takes == len(given):
        return intrinsic(body, inside, given)
    if EXTERNALS.get(name) == len(given) and not isinstance(function, np.ufunc):
        return external(body, name, given)  # numpy rounds these in its own way
    refuse(
        f"`{name}` of {len(given)} numbers: write it with functions that LANGUAGE.md"
        " lists"
    )
