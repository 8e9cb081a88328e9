"""An intensity measure: the acceleration spectrum intensity of Von Thun and others (1988)."""

from __future__ import annotations

import numpy as np

import rpscli
from rpscli.plugins import GroundMotion, IntensityMeasure


def spectrum_intensity(motion: GroundMotion, period: float, damping: float) -> float:
    """ASI [m/s]: the integral of Sa over periods of 0.1 to 0.5 s."""
    del period  # NaN: it is taken at none
    periods = np.linspace(0.1, 0.5, 41)
    spectrum = rpscli.response_spectrum(motion, periods, damping).pseudo_acceleration
    return float(np.trapezoid(spectrum, periods))


ASI = IntensityMeasure("m/s", spectrum_intensity)
