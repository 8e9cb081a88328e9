"""Motions that are made: mathematical pulses, and seeded stochastic ground motions.

`pulse:sine?amplitude=0.4g&period=1.2`: every pulse starts at t = 0. One that starts
with a jump (cosine) jumps: its first sample is the amplitude; the ground acceleration
is zero after the last sample.

`synthetic:?pga=0.4g&seed=1`: white noise with the Kanai-Tajimi spectrum of a soil layer,
cut at low frequencies by the filter of Clough and Penzien; the envelope of Saragoni and
Hart grows and decays it; a correction of the baseline brings the ground back to rest. A
long velocity pulse may be added, as near a fault.

References
----------
G. P. Mavroeidis and A. S. Papageorgiou, Bull. Seism. Soc. Am. 93(3), 2003, equation 3
(pulse). N. Ricker, 1943 (wavelets: the second and the third derivative of a Gaussian). K.
Kanai, Bull. Earthq. Res. Inst. 35, 1957; H. Tajimi, Proc. 2nd WCEE, 1960 (spectrum). R.
W. Clough and J. Penzien, Dynamics of Structures, 1975, section 28-4 (second filter). G.
R. Saragoni and G. C. Hart, Earthq. Eng. Struct. Dyn. 2, 1974, in the form of D. M. Boore,
Pure Appl. Geophys. 160, 2003, equations 9 to 12 (envelope). A. Der Kiureghian and A.
Neuenhofer, Earthq. Eng. Struct. Dyn. 21, 1992 (values for firm soil).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.constants import STANDARD_GRAVITY
from rpscli.errors import RecordError
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.measures import displacement, velocity
from rpscli.records.source import Source, hint

Array = NDArray[np.float64]

DOUBTFUL = 0.2  # peaks of numbers without unit below this [g] are asked about
# periods before the peak of a Ricker wavelet: at its start it is below 1e-12 of it
_LEAD = 2.5
_STEPS_PER_PERIOD = 2000
_MAVROEIDIS = "mavroeidis_papageorgiou"


class _Pulse(NamedTuple):
    """A shape of unit amplitude over time in periods, from zero, and its length in them.

    It `fits` if its end is part of the definition, so that it has to fall on a sample.
    """

    shape: Callable[[Array], Array]
    periods: float
    fits: bool


def _ricker(tau: Array) -> Array:
    x2 = (np.pi * (tau - _LEAD)) ** 2
    return (1.0 - 2.0 * x2) * np.exp(-x2)


def _ricker_antisymmetric(tau: Array) -> Array:
    x = np.pi * (tau - _LEAD)  # 1.38 brings the peak to one
    return (
        (4.0 * x**2 / 3.0 - 3.0)
        * (2.0 * x / math.sqrt(3.0))
        * np.exp(-2.0 * x**2 / 3.0)
        / 1.38
    )


def _mavroeidis_papageorgiou(tau: Array, cycles: float, phase: float) -> Array:
    """Acceleration of the pulse of unit velocity amplitude and period."""
    s = 2.0 * np.pi * (tau - 0.5 * cycles)
    bell = np.sin(s / cycles) * np.cos(s + phase)
    wave = cycles * np.sin(s + phase) * (1.0 + np.cos(s / cycles))
    return np.where(np.abs(s) <= np.pi * cycles, -np.pi / cycles * (bell + wave), 0.0)


_PULSES = {
    "sine": _Pulse(lambda tau: np.sin(2.0 * np.pi * tau), 1.0, fits=True),
    "cosine": _Pulse(lambda tau: np.cos(2.0 * np.pi * tau), 1.0, fits=True),
    "half_sine": _Pulse(lambda tau: np.sin(2.0 * np.pi * tau), 0.5, fits=True),
    "ricker": _Pulse(_ricker, 2.0 * _LEAD, fits=False),
    "ricker_antisymmetric": _Pulse(_ricker_antisymmetric, 2.0 * _LEAD, fits=False),
}
PULSES = (*_PULSES, _MAVROEIDIS)


def load_pulse(of: Source) -> GroundMotion:
    """Make a pulse.

    `amplitude` is the peak acceleration (for the Mavroeidis-Papageorgiou pulse that
    of the whole wave), `period` that of the oscillation. `dt` defaults to a 2000th of
    the period and has to divide pulses of one period. The Mavroeidis-Papageorgiou
    pulse takes `cycles` (default 2) and `phase` (default 0), and `velocity_amplitude`
    in place of `amplitude`.
    """
    name = of.place
    if name not in PULSES:
        raise RecordError(f"{of}: pulse {name!r} is not known; {hint(name, PULSES)}")
    own = ("velocity_amplitude", "cycles", "phase") if name == _MAVROEIDIS else ()
    of.query("amplitude", "period", "dt", *own)
    period = of.quantity("period", "time")
    if period <= 0.0:
        raise RecordError(f"{of}: period = {period} s must be positive")
    pulse, amplitude = (
        _bell_of_waves(of, period)
        if own
        else (_PULSES[name], of.acceleration("amplitude"))
    )
    if amplitude == 0.0:
        key = "amplitude" if "amplitude" in of.values else "velocity_amplitude"
        raise RecordError(f"{of}: {key} = 0 makes no pulse")
    dt, time = _sampled(of, pulse, period)
    peak = abs(amplitude) / STANDARD_GRAVITY
    written = of.values.get("amplitude") or "g"
    bare = written.strip().replace(".", "").isdigit() and peak < DOUBTFUL
    doubt = (
        f"{of}: an amplitude of {amplitude:g} m/s2 = {peak:.4g} g; was {amplitude:g}g"
        " meant?"
    )
    return GroundMotion(
        amplitude * pulse.shape(time),
        dt,
        f"{name}_T{period:g}s_a{peak:.4g}g",
        of,
        "pulse",
        f"{name.replace('_', ' ')} pulse, period {period:g} s, peak {peak:.4g} g",
        (doubt,) * bare,
    )


def _sampled(of: Source, pulse: _Pulse, period: float) -> tuple[float, Array]:
    """The step of a pulse [s], and the times of its samples in periods."""
    dt = of.quantity("dt", "time", period / _STEPS_PER_PERIOD)
    length = pulse.periods * period
    fault = ""
    whole = length / dt if dt else math.nan
    if not 0.0 < dt <= 0.25 * period:
        fault = "must be positive and at most a quarter of the period"
    elif whole > 1e7:
        fault = f"makes {whole:.3g} samples; raise it"
    elif pulse.fits and abs(whole - round(whole)) > 1e-6:
        fault = (
            f"does not divide the pulse of {length:g} s, which has to end on a sample;"
            f" the nearest that does is dt={length / round(whole):.10g}"
        )
    if fault:
        raise RecordError(f"{of}: dt = {dt:g} s {fault}")
    steps = round(whole) if pulse.fits else math.ceil(whole - 1e-6)
    # The last sample of a pulse that fits is its end exactly, whatever the rounding of
    # dt.
    step = pulse.periods / steps if pulse.fits else dt / period
    return dt, np.arange(steps + 1, dtype=np.float64) * step


def _bell_of_waves(of: Source, period: float) -> tuple[_Pulse, float]:
    cycles = of.quantity("cycles", "ratio", 2.0)
    phase = of.quantity("phase", "angle", 0.0)
    if not 1.0 < cycles <= 100.0:
        raise RecordError(f"{of}: cycles = {cycles:g} must lie between 1 and 100")
    dense = np.linspace(0.0, cycles, 1 + 2 * _STEPS_PER_PERIOD * math.ceil(cycles))
    peak = float(np.max(np.abs(_mavroeidis_papageorgiou(dense, cycles, phase))))
    if ("amplitude" in of.values) == ("velocity_amplitude" in of.values):
        raise RecordError(
            f"{of}: give either amplitude (peak acceleration) or velocity_amplitude"
        )
    if "amplitude" in of.values:
        amplitude = of.acceleration("amplitude")
    else:
        amplitude = of.quantity("velocity_amplitude", "velocity") * peak / period
    pulse = _Pulse(
        lambda tau: _mavroeidis_papageorgiou(tau, cycles, phase) / peak,
        cycles,
        fits=False,
    )
    return pulse, amplitude


_FIRM_GROUND = 15.0 / (2.0 * math.pi)  # Hz
_FIRM_CUT = 1.5 / (2.0 * math.pi)
_PEAK_AT = 0.2  # of the envelope: when it peaks, what is left at the end
_END_LEVEL = 0.01
_PULSE_PHASE = 0.5 * math.pi  # an odd velocity leaves no displacement behind
_OPTIONS = (
    "pga", "seed", "duration", "dt", "ground_frequency", "ground_damping", "cut_frequency",
    "cut_damping", "pulse_velocity", "pulse_period", "pulse_cycles",
)  # fmt: skip


def load_synthetic(of: Source) -> GroundMotion:
    """Make a synthetic motion.

    Options: `pga` (needed), `seed` (needed), `duration` (30 s), `dt` (0.01 s),
    `ground_frequency` (2.39 Hz) and `ground_damping` (0.6) of the soil, `cut_frequency`
    (0.239 Hz) and `cut_damping` (0.6) of the low cut; with `pulse_velocity`, also
    `pulse_period` (3 s) and `pulse_cycles` (2).
    """
    of.query(*_OPTIONS)
    noise = _noise(of)
    dt = noise.dt
    pga = noise.pga
    count = round(noise.duration / dt) + 1
    grown = _filtered_noise(count, noise) * envelope(np.linspace(0.0, 1.0, count))
    shaped = _brought_to_rest(grown, dt)
    pulse, label = _velocity_pulse(of, count, dt)
    if (own := float(np.max(np.abs(pulse)))) >= pga:
        raise RecordError(
            f"{of}: the pulse alone peaks at {own:.4g} m/s2, at or above pga = {pga:.4g}"
            " m/s2"
        )
    # The factor of the noise at which the sum first reaches the peak, at any sample.
    size = np.abs(shaped)
    loud = size > 1e-12 * size.max()
    room = (pga - pulse * np.sign(shaped))[loud]
    return GroundMotion(
        shaped * float(np.min(room / size[loud])) + pulse,
        dt,
        f"synthetic_seed{noise.seed}_{pga / STANDARD_GRAVITY:.4g}g",
        of,
        "synthetic",
        f"synthetic, not a recording: filtered white noise, seed {noise.seed}{label}",
    )


class _Noise(NamedTuple):
    """Filtered white noise: peak, length, frequency [Hz] and damping of both filters."""

    seed: int
    pga: float  # [m/s2]
    duration: float  # [s]
    dt: float  # [s]
    ground: tuple[float, float]
    cut: tuple[float, float]


def _noise(of: Source) -> _Noise:
    """The noise that the options of a source ask for."""
    seed = of.integer("seed")
    pga = of.acceleration("pga")
    duration = of.quantity("duration", "time", 30.0)
    dt = of.quantity("dt", "time", 0.01)
    ground = of.quantity("ground_frequency", "frequency", _FIRM_GROUND)
    cut = of.quantity("cut_frequency", "frequency", _FIRM_CUT)
    dampings = [
        of.quantity(f"{name}_damping", "ratio", 0.6) for name in ("ground", "cut")
    ]
    if min(pga, dt, ground, cut, *dampings) <= 0.0 or not 20 * dt <= duration <= 1e6 * dt:
        raise RecordError(
            f"{of}: pga, dt, frequencies and dampings must be positive and the duration "
            f"20 to 1 000 000 steps"
        )
    if max(ground, cut) >= 0.5 / dt:
        raise RecordError(
            f"{of}: a filter at or above 1/(2 dt) = {0.5 / dt:g} Hz; lower dt"
        )
    return _Noise(seed, pga, duration, dt, (ground, dampings[0]), (cut, dampings[1]))


def _velocity_pulse(of: Source, count: int, dt: float) -> tuple[Array, str]:
    """The pulse in a synthetic motion at its samples [m/s2], and words for it; zero, and
    none, unless it is asked for.
    """
    if "pulse_velocity" not in of.values:
        if of.values.keys() & {"pulse_period", "pulse_cycles"}:
            raise RecordError(f"{of}: a pulse needs pulse_velocity=...")
        return np.zeros(count), ""
    amplitude = of.quantity("pulse_velocity", "velocity")
    period = of.quantity("pulse_period", "time", 3.0)
    cycles = of.quantity("pulse_cycles", "ratio", 2.0)
    time = np.arange(count, dtype=np.float64) * dt
    middle = 1.5 * _PEAK_AT * time[-1]  # a little after the envelope's peak
    start = max(0.0, middle - 0.5 * cycles * period)
    if period <= 0.0 or cycles <= 1.0 or start + cycles * period > time[-1]:
        raise RecordError(
            f"{of}: a pulse of {cycles:g} cycles of {period:g} s does not fit into"
            f" {time[-1]:g} s, or has no more than one cycle"
        )
    shape = _mavroeidis_papageorgiou((time - start) / period, cycles, _PULSE_PHASE)
    pulse = _brought_to_rest(amplitude / period * shape, dt)
    return pulse, f" with a velocity pulse of {amplitude:g} m/s, {period:g} s"


def envelope(fraction: Array) -> Array:
    """Saragoni-Hart envelope over time as a fraction of the duration; its peak is 1."""
    b = -_PEAK_AT * math.log(_END_LEVEL) / (1.0 + _PEAK_AT * (math.log(_PEAK_AT) - 1.0))
    decay = np.exp(-b / _PEAK_AT * fraction)
    return np.asarray((math.e / _PEAK_AT) ** b * fraction**b * decay, dtype=np.float64)


def _filtered_noise(count: int, noise: _Noise) -> Array:
    # Filtering by FFT gives a stationary (periodic) process: nothing has to settle first.
    white = np.random.Generator(np.random.PCG64(noise.seed)).standard_normal(count)
    ground = noise.ground
    cut = noise.cut
    w = 2.0 * np.pi * np.fft.rfftfreq(count, noise.dt)
    wg = 2.0 * np.pi * ground[0]
    wc = 2.0 * np.pi * cut[0]
    soil = (wg**2 + 2j * ground[1] * wg * w) / (wg**2 - w**2 + 2j * ground[1] * wg * w)
    low_cut = w**2 / (wc**2 - w**2 + 2j * cut[1] * wc * w)
    return np.asarray(np.fft.irfft(np.fft.rfft(white) * soil * low_cut, count))


def _brought_to_rest(acceleration: Array, dt: float) -> Array:
    # Subtracts (p + q t) times the envelope, with p and q such that the last velocity and
    # the last displacement vanish: nothing changes where the ground is quiet.
    fraction = np.linspace(0.0, 1.0, acceleration.size)
    basis = [envelope(fraction), envelope(fraction) * fraction]

    def last(a: Array) -> tuple[float, float]:
        return float(velocity(a, dt)[-1]), float(displacement(a, dt)[-1])

    matrix = np.array([last(shape) for shape in basis]).T
    p, q = np.linalg.solve(matrix, last(acceleration))
    return np.asarray(acceleration - (p * basis[0] + q * basis[1]))
