"""What a building in full contact demands, in all steps of a block at once."""

from __future__ import annotations

import math

from rpscli.physics.core.compile import compiled, compiled_with
from rpscli.physics.core.records import INSTANTS, Floats, Record
from rpscli.physics.core.series import middle_of, peak
from rpscli.physics.planar.demands import SURELY, WITHIN, raise_by, reach, written
from rpscli.physics.planar.equation_of_motion import Measures, contact_measures


@compiled
def may_raise(s: Record, l: int, block: Record, h: float, steps: int) -> bool:
    """Whether a bound of the first steps, of length h [s], is passed, see `planar.demands`."""
    found, part, ratio = 0, (WITHIN / 8.0 * h * h) ** 2, s.bend_ratio[l]
    shear, acceleration = s.shear_below_all_maxima[l], s.acceleration_below_all_maxima[l]
    for k in range(INSTANTS):
        bulge = part * block.shear_bend[k]
        more = reach(block.shear_bound[k], bulge) > shear
        more |= reach(block.acceleration_bound[k], ratio * bulge) > acceleration
        found |= 1 if more & (k <= steps) else 0
    return found > 0


@compiled
def raise_floors_of_block(
    block: Record, system: Record, shears: Floats, accelerations: Floats, h: float, steps: int
) -> None:
    """Raise the largest storey shears [N] and absolute floor accelerations [m/s2], (n,) or more."""
    bulge = WITHIN / 8.0 * h * h
    for r in range(block.n):
        omega2, damping, Gamma = system.omega2[r], system.two_xi_omega[r], system.Gamma[r]
        for k in range(INSTANTS):
            ddq = -Gamma * block.a_g[k] - block.forces[r, k]
            block.rises[r, k] = omega2 * block.dqs[r, k] + damping * ddq
    shear, acceleration, ratio = 0.0, 0.0, math.sqrt(system.bend_ratio)
    for k in range(steps + 1):
        bent = (bulge * bulge) * block.shear_bend[k]
        shear = max(shear, reach(block.shear_bound[k], bent))
        acceleration = max(acceleration, reach(block.acceleration_bound[k], ratio * ratio * bent))
    shear, acceleration = math.sqrt(shear) / SURELY, math.sqrt(acceleration) / SURELY
    for i in range(block.n):
        share, other_share = system.shear_bound_of[i], system.acceleration_bound_of[i]
        if shear > share * shears[i]:
            add_modes(block, system.storey_shear_of, block.qs, block.row, i)
        if shear > share * shears[i] and row_may_rise(block, shears[i], share, bulge, steps):
            add_modes(block, system.storey_shear_of, block.dqs, block.row_slope, i)
            shears[i] = max(shears[i], largest_of_row(block, h, steps))
        if acceleration <= other_share * accelerations[i]:
            continue
        add_modes(block, system.phi, block.forces, block.row, i)
        if row_may_rise(block, accelerations[i], other_share / ratio, bulge, steps):
            add_modes(block, system.phi, block.rises, block.row_slope, i)
            accelerations[i] = max(accelerations[i], largest_of_row(block, h, steps))


@compiled
def row_may_rise(block: Record, largest: float, bound: float, bulge: float, steps: int) -> bool:
    """Whether the block's row may rise above the largest in its first steps."""
    found = 0
    for k in range(INSTANTS):
        left = largest - abs(block.row[k])
        more = left * bound < bulge * math.sqrt(block.shear_bend[k])
        found |= 1 if more & (k <= steps) else 0
    return found > 0


@compiled
def add_modes(block: Record, shares: Floats, modes: Floats, row: Floats, i: int) -> None:
    """Sum what all modes contribute at floor i to a row, three at a time."""
    threes = block.n - block.n % 3
    for k in range(INSTANTS):
        row[k] = 0.0
    for r in range(0, threes, 3):
        a, b, c = shares[r, i], shares[r + 1, i], shares[r + 2, i]
        for k in range(INSTANTS):
            row[k] = row[k] + a * modes[r, k] + b * modes[r + 1, k] + c * modes[r + 2, k]
    for r in range(threes, block.n):
        a = shares[r, i]
        for k in range(INSTANTS):
            row[k] += a * modes[r, k]


