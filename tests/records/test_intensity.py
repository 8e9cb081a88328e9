import math

import numpy as np
import pytest
from conformance import conforms
from hypothesis import given, settings
from hypothesis import strategies as st
from paper_structures import known
from scipy.signal import lsim

from rpscli.analyses.known_systems import DAMPINGS, record_numbers
from rpscli.constants import STANDARD_GRAVITY
from rpscli.errors import RecordError
from rpscli.records.ground_motion import GroundMotion, MotionComponents
from rpscli.records.loading import load_record
from rpscli.records.measures import (
    displacement,
    intensity_measures,
    measured,
    response_spectrum,
    velocity,
)

NUMBERS = dict(record_numbers())


def known_system(quantity, expected, tolerance):
    """A motion that every installation measures again."""
    conforms(
        "measures and spectra of records", quantity, expected, NUMBERS[quantity],
        tolerance * expected, "closed form", "integrals of the motion, textbook overshoot",
    )  # fmt: skip


SAMPLES = st.lists(st.floats(-10.0, 10.0), min_size=2, max_size=30)


def motion(values, dt=0.5):
    return GroundMotion(
        np.asarray(values, dtype=float), dt, "name", "source.at2", "PEER AT2"
    )


@pytest.mark.evidence("measures and spectra of records", "exact")
def test_a_triangle_by_hand():
    # a = 0, 2, 0 m/s2 at 1 s: v = 0, 1, 2; d adds 2/6 and then 1 + 4/6.
    made = motion([0.0, 2.0, 0.0], 1.0)
    assert velocity(made.acceleration, 1.0).tolist() == [0.0, 1.0, 2.0]
    np.testing.assert_allclose(
        displacement(made.acceleration, 1.0), [0.0, 1 / 3, 2.0], rtol=1e-15
    )
    measures = intensity_measures(made)
    assert (measures.pga, measures.pgv) == (2.0, 2.0)
    assert measures.pgd == pytest.approx(2.0, rel=1e-15)
    arias = math.pi / (2 * STANDARD_GRAVITY) * 4.0
    of_triangle("Arias intensity [m/s]", arias, measures.arias)
    assert measures.cav == 2.0
    # The Husid curve 0, 2, 4 is straight here: 90 % of 2 s.
    of_triangle("duration from 5 to 95 % [s]", 1.8, measures.d5_95)


def of_triangle(quantity, expected, found):
    conforms(
        "measures and spectra of records", f"{quantity}, triangle", expected, found,
        1e-14 * expected, "hand calculation", "a = 0, 2, 0 m/s2 at 1 s",
    )  # fmt: skip


@pytest.mark.evidence("measures and spectra of records", "exact")
def test_one_sine_against_its_integrals():
    a, w, count = 3.0, 2.0 * math.pi, 4000
    second_order = (w / count) ** 2  # relative error of straight lines through a sine
    known_system("PGV [m/s], one sine", 2.0 * a / w, second_order)
    known_system("PGD [m], one sine", a / w, second_order)  # a t/w at t = 1 s
    arias = math.pi / (2 * STANDARD_GRAVITY) * a**2 / 2
    known_system("Arias intensity [m/s], one sine", arias, 1e-12)
    known_system("CAV [m/s], one sine", 2.0 * a / math.pi, second_order)


@pytest.mark.evidence("measures and spectra of records", "exact")
def test_significant_durations_by_hand():
    # Flat for 10 s: the Husid curve is straight, so 70 % and 90 % of 10 s.
    measures = intensity_measures(motion([1.0] * 101, 0.1))
    for part, expected, found in ((75, 7.0, measures.d5_75), (95, 9.0, measures.d5_95)):
        conforms(
            "measures and spectra of records",
            f"duration from 5 to {part} % [s], constant for 10 s", expected, found,
            1e-6 * expected, "hand calculation", "a straight Husid curve",
        )  # fmt: skip


