"""Intensity measures of a ground motion, all in SI units."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rpscli.constants import STANDARD_GRAVITY
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.measures.integration import displacement, velocity


@dataclass(frozen=True)
class IntensityMeasures:
    """Measures of one motion; peaks are unsigned and taken at the samples.

    Attributes
    ----------
    pga, pgv, pgd : float [m/s2, m/s, m]
        Peak ground acceleration, velocity and displacement; the ground starts from rest and no
        baseline is corrected.
    arias : float [m/s]
        Arias intensity, pi/(2 g) times the integral of the squared acceleration.
    cav : float [m/s]
        Cumulative absolute velocity, the integral of the absolute acceleration.
    d5_95 : float [s]
        Significant duration, from 5 % to 95 % of the Arias intensity.
    """

    pga: float
    pgv: float
    pgd: float
    arias: float
    cav: float
    d5_95: float


def intensity_measures(motion: GroundMotion) -> IntensityMeasures:
    """All measures of a motion.

    Notes
    -----
    Squares and absolute values are integrated by the trapezoidal rule, which is what published
    values use: for motions without content near the Nyquist frequency it is the more accurate
    one, while squares of the straight lines between samples fall short by dt/6 sum (a' dt)^2.

    References
    ----------
    A. Arias, in Seismic Design for Nuclear Power Plants, MIT Press, 1970.
    M. D. Trifunac and A. G. Brady, Bull. Seism. Soc. Am. 65, 1975 (duration).

    Examples
    --------
    >>> flat = GroundMotion(np.ones(101), 0.1, "flat", "", "")
    >>> measures = intensity_measures(flat)
    >>> round(measures.pgv, 9), round(measures.pgd, 9), round(measures.d5_95, 9)
    (10.0, 50.0, 9.0)
    """
    a, dt = motion.acceleration, motion.dt
    husid = _cumulative(a**2, dt)
    return IntensityMeasures(
        pga=motion.pga,
        pgv=float(np.max(np.abs(velocity(a, dt)))),
        pgd=float(np.max(np.abs(displacement(a, dt)))),
        arias=math.pi / (2.0 * STANDARD_GRAVITY) * float(husid[-1]),
        cav=float(_cumulative(np.abs(a), dt)[-1]),
        d5_95=_crossing(husid, 0.95, dt) - _crossing(husid, 0.05, dt),
    )


def _cumulative(values: NDArray[np.float64], dt: float) -> NDArray[np.float64]:
    return np.concatenate([[0.0], np.cumsum(0.5 * dt * (values[:-1] + values[1:]))])


def _crossing(husid: NDArray[np.float64], share: float, dt: float) -> float:
    # First time at which the curve reaches the share, interpolated; 0 for a motion of zeros.
    level = share * husid[-1]
    after = int(np.argmax(husid >= level))
    if after == 0:
        return 0.0
    before = after - 1
    return dt * (before + float((level - husid[before]) / (husid[after] - husid[before])))
