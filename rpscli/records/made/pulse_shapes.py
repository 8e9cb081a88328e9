"""Shapes of mathematical pulses: acceleration of unit peak over time in periods, from zero."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

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

    Parameters
    ----------
    tau : array, shape (n,)
        Time over the period, from the start of the pulse; it lasts `cycles` periods.
    cycles : float
        The paper's gamma, above 1: number of oscillations under the bell.
    phase : float [rad]
        The paper's nu: 0 makes velocity symmetric, pi/2 antisymmetric.

    Returns
    -------
    array, shape (n,) [1/s, for a period of 1 s]
        Derivative of (1 + cos(2 pi s/cycles)) cos(2 pi s + phase)/2, s = tau - cycles/2; zero
        outside the pulse.

    Notes
    -----
    Mavroeidis and Papageorgiou, BSSA 93(3), 2003, equation 3.
    """
    s = 2.0 * np.pi * (tau - 0.5 * cycles)
    inside = np.abs(s) <= np.pi * cycles
    bell = np.sin(s / cycles) * np.cos(s + phase)
    wave = cycles * np.sin(s + phase) * (1.0 + np.cos(s / cycles))
    return np.where(inside, -np.pi / cycles * (bell + wave), 0.0)
