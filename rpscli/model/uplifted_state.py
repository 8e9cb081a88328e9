"""Start of an uplifted state: the constants of its linear equations (Theory (6.1) to (6.3))."""

from __future__ import annotations

import cmath
import math
from typing import NamedTuple

from rpscli.model.bearing import Bearing
from rpscli.physics import geometry


class UpliftedState(NamedTuple):
    """Contact geometry at one tilt; lengths of the columns over R, derivatives by the tilt x."""

    rotation: float
    """x [rad]."""
    arm: float
    """B."""
    height: float
    """C, so that u_b' = 2 R C x'."""
    kappa: float
    """B', the storey's dimensionless stiffness."""
    squared_distance: float
    """S = B^2 + C^2; 1 to first order."""
    elongation: tuple[float, float, float]
    """e, e' and e'' of a tendon in the axis [m]."""


def uplifted_state(bearing: Bearing, *, rolling: bool, exact: bool = True) -> UpliftedState:
    """The state where it begins, or the paper's.

    Parameters
    ----------
    bearing
        Shape of every column.
    rolling
        On the arcs; else rocking on their ends.
    exact
        At the tilt where the state begins: 0 rolling, beta rocking. Else to first order in alpha,
        and rocking continued to theta = 0.
    """
    if not exact:
        diameter = 2.0 * bearing.semi_diagonal
        a = bearing.alpha if rolling else bearing.alpha_wedge
        kappa = 2.0 * bearing.curvature_ratio - 1.0 if rolling else -1.0
        # e = 2 R (a x + (kappa + 1) x^2/2)
        return UpliftedState(0.0, a, 1.0, kappa, 1.0, (0.0, diameter * a, diameter * (kappa + 1.0)))
    phase, x = (bearing.rolling, 0.0) if rolling else (bearing.rocking, bearing.beta)
    cosine, sine = math.cos(x), math.sin(x)
    B = geometry.contact_arm(phase, cosine, sine)
    C = geometry.contact_height(phase, cosine, sine)
    kappa = phase.q * cosine - phase.p * sine
    return UpliftedState(x, B, C, kappa, B * B + C * C, _elongation(bearing, x))


def _elongation(bearing: Bearing, x: float) -> tuple[float, float, float]:
    """At theta = 0, or where the contact has arrived at the arc's end and stays there."""
    B, r = bearing.half_width, 0.0 if bearing.is_flat else bearing.radius
    if x == 0.0:
        return 0.0, 2.0 * B, 2.0 * r
    # The middle of an end moves by z = reach - edge exp(-i x); e = 2 |z|.
    edge = complex(B + r * math.sin(x), r * (1.0 - math.cos(x)))
    turned = edge * cmath.exp(-1j * x)
    z = B + r * x - turned
    away = (z.conjugate() * 1j * turned).real
    bend = abs(turned) ** 2 + (z.conjugate() * turned).real
    distance = abs(z)
    return 2.0 * distance, 2.0 * away / distance, 2.0 * (bend - (away / distance) ** 2) / distance
