"""Full contact: a fixed-base building, solved exactly, and the instant at which it uplifts.

While theta = theta' = 0 the building is linear and the ground acceleration is linear over an
interval, so its modes advance without error. The storey uplifts to the side s when the margin

    f(t) = g tan(alpha) (1 + 2 gamma + 2 gamma eta) - s q(t),
    q(t) = -a_g (1 + 2 gamma) + 2 gamma eta V/M_tot

leaves zero downwards (Theory, section 3): exactly where s theta'' of the uplifted equation would
become positive.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rpscli.physics.events import NO_PASSAGE, first_descent, lower_hull, quintic
from rpscli.physics.jit import kernel
from rpscli.physics.layout import DAMPED, FLOORS, INPUT
from rpscli.physics.oscillator import advance_oscillator, decay
from rpscli.physics.parameters import Floors, Podium
from rpscli.physics.uplifted import Shaking


@kernel
def to_modes(floors: Floors, y: NDArray[np.float64], z: NDArray[np.float64]) -> None:
    """Modal displacements and velocities z (2, n) of the floors in y: Phi^T M u."""
    n = floors.mass.shape[0]
    for r in range(n):
        q, dq = 0.0, 0.0
        for i in range(n):
            weight = floors.shapes[i, r] * floors.mass[i]
            q += weight * y[FLOORS + i]
            dq += weight * y[FLOORS + n + i]
        z[0, r], z[1, r] = q, dq


@kernel
def to_floors(floors: Floors, z: NDArray[np.float64], y: NDArray[np.float64]) -> None:
    """Floor displacements and velocities in y of the modes z (2, n): Phi z."""
    n = floors.mass.shape[0]
    for i in range(n):
        u, du = 0.0, 0.0
        for r in range(n):
            u += floors.shapes[i, r] * z[0, r]
            du += floors.shapes[i, r] * z[1, r]
        y[FLOORS + i], y[FLOORS + n + i] = u, du


@kernel
def push(
    podium: Podium, floors: Floors, z: NDArray[np.float64], shaking: Shaking, time: float
) -> tuple[float, float, float]:
    """q(t), q'(t), q''(t) of the modes z at `time` within the interval."""
    a = shaking.start + shaking.slope * time
    mass = 1.0 + 2.0 * podium.gamma
    q0, q1, q2 = -a * mass, -shaking.slope * mass, 0.0
    if floors.mass.shape[0] == 0:
        return q0, q1, q2
    share = 2.0 * podium.gamma * podium.eta / podium.floors_mass
    for r in range(floors.mass.shape[0]):
        w, part = floors.omega[r], floors.participation[r]
        square, drag = w**2, 2.0 * floors.xi[r] * w
        d0, d1 = z[0, r], z[1, r]
        d2 = -part * a - drag * d1 - square * d0
        d3 = -part * shaking.slope - drag * d2 - square * d1
        q0 += share * part * (square * d0 + drag * d1)
        q1 += share * part * (square * d1 + drag * d2)
        q2 += share * part * (square * d2 + drag * d3)
    return q0, q1, q2


@kernel
def uplift_limit(podium: Podium, gravity: float) -> float:
    """Largest |q| of full contact under the vertical acceleration `gravity` = g + a_v."""
    mass = 1.0 + 2.0 * podium.gamma + 2.0 * podium.gamma * podium.eta
    return gravity * math.tan(podium.alpha) * mass


@kernel
def fill_decay(floors: Floors, h: float, table: NDArray[np.float64]) -> None:
    """c(h) and s(h) of every mode; writes table (2, n)."""
    for r in range(floors.mass.shape[0]):
        table[0, r], table[1, r] = decay(floors.omega[r], floors.xi[r], h)


@kernel
def advance_modes(
    floors: Floors,
    shaking: Shaking,
    time: float,
    h: float,
    table: NDArray[np.float64],
    z: NDArray[np.float64],
    end: NDArray[np.float64],
) -> None:
    """Modes `end` (2, n) a time h after z, exactly; `table` belongs to h."""
    a = shaking.start + shaking.slope * time
    for r in range(floors.mass.shape[0]):
        part = -floors.participation[r]
        end[0, r], end[1, r] = advance_oscillator(
            floors.omega[r],
            floors.xi[r],
            table[0, r],
            table[1, r],
            h,
            z[0, r],
            z[1, r],
            part * a,
            part * shaking.slope,
        )


