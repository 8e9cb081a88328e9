"""A storey on beds of springs without tension, the lift of the beam an unknown of its own.

Nothing of the law of one end is used: pressures p = b (d + tau d') where the bed is pressed, d > 0,
and p > 0, are integrated over each flat end in closed form. Unknowns are theta, the lift v_b and
the floors; Runge and Kutta's method of order 4 with steps of 0.15 over the fastest frequency, that
of the bounce. The lift of an end's middle is v_b/2 + H (1 - cos theta), and u_b' = 2 R C theta'
with C = cos(alpha - |theta|), as on rigid ends: that much is geometry.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rpscli.physics.compile import compiled, kernel

Array = NDArray[np.float64]


@compiled
def pressed(depth: float, turn: float, rate: float, turn_rate: float, tau: float, B: float) -> Any:
    """Integrals of p and p xi over -B..B, over b: depth + turn xi with its rate, both cut at 0."""
    low, high = -B, B
    for one, slope in ((depth, turn), (depth + tau * rate, turn + tau * turn_rate)):
        if slope == 0.0:
            if one <= 0.0:
                return 0.0, 0.0
        else:
            root = -one / slope
            if slope > 0.0:
                low = max(low, root)
            else:
                high = min(high, root)
    if high <= low:
        return 0.0, 0.0
    a, c = depth + tau * rate, turn + tau * turn_rate
    square, cube = 0.5 * (high**2 - low**2), (high**3 - low**3) / 3.0
    return a * (high - low) + c * square, a * square + c * cube


@compiled
def rates(y: Any, out: Array, a_g: float, n: int, c: Array, M: Array, K: Array, D: Array) -> None:
    """y = [theta, v, u.., theta', v', u'..]; c as `follow` packs it."""
    H, B, R, alpha, columns, beam, total, g, icm, bed, tau = c
    theta, v, omega, rise = y[0], y[1], y[2 + n], y[3 + n]
    w = 0.5 * v + H * (1.0 - math.cos(theta))
    dw = 0.5 * rise + H * math.sin(theta) * omega
    turn, turn_rate = math.sin(theta), math.cos(theta) * omega
    force, moment = pressed(-w, turn, -dw, turn_rate, tau, B)
    force, moment = bed * force, bed * moment
    C = math.cos(alpha - abs(theta))
    slope = math.sin(alpha - abs(theta)) * (1.0 if theta >= 0.0 else -1.0)
    own = 0.25 * columns + beam
    # u_b, odd in theta
    base = 2.0 * R * (math.sin(alpha) - math.sin(alpha - abs(theta)))
    base = base if theta >= 0.0 else -base
    shear = 0.0
    for i in range(n):
        f = 0.0
        for j in range(n):
            f += K[i, j] * (y[2 + j] - base) + D[i, j] * (y[4 + n + j] - 2.0 * R * C * omega)
        shear += f
        out[2 + i], out[4 + n + i] = y[4 + n + i], -f / M[i] - a_g
    inertia = icm + own * 4.0 * R * R * C * C
    torque = 2.0 * (force * H * math.sin(theta) - moment * math.cos(theta))
    push = shear - (0.5 * columns + beam) * a_g
    out[0], out[1] = omega, rise
    quadratic = own * 4.0 * R * R * C * slope * omega * omega
    out[2 + n] = (torque + 2.0 * R * C * push - quadratic) / inertia
    out[3 + n] = (force - (0.5 * columns + beam + total) * g) / (own + total)


@kernel
def follow(
    y: Array, acc: Array, dt: float, parts: int, n: int, c: Array, M: Array, K: Array, D: Array,
    k1: float, limit: float,
) -> Any:  # fmt: skip
    """Largest |theta| and base shear at all steps."""
    k = np.zeros((4, y.size))
    largest, shear, h = abs(y[0]), 0.0, dt / parts
    for i in range(acc.size - 1):
        for part in range(parts):
            a0 = acc[i] + (acc[i + 1] - acc[i]) * part / parts
            a1 = acc[i] + (acc[i + 1] - acc[i]) * (part + 1) / parts
            rates(y, k[0], a0, n, c, M, K, D)
            rates(y + 0.5 * h * k[0], k[1], 0.5 * (a0 + a1), n, c, M, K, D)
            rates(y + 0.5 * h * k[1], k[2], 0.5 * (a0 + a1), n, c, M, K, D)
            rates(y + h * k[2], k[3], a1, n, c, M, K, D)
            y = y + h / 6.0 * (k[0] + 2.0 * k[1] + 2.0 * k[2] + k[3])
            largest = max(largest, abs(y[0]))
            base = 2.0 * c[2] * (math.sin(c[3]) - math.sin(c[3] - abs(y[0])))
            shear = max(shear, abs(k1 * (y[2] - (base if y[0] >= 0.0 else -base))))
            if largest > limit:
                return largest, shear
    return largest, shear


def resolved(
    structure: Any, acceleration: Array, dt: float, *, zeta: float, seconds: float, limit: float
) -> tuple[float, float]:
    """max |theta| [rad] and largest base shear [N] of a `PodiumStructure` with flat ends.

    `zeta` is the damping ratio of the bounce on all beds, omega_v^2 = g/(2 D_0).
    """
    b, above, bed = structure.bearing, structure.superstructure, structure.bed
    n, H, B = structure.storeys, b.half_height, b.half_width
    total, g = structure.superstructure_mass, structure.gravity
    weight, settled = structure.weight, bed.settlement
    bounce = math.sqrt(g / (2.0 * settled))
    icm = (b.inertia_ratio - 1.0) * structure.columns_mass * b.semi_diagonal**2
    stiffness = weight / (2.0 * B * settled)  # per width
    c = np.array([
        H, B, b.semi_diagonal, b.alpha, structure.columns_mass, structure.cap_beam_mass, total, g,
        icm, stiffness, 2.0 * zeta / bounce,
    ])  # fmt: skip
    M, K, D = above.masses, above.stiffness_matrix, above.damping_matrix
    own = math.sqrt(weight * B * 2.0 * B / settled / (4.0 * H * H) / bed.mass)
    fastest = max(2.0 * bounce * max(1.0, zeta), own, above.frequencies[-1])
    parts = max(math.ceil(dt * fastest / 0.15), 1)
    y = np.zeros(4 + 2 * n)
    y[1] = -2.0 * settled
    acc = np.concatenate([acceleration, np.zeros(round(seconds / dt))])
    largest, shear = follow(y, acc, dt, parts, n, c, M, K, D, float(above.stiffnesses[0]), limit)
    return largest, shear
