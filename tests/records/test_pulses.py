from __future__ import annotations

import math

import numpy as np
import pytest

from rpscli.errors import RecordError
from rpscli.records.loading import load_record
from rpscli.records.measures import displacement, velocity

T = 1.2
W = 2.0 * math.pi / T


@pytest.mark.parametrize(
    ("amplitude", "value"),
    [
        ("0.4g", 0.4 * 9.80665),
        ("0.4 g", 0.4 * 9.80665),
        ("3.9 m/s2", 3.9),
        ("390 cm/s^2", 3.9),
        ("3.9", 3.9),
        ("-0.4g", -0.4 * 9.80665),
    ],
)
def test_amplitudes(amplitude: str, value: float) -> None:
    made = load_record(f"pulse:cosine?amplitude={amplitude}&period=1.2 s")
    assert made.pga == pytest.approx(abs(value), rel=1e-15)
    assert made.acceleration[0] == pytest.approx(value, rel=1e-15)


def test_sine() -> None:
    made = load_record("pulse:sine?amplitude=2&period=1.2")
    assert (made.npts, made.dt, made.format) == (2001, T / 2000, "pulse")
    assert made.duration == pytest.approx(T, rel=1e-15)
    np.testing.assert_allclose(made.acceleration, 2.0 * np.sin(W * made.time), atol=1e-14)
    assert velocity(made.acceleration, made.dt)[-1] == pytest.approx(0.0, abs=1e-13)


def test_cosine_jumps_at_both_ends() -> None:
    made = load_record("pulse:cosine?amplitude=2&period=1.2&dt=0.01")
    assert (made.npts, made.dt) == (121, 0.01)
    assert made.acceleration[0] == 2.0
    assert made.acceleration[-1] == pytest.approx(2.0, rel=1e-15)
    np.testing.assert_allclose(made.acceleration, 2.0 * np.cos(W * made.time), atol=1e-13)


def test_half_sine_is_half_of_one() -> None:
    made = load_record("pulse:half_sine?amplitude=2&period=1.2")
    assert made.duration == pytest.approx(0.5 * T, rel=1e-15)
    assert made.npts == 1001
    np.testing.assert_allclose(made.acceleration, 2.0 * np.sin(W * made.time), atol=1e-14)
    assert made.acceleration.min() >= 0.0


def test_ricker() -> None:
    made = load_record("pulse:ricker?amplitude=2&period=1.2")
    peak = made.time[np.argmax(made.acceleration)]
    x = math.pi * (made.time - peak) / T
    expected = 2.0 * (1.0 - 2.0 * x**2) * np.exp(-(x**2))
    np.testing.assert_allclose(made.acceleration, expected, atol=1e-12)
    assert made.pga == 2.0
    assert abs(made.acceleration[0]) < 1e-12 * made.pga
    assert abs(made.acceleration[-1]) < 1e-12 * made.pga


def test_ricker_antisymmetric() -> None:
    made = load_record("pulse:ricker_antisymmetric?amplitude=2&period=1.2")
    x = math.pi * (made.time - 0.5 * made.duration) / T
    expected = (2 / 1.38) * (4 * x**2 / 3 - 3) * (2 * x / math.sqrt(3)) * np.exp(-2 * x**2 / 3)
    np.testing.assert_allclose(made.acceleration, expected, atol=1e-12)
    np.testing.assert_allclose(made.acceleration, -made.acceleration[::-1], atol=1e-12)
    assert made.pga == pytest.approx(2.0, rel=5e-3)  # 1.38 is a rounded number
    assert abs(made.acceleration[0]) < 1e-12


@pytest.mark.parametrize("cycles", [1.2, 2.0, 3.5])
@pytest.mark.parametrize("phase", ["0", "90 deg", "0.7"])
def test_mavroeidis_papageorgiou_integrates_to_its_velocity(cycles: float, phase: str) -> None:
    source = "pulse:mavroeidis_papageorgiou?velocity_amplitude=0.5 m/s&period=1.2"
    made = load_record(f"{source}&cycles={cycles}&phase={phase}")
    nu = math.pi / 2 if "deg" in phase else float(phase)
    tau = made.time - 0.5 * cycles * T
    expected = 0.25 * (1.0 + np.cos(W * tau / cycles)) * np.cos(W * tau + nu)
    expected[made.time > cycles * T] = 0.0
    # The trapezoidal rule is of second order in w dt = 2 pi/2000.
    np.testing.assert_allclose(velocity(made.acceleration, made.dt), expected, atol=1e-5)
    assert made.duration >= cycles * T - 1e-9


