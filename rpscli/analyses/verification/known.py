"""Numbers that are known beside those that the program finds, and of which structures."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from rpscli.constants import STANDARD_GRAVITY
from rpscli.model.bearing import Bearing
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import RayleighDamping, Superstructure, profile_stiffnesses
from rpscli.records.ground_motion import GroundMotion


@dataclass(frozen=True)
class Known:
    """A number that should come out, and the largest difference that is still agreement."""

    value: float
    tolerance: float


def printed(digits: str, units: float = 0.5) -> Known:
    """A printed number; the tolerance is half of its last digit, or so many of them."""
    decimals = len(digits.partition(".")[2])
    return Known(float(digits), float(f"{units * 10.0**-decimals:.6g}"))


def within(value: float, share: float) -> Known:
    """A number that holds up to a share of it."""
    return Known(value, abs(value) * share)


@dataclass(frozen=True)
class Comparison:
    """One line of a verification: what is compared, of which structure, both values in one unit.

    `certified_digits` are those of a certified problem, whose computed value may be missing (NaN).
    """

    group: str
    quantity: str
    unit: str
    expected: float
    computed: float
    tolerance: float
    certified_digits: int = 0

    @property
    def holds(self) -> bool:
        """Whether the computed value is close enough; one that is not a number never is."""
        return abs(self.computed - self.expected) <= self.tolerance

    @property
    def digits(self) -> float | None:
        """Correct ones of an answer to a certified problem, at most those that are certified."""
        if not self.certified_digits or math.isnan(self.computed):
            return None
        off = abs(self.computed / self.expected - 1.0)
        return max(-math.log10(max(off, 10.0**-self.certified_digits)), 0.0)

    @property
    def verdict(self) -> str:
        """In a word, or how many digits are correct."""
        if self.digits is not None:
            return f"{self.digits:.1f} digits"
        return "agrees" if self.holds else "missing" if math.isnan(self.computed) else "DIFFERS"


def compare(group: str, quantity: str, unit: str, known: Known, computed: float) -> Comparison:
    """The comparison of a known number with a computed one."""
    return Comparison(group, quantity, unit, known.value, float(computed), known.tolerance)


FLAT = 0.0
"""Curvature ratio of flat ends."""

SLENDER = 1e-3
"""A tan(alpha) at which the linear theory leaves out terms of alpha^2 = 1e-6 only."""

LINEAR = 3.0 * SLENDER**2
"""What the linear theory leaves out then, relative."""

ROUNDED_GRAVITY = 9.81
"""The gravity of other authors [m/s2]."""


def paper_podium(
    storeys: int, tan_alpha: float, rho: float, semi_diagonal: float = 1.5
) -> PodiumStructure:
    """The paper's: gamma = 10, eta = n, T1 = n/10 s, 5 % in modes 1 and 2 (Theory, section 7)."""
    masses = np.full(storeys, 2e5)
    stiffnesses = profile_stiffnesses(masses, storeys / 10.0, "sine")
    building = Superstructure(masses, stiffnesses, RayleighDamping(0.05, (1, 2)))
    bearing = Bearing(semi_diagonal, tan_alpha, 2.0 * tan_alpha if rho else tan_alpha, rho)
    return PodiumStructure(bearing, 2e4, 2e5, building, ImpactLaw("rigid"))


def block(
    half_width: float,
    half_height: float,
    restitution: float | None = None,
    gravity: float = STANDARD_GRAVITY,
) -> PodiumStructure:
    """A rectangular block that stands alone; Housner's restitution unless it is given."""
    law = ImpactLaw() if restitution is None else ImpactLaw("value", restitution)
    slope = half_width / half_height
    bearing = Bearing(math.hypot(half_width, half_height), slope, slope, FLAT)
    return PodiumStructure(bearing, 1e3, 0.0, None, law, gravity)


def slender_block(
    size: float, restitution: float | None = None, gravity: float = STANDARD_GRAVITY
) -> PodiumStructure:
    """A block of semi-diagonal `size` so slender that it obeys the linear theory."""
    alpha = math.atan(SLENDER)
    return block(size * math.sin(alpha), size * math.cos(alpha), restitution, gravity)


def motion(acceleration: ArrayLike, dt: float) -> GroundMotion:
    """A ground motion from its samples [m/s2]."""
    return GroundMotion(np.asarray(acceleration, dtype=float), dt, "made", "made", "made")
