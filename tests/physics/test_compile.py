"""Functions of the kernels: plain Python when Python calls them, machine code in a kernel."""

from __future__ import annotations

import inspect
from typing import Any

import numba
import numpy as np
from paper_structures import Array, needs_compiled_kernels

from rpscli.physics.compile import OPTIONS, compiled, fma, kernel
from rpscli.physics.state import LANES, STATE, Record, records
from rpscli.physics.step import accelerate


@compiled
def power(x: float, times: int) -> float:
    """x to a whole number."""
    result = 1.0
    for _ in range(times):
        result *= x
    return result


@compiled
def add_powers(x: Array, total: Array) -> None:
    """Adds x^2 and x^3."""
    for i in range(len(x)):
        total[i] += power(x[i], 2) + power(x[i], 3)


@kernel
def four_times(x: Array, total: Array) -> None:
    """Adds them four times."""
    for _ in range(4):
        add_powers(x, total)


@compiled
def raise_by_sums(b: Array, lanes: int) -> None:
    """Raises row 2 to the sum of rows 0 and 1 where row 0 is positive."""
    for lane in range(lanes):
        total = b[0, lane] + b[1, lane] if b[0, lane] > 0.0 else 0.0
        b[2, lane] = max(b[2, lane], total)


@kernel
def raise_all(b: Array) -> None:
    """In as many lanes as the kernels have."""
    raise_by_sums(b, LANES)


def accelerate_all(state: Record) -> None:
    """The laws of all lanes."""
    accelerate(state[0], 0.5)


@kernel
def fused(a: float, b: float, c: float) -> float:
    """In machine code."""
    return fma(a, b, c)


X = np.linspace(-2.0, 2.0, 9)


def three_rows() -> Array:
    """Two of numbers, and one to write."""
    return np.array([np.linspace(-1.0, 2.5, LANES), np.linspace(2.0, -1.5, LANES), np.zeros(LANES)])


def code_of(function: Any, argument: Any) -> str:
    """Optimised code of a function for this processor."""
    fresh: Any = numba.njit(function, **OPTIONS)
    fresh(argument)
    (code,) = fresh.inspect_llvm().values()
    return str(code)


def test_without_a_kernel_they_run_as_python() -> None:
    assert inspect.isfunction(power)
    assert power(3.0, 4) == 81.0
    total = np.zeros(9)
    add_powers(X, total)
    assert total.tolist() == (X**2 + X**3).tolist()


def test_a_kernel_calls_them_compiled() -> None:
    total = np.zeros(9)
    four_times(X, total)
    np.testing.assert_allclose(total, 4.0 * (X**2 + X**3), rtol=1e-14)


@needs_compiled_kernels
def test_a_kernel_is_machine_code() -> None:
    four_times(X, np.zeros(9))
    overloads: Any = four_times
    assert len(overloads.signatures) == 1


def test_a_loop_over_lanes_does_what_it_says() -> None:
    b = three_rows()
    total = np.where(b[0] > 0.0, b[0] + b[1], 0.0)
    raise_all(b)
    np.testing.assert_array_equal(b[2], np.maximum(total, 0.0))


@needs_compiled_kernels
def test_loops_over_lanes_become_vector_instructions() -> None:
    for ways in (1, 2):
        code = code_of(accelerate_all, records(STATE, 1, ways, LANES))
        assert "x double>" in code
        assert "= load double" not in code  # nothing is left that goes lane by lane


def test_a_product_and_a_sum_are_rounded_once() -> None:
    for a, b, c in ((1.0 + 2.0**-30, 1.0 - 2.0**-30, -1.0), (0.1, 10.0, -1.0), (3.0, 4.0, 5.0)):
        assert fma(a, b, c) == fused(a, b, c)
    assert fused(1.0 + 2.0**-30, 1.0 - 2.0**-30, -1.0) == -(2.0**-60)
