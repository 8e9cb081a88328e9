"""When the free vibration after the record can be left off."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rpscli.physics.contact import uplift_limit
from rpscli.physics.jit import kernel
from rpscli.physics.layout import FULL_CONTACT, ROCKING, ROLLING
from rpscli.physics.parameters import Floors, Podium
from rpscli.physics.uplifted import cap_beam_lift, phase_of, uplifted_energy

RESERVE = 1.05
"""The rigid impact law may create energy, a few per cent of what is left in all cases seen."""


@kernel
def is_over(
    podium: Podium,
    floors: Floors,
    motion: int,
    side: float,
    y: NDArray[np.float64],
    z: NDArray[np.float64],
    peak: float,
    storey_shears: NDArray[np.float64],
    floor_accelerations: NDArray[np.float64],
) -> bool:
    """Whether no later moment of the free vibration can bring a new maximum.

    In full contact each mode decays from its present energy, which bounds every demand and the
    push that could uplift the storey again. Uplifted, the whole energy bounds the lift of the
    weight, and the strain energy of each storey.
    """
    if motion == FULL_CONTACT:
        return vibration_is_bounded(podium, floors, z, storey_shears, floor_accelerations)
    energy = RESERVE * uplifted_energy(podium, floors, motion, side, y)
    lifted = ROLLING if peak < podium.beta else ROCKING
    phase = phase_of(podium, lifted)
    mass = 0.5 * podium.columns_mass + podium.cap_beam_mass + podium.floors_mass
    lift = 2.0 * podium.R * cap_beam_lift(phase, math.cos(peak), math.sin(peak))
    if energy > mass * podium.gravity * lift or peak > podium.theta_cr:
        return False
    for i in range(floors.mass.shape[0]):
        if storey_shears[i] ** 2 < 2.0 * floors.stiffness[i] * energy:
            return False
    return True


@kernel
def vibration_is_bounded(
    podium: Podium,
    floors: Floors,
    z: NDArray[np.float64],
    storey_shears: NDArray[np.float64],
    floor_accelerations: NDArray[np.float64],
) -> bool:
    """The same in full contact: mode r never moves faster than v_r = sqrt(2 E_r)."""
    n = floors.mass.shape[0]
    if n == 0:
        return True
    base_shear = 0.0
    for r in range(n):
        w = floors.omega[r]
        speed = math.sqrt(z[1, r] ** 2 + (w * z[0, r]) ** 2)
        base_shear += abs(floors.participation[r]) * w * (1.0 + 2.0 * floors.xi[r]) * speed
    share = 2.0 * podium.gamma * podium.eta / podium.floors_mass
    if share * base_shear >= uplift_limit(podium, podium.gravity):
        return False
    for i in range(n):
        shear, acceleration = 0.0, 0.0
        for r in range(n):
            w = floors.omega[r]
            speed = math.sqrt(z[1, r] ** 2 + (w * z[0, r]) ** 2)
            below = floors.shapes[i - 1, r] if i > 0 else 0.0
            shear += abs(floors.shapes[i, r] - below) * speed / w
            acceleration += abs(floors.shapes[i, r]) * w * (1.0 + 2.0 * floors.xi[r]) * speed
        if floors.stiffness[i] * shear > storey_shears[i] or acceleration > floor_accelerations[i]:
            return False
    return True
