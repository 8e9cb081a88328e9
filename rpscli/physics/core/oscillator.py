"""The damped linear oscillator under a load that varies linearly: its exact solution.

q'' + 2 xi w q' + w^2 q = p(t), p linear over the step. With the decaying cosine and sine

    c(t) = exp(-xi w t) cos(wd t),    s(t) = exp(-xi w t) sin(wd t)/wd,    wd = w sqrt(1 - xi^2),

(hyperbolic for xi > 1) the homogeneous part is q0 (c + xi w s) + q0' s, and the particular part is
linear in time (N. C. Nigam and P. C. Jennings, BSSA 59 (1969) 909-922).
"""

from __future__ import annotations

import math

from rpscli.physics.core.compile import compiled


@compiled
def decay(omega: float, xi: float, h: float) -> tuple[float, float]:
    """c(h) and s(h) [1, s]; under-, over- and critically damped [omega rad/s, h s]."""
    rate = xi * omega
    square = omega**2 - rate**2
    if abs(square) * h**2 < 1e-16:
        envelope = math.exp(-rate * h)
        return envelope, envelope * h
    if square > 0.0:
        wd = math.sqrt(square)
        envelope = math.exp(-rate * h)
        return envelope * math.cos(wd * h), envelope * math.sin(wd * h) / wd
    wd = math.sqrt(-square)
    if wd * h < 1.0:  # where the difference below would cancel
        envelope = math.exp(-rate * h)
        return envelope * math.cosh(wd * h), envelope * math.sinh(wd * h) / wd
    slow, fast = math.exp((wd - rate) * h), math.exp(-(wd + rate) * h)
    return 0.5 * (slow + fast), 0.5 * (slow - fast) / wd


@compiled
def transition(
    omega: float, xi: float, h: float
) -> tuple[float, float, float, float, float, float, float, float]:
    """The exact map over a step h [omega rad/s, h s].

    Returns: a, b, c, d, e, f, g, i of q1 = a q + b q' + c p + d p' and q1' = e q + f q' + g p + i
    p', with p the load at the start of the step and p' its slope.
    """
    c, s = decay(omega, xi, h)
    square = omega * omega
    rest, grow = 1.0 - (c + xi * omega * s), c - xi * omega * s
    trend = (h - s - 2.0 * xi / omega * rest) / square
    return (
        1.0 - rest,
        s,
        rest / square,
        trend,
        -square * s,
        grow,
        s,
        (1.0 - c - xi * omega * s) / square,
    )
