"""What an impact makes of the state, and whether the storey stays down (Theory, sections 3, 4)."""

from __future__ import annotations

import math

import numpy as np

from benchmarks.peers.rocking import NEGLIGIBLE, Floats, Rocking


class Landing:
    """The impact of one podium, with the right-hand side at x = 0 prepared: it is linear there."""

    def __init__(self, podium: Rocking) -> None:
        n, gamma, eta = len(podium.masses), podium.gamma, podium.eta
        sine, cosine = math.sin(podium.alpha), math.cos(podium.alpha)
        self.storeys, self.restitution = n, podium.restitution
        self.beam = 2.0 * podium.R * cosine
        self.jump = self.beam * (1.0 - podium.restitution)
        self.left_out = 2.0 / (1.0 + podium.restitution) * self.beam  # (3.5)
        self.negligible = 2.0 * NEGLIGIBLE * podium.alpha
        curve = podium.rolling.c
        A = podium.Io - 1.0 + 1.0 + 4.0 * gamma + 4.0 * gamma * eta * sine**2
        D = sine * ((1.0 + 4.0 * gamma) * curve + 4.0 * gamma * eta * (curve - cosine))
        restoring = sine * podium.gravity / podium.R * (1.0 + 2.0 * gamma + 2.0 * gamma * eta)
        self.restoring, self.turning = restoring / A, D / A
        self.ground = cosine * (1.0 + 2.0 * gamma) / podium.R / A
        shear = np.zeros(2 * n + 2)  # V = shear . y, beam at 2 R cos(alpha) x'
        shear[1], shear[n + 2 :] = podium.stiffnesses[0], podium.a0 * podium.masses
        shear[n + 2] += podium.a1 * podium.stiffnesses[0]
        shear[n + 1] = -2.0 * podium.R * cosine * shear[n + 2 :].sum()
        self.back = 0.0
        """What decelerates the tilt behind the last impact [rad/s2]."""
        self.building = 2.0 * cosine / (podium.columns_mass * podium.R) / A * shear

    def land(self, y: Floats, across: float) -> bool:
        """Impact: change the mirrored state to that of the other side; whether the storey locks.

        `across` is the ground acceleration as mirrored on the side that is left.
        """
        n = self.storeys
        rate = -self.restitution * y[n + 1]
        y[n + 2 :] -= self.jump * y[n + 1]
        np.negative(y, y)
        y[0], y[n + 1] = 0.0, rate
        back = self.restoring + self.turning * rate * rate - self.ground * across
        back -= self.building @ y
        self.back = float(back)
        stays = back > 0.0 and rate * rate < self.negligible * back
        if stays:
            y[n + 2 :] += self.left_out * rate
        return bool(stays)
