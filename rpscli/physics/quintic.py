"""First passage of a smooth function through zero within a step.

Over one step a function f with f, f' and f'' known at both ends is the quintic

    f(h t) = sum_i b_i C(5, i) t^i (1 - t)^(5 - i),    0 <= t <= 1,

whose Bernstein coefficients b_i follow from the end values directly. A polynomial lies
within the hull of its coefficients: if none is negative there is no passage, however the
curve bends between the ends. This is the whole test of a step without event, and it
cannot overlook a dip below zero and back. Where it fails, the interval is halved until
the coefficients change sign once, which means exactly one root (G. Farin, Curves and
Surfaces for CAGD, on variation diminution).

A start at exactly zero is no passage unless the curve leaves downwards, so a search may
begin on the very event that was handled last.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from rpscli.physics.compile import compiled, inlined

Quintic: TypeAlias = tuple[float, float, float, float, float, float]

NO_PASSAGE = 2.0
"""Returned instead of a t in [0, 1]."""

SETTLED = 1e-9
"""Relative correction at which Newton's method stops: its square, the error left, is less
than rounding; at a double root, which is not known any better, the error is as large."""

DEEPEST_HALVING = 40
"""Pieces of 2^-40 of a step are below rounding: a contact of two roots there is one."""


@compiled
def quintic(
    h: float, f0: float, df0: float, ddf0: float, f1: float, df1: float, ddf1: float
) -> Quintic:
    """Bernstein coefficients of the Hermite quintic over a step of length h [h s]."""
    d0 = 0.2 * h * df0
    d1 = 0.2 * h * df1
    c0 = 0.05 * (h * h) * ddf0
    c1 = 0.05 * (h * h) * ddf1
    return (f0, f0 + d0, f0 + 2.0 * d0 + c0, f1 - 2.0 * d1 + c1, f1 - d1, f1)


@inlined
def cubic(h: float, value: float, slope: float, end: float, end_slope: float) -> Quintic:
    """The cubic through values and slopes at both ends of a step."""
    mean = (end - value) / h if h > 0.0 else 0.0
    per_h = 1.0 / h if h > 0.0 else 0.0
    bend = (6.0 * mean - 4.0 * slope - 2.0 * end_slope) * per_h
    end_bend = (2.0 * slope + 4.0 * end_slope - 6.0 * mean) * per_h
    return quintic(h, value, slope, bend, end, end_slope, end_bend)


@compiled
def lower_hull(b: Quintic) -> float:
    """No value of the quintic after its start is below this."""
    return min(b[1], b[2], b[3], b[4], b[5])


@compiled
def upper_hull(b: Quintic) -> float:
    """No value of the quintic after its start is above this."""
    return max(b[1], b[2], b[3], b[4], b[5])


@compiled
def offset(b: Quintic, sign: float, level: float) -> Quintic:
    """Coefficients of sign (f - level)."""
    return (
        sign * (b[0] - level),
        sign * (b[1] - level),
        sign * (b[2] - level),
        sign * (b[3] - level),
        sign * (b[4] - level),
        sign * (b[5] - level),
    )


@compiled
def value(b: Quintic, t: float) -> float:
    """f at t."""
    r = 1.0 - t
    t2 = t * t
    r2 = r * r
    ends = b[0] * r2 * r2 * r + b[5] * t2 * t2 * t
    return ends + 5.0 * t * r * (
        b[1] * r2 * r + b[4] * t2 * t + 2.0 * t * r * (b[2] * r + b[3] * t)
    )


@compiled
def first_descent(b: Quintic, piece: NDArray[np.float64]) -> float:
    """Smallest t in [0, 1] from which f < 0, or `NO_PASSAGE` [piece (6,)]."""
    stays = min(lower_hull(b), b[0]) >= 0.0
    return NO_PASSAGE if stays else search_descent(b, piece)


@compiled
def search_descent(b: Quintic, piece: NDArray[np.float64]) -> float:
    """First descent of a quintic whose hull does not say that there is none [piece
    (6,)].
    """
    level = 0
    index = 0
    while True:
        width = 0.5**level
        restrict(b, index * width, (index + 1) * width, piece)
        changes, leaving = sign_pattern(piece)
        if leaving < 0:
            return index * width
        if changes == 1 or (changes > 1 and level == DEEPEST_HALVING):
            return (index + descent_in(piece)) * width
        if changes == 0:
            index += 1
            while index % 2 == 0 and level > 0:
                index //= 2
                level -= 1
            if level == 0:
                return NO_PASSAGE
        else:
            level = level + 1
            index = 2 * index


@compiled
def restrict(b: Quintic, start: float, end: float, piece: NDArray[np.float64]) -> None:
    """Coefficients over [start, end], by de Casteljau's scheme from
    either end; writes `piece`.
    """
    for i in range(6):
        piece[i] = b[i]
    if start == 0.0 and end == 1.0:
        return
    for j in range(1, 6):
        for i in range(5, j - 1, -1):
            piece[i] = (1.0 - end) * piece[i - 1] + end * piece[i]
    t = start / end
    for j in range(1, 6):
        for i in range(6 - j):
            piece[i] = (1.0 - t) * piece[i] + t * piece[i + 1]


@compiled
def sign_pattern(piece: NDArray[np.float64]) -> tuple[int, int]:
    """Number of sign changes, zeros left out, and the sign of the
    first coefficient not zero.
    """
    changes = 0
    first = 0
    last = 0
    for i in range(6):
        sign = 1 if piece[i] > 0.0 else (-1 if piece[i] < 0.0 else 0)
        if sign == 0:
            continue
        if last == 0:
            first = sign
        elif sign != last:
            changes += 1
        last = sign
    return changes, first


@compiled
def descent_in(piece: NDArray[np.float64]) -> float:
    """The root of a piece that changes sign once, downwards: Newton's
    method inside a bracket.
    """
    b = (piece[0], piece[1], piece[2], piece[3], piece[4], piece[5])
    low = 0.0
    high = 1.0
    t = b[0] / (b[0] - b[5]) if b[0] > 0.0 > b[5] else 0.5  # where the chord crosses
    for _ in range(100):
        f = value(b, t)
        if f >= 0.0:
            low = t
        else:
            high = t
        fall = slope(b, t)
        better = t - f / fall if fall < 0.0 else -1.0
        if not low <= better <= high:
            better = 0.5 * (low + high)
        if abs(better - t) <= SETTLED * t:
            return better
        t = better
    return t


@compiled
def slope(b: Quintic, t: float) -> float:
    """df/dt at t."""
    r = 1.0 - t
    r2 = r * r
    t2 = t * t
    return 5.0 * (
        (b[1] - b[0]) * (r2 * r2)
        + 4.0 * (b[2] - b[1]) * (r * r2) * t
        + 6.0 * (b[3] - b[2]) * r2 * t2
        + 4.0 * (b[4] - b[3]) * r * (t * t2)
        + (b[5] - b[4]) * (t2 * t2)
    )


@compiled
def peak_in_step(path: Quintic) -> tuple[float, float]:
    """Fraction of the step and height of the tilt's maximum, where x' falls through zero.

    Bisection of the slope: it never leaves the step, and is rarely needed.
    """
    low = 0.0
    high = 1.0
    for _ in range(50):
        t = 0.5 * (low + high)
        if slope(path, t) > 0.0:
            low = t
        else:
            high = t
    return low, value(path, low)
