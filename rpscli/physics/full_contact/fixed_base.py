"""The same building on a fixed base: exact, for comparison and as a test of full contact."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rpscli.physics.compile import compiled, kernel
from rpscli.physics.full_contact.demands import mark_samples, raise_floors_of_block
from rpscli.physics.full_contact.modal_block import fill_map, follow_modes, keep_state
from rpscli.physics.state import INSTANTS, WHOLE_STEP, Floats, Record


@kernel
def integrate_fixed_base(
    acceleration: Floats,
    dt: float,
    instants: int,
    systems: Record,
    blocks: Record,
    floors: NDArray[np.float64],
    largest: Floats,
) -> None:
    """Follow a building from rest.

    Parameters
    ----------
    acceleration
        (npts,) of the ground [m/s2], zero after the last sample.
    dt
        Sampling interval [s].
    instants
        How many samples are followed.
    systems, blocks
        (1,) its `state.SYSTEM`, and room for a block.
    floors
        (instants, 2, n): written with floor displacements [m] and velocities [m/s]; (0, 2, n) if
        nobody asks for them.
    largest
        (2, n): written with the largest storey shears k_i d_i [N] and absolute floor
        accelerations [m/s2].
    """
    follow_fixed_base(acceleration, dt, instants, systems[0], blocks[0], floors, largest)


@compiled
def follow_fixed_base(
    acceleration: Floats,
    dt: float,
    instants: int,
    system: Record,
    block: Record,
    floors: NDArray[np.float64],
    largest: Floats,
) -> None:
    """The same for one record each.

    Parameters
    ----------
    acceleration, dt, instants, floors, largest
        See `integrate_fixed_base`.
    """
    n = system.n
    fill_map(block, system, WHOLE_STEP, dt)
    steps = INSTANTS - 1
    for first in range(0, instants, steps):
        for k in range(INSTANTS):
            i = first + k
            inside = i + 1 < acceleration.shape[0]
            start = acceleration[i] if inside else 0.0
            end = acceleration[i + 1] if inside else 0.0
            block.a_g[k], block.a_g_slope[k] = start, (end - start) / dt
        follow_modes(block, system, WHOLE_STEP)
        last = min(steps, instants - first) - 1
        mark_samples(block, 0, last, 1)
        raise_floors_of_block(block, system, largest[0], largest[1])
        for k in range(last + 1 if floors.shape[0] else 0):
            for i in range(n):
                u, du = 0.0, 0.0
                for r in range(n):
                    u += system.phi[r, i] * block.qs[r, k]
                    du += system.phi[r, i] * block.dqs[r, k]
                floors[first + k, 0, i], floors[first + k, 1, i] = u, du
        keep_state(block, steps)