@pytest.mark.evidence("measures and spectra of records", "exact")
def test_spectral_measures_of_a_sudden_load():
    """Its spectrum is flat: a (1 + e), e the decay over half a cycle, at every period."""
    a, damping = 3.0, 0.05
    peak = a * (1.0 + math.exp(-math.pi * damping / math.sqrt(1.0 - damping**2)))
    tolerance = 2e-3  # of spectra between their samples
    known_system("AvgSa [m/s2], sudden load", peak, tolerance)
    # The integral of T/2pi from 0.1 to 2.5 s.
    of_one = (2.5**2 - 0.1**2) / (4.0 * math.pi)
    known_system("Housner intensity [m], sudden load", peak * of_one, tolerance)


@pytest.mark.evidence("measures and spectra of records", "exact")
def test_filtered_incremental_velocity_of_three_long_pushes():
    """Bell curves, too slow for the filter: each gains its integral over 0.7 T at its top."""
    period, dt, wide = 0.5, 0.005, 2.0
    bell = np.exp(-0.5 * (np.arange(-12.0, 12.0, dt) / wide) ** 2)
    three = np.concatenate([1.0 * bell, 3.0 * bell, 2.0 * bell])
    one = (
        wide
        * math.sqrt(2.0 * math.pi)
        * math.erf(0.35 * period / (wide * math.sqrt(2.0)))
    )
    # The filter takes (f/corner)^4 with f = 1/(2 pi 2 s): 5e-6.
    # A fourth, and pushes to the other side that gain less, change nothing.
    more = np.concatenate([three, 0.5 * bell, -0.9 * three])
    for name, values in (("three", three), ("seven", more)):
        conforms(
            "measures and spectra of records", f"FIV3 [m/s], {name} long pushes",
            6.0 * one, measured(GroundMotion(values, dt), "FIV3", period),
            2e-5 * 6.0 * one, "closed form", "integrals of bell curves over 0.7 T",
        )  # fmt: skip


@pytest.mark.evidence("measures and spectra of records", "exact")
@pytest.mark.parametrize("frequency", [0.5, 1.3, 4.0])
def test_filtered_incremental_velocity_of_a_sine(frequency):
    """Three times amplitude, squared gain of the filter, and integral over the window."""
    a, period, dt = 2.0, 0.6, 0.002
    corner, count = 0.85 / period, round(40.0 / dt)
    ramps = np.minimum(
        1.0, np.minimum(np.arange(count), np.arange(count)[::-1]) * dt / 10.0
    )
    swing = np.sin(0.5 * math.pi * ramps) ** 2 * np.sin(
        2.0 * math.pi * frequency * dt * np.arange(count)
    )
    warped = math.tan(math.pi * frequency * dt) / math.tan(math.pi * corner * dt)
    gain = 1.0 / (1.0 + warped**4)
    wanted = 3.0 * a * gain * abs(math.sin(math.pi * frequency * 0.7 * period))
    wanted /= math.pi * frequency
    found = measured(GroundMotion(a * swing, dt), "FIV3", period)
    conforms(
        "measures and spectra of records", f"FIV3 [m/s], sine of {frequency} Hz",
        wanted, found, 3e-3 * wanted,  # ramps are not one frequency
        "closed form", "amplitude, gain of the filter, integral over 0.7 T",
    )  # fmt: skip


@pytest.mark.evidence("measures and spectra of records", "exact")
@settings(deadline=None)
@given(SAMPLES, st.floats(0.001, 1.0))
def test_integrals_are_those_of_the_straight_lines(values, dt):
    a = np.array(values)
    fine = np.interp(
        np.linspace(0, a.size - 1, 1 + 8 * (a.size - 1)), np.arange(a.size), a
    )
    # Rounding of a sum of some hundred terms, each below 10 m/s2 times the duration (squared).
    span = dt * a.size
    fine_v, fine_d = velocity(fine, dt / 8)[::8], displacement(fine, dt / 8)[::8]
    np.testing.assert_allclose(fine_v, velocity(a, dt), atol=1e-12 * 10 * span)
    np.testing.assert_allclose(fine_d, displacement(a, dt), atol=1e-12 * 10 * span**2)


def test_a_motion_of_zeros_measures_nothing():
    measures = intensity_measures(motion([0.0, 0.0, 0.0], 0.1))
    assert set(vars(measures).values()) == {0.0}