@kernel
def contact_energies(
    floors: Floors,
    shaking: Shaking,
    time: float,
    h: float,
    z: NDArray[np.float64],
    end: NDArray[np.float64],
) -> tuple[float, float]:
    """Energy put in by the ground and damped during an exact step [J].

    The input -int a_g 1^T M u' dt is exact: integrated by parts it needs int q dt, which the
    equation of motion gives. The damped energy is a trapezoid corrected with end slopes, of order
    4, independent of the solution's own balance so that the audit can show something.
    """
    a0 = shaking.start + shaking.slope * time
    a1 = a0 + shaking.slope * h
    given, damped = 0.0, 0.0
    for r in range(floors.mass.shape[0]):
        w, part = floors.omega[r], floors.participation[r]
        drag = 2.0 * floors.xi[r] * w
        q0, v0, q1, v1 = z[0, r], z[1, r], end[0, r], end[1, r]
        area = (-part * 0.5 * (a0 + a1) * h - (v1 - v0) - drag * (q1 - q0)) / w**2
        given -= part * (a1 * q1 - a0 * q0 - shaking.slope * area)
        g0 = -part * a0 - drag * v0 - w**2 * q0
        g1 = -part * a1 - drag * v1 - w**2 * q1
        damped += drag * (0.5 * h * (v0**2 + v1**2) + h**2 / 6.0 * (v0 * g0 - v1 * g1))
    return given, damped


@kernel
def margin_after(
    podium: Podium,
    floors: Floors,
    shaking: Shaking,
    time: float,
    h: float,
    side: float,
    table: NDArray[np.float64],
    z: NDArray[np.float64],
    end: NDArray[np.float64],
) -> tuple[float, float]:
    """Margin f against uplift to `side` and its slope, a time h after the modes z, exactly."""
    fill_decay(floors, h, table)
    advance_modes(floors, shaking, time, h, table, z, end)
    q, dq, _ = push(podium, floors, end, shaking, time + h)
    gravity = podium.gravity + shaking.vertical_start + shaking.vertical_slope * (time + h)
    drift = uplift_limit(podium, shaking.vertical_slope)
    return uplift_limit(podium, gravity) - side * q, drift - side * dq


@kernel
def locate_uplift(
    podium: Podium,
    floors: Floors,
    shaking: Shaking,
    time: float,
    h: float,
    guess: float,
    side: float,
    z: NDArray[np.float64],
    table: NDArray[np.float64],
    end: NDArray[np.float64],
) -> float:
    """Time after `time`, near guess in [0, h], at which the margin is zero to rounding.

    Newton's method on the exact margin. A margin that only grazes zero has no steep root; the
    interpolant's own root then stands.
    """
    t = guess
    for _ in range(6):
        f, slope = margin_after(podium, floors, shaking, time, t, side, table, z, end)
        if slope >= 0.0:
            break
        change = -f / slope
        if not 0.0 <= t + change <= h:
            break
        t += change
        if abs(change) < 1e-15 * h:
            break
    return t


@kernel
def step_contact(
    podium: Podium,
    floors: Floors,
    shaking: Shaking,
    time: float,
    h: float,
    table: NDArray[np.float64],
    scratch: NDArray[np.float64],
    piece: NDArray[np.float64],
    y: NDArray[np.float64],
    z: NDArray[np.float64],
    end: NDArray[np.float64],
) -> tuple[float, float]:
    """Advance full contact by h, or to the uplift if that comes first.

    Parameters
    ----------
    table, scratch
        (2, n): decay over h, and room for the decay over a part of it.
    piece
        (6,) scratch.
    y
        Its energy entries are advanced; the floors' entries are not kept up in full contact.
    z
        Modes (2, n), advanced.
    end
        (2, n) scratch.

    Returns
    -------
    Time advanced [s], and the side of uplift (0 if none).
    """
    advance_modes(floors, shaking, time, h, table, z, end)
    f0, df0, ddf0 = push(podium, floors, z, shaking, time)
    f1, df1, ddf1 = push(podium, floors, end, shaking, time + h)
    g0 = podium.gravity + shaking.vertical_start + shaking.vertical_slope * time
    limit0 = uplift_limit(podium, g0)
    limit1 = uplift_limit(podium, g0 + shaking.vertical_slope * h)
    climb = uplift_limit(podium, shaking.vertical_slope)
    first, side = NO_PASSAGE, 0.0
    for sign in (1.0, -1.0):
        margin = quintic(
            h,
            limit0 - sign * f0,
            climb - sign * df0,
            -sign * ddf0,
            limit1 - sign * f1,
            climb - sign * df1,
            -sign * ddf1,
        )
        if lower_hull(margin) < 0.0 or margin[0] < 0.0:
            t = first_descent(margin, piece)
            if t < first:
                first, side = t, sign
    advanced = h
    if side != 0.0:
        advanced = locate_uplift(podium, floors, shaking, time, h, first * h, side, z, scratch, end)
        fill_decay(floors, advanced, scratch)
        advance_modes(floors, shaking, time, advanced, scratch, z, end)
    given, damped = contact_energies(floors, shaking, time, advanced, z, end)
    y[INPUT] += given
    y[DAMPED] += damped
    for r in range(floors.mass.shape[0]):
        z[0, r], z[1, r] = end[0, r], end[1, r]
    return advanced, side