@compiled
def largest_of_row(block: Record, h: float, steps: int) -> float:
    """Largest absolute value of the block's row in its first steps."""
    row, rates, largest = block.row, block.row_slope, block.largest
    for k in range(INSTANTS):
        middle = middle_of(row[k], row[k + 1], h * rates[k], h * rates[k + 1])
        largest[k] = written(peak(row[k], middle, row[k + 1]) if k < steps else 0.0)
    half = INSTANTS // 2  # halved so that the compiler compares vectors
    while half >= 4:
        for k in range(half):
            largest[k] = written(max(largest[k], largest[half + k]))
        half //= 2
    return float(max(largest[0], largest[1], largest[2], largest[3]))


def _still(_block: Record, _k: int) -> tuple[float, float]:
    return 0.0, 0.0


@compiled_with("across", otherwise=_still)
def beam_motion(block: Record, k: int) -> tuple[float, float]:
    """u_b'' after k steps and its rate [m/s2, m/s3]: 0 but on a bed."""
    return block.across[k], block.across_rate[k]


@compiled
def contacts_may_rise(s: Record, l: int, block: Record, pull: float, h: float, steps: int) -> bool:
    """Whether forces of the columns may be larger, or smaller, than so far in the first steps."""
    beam, columns, gravity = s.cap_beam_mass[l], s.columns_mass[l], s.gravity[l]
    upper = beam + s.floors_mass[l]
    found, part = 0, WITHIN / 8.0 * h
    for k in range(INSTANTS):
        a_g, g_up = block.a_g[k], block.g_up[k]
        across, rate = beam_motion(block, k)
        moved = rate - beam_motion(block, k + 1)[1]
        bulge = part * (abs(block.dV[k] - block.dV[k + 1]) + (beam + columns) * abs(moved))
        shear = beam * (a_g + across) - block.V[k] - block.push[k]
        shear_bottom = shear + columns * (a_g + 0.5 * across)
        top, bottom = abs(shear) + bulge, abs(shear_bottom) + bulge
        N_top = upper * g_up + pull
        N_bottom = N_top + columns * g_up
        more = (top > s.friction_top[l] * N_top) | (bottom > s.friction_bottom[l] * N_bottom)
        more |= (top > s.shear_top[l]) | (bottom > s.shear_bottom[l])
        light = N_bottom / ((upper + columns) * gravity)
        more |= (light < s.normal_bottom[l]) | (light > s.heavy_bottom[l])
        found |= 1 if more & (k <= steps) else 0
    return found > 0


@compiled
def observe_contacts(
    s: Record, l: int, block: Record, system: Record, pull: float, h: float, steps: int
) -> None:
    """Raise friction demands and forces of contacts, step by step, within and at both ends."""
    for k in range(steps):
        V, V_end = block.V[k], block.V[k + 1]
        a_g, change = block.a_g[k], 0.5 * h * block.a_g_slope[k]
        g_up, rise = block.g_up[k], 0.5 * h * block.g_up_slope[k]
        middle = middle_of(V, V_end, h * block.dV[k], h * block.dV[k + 1])
        (X, rate), (X_end, rate_end) = beam_motion(block, k), beam_motion(block, k + 1)
        across = middle_of(X, X_end, h * rate, h * rate_end)
        raise_by(
            s,
            l,
            measures(system, V + block.push[k], a_g, g_up, pull, X),
            measures(
                system, middle + block.push_within[k], a_g + change, g_up + rise, pull, across
            ),
            measures(
                system,
                V_end + block.push[k + 1],
                a_g + 2.0 * change,
                g_up + 2.0 * rise,
                pull,
                X_end,
            ),
        )


@compiled
def measures(
    system: Record, V: float, a_g: float, g_up: float, pull: float, across: float
) -> Measures:
    """Measures of contacts in full contact, see `contact_measures`."""
    return contact_measures(
        system.cap_beam_mass,
        system.floors_mass,
        system.columns_mass,
        across,
        0.0,
        V,
        a_g,
        g_up,
        system.gravity,
        pull,
    )
