"""The same building on a fixed base: exact, for comparison and as a test of full contact."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rpscli.physics.building import floor_rates
from rpscli.physics.contact import advance_modes, fill_decay, to_floors
from rpscli.physics.driver import shaking_in
from rpscli.physics.jit import kernel
from rpscli.physics.layout import FLOORS
from rpscli.physics.observation import record_demands
from rpscli.physics.parameters import Floors, Ground


@kernel
def integrate_fixed_base(
    floors: Floors, ground: Ground, intervals: int, samples: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Largest storey shears k_i d_i (n,) [N] and absolute floor accelerations (n,) [m/s2].

    `samples` (intervals + 1, 2 n), or with no rows, takes floor displacements and velocities.
    """
    n = floors.mass.shape[0]
    y, rates = np.zeros(FLOORS + 2 * n), np.zeros(FLOORS + 2 * n)
    z, end, table = np.zeros((2, n)), np.zeros((2, n)), np.zeros((2, n))
    storey_shears, floor_accelerations = np.zeros(n), np.zeros(n)
    fill_decay(floors, ground.dt, table)
    for interval in range(intervals + 1):
        shaking = shaking_in(ground, interval)
        to_floors(floors, z, y)
        floor_rates(floors, y, 0.0, 0.0, shaking.start, rates)
        record_demands(floors, y, rates, 0.0, shaking.start, storey_shears, floor_accelerations)
        if interval < samples.shape[0]:
            samples[interval, :] = y[FLOORS:]
        advance_modes(floors, shaking, 0.0, ground.dt, table, z, end)
        z, end = end, z
    return storey_shears, floor_accelerations
