"""Elastic response spectra, by the exact response to acceleration linear between samples.

With s = -xi w + i w_d, the integral q of exp(s (t - tau)) times the ground acceleration has the
displacement -Im(q)/w_d and the velocity -Im(s q)/w_d. The step-by-step solution (N. C. Nigam and
P. C. Jennings, Bull. Seism. Soc. Am. 59, 1969) is then a recursion of first order, which one call
of a digital filter runs through.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rpscli.errors import RecordError, require_kind
from rpscli.records.ground_motion import GroundMotion
from rpscli.shown import Shown

_SAMPLES_PER_PERIOD = 50  # so that the largest sample is within 0.2 % of the peak
_FINEST = 64  # parts of a step; oscillators with periods below a step just follow the ground

SHORTEST = 1e-6  # of periods [s]; 0 is the rigid oscillator
DAMPING = 0.05


@dataclass(frozen=True, eq=False, repr=False)
class ResponseSpectrum(Shown):
    """Peak responses of linear oscillators, unsigned, each of shape (n,)."""

    periods: NDArray[np.float64]
    """[s]."""
    damping: float
    """Share of critical damping."""
    displacement: NDArray[np.float64]
    """Relative to the ground [m]."""
    pseudo_acceleration: NDArray[np.float64]
    """(2 pi/T)^2 times the displacement; the PGA at T = 0 [m/s2]."""
    total_acceleration: NDArray[np.float64]
    """Of the mass, in the inertial frame; the PGA at T = 0 [m/s2]."""


def response_spectrum(
    motion: GroundMotion, periods: Sequence[float] | NDArray[np.float64], damping: float = 0.05
) -> ResponseSpectrum:
    """Response spectrum of a motion; the free vibration after its end counts.

    Parameters
    ----------
    motion : GroundMotion
        Horizontal ground acceleration.
    periods : sequence of float [s]
        Not negative; zero is the rigid oscillator.
    damping : float
        Share of critical damping, from 0 up to but below 1.

    Raises
    ------
    RecordError
        If a period or the damping is out of range.

    Examples
    --------
    >>> motion = GroundMotion(np.array([1.0, 1.0]), 10.0, "step", "", "")
    >>> spectrum = response_spectrum(motion, [1.0], damping=0.0)
    >>> round(float(spectrum.pseudo_acceleration[0]), 2)  # a sudden load counts twice
    2.0
    """
    require_kind(motion, GroundMotion, "the motion", "load_record(...) reads one")
    try:
        wanted = np.array(periods, dtype=np.float64)
    except (TypeError, ValueError):
        wanted = np.array([np.nan])
    if not (np.isfinite(wanted) & ((wanted == 0.0) | (wanted >= SHORTEST))).all():
        raise RecordError(
            f"periods of a response spectrum must be 0 or from {SHORTEST:g} s on:"
            f" {str(periods)[:60]}"
        )
    if not 0.0 <= damping < 1.0:
        raise RecordError(f"the damping of a response spectrum, {damping}, must be in [0, 1)")
    peaks = np.tile([0.0, motion.pga], (wanted.size, 1))
    for place in np.flatnonzero(wanted):
        histories = _histories(motion, float(wanted[place]), damping)
        peaks[place] = [np.max(np.abs(each)) for each in histories]
    with np.errstate(divide="ignore"):
        stiffness = (2.0 * np.pi / wanted) ** 2
    pseudo = np.full(wanted.shape, motion.pga)
    np.multiply(stiffness, peaks[:, 0], out=pseudo, where=wanted > 0.0)
    return ResponseSpectrum(wanted, damping, peaks[:, 0], pseudo, peaks[:, 1])


def spectral_acceleration(motion: GroundMotion, period: float, damping: float = 0.05) -> float:
    """Pseudo-acceleration Sa(T) [m/s2] at one period; the PGA at T = 0."""
    return float(response_spectrum(motion, [period], damping).pseudo_acceleration[0])


def pseudo_acceleration_history(
    motion: GroundMotion, period: float, damping: float
) -> NDArray[np.float64]:
    """Relative displacement of an oscillator times (2 pi/T)^2 [m/s2], on a step of its own."""
    if period == 0.0:
        return motion.acceleration
    return (2.0 * math.pi / period) ** 2 * _histories(motion, period, damping)[0]


def _histories(motion: GroundMotion, period: float, damping: float) -> list[NDArray[np.float64]]:
    """Displacement [m] and total acceleration [m/s2] of one oscillator."""
    from scipy.linalg import expm
    from scipy.signal import lfilter

    parts = min(_FINEST, max(1, math.ceil(_SAMPLES_PER_PERIOD * motion.dt / period)))
    fine = motion.finer(parts)
    quiet = np.zeros(math.ceil(period / fine.dt) + 1)  # one period after the end
    ground = np.concatenate([fine.acceleration, quiet])
    w = 2.0 * math.pi / period
    s = w * complex(-damping, math.sqrt(1.0 - damping**2))
    # Re(q), Im(q), the acceleration and its slope, as the closed formulae of the integrals lose
    # all digits where w dt is small.
    a, b = s.real * fine.dt, s.imag * fine.dt
    rows = [[a, -b, 1.0, 0.0], [b, a, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 0.0]]
    step = expm(np.array(rows))
    grown, _, level, slope = step[0] + 1j * step[1]
    last, first = fine.dt * slope, fine.dt * (level - slope)
    # At rest at the first sample, which may be a jump.
    q, _ = lfilter([last, first], [1.0, -grown], ground, zi=[-last * ground[0]])
    displacement, velocity = -q.imag / s.imag, -(s * q).imag / s.imag
    return [displacement, -(w**2) * displacement - 2.0 * damping * w * velocity]


def drawn_spectrum(motion: GroundMotion) -> ResponseSpectrum:
    """The spectrum of figures: up to 4 s, at 5 % of critical damping."""
    periods = np.concatenate([np.arange(0.0, 1.0, 0.02), np.arange(1.0, 4.01, 0.05)])
    return response_spectrum(motion, periods, DAMPING)
