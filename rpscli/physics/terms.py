"""The motion of one lane within a step: the polynomials that `series` leaves behind."""

from __future__ import annotations

from typing import TypeAlias

from rpscli.physics.layout import (
    DQ,
    NEXT_DQ,
    NEXT_Q,
    NEXT_RATE,
    NEXT_TILT,
    NEXT_TURN,
    RATES,
    STEP,
    TILT,
    TURN,
    Q,
)
from rpscli.physics.parameters import Floats
from rpscli.physics.part import part, routine

Terms: TypeAlias = tuple[float, float, float, float, float, float, float, float]
"""Terms of order 0 to `layout.ORDER` of a velocity, as powers of the fraction of the step."""

SETTLED = 1e-8
"""A correction so small leaves its square, less than rounding."""


@part
def value(c: Terms, t: float) -> float:
    """The sum of c_k t^k."""
    late = c[4] + t * (c[5] + t * (c[6] + t * c[7]))
    return c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * late)))


@part
def integral(c: Terms, t: float) -> float:
    """The sum of c_k t^(k + 1)/(k + 1)."""
    late = c[4] * 0.2 + t * (c[5] * (1.0 / 6.0) + t * (c[6] * (1.0 / 7.0) + t * (c[7] * 0.125)))
    return t * (c[0] + t * (c[1] * 0.5 + t * (c[2] * (1.0 / 3.0) + t * (c[3] * 0.25 + t * late))))


@part
def slope(c: Terms, t: float) -> float:
    """The sum of k c_k t^(k - 1)."""
    late = 4.0 * c[4] + t * (5.0 * c[5] + t * (6.0 * c[6] + t * (7.0 * c[7])))
    return c[1] + t * (2.0 * c[2] + t * (3.0 * c[3] + t * late))


@part
def tilt_terms(s: Floats) -> Terms:
    """Terms of x', from the numbers of a lane."""
    r = RATES
    return (s[r], s[r + 1], s[r + 2], s[r + 3], s[r + 4], s[r + 5], s[r + 6], s[r + 7])


@part
def modal_terms(x: Floats, r: int) -> Terms:
    """Terms of the velocity of mode r, from the blocks of a lane."""
    k = DQ
    return (
        x[k, r],
        x[k + 1, r],
        x[k + 2, r],
        x[k + 3, r],
        x[k + 4, r],
        x[k + 5, r],
        x[k + 6, r],
        x[k + 7, r],
    )


@part
def meet(s: Floats, level: float, guess: float) -> float:
    """Fraction of the step at which the tilt is at a level: Newton's method from near it.

    A path that only grazes the level may have no root; the guess then stands.
    """
    t, h, rates = guess, s[STEP], tilt_terms(s)
    height = level - s[TILT]
    for _ in range(8):
        advance = h * value(rates, t)
        change = (height - h * integral(rates, t)) / advance if advance != 0.0 else 2.0
        if not 0.0 <= t + change <= 1.0:
            break
        t += change
        if abs(change) < SETTLED:
            break
    return t


@routine
def end_at(s: Floats, x: Floats, t: float, level: float) -> None:
    """Make a fraction t of the step its end, where the tilt is at a level.

    `s` are the numbers and `x` the blocks of a lane.
    """
    h, rates = s[STEP], tilt_terms(s)
    s[NEXT_TILT], s[NEXT_RATE] = level, value(rates, t)
    s[NEXT_TURN] = slope(rates, t) / h if h > 0.0 else s[TURN]
    for r in range(x.shape[1]):
        rates = modal_terms(x, r)
        x[NEXT_Q, r], x[NEXT_DQ, r] = x[Q, r] + h * integral(rates, t), value(rates, t)
    s[STEP] = t * h
