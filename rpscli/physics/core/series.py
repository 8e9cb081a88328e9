"""Series that Taylor steps leave behind, sine and cosine, and a rule of quadrature."""

from __future__ import annotations

from typing import TypeAlias

from rpscli.physics.core.compile import compiled, inlined

Terms: TypeAlias = tuple[float, float, float, float, float, float, float, float]
"""Terms of order 0 to `records.ORDER` of a velocity, as powers of the fraction of the step."""


@compiled
def value(c: Terms, t: float) -> float:
    """The sum of c_k t^k."""
    higher_terms = c[4] + t * (c[5] + t * (c[6] + t * c[7]))
    return c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * higher_terms)))


@compiled
def integral(c: Terms, t: float) -> float:
    """The sum of c_k t^(k + 1)/(k + 1)."""
    higher = c[4] * 0.2 + t * (c[5] * (1.0 / 6.0) + t * (c[6] * (1.0 / 7.0) + t * (c[7] * 0.125)))
    return t * (c[0] + t * (c[1] * 0.5 + t * (c[2] * (1.0 / 3.0) + t * (c[3] * 0.25 + t * higher))))


@compiled
def slope(c: Terms, t: float) -> float:
    """The sum of k c_k t^(k - 1)."""
    higher_terms = 4.0 * c[4] + t * (5.0 * c[5] + t * (6.0 * c[6] + t * (7.0 * c[7])))
    return c[1] + t * (2.0 * c[2] + t * (3.0 * c[3] + t * higher_terms))


# The largest value within a step of what is known at its start, middle and end.


@compiled
def middle_of(
    start: float, end: float, slope_times_step: float, end_slope_times_step: float
) -> float:
    """The middle of the cubic with these ends and slopes, which errs by (w h)^4/384."""
    return 0.5 * (start + end) + 0.125 * (slope_times_step - end_slope_times_step)


@compiled
def cubic(
    start: float, end: float, slope_times_step: float, end_slope_times_step: float, t: float
) -> tuple[float, float]:
    """The same cubic a fraction t into the step, and its slope times the step."""
    change = end - start
    first, last = slope_times_step - change, end_slope_times_step - change
    bent = first * (1.0 - t) - last * t
    slope_there = change + first * (1.0 - t) * (1.0 - 3.0 * t) + last * t * (3.0 * t - 2.0)
    return start + change * t + t * (1.0 - t) * bent, slope_there


@compiled
def turning_value(start: float, middle: float, end: float) -> float:
    """Where the parabola through three values turns within the step, its value; else the end."""
    bend, change = start - 2.0 * middle + end, end - start
    turns = abs(change) < 2.0 * abs(bend)
    return middle - change * change / (8.0 * (bend if turns else 1.0)) if turns else end


@compiled
def peak(start: float, middle: float, end: float) -> float:
    """The largest absolute value of the parabola through three values."""
    highest = max(abs(start), abs(end))
    return max(highest, abs(turning_value(start, middle, end)))


# Sine and cosine of a tilt, without branches so that lanes can be computed together.

S1, S2, S3, S4, S5 = -1 / 6, 1 / 120, -1 / 5040, 1 / 362880, -1 / 39916800
S6, S7, S8, S9 = 1 / 6227020800, -1 / 1307674368e3, 1 / 355687428096e3, -1 / 121645100408832e3
C1, C2, C3, C4, C5 = -1 / 2, 1 / 24, -1 / 720, 1 / 40320, -1 / 3628800
C6, C7, C8, C9 = 1 / 479001600, -1 / 87178291200, 1 / 20922789888e3, -1 / 6402373705728e3
C10 = 1 / 243290200817664e4


@inlined
def sine_cosine(x: float) -> tuple[float, float]:
    """The sine and cosine of x by their power series [x in rad].

    Twenty-one terms leave less than 5e-16 for |x| <= pi/2, which no standing column exceeds; the
    error grows to 1e-9 at pi, where a structure has long been counted as overturned.

    The terms are added in pairs, and pairs of pairs (G. Estrin, 1960): what follows waits for a
    chain of five operations instead of ten.
    """
    z = x * x
    z2 = z * z
    z4 = z2 * z2
    z8 = z4 * z4
    low = (1.0 + S1 * z) + (S2 + S3 * z) * z2
    high = (S4 + S5 * z) + (S6 + S7 * z) * z2
    sine = (low + high * z4) + (S8 + S9 * z) * z8
    low = (1.0 + C1 * z) + (C2 + C3 * z) * z2
    high = (C4 + C5 * z) + (C6 + C7 * z) * z2
    cosine = (low + high * z4) + ((C8 + C9 * z) + C10 * z2) * z8
    return x * sine, cosine


# Gauss and Legendre's rule of order 8 over [0, 1].

NODES = (0.06943184420297371, 0.33000947820757187, 0.6699905217924281, 0.9305681557970263)
WEIGHTS = (0.17392742256872693, 0.32607257743127307, 0.32607257743127307, 0.17392742256872693)
