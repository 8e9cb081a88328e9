"""Blocks of exact steps of the building's modes.

While theta = theta' = 0 the building is linear and the ground acceleration is linear over an
interval, so its modes advance without error (Theory, section 10). Exact steps may be as many as one
likes before one looks at them, so they are taken in blocks: the modes are followed through a block
one after the other, then everything that is wanted of its instants is computed for all of them at
once, in vector instructions. Entry k of each row of a block belongs to the state after k steps.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from rpscli.physics.core.compile import compiled, inlined, kernel
from rpscli.physics.core.oscillator import decay, transition
from rpscli.physics.core.records import INSTANTS, Floats, Record
from rpscli.physics.core.series import NODES, WEIGHTS
from rpscli.physics.planar.full_contact.demands import raise_floors_of_block
from rpscli.physics.planar.state import WHOLE_STEP

Map: TypeAlias = tuple[float, float, float, float]
"""What a step makes of a mode left alone: coefficients of q and q' in q, then those in q'."""


@compiled
def fill_map(block: Record, system: Record, which: int, h: float) -> None:
    """The exact map of every mode over h [s], under the ground's acceleration [h s].

    Writes the block's map of a WHOLE_STEP or a SHORT_STEP.
    """
    step = block.step_maps[which]
    for r in range(system.n):
        a, b, c, d, e, f, g, i = transition(system.omega[r], system.xi[r], h)
        load = -system.Gamma[r]
        step[r, 0], step[r, 1], step[r, 2], step[r, 3] = a, b, load * c, load * d
        step[r, 4], step[r, 5], step[r, 6], step[r, 7] = e, f, load * g, load * i


@compiled
def follow_modes(block: Record, system: Record, which: int) -> None:
    """Follow every mode through a block, from `q` and `dq`, by the map of a whole or short step.

    Reads the ground's motion and writes the modes' rows, V with its derivatives and the bounds of
    the demands. Few rows meet in each loop over instants: so the compiler finds it worth checking
    that they do not overlap, and makes vector instructions.
    """
    move_modes(block, block.step_maps[which])
    sum_modes(block, system)


@inlined
def sum_modes(block: Record, system: Record) -> None:
    """Write what the modes make of V, its derivatives and the bounds, shaken by `a_g`."""
    for k in range(INSTANTS):
        block.V[k], block.dV[k], block.ddV[k] = 0.0, 0.0, 0.0
        block.shear_bound[k], block.acceleration_bound[k] = 0.0, 0.0
        block.shear_bend[k] = 0.0
    for r in range(block.n):
        Gamma, omega2, two_xi_omega = system.Gamma[r], system.omega2[r], system.two_xi_omega[r]
        for k in range(INSTANTS):
            block.forces[r, k] = omega2 * block.qs[r, k] + two_xi_omega * block.dqs[r, k]
        shear, acceleration = system.shear_weight[r], system.acceleration_weight[r]
        for k in range(INSTANTS):
            q, force = block.qs[r, k], block.forces[r, k]
            block.V[k] += Gamma * force
            block.shear_bound[k] += shear * (q * q)
            block.acceleration_bound[k] += acceleration * (force * force)
        for k in range(INSTANTS):
            ddq = -Gamma * block.a_g[k] - block.forces[r, k]
            force_rate = omega2 * block.dqs[r, k] + two_xi_omega * ddq
            block.dV[k] += Gamma * force_rate
            block.ddV[k] += Gamma * (omega2 * ddq - two_xi_omega * force_rate)
            block.shear_bend[k] += shear * (ddq * ddq)


@compiled
def move_modes(block: Record, step: Floats) -> None:
    """States of all modes at all instants: each is the map of the one before [step (modes, 8)].

    What the ground does waits for nothing and comes first, see `add_ground`. Three modes then go
    together, so that none waits for its own last step.
    """
    n, qs, dqs, forces = block.n, block.qs, block.dqs, block.forces
    threes = n - n % 3
    for r in range(n):
        add_ground(block, step, r)
    for r in range(0, threes, 3):
        m0, m1, m2 = map_of(step, r), map_of(step, r + 1), map_of(step, r + 2)
        q0, v0 = block.q[r], block.dq[r]
        q1, v1 = block.q[r + 1], block.dq[r + 1]
        q2, v2 = block.q[r + 2], block.dq[r + 2]
        for k in range(INSTANTS):
            still0, still1, still2 = qs[r, k], qs[r + 1, k], qs[r + 2, k]
            qs[r, k], dqs[r, k], qs[r + 1, k] = q0, v0, q1
            dqs[r + 1, k], qs[r + 2, k], dqs[r + 2, k] = v1, q2, v2
            q0, v0 = mapped(m0, q0, v0, still0, forces[r, k])
            q1, v1 = mapped(m1, q1, v1, still1, forces[r + 1, k])
            q2, v2 = mapped(m2, q2, v2, still2, forces[r + 2, k])
    for r in range(threes, n):
        m0, q0, v0 = map_of(step, r), block.q[r], block.dq[r]
        for k in range(INSTANTS):
            still0 = qs[r, k]
            qs[r, k], dqs[r, k] = q0, v0
            q0, v0 = mapped(m0, q0, v0, still0, forces[r, k])


@compiled
def add_ground(block: Record, step: Floats, r: int) -> None:
    """Write where the ground alone brings mode r in each step, and how fast, to qs and forces."""
    a, b, e, d = step[r, 2], step[r, 3], step[r, 6], step[r, 7]
    for k in range(INSTANTS):
        a_g, slope = block.a_g[k], block.a_g_slope[k]
        block.qs[r, k], block.forces[r, k] = a * a_g + b * slope, e * a_g + d * slope


@compiled
def map_of(step: Floats, r: int) -> Map:
    """The map of mode r [step (modes, 8)]."""
    return step[r, 0], step[r, 1], step[r, 4], step[r, 5]


@compiled
def mapped(m: Map, q: float, dq: float, still: float, moving: float) -> tuple[float, float]:
    """Displacement and velocity a step later, with what the ground does to them."""
    return m[0] * q + (m[1] * dq + still), m[2] * q + (m[3] * dq + moving)


@compiled
def keep_state(block: Record, k: int) -> None:
    """Make the state after k steps of the block the present one."""
    for r in range(block.n):
        block.q[r], block.dq[r] = block.qs[r, k], block.dqs[r, k]


# What flows in a block of exact steps in full contact (Theory (8.2)).

GROWTH = 1.5
"""Ratio of the ends of the parts over which a strongly damped velocity is integrated: four nodes in
each leave 1e-8 of what decays."""


@compiled
def fill_work(block: Record, system: Record, which: int, h: float) -> None:
    """Integrals over a step of every mode's velocity v, as forms of how the step begins [h s].

    Left to itself under a load p + p' t it is v = q0' C + q0'' S + p' P, with C = c + xi w s, S = s
    and P = (1 - C)/w^2 of `formulae.oscillator`. The integrals of v^2 (six coefficients) and of v t
    (three) are taken by Gauss's rule: over the whole step, or over parts that grow with the time
    where the velocity decays within the step. They know nothing of where the step ends, nor of
    energy, so that the audit can show something.
    """
    for r in range(system.n):
        work, rate = block.work[which, r], 2.0 * system.two_xi_omega[r]
        for j in range(len(work)):
            work[j] = 0.0
        start, end = 0.0, (h if rate * h <= 1.0 else 1.0 / rate)
        while start < h:
            for i in range(len(NODES)):
                t, weight = start + (end - start) * NODES[i], (end - start) * WEIGHTS[i]
                c, S = decay(system.omega[r], system.xi[r], t)
                C = c + system.xi[r] * system.omega[r] * S
                P = (1.0 - C) / system.omega2[r]
                work[0] += weight * C * C
                work[1] += weight * S * S
                work[2] += weight * P * P
                work[3] += 2.0 * weight * C * S
                work[4] += 2.0 * weight * C * P
                work[5] += 2.0 * weight * S * P
                work[6] += weight * t * C
                work[7] += weight * t * S
                work[8] += weight * t * P
            start, end = end, min(GROWTH * end, h)


@compiled
def book_energy_of_block(block: Record, system: Record, which: int) -> None:
    """Energy put in by the ground, -int a_g 1^T M u' dt, and damped during each step [J]."""
    for k in range(INSTANTS):
        block.input[k], block.damped[k] = 0.0, 0.0
    for r in range(block.n):
        Gamma, omega2, two_xi_omega = system.Gamma[r], system.omega2[r], system.two_xi_omega[r]
        work = block.work[which, r]
        for k in range(INSTANTS - 1):
            a_g, slope = block.a_g[k], block.a_g_slope[k]
            q, v, moved = block.qs[r, k], block.dqs[r, k], block.qs[r, k + 1] - block.qs[r, k]
            g, j = -Gamma * a_g - two_xi_omega * v - omega2 * q, -Gamma * slope
            later = work[6] * v + work[7] * g + work[8] * j
            squares = work[0] * (v * v) + work[1] * (g * g) + work[2] * (j * j)
            mixed = work[3] * (v * g) + work[4] * (v * j) + work[5] * (g * j)
            block.input[k] -= Gamma * (a_g * moved + slope * later)
            block.damped[k] += two_xi_omega * (squares + mixed)


