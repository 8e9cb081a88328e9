"""The outline of a leaning column and its contacts, true to scale, for pictures."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rpscli.model.bearing import Bearing

Array = NDArray[np.float64]

ARC_POINTS = 12


def upright_outline(bearing: Bearing) -> Array:
    """Corners of the upright column about its centre, (points, 2) [m], counter-clockwise.

    ::

        .---.      flat part up to B, an arc of radius r up to B', straight sides
       (     )
        |   |
       (     )
        '---'
    """
    H, B, r = bearing.half_height, bearing.half_width, bearing.radius
    turn = np.linspace(0.0, bearing.beta, ARC_POINTS if bearing.beta > 0.0 else 1)
    x = B + r * np.sin(turn)
    y = -H + r * (1.0 - np.cos(turn))
    corner = np.column_stack([x, y])  # bottom right, outwards
    upper = corner[::-1] * (1.0, -1.0)
    right = np.vstack([corner, upper])
    return np.vstack([right, -right])


def leaning_outline(bearing: Bearing, rotation: float, displacement: float, lift: float) -> Array:
    """Corners of the column at a rotation, (points, 2) [m]; upright it stands on the origin.

    Parameters
    ----------
    rotation
        theta [rad], positive about the right edge: clockwise.
    displacement, lift
        u_b and v_b of the cap beam [m]; the column's centre makes half of both.
    """
    cosine, sine = math.cos(rotation), math.sin(rotation)
    turn = np.array([[cosine, -sine], [sine, cosine]])
    centre = (0.5 * displacement, bearing.half_height + 0.5 * lift)
    return np.asarray(upright_outline(bearing) @ turn + centre)


def contact_points(bearing: Bearing, rotation: float, displacement: float, lift: float) -> Array:
    """Where a leaning column touches ground and cap beam, (2, 2) [m]; arguments as above.

    It has rolled the arc's length r |theta| beyond the edge of the flat part, up to r beta.
    """
    side = math.copysign(1.0, rotation)
    reach = side * (bearing.half_width + bearing.radius * min(abs(rotation), bearing.beta))
    return np.array([[reach, 0.0], [displacement - reach, 2.0 * bearing.half_height + lift]])
