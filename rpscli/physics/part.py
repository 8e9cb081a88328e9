"""What kernels are made of: parts, merged into their callers, and routines, which stay functions.

Of every function that a kernel calls numba makes a library of its own: machine code and an entrance
for Python, all of which is thrown away when the kernel links it. Here both are left out, and what
will be merged is not optimised before, for it will be as a piece of its caller. That halves the
time of compilation. A routine is optimised by itself and never merged, so that the code of a
hot loop does not depend on what stands around its call.

This reaches into numba: a library that leaves out its last stages, and the pass that makes one.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba
from numba.core import types
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import register_pass
from numba.core.registry import CPUDispatcher
from numba.core.typed_passes import NativeLowering

from rpscli.physics.jit import OPTIONS

Function = TypeVar("Function", bound=Callable[..., Any])


def part(function: Function) -> Function:
    """Merge into each caller: for steps of a longer function, and for what lanes loop over."""
    return _translated(function, merge=True)


def routine(function: Function) -> Function:
    """Keep as a function: for hot loops, and for what is called from several places."""
    return _translated(function, merge=False)


def _translated(function: Function, *, merge: bool) -> Function:
    """Compile with every kernel that calls it; called from Python it runs as Python."""
    if cast("Any", numba.config).DISABLE_JIT:
        return function
    options = {
        "nopython": True,
        "boundscheck": None,
        "forceinline": merge,
        "no_cpython_wrapper": True,
        **OPTIONS,
    }
    compiled: Any = Part(function, targetoptions=options, pipeline_class=PartCompiler)
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


class LinkedLibrary(JITCodeLibrary):
    """Code to be linked into that of a kernel, never run by itself."""

    def _optimize_functions(self, ll_module: Any) -> None:
        """Leave functions until the parts that they call are merged into them."""

    def _finalize_final_module(self) -> None:
        """Make no machine code."""
        self._finalize_dynamic_globals()
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:  # noqa: ARG002
        """Tell that there is none."""
        self._ensure_finalized()
        return 0

    @property
    def codegen(self) -> Any:
        """What is told about the function's environment, which only Python objects need."""
        return _Nobody


class PartLibrary(LinkedLibrary):
    """A part: translated, and left at that."""

    def _optimize_final_module(self) -> None:
        """Leave the module for its callers."""


class RoutineLibrary(LinkedLibrary):
    """A routine: optimised with the parts that are merged into it, and kept as a function."""

    def add_ir_module(self, ir_module: Any) -> None:
        """Forbid merging it."""
        for function in ir_module.functions:
            if not function.is_declaration:
                function.attributes.add("noinline")
        super().add_ir_module(ir_module)


class _Nobody:
    @staticmethod
    def set_env(name: str, env: Any) -> None:
        """Take no notice."""


@register_pass(mutates_CFG=True, analysis_only=False)
class PartLowering(NativeLowering):
    """Translation into a `PartLibrary` or a `RoutineLibrary`."""

    _name = "part_lowering"

    def run_pass(self, state: Any) -> bool:
        """Translate."""
        library = PartLibrary if state.flags.forceinline else RoutineLibrary
        state.library = library(state.targetctx.codegen(), state.func_id.func_qualname)
        state.library.enable_object_caching()
        return bool(super().run_pass(state))


class PartCompiler(CompilerBase):
    """numba's compiler with that pass instead of its own."""

    def define_pipelines(self) -> list[Any]:
        """The one pipeline."""
        manager = DefaultPassBuilder.define_nopython_pipeline(self.state)
        manager.passes = [
            (PartLowering if made is NativeLowering else made, why) for made, why in manager.passes
        ]
        manager.finalize()
        return [manager]
