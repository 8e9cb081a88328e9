"""The same building on a fixed base: exact, for comparison and as a test of full contact."""

from __future__ import annotations

import numpy as np

from rpscli.physics.contact import (
    DQ,
    PULL,
    SHAPES,
    WHOLE,
    Q,
    advance_modes,
    keep_end,
    load_modes,
    push_of,
)
from rpscli.physics.jit import kernel
from rpscli.physics.parameters import Floats, Systems


@kernel
def integrate_fixed_base(
    systems: Systems, acceleration: Floats, dt: float, intervals: int, samples: Floats
) -> tuple[Floats, Floats]:
    """Largest storey shears k_i d_i (n,) [N] and absolute floor accelerations (n,) [m/s2].

    The building is that of the first system. The ground acceleration (npts,) [m/s2] is zero after
    its last sample. `samples` (intervals + 1, 2 n), or with no rows, takes floor displacements and
    velocities.
    """
    n = systems.mass.shape[1]
    z = np.zeros((SHAPES + 2 * n, n))
    storey_shears, floor_accelerations = np.zeros(n), np.zeros(n)
    load_modes(systems, 0, z, dt)
    for interval in range(intervals + 1):
        inside = interval + 1 < acceleration.shape[0]
        start = acceleration[interval] if inside else 0.0
        end = acceleration[interval + 1] if inside else 0.0
        push_of(z, Q, start)
        for i in range(n):
            shear, pull, u, du = 0.0, 0.0, 0.0, 0.0
            for r in range(n):
                shear += z[SHAPES + n + r, i] * z[Q, r]
                pull += z[SHAPES + r, i] * z[PULL, r]
                u += z[SHAPES + r, i] * z[Q, r]
                du += z[SHAPES + r, i] * z[DQ, r]
            storey_shears[i] = max(storey_shears[i], abs(shear))
            floor_accelerations[i] = max(floor_accelerations[i], abs(pull))
            if interval < samples.shape[0]:
                samples[interval, i], samples[interval, n + i] = u, du
        advance_modes(z, start, (end - start) / dt, WHOLE)
        keep_end(z)
    return storey_shears, floor_accelerations
