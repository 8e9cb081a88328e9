"""Lagrange's equations of the uplifted storey in tilt and inter-storey drifts.

Contact geometry is written with complex numbers (x + i y, metres). In the column's own frame, with
the origin at its centre, the lower right arc is p(phi) = q - i r exp(i phi), q = B - i H + i r. A
tilt x > 0 turns the column clockwise, exp(-i x). Rolling without slip puts the contact at B + r x
on the ground; the upper contact is the mirror point of the lower one. So the cap beam moves by
w = u + i v = 2 [r x + q (1 - exp(-i x))], and on the arc's end P = p(beta) by
w = 2 [B + r beta - i H - P exp(-i x)]. The left side is the mirror image.
"""

import cmath
import math
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class OracleSystem:
    """A building on kinematic bearings, SI units.

    `columns_mass` is that of all columns together, `inertia_ratio` is I_o/(m_c R^2). `masses` and
    `stiffnesses` are listed from the first floor up and may be empty; `damping_matrix` acts on the
    floors' velocities relative to the cap beam. `law` says what the floors do at an impact; a
    `restitution` replaces the ratio of tilt velocities that its momentum balance gives.
    """

    R: float
    tan_alpha: float
    tan_alpha_wedge: float
    rho: float
    inertia_ratio: float
    columns_mass: float
    cap_beam_mass: float
    masses: Array
    stiffnesses: Array
    damping_matrix: Array
    gravity: float = 9.80665
    law: Literal["rigid", "flexible"] = "rigid"
    restitution: float | None = None


@dataclass(frozen=True)
class Contact:
    """Where the columns stand: the side of the tilt (+1 right, -1 left) and arc or arc's end."""

    side: int
    rolling: bool


