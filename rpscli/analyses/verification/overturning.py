"""Least pulses that overturn a block: a closed form, and numbers that others published."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.demand import demand
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.verification.known import (
    LINEAR,
    ROUNDED_GRAVITY,
    SLENDER,
    Comparison,
    Known,
    block,
    compare,
    motion,
    slender_block,
    within,
)
from rpscli.model.podium import PodiumStructure

Array = NDArray[np.float64]

THRESHOLD = "Half-sine of 1 s, slender block, no impact (linear theory)"
ANY_PULSE = "Polygonal pulse of 0.8 s, slender block, no impact (linear theory)"
PUBLISHED = "Pulses of 1 s on blocks (Makris and Roussos, Geotechnique 50, 2000)"

DT = 1.0 / 2000.0
KNOTS, HEIGHTS = np.array([0.0, 0.2, 0.3, 0.7, 0.8]), np.array([0.0, 1.0, 0.4, 0.8, 0.0])
_T = np.arange(2001) * DT
SHAPES = {
    "half-sine": np.sin(2.0 * np.pi * _T[:1001]),
    "sine": np.sin(2.0 * np.pi * _T),
    "cosine": np.cos(2.0 * np.pi * _T),
    "polygon": np.interp(_T[:1601], KNOTS, HEIGHTS),
}
CHORDS = (2.0 * math.pi * DT) ** 2 / 8.0
"""A sine sampled every DT is cut off by at most this share: 1.2e-6."""


class Overturned(NamedTuple):
    """A block of half sizes [m], its pulse, linear or nonlinear, and the least amplitude [g]."""

    half_width: float
    half_height: float
    pulse: str
    theory: str
    least: Known


# The authors give the amplitudes of two runs, one that stands and one that falls, mostly 0.001 g
# apart: that is the tolerance. Only the limit of the sine on the nonlinear block has more digits.
EXPECTED = (
    Overturned(0.2, 0.6, "half-sine", "linear", Known(0.5545, 0.0005)),
    Overturned(0.5, 1.5, "sine", "linear", Known(0.4514, 0.0005)),
    Overturned(0.5, 1.5, "sine", "nonlinear", Known(0.46873, 1e-5)),
    Overturned(0.5, 1.5, "cosine", "nonlinear", Known(0.6250, 0.001)),
)


def pulses() -> Iterator[Comparison]:
    """Least amplitudes by bisection."""
    for size in (0.4, 1.5, 4.0):
        structure = slender_block(size)
        expected = half_sine_threshold(math.sqrt(0.75 * structure.gravity / size))
        found = least_amplitude(structure, "half-sine", SLENDER * expected) / SLENDER
        known = within(expected, LINEAR + 2.0 * CHORDS)
        yield compare(THRESHOLD, f"a_p/(g alpha), R = {size:g} m", "-", known, found)
    for size in (1.0, 3.0):
        structure = slender_block(size)
        expected = polygon_threshold(math.sqrt(0.75 * structure.gravity / size))
        found = least_amplitude(structure, "polygon", SLENDER * expected) / SLENDER
        known = within(expected, LINEAR)
        yield compare(ANY_PULSE, f"a_p/(g alpha), R = {size:g} m", "-", known, found)
    for row in EXPECTED:
        real = block(row.half_width, row.half_height, gravity=ROUNDED_GRAVITY)
        least = row.least.value
        if row.theory == "linear":
            # The slender block of the same size and restitution, in units of alpha.
            alpha, size = real.bearing.alpha, real.bearing.semi_diagonal
            slender = slender_block(size, real.restitution, ROUNDED_GRAVITY)
            found = least_amplitude(slender, row.pulse, least * SLENDER / alpha) * alpha / SLENDER
        else:
            found = least_amplitude(real, row.pulse, least)
        sizes = f"b = {row.half_width:g} m, h = {row.half_height:g} m"
        yield compare(PUBLISHED, f"{row.pulse}, {sizes}, {row.theory}", "g", row.least, found)


def half_sine_threshold(p: float) -> float:
    """a_p/(alpha g) = 1/sin(psi), with (w/p) sin psi - cos psi = exp[-(p/w)(pi - psi)]."""
    from scipy.optimize import brentq

    w = 2.0 * math.pi

    def excess(psi: float) -> float:
        return w / p * math.sin(psi) - math.cos(psi) - math.exp(-p / w * (math.pi - psi))

    return 1.0 / math.sin(float(brentq(excess, 1e-3, 0.5 * math.pi, xtol=1e-14)))


def polygon_threshold(p: float) -> float:
    """a_p/(alpha g) for which the integral of exp(-s) a/(g alpha) from uplift is 1, s = p t."""
    from scipy.optimize import brentq

    def excess(amplitude: float) -> float:
        # Uplift is on the first side; each side is integrated exactly.
        times = np.concatenate(([KNOTS[1] / amplitude], KNOTS[1:]))
        a = amplitude * np.interp(times, KNOTS, HEIGHTS)
        decay = np.exp(-p * (times - times[0]))
        slopes = np.diff(a) / np.diff(times)
        sides = a[:-1] * decay[:-1] - a[1:] * decay[1:] + slopes / p * (decay[:-1] - decay[1:])
        return float(np.sum(sides)) - 1.0

    return float(brentq(excess, 1.05, 50.0, xtol=1e-13))


def least_amplitude(structure: PodiumStructure, pulse: str, near: float) -> float:
    """The least amplitude that overturns [g], sought within 5 % of a value; NaN beyond that."""
    low, high = 0.95 * near, 1.05 * near
    if _overturns(structure, low, pulse) or not _overturns(structure, high, pulse):
        return math.nan
    while high - low > 4e-7 * high:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if _overturns(structure, middle, pulse) else (middle, high)
    return 0.5 * (low + high)


def _overturns(structure: PodiumStructure, amplitude: float, pulse: str) -> bool:
    # Near the limit the distance to it grows as exp(p t): after 18/p by 6e7.
    settings = TimeHistorySettings(free_vibration=18.0 / structure.rigid_frequency_parameter)
    record = motion(amplitude * structure.gravity * SHAPES[pulse], DT)
    return demand(structure, record, settings).outcome.startswith("overturned")