def simulated(made, period, damping):
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
def test_against_another_simulation(values, period, damping):
    # At least 50 samples a period: nothing is refined.
    made = motion([value / 1000 for value in values], 0.01)
    spectrum = response_spectrum(made, [period], damping)
    displacement, acceleration = simulated(made, period, damping)
    # A recursion over n steps loses about n eps/(w dt)^2, here 1e-9 at most of the peak ground
    # displacement of a flat record, which is also the scale of what cancels.
    scale = made.pga * (0.01 * len(values)) ** 2
    assert spectrum.displacement[0] == pytest.approx(
        displacement, rel=1e-8, abs=1e-9 * scale
    )
    assert spectrum.total_acceleration[0] == pytest.approx(
        acceleration, rel=1e-8, abs=1e-8 * made.pga
    )


@pytest.mark.evidence("measures and spectra of records", "exact")
def test_steady_resonance_by_formula():
    # At resonance an undamped oscillator at rest answers a sin(wt) by a (wt cos(wt) - sin(wt))/2w2.
    w, a, cycles = 2.0 * math.pi, 1.5, 10
    t = np.arange(0, cycles * 2000 + 1) / 2000
    made = motion(a * np.sin(w * t), 1 / 2000)
    spectrum = response_spectrum(made, [1.0], 0.0)
    # Largest at the end: a cycles/(2 w) * 2 pi/(w), which free vibration then keeps.
    expected = a * cycles * 2.0 * math.pi / (2.0 * w**2)
    conforms(
        "measures and spectra of records", "Sd [m], ten cycles at resonance, undamped",
        expected, spectrum.displacement[0], 2 * (w / 2000) ** 2 * expected,
        "closed form", "a (wt cos(wt) - sin(wt))/(2 w^2)",
    )  # fmt: skip


@pytest.mark.evidence("measures and spectra of records", "exact")
@pytest.mark.parametrize("damping", DAMPINGS)
def test_sudden_constant_load_overshoots_as_in_textbooks(damping):
    made = motion([2.0, 2.0], 3.0)
    overshoot = 1.0 + math.exp(-damping * math.pi / math.sqrt(1.0 - damping**2))
    name = f"Sa at 4 s [m/s2], sudden load, damping {damping:g}"
    known_system(name, 3.0 * overshoot, 2e-3)
    sa = measured(made, "Sa", 4.0, damping)
    # At least 50 samples a period, so one within 1/100 of it from the peak: 1 - cos(pi/50).
    assert sa == pytest.approx(2.0 * overshoot, rel=2e-3)


def test_limits_of_short_and_long_periods():
    made = load_record("synthetic:?pga=0.3g&seed=5&duration=10")
    spectrum = response_spectrum(made, [0.0, 0.004, 300.0])
    assert spectrum.pseudo_acceleration[0] == made.pga == spectrum.total_acceleration[0]
    assert spectrum.displacement[0] == 0.0
    # A stiff oscillator follows the ground up to the ripple of the kinks between samples.
    assert spectrum.pseudo_acceleration[1] == pytest.approx(made.pga, rel=0.05)
    # A mass on a very soft spring stays where it is: its relative displacement is the ground's.
    assert spectrum.displacement[2] == pytest.approx(
        intensity_measures(made).pgd, rel=0.05
    )


def test_linearity_and_definition():
    made = load_record("pulse:ricker?amplitude=0.3g&period=0.8&dt=0.004")
    periods = [0.1, 0.7, 2.0]
    one, twice = (
        response_spectrum(made, periods),
        response_spectrum(made.scaled(-2.0), periods),
    )
    np.testing.assert_allclose(
        twice.total_acceleration, 2.0 * one.total_acceleration, rtol=1e-12
    )
    stiffness = (2.0 * np.pi / np.array(periods)) ** 2
    np.testing.assert_allclose(
        one.pseudo_acceleration, stiffness * one.displacement, rtol=1e-14
    )
    assert measured(made, "Sa", 0.7) == one.pseudo_acceleration[1]
    undamped = response_spectrum(made, periods, 0.0)
    np.testing.assert_allclose(
        undamped.pseudo_acceleration, undamped.total_acceleration, rtol=1e-9
    )  # the same quantity without damping


