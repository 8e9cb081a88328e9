"""Machine code: made of a program's text, kept on disk, loaded, called."""

from __future__ import annotations

import ctypes
import hashlib
import os
import tempfile
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext
from functools import cache
from pathlib import Path
from typing import Any

import llvmlite
import llvmlite.binding as llvm
import numpy as np

from rpscli.compiler.values import DOUBLE, INT, POINTER, Kind, types_of

OPTIMISATION = 2
SELECTION = 2
"""Levels of LLVM's passes and of its choice of instructions: higher ones take longer to
compile and no less to run."""

DIGEST = 32
"""Bytes at the end of a file of machine code: the digest of the rest."""


@cache
def processor() -> str:
    """Processor that machine code is made for, and its compiler: elsewhere the code is of
    no use.
    """
    features = llvm.get_host_cpu_features().flatten()
    version = ".".join(map(str, llvm.llvm_version_info))
    triple = llvm.get_process_triple()
    return (
        f"{triple} {llvm.get_host_cpu_name()} {features} {version} {llvmlite.__version__}"
    )


def can_fuse() -> bool:
    """True if the processor has an instruction for `fma`; else a
    function does it, slowly.
    """
    return bool(llvm.get_host_cpu_features().get("fma", True))


@cache
def target_machine() -> Any:
    """LLVM's description of this processor."""
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    target = llvm.Target.from_triple(llvm.get_process_triple())
    return target.create_target_machine(
        cpu=llvm.get_host_cpu_name(),
        features=llvm.get_host_cpu_features().flatten(),
        opt=SELECTION,
        reloc="pic",
        codemodel="default",
    )


def optimised(text: str) -> Any:
    """A program's text as a module of LLVM, optimised; numbers
    round as they are written.
    """
    machine = target_machine()
    module = llvm.parse_assembly(text)
    module.triple = llvm.get_process_triple()
    module.data_layout = str(machine.target_data)
    module.verify()
    options = llvm.create_pipeline_tuning_options(speed_level=OPTIMISATION)
    options.loop_vectorization = True
    options.slp_vectorization = (
        False  # it takes long, and finds nothing that loops have not
    )
    builder = llvm.create_pass_builder(machine, options)
    builder.getModulePassManager().run(module, builder)
    return module


def machine_code(text: str) -> bytes:
    """An object file of a program's text."""
    return bytes(target_machine().emit_object(optimised(text)))


class Kept:
    """Machine code in a folder that only this user may write to; without one, in memory.

    Parameters
    ----------
    folder
        Where it is kept, or None.
    alone
        One process at a time within this; others then find what the first has made.
    not_kept
        Is told why a file could not be written.
    """

    def __init__(
        self,
        folder: Path | None,
        alone: Callable[[Path], AbstractContextManager[None]] = lambda _: nullcontext(),
        not_kept: Callable[[Path, OSError], None] = lambda *_: None,
    ) -> None:
        self.folder = folder
        self.alone = alone
        self.not_kept = not_kept

    def find(self, name: str) -> bytes | None:
        """Machine code of a name, if all of it is there: flipped bits
        would compute, or crash.
        """
        if self.folder is None:
            return None
        try:
            content = self.folder.joinpath(name).read_bytes()
        except OSError:
            return None
        code = content[:-DIGEST]
        digest = content[-DIGEST:]
        return code if hashlib.sha256(code).digest() == digest else None

    def get(self, name: str, make: Callable[[], str]) -> bytes:
        """Machine code of a name, made of the text that `make`
        gives if it is not there.
        """
        if (code := self.find(name)) is not None:
            return code
        if self.folder is None:
            return machine_code(make())
        try:
            with self.alone(self.folder):
                if (code := self.find(name)) is None:
                    code = machine_code(make())
                    self.put(self.folder / name, code)
        except OSError as error:
            self.not_kept(self.folder, error)
        return machine_code(make()) if code is None else code

    def put(self, path: Path, code: bytes) -> None:
        """Write a file: whole, or not at all."""
        handle, written = tempfile.mkstemp(dir=path.parent)
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(code + hashlib.sha256(code).digest())
            Path(written).replace(path)
        except OSError as error:
            Path(written).unlink(missing_ok=True)
            self.not_kept(path.parent, error)


TYPES: dict[str, Any] = {
    POINTER: ctypes.c_void_p,
    INT: ctypes.c_int64,
    DOUBLE: ctypes.c_double,
}


class Entry:
    """A function of a program as Python calls it, without the interpreter's lock.

    Parameters
    ----------
    code
        Machine code of the program.
    name
        Of the function.
    kinds
        Of its arguments.
    result
        DOUBLE, or None where it returns nothing.
    arrays
        Names of arrays of doubles of the program that are read.
    """

    def __init__(
        self,
        code: bytes,
        name: str,
        kinds: Sequence[Kind],
        result: str | None,
        *arrays: str,
    ) -> None:
        target_machine()
        self._jit = llvm.create_lljit_compiler()
        builder = llvm.JITLibraryBuilder().add_object_img(code).add_current_process()
        for each in (name, *arrays):
            builder = builder.export_symbol(each)
        self._library = builder.link(self._jit, name)
        self._addresses = {each: int(self._library[each]) for each in (name, *arrays)}
        self.address = self._addresses[name]
        types = [TYPES[part] for kind in kinds for part in types_of(kind)]
        self._call = ctypes.CFUNCTYPE(TYPES.get(result or ""), *types)(self.address)

    def numbers_at(self, name: str, count: int) -> list[float]:
        """The first numbers of an array of the program."""
        return list((ctypes.c_double * count).from_address(self._addresses[name]))

    def __call__(self, *arguments: Any) -> Any:
        """Call it with numbers, arrays, rows of records, and tuples of such."""
        return self._call(*numbers_of(arguments))


def numbers_of(argument: Any) -> list[Any]:
    """Addresses, sizes and numbers of an argument, in the order of `values.parts`."""
    if isinstance(argument, tuple):
        return [number for each in argument for number in numbers_of(each)]
    if not isinstance(argument, np.ndarray):
        return [argument]
    if not argument.flags.c_contiguous:
        raise ValueError("the numbers of an array must stand one after the other")
    return [argument.ctypes.data, *argument.shape]


def kind_of_argument(argument: Any) -> Kind:
    """The kind of what Python is to call a function with."""
    if isinstance(argument, tuple):
        of = type(argument) if hasattr(argument, "_fields") else None
        return "tuple", tuple(map(kind_of_argument, argument)), of
    if not isinstance(argument, np.ndarray):
        return INT if isinstance(argument, (int, np.integer)) else DOUBLE
    if argument.dtype.fields:
        return "Rows", argument.dtype
    if argument.dtype != np.float64:
        raise TypeError(f"an array of {argument.dtype}: make it float64")
    return "Matrix", argument.ndim
