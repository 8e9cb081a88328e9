"""The exact step of a storey that stands: full contact on rigid
ends, under linear springs.

No law is asked and nothing errs: each mode is an oscillator on ground whose acceleration
is linear within the step,

    q'' + c q' + w^2 q = a + b t,      a = -Gamma a_g + what plastic drifts do,  c = 2 xi w,

whose end follows from its start (N. C. Nigam and P. C. Jennings, Bull. Seism.
Soc. Am. 59 (1969) 909-922). With S(h) the response to a unit velocity, I its
integral and J that of I,

    q(h)  = (1 - w^2 I) q + S q'  + I a + J b
    q'(h) =      -w^2 S q + S' q' + S a + I b,         S' = 1 - w^2 I - c S.

The factors are made anew when the length of the step changes, one time in forty.
"""

from __future__ import annotations

import math

from rpscli.physics.compile import compiled, fma, inlined
from rpscli.physics.lane import lanes_of, ways_of
from rpscli.physics.state import FULL_CONTACT, Record
from rpscli.physics.step import book_power, clear_powers, end_rates
from rpscli.physics.storeys import base_slip


@inlined
def stands_exactly(s: Record, l: int) -> bool:
    """True if a lane takes the exact step: it stands, and no storey yields."""
    return (s.phase[l] == FULL_CONTACT) & (s.marked[l] == 0)  # type: ignore[no-any-return]


TERMS = 20
"""Of the series for short steps: the last is below 1e-17 of the sum."""

SHORT = 0.5
"""w h and c h below which the closed forms lose digits, and the series has all."""


@compiled
def responses(omega2: float, c: float, h: float) -> tuple[float, float, float, float]:
    """S, S', I and J of an oscillator after a time h [s; 1; s2; s3]."""
    if omega2 * (h * h) < SHORT * SHORT and c * h < SHORT:
        return responses_by_series(omega2, c, h)
    a = 0.5 * c
    beyond = a * a - omega2
    d = math.sqrt(abs(beyond))
    if beyond > 0.0 and d * h > CREEPS:
        return creeping_responses(omega2 / (a + d), a + d, h)
    left = math.exp(-a * h)
    z = d * h
    if beyond > 0.0:
        S = left * math.sinh(z) / d
        cosine = math.cosh(z)
    else:
        S = left * (math.sin(z) / d if d > 0.0 else h)
        cosine = math.cos(z)
    dS = left * cosine - a * S
    I = (1.0 - dS - c * S) / omega2
    return S, dS, I, (h - S - c * I) / omega2


CREEPS = 0.1
"""Half of the difference of two rates of decay times h, from which
each is followed by itself."""


@compiled
def creeping_responses(
    slow: float, fast: float, h: float
) -> tuple[float, float, float, float]:
    """Responses of an oscillator that is damped beyond its critical damping, by its two
    rates.
    """
    apart = fast - slow
    S = math.exp(-slow * h) * -math.expm1(-apart * h) / apart
    dS = (fast * math.exp(-fast * h) - slow * math.exp(-slow * h)) / apart
    I = (decayed(slow, h) - decayed(fast, h)) / apart
    return S, dS, I, (decayed_twice(slow, h) - decayed_twice(fast, h)) / apart


@compiled
def decayed(rate: float, h: float) -> float:
    """Integral of exp(-rate t) over h."""
    return -math.expm1(-rate * h) / rate


@compiled
def decayed_twice(rate: float, h: float) -> float:
    """Integral of that."""
    z = rate * h
    found = 0.0
    term = 0.5 * h * h
    if z > SHORT:
        return (h - decayed(rate, h)) / rate
    for k in range(3, TERMS):
        found += term
        term *= -z / k
    return found


@compiled
def responses_by_series(
    omega2: float, c: float, h: float
) -> tuple[float, float, float, float]:
    """Responses by powers of h, whose factors follow from each other by the equation of
    motion.
    """
    S = 0.0
    I = 0.0
    J = 0.0
    before = 0.0
    factor = 1.0
    power = h
    for k in range(1, TERMS):
        S += factor * power
        I += factor * power * h / (k + 1)
        J += factor * power * (h * h) / ((k + 1) * (k + 2))
        before, factor = factor, -(c * factor + omega2 * before)
        power *= h / (k + 1)
    return S, 1.0 - omega2 * I - c * S, I, J


@compiled
def set_factors(s: Record, l: int) -> None:
    """Make the factors of a lane's modes for the length of its step."""
    s.factors_h[l] = s.h[l]
    for r in range(s.axes * s.n):
        omega2 = s.omega2[r, l]
        S, dS, I, J = responses(omega2, s.two_xi_omega[r, l], s.h[l])
        s.factors[0, r, l] = 1.0 - omega2 * I
        s.factors[1, r, l] = S
        s.factors[2, r, l] = I
        s.factors[3, r, l] = J
        s.factors[4, r, l] = -omega2 * S
        s.factors[5, r, l] = dS