# The same building on a fixed base: exact, for comparison and as a test of full contact.


@kernel
def integrate_fixed_base(
    acceleration: Floats,
    dt: float,
    each: int,
    instants: int,
    systems: Record,
    blocks: Record,
    floors: NDArray[np.float64],
    largest: Floats,
) -> None:
    """The building on a fixed base, from rest: exact, for comparison and as a test.

    `acceleration` is (npts,) [m/s2] with the interval `dt`, zero after the last sample, followed in
    `each` steps; `instants` samples are followed. Written are `floors` (instants, 2, n), u and u'
    [m, m/s], or (0, 2, n) if nobody asks for them, and `largest` (2, n), storey shears [N] and
    absolute accelerations [m/s2].
    """
    system, block = systems[0], blocks[0]
    h = dt / each
    fill_map(block, system, WHOLE_STEP, h)
    most, last = INSTANTS - 1, (instants - 1) * each
    for first in range(0, last + 1, most):
        for k in range(INSTANTS):
            i = (first + k) // each
            inside = i + 1 < acceleration.shape[0]
            start = acceleration[i] if inside else 0.0
            end = acceleration[i + 1] if inside else 0.0
            slope = (end - start) / dt
            block.a_g[k], block.a_g_slope[k] = start + slope * h * ((first + k) % each), slope
        follow_modes(block, system, WHOLE_STEP)
        steps = min(most, last - first)
        raise_floors_of_block(block, system, largest[0], largest[1], h, steps)
        for k in range(min(most, last + 1 - first) if floors.shape[0] else 0):
            if (first + k) % each == 0:
                store_floors(block, system, k, floors[(first + k) // each])
        keep_state(block, most)


@compiled
def store_floors(block: Record, system: Record, k: int, floors: Floats) -> None:
    """Displacements and velocities (2, n) of the floors after k steps of the block."""
    for i in range(block.n):
        u, du = 0.0, 0.0
        for r in range(block.n):
            u += system.phi[r, i] * block.qs[r, k]
            du += system.phi[r, i] * block.dqs[r, k]
        floors[0, i], floors[1, i] = u, du
