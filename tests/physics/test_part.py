"""Parts and routines: compiled into the kernels that call them, and plain Python without one."""

from __future__ import annotations

import inspect
from typing import Any

import numpy as np
from paper_structures import Array, needs_compiled_kernels

from rpscli.physics.jit import kernel
from rpscli.physics.part import lane_routine, part, routine


@part
def power(x: float, times: int) -> float:
    """x to a whole number."""
    result = 1.0
    for _ in range(times):
        result *= x
    return result


@routine
def add_powers(x: Array, total: Array) -> None:
    """Adds x^2 and x^3."""
    for i in range(len(x)):
        total[i] += power(x[i], 2) + power(x[i], 3)


@kernel
def four_times(x: Array, total: Array) -> None:
    """Adds them four times."""
    for _ in range(4):
        add_powers(x, total)


@lane_routine
def add_rows(b: Array, lanes: tuple[tuple[()], ...]) -> None:
    """Raises row 2 to the sum of rows 0 and 1 where row 0 is positive."""
    L = len(lanes)
    for lane in range(L):
        total = b[lane] + b[L + lane] if b[lane] > 0.0 else 0.0
        b[2 * L + lane] = max(b[2 * L + lane], total)


@kernel
def add_rows_twice(b: Array, lanes: tuple[tuple[()], ...]) -> None:
    """Does it again."""
    add_rows(b, lanes)
    add_rows(b, lanes)


X = np.linspace(-2.0, 2.0, 9)


def compiled_once(function: Any) -> Any:
    """What was made of a function that was compiled for one kind of arguments only."""
    (compiled,) = function.overloads.values()
    return compiled


def compiled_here(kernel: Any) -> Any:
    """What a kernel that was called holds, compiled by this process: the last may have been."""
    inner: Any = inspect.getclosurevars(kernel).nonlocals["compiled"]
    inner.recompile()
    return compiled_once(inner)


def test_without_a_kernel_they_run_as_python() -> None:
    assert power(3.0, 4) == 81.0
    total = np.zeros(9)
    add_powers(X, total)
    assert total.tolist() == (X**2 + X**3).tolist()


def test_a_kernel_calls_them_compiled() -> None:
    total = np.zeros(9)
    four_times(X, total)
    np.testing.assert_allclose(total, 4.0 * (X**2 + X**3), rtol=1e-14)


@needs_compiled_kernels
def test_a_part_is_compiled_once_for_all_constants() -> None:
    four_times(X, np.zeros(9))
    # only the kernel is machine code
    compiled = compiled_here(four_times)
    assert compiled.library.get_pointer_to_function(compiled.fndesc.llvm_func_name) != 0
    compiled = compiled_once(power)
    assert compiled.library.get_pointer_to_function(compiled.fndesc.llvm_func_name) == 0


@needs_compiled_kernels
def test_the_loop_over_lanes_of_a_lane_routine_becomes_vector_instructions() -> None:
    b = np.concatenate([np.linspace(-1.0, 2.5, 8), np.linspace(2.0, -1.5, 8), np.zeros(8)])
    add_rows_twice(b, ((),) * 8)
    total = np.where(b[:8] > 0.0, b[:8] + b[8:16], 0.0)
    np.testing.assert_array_equal(b[16:], np.maximum(total, 0.0))
    compiled_here(add_rows_twice)
    compiled = compiled_once(add_rows)
    (code,) = [
        str(each)
        for each in compiled.library.get_defined_functions()
        if each.name == compiled.fndesc.llvm_func_name
    ]
    assert "x double>" in code
    assert "= load double" not in code  # nothing is left that goes lane by lane
