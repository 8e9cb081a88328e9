"""Flat columns under a slab that turns, by Lagrange's equations in numbers only.

Written anew and independent of `rpscli`: closed forms of flat columns, kinetic and
potential energy of each as a function of the slab's ways, and derivatives of these by
differences. No formula of the program is used.
"""

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, minimize

G = 9.80665


def tilt_of(beyond, alpha):
    """x of |u|/2R = sin(alpha) - sin(alpha - x)."""
    return alpha - np.arcsin(np.sin(alpha) - beyond)


def column_energies(u, w, R, alpha, mass, slab, floors, inertia_ratio):
    """Kinetic energy of one column and what it carries, and its lift times its weight."""
    U = np.hypot(*u)
    x = tilt_of(U / (2.0 * R), alpha)
    n = u / U
    along, across = n @ w, n[0] * w[1] - n[1] * w[0]
    # Rates of the tilt along and across: d|u|/dx = 2 R cos(alpha - x).
    p = along / (2.0 * R * np.cos(alpha - x))
    turn = across / U  # rate of the azimuth
    beam = mass / 4.0 + slab
    icm = (inertia_ratio - 1.0) * mass * R**2  # about the centre, across the axis
    axial = 0.5 * mass * (R * np.sin(alpha)) ** 2
    kinetic = 0.5 * beam * (along**2 + across**2)
    lift_rate = 2.0 * R * np.sin(alpha - x) * p
    kinetic += 0.5 * (mass / 4.0 + slab + floors) * lift_rate**2
    kinetic += 0.5 * icm * (p**2 + (np.sin(x) * turn) ** 2)
    kinetic += 0.5 * axial * ((1.0 - np.cos(x)) * turn) ** 2
    weight = (mass / 2.0 + slab + floors) * G
    return kinetic, weight * 2.0 * R * (np.cos(alpha - x) - np.cos(alpha))


class TurningSlab:
    """Flat columns of slenderness tan(alpha_i) at places, under a rigid building."""

    def __init__(self, places, slenderness, R, mass, slab, floors, inertia, ratio=4 / 3):
        self.places = np.array(places, float)
        self.alphas = np.arctan(slenderness)
        self.given = R, mass, slab, floors, ratio
        self.spare = inertia - slab * (self.places**2).sum()

    def energies(self, way, rate):
        R, mass, slab, floors, ratio = self.given
        cosine, sine = np.cos(way[2]), np.sin(way[2])
        kinetic, potential = 0.5 * self.spare * rate[2] ** 2, 0.0
        for (x, y), alpha in zip(self.places, self.alphas, strict=True):
            d = np.array([cosine * x - sine * y, sine * x + cosine * y])
            u = way[:2] + d - (x, y)
            w = rate[:2] + rate[2] * np.array([-d[1], d[0]])
            T, V = column_energies(u, w, R, alpha, mass, slab, floors, ratio)
            kinetic, potential = kinetic + T, potential + V
        return kinetic, potential

    def masses(self, way):
        units = np.eye(3)
        alone = [self.energies(way, e)[0] for e in units]
        M = np.diag([2.0 * T for T in alone])
        for i, j in ((0, 1), (0, 2), (1, 2)):
            M[i, j] = M[j, i] = (
                self.energies(way, units[i] + units[j])[0] - alone[i] - alone[j]
            )
        return M

    def accelerations(self, way, rate, step=2e-5):
        """(d/dt)(dT/dq') - dT/dq + dV/dq = 0, by differences of the fourth order."""
        slopes, gradient, force = [], [], []
        for k in range(3):
            e = np.zeros(3)
            e[k] = step * (0.1 if k == 2 else 1.0)

            def slope(of, e=e, k=k):
                near = of(way + e) - of(way - e)
                far = of(way + 2 * e) - of(way - 2 * e)
                return (8.0 * near - far) / (12.0 * e[k])

            slopes.append(slope(self.masses))
            gradient.append(slope(lambda q: self.energies(q, rate)[0]))
            force.append(slope(lambda q: self.energies(q, 0.0 * rate)[1]))
        turned = sum(r * S for r, S in zip(rate, slopes, strict=True)) @ rate
        return np.linalg.solve(self.masses(way), np.array(gradient) - turned - force)

    def free(self, way, seconds):
        """Ways at the times, released at rest."""
        way = np.array(way, float)

        def rates(_, y):
            return np.concatenate([y[3:], self.accelerations(y[:3], y[3:])])

        times = np.asarray(seconds)
        found = solve_ivp(
            rates, (0.0, times[-1]), np.concatenate([way, np.zeros(3)]), method="DOP853",
            rtol=1e-10, atol=1e-13, t_eval=times,
        )  # fmt: skip
        return found.y[:3].T


def holds(places, strengths, load, lever=0.0):
    """Whether no turn about any point of a fine search gains more than it lifts."""
    Q, T = np.array(load[:2]), load[2]
    if np.hypot(*Q) >= np.sum(strengths):
        return False

    def missing(c, sign):
        arms = np.hypot(*(places - c).T)
        return strengths @ arms + lever - sign * (T + Q[0] * c[1] - Q[1] * c[0])

    for sign in (1.0, -1.0):
        # Convex, with kinks at the places: from the best of these, and from the middle.
        at = [missing(place, sign) for place in places]
        if min(at) < 0.0:
            return False
        for start in (places[np.argmin(at)], places.mean(axis=0)):
            found = minimize(
                missing, start + 1e-3, args=(sign,), method="Nelder-Mead",
                options={"xatol": 1e-10, "fatol": 1e-13, "maxiter": 2000},
            )  # fmt: skip
            if found.fun < 0.0:
                return False
    return True


def factor_of(places, strengths, load, lever=0.0):
    """Load factor at which full contact ends, by bisection of `holds`."""
    load = np.array(load)
    return brentq(
        lambda k: 1.0 if holds(places, strengths, k * load, lever) else -1.0,
        1e-3 * strengths.sum() / max(np.abs(load).max(), 1e-9),
        2.0 * strengths.sum() / max(np.abs(load[:2]).max(), np.abs(load[2]) / 10.0),
        xtol=1e-8 * strengths.sum(), rtol=1e-8,
    )  # fmt: skip