@inlined
def slope_of_ground(s: Record, l: int, axis: int) -> float:
    """Slope of the ground's acceleration along an axis [m/s3]."""
    return s.a_g_slope[axis, l] if axis < ways_of(s) else s.g_up_slope[l]  # type: ignore[no-any-return]


@inlined
def stand_along(s: Record, axis: int) -> None:
    """Lead the modes along an axis to the end of the step, in all lanes."""
    n = s.n
    lanes = lanes_of(s)
    for l in range(lanes):
        s.new_V[axis, l] = 0.0
        s.new_shaking[axis, l] = s.shaking[axis, l] + s.h[l] * slope_of_ground(s, l, axis)
    for r in range(axis * n, (axis + 1) * n):
        for l in range(lanes):
            load = fma(-s.Gamma[r, l], s.shaking[axis, l], s.freed[r, l])
            rate = -s.Gamma[r, l] * slope_of_ground(s, l, axis)
            S = s.factors[1, r, l]
            I = s.factors[2, r, l]
            q = s.q[r, l]
            dq = s.dq[r, l]
            new_q = fma(
                s.factors[0, r, l], q, fma(S, dq, fma(I, load, s.factors[3, r, l] * rate))
            )
            new_dq = fma(
                s.factors[4, r, l], q, fma(s.factors[5, r, l], dq, fma(S, load, I * rate))
            )
            s.new_q[r, l] = new_q
            s.new_dq[r, l] = new_dq
            s.force[r, l] = fma(s.omega2[r, l], new_q, s.two_xi_omega[r, l] * new_dq)
        for l in range(lanes):
            s.new_V[axis, l] += s.Gamma[r, l] * s.force[r, l]


@compiled
def stand(s: Record) -> None:
    """Take a step of lanes that all stand: writes the end."""
    lanes = lanes_of(s)
    for l in range(lanes):
        if s.factors_h[l] != s.h[l]:
            set_factors(s, l)
    if lanes == 1 and s.audited > 0:
        book_standing(s)
    for axis in range(ways_of(s)):
        stand_along(s, axis)
    if s.axes > ways_of(s):
        stand_along(s, ways_of(s))
    if s.yielding > 0:
        free_standing(s)
    for axis in range(ways_of(s)):
        for l in range(lanes):
            s.new_tilt[axis, l] = 0.0
            s.new_tilt_rate[axis, l] = 0.0
            s.new_bend[axis, l] = 0.0
    for l in range(lanes):
        s.new_x[l] = 0.0
        s.new_v[l] = 0.0
        s.new_a[l] = 0.0
        s.new_lift[l] = 0.0
        s.new_speed[l] = 0.0
        s.new_square_rate[l] = 0.0
        s.new_quicker[l] = 0.0
        s.error[l] = 0.0
    end_rates(s)


@compiled
def free_standing(s: Record) -> None:
    """Take what plastic drifts, which now rest, load the modes by from their forces."""
    for axis in range(ways_of(s)):
        for l in range(lanes_of(s)):
            s.new_V[axis, l] -= base_slip(
                s, l, axis, 0.0
            )  # the drift counts where it yields
        for r in range(axis * s.n, (axis + 1) * s.n):
            for l in range(lanes_of(s)):
                s.force[r, l] -= s.freed[r, l]


# Where energy is audited its flows are integrated by C. F. Gauss's rule of four points.

POINTS = (
    0.06943184420297371,
    0.33000947820757187,
    0.6699905217924281,
    0.9305681557970263,
)
WEIGHTS = (
    0.17392742256872692,
    0.32607257743127307,
    0.32607257743127307,
    0.17392742256872692,
)


@compiled
def set_factors_within(s: Record) -> None:
    """Make the factors of velocities at the points, in the only lane."""
    s.within_h[0] = s.h[0]
    for k in range(4):
        for r in range(s.axes * s.n):
            omega2 = s.omega2[r, 0]
            S, dS, I, _ = responses(omega2, s.two_xi_omega[r, 0], POINTS[k] * s.h[0])
            s.within[4 * k, r] = -omega2 * S
            s.within[4 * k + 1, r] = dS
            s.within[4 * k + 2, r] = S
            s.within[4 * k + 3, r] = I


@compiled
def book_standing(s: Record) -> None:
    """Book the means of powers over the step of the only lane."""
    if s.within_h[0] != s.h[0]:
        set_factors_within(s)
    clear_powers(s)
    for k in range(4):
        for axis in range(s.axes):
            slope = s.g_up_slope[0]
            if axis < ways_of(s):
                slope = s.a_g_slope[axis, 0]
            for r in range(axis * s.n, (axis + 1) * s.n):
                load = fma(-s.Gamma[r, 0], s.shaking[axis, 0], s.freed[r, 0])
                moved = s.within[4 * k + 2, r] * load
                moved -= s.within[4 * k + 3, r] * (s.Gamma[r, 0] * slope)
                moved += s.within[4 * k + 1, r] * s.dq[r, 0]
                s.new_dq[r, 0] = moved + s.within[4 * k, r] * s.q[r, 0]
        still = (0.0, 0.0)
        book_power(s, s.time[0] + POINTS[k] * s.h[0], WEIGHTS[k], still, still)
