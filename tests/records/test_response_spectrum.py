from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.signal import lsim

from rpscli.errors import RecordError
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.loading import load_record
from rpscli.records.measures import intensity_measures
from rpscli.records.spectrum import response_spectrum, spectral_acceleration


def motion(values: Any, dt: float) -> GroundMotion:
    return GroundMotion(np.asarray(values, dtype=float), dt, "n", "s", "f")


def simulated(made: GroundMotion, period: float, damping: float) -> tuple[float, float]:
    """Peaks by scipy's simulation of the same oscillator, linear between samples."""
    w = 2.0 * math.pi / period
    quiet = math.ceil(period / made.dt) + 1
    ground = np.concatenate([made.acceleration, np.zeros(quiet)])
    system = (
        [[0.0, 1.0], [-(w**2), -2.0 * damping * w]],
        [[0.0], [-1.0]],
        [[1.0, 0.0], [-(w**2), -2.0 * damping * w]],
        [[0.0], [0.0]],
    )
    _, response, _ = lsim(system, ground, made.dt * np.arange(ground.size))
    return float(np.max(np.abs(response[:, 0]))), float(np.max(np.abs(response[:, 1])))


@pytest.mark.evidence("measures and spectra of records", "program")
@settings(deadline=None)
@given(
    st.lists(st.integers(-5000, 5000), min_size=2, max_size=40).filter(any),
    st.floats(0.5, 20.0),
    st.floats(0.0, 0.9),
)
def test_against_an_independent_simulation(
    values: list[int], period: float, damping: float
) -> None:
    made = motion(
        [value / 1000 for value in values], 0.01
    )  # at least 50 samples a period: nothing is refined
    spectrum = response_spectrum(made, [period], damping)
    displacement, acceleration = simulated(made, period, damping)
    # A recursion over n steps loses about n eps/(w dt)^2, here 1e-9 at most of the peak ground
    # displacement of a flat record, which is also the scale of what cancels.
    scale = made.pga * (0.01 * len(values)) ** 2
    assert spectrum.displacement[0] == pytest.approx(displacement, rel=1e-8, abs=1e-9 * scale)
    assert spectrum.total_acceleration[0] == pytest.approx(
        acceleration, rel=1e-8, abs=1e-8 * made.pga
    )


@pytest.mark.evidence("measures and spectra of records", "exact")
def test_steady_resonance_by_formula() -> None:
    # At resonance an undamped oscillator at rest answers a sin(wt) by a (wt cos(wt) - sin(wt))/2w2.
    w, a, cycles = 2.0 * math.pi, 1.5, 10
    t = np.arange(0, cycles * 2000 + 1) / 2000
    made = motion(a * np.sin(w * t), 1 / 2000)
    spectrum = response_spectrum(made, [1.0], 0.0)
    # Largest at the end: a cycles/(2 w) * 2 pi/(w), which free vibration then keeps.
    expected = a * cycles * 2.0 * math.pi / (2.0 * w**2)
    assert spectrum.displacement[0] == pytest.approx(expected, rel=2 * (w / 2000) ** 2)


@pytest.mark.evidence("measures and spectra of records", "exact")
@pytest.mark.parametrize("damping", [0.0, 0.05, 0.3])
def test_sudden_constant_load_overshoots_as_in_textbooks(damping: float) -> None:
    made = motion([2.0, 2.0], 3.0)
    overshoot = 1.0 + math.exp(-damping * math.pi / math.sqrt(1.0 - damping**2))
    sa = spectral_acceleration(made, 4.0, damping)
    # At least 50 samples a period, so one within 1/100 of it from the peak: 1 - cos(pi/50).
    assert sa == pytest.approx(2.0 * overshoot, rel=2e-3)


def test_limits_of_short_and_long_periods() -> None:
    made = load_record("synthetic:?pga=0.3g&seed=5&duration=10")
    spectrum = response_spectrum(made, [0.0, 0.004, 300.0])
    assert spectrum.pseudo_acceleration[0] == made.pga == spectrum.total_acceleration[0]
    assert spectrum.displacement[0] == 0.0
    # A stiff oscillator follows the ground up to the ripple of the kinks between samples.
    assert spectrum.pseudo_acceleration[1] == pytest.approx(made.pga, rel=0.05)
    # A mass on a very soft spring stays where it is: its relative displacement is the ground's.
    assert spectrum.displacement[2] == pytest.approx(intensity_measures(made).pgd, rel=0.05)


def test_short_periods_are_resolved_between_samples() -> None:
    coarse = np.array([0.0, 1.0, -1.0, 0.5, 0.0, 0.0])
    fine = np.interp(np.arange(0, 5 * 40 + 1) / 40, np.arange(6), coarse)
    periods = [0.2, 0.5, 1.0]
    one = response_spectrum(motion(coarse, 0.1), periods)
    other = response_spectrum(motion(fine, 0.1 / 40), periods)
    # Both resolve the period by at least 50 samples: 1 - cos(pi/50).
    np.testing.assert_allclose(one.displacement, other.displacement, rtol=2e-3)


def test_linearity_and_definition() -> None:
    made = load_record("pulse:ricker?amplitude=0.3g&period=0.8&dt=0.004")
    periods = [0.1, 0.7, 2.0]
    one, twice = response_spectrum(made, periods), response_spectrum(made.scaled(-2.0), periods)
    np.testing.assert_allclose(twice.total_acceleration, 2.0 * one.total_acceleration, rtol=1e-12)
    stiffness = (2.0 * np.pi / np.array(periods)) ** 2
    np.testing.assert_allclose(one.pseudo_acceleration, stiffness * one.displacement, rtol=1e-14)
    assert spectral_acceleration(made, 0.7) == one.pseudo_acceleration[1]
    undamped = response_spectrum(made, periods, 0.0)
    np.testing.assert_allclose(
        undamped.pseudo_acceleration, undamped.total_acceleration, rtol=1e-9
    )  # the same quantity without damping


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda made: response_spectrum(made, [-1.0]), "must be 0 or from 1e-06 s on"),
        (lambda made: response_spectrum(made, [math.nan]), "must be 0 or from 1e-06 s on"),
        (lambda made: response_spectrum(made, [1.0], 1.0), r"must be in \[0, 1\)"),
    ],
)
def test_refuses(call: Callable[[GroundMotion], object], message: str) -> None:
    with pytest.raises(RecordError, match=message):
        call(motion([0.0, 1.0], 0.1))
