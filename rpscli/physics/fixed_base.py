"""The same building on a fixed base: exact, for comparison and as a test of full contact."""

from __future__ import annotations

from rpscli.physics.contact import fill_transition, keep, march
from rpscli.physics.contact_layout import (
    AT,
    COLUMNS,
    MODAL_DQ,
    MODAL_Q,
    SHAPES,
    SLOPE,
    WHOLE,
)
from rpscli.physics.jit import kernel
from rpscli.physics.parameters import Block, Floats
from rpscli.physics.standing_demands import mark_samples, observe_floors


@kernel
def integrate_fixed_base(
    acceleration: Floats,
    dt: float,
    samples: Floats,
    tops: Floats,
    z: Floats,
    block: Block,
) -> None:
    """Follow a building from rest.

    Parameters
    ----------
    acceleration
        (npts,) of the ground [m/s2], zero after the last sample.
    dt
        Sampling interval [s].
    samples
        (instants, 2 n): written with floor displacements [m] and velocities [m/s].
    tops
        (2, n): written with the largest storey shears k_i d_i [N] and absolute floor
        accelerations [m/s2].
    z, block
        Its modal rows (25 + 2 n, n), and room for a block: see `contact_layout`.
    """
    n, instants = samples.shape[1] // 2, samples.shape[0]
    fill_transition(z, dt, WHOLE)
    c = block.rows
    steps = COLUMNS - 1
    for first in range(0, instants, steps):
        for k in range(COLUMNS):
            i = first + k
            inside = i + 1 < acceleration.shape[0]
            start = acceleration[i] if inside else 0.0
            end = acceleration[i + 1] if inside else 0.0
            c[AT * COLUMNS + k], c[SLOPE * COLUMNS + k] = start, (end - start) / dt
        march(block, z, WHOLE)
        last = min(steps, instants - first) - 1
        mark_samples(c, 0, last, 1)
        observe_floors(block, z, tops[0], tops[1])
        for k in range(last + 1):
            for i in range(n):
                u, du = 0.0, 0.0
                for r in range(n):
                    u += z[SHAPES + r, i] * block.modes[r, MODAL_Q, k]
                    du += z[SHAPES + r, i] * block.modes[r, MODAL_DQ, k]
                samples[first + k, i], samples[first + k, n + i] = u, du
        keep(block, z, steps)
