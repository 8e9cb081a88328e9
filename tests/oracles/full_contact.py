"""Full contact: the fixed-base building under a linear ground acceleration, by exponentials."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.linalg import expm

from .crossings import Curve

_TAYLOR_ORDER = (
    20  # 1/21! of the leading term with sub-intervals of one radian of the fastest mode
)


class Exit(NamedTuple):
    """A way out of rest: direction * push passes lift * (gravity + a_v) + held."""

    direction: int
    lift: float
    held: float


@dataclass(frozen=True)
class LinearGround:
    """Ground acceleration over one interval, linear in the time since its start."""

    horizontal: float
    horizontal_rate: float
    vertical: float
    vertical_rate: float

    def later(self, tau):
        return LinearGround(
            self.horizontal + tau * self.horizontal_rate,
            self.horizontal_rate,
            self.vertical + tau * self.vertical_rate,
            self.vertical_rate,
        )


class FullContact:
    """The fixed-base building under a linear load, z = [d, d', a_g, a_g'], by exponentials."""

    def __init__(self, lagrangian):
        system, n = lagrangian.system, lagrangian.storeys
        flow = np.zeros((2 * n + 2, 2 * n + 2))
        flow[:n, n : 2 * n] = np.eye(n)
        if n > 0:
            forces = np.column_stack(
                (np.diag(system.stiffnesses), lagrangian.drift_damping)
            )
            flow[n : 2 * n, : 2 * n] = -np.linalg.solve(lagrangian.drift_mass, forces)
            flow[n, 2 * n] = -1.0  # the first storey alone sees the ground
        flow[2 * n, 2 * n + 1] = 1.0
        # horizontal force that tries to lift the storey towards theta > 0: V - (N m_c/2 + m_b) a_g
        push = np.zeros(2 * n + 2)
        if n > 0:
            push[0] = system.stiffnesses[0]
            push[n : 2 * n] = lagrangian.drift_damping[0]
        push[2 * n] = -lagrangian.pushed_mass
        self.flow, self.fastest = flow, float(np.max(np.abs(np.linalg.eigvals(flow))))
        self.gravity = system.gravity
        rows = [push]
        for order in range(1, _TAYLOR_ORDER + 1):
            rows.append(rows[-1] @ flow / order)
        self.taylor = np.array(rows)
        self._steps = {}

    def over(self, z, tau):
        if tau not in self._steps:
            self._steps[tau] = expm(self.flow * tau)
        return self._steps[tau] @ z

    def push(self, z):
        """Horizontal force on the cap beam towards theta > 0."""
        return float(self.taylor[0] @ z)

    def leaving(self, z, ground, h, exits):
        """First instant in [0, h] at which the push passes what holds the storey, and whither."""
        push = self.taylor @ z * h ** np.arange(_TAYLOR_ORDER + 1)
        found = []
        for way in exits:
            hold = way.lift * np.array(
                [self.gravity + ground.vertical, h * ground.vertical_rate]
            )
            hold[0] += way.held
            if np.sum(np.abs(push)) < hold[0] - abs(hold[1]):
                continue
            excess = way.direction * push
            excess[:2] -= hold
            if excess[0] > 0.0:
                return 0.0, way.direction
            root = Curve(excess).crossing(0.0, 1)
            if root is not None:
                found.append((root * h, way.direction))
        return min(found, default=None)
