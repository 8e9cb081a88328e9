"""Blocks of exact steps of the building's modes.

While theta = theta' = 0 the building is linear and the ground acceleration is linear over an
interval, so its modes advance without error (Theory, section 10). Exact steps may be as many as one
likes before one looks at them, so they are taken in blocks: the modes are followed through a block
one after the other, then everything that is wanted of its instants is computed for all of them at
once, in vector instructions. Entry k of each row of a block belongs to the state after k steps.
"""

from __future__ import annotations

from typing import TypeAlias

from rpscli.physics.compile import compiled
from rpscli.physics.formulae.oscillator import transition
from rpscli.physics.state import INSTANTS, Floats, Record

Map: TypeAlias = tuple[float, float, float, float]
"""What a step makes of a mode left alone: coefficients of q and q' in q, then those in q'."""


@compiled
def fill_map(block: Record, system: Record, which: int, h: float) -> None:
    """The exact map of every mode over h [s], under the ground's acceleration.

    Writes the block's map of a WHOLE_STEP or a SHORT_STEP.

    Parameters
    ----------
    which
        WHOLE_STEP or SHORT_STEP.
    h
        Length of the step [s].
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

    Parameters
    ----------
    which
        WHOLE_STEP or SHORT_STEP.
    """
    for k in range(INSTANTS):
        block.V[k], block.dV[k], block.ddV[k] = 0.0, 0.0, 0.0
        block.shear_bound[k], block.acceleration_bound[k] = 0.0, 0.0
    move_modes(block, block.step_maps[which])
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
            rise = omega2 * block.dqs[r, k] + two_xi_omega * ddq
            block.dV[k] += Gamma * rise
            block.ddV[k] += Gamma * (omega2 * ddq - two_xi_omega * rise)


@compiled
def move_modes(block: Record, step: Floats) -> None:
    """States of all modes at all instants: each is the map of the one before.

    What the ground does waits for nothing and comes first, see `add_ground`. Three modes then go
    together, so that none waits for its own last step.

    Parameters
    ----------
    step
        (modes, 8), see `fill_map`.
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
    """Write where the ground alone brings mode r in each step, and how fast, to qs and forces.

    Parameters
    ----------
    step
        (modes, 8), see `fill_map`.
    """
    a, b, e, d = step[r, 2], step[r, 3], step[r, 6], step[r, 7]
    for k in range(INSTANTS):
        a_g, slope = block.a_g[k], block.a_g_slope[k]
        block.qs[r, k], block.forces[r, k] = a * a_g + b * slope, e * a_g + d * slope


@compiled
def map_of(step: Floats, r: int) -> Map:
    """The map of mode r.

    Parameters
    ----------
    step
        (modes, 8), see `fill_map`.
    """
    return step[r, 0], step[r, 1], step[r, 4], step[r, 5]


@compiled
def mapped(m: Map, q: float, dq: float, still: float, moving: float) -> tuple[float, float]:
    """Displacement and velocity a step later, with what the ground does to them.

    Parameters
    ----------
    m
        What a step makes of the mode left alone.
    q, dq
        Modal displacement and velocity at its start.
    still, moving
        What the ground adds to either.
    """
    return m[0] * q + (m[1] * dq + still), m[2] * q + (m[3] * dq + moving)


@compiled
def keep_state(block: Record, k: int) -> None:
    """Make the state after k steps of the block the present one.

    Parameters
    ----------
    k
        Steps of the block.
    """
    for r in range(block.n):
        block.q[r], block.dq[r] = block.qs[r, k], block.dqs[r, k]
