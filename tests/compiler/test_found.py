# ruff: noqa: E501
"""What readers of the page found: once wrong without a word, now as Python has it or refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from rpscli.compiler.values import NotInLanguage

from .written import bits, compiled, module_of

AS_PYTHON = {
    "left by break": "def f(a):\n    for x in (1.0, 2.0, 3.0):\n        if x > a:\n            break\n"
    "    return x\n",
    "set in one pass": "def f(a):\n    for x in (1.0, 2.0, 3.0):\n        if x < a:\n            y = x\n"
    "    return y\n",
    "of pairs": "def f(a):\n    for x, y in ((1.0, 2.0), (3.0, 4.0)):\n        if x > a:\n"
    "            break\n    return 10.0 * x + y\n",
    "known among others": "def f(a):\n    for x in (a, 2, 3.0):\n        if x == 2:\n            break\n"
    "    return x / 2\n",
    "a plus sign": "def f(a):\n    return +a * +2.0\n",
    "words": "S = 'up'\ndef f(a):\n    return a if S == 'up' and S in ('up', 'x') else -a\n",
    "no pass": "def f(a):\n    while False:\n        a = [a]\n    return a\n",
}


@pytest.mark.parametrize("text", AS_PYTHON.values(), ids=[*AS_PYTHON])
def test_as_python(text: str, tmp_path: Path) -> None:
    function = module_of(text, tmp_path).f
    made = compiled(function, 1.5)
    for a in (1.5, 2.5):
        assert bits(made(a)) == bits(function(a))


REFUSED = {
    "two lambdas": "g, h = lambda x: x + 1.0, lambda x: x * 3.0\ndef f(a):\n    return h(a)\n",
    "decorated": "import functools\ndef g(a):\n    return a\n@functools.wraps(g)\ndef h(a):\n"
    "    return 2.0 * g(a)\ndef f(a):\n    return h(a)\n",
    "names only": "m = 100.0\ndef g(x, *, m=3.0):\n    return x * m\ndef f(a):\n    return g(a)\n",
    "places only": "x = 1.0\ndef g(x, /):\n    return x\ndef f(a):\n    return g(a)\n",
    "more": "r = (1.0,)\ndef g(x, *r):\n    return x * r[0]\ndef f(a):\n    return g(a)\n",
    "two classes": "from typing import NamedTuple\nclass P(NamedTuple):\n    x: float\n    y: float\n"
    "class Q(NamedTuple):\n    y: float\n    x: float\ndef f(a):\n"
    "    p = P(1.0, a) if a > 1.0 else Q(3.0, a)\n    return p.x\n",
    "derived": "from typing import NamedTuple\nclass P(NamedTuple):\n    x: float\nclass Q(P):\n"
    "    def __new__(cls, x):\n        return super().__new__(cls, 2.0 * x)\ndef f(a):\n"
    "    return Q(a).x\n",
    "numpy's exp": "def f(a):\n    return np.exp(a)\n",
    "two bools": "def f(a):\n    return float((a > 1.0) + (a > 2.0))\n",
    "narrow": "U = np.float32(1.1)\ndef f(a):\n    return a * U\n",
    "narrow arrays": "U = np.array([1, 2], dtype=np.int8)\ndef f(a):\n    return a * U[int(a)]\n",
    "own before": "K = 2.0\ndef f(a):\n    x = K\n    K = a\n    return x\n",
    "large": "K = 2**64\ndef f(a):\n    return float(int(a) < K)\n",
    "beyond": "T = (1.0, 2.0)\ndef f(a):\n    return a * T[2]\n",
    "one number": "def f(a):\n    return min(a)\n",
    "two numbers": "def f(a):\n    return math.sqrt(a, 2.0)\n",
    "a float in a range": "def f(a):\n    for i in range(a):\n        a = 2.0 * i\n    return a\n",
    "tuples by a variable": "T = ((1.0, 2.0), (3.0, 4.0))\ndef f(a):\n    return T[int(a)][1]\n",
    "an array as a test": "P = np.ones(2)\ndef f(a):\n    return a if P else 1.0\n",
    "sums of arrays": "P = np.ones(2)\ndef f(a):\n    return (P + a)[0]\n",
    "too deep": "def f(a):\n    return " + "a + " * 900 + "a\n",
    "no double": "def f(a):\n    return P\nP = 'text'\n",
}


@pytest.mark.parametrize("text", REFUSED.values(), ids=[*REFUSED])
def test_refused(text: str, tmp_path: Path) -> None:
    with pytest.raises(NotInLanguage):
        compiled(module_of(text, tmp_path).f, 1.5)


def divided(n: np.ndarray, out: np.ndarray) -> None:
    out[0] = int(n[0]) // int(n[1])
    out[1] = int(n[0]) % int(n[1])


def test_no_division_of_ints_ends_the_process() -> None:
    out = np.zeros(2)
    made = compiled(divided, np.ones(2), out, result=None)
    for a, b in ((7.0, -1.0), (1e300, -1.0), (-(2.0**63), -1.0), (5.0, 0.0)):
        made(np.array([a, b]), out)
        if abs(a) < 2**53 and b:
            assert out.tolist() == [a // b, a % b]


def test_functions_are_asked_for_doubles_or_nothing() -> None:
    def whole(a: float) -> int:
        return 3

    assert compiled(whole, 1.0)(1.0) == 3.0  # an int would be read from another register
