"""Sines without branches, and what is left of them near zero."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from paper_structures import COMPILED

from rpscli.physics.laws import sines

ROUNDING = 3.4e-16
"""Three units of the last place below 1."""

LEFT_OUT = (0.5 * math.pi) ** 21 / math.factorial(21)
"""First term of the sine that is left out, where it is largest: 2.6e-16."""

POINTS = 20_001 if COMPILED else 501


@pytest.mark.parametrize(("end", "error"), [(1.4, ROUNDING), (0.5 * math.pi, ROUNDING + LEFT_OUT)])
def test_up_to_a_quarter_of_a_turn(end: float, error: float) -> None:
    for x in np.linspace(0.0, end, POINTS).tolist():
        sine, less, _ = sines(x)
        assert abs(sine - math.sin(x)) <= error, x
        assert abs(1.0 - less - math.cos(x)) <= ROUNDING, x


@given(st.floats(-0.5 * math.pi, 0.5 * math.pi))
def test_odd_and_even(x: float) -> None:
    sine, less, excess = sines(x)
    assert sines(-x) == (-sine, less, -excess)


@given(st.floats(1e-9, 0.1))
def test_near_zero_nothing_is_lost(x: float) -> None:
    _, less, excess = sines(x)
    assert less == pytest.approx(2.0 * math.sin(0.5 * x) ** 2, rel=4e-16)
    series = x**3 / 6.0 * (1.0 - x * x / 20.0 * (1.0 - x * x / 42.0 * (1.0 - x * x / 72.0)))
    assert excess == pytest.approx(series, rel=1e-14)


def test_beyond_the_range_that_is_needed_the_error_stays_small() -> None:
    sine, less, _ = sines(math.pi)
    assert abs(sine) < 1e-9
    assert abs(less - 2.0) < 1e-9
