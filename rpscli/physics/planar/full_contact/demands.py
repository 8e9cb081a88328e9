"""What a building in full contact demands, at all instants of a block at once."""

from __future__ import annotations

import math

from rpscli.physics.core.compile import compiled
from rpscli.physics.core.records import INSTANTS, Floats, Record
from rpscli.physics.planar.demands import written
from rpscli.physics.planar.equation_of_motion import contact_measures


@compiled
def clear_contacts(block: Record) -> None:
    """Begin a time in full contact: nothing was demanded yet."""
    for k in range(INSTANTS):
        block.friction_top[k], block.friction_bottom[k] = 0.0, 0.0
        block.normal_top[k], block.normal_bottom[k] = math.inf, math.inf
        block.push[k] = 0.0


@compiled
def mark_samples(block: Record, first: int, last: int, each: int) -> None:
    """Write `at_sample`: 1 at the instants first, first + each, ... up to last."""
    for k in range(INSTANTS):
        block.at_sample[k] = 0.0
    for k in range(first, last + 1, each):
        block.at_sample[k] = 1.0


@compiled
def may_raise(block: Record, shear: float, acceleration: float) -> bool:
    """Whether the bounds of a sample are above these, see `uplifted.demands`."""
    found = 0
    for k in range(INSTANTS):
        more = (block.shear_bound[k] > shear) | (block.acceleration_bound[k] > acceleration)
        found |= 1 if more & (block.at_sample[k] > 0.0) else 0
    return found > 0


@compiled
def raise_floors_of_block(
    block: Record, system: Record, shears: Floats, accelerations: Floats
) -> None:
    """Raise the largest storey shears [N] and absolute floor accelerations [m/s2], (n,) or more."""
    n = block.n
    threes = n - n % 3
    for i in range(n):
        for k in range(INSTANTS):
            block.shear[k], block.acceleration[k] = 0.0, 0.0
        for r in range(0, threes, 3):
            add_three_modes(block, system, i, r)
        for r in range(threes, n):
            phi, shear = system.phi[r, i], system.storey_shear_of[r, i]
            for k in range(INSTANTS):
                block.shear[k] += shear * block.qs[r, k]
                block.acceleration[k] += phi * block.forces[r, k]
        shears[i] = max(shears[i], largest_at_samples(block, block.shear))
        accelerations[i] = max(accelerations[i], largest_at_samples(block, block.acceleration))


@compiled
def largest_at_samples(block: Record, row: Floats) -> float:
    """Largest absolute value of a row at samples; overwrites the row [row (INSTANTS,)]."""
    for k in range(INSTANTS):
        row[k] = block.at_sample[k] * abs(row[k])
    half = INSTANTS // 2  # halved so that the compiler compares vectors
    while half >= 4:
        for k in range(half):
            row[k] = written(max(row[k], row[half + k]))
        half //= 2
    return float(max(row[0], row[1], row[2], row[3]))


@compiled
def add_three_modes(block: Record, system: Record, i: int, r: int) -> None:
    """Add what the modes r, r + 1 and r + 2 contribute at floor i: the sum waits in a register."""
    s0, s1 = system.storey_shear_of[r, i], system.storey_shear_of[r + 1, i]
    s2, qs = system.storey_shear_of[r + 2, i], block.qs
    for k in range(INSTANTS):
        block.shear[k] = block.shear[k] + s0 * qs[r, k] + s1 * qs[r + 1, k] + s2 * qs[r + 2, k]
    p0, p1, p2 = system.phi[r, i], system.phi[r + 1, i], system.phi[r + 2, i]
    forces = block.forces
    for k in range(INSTANTS):
        block.acceleration[k] = (
            block.acceleration[k]
            + p0 * forces[r, k]
            + p1 * forces[r + 1, k]
            + p2 * forces[r + 2, k]
        )


@compiled
def observe_contacts(block: Record, system: Record, pull: float) -> None:
    """Raise friction demands and lower least normal forces, instant by instant [pull N]."""
    for k in range(INSTANTS):
        top, bottom, light_top, light_bottom = contact_measures(
            system.cap_beam_mass,
            system.floors_mass,
            system.columns_mass,
            0.0,
            0.0,
            block.V[k] + block.push[k],
            block.a_g[k],
            block.g_up[k],
            system.gravity,
            pull,
        )
        seen = block.at_sample[k] > 0.0
        block.friction_top[k] = written(max(block.friction_top[k], top if seen else 0.0))
        block.friction_bottom[k] = written(max(block.friction_bottom[k], bottom if seen else 0.0))
        block.normal_top[k] = written(min(block.normal_top[k], light_top if seen else math.inf))
        light = light_bottom if seen else math.inf
        block.normal_bottom[k] = written(min(block.normal_bottom[k], light))


@compiled
def hand_over_contacts(s: Record, l: int, block: Record) -> None:
    """End a time in full contact: raise the demands of the lane by its own."""
    for k in range(INSTANTS):
        s.friction_top[l] = max(s.friction_top[l], block.friction_top[k])
        s.friction_bottom[l] = max(s.friction_bottom[l], block.friction_bottom[k])
        s.normal_top[l] = min(s.normal_top[l], block.normal_top[k])
        s.normal_bottom[l] = min(s.normal_bottom[l], block.normal_bottom[k])
