"""What a kernel calls, compiled as a part of it.

numba makes each compiled function a library of its own: everything below it is linked into it,
optimised and turned into machine code anew. What is only called by a kernel is lowered once here,
and optimised with the kernel that it ends up in: half of the time of a compilation.
"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import LoweringPass, register_pass
from numba.core.typed_passes import AnnotateTypes


class Part(JITCodeLibrary):
    """Code of a function that is linked into others, and never run by itself."""

    @property
    def codegen(self) -> Any:
        """Without an address there is no place for the environment of a function."""
        return SimpleNamespace(set_env=lambda *_: None)

    def get_pointer_to_function(self, name: str) -> int:
        """Return no address."""
        del name
        return 0

    def _optimize_final_module(self) -> None:
        """Leave it to the library that this one is linked into."""

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._finalized = True


@register_pass(mutates_CFG=False, analysis_only=False)
class AsPart(LoweringPass):
    """Have what follows write to a `Part`."""

    _name = "as_part"

    def __init__(self) -> None:
        super().__init__()

    def run_pass(self, state: Any) -> bool:
        """Give the compiler its library."""
        state.library = Part(state.targetctx.codegen(), state.func_id.func_qualname)
        state.library.enable_object_caching()
        return True


class PartCompiler(CompilerBase):
    """numba's compiler of machine code, but for where it writes to."""

    def define_pipelines(self) -> list[Any]:
        """Its passes, and one more."""
        passes = DefaultPassBuilder.define_nopython_pipeline(self.state)
        passes.add_pass_after(AsPart, AnnotateTypes)
        passes.finalize()
        return [passes]
