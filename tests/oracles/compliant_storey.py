"""A storey on plane or edge beds under flat ends, integrated by scipy in theta and floors u_t.

Written from the law of one end (moment m, lift of its centre) and Lagrange's equation in absolute
floor displacements; nothing is taken from the kernels. B = R sin(alpha - x), C = R cos(alpha - x).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
from scipy.integrate import solve_ivp

from .storey_lagrangian import Array, OracleSystem


@dataclass(frozen=True, eq=False)
class CompliantStorey:
    """Of a system with flat ends; `plane` or two edges, phi_u where they lift.

    `kept` of theta' is left at each return.
    """

    system: OracleSystem
    phi_u: float
    zeta: float
    plane: bool
    kept: float

    @property
    def alpha(self) -> float:
        return math.atan(self.system.tan_alpha)

    @cached_property
    def stiffness(self) -> Array:
        """(n, n) of the building."""
        between = np.eye(len(self.system.masses)) - np.eye(len(self.system.masses), k=-1)
        return np.asarray(between.T @ np.diag(self.system.stiffnesses) @ between)

    def arms(self, x: float) -> tuple[float, float, float, float, float]:
        """Weight's arm, B_v, dB_v/dx, C and dC/dx at x > phi_u."""
        u, a = self.phi_u, self.alpha
        B, C = np.sin(a - x), np.cos(a - x)
        if not self.plane:
            return B, B, -C, C, B
        there, sunk = np.sin(a - u), np.sqrt(u / x)
        m = 1.0 - 2.0 / 3.0 * sunk  # moment over that of the column on its edge
        return (
            B - np.sin(a) * (1.0 - m),
            B - there * sunk,
            -C + there * sunk / (2.0 * x),
            C,
            B,
        )

    def rates(self, a_g: float, y: Array, bedded: bool, a_v: float = 0.0) -> Array:
        """y = [theta, theta', u_t, u_t'], theta and all else of the side with theta > 0.

        What is lifted, W/g by v_b' = 2 R B_v theta', feels a_v; in full contact nothing is.
        """
        n, R = len(self.system.masses), self.system.R
        x, rate, u, du = y[0], y[1], y[2 : 2 + n], y[2 + n :]
        total, g = self.system.masses.sum(), self.system.gravity
        weight = (0.5 * self.system.columns_mass + self.system.cap_beam_mass + total) * g
        if bedded:
            end = self.arms(self.phi_u * (1.0 + 1e-15))
            moment = 2.0 * R * weight * end[0] * x / self.phi_u
            C, dC, Bv, dBv = np.cos(self.alpha - self.phi_u), 0.0, 0.0, 0.0
        else:
            arm, Bv, dBv, C, dC = self.arms(x)
            moment = 2.0 * R * weight * (arm + Bv * a_v / g)
        own = 0.25 * self.system.columns_mass + self.system.cap_beam_mass
        Icm = (self.system.inertia_ratio - 1.0) * self.system.columns_mass * R * R
        inertia = Icm + 4.0 * R * R * (own * (C * C + Bv * Bv) + total * Bv * Bv)
        slope = 8.0 * R * R * (own * (C * dC + Bv * dBv) + total * Bv * dBv)
        if bedded:
            moment += (
                2.0 * self.zeta * np.sqrt(moment / x * inertia if x else self.k * inertia) * rate
            )
        base = self.beam_path(x, bedded)
        drift, drift_rate = u - base, du - 2.0 * R * C * rate
        forces = self.stiffness @ drift + self.system.damping_matrix @ drift_rate
        push = forces.sum() - (0.5 * self.system.columns_mass + self.system.cap_beam_mass) * a_g
        ddx = (2.0 * R * C * push - moment - 0.5 * slope * rate * rate) / inertia
        return np.array([rate, ddx, *du, *(-forces / self.system.masses - a_g)])

    @property
    def k(self) -> float:
        """Secant of the moment up to phi_u [N m]."""
        weight = (
            0.5 * self.system.columns_mass + self.system.cap_beam_mass + self.system.masses.sum()
        ) * self.system.gravity
        return float(
            2.0 * self.system.R * weight * self.arms(self.phi_u * (1.0 + 1e-15))[0] / self.phi_u
        )

    def beam_path(self, x: float, bedded: bool) -> float:
        """u_b, linear up to phi_u and continuous there."""
        a, u = self.alpha, self.phi_u
        if bedded:
            return float(2.0 * self.system.R * np.cos(a - u) * x)
        start = np.cos(a - u) * u + np.sin(a - u)
        return float(2.0 * self.system.R * (start - np.sin(a - x)))

    def kept_at_uplift(self) -> float:
        """Of theta', so that the energy of the tilt is kept where B_v jumps."""
        if self.plane:
            return 1.0
        own, total, a = (
            0.25 * self.system.columns_mass + self.system.cap_beam_mass,
            self.system.masses.sum(),
            self.alpha - self.phi_u,
        )
        low = (self.system.inertia_ratio - 1.0) * self.system.columns_mass / 4.0 + own * np.cos(
            a
        ) ** 2
        return float(np.sqrt(low / (low + (own + total) * np.sin(a) ** 2)))

    def history(
        self, a_g: Array, dt: float, a_v: Array | None = None, tolerance: float = 1e-11
    ) -> tuple[Array, Array, int]:
        """theta and u_t at the samples, and the number of returns to full contact; from rest."""
        n = len(self.system.masses)
        y, side, bedded, returns = np.zeros(2 + 2 * n), 1.0, True, 0
        found = [(0.0, *y[2 : 2 + n])]
        a_v = np.zeros_like(a_g) if a_v is None else a_v
        for k in range(len(a_g) - 1):
            t, end = 0.0, dt
            while end - t > 1e-13:
                ends = self._ends(bedded)
                ground = side * a_g[k], side * (a_g[k + 1] - a_g[k]) / dt
                lift = a_v[k], (a_v[k + 1] - a_v[k]) / dt
                step = solve_ivp(
                    partial(self._rates_at, ground, lift, bedded), (t, end), y, "DOP853",
                    events=ends, rtol=tolerance, atol=1e-13, max_step=0.25 * dt,
                )  # fmt: skip
                t, y = float(step.t[-1]), step.y[:, -1]
                if step.status == 1:
                    y, side, bedded = self._pass(y, side, bedded)
                    returns += bedded
            found.append((side * y[0], *(side * y[2 : 2 + n])))
        table = np.array(found)
        return table[:, 0], table[:, 1:], returns

    def _rates_at(
        self, ground: tuple[float, float], lift: tuple[float, float], bedded: bool, t: float,
        y: Array,
    ) -> Array:  # fmt: skip
        return self.rates(ground[0] + ground[1] * t, y, bedded, lift[0] + lift[1] * t)

    def _ends(self, bedded: bool) -> list:  # type: ignore[type-arg]
        def above(_t: float, z: Array) -> float:
            return float(z[0] - self.phi_u)

        def below(_t: float, z: Array) -> float:
            return float(z[0] + self.phi_u)

        for event, direction in ((above, 1.0 if bedded else -1.0), (below, -1.0)):
            event.terminal, event.direction = True, direction  # type: ignore[attr-defined]
        return [above, below] if bedded else [above]

    def _pass(self, y: Array, side: float, bedded: bool) -> tuple[Array, float, bool]:
        """Over phi_u: outwards nothing is lost, inwards theta' keeps `kept`; floors keep theirs."""
        if y[0] < 0.0:
            y, side = -y, -side
        change = self.kept_at_uplift()
        y[0] = self.phi_u
        y[1] *= change if bedded else self.kept / change
        return y, side, not bedded
