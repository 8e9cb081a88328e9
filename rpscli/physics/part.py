"""What kernels are made of: parts, merged into their callers, and routines, which stay functions.

A part costs no call, and the compiler sees it in its place. A routine is optimised by itself and
never merged, so that the code of a hot loop does not depend on what stands around its call. Neither
is compiled before a kernel that calls it is: see `rpscli.physics.linking`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba
from numba.core import types
from numba.core.registry import CPUDispatcher

from rpscli.physics.jit import OPTIONS
from rpscli.physics.linking import KIND, KernelCompiler

Function = TypeVar("Function", bound=Callable[..., Any])


def part(function: Function) -> Function:
    """Merge into each caller: for steps of a longer function, and for what lanes loop over."""
    return _translated(function, "part")


def routine(function: Function) -> Function:
    """Keep as a function: for hot loops, and for what is called from several places."""
    return _translated(function, "routine")


def lane_routine(function: Function) -> Function:
    """Keep as a function whose loops over lanes are to become vector instructions."""
    return _translated(function, "lane routine")


def _translated(function: Function, kind: str) -> Function:
    """Compile with every kernel that calls it; called from Python it runs as Python."""
    if cast("Any", numba.config).DISABLE_JIT:
        return function
    setattr(function, KIND, kind)
    options = {
        "nopython": True,
        "boundscheck": None,
        "forceinline": kind == "part",
        "no_cpython_wrapper": True,
        "no_cfunc_wrapper": True,
        **OPTIONS,
    }
    compiled: Any = Part(function, targetoptions=options, pipeline_class=KernelCompiler)
    return cast("Function", compiled)


class Part(CPUDispatcher):
    """What numba knows of a part."""

    def __call__(self, *arguments: Any) -> Any:
        """Run as Python: nothing of a part can be called but what was merged into a kernel."""
        return self.py_func(*arguments)

    def get_call_template(self, args: Any, kws: Any) -> Any:
        """Compile once for all values of a constant: merging makes them known anyway."""
        plain = tuple(types.unliteral(arg) for arg in args)
        return super().get_call_template(
            plain, {name: types.unliteral(arg) for name, arg in kws.items()}
        )
