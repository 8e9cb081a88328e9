"""The damped linear oscillator under a load that varies linearly: its exact solution.

q'' + 2 xi w q' + w^2 q = p(t), p linear over the step. With the decaying cosine and sine

    c(t) = exp(-xi w t) cos(wd t),    s(t) = exp(-xi w t) sin(wd t)/wd,    wd = w sqrt(1 - xi^2),

(hyperbolic for xi > 1) the homogeneous part is q0 (c + xi w s) + q0' s, and the particular part is
linear in time (N. C. Nigam and P. C. Jennings, BSSA 59 (1969) 909-922).
"""

from __future__ import annotations

import math

from rpscli.physics.jit import kernel


@kernel
def decay(omega: float, xi: float, h: float) -> tuple[float, float]:
    """c(h) and s(h) [1, s]; under-, over- and critically damped."""
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
    slow, fast = math.exp((wd - rate) * h), math.exp(-(wd + rate) * h)
    return 0.5 * (slow + fast), 0.5 * (slow - fast) / wd


@kernel
def advance_oscillator(
    omega: float,
    xi: float,
    c: float,
    s: float,
    h: float,
    q: float,
    dq: float,
    load: float,
    slope: float,
) -> tuple[float, float]:
    """q and q' after a step h with the load p = load + slope t, given c(h) and s(h)."""
    trend = slope / omega**2
    static = load / omega**2 - 2.0 * xi * trend / omega
    a, b = q - static, dq - trend
    after = static + trend * h + (c + xi * omega * s) * a + s * b
    return after, trend - omega**2 * s * a + (c - xi * omega * s) * b
