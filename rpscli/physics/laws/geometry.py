"""Contact geometry of a kinematic bearing: three constants for each phase of motion.

A column of semi-diagonal R leans by x = |theta| >= 0.  It stands on an arc of radius r
while x < beta (rolling) and on the arc's end beyond (rocking)::

          .-----------.            k = 2 rho cos(alpha),  rho = r / 2H
         (             )
          |  H      .' |           flat part  2B   tan(alpha)  = B /H
          |       .' R |           wedge      2B'  tan(alpha') = B'/H
          |     +'     |
          |            |           sin(beta) = (tan alpha' - tan alpha) / (2 rho)
         (             )
    ______'-----------'______

Expanding sin(alpha - x), cos(alpha - x), ... in sin x and cos x leaves, in both phases,

    B(x) = p cos x + q sin x               lever arm of the weight, over R
    C(x) = c + p sin x - q cos x           height of the cap beam's path, over R

with  C' = B  and  B' = c - C, so one sine and one cosine give the
rest, Theory (1.9) to (1.11):

    S = B^2 + C^2 = p^2 + q^2 - c^2 + 2 c C
    u_b / 2R = u0 + c x - q sin x - p cos x        (odd in theta)
    v_b / 2R = v0 + p sin x - q cos x              (even in theta)

Every function takes floats or arrays; `laws` compiles them for the kernel. This module
itself needs numpy only.
"""

from __future__ import annotations

import math
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

Value = TypeVar("Value", float, NDArray[np.float64])


class Phase(NamedTuple):
    """Constants of one phase of motion (rolling or rocking), all dimensionless."""

    p: float  # B = p cos x + q sin x, C = c + p sin x - q cos x
    q: float  # B = p cos x + q sin x, C = c + p sin x - q cos x
    c: float  # B = p cos x + q sin x, C = c + p sin x - q cos x
    u0: float  # constants of |u_b|/2R and v_b/2R
    v0: float  # constants of |u_b|/2R and v_b/2R


def rolling_phase(alpha: float, rho: float) -> Phase:
    """Constants while the contact point travels along the arc (x < beta) [alpha rad]."""
    k = 2.0 * rho * math.cos(alpha)
    p = math.sin(alpha)
    q = k - math.cos(alpha)
    return Phase(p=p, q=q, c=k, u0=p, v0=q)


def rocking_phase(alpha: float, rho: float, beta: float) -> Phase:
    """Constants while the column pivots about the end of the arc (x >= beta)."""
    k = 2.0 * rho * math.cos(alpha)
    return Phase(
        p=math.sin(alpha) + k * math.sin(beta),
        q=k * (1.0 - math.cos(beta)) - math.cos(alpha),
        c=0.0,
        u0=math.sin(alpha) + k * beta,
        v0=-math.cos(alpha),
    )


def contact_arm(phase: Phase, cos_x: Value, sin_x: Value) -> Value:
    """B(x): horizontal distance of the weight from the contact, over R (Theory (1.6))."""
    return phase.p * cos_x + phase.q * sin_x


def contact_height(phase: Phase, cos_x: Value, sin_x: Value) -> Value:
    """C(x): du_b/dtheta = 2 R C (Theory (1.7), (1.8))."""
    return phase.c + phase.p * sin_x - phase.q * cos_x


def end_displacement(
    half_width: float,
    radius: float,
    rolled: tuple[Value, Value, Value],
    turned: tuple[Value, Value],
) -> tuple[Value, Value, Value]:
    """Ways of the middle of an end across and upwards, and of the contact from there.

    Parameters
    ----------
    half_width, radius
        B of the flat part and r of the arc, in any unit.
    rolled
        y = min(x, beta), sin(y) and 1 - cos(y).
    turned
        sin(x) and 1 - cos(x).
    """
    y, sin_y, less_y = rolled
    sin_x, less_x = turned
    across = half_width * less_x + radius * (
        (y - sin_y) + (sin_y * less_x - less_y * sin_x)
    )
    upwards = half_width * sin_x + radius * (sin_y * sin_x - less_y * (1.0 - less_x))
    return across, upwards, half_width + radius * y


def cap_beam_displacement(phase: Phase, x: Value, cos_x: Value, sin_x: Value) -> Value:
    """|u_b| / 2R [x rad] (Theory (1.4))."""
    return phase.u0 + phase.c * x - phase.q * sin_x - phase.p * cos_x


def cap_beam_lift(phase: Phase, cos_x: Value, sin_x: Value) -> Value:
    """v_b / 2R (Theory (1.5))."""
    return phase.v0 + phase.p * sin_x - phase.q * cos_x


def inertia(columns: float, beam: float, lifted: float, C2: Value, B2: Value) -> Value:
    """A(x): inertia against the tilt, over N m_c R^2 (2.2).

    Parameters
    ----------
    columns, beam, lifted
        I_o - 1, 1 + 4 gamma and 1 + 4 gamma (1 + eta): floors are lifted, and not pushed.
    C2, B2
        Squares of the arms of the cap beam's path and of its lift, over R.
    """
    return columns + beam * C2 + lifted * B2


def arm_root(phase: Phase) -> float:
    """Smallest positive x with B(x) = 0 if this phase went on for ever [rad]."""
    return math.atan2(phase.p, -phase.q)


def critical_rotation(rolling: Phase, rocking: Phase, beta: float) -> float:
    """theta_cr: the smallest positive root of B on the branch that
    is really travelled [rad].

    The column rolls up to beta and rocks beyond; B is continuous at beta, so a root of
    the rolling branch counts only if it lies before beta.
    """
    root = arm_root(rolling)
    return root if root <= beta else arm_root(rocking)


def path_along(
    rolling: Phase, rocking: Phase, beta: float, x: NDArray[np.float64]
) -> tuple[NDArray[np.float64], ...]:
    """B, C, u_b/2R and v_b/2R along an array of x >= 0, each in its own
    phase [beta rad, x rad].
    """
    cos_x = np.cos(x)
    sin_x = np.sin(x)
    rolls = x < beta
    one, two = (
        (
            contact_arm(phase, cos_x, sin_x),
            contact_height(phase, cos_x, sin_x),
            cap_beam_displacement(phase, x, cos_x, sin_x),
            cap_beam_lift(phase, cos_x, sin_x),
        )
        for phase in (rolling, rocking)
    )
    return tuple(np.where(rolls, a, b) for a, b in zip(one, two, strict=True))
