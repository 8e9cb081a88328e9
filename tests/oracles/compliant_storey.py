"""A storey on plane or edge beds under flat ends, by the law of one end and by pressures.

`CompliantStorey`, integrated by scipy in theta and floors u_t, is written from the law of one end
(moment m, lift of its centre) and Lagrange's equation in absolute floor displacements; nothing is
taken from the kernels. B = R sin(alpha - x), C = R cos(alpha - x).

`resolved` uses nothing of the law of one end: pressures p = b (d + tau d') of springs without
tension where the bed is pressed, d > 0, and p > 0, are integrated over each flat end in closed
form. Unknowns are theta, the lift v_b and the floors; Runge and Kutta's method of order 4 with
steps of 0.15 over the fastest frequency, that of the bounce. The lift of an end's middle is
v_b/2 + H (1 - cos theta), and u_b' = 2 R C theta' with C = cos(alpha - |theta|), as on rigid ends:
that much is geometry.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from rpscli.compiler.functions import Program
from rpscli.compiler.objects import Entry, kind_of_argument, machine_code

from .storey_lagrangian import Array, OracleSystem, StoreyLagrangian


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

    @cached_property
    def motion(self):
        """Masses, and the angles of the ends."""
        return StoreyLagrangian(self.system)

    @property
    def alpha(self):
        return math.atan(self.system.tan_alpha)

    @cached_property
    def stiffness(self):
        """(n, n) of the building."""
        between = np.eye(self.motion.storeys) - np.eye(self.motion.storeys, k=-1)
        return np.asarray(between.T @ np.diag(self.system.stiffnesses) @ between)

    def arms(self, x):
        """Weight's arm, B_v, dB_v/dx, C and dC/dx at x > phi_u."""
        u, a = self.phi_u, self.alpha
        B, C = np.sin(a - x), np.cos(a - x)
        if not self.plane:
            return B, B, -C, C, B
        there, sunk = np.sin(a - u), np.sqrt(u / x)
        m = 1.0 - 2.0 / 3.0 * sunk  # moment over that of the column on its edge
        slope = -C + there * sunk / (2.0 * x)
        return B - np.sin(a) * (1.0 - m), B - there * sunk, slope, C, B

    def rates(self, a_g, y, bedded, a_v=0.0):
        """y = [theta, theta', u_t, u_t'], theta and all else of the side with theta > 0.

        What is lifted, W/g by v_b' = 2 R B_v theta', feels a_v; in full contact nothing is.
        """
        motion, n, D = self.motion, self.motion.storeys, 2.0 * self.system.R
        x, rate, u, du = y[0], y[1], y[2 : 2 + n], y[2 + n :]
        lifted, total = motion.lifted_mass, self.system.masses.sum()
        if bedded:
            moment = self.secant * x
            C, dC, Bv, dBv = np.cos(self.alpha - self.phi_u), 0.0, 0.0, 0.0
        else:
            arm, Bv, dBv, C, dC = self.arms(x)
            moment = D * lifted * (arm * self.system.gravity + Bv * a_v)
        own = motion.moving_mass - total
        inertia = motion.spin_inertia + D**2 * (own * (C * C + Bv * Bv) + total * Bv * Bv)
        half_slope = D**2 * (own * (C * dC + Bv * dBv) + total * Bv * dBv)
        if bedded:
            moment += 2.0 * self.zeta * np.sqrt(self.secant * inertia) * rate
        drift, drift_rate = u - self.beam_path(x, bedded), du - D * C * rate
        forces = self.stiffness @ drift + self.system.damping_matrix @ drift_rate
        push = forces.sum() - motion.pushed_mass * a_g
        ddx = (D * C * push - moment - half_slope * rate * rate) / inertia
        return np.array([rate, ddx, *du, *(-forces / self.system.masses - a_g)])

    @cached_property
    def secant(self):
        """Of the moment up to phi_u [N m]."""
        weight = self.motion.lifted_mass * self.system.gravity
        arm = self.arms(self.phi_u * (1.0 + 1e-15))[0]
        return float(2.0 * self.system.R * weight * arm / self.phi_u)

    def beam_path(self, x, bedded):
        """u_b, linear up to phi_u and continuous there."""
        a, u = self.alpha, self.phi_u
        if bedded:
            return float(2.0 * self.system.R * np.cos(a - u) * x)
        start = np.cos(a - u) * u + np.sin(a - u)
        return float(2.0 * self.system.R * (start - np.sin(a - x)))

    def kept_at_uplift(self):
        """Of theta', so that the energy of the tilt is kept where B_v jumps."""
        if self.plane:
            return 1.0
        total, a = self.system.masses.sum(), self.alpha - self.phi_u
        own, D = self.motion.moving_mass - total, 2.0 * self.system.R
        low = self.motion.spin_inertia + own * (D * np.cos(a)) ** 2
        return float(np.sqrt(low / (low + (own + total) * (D * np.sin(a)) ** 2)))

    def history(self, a_g, dt, a_v=None, tolerance=1e-11):
        """theta and u_t at the samples, and the number of returns to full contact; from rest."""
        n = self.motion.storeys
        y, side, bedded, returns = np.zeros(2 + 2 * n), 1.0, True, 0
        found = [(0.0, *y[2 : 2 + n])]
        a_v = np.zeros_like(a_g) if a_v is None else a_v

        def rates(t, z, k, side, bedded):
            early, late = 1.0 - t / dt, t / dt
            across, up = (early * a[k] + late * a[k + 1] for a in (a_g, a_v))
            return self.rates(side * across, z, bedded, up)

        def above(_t, z, *_):
            return float(z[0] - self.phi_u)

        def below(_t, z, *_):
            return float(z[0] + self.phi_u)

        above.terminal = below.terminal = True
        below.direction = -1.0
        for k in range(len(a_g) - 1):
            t = 0.0
            while dt - t > 1e-13:
                above.direction = 1.0 if bedded else -1.0
                step = solve_ivp(
                    rates, (t, dt), y, "DOP853", events=[above, below] if bedded else [above],
                    args=(k, side, bedded), rtol=tolerance, atol=1e-13, max_step=0.25 * dt,
                )  # fmt: skip
                t, y = float(step.t[-1]), step.y[:, -1]
                if step.status == 1:
                    y, side, bedded = self._pass(y, side, bedded)
                    returns += bedded
            found.append((side * y[0], *(side * y[2 : 2 + n])))
        table = np.array(found)
        return table[:, 0], table[:, 1:], returns

    def _pass(self, y, side, bedded):
        """Over phi_u: outwards nothing is lost, inwards theta' keeps `kept`; floors keep theirs."""
        if y[0] < 0.0:
            y, side = -y, -side
        change = self.kept_at_uplift()
        y[0] = self.phi_u
        y[1] *= change if bedded else self.kept / change
        return y, side, not bedded


