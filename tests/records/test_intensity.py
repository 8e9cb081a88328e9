from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rpscli.constants import STANDARD_GRAVITY
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.measures import displacement, intensity_measures, velocity

SAMPLES = st.lists(st.floats(-10.0, 10.0), min_size=2, max_size=30)


def motion(values: list[float], dt: float) -> GroundMotion:
    return GroundMotion(np.array(values), dt, "n", "s", "f")


def test_a_triangle_by_hand() -> None:
    # a = 0, 2, 0 m/s2 at 1 s: v = 0, 1, 2; d adds 2/6 and then 1 + 4/6.
    made = motion([0.0, 2.0, 0.0], 1.0)
    assert velocity(made.acceleration, 1.0).tolist() == [0.0, 1.0, 2.0]
    np.testing.assert_allclose(displacement(made.acceleration, 1.0), [0.0, 1 / 3, 2.0], rtol=1e-15)
    measures = intensity_measures(made)
    assert (measures.pga, measures.pgv) == (2.0, 2.0)
    assert measures.pgd == pytest.approx(2.0, rel=1e-15)
    assert measures.arias == pytest.approx(math.pi / (2 * STANDARD_GRAVITY) * 4.0, rel=1e-15)
    assert measures.cav == 2.0
    # The Husid curve 0, 2, 4 is straight here: 90 % of 2 s.
    assert measures.d5_95 == pytest.approx(1.8, rel=1e-14)


def test_one_sine_against_its_integrals() -> None:
    a, w, count = 3.0, 2.0 * math.pi, 4000
    t = np.arange(count + 1) / count
    made = GroundMotion(a * np.sin(w * t), 1.0 / count, "n", "s", "f")
    measures = intensity_measures(made)
    second_order = (w / count) ** 2  # relative error of straight lines through a sine
    assert measures.pgv == pytest.approx(2.0 * a / w, rel=second_order)
    assert measures.pgd == pytest.approx(a / w, rel=second_order)  # a t/w at t = 1 s
    assert measures.arias == pytest.approx(math.pi / (2 * STANDARD_GRAVITY) * a**2 / 2, rel=1e-12)
    assert measures.cav == pytest.approx(2.0 * a / math.pi, rel=second_order)


@settings(deadline=None)
@given(SAMPLES, st.floats(0.001, 1.0))
def test_integrals_are_those_of_the_straight_lines(values: list[float], dt: float) -> None:
    a = np.array(values)
    fine = np.interp(np.linspace(0, a.size - 1, 1 + 8 * (a.size - 1)), np.arange(a.size), a)
    # Rounding of a sum of some hundred terms, each below 10 m/s2 times the duration (squared).
    span = dt * a.size
    fine_v, fine_d = velocity(fine, dt / 8)[::8], displacement(fine, dt / 8)[::8]
    np.testing.assert_allclose(fine_v, velocity(a, dt), atol=1e-12 * 10 * span)
    np.testing.assert_allclose(fine_d, displacement(a, dt), atol=1e-12 * 10 * span**2)


@settings(deadline=None)
@given(SAMPLES, st.floats(0.001, 1.0), st.floats(0.1, 10.0))
def test_scaling(values: list[float], dt: float, factor: float) -> None:
    one, scaled = (intensity_measures(motion(values, dt).scaled(f)) for f in (1.0, -factor))
    for name, power in {"pga": 1, "pgv": 1, "pgd": 1, "cav": 1, "arias": 2}.items():
        expected = getattr(one, name) * factor**power
        assert getattr(scaled, name) == pytest.approx(expected, rel=1e-12, abs=1e-300)
    assert 0.0 <= scaled.d5_95 <= dt * (len(values) - 1)


def test_a_motion_of_zeros_measures_nothing() -> None:
    measures = intensity_measures(motion([0.0, 0.0, 0.0], 0.1))
    assert set(vars(measures).values()) == {0.0}
