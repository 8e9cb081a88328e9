"""Seeded stochastic ground motions: filtered white noise under an envelope.

The noise has the Kanai-Tajimi spectrum of a soil layer, cut at low frequencies by the filter of
Clough and Penzien; the envelope of Saragoni and Hart grows and decays it; a correction of the
baseline brings the ground back to rest. A long velocity pulse may be added, as near a fault.

References
----------
K. Kanai, Bull. Earthq. Res. Inst. 35, 1957; H. Tajimi, Proc. 2nd WCEE, 1960 (spectrum).
R. W. Clough and J. Penzien, Dynamics of Structures, 1975, section 28-4 (second filter).
G. R. Saragoni and G. C. Hart, Earthq. Eng. Struct. Dyn. 2, 1974, in the form of D. M. Boore,
Pure Appl. Geophys. 160, 2003, equations 9 to 12 (envelope).
A. Der Kiureghian and A. Neuenhofer, Earthq. Eng. Struct. Dyn. 21, 1992 (values for firm soil).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rpscli.constants import STANDARD_GRAVITY
from rpscli.errors import RecordError
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.measures import displacement, velocity
from rpscli.records.pulses import mavroeidis_papageorgiou
from rpscli.records.source import Source

_FIRM_GROUND = 15.0 / (2.0 * math.pi)  # Hz
_FIRM_CUT = 1.5 / (2.0 * math.pi)  # Hz
_PEAK_AT, _END_LEVEL = 0.2, 0.01  # of the envelope: when it peaks, what is left at the end
_PULSE_PHASE = 0.5 * math.pi  # an odd velocity leaves no displacement behind
_OPTIONS = (
    "pga",
    "seed",
    "duration",
    "dt",
    "ground_frequency",
    "ground_damping",
    "cut_frequency",
    "cut_damping",
    "pulse_velocity",
    "pulse_period",
    "pulse_cycles",
)


def load_synthetic(of: Source) -> GroundMotion:
    """Make a synthetic motion.

    Options: `pga` (needed), `seed` (needed), `duration` (30 s), `dt` (0.01 s), `ground_frequency`
    (2.39 Hz) and `ground_damping` (0.6) of the soil, `cut_frequency` (0.239 Hz) and `cut_damping`
    (0.6) of the low cut; with `pulse_velocity`, also `pulse_period` (3 s) and `pulse_cycles` (2).
    """
    query, source = of.query(*_OPTIONS), of
    seed = query.integer("seed")
    pga = query.acceleration("pga")
    duration = query.quantity("duration", "time", 30.0)
    dt = query.quantity("dt", "time", 0.01)
    ground = query.quantity("ground_frequency", "frequency", _FIRM_GROUND)
    cut = query.quantity("cut_frequency", "frequency", _FIRM_CUT)
    dampings = [query.quantity(f"{name}_damping", "ratio", 0.6) for name in ("ground", "cut")]
    if min(pga, dt, ground, cut, *dampings) <= 0.0 or not 20 * dt <= duration <= 1e6 * dt:
        raise RecordError(
            f"{source}: pga, dt, frequencies and dampings must be positive and the duration "
            f"20 to 1 000 000 steps"
        )
    if max(ground, cut) >= 0.5 / dt:
        raise RecordError(f"{source}: a filter at or above 1/(2 dt) = {0.5 / dt:g} Hz; lower dt")
    count = round(duration / dt) + 1
    noise = _filtered_noise(count, dt, seed, (ground, dampings[0]), (cut, dampings[1]))
    shaped = _brought_to_rest(noise * envelope(np.linspace(0.0, 1.0, count)), dt)
    pulse = np.zeros(count)
    label = ""
    if "pulse_velocity" in query.values:
        amplitude = query.quantity("pulse_velocity", "velocity")
        period = query.quantity("pulse_period", "time", 3.0)
        cycles = query.quantity("pulse_cycles", "ratio", 2.0)
        pulse = _velocity_pulse(
            source, np.arange(count, dtype=np.float64) * dt, amplitude, period, cycles
        )
        pulse = _brought_to_rest(pulse, dt)
        label = f" with a velocity pulse of {amplitude:g} m/s, {period:g} s"
    elif query.values.keys() & {"pulse_period", "pulse_cycles"}:
        raise RecordError(f"{source}: a pulse needs pulse_velocity=...")
    return GroundMotion(
        _raised_to(pga, shaped, pulse, source),
        dt,
        f"synthetic_seed{seed}_{pga / STANDARD_GRAVITY:.4g}g",
        source,
        "synthetic",
        f"synthetic, not a recording: filtered white noise, seed {seed}{label}",
    )


def envelope(fraction: NDArray[np.float64]) -> NDArray[np.float64]:
    """Saragoni-Hart envelope over time as a fraction of the duration; its peak is 1."""
    b = -_PEAK_AT * math.log(_END_LEVEL) / (1.0 + _PEAK_AT * (math.log(_PEAK_AT) - 1.0))
    c = b / _PEAK_AT
    return np.asarray(
        (math.e / _PEAK_AT) ** b * fraction**b * np.exp(-c * fraction), dtype=np.float64
    )


def _filtered_noise(
    count: int, dt: float, seed: int, ground: tuple[float, float], cut: tuple[float, float]
) -> NDArray[np.float64]:
    # Filtering by FFT gives a stationary (periodic) process: nothing has to settle first.
    white = np.random.Generator(np.random.PCG64(seed)).standard_normal(count)
    w = 2.0 * np.pi * np.fft.rfftfreq(count, dt)
    wg, wc = 2.0 * np.pi * ground[0], 2.0 * np.pi * cut[0]
    soil = (wg**2 + 2j * ground[1] * wg * w) / (wg**2 - w**2 + 2j * ground[1] * wg * w)
    low_cut = w**2 / (wc**2 - w**2 + 2j * cut[1] * wc * w)
    filtered: NDArray[np.float64] = np.fft.irfft(np.fft.rfft(white) * soil * low_cut, count)
    return filtered


def _velocity_pulse(
    source: str, time: NDArray[np.float64], amplitude: float, period: float, cycles: float
) -> NDArray[np.float64]:
    middle = 1.5 * _PEAK_AT * time[-1]  # a little after the envelope's peak
    start = max(0.0, middle - 0.5 * cycles * period)
    if period <= 0.0 or cycles <= 1.0 or start + cycles * period > time[-1]:
        raise RecordError(
            f"{source}: a pulse of {cycles:g} cycles of {period:g} s does not fit into "
            f"{time[-1]:g} s, or has no more than one cycle"
        )
    shape = mavroeidis_papageorgiou((time - start) / period, cycles, _PULSE_PHASE)
    return amplitude / period * shape


def _brought_to_rest(acceleration: NDArray[np.float64], dt: float) -> NDArray[np.float64]:
    # Subtracts (p + q t) times the envelope, with p and q such that the last velocity and the
    # last displacement vanish: nothing changes where the ground is quiet.
    fraction = np.linspace(0.0, 1.0, acceleration.size)
    basis = [envelope(fraction), envelope(fraction) * fraction]

    def last(a: NDArray[np.float64]) -> tuple[float, float]:
        return float(velocity(a, dt)[-1]), float(displacement(a, dt)[-1])

    matrix = np.array([last(shape) for shape in basis]).T
    p, q = np.linalg.solve(matrix, last(acceleration))
    correction: NDArray[np.float64] = p * basis[0] + q * basis[1]
    return acceleration - correction


def _raised_to(
    pga: float, noise: NDArray[np.float64], pulse: NDArray[np.float64], source: str
) -> NDArray[np.float64]:
    # The factor of the noise at which the sum first reaches the peak, at any sample.
    own = float(np.max(np.abs(pulse)))
    if own >= pga:
        raise RecordError(
            f"{source}: the pulse alone peaks at {own:.4g} m/s2, at or above pga = {pga:.4g} m/s2"
        )
    size = np.abs(noise)
    loud = size > 1e-12 * size.max()
    room = (pga - pulse * np.sign(noise))[loud]
    return noise * float(np.min(room / size[loud])) + pulse