def pressed(
    depth: float, turn: float, rate: float, turn_rate: float, tau: float, B: float
) -> Any:
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


def rates(
    y: Any, out: Array, a_g: float, n: int, c: Array, M: Array, K: Array, D: Array
) -> None:
    """y = [theta, v, u.., theta', v', u'..]; c as `follow` packs it."""
    H, B, R, alpha, columns = c[0], c[1], c[2], c[3], c[4]
    beam, total, g, icm, bed, tau = c[5], c[6], c[7], c[8], c[9], c[10]
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
            f += K[i, j] * (y[2 + j] - base) + D[i, j] * (
                y[4 + n + j] - 2.0 * R * C * omega
            )
        shear += f
        out[2 + i], out[4 + n + i] = y[4 + n + i], -f / M[i] - a_g
    inertia = icm + own * 4.0 * R * R * C * C
    torque = 2.0 * (force * H * math.sin(theta) - moment * math.cos(theta))
    push = shear - (0.5 * columns + beam) * a_g
    out[0], out[1] = omega, rise
    quadratic = own * 4.0 * R * R * C * slope * omega * omega
    out[2 + n] = (torque + 2.0 * R * C * push - quadratic) / inertia
    out[3 + n] = (force - (0.5 * columns + beam + total) * g) / (own + total)


def follow(
    y: Array, k: Array, found: Array, acc: Array, dt: float, parts: int, n: int, c: Array, M: Array,
    K: Array, D: Array, k1: float, limit: float,
) -> None:  # fmt: skip
    """Largest |theta| and base shear at all steps [k (5, y), found (2,)]."""
    largest, shear, h, at = abs(y[0]), 0.0, dt / parts, k[4]
    for i in range(acc.shape[0] - 1):
        for part in range(parts):
            a0 = acc[i] + (acc[i + 1] - acc[i]) * part / parts
            a1 = acc[i] + (acc[i + 1] - acc[i]) * (part + 1) / parts
            rates(y, k[0], a0, n, c, M, K, D)
            for j in range(y.shape[0]):
                at[j] = y[j] + 0.5 * h * k[0, j]
            rates(at, k[1], 0.5 * (a0 + a1), n, c, M, K, D)
            for j in range(y.shape[0]):
                at[j] = y[j] + 0.5 * h * k[1, j]
            rates(at, k[2], 0.5 * (a0 + a1), n, c, M, K, D)
            for j in range(y.shape[0]):
                at[j] = y[j] + h * k[2, j]
            rates(at, k[3], a1, n, c, M, K, D)
            for j in range(y.shape[0]):
                y[j] += h / 6.0 * (k[0, j] + 2.0 * k[1, j] + 2.0 * k[2, j] + k[3, j])
            largest = max(largest, abs(y[0]))
            base = 2.0 * c[2] * (math.sin(c[3]) - math.sin(c[3] - abs(y[0])))
            shear = max(shear, abs(k1 * (y[2] - (base if y[0] >= 0.0 else -base))))
            found[0], found[1] = largest, shear
            if largest > limit:
                return


def resolved(structure, acceleration, dt, *, zeta, seconds, limit):
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
    arrays = [np.ascontiguousarray(each, dtype=float) for each in (M, K, D)]
    found = np.array([abs(y[0]), 0.0])
    given = y, np.zeros((5, y.size)), found, acc, float(dt), parts, n, c, *arrays
    given = *given, float(above.stiffnesses[0]), float(limit)
    program, kinds = Program(), [kind_of_argument(each) for each in given]
    program.add(follow, kinds, "@follow")
    Entry(machine_code(program.text()), "follow", kinds, None)(*given)
    return float(found[0]), float(found[1])
