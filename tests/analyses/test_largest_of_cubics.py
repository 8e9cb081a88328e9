"""Largest values of cubics through samples with rates, against the cubics themselves."""

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline

from rpscli.analyses.fixed_base import largest_of_cubics

STEP = 0.02


@pytest.mark.parametrize("steepness", [0.0, 1.0, 30.0, 1e3])
def test_no_step_that_holds_the_largest_value_is_passed_over(steepness):
    rng = np.random.default_rng(61)
    for _ in range(200):
        values = rng.standard_normal(12)
        rates = steepness / STEP * rng.standard_normal(12)
        cubic = CubicHermiteSpline(STEP * np.arange(12), values, rates)
        turns = cubic.derivative().roots(extrapolate=False)
        turns = turns[np.isfinite(turns)]  # NaN stands for a step of slope zero
        at = np.concatenate((cubic(turns), values))
        # Rounding of polynomials whose terms are `steepness` times their values.
        error = 1e-12 * (1.0 + steepness)
        assert largest_of_cubics(values, rates, STEP) == pytest.approx(
            abs(at).max(), abs=error
        )


def test_a_cubic_passes_its_ends_by_four_twenty_sevenths_of_its_rate():
    assert largest_of_cubics(np.zeros(2), np.array([1.0, 0.0]), STEP) == pytest.approx(
        4.0 / 27.0 * STEP, rel=1e-14
    )


def test_what_is_not_finite_is_said():
    assert np.isnan(largest_of_cubics(np.array([0.0, np.nan, 1.0]), np.zeros(3), STEP))
