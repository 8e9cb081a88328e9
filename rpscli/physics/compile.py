"""Compilation of the kernels, cached where the user may write.

numba invalidates a cached function when its own file changes, not when a function that it inlines
from another file does. The cache folder is therefore named after a digest of all kernel sources:
what is found there always belongs to the program that runs.
"""

from __future__ import annotations

import hashlib
import inspect
import math
import re
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from fractions import Fraction
from functools import cache
from io import BytesIO
from pathlib import Path
from typing import Any, TypeAlias, TypeVar, cast

import numba
from numba.core import cgutils, types
from numba.core.caching import IndexDataCacheFile
from numba.extending import intrinsic, overload, register_jitable

from rpscli.errors import PluginError
from rpscli.physics.parts import PartCompiler
from rpscli.physics.state import PADDING
from rpscli.user_cache import VARIABLE, alone_in, is_private, user_cache

Function = TypeVar("Function", bound=Callable[..., Any])

OPTIONS: dict[str, Any] = {
    "nogil": True,
    "error_model": "numpy",
    # Nothing is called from C: without these wrappers a tenth less is to be compiled. The argument
    # of numba.jit is not in its manual.
    "no_cfunc_wrapper": True,
}
PART: dict[str, Any] = {**OPTIONS, "pipeline_class": PartCompiler, "_nrt": False}
"""The same of what is called by kernels alone, and allocates nothing: no references are counted."""

SOURCES = Path(__file__).parent
CONSTANTS = SOURCES.parent / "constants.py"
"""The one module outside of the sources that decides about a kernel: how large its records are."""


def _name_in_code(kind: types.Type) -> tuple[str, tuple[int]]:
    """What a type is called in the names of machine code: the digest of all that it holds."""
    digest = hashlib.sha256(kind.name.encode()).hexdigest()
    return type(kind).__name__, (int(digest[:12], 16),)


# numba (0.68) names a record by a running number of the process, and an array in it without its
# shape. Machine code of two records, compiled by two processes and loaded by a third, then has the
# same names, and the code of one is called for the other: garbage without a warning.
cast("Any", types.Record).mangling_args = property(_name_in_code)


def sources_digest(folder: Path, *others: Path) -> str:
    """Digest of all Python sources below a folder, their places included, and of other files."""
    digest = hashlib.sha256()
    for source in sorted(folder.rglob("*.py")):
        digest.update(str(source.relative_to(folder).as_posix()).encode())
        digest.update(source.read_bytes())
    for other in others:
        digest.update(other.read_bytes())
    return digest.hexdigest()[:16]


@cache
def cache_folder() -> Path | None:
    """Folder of the compiled kernels; None if no place is writable, or others may write there."""
    if (place := user_cache()) is None:
        return None
    folder = place / f"kernels-{sources_digest(SOURCES, CONSTANTS)}"
    try:
        folder.mkdir(mode=0o700, exist_ok=True)
    except OSError:
        return None
    return folder if is_private(folder) else None


class _WithDigests(IndexDataCacheFile):
    """Files that end with the digest of the rest; code of others is not run, but made anew."""

    @contextmanager
    def _open_for_write(self, filepath: str) -> Iterator[BytesIO]:
        content = BytesIO()
        with super()._open_for_write(filepath) as file:
            yield content
            file.write(content.getvalue() + hashlib.sha256(content.getvalue()).digest())

    def _load_index(self) -> dict[Any, str]:
        whole = self._is_whole(self._index_name)
        return dict(super()._load_index()) if whole else {}  # type: ignore[no-untyped-call]

    def _load_data(self, name: str) -> Any:
        if not self._is_whole(name):
            raise OSError(f"{name} is damaged")  # as if it were not there
        return super()._load_data(name)  # type: ignore[no-untyped-call]

    def _is_whole(self, name: str) -> bool:
        with suppress(OSError):
            content = Path(self._cache_path, name).read_bytes()
            return hashlib.sha256(content[:-DIGEST]).digest() == content[-DIGEST:]
        return False


DIGEST = 32
"""Bytes at the end of a file."""


def kernel(function: Function) -> Function:
    """Compile at the first call from Python, without the GIL; keep the machine code on disk.

    It rounds as Python does, in every loop and process: products and sums that are to be rounded
    once are written as `fma`.
    """
    folder, config = cache_folder(), cast("Any", numba.config)
    before, config.CACHE_DIR = config.CACHE_DIR, str(folder or "")
    try:
        made = numba.njit(function, cache=folder is not None, **OPTIONS)
    finally:
        config.CACHE_DIR = before
    if folder is not None and not config.DISABLE_JIT:
        _kept_if_there_is_room(made, folder)
    return cast("Function", made)


def _kept_if_there_is_room(made: Any, folder: Path) -> None:
    """A full disk is no reason to stop: the machine code is in memory when it is to be kept.

    What is loaded again is what was written: flipped bits would end the process, or compute.
    """
    cached = made._cache  # noqa: SLF001 -- numba has no other place for this
    cached._cache_file.__class__ = _WithDigests  # noqa: SLF001
    save = cached.save_overload

    def saved(*compiled_code: Any) -> None:
        try:
            with alone_in(folder):  # numba numbers the files of a function without a lock
                save(*compiled_code)
        except OSError as error:
            _not_kept(folder, error.strerror or str(error))

    cached.save_overload = saved


