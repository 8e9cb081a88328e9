"""Full contact: a fixed-base building, solved exactly.

While theta = theta' = 0 the building is linear and the ground acceleration is linear over an
interval, so its modes advance without error (Theory, section 10). Exact steps may be as many as one
likes before one looks at them, so they are taken in blocks: the modes are followed through a block
one after the other, then everything that is wanted of its instants is computed for all of them at
once, in vector instructions. Entry k of each row of a block belongs to the state after k steps.
What a lane needs besides stands in its modal rows z (rows, n), see `contact_layout`.
"""

from __future__ import annotations

from typing import TypeAlias

from rpscli.physics.contact_layout import (
    AT,
    COLUMNS,
    DQ,
    DRAG,
    GIVEN,
    MODAL_DQ,
    MODAL_PULL,
    MODAL_Q,
    OMEGA,
    PARTICIPATION,
    PUSH,
    PUSH_BEND,
    PUSH_SLOPE,
    SLOPE,
    SQUARE,
    TAKEN,
    XI,
    Q,
)
from rpscli.physics.oscillator import transition
from rpscli.physics.parameters import Block, Floats
from rpscli.physics.part import part, routine

Map: TypeAlias = tuple[float, float, float, float, float, float, float, float]
"""What a step makes of a mode: coefficients of q, q', a_g and its slope in q, then those in q'."""


@routine
def fill_transition(z: Floats, h: float, row: int) -> None:
    """The exact map of every mode over h, under the ground's acceleration; 8 rows from `row`."""
    for r in range(z.shape[1]):
        a, b, c, d, e, f, g, i = transition(z[OMEGA, r], z[XI, r], h)
        load = -z[PARTICIPATION, r]
        z[row, r], z[row + 1, r], z[row + 2, r], z[row + 3, r] = a, b, load * c, load * d
        z[row + 4, r], z[row + 5, r], z[row + 6, r], z[row + 7, r] = e, f, load * g, load * i


@routine
def march(block: Block, z: Floats, row: int) -> None:
    """Follow every mode through a block, from Q and DQ; the map of a step stands at `row`.

    Reads the ground's motion (rows AT and SLOPE) and writes the modes' rows and the push. Few rows
    meet in each loop over instants: so the compiler finds it worth checking that they do not
    overlap, and makes vector instructions.
    """
    c = block.rows
    for k in range(COLUMNS):
        c[PUSH * COLUMNS + k] = 0.0
        c[PUSH_SLOPE * COLUMNS + k] = 0.0
        c[PUSH_BEND * COLUMNS + k] = 0.0
    follow(block, z, row)
    for r in range(z.shape[1]):
        qs, dqs = block.modes[r, MODAL_Q], block.modes[r, MODAL_DQ]
        pulls = block.modes[r, MODAL_PULL]
        part, square, drag = z[PARTICIPATION, r], z[SQUARE, r], z[DRAG, r]
        for k in range(COLUMNS):
            pulls[k] = square * qs[k] + drag * dqs[k]
        for k in range(COLUMNS):
            c[PUSH * COLUMNS + k] += part * pulls[k]
        for k in range(COLUMNS):
            ddq = -part * c[AT * COLUMNS + k] - pulls[k]
            rise = square * dqs[k] + drag * ddq
            c[PUSH_SLOPE * COLUMNS + k] += part * rise
            c[PUSH_BEND * COLUMNS + k] += part * (square * ddq - drag * rise)


@part
def follow(block: Block, z: Floats, row: int) -> None:
    """States of all modes at all instants: each is the map of the one before.

    Two modes go together, so that neither waits for its own last step; the last of an odd number
    goes with itself.
    """
    c, modes, n = block.rows, block.modes, z.shape[1]
    for r in range(0, n, 2):
        t = min(r + 1, n - 1)
        one, other = map_of(z, row, r), map_of(z, row, t)
        q, dq, p, dp = z[Q, r], z[DQ, r], z[Q, t], z[DQ, t]
        qs, dqs, ps, dps = (
            modes[r, MODAL_Q],
            modes[r, MODAL_DQ],
            modes[t, MODAL_Q],
            modes[t, MODAL_DQ],
        )
        for k in range(COLUMNS):
            at, slope = c[AT * COLUMNS + k], c[SLOPE * COLUMNS + k]
            qs[k], dqs[k], ps[k], dps[k] = q, dq, p, dp
            q, dq = mapped(one, q, dq, at, slope)
            p, dp = mapped(other, p, dp, at, slope)


@part
def map_of(z: Floats, row: int, r: int) -> Map:
    """The map of mode r that stands at `row`."""
    return (
        z[row, r],
        z[row + 1, r],
        z[row + 2, r],
        z[row + 3, r],
        z[row + 4, r],
        z[row + 5, r],
        z[row + 6, r],
        z[row + 7, r],
    )


@part
def mapped(m: Map, q: float, dq: float, at: float, slope: float) -> tuple[float, float]:
    """Displacement and velocity a step later, under the ground's acceleration and its slope."""
    still, moving = m[2] * at + m[3] * slope, m[6] * at + m[7] * slope
    return m[0] * q + (m[1] * dq + still), m[4] * q + (m[5] * dq + moving)


@part
def keep(block: Block, z: Floats, k: int) -> None:
    """Make the state after k steps of the block the present one."""
    for r in range(z.shape[1]):
        z[Q, r], z[DQ, r] = block.modes[r, MODAL_Q, k], block.modes[r, MODAL_DQ, k]


@routine
def energies(block: Block, z: Floats, h: float) -> None:
    """Energy put in by the ground and damped during each step of length h [J].

    The input -int a_g 1^T M u' dt is exact: integrated by parts it needs int q dt, which the
    equation of motion gives. The damped energy, with the square of the velocity, is that of the
    quintic with the values, slopes and curvatures of both ends: of order 6, and independent of the
    solution's own balance so that the audit can show something.
    """
    c = block.rows
    for k in range(COLUMNS):
        c[GIVEN * COLUMNS + k], c[TAKEN * COLUMNS + k] = 0.0, 0.0
    for r in range(z.shape[1]):
        qs, dqs = block.modes[r, MODAL_Q], block.modes[r, MODAL_DQ]
        part, square, drag = z[PARTICIPATION, r], z[SQUARE, r], z[DRAG, r]
        for k in range(COLUMNS - 1):
            a0, slope = c[AT * COLUMNS + k], c[SLOPE * COLUMNS + k]
            a1 = a0 + slope * h
            q0, q1, v0, v1 = qs[k], qs[k + 1], dqs[k], dqs[k + 1]
            area = (-part * 0.5 * (a0 + a1) * h - (v1 - v0) - drag * (q1 - q0)) / square
            g0 = -part * a0 - drag * v0 - square * q0
            g1 = -part * a1 - drag * v1 - square * q1
            c[GIVEN * COLUMNS + k] -= part * (a1 * q1 - a0 * q0 - slope * area)
            j0 = -part * slope - drag * g0 - square * v0
            j1 = -part * slope - drag * g1 - square * v1
            ends = 0.5 * (v0 * v0 + v1 * v1) + h / 5.0 * (v0 * g0 - v1 * g1)
            bends = h * h / 60.0 * (g0 * g0 + v0 * j0 + (g1 * g1 + v1 * j1))
            c[TAKEN * COLUMNS + k] += drag * h * (ends + bends)
