"""The motion of one lane within a step: the polynomials that the Taylor step leaves behind."""

from __future__ import annotations

from typing import TypeAlias

from rpscli.physics.compile import compiled
from rpscli.physics.state import Record

Terms: TypeAlias = tuple[float, float, float, float, float, float, float, float]
"""Terms of order 0 to `state.ORDER` of a velocity, as powers of the fraction of the step."""

SETTLED = 1e-8
"""A correction so small leaves its square, less than rounding."""


@compiled
def value(c: Terms, t: float) -> float:
    """The sum of c_k t^k.

    Parameters
    ----------
    c
        Coefficients c_0 to c_7.
    t
        Fraction of the step.
    """
    late = c[4] + t * (c[5] + t * (c[6] + t * c[7]))
    return c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * late)))


@compiled
def integral(c: Terms, t: float) -> float:
    """The sum of c_k t^(k + 1)/(k + 1).

    Parameters
    ----------
    c
        Coefficients c_0 to c_7.
    t
        Fraction of the step.
    """
    late = c[4] * 0.2 + t * (c[5] * (1.0 / 6.0) + t * (c[6] * (1.0 / 7.0) + t * (c[7] * 0.125)))
    return t * (c[0] + t * (c[1] * 0.5 + t * (c[2] * (1.0 / 3.0) + t * (c[3] * 0.25 + t * late))))


@compiled
def slope(c: Terms, t: float) -> float:
    """The sum of k c_k t^(k - 1).

    Parameters
    ----------
    c
        Coefficients c_0 to c_7.
    t
        Fraction of the step.
    """
    late = 4.0 * c[4] + t * (5.0 * c[5] + t * (6.0 * c[6] + t * (7.0 * c[7])))
    return c[1] + t * (2.0 * c[2] + t * (3.0 * c[3] + t * late))


@compiled
def rotation_terms(s: Record, l: int) -> Terms:
    """Terms of x' of a lane."""
    d = s.dtheta_terms
    return d[0, l], d[1, l], d[2, l], d[3, l], d[4, l], d[5, l], d[6, l], d[7, l]


@compiled
def modal_terms(s: Record, r: int, l: int) -> Terms:
    """Terms of the velocity of mode r of a lane."""
    d = s.dq
    return (
        d[0, r, l],
        d[1, r, l],
        d[2, r, l],
        d[3, r, l],
        d[4, r, l],
        d[5, r, l],
        d[6, r, l],
        d[7, r, l],
    )


@compiled
def fraction_at(s: Record, l: int, level: float, guess: float) -> float:
    """Fraction of the step at which the tilt is at a level: Newton's method from near it.

    A path that only grazes the level may have no root; the guess then stands.

    Parameters
    ----------
    level
        Tilt [rad].
    guess
        Fraction of the step.
    """
    t, h, terms = guess, s.step[l], rotation_terms(s, l)
    height = level - s.theta[l]
    for _ in range(8):
        advance = h * value(terms, t)
        change = (height - h * integral(terms, t)) / advance if advance != 0.0 else 2.0
        if not 0.0 <= t + change <= 1.0:
            break
        t += change
        if abs(change) < SETTLED:
            break
    return t


@compiled
def tilt_at(s: Record, l: int, t: float) -> float:
    """The tilt of a lane at a fraction t of its step.

    Parameters
    ----------
    t
        Fraction of the step.
    """
    return float(s.theta[l] + s.step[l] * integral(rotation_terms(s, l), t))


@compiled
def end_step_at(s: Record, l: int, t: float, level: float) -> None:
    """Make a fraction t of the step of a lane its end, where the tilt is at a level.

    Parameters
    ----------
    t
        Fraction of the step.
    level
        Tilt there [rad].
    """
    h, terms = s.step[l], rotation_terms(s, l)
    s.next_theta[l], s.next_theta_dot[l] = level, value(terms, t)
    s.next_theta_ddot[l] = slope(terms, t) / h if h > 0.0 else s.theta_ddot[l]
    for r in range(s.n):
        terms = modal_terms(s, r, l)
        s.next_q[r, l] = s.q[r, l] + h * integral(terms, t)
        s.next_dq[r, l] = value(terms, t)
    s.step[l] = t * h
