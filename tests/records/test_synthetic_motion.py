from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from rpscli.constants import STANDARD_GRAVITY
from rpscli.errors import RecordError
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.loading import load_record
from rpscli.records.measures import displacement, intensity_measures, velocity
from rpscli.records.spectrum import spectral_acceleration

SHIPPED = Path(__file__).parents[2] / "cases" / "records"
PULSE = "synthetic:?pga=0.45g&seed=2&pulse_velocity=0.8&pulse_period=3"


def assert_ends_at_rest(made: GroundMotion) -> None:
    measures = intensity_measures(made)
    # Rounding of a sum of some thousand terms.
    assert abs(velocity(made.acceleration, made.dt)[-1]) < 1e-11 * measures.pgv
    assert abs(displacement(made.acceleration, made.dt)[-1]) < 1e-10 * measures.pgd


def test_options_are_honoured() -> None:
    made = load_record("synthetic:?pga=0.4g&duration=20&dt=0.005&seed=7&ground_frequency=3 Hz")
    assert made.pga == pytest.approx(0.4 * STANDARD_GRAVITY, rel=1e-14)
    assert (made.dt, made.npts, made.format) == (0.005, 4001, "synthetic")
    assert "not a recording" in made.description
    assert made.acceleration[0] == 0.0
    assert_ends_at_rest(made)


def test_the_seed_makes_the_motion() -> None:
    sources = ["synthetic:?pga=1&seed=1", "synthetic:?seed=1&pga=1", "synthetic:?pga=1&seed=2"]
    one, same, other = (load_record(source) for source in sources)
    assert one.digest == same.digest
    assert one.digest != other.digest


def test_a_velocity_pulse() -> None:
    made = load_record(PULSE)
    plain = load_record(PULSE.partition("&pulse")[0])
    assert made.pga == pytest.approx(0.45 * STANDARD_GRAVITY, rel=1e-14)
    assert_ends_at_rest(made)
    assert "velocity pulse of 0.8 m/s, 3 s" in made.description
    # Resonant with the pulse, the long oscillator feels it; a stiff one does not.
    assert spectral_acceleration(made, 3.0) > 2.0 * spectral_acceleration(plain, 3.0)
    assert spectral_acceleration(made, 0.1) < 1.2 * spectral_acceleration(plain, 0.1)


@pytest.mark.evidence("synthetic motions", "exact")
def test_the_spectrum_is_that_of_the_ground() -> None:
    # Power averaged over seeds, at the layer's frequency against four times that; well below
    # the low cut (0.24 Hz) it is nearly gone.
    power = np.zeros(1501)
    for seed in range(60):
        made = load_record(f"synthetic:?pga=1&seed={seed}&ground_frequency=3&ground_damping=0.3")
        spectrum = np.abs(np.fft.rfft(made.acceleration / np.std(made.acceleration))) ** 2
        power += spectrum[:1501]
    frequency = np.fft.rfftfreq(made.npts, made.dt)[:1501]

    def near(f: float) -> float:
        return float(power[np.abs(frequency - f) < 0.1 * f].mean())

    def layer(ratio: float, z: float = 0.3) -> float:
        return (1 + (2 * z * ratio) ** 2) / ((1 - ratio**2) ** 2 + (2 * z * ratio) ** 2)

    # 60 seeds times at least 18 lines (half of them independent under the envelope): 5 %; three
    # times that.
    assert near(3.0) / near(12.0) == pytest.approx(layer(1.0) / layer(4.0), rel=0.15)
    assert power[1:3].mean() < 0.02 * near(3.0)


@pytest.mark.evidence("synthetic motions", "exact")
def test_the_strong_part_follows_the_envelope() -> None:
    squares = sum(
        load_record(f"synthetic:?pga=1&seed={seed}").acceleration ** 2 for seed in range(20)
    )
    assert isinstance(squares, np.ndarray)
    thirds = squares.reshape(-1)[:3000].reshape(10, 300).sum(axis=1)
    assert np.argmax(thirds) in {1, 2}  # the peak lies at a fifth of the duration
    assert thirds[-1] < 0.01 * thirds.max()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ("seed=1", "pga is missing"),
        ("pga=0.4g", "seed is missing; give a whole number"),
        ("pga=0.4g&seed=1.5", "seed = '1.5' is not one"),
        ("pga=0.4g&seed=1&durations=3", "did you mean duration"),
        ("pga=-0.4g&seed=1", "must be positive"),
        ("pga=0.4g&seed=1&duration=0.1", "20 to 1 000 000 steps"),
        ("pga=0.4g&seed=1&dt=0", "must be positive"),
        ("pga=0.4g&seed=1&ground_frequency=60", "at or above 1/\\(2 dt\\) = 50 Hz"),
        ("pga=0.4g&seed=1&pulse_period=2", "a pulse needs pulse_velocity"),
        ("pga=0.4g&seed=1&pulse_velocity=5", "the pulse alone peaks at .* above pga = 3.923"),
        ("pga=0.4g&seed=1&pulse_velocity=1&pulse_period=20", "does not fit into 30 s"),
        ("pga=0.4g&seed=1&pulse_velocity=1&pulse_cycles=1", "no more than one cycle"),
    ],
)
def test_refuses(options: str, message: str) -> None:
    with pytest.raises(RecordError, match=message):
        load_record(f"synthetic:?{options}")


@pytest.mark.parametrize("name", ["synthetic_far_field.at2", "synthetic_near_field_pulse.at2"])
def test_shipped_files_are_what_their_headers_say(name: str) -> None:
    path = SHIPPED / name
    lines = path.read_text().splitlines()
    assert "SYNTHETIC, NOT A RECORDING" in lines[0]
    source = lines[1].partition(";")[0]
    made, shipped = load_record(source), load_record(str(path))
    assert "seed" in source
    assert shipped.warnings == ()
    assert shipped.dt == made.dt
    # Eight digits are printed; transforms of other libraries differ in the last bits of the peak.
    np.testing.assert_allclose(
        shipped.acceleration, made.acceleration, rtol=6e-8, atol=1e-12 * made.pga
    )
    assert path.stat().st_size < 60_000
