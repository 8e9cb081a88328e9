"""Roots between turning points."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.polynomial.polynomial import polyfromroots, polyval

from .crossings import NODES, first_crossing, monotone_pieces, through_nodes


def test_a_dip_and_its_return_are_both_found() -> None:
    dip = np.asarray(-polyfromroots([0.5, 0.5 + 1e-4, 2.0]), dtype=np.float64)
    pieces = monotone_pieces(dip)
    end = float(polyval(1.0, dip))
    assert first_crossing(dip, pieces, 0.0, -1, end=end) == pytest.approx(0.5, abs=1e-9)
    assert first_crossing(dip, pieces, 0.0, 1, end=end) == pytest.approx(0.5001, abs=1e-9)


def test_the_start_of_a_step_is_no_crossing() -> None:
    up_and_down = np.array([0.0, 1.0, -4.0])
    pieces = monotone_pieces(up_and_down)
    assert first_crossing(up_and_down, pieces, 0.0, -1, end=-3.0) == pytest.approx(0.25)
    assert first_crossing(up_and_down, pieces, 0.0, 1, end=-3.0) is None


def test_the_polynomial_through_the_nodes_is_exact_to_degree_seven() -> None:
    coefficients = np.random.default_rng(5).normal(size=8)
    found = through_nodes(float(coefficients[0]), np.asarray(polyval(NODES, coefficients)))
    assert found == pytest.approx(coefficients, abs=1e-10)  # condition 1e5 of the fit
    assert found[0] == coefficients[0]
