"""Marks of the functions that become machine code, and what they may
call beside Python's own.

They are written in the compiler's language (`rpscli/compiler/LANGUAGE.md`) and run as
Python with the same bits.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias, TypeVar

from rpscli.compiler.functions import inlined
from rpscli.compiler.mathematics import call_at, fma

__all__ = ["LAW_NUMBERS", "Numbers", "compiled", "fma", "inlined", "own_law"]

Function = TypeVar("Function", bound=Callable[..., Any])


def compiled(function: Function) -> Function:
    """Mark a function that is compiled with the kernel that calls it."""
    return function


LAW_NUMBERS = 9
"""Numbers that a law of another package is called with; those behind
what it takes are left off."""

Numbers: TypeAlias = tuple[float, float, float, float, float, float, float, float, float]

own_law = call_at
"""Call a law of another package. Addresses differ from process to process: they stand in
records, and machine code on disk knows none."""
