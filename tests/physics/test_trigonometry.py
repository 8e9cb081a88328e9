"""Sine and cosine without branches."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from paper_structures import COMPILED

from rpscli.physics.core.series import sine_cosine

ROUNDING = 3.4e-16
"""Three units of the last place below 1."""

LEFT_OUT = (0.5 * math.pi) ** 21 / math.factorial(21)
"""First term of the sine that is left out, where it is largest: 2.6e-16."""

POINTS = 20_001 if COMPILED else 501


@pytest.mark.parametrize(("end", "error"), [(1.4, ROUNDING), (0.5 * math.pi, ROUNDING + LEFT_OUT)])
def test_up_to_a_quarter_of_a_turn(end: float, error: float) -> None:
    for x in np.linspace(0.0, end, POINTS).tolist():
        sine, cosine = sine_cosine(x)
        assert abs(sine - math.sin(x)) <= error, x
        assert abs(cosine - math.cos(x)) <= ROUNDING, x


@given(st.floats(-0.5 * math.pi, 0.5 * math.pi))
def test_odd_and_even(x: float) -> None:
    sine, cosine = sine_cosine(x)
    assert sine_cosine(-x) == (-sine, cosine)


@given(st.floats(-1e-8, 1e-8))
def test_near_zero_they_are_exact(x: float) -> None:
    # x^3/6 and x^2/2 are below half a unit of the last place
    assert sine_cosine(x) == (x, 1.0)


def test_beyond_the_range_that_is_needed_the_error_stays_small() -> None:
    sine, cosine = sine_cosine(math.pi)
    assert abs(sine) < 1e-9
    assert abs(cosine + 1.0) < 1e-9
