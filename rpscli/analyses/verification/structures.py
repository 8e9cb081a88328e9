"""Structures with known answers: those of the paper, single blocks, and ground motions for them."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from rpscli.constants import STANDARD_GRAVITY
from rpscli.model.bearing import Bearing
from rpscli.model.damping import RayleighDamping
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import Superstructure, profile_stiffnesses
from rpscli.records.ground_motion import GroundMotion

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
    """The paper's: gamma = 10, eta = n, T1 = n/10 s, 5 % in modes 1 and 2 (Theory, section 7).

    Parameters
    ----------
    storeys
        n.
    tan_alpha
        Slenderness.
    rho
        Radius of the arcs; 0 for flat ends.
    semi_diagonal
        R [m].
    """
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
    """A rectangular block that stands alone; Housner's restitution unless it is given.

    Parameters
    ----------
    half_width, half_height
        [m].
    restitution
        e; None for Housner's.
    gravity
        g [m/s2].
    """
    law = ImpactLaw() if restitution is None else ImpactLaw("value", restitution)
    slope = half_width / half_height
    bearing = Bearing(math.hypot(half_width, half_height), slope, slope, FLAT)
    return PodiumStructure(bearing, 1e3, 0.0, None, law, gravity)


def slender_block(
    size: float, restitution: float | None = None, gravity: float = STANDARD_GRAVITY
) -> PodiumStructure:
    """A block of semi-diagonal `size` so slender that it obeys the linear theory.

    Parameters
    ----------
    size
        Semi-diagonal R [m].
    restitution
        e; None for Housner's.
    gravity
        g [m/s2].
    """
    alpha = math.atan(SLENDER)
    return block(size * math.sin(alpha), size * math.cos(alpha), restitution, gravity)


def motion(acceleration: ArrayLike, dt: float) -> GroundMotion:
    """A ground motion from its samples [m/s2].

    Parameters
    ----------
    acceleration
        (npts,) [m/s2].
    dt
        Sampling interval [s].
    """
    return GroundMotion(np.asarray(acceleration, dtype=float), dt, "made", "made", "made")
