"""The same building on a fixed base: exact, for comparison and as a test of full contact."""

from __future__ import annotations

from rpscli.physics.contact import (
    AT,
    COLUMNS,
    MODAL_DQ,
    MODAL_Q,
    SHAPES,
    SLOPE,
    TOP_ACCELERATION,
    TOP_SHEAR,
    WHOLE,
    keep,
    load_modes,
    march,
)
from rpscli.physics.jit import kernel
from rpscli.physics.parameters import Block, Floats, Systems
from rpscli.physics.standing_demands import forget, mark_samples, observe_floors


@kernel
def integrate_fixed_base(
    systems: Systems,
    acceleration: Floats,
    dt: float,
    samples: Floats,
    tops: Floats,
    z: Floats,
    block: Block,
) -> None:
    """Follow the building of the first system.

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
        Scratch: (26 + 2 n, n) modal rows and a block, see `contact`.
    """
    n, instants = samples.shape[1] // 2, samples.shape[0]
    load_modes(systems, 0, z, dt)
    forget(block)
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
        observe_floors(block, z)
        for k in range(last + 1):
            for i in range(n):
                u, du = 0.0, 0.0
                for r in range(n):
                    u += z[SHAPES + r, i] * block.modes[r, MODAL_Q, k]
                    du += z[SHAPES + r, i] * block.modes[r, MODAL_DQ, k]
                samples[first + k, i], samples[first + k, n + i] = u, du
        keep(block, z, steps)
    for i in range(n):
        for k in range(COLUMNS):
            tops[0, i] = max(tops[0, i], block.tops[i, TOP_SHEAR, k])
            tops[1, i] = max(tops[1, i], block.tops[i, TOP_ACCELERATION, k])