class StoreyLagrangian:
    """T = 1/2 q'^T M(q) q' and the generalised forces for q = [theta, d_1 ... d_n]."""

    def __init__(self, system):
        self.system = system
        n = self.storeys = len(system.masses)
        self.half_height = system.R / math.hypot(1.0, system.tan_alpha)
        self.half_width = self.half_height * system.tan_alpha
        self.radius = 2.0 * system.rho * self.half_height
        reach = self.half_height * (system.tan_alpha_wedge - system.tan_alpha)
        self.beta = math.asin(reach / self.radius) if self.radius > 0.0 else 0.0
        self.arc_frame = complex(self.half_width, self.radius - self.half_height)
        self.arc_end = self.arc_frame - 1j * self.radius * cmath.exp(1j * self.beta)
        centroidal = (system.inertia_ratio - 1.0) * system.columns_mass * system.R**2
        # floors above each drift move with it: mu_j = m_j + ... + m_n
        self.carried = np.cumsum(system.masses[::-1])[::-1].astype(np.float64)
        total = float(np.sum(system.masses))
        self.spin_inertia = centroidal
        self.moving_mass = system.columns_mass / 4.0 + system.cap_beam_mass + total
        self.lifted_mass = system.columns_mass / 2.0 + system.cap_beam_mass + total
        self.pushed_mass = system.columns_mass / 2.0 + system.cap_beam_mass
        order = np.arange(n)
        self.drift_mass = self.carried[np.maximum.outer(order, order)]
        summation = np.tril(np.ones((n, n)))
        self.drift_damping = summation.T @ system.damping_matrix @ summation

    @cached_property
    def critical_rotation(self):
        """Tilt at which the lift v_b of the cap beam is largest, on the branch that is reached."""
        on_arc = cmath.phase(1j * self.arc_frame)  # Re(q exp(-i x)) = 0
        if 0.0 < on_arc < self.beta:
            return on_arc
        return cmath.phase(1j * self.arc_end)

    def cap_beam(self, x, *, rolling):
        """w(x), dw/dx and d2w/dx2 [m] of the right-hand side, x = |theta|."""
        turn = cmath.exp(-1j * x)
        if rolling:
            arm = 2.0 * self.arc_frame
            return (
                2.0 * self.radius * x + arm * (1.0 - turn),
                2.0 * self.radius + 1j * arm * turn,
                arm * turn,
            )
        arm = 2.0 * self.arc_end
        start = 2.0 * complex(
            self.half_width + self.radius * self.beta, -self.half_height
        )
        return start - arm * turn, 1j * arm * turn, arm * turn

    def mass_matrix(self, slope):
        """M(q), shape (n+1, n+1), where dw/dx = `slope`."""
        matrix = np.empty((self.storeys + 1, self.storeys + 1))
        matrix[0, 0] = self.spin_inertia + self.moving_mass * abs(slope) ** 2
        matrix[0, 1:] = matrix[1:, 0] = slope.real * self.carried
        matrix[1:, 1:] = self.drift_mass
        return matrix

    def acceleration(self, contact, y, a_g, gravity, moment=0.0):
        """q'' of the uplifted system under another moment on theta; y = [q, q', ...].

        `gravity` includes the ground's vertical a_v.
        """
        n, side = self.storeys, contact.side
        omega = float(y[n + 1])
        _, slope, bend = self.cap_beam(side * float(y[0]), rolling=contact.rolling)
        force = np.empty(n + 1)
        # of Lagrange's velocity terms only those in theta'^2 survive: M depends on theta alone
        force[0] = moment - self.lifted_mass * (
            a_g * slope.real + gravity * side * slope.imag
        )
        force[0] -= self.moving_mass * side * (slope.conjugate() * bend).real * omega**2
        force[1:] = -self.carried * (a_g + side * bend.real * omega**2)
        force[1:] -= (
            self.system.stiffnesses * y[1 : n + 1]
            + self.drift_damping @ y[n + 2 : 2 * n + 2]
        )
        return np.asarray(
            np.linalg.solve(self.mass_matrix(slope), force), dtype=np.float64
        )

    def energies(self, contact, y):
        """Kinetic and potential energy [J] relative to the ground; both zero at rest."""
        n = self.storeys
        rate = y[n + 1 : 2 * n + 2]
        shift, slope, _ = self.cap_beam(
            contact.side * float(y[0]), rolling=contact.rolling
        )
        springs = 0.5 * float(self.system.stiffnesses @ y[1 : n + 1] ** 2)
        kinetic = 0.5 * float(rate @ self.mass_matrix(slope) @ rate)
        return kinetic, springs + self.lifted_mass * self.system.gravity * shift.imag

    @cached_property
    def restitution(self):
        """theta'+ / theta'- at theta = 0.

        Unknowns: theta'+ and the impulses (X, Y) that the new lower and upper edge give to the
        columns. Rows: momentum of the columns (horizontal, vertical, about the centre) and of what
        they carry. The old edges leave without an impulse. With `flexible` the springs pass no
        horizontal impulse on, while vertically the floors are always carried.
        """
        system = self.system
        if system.restitution is not None:
            return system.restitution
        width, height, columns = self.half_width, self.half_height, system.columns_mass
        vertical = system.cap_beam_mass + float(np.sum(system.masses))
        horizontal = system.cap_beam_mass if system.law == "flexible" else vertical
        before = np.array(
            [columns * height, columns * width, self.spin_inertia, 0.0, 0.0]
        )
        before[3:] = 2.0 * horizontal * height, 2.0 * vertical * width
        rows = np.zeros((5, 5))
        rows[:, 0] = before * np.array([1.0, -1.0, 1.0, 1.0, -1.0])
        rows[0, [1, 3]] = rows[1, [2, 4]] = -1.0
        rows[2, 1:] = (
            height,
            -width,
            -height,
            width,
        )  # moment y X - x Y at (-B, -H) and (B, H)
        rows[3, 3] = rows[4, 4] = 1.0
        return float(np.linalg.solve(rows, before)[0])

    def after_impact(self, y):
        """State just after theta = 0: tilt reset to zero, velocities by the impact law."""
        n = self.storeys
        after = y.copy()
        after[0] = 0.0
        after[n + 1] = self.restitution * y[n + 1]
        if self.system.law == "flexible" and n > 0:
            # u_t' stays, so the first storey takes up what the cap beam loses
            after[n + 2] += 2.0 * self.half_height * (y[n + 1] - after[n + 1])
        return after