@cache
def _not_kept(folder: Path, reason: str) -> None:
    """Say it once for all kernels."""
    warnings.warn(
        f"{folder}: {reason}: compiled kernels are not kept there, and compiled each time;"
        f" make room, or name another place in {VARIABLE}",
        stacklevel=2,
    )


def compiled(function: Function) -> Function:
    """Compile with the kernels that call it; called from Python it runs as Python."""
    return register_jitable(**PART)(function)


def inlined(function: Function) -> Function:
    """The same, merged into its callers, whose constants it then knows: for loops over lanes."""
    return register_jitable(forceinline=True, **PART)(function)


def together(alone: Function) -> Callable[[Function], Function]:
    """Take this function in place of another that is not compiled, for more lanes than one."""

    def register(function: Function) -> Function:
        def choose(s: Any, systems: Any) -> Callable[..., Any]:
            del systems
            lanes: int = s.record.fields["x"].type.shape[0] - PADDING
            return function if lanes > 1 else alone

        overload(alone, jit_options=cast("Any", PART), strict=False)(choose)
        return function

    return register


def fma(a: float, b: float, c: float) -> float:
    """The sum a b + c, rounded once: in machine code one instruction, in Python the same number."""
    if (there := getattr(math, "fma", None)) is not None:  # Python 3.13
        return float(there(a, b, c))
    plain = float(a) * float(b) + float(c)
    if not math.isfinite(plain):
        return plain
    return float(Fraction(float(a)) * Fraction(float(b)) + Fraction(float(c))) or plain


@intrinsic
def _fused(_typing: Any, a: Any, b: Any, c: Any) -> Any:
    def code(_context: Any, builder: Any, _signature: Any, given: Any) -> Any:
        return builder.fma(*given)

    return types.float64(a, b, c), code


_sum: Any = _fused
overload(fma, jit_options=cast("Any", PART), strict=False)(
    lambda *_: lambda a, b, c: _sum(a, b, c)  # noqa: PLW0108 -- a function is asked for
)


# Laws of other packages are called by their addresses, which differ from process to process: they
# stand in records, and machine code on disk knows none.

LAW_NUMBERS = 9
"""Numbers that such a law is called with; those behind what it takes are left off."""

Numbers: TypeAlias = tuple[float, float, float, float, float, float, float, float, float]
_laws: dict[int, Callable[..., float]] = {}


def own_law(address: int, given: Numbers) -> float:
    """Call a law of another package by its address."""
    return float(_laws[int(address)](*given))


@intrinsic
def _by_address(_typing: Any, address: Any, given: Any) -> Any:
    def code(context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        tools: Any = cgutils
        number = context.get_value_type(types.float64)
        law = tools.ir.FunctionType(number, [number] * LAW_NUMBERS).as_pointer()
        numbers = [builder.extract_value(arguments[1], i) for i in range(LAW_NUMBERS)]
        return builder.call(builder.inttoptr(arguments[0], law), numbers)

    return types.float64(address, given), code


_call: Any = _by_address
overload(own_law, jit_options=cast("Any", PART), strict=False)(
    lambda *_: lambda address, given: _call(address, given)  # noqa: PLW0108 -- a function is asked for
)


@cache
def address_of(function: Callable[..., float] | None, taken: int) -> int:
    """Where machine code of a law of so many numbers stands while this process lasts; 0 of none.

    It takes a second to make. What a law raises is NaN. Raises PluginError with what numba says.
    """
    if function is None:
        return 0
    plain, no_code = inspect.unwrap(function), cast("Any", numba.config).DISABLE_JIT
    called = plain if no_code else numba.njit(plain, error_model="numpy")

    def law(
        a: float, b: float, c: float, d: float, e: float, f: float, g: float, h: float, i: float
    ) -> float:
        try:
            return called(*(a, b, c, d, e, f, g, h, i)[:taken])  # type: ignore[no-any-return]
        except Exception:  # noqa: BLE001 -- of others
            return math.nan

    made, address = law, 1 + len(_laws)
    if not no_code:
        try:
            made = numba.cfunc(types.float64(*[types.float64] * LAW_NUMBERS))(law)
        except Exception as error:  # noqa: BLE001 -- of others
            lines = [line for line in str(error).splitlines() if not line.startswith("Failed in")]
            place, said = f"{plain.__module__}.{plain.__qualname__}", (lines or [repr(error)])[0]
            raise PluginError(f"{place} cannot be compiled by numba: {said}") from None
        address = int(made.address or 0)
    _laws[address] = made
    return address


_compiled_here: set[str] = set()


def is_compiled(name: str) -> bool:
    """Whether `remember_compiled` was told so by any process that uses the same cache folder."""
    folder = cache_folder()
    return name in _compiled_here or (folder is not None and (folder / _mark(name)).exists())


def remember_compiled(name: str) -> None:
    """Note that the machine code of a kernel is in memory and, if there is a cache, on disk."""
    _compiled_here.add(name)
    if (folder := cache_folder()) is not None:
        try:
            (folder / _mark(name)).touch()
        except OSError as error:
            _not_kept(folder, error.strerror or str(error))


def _mark(name: str) -> str:
    return re.sub(r"\W+", "-", name) + ".compiled"
