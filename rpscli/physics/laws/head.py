"""A column that follows its head, whose place under the slab is given (17.1) to (17.5).

Sections 1 to 14 give the tilt and ask how the cap beam moves. Where a slab turns about the
vertical each head moves in its own way, and the tilt follows:

    2 R h(x) r = u,     w = u',     T = [alpha (n.w)^2 + kappa (t.w)^2]/2
    alpha = m_c A/(4 C^2),          kappa = m_c K/(4 h^2)

with A, B, C, K and h of `place`. Lagrange's equations of the head, with b = (alpha -
kappa)/U^2, U = |u| and ' by U, are M u'' + c + F n, the force that pushes it:

    M = kappa 1 + b u u^T,      F = N B/C
    c = kappa' (n.w) w - kappa' |w|^2 n/2 + b |w|^2 u + b' (n.w)(u.w) u/2

Within U_c of upright the cone of rigid ends is a bowl: U^2 + U_c^2 in place of U^2 in b
and in n = u/U of F, which is still Lagrangian.
"""

from __future__ import annotations

from typing import NamedTuple

from rpscli.physics.compile import inlined
from rpscli.physics.laws.geometry import Phase, contact_height
from rpscli.physics.laws.place import Place, length, sines


class Head(NamedTuple):
    """What moves with a column's head, and what holds it; per unit of its mass m_c."""

    xx: float  # M
    xy: float
    yy: float
    c_x: float  # c
    c_y: float
    out_x: float  # n of F, its length below 1 within the bowl
    out_y: float
    arm: float  # B/C


@inlined
def displacement(phase: Phase, x: float) -> float:
    """|u|/2R at a tilt x (1.4), without loss near zero [rad]."""
    _, less, excess = sines(x)
    return (
        (phase.u0 - phase.p) + phase.p * less + (phase.c - phase.q) * x + phase.q * excess
    )


@inlined
def height(phase: Phase, x: float) -> float:
    """C(x), the slope of `displacement`."""
    sine, less, _ = sines(x)
    return contact_height(phase, 1.0 - less, sine)


MOST_TRIES = 12
NEAR = 4e-16


@inlined
def tilt_at(phase: Phase, beyond: float, guess: float) -> float:
    """The tilt of |u|/2R = `beyond`, by Newton's steps from a guess [rad]."""
    x = guess
    tries = 0
    step = 1.0
    while abs(step) > NEAR * (abs(x) + 1e-3) and tries < MOST_TRIES:
        step = (displacement(phase, x) - beyond) / height(phase, x)
        x -= step
        tries += 1
    return max(x, 0.0)


@inlined
def head_of(
    at: Place,
    diameter: float,
    bowl: float,
    u: tuple[float, float],
    w: tuple[float, float],
) -> Head:
    """The law of a head displaced by u [m] with the velocity w [m/s], per unit of m_c.

    `at` is the place of the tilt, `diameter` 2 R [m], `bowl` U_c [m].
    """
    U = length(u[0], u[1])
    square = U * U + bowl * bowl
    square = max(square, 1e-300)
    per_U = 1.0 / max(U, 1e-150)
    n_x = u[0] * per_U
    n_y = u[1] * per_U
    per_slope = 1.0 / (diameter * at.C)  # dx/dU
    alpha = 0.25 * at.A / (at.C * at.C)
    kappa = 0.25 * at.K / (at.h * at.h)
    alpha_slope = 0.5 * (at.D - at.A * at.B / at.C) / (at.C * at.C) * per_slope
    kappa_slope = (
        0.25 * (at.K_slope - 2.0 * at.K * at.dh / at.h) / (at.h * at.h) * per_slope
    )
    apart = alpha - kappa
    b = apart / square
    b_slope = (alpha_slope - kappa_slope - 2.0 * U * b) / square
    along = n_x * w[0] + n_y * w[1]
    speed = w[0] * w[0] + w[1] * w[1]
    radial = b * speed + 0.5 * b_slope * along * (U * along)
    swing = 0.5 * kappa_slope * speed
    out = 1.0 / length(U, bowl) if U + bowl > 0.0 else 0.0
    return Head(
        kappa + b * (u[0] * u[0]),
        b * (u[0] * u[1]),
        kappa + b * (u[1] * u[1]),
        kappa_slope * along * w[0] - swing * n_x + radial * u[0],
        kappa_slope * along * w[1] - swing * n_y + radial * u[1],
        u[0] * out,
        u[1] * out,
        at.B / at.C,
    )
