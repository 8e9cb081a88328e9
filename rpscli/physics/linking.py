"""How a kernel is put together from its parts and routines.

numba makes a library of every function: the intermediate code with that of all it calls, optimised
anew in each caller, then machine code and entrances for C and Python, all of which is thrown away
when the kernel has linked it. Of a part only the translation is wanted here, for it is merged into
its callers and optimised there; of a routine the optimised code, added to the kernel as it is.
That, and leaving out passes for features that no kernel has, saves a third of the time; and the
kernels become faster, for loops that are optimised anew in each caller become worse.

This reaches into numba: libraries that leave out stages, and the passes that make them.
"""

from __future__ import annotations

from typing import Any

from llvmlite.binding import create_pass_builder, create_pipeline_tuning_options
from numba.core import untyped_passes as untyped
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder, Flags
from numba.core.compiler_machinery import register_pass
from numba.core.typed_passes import InlineOverloads, NativeLowering, NopythonRewrites

UNUSED = (
    untyped.WithLifting,
    untyped.InlineClosureLikes,
    untyped.RewriteDynamicRaises,
    untyped.MakeFunctionToJitFunction,
    untyped.InlineInlinables,
    untyped.FindLiterallyCalls,
    untyped.LiteralUnroll,
    untyped.LiteralPropagationSubPipelinePass,
    InlineOverloads,
    NopythonRewrites,
)
"""Passes for what no kernel contains: contexts, closures, exceptions, expressions of arrays."""


class Library(JITCodeLibrary):
    """Code that merges parts, is optimised once, and has routines added as they are."""

    def __init__(self, codegen: Any, name: str) -> None:
        super().__init__(codegen, name)
        self.enable_object_caching()
        self.routines: dict[RoutineLibrary, None] = {}
        """All that is called, callers first: what nobody has called yet is not linked."""

    def add_linking_library(self, library: Any) -> None:
        """Remember routines for later; merge everything else."""
        library._ensure_finalized()
        called = [library] if isinstance(library, RoutineLibrary) else []
        for routine in (*called, *getattr(library, "routines", ())):
            self.routines.pop(routine, None)  # behind all that call it
            self.routines[routine] = None
        if not called:
            super().add_linking_library(library)

    def _optimize_functions(self, ll_module: Any) -> None:
        """Leave functions until the parts that they call are merged into them."""

    def _optimize_final_module(self) -> None:
        """Optimise, once and not twice as numba does for the sake of counting references."""
        passes, builder = self._codegen._module_pass_manager(slp_vectorize=True)
        passes.run(self._final_module, builder)


class KernelLibrary(Library):
    """A kernel: the only machine code."""

    def _finalize_final_module(self) -> None:
        """Add the routines."""
        for routine in self.routines:
            self._final_module.link_in(routine._get_module_for_linking(), preserve=True)
        super()._finalize_final_module()


class LinkedLibrary(Library):
    """Code to be linked into that of a kernel, never run by itself."""

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


class LaneRoutineLibrary(RoutineLibrary):
    """A routine that goes over lanes: its loops become vector instructions.

    A loop over a known number of lanes would otherwise be unrolled before the compiler looks for
    vectors, which it then has to find in what is left of it.
    """

    def _optimize_final_module(self) -> None:
        """Vectorise the loops, then optimise."""
        tuning = create_pipeline_tuning_options(speed_level=3)
        tuning.loop_vectorization, tuning.loop_unrolling = True, False
        builder = create_pass_builder(self._codegen._tm, tuning)
        builder.getModulePassManager().run(self._final_module, builder)
        super()._optimize_final_module()


class _Nobody:
    @staticmethod
    def set_env(name: str, env: Any) -> None:
        """Take no notice."""


KIND = "rps_kind"
"""Attribute of a Python function that says which library is made of it."""

LIBRARIES: dict[str, type[Library]] = {
    "kernel": KernelLibrary,
    "part": PartLibrary,
    "routine": RoutineLibrary,
    "lane routine": LaneRoutineLibrary,
}


@register_pass(mutates_CFG=True, analysis_only=False)
class KernelLowering(NativeLowering):
    """Translation into one of these libraries."""

    _name = "kernel_lowering"

    def run_pass(self, state: Any) -> bool:
        """Translate."""
        library = LIBRARIES[getattr(state.func_id.func, KIND, "kernel")]
        state.library = library(state.targetctx.codegen(), state.func_id.func_qualname)
        return bool(super().run_pass(state))


class KernelFlags(Flags):
    """numba's options, which it compares a hundred thousand times while it looks for operators."""

    def __hash__(self) -> int:
        """Nearly all are equal."""
        return hash(KernelFlags)

    def __eq__(self, other: object) -> bool:
        """Compare what was set, and not all that could be."""
        return isinstance(other, KernelFlags) and self._values == other._values


class KernelCompiler(CompilerBase):
    """numba's compiler for kernels, parts and routines."""

    def __init__(self, *context: Any) -> None:
        super().__init__(*context)
        self.state.flags = KernelFlags(self.state.flags)

    def define_pipelines(self) -> list[Any]:
        """The one pipeline."""
        manager = DefaultPassBuilder.define_nopython_pipeline(self.state)
        manager.passes = [
            (KernelLowering if made is NativeLowering else made, why)
            for made, why in manager.passes
            if made not in UNUSED
        ]
        manager.finalize()
        return [manager]
