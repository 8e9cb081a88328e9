"""Mathematical pulses: `pulse:sine?amplitude=0.4g&period=1.2`.

Every pulse starts at t = 0. One that starts with a jump (cosine) jumps: its first sample is the
amplitude; the ground acceleration is zero after the last sample.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rpscli.constants import STANDARD_GRAVITY
from rpscli.errors import RecordError
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.quantities import Query, hint
from rpscli.records.source import Source

LEAD = 2.5
"""Periods before the peak of a Ricker wavelet: at its start it is below 1e-12 of the peak."""


def sine(tau: NDArray[np.float64]) -> NDArray[np.float64]:
    """One full period, or half of one, of a sine."""
    return np.sin(2.0 * np.pi * tau)


def cosine(tau: NDArray[np.float64]) -> NDArray[np.float64]:
    """One full period of a cosine: it starts and ends with a jump."""
    return np.cos(2.0 * np.pi * tau)


def ricker(tau: NDArray[np.float64]) -> NDArray[np.float64]:
    """Symmetric Ricker wavelet, the second derivative of a Gaussian (Ricker 1943)."""
    x2 = (np.pi * (tau - LEAD)) ** 2
    return (1.0 - 2.0 * x2) * np.exp(-x2)


def ricker_antisymmetric(tau: NDArray[np.float64]) -> NDArray[np.float64]:
    """Antisymmetric Ricker wavelet, a third derivative; 1.38 brings its peak to one."""
    x = np.pi * (tau - LEAD)
    return (4.0 * x**2 / 3.0 - 3.0) * (2.0 * x / math.sqrt(3.0)) * np.exp(-2.0 * x**2 / 3.0) / 1.38


def mavroeidis_papageorgiou(
    tau: NDArray[np.float64], cycles: float, phase: float
) -> NDArray[np.float64]:
    """Acceleration of the Mavroeidis-Papageorgiou pulse of unit velocity amplitude and period.

    Mavroeidis and Papageorgiou, BSSA 93(3), 2003, equation 3.
    """
    s = 2.0 * np.pi * (tau - 0.5 * cycles)
    inside = np.abs(s) <= np.pi * cycles
    bell = np.sin(s / cycles) * np.cos(s + phase)
    wave = cycles * np.sin(s + phase) * (1.0 + np.cos(s / cycles))
    return np.where(inside, -np.pi / cycles * (bell + wave), 0.0)


DOUBTFUL = 0.2
"""Peaks of numbers without unit below this [g] are asked about."""

_STEPS_PER_PERIOD = 2000
_MAVROEIDIS = "mavroeidis_papageorgiou"

Shape = Callable[[NDArray[np.float64]], NDArray[np.float64]]


@dataclass(frozen=True)
class _Pulse:
    """A shape of unit amplitude over time in periods, from zero."""

    shape: Shape
    periods: float  # length
    fits: bool  # the end is part of the definition, so it has to fall on a sample


_PULSES = {
    "sine": _Pulse(sine, 1.0, fits=True),
    "cosine": _Pulse(cosine, 1.0, fits=True),
    "half_sine": _Pulse(sine, 0.5, fits=True),
    "ricker": _Pulse(ricker, 2.0 * LEAD, fits=False),
    "ricker_antisymmetric": _Pulse(ricker_antisymmetric, 2.0 * LEAD, fits=False),
}
PULSES = (*_PULSES, _MAVROEIDIS)
"""The names of the pulses."""


def load_pulse(of: Source) -> GroundMotion:
    """Make a pulse.

    `amplitude` is the peak acceleration (for the Mavroeidis-Papageorgiou pulse that of the whole
    wave), `period` that of the oscillation. `dt` defaults to a 2000th of the period and has to
    divide pulses of one period. The Mavroeidis-Papageorgiou pulse takes `cycles` (default 2) and
    `phase` (default 0), and `velocity_amplitude` in place of `amplitude`.
    """
    name, source = of.place, of
    if name not in PULSES:
        raise RecordError(f"{source}: pulse {name!r} is not known; {hint(name, PULSES)}")
    own = ("velocity_amplitude", "cycles", "phase") if name == _MAVROEIDIS else ()
    query = of.query("amplitude", "period", "dt", *own)
    period = query.quantity("period", "time")
    if period <= 0.0:
        raise RecordError(f"{source}: period = {period} s must be positive")
    pulse, amplitude = (
        _bell_of_waves(query, period) if own else (_PULSES[name], query.acceleration("amplitude"))
    )
    if amplitude == 0.0:
        key = next(key for key in ("amplitude", "velocity_amplitude") if key in query.values)
        raise RecordError(f"{source}: {key} = 0 makes no pulse")
    dt, steps = _sampling(query, pulse, period)
    # The last sample of a pulse that fits is its end exactly, whatever the rounding of dt.
    tau = np.arange(steps + 1, dtype=np.float64) * (
        pulse.periods / steps if pulse.fits else dt / period
    )
    peak = abs(amplitude) / STANDARD_GRAVITY
    bare = query.values.get("amplitude", "g").strip().replace(".", "").isdigit() and peak < DOUBTFUL
    doubt = (
        f"{source}: an amplitude of {amplitude:g} m/s2 = {peak:.4g} g; was {amplitude:g}g meant?"
    )
    return GroundMotion(
        amplitude * pulse.shape(tau),
        dt,
        f"{name}_T{period:g}s_a{peak:.4g}g",
        source,
        "pulse",
        f"{name.replace('_', ' ')} pulse, period {period:g} s, peak {peak:.4g} g",
        (doubt,) * bare,
    )


def _bell_of_waves(query: Query, period: float) -> tuple[_Pulse, float]:
    cycles = query.quantity("cycles", "ratio", 2.0)
    phase = query.quantity("phase", "angle", 0.0)
    if not 1.0 < cycles <= 100.0:
        raise RecordError(f"{query.source}: cycles = {cycles:g} must lie between 1 and 100")
    dense = np.linspace(0.0, cycles, 1 + 2 * _STEPS_PER_PERIOD * math.ceil(cycles))
    peak = float(np.max(np.abs(mavroeidis_papageorgiou(dense, cycles, phase))))

    def shape(tau: NDArray[np.float64]) -> NDArray[np.float64]:
        return mavroeidis_papageorgiou(tau, cycles, phase) / peak

    given = [key for key in ("amplitude", "velocity_amplitude") if key in query.values]
    if len(given) != 1:
        raise RecordError(
            f"{query.source}: give either amplitude (peak acceleration) or velocity_amplitude"
        )
    if given == ["amplitude"]:
        amplitude = query.acceleration("amplitude")
    else:
        amplitude = query.quantity("velocity_amplitude", "velocity") * peak / period
    return _Pulse(shape, cycles, fits=False), amplitude


def _sampling(query: Query, pulse: _Pulse, period: float) -> tuple[float, int]:
    length = pulse.periods * period
    dt = query.quantity("dt", "time", period / _STEPS_PER_PERIOD)
    if not 0.0 < dt <= 0.25 * period:
        raise RecordError(
            f"{query.source}: dt = {dt:g} s must be positive and at most a quarter of the period"
        )
    if length / dt > 1e7:
        raise RecordError(
            f"{query.source}: dt = {dt:g} s makes {length / dt:.3g} samples; raise it"
        )
    steps = round(length / dt)
    if not pulse.fits:
        return dt, math.ceil(length / dt - 1e-6)
    if abs(length / dt - steps) > 1e-6:
        raise RecordError(
            f"{query.source}: dt = {dt:g} s does not divide the pulse of {length:g} s, which has "
            f"to end on a sample; the nearest that does is dt={length / steps:.10g}"
        )
    return dt, steps