@pytest.mark.parametrize(
    ("period", "damping", "message"),
    [
        (-1.0, 0.05, "must be 0 or from 1e-06 s on"),
        (math.nan, 0.05, "must be 0 or from 1e-06 s on"),
        (1.0, 1.0, r"must be in \[0, 1\)"),
    ],
)
def test_refuses(period, damping, message):
    with pytest.raises(RecordError, match=message):
        response_spectrum(motion([0.0, 1.0], 0.1), [period], damping)


def test_samples_are_a_read_only_contiguous_copy():
    values = np.arange(10.0)[::2]
    made = GroundMotion(values, 0.1, "n", "s", "f")
    values[0] = 99.0
    assert made.acceleration.flags.c_contiguous
    assert made.acceleration[0] == 0.0
    with pytest.raises(ValueError, match="read-only"):
        made.acceleration[0] = 1.0


def test_scaled_says_so_and_keeps_the_rest():
    made = motion([0.0, 1.0, -4.0])
    twice = made.scaled(-2.0)
    assert twice.acceleration.tolist() == [0.0, -2.0, 8.0]
    assert twice.pga == 8.0
    assert twice.description == "scaled by -2"
    assert twice.scaled(0.5).description == "scaled by -2; scaled by 0.5"
    assert (twice.name, twice.source, twice.dt) == (made.name, made.source, made.dt)


def test_digest_depends_on_step_and_samples_only():
    made = motion([0.0, 1.0])
    same = GroundMotion(np.array([0.0, 1.0]), 0.5, "other", "elsewhere", "pulse")
    assert made.digest == same.digest
    assert made.digest != motion([0.0, 1.0], 0.25).digest
    assert made.digest != motion([0.0, 1.0 + 1e-15]).digest
    assert made.digest != made.scaled(2.0).digest


@pytest.mark.parametrize(
    ("values", "dt", "message"),
    [
        ([[0.0, 1.0], [1.0, 2.0]], 0.1, "one row"),
        ([1.0], 0.1, "at least 2 samples"),
        ([0.0, np.nan, 1.0], 0.1, "sample 2 is nan, not finite"),
        ([0.0, 1.0], 0.0, "dt = 0.0 s must be positive"),
        ([0.0, 1.0], np.inf, "must be positive and finite"),
    ],
)
def test_refuses_samples(values, dt, message):
    with pytest.raises(RecordError, match=message) as raised:
        motion(values, dt)
    assert "source.at2" in str(raised.value)


def test_a_second_horizontal_component():
    x, y, up = motion([1.0, -2.0]), motion([5.0, 6.0, 7.0]), motion([1.0, 0.0])
    pair = MotionComponents(x, up, y=y)
    assert [*pair.named] == ["horizontal", "y", "vertical"]
    assert pair.samples[pair.row("y")].tolist() == [5.0, 6.0, 7.0]
    assert pair.samples[pair.row("horizontal")].tolist() == [
        1.0,
        -2.0,
        0.0,
    ]  # goes on as zero
    assert MotionComponents(x, up).row("y") is None
    assert (pair.npts, pair.duration, pair.dt) == (3, 1.0, 0.5)
    assert not pair.samples.flags.writeable
    assert pair.scaled(2.0).scaled(0.25).scale == 0.5
    assert known(pair.scaled(2.0).y).acceleration.tolist() == [10.0, 12.0, 14.0]
    assert known(pair.finer(2).y).acceleration.tolist() == [5.0, 5.5, 6.0, 6.5, 7.0]
    digests = {
        MotionComponents(x, z, y=n).digest for z in (None, up) for n in (None, y, up)
    }
    assert len(digests) == 6
    other = motion([1.0, 2.0], 0.2)
    with pytest.raises(RecordError, match=r"the y record has dt = 0.2 s"):
        MotionComponents(x, y=other)
    with pytest.raises(
        RecordError, match=r"vertical .* dt = 0\.2 s, .* 0\.5 s: they must agree"
    ):
        MotionComponents(x, other)
