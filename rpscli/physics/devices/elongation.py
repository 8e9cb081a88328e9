"""How a tendon in the axis of a column is stretched by the tilt (Theory, section 11).

The middle of either end moves by (M_1, M_2) from where it stood; with E its distance from there a
tendon is longer by e = 2 E. Seen from the contact, which lies B + r x from that place along the
ground while rolling and B + r beta while rocking, de/dx = 2 cos(psi) times that distance, psi being
the angle of (M_1, M_2) with the vertical.
"""

from __future__ import annotations

import math

import numpy as np

from rpscli.physics.compile import compiled
from rpscli.physics.formulae.trigonometry import sine_cosine
from rpscli.physics.state import TERMS, Record

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)
NODES = tuple(float(0.5 + 0.5 * node) for node in _NODES)
WEIGHTS = tuple(float(0.5 * weight) for weight in _WEIGHTS)
"""Gauss and Legendre's rule over [0, 1]: exact to rounding for cos(x s), sin(x s) up to x = 3."""


@compiled
def opening(s: Record, l: int, x: float) -> tuple[float, float, float, float]:
    """Elongation e of a tendon, de/dx, and sine and cosine of psi, at a tilt x in its phase.

    Parameters
    ----------
    x
        Tilt in the present phase [rad].
    """
    sine, cosine = sine_cosine(x)
    B, r = s.half_width[l], s.arc_radius[l]
    reach = B + r * x
    across, upwards = B * (1.0 - cosine) + r * (x - sine), B * sine + r * (1.0 - cosine)
    if s.phase_c[l] == 0.0 and s.arc_end[l] > 0.0:
        sine_end, cosine_end = sine_cosine(s.arc_end[l])
        reach = B + r * s.arc_end[l]
        along, above = B + r * sine_end, r * (1.0 - cosine_end)
        across = reach - (along * cosine + above * sine)
        upwards = along * sine - above * cosine
    distance = math.sqrt(across * across + upwards * upwards)
    lean, rise = 0.0, 1.0
    if distance > 0.0:
        lean, rise = across / distance, upwards / distance
    return 2.0 * distance, 2.0 * rise * reach, lean, rise


@compiled
def expand_from_upright(s: Record, l: int) -> None:
    """Write (E/x)^2 in powers of x - x_0 to row 2 of `local`, while rolling or on flat ends.

    E has a zero at x = 0, where the tilt begins: M_1/x and M_2/x do not, with sin(x)/x and
    (1 - cos x)/x as means of cos(x s) and sin(x s) over s from 0 to 1.
    """
    x, B, r = s.theta[l], s.half_width[l], s.arc_radius[l]
    one, two, square = s.local[0], s.local[1], s.local[2]
    for k in range(TERMS + 1):
        one[k], two[k], square[k] = 0.0, 0.0, 0.0
    for i in range(len(NODES)):
        sine, cosine = sine_cosine(x * NODES[i])
        power = WEIGHTS[i]
        for k in range(TERMS + 1):
            one[k] += power * sine
            two[k] += power * cosine
            sine, cosine = cosine, -sine
            power *= NODES[i] / (k + 1.0)
    for k in range(TERMS + 1):
        across = B * one[k] - r * two[k] + (r if k == 0 else 0.0)
        one[k], two[k] = across, B * two[k] + r * one[k]
    for k in range(TERMS + 1):
        for j in range(k + 1):
            square[k] += one[j] * one[k - j] + two[j] * two[k - j]


@compiled
def expand_beyond_arc(s: Record, l: int) -> None:
    """Write E^2 in powers of x - x_0 to row 2 of `local`, while rocking about the end of an arc."""
    B, r, square = s.half_width[l], s.arc_radius[l], s.local[2]
    sine, cosine = sine_cosine(s.arc_end[l])
    reach, along, above = B + r * s.arc_end[l], B + r * sine, r * (1.0 - cosine)
    sine, cosine = sine_cosine(s.theta[l])
    part = 1.0
    for k in range(TERMS + 1):
        square[k] = -2.0 * reach * (along * cosine + above * sine) * part
        sine, cosine = cosine, -sine
        part /= k + 1.0
    square[0] += reach * reach + along * along + above * above


@compiled
def expand_opening(s: Record, l: int) -> None:
    """Write e, de/dx and the derivatives of that at the start of the step."""
    from_upright = s.phase_c[l] > 0.0 or s.arc_end[l] == 0.0
    if from_upright:
        expand_from_upright(s, l)
    else:
        expand_beyond_arc(s, l)
    square, root = s.local[2], s.local[3]
    root[0] = math.sqrt(square[0])
    for k in range(1, TERMS + 1):
        rest = square[k]
        for j in range(1, k):
            rest -= root[j] * root[k - j]
        root[k] = rest / (2.0 * root[0])
    x, factorial = s.theta[l], 1.0
    s.opening_terms[0, l] = 2.0 * (x * root[0] if from_upright else root[0])
    for k in range(1, TERMS + 1):
        factorial *= k
        distance = x * root[k] + root[k - 1] if from_upright else root[k]
        s.lever_terms[k - 1, 0, l] = 2.0 * factorial * distance
