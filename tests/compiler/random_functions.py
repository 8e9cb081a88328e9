"""Random functions of the compiler's language, as text."""

from __future__ import annotations

from random import Random

FLOATS, INTS = ("x", "y", "a", "b"), ("i", "j", "k")
NUMBERS = ("0.0", "-0.0", "1.5", "-2.0", "1e-3", "math.inf", "3")
SIGNS = ("<", "<=", ">", ">=", "==", "!=")
HELPERS = """
def pick(x: float, y: float, i: int) -> float:
    if i > 1:
        return x - y
    if x > y:
        return y
    return float(i)


def both(x: float, i: int) -> tuple[float, int]:
    return 0.5 * x, i + 1


"""


def number(r: Random, deep: int) -> str:
    """An expression that is a float, or an int where one may stand."""
    if deep <= 0:
        return r.choice([*FLOATS, *FLOATS, *NUMBERS, *INTS])
    one, two = number(r, deep - 1), number(r, deep - 2)
    return r.choice([
        lambda: f"({one} {r.choice('+-*')} {two})",
        lambda: f"({one} / {two})",
        lambda: f"(-{one})",
        lambda: f"({one} if {test(r, deep - 1)} else {two})",
        lambda: f"{r.choice(['min', 'max'])}({one}, {two})",
        lambda: f"abs({one})",
        lambda: f"math.{r.choice(['fabs', 'cos', 'atan', 'tanh'])}({one})",
        lambda: f"math.sqrt(abs({one}))",
        lambda: f"math.copysign({one}, -1.0 if {two} < 0.0 else 1.0)",
        lambda: f"pick({one}, {two}, {whole(r, deep - 1)})",
        lambda: f"both({one}, {whole(r, deep - 2)})[0]",
        lambda: f"({one}, {two}, 1.0)[{r.randrange(3)}]",
        lambda: f"(1.0 * {whole(r, deep - 1)})",
    ])()  # fmt: skip


def whole(r: Random, deep: int) -> str:
    """An expression that is an int."""
    if deep <= 0:
        return r.choice([*INTS, "2", "-3", "1"])
    one, two = whole(r, deep - 1), whole(r, deep - 2)
    return r.choice([
        lambda: f"(({one} {r.choice('+-*')} {two}) % 11)",
        lambda: f"({one} // {r.choice(['3', '-2', two])})",
        lambda: f"({one} % {r.choice(['5', '-4'])})",
        lambda: f"({one} if {test(r, deep - 1)} else {two})",
        lambda: f"({one} {r.choice('&|')} {two})",
        lambda: f"{r.choice(['min', 'max'])}({one}, {two})",
        lambda: f"abs({one})",
        lambda: f"both(x, {one})[1]",
    ])()  # fmt: skip


def test(r: Random, deep: int) -> str:
    """An expression that is a bool."""
    if deep <= 0:
        return r.choice(["(x > y)", "(a <= b)", "(i == j)", "(k != 2)", "True"])
    one, two = test(r, deep - 1), test(r, deep - 2)
    return r.choice([
        lambda: f"({number(r, deep - 1)} {r.choice(SIGNS)} {number(r, 1)})",
        lambda: f"({r.choice(FLOATS)} < {number(r, 0)} <= {r.choice(FLOATS)})",
        lambda: f"({one} and {two})",
        lambda: f"({one} or {two})",
        lambda: f"(not {one})",
        lambda: f"({one} {r.choice('&|')} {two})",
        lambda: f"({whole(r, 1)} in (1, 2, {whole(r, 0)}))",
        lambda: f"math.isfinite({number(r, deep - 1)})",
    ])()  # fmt: skip


test.__test__ = False  # type: ignore[attr-defined]


def statement(r: Random, deep: int, *, looped: bool) -> list[str]:  # noqa: C901, PLR0911
    """A statement, over several lines."""
    kinds = ["float", "int", "changed", "two", "swap"]
    kinds += ["if", "if", "for", "tuple", "while"] if deep > 0 else []
    kinds += ["leave", "skip", "break"] if looped else []
    kind = r.choice(kinds)
    body: list[str] = []
    if kind in {"if", "for", "tuple", "while"}:
        inside = looped or kind in {"for", "while"}
        body = [f"    {line}" for line in block(r, deep - 1, looped=inside)]
    if kind == "float":
        return [f"{r.choice(FLOATS)} = {number(r, 3)}"]
    if kind == "int":
        return [f"{r.choice(INTS)} = {whole(r, 2)}"]
    if kind == "changed":
        return [f"{r.choice(FLOATS)} {r.choice('+-*')}= {number(r, 2)}"]
    if kind == "two":
        return [
            f"{r.choice(FLOATS)}, {r.choice(INTS)} = both({number(r, 1)}, {whole(r, 1)})"
        ]
    if kind == "swap":
        return ["a, b = b, a"]
    if kind == "if":
        other = [f"    {line}" for line in block(r, deep - 1, looped=looped)]
        return [
            f"if {test(r, 2)}:",
            *body,
            *(["else:", *other] if r.random() < 0.5 else []),
        ]
    if kind == "for":
        step = r.choice(["", ", 1", ", 2", ", -1"])
        ends = f"{whole(r, 1)}, {whole(r, 1)}" if step else r.choice(["4", "abs(i) % 5"])
        return [f"for k in range({ends}{step}):", *body]
    if kind == "tuple":
        return [f"for b in ({number(r, 1)}, a, {number(r, 0)}):", *body]
    if kind == "while":
        n = f"n{deep}"  # of its own: loops end
        return [f"{n} = 0", f"while {n} < 5 and {test(r, 1)}:", f"    {n} += 1", *body]
    if kind == "leave":
        return [f"if {test(r, 1)}:", f"    return {number(r, 1)}"]
    return [f"if {test(r, 1)}:", "    continue" if kind == "skip" else "    break"]


def block(r: Random, deep: int, *, looped: bool) -> list[str]:
    """Some statements."""
    return [
        line
        for _ in range(r.randrange(1, 4))
        for line in statement(r, deep, looped=looped)
    ]


def random_function(r: Random) -> str:
    """A module with a function `f` of two floats and two ints."""
    lines = ["a, b, k = 1.0, x, 0"]
    for _ in range(r.randrange(2, 6)):
        lines += statement(r, 2, looped=False)
    lines.append(f"return {number(r, 2)} + a + b + k")
    return HELPERS + "def f(x, y, i, j):\n" + "".join(f"    {line}\n" for line in lines)
