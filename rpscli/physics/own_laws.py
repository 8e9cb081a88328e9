"""Laws of other packages: compiled for themselves, called by the kernel
through their addresses.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cache
from typing import Any

from rpscli.compiler.mathematics import AT
from rpscli.compiler.values import DOUBLE, NotInLanguage
from rpscli.errors import PluginError, words_of
from rpscli.physics.compile import LAW_NUMBERS
from rpscli.physics.kernels import are_interpreted
from rpscli.registry import GUARD, owner_of

Law = Callable[..., float]

NAME = "law"
REFUSED = "law.refused"


@dataclass(eq=False)
class InterpretedLaw:
    """A law that runs as Python: what it raises is no number, as in machine code."""

    function: Law
    taken: int
    refused: list[float] = field(default_factory=list)

    def __call__(self, *numbers: float) -> float:
        """Value that the law gives."""
        try:
            found = float(self.function(*numbers[: self.taken]))
        except KeyboardInterrupt:
            raise
        except BaseException:  # noqa: BLE001 -- of others
            found = math.nan
        if not math.isfinite(found) and math.isfinite(sum(map(abs, numbers))):
            self.refused = [1.0, *numbers]
        return found

    def numbers_at(self, _name: str, _count: int) -> list[float]:
        """Numbers that it was given where it gave no number."""
        return self.refused or [0.0]


def plain(function: Law) -> Law:
    """A law as its package wrote it: without the guard that
    calls from Python go through.
    """
    while getattr(function, GUARD, False):
        function = vars(function)["__wrapped__"]
    return getattr(function, "py_func", function)  # of another compiler


@cache
def loaded(function: Law, taken: int) -> Any:
    """A law of so many numbers as machine code, or as Python; raises PluginError."""
    if are_interpreted():
        return InterpretedLaw(function, taken)
    from rpscli.compiler.functions import Program
    from rpscli.compiler.objects import Entry, machine_code

    program = Program()
    try:
        program.add_watched(function, taken, LAW_NUMBERS, NAME)
    except NotInLanguage as error:
        place = f"{function.__module__}.{function.__qualname__}"
        said = ": ".join(reversed(error.args))
        raise PluginError(f"{place} cannot be compiled: {said}") from None
    return Entry(
        machine_code(program.text()), NAME, [DOUBLE] * LAW_NUMBERS, DOUBLE, REFUSED
    )


@cache
def address_of(function: Law, taken: int) -> int:
    """Where a law of so many numbers stands while this process lasts."""
    law = loaded(plain(function), taken)
    address = law.address if hasattr(law, "address") else 1 + len(AT)
    AT[address] = law
    return int(address)


def said_of(function: Law, taken: int) -> str:
    """Words of a law, or the value it gave, where it last gave no finite number; empty if
    it always did.

    It is asked once more, in Python, by what it was given then.
    """
    refused, *given = loaded(plain(function), taken).numbers_at(REFUSED, 1 + taken)
    if not refused:
        return ""
    at = f"{function.__name__}({numbers(given[:taken])})"
    owner = owner_of(function, f"{function.__module__}.{function.__qualname__}")
    try:
        said = f"gives {plain(function)(*given[:taken])}"
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # noqa: BLE001 -- of others
        said = words_of(error)
    return f"{owner}: {at}: {said}"


def numbers(given: Sequence[float]) -> str:
    """Numbers in a message."""
    return ", ".join(f"{each:.6g}" for each in given)
