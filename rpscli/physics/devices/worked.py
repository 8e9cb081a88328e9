"""Stroke, rate and height of the devices of a lane at a motion."""

from __future__ import annotations

import math
from typing import NamedTuple

from rpscli.physics.compile import compiled
from rpscli.physics.energy import path_at
from rpscli.physics.lane import Polar, place_with, polar
from rpscli.physics.laws.geometry import end_displacement
from rpscli.physics.state import FULL_CONTACT, Record


class Worked(NamedTuple):
    """Strokes and rates at which the devices of a lane are worked."""

    tilt: Polar
    path: float  # |u_b| [m]
    along: float  # u_b' along the tilt and across it [m/s]
    across: float
    C: float  # height of the cap beam's path, over R
    # elongation of a tendon [m], de/dx, and the angle psi of its end from the vertical
    e: float
    lever: float
    sin_psi: float
    cos_psi: float


@compiled
def worked(
    s: Record, l: int, tilt: tuple[float, float], rate: tuple[float, float]
) -> Worked:
    """Strokes and rates of devices at a tilt and its rate."""
    now = polar(s, l, tilt, rate)
    diameter = s.diameter[l]
    if s.phase[l] == FULL_CONTACT:
        still = Polar(0.0, now.n, now.t, 0.0, 0.0)
        return Worked(still, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
    at = place_with(s, l, now.x, 0.0, 0.0)  # C and h know of no patch
    e = 0.0
    lever = 0.0
    sin_psi = 0.0
    cos_psi = 1.0
    if s.tendons[l] > 0:
        e, lever, sin_psi, cos_psi = tendon_elongation(s, l, now.x)
    out = diameter * at.C * now.p
    aside = diameter * at.h * now.q
    path = diameter * path_at(s, l, now.x)
    return Worked(now, path, out, aside, at.C, e, lever, sin_psi, cos_psi)


@compiled
def tendon_elongation(s: Record, l: int, x: float) -> tuple[float, float, float, float]:
    """Elongation e of a tendon, de/dx, and sine and cosine of psi, at a
    tilt x (11.7) to (11.10).

    The middle of either end moves by (M_1, M_2) from where it stood; with E its distance
    from there a tendon is longer by e = 2 E. Seen from the contact, which lies B + r x
    from that place along the ground while rolling and B + r beta while rocking, de/dx = 2
    cos(psi) times that distance.
    """
    y = x if s.rolls[l] > 0.0 else s.beta[l]
    half_sine = math.sin(0.5 * x)
    half_sine_y = math.sin(0.5 * y)
    across, upwards, reach = end_displacement(
        s.half_width[l],
        s.arc_radius[l],
        (y, math.sin(y), 2.0 * (half_sine_y * half_sine_y)),
        (math.sin(x), 2.0 * (half_sine * half_sine)),
    )
    distance = math.sqrt(across * across + upwards * upwards)
    if x < 0.0:  # on from upright as it came there, where a step may try
        distance = -distance
    sin_psi = 0.0
    cos_psi = 1.0
    if distance != 0.0:
        sin_psi = across / distance
        cos_psi = upwards / distance
    return 2.0 * distance, 2.0 * cos_psi * reach, sin_psi, cos_psi