def test_mavroeidis_papageorgiou_by_peak_acceleration() -> None:
    source = "pulse:mavroeidis_papageorgiou?period=1.2&amplitude=0.4g"
    made = load_record(source)
    assert made.pga == pytest.approx(0.4 * 9.80665, rel=1e-5)
    longer = load_record(f"{source}&cycles=2.3&dt=0.007")
    assert longer.dt == 0.007
    assert longer.npts == math.ceil(2.3 * T / 0.007) + 1
    quarter = load_record(f"{source}&phase=90 deg")
    drift = displacement(quarter.acceleration, quarter.dt)
    assert abs(drift[-1]) < 1e-6 * np.max(np.abs(drift))


@pytest.mark.parametrize(
    ("source", "message"),
    [
        ("sin?amplitude=1&period=1", "pulse 'sin' is not known; did you mean sine"),
        ("?amplitude=1&period=1", "pulse '' is not known; known: sine, cosine"),
        ("sine?amplitude=1", "period is missing"),
        ("sine?period=1", "amplitude is missing"),
        ("sine?amplitude=1&periode=1", "'periode' is not known; did you mean period"),
        ("sine?amplitude=1&period=1&cycles=2", "'cycles' is not known"),
        ("sine?amplitude=1&amplitude=2&period=1", "amplitude is given twice"),
        ("sine?amplitude=&period=1", "amplitude has no value"),
        ("sine?amplitude=big&period=1", "amplitude = 'big' is not a number"),
        ("sine?amplitude=1 furlong&period=1", "is no acceleration in g, m/s2"),
        ("sine?amplitude=1&period=1 m", "period = '1 m' is no time in s"),
        ("sine?amplitude=1&period=0", "period = 0.0 s must be positive"),
        ("sine?amplitude=0&period=1", "amplitude = 0 makes no pulse"),
        ("sine?amplitude=1&period=1&dt=0.003", r"does not divide .* dt=0.003003003003$"),
        ("half_sine?amplitude=1&period=1&dt=0.2", r"does not divide .* of 0.5 s.*dt=0.25$"),
        ("sine?amplitude=1&period=1&dt=0.5", "at most a quarter of the period"),
        ("sine?amplitude=1&period=1&dt=-0.01", "must be positive"),
        ("sine?amplitude=1&period=1&dt=1e-9", "makes 1e\\+09 samples"),
        ("mavroeidis_papageorgiou?period=1", "either amplitude .* or velocity_amplitude"),
        ("mavroeidis_papageorgiou?period=1&amplitude=1&velocity_amplitude=1", "either amplitude"),
        ("mavroeidis_papageorgiou?period=1&amplitude=1&cycles=1", "cycles = 1 must lie between"),
    ],
)
def test_refuses(source: str, message: str) -> None:
    with pytest.raises(RecordError, match=message) as raised:
        load_record(f"pulse:{source}")
    assert f"pulse:{source}" in str(raised.value)


@pytest.mark.parametrize("period", [0.1, 0.3, 0.7, 1.1, 1.2, 2.3])
@pytest.mark.parametrize("parts", [7, 100, 999])
def test_a_step_that_divides_is_accepted_in_spite_of_rounding(period: float, parts: int) -> None:
    made = load_record(f"pulse:sine?amplitude=1&period={period}&dt={period / parts!r}")
    assert made.npts == parts + 1


def test_name_and_description_say_what_it_is() -> None:
    made = load_record("pulse:ricker?amplitude=0.4g&period=1.2")
    assert made.name == "ricker_T1.2s_a0.4g"
    assert "period 1.2 s, peak 0.4 g" in made.description
