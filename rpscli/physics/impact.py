"""What changes at theta = 0: the impact on the other edge, and coming to rest on the flat ends."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rpscli.physics.jit import kernel
from rpscli.physics.layout import FLOORS, TILT, TILT_RATE
from rpscli.physics.parameters import Floors, Podium


@kernel
def shift_floors(floors: Floors, y: NDArray[np.float64], change: float) -> None:
    """Add the same velocity to every floor [m/s]."""
    n = floors.mass.shape[0]
    for i in range(n):
        y[FLOORS + n + i] += change


@kernel
def impact(podium: Podium, floors: Floors, side: float, y: NDArray[np.float64]) -> float:
    """Go over from the edge on `side` to the other; returns the new side.

    theta'+ = e theta'-, and floors that move with the cap beam jump by
    -2 R cos(alpha) (1 - e) theta'- (Theory, section 4; paper, Eq. 6). The tilt x = |theta| starts
    again from exactly zero, upwards.
    """
    before = side * min(y[TILT_RATE], 0.0)
    y[TILT] = 0.0
    y[TILT_RATE] = podium.restitution * abs(before)
    if podium.floors_jump:
        jump = -2.0 * podium.R * math.cos(podium.alpha) * (1.0 - podium.restitution) * before
        shift_floors(floors, y, jump)
    return -side


@kernel
def is_negligible(podium: Podium, rate: float, acceleration: float, tolerance: float) -> bool:
    """Whether the excursion that begins with x' = rate at x = 0 is too small to follow.

    Impacts accumulate: each excursion is e^2 times as high as the last. At constant deceleration
    it reaches x'^2/(2 |x''|).
    """
    return acceleration < 0.0 and rate**2 < 2.0 * abs(acceleration) * tolerance * podium.alpha


@kernel
def lock(podium: Podium, floors: Floors, side: float, y: NDArray[np.float64]) -> None:
    """Full contact from now on: the floors lose the cap beam's velocity, not the relative one."""
    base_rate = side * 2.0 * podium.R * math.cos(podium.alpha) * y[TILT_RATE]
    shift_floors(floors, y, -base_rate)
    y[TILT] = 0.0
    y[TILT_RATE] = 0.0
