"""One step of the explicit Runge-Kutta pair of Dormand and Prince, order 5, first same as last.

J. R. Dormand and P. J. Prince, A family of embedded Runge-Kutta formulae, J. Comput. Appl. Math. 6
(1980) 19-26. The embedded formula of order 4 is not needed: the step follows the record's samples.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rpscli.physics.jit import kernel
from rpscli.physics.parameters import Floors, Podium
from rpscli.physics.uplifted import Shaking, rates_of_change

STAGES = 7
"""Rows of the array of slopes; the last is the first of the next step."""

EVALUATIONS = 6
"""Right-hand sides of one step when the first slope is known."""


@kernel
def step(
    podium: Podium,
    floors: Floors,
    motion: int,
    side: float,
    shaking: Shaking,
    time: float,
    h: float,
    y: NDArray[np.float64],
    k: NDArray[np.float64],
    end: NDArray[np.float64],
) -> None:
    """Advance the uplifted structure from `time` by `h`.

    Parameters
    ----------
    y, end
        State before and, written, after the step, (m,).
    k
        Slopes, (7, m): row 0 is dy/dt at y; rows 1-6 are written, row 6 is dy/dt at `end`.
    """
    m = y.shape[0]
    for i in range(m):
        end[i] = y[i] + h * (1 / 5) * k[0, i]
    rates_of_change(podium, floors, motion, side, shaking, time + h * (1 / 5), end, k[1])
    for i in range(m):
        end[i] = y[i] + h * ((3 / 40) * k[0, i] + (9 / 40) * k[1, i])
    rates_of_change(podium, floors, motion, side, shaking, time + h * (3 / 10), end, k[2])
    for i in range(m):
        end[i] = y[i] + h * ((44 / 45) * k[0, i] - (56 / 15) * k[1, i] + (32 / 9) * k[2, i])
    rates_of_change(podium, floors, motion, side, shaking, time + h * (4 / 5), end, k[3])
    for i in range(m):
        end[i] = y[i] + h * (
            (19372 / 6561) * k[0, i]
            - (25360 / 2187) * k[1, i]
            + (64448 / 6561) * k[2, i]
            - (212 / 729) * k[3, i]
        )
    rates_of_change(podium, floors, motion, side, shaking, time + h * (8 / 9), end, k[4])
    for i in range(m):
        end[i] = y[i] + h * (
            (9017 / 3168) * k[0, i]
            - (355 / 33) * k[1, i]
            + (46732 / 5247) * k[2, i]
            + (49 / 176) * k[3, i]
            - (5103 / 18656) * k[4, i]
        )
    rates_of_change(podium, floors, motion, side, shaking, time + h, end, k[5])
    for i in range(m):
        end[i] = y[i] + h * (
            (35 / 384) * k[0, i]
            + (500 / 1113) * k[2, i]
            + (125 / 192) * k[3, i]
            - (2187 / 6784) * k[4, i]
            + (11 / 84) * k[5, i]
        )
    rates_of_change(podium, floors, motion, side, shaking, time + h, end, k[6])
