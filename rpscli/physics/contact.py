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
    PULLED,
    PULLED_WEIGHT,
    PUSH,
    PUSH_BEND,
    PUSH_SLOPE,
    SLOPE,
    SQUARE,
    STRAIN,
    STRAIN_WEIGHT,
    TAKEN,
    XI,
    Q,
)
from rpscli.physics.oscillator import transition
from rpscli.physics.parameters import Block, Floats
from rpscli.physics.part import part, routine

Map: TypeAlias = tuple[float, float, float, float]
"""What a step makes of a mode left alone: coefficients of q and q' in q, then those in q'."""


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

    Reads the ground's motion (rows AT and SLOPE) and writes the modes' rows, the push and how much
    the modes are strained. Few rows meet in each loop over instants: so the compiler finds it worth
    checking that they do not overlap, and makes vector instructions.
    """
    c = block.rows
    for k in range(COLUMNS):
        c[PUSH * COLUMNS + k] = 0.0
        c[PUSH_SLOPE * COLUMNS + k] = 0.0
        c[PUSH_BEND * COLUMNS + k] = 0.0
        c[STRAIN * COLUMNS + k] = 0.0
        c[PULLED * COLUMNS + k] = 0.0
    follow(block, z, row)
    for r in range(z.shape[1]):
        qs, dqs = block.modes[r, MODAL_Q], block.modes[r, MODAL_DQ]
        pulls = block.modes[r, MODAL_PULL]
        part, square, drag = z[PARTICIPATION, r], z[SQUARE, r], z[DRAG, r]
        for k in range(COLUMNS):
            pulls[k] = square * qs[k] + drag * dqs[k]
        strain, pulled = z[STRAIN_WEIGHT, r], z[PULLED_WEIGHT, r]
        for k in range(COLUMNS):
            c[PUSH * COLUMNS + k] += part * pulls[k]
            c[STRAIN * COLUMNS + k] += strain * (qs[k] * qs[k])
            c[PULLED * COLUMNS + k] += pulled * (pulls[k] * pulls[k])
        for k in range(COLUMNS):
            ddq = -part * c[AT * COLUMNS + k] - pulls[k]
            rise = square * dqs[k] + drag * ddq
            c[PUSH_SLOPE * COLUMNS + k] += part * rise
            c[PUSH_BEND * COLUMNS + k] += part * (square * ddq - drag * rise)


@part
def follow(block: Block, z: Floats, row: int) -> None:
    """States of all modes at all instants: each is the map of the one before.

    What the ground does waits for nothing and comes first, see `shove`. Three modes then go
    together, so that none waits for its own last step.
    """
    modes, n = block.modes, z.shape[1]
    threes = n - n % 3
    for r in range(n):
        shove(block, z, row, r)
    for r in range(0, threes, 3):
        q0, v0, f0 = modes[r, MODAL_Q], modes[r, MODAL_DQ], modes[r, MODAL_PULL]
        q1, v1, f1 = modes[r + 1, MODAL_Q], modes[r + 1, MODAL_DQ], modes[r + 1, MODAL_PULL]
        q2, v2, f2 = modes[r + 2, MODAL_Q], modes[r + 2, MODAL_DQ], modes[r + 2, MODAL_PULL]
        m0, m1, m2 = map_of(z, row, r), map_of(z, row, r + 1), map_of(z, row, r + 2)
        x0, y0 = z[Q, r], z[DQ, r]
        x1, y1 = z[Q, r + 1], z[DQ, r + 1]
        x2, y2 = z[Q, r + 2], z[DQ, r + 2]
        for k in range(COLUMNS):
            still0, still1, still2 = q0[k], q1[k], q2[k]
            q0[k], v0[k], q1[k], v1[k], q2[k], v2[k] = x0, y0, x1, y1, x2, y2
            x0, y0 = mapped(m0, x0, y0, still0, f0[k])
            x1, y1 = mapped(m1, x1, y1, still1, f1[k])
            x2, y2 = mapped(m2, x2, y2, still2, f2[k])
    for r in range(threes, n):
        qs, vs, fs = modes[r, MODAL_Q], modes[r, MODAL_DQ], modes[r, MODAL_PULL]
        m, x, y = map_of(z, row, r), z[Q, r], z[DQ, r]
        for k in range(COLUMNS):
            still = qs[k]
            qs[k], vs[k] = x, y
            x, y = mapped(m, x, y, still, fs[k])


@part
def shove(block: Block, z: Floats, row: int, r: int) -> None:
    """Write where the ground alone brings mode r in each step, and how fast, to Q and PULL."""
    c, still, moving = block.rows, block.modes[r, MODAL_Q], block.modes[r, MODAL_PULL]
    a, b, e, d = z[row + 2, r], z[row + 3, r], z[row + 6, r], z[row + 7, r]
    for k in range(COLUMNS):
        at, slope = c[AT * COLUMNS + k], c[SLOPE * COLUMNS + k]
        still[k], moving[k] = a * at + b * slope, e * at + d * slope


@part
def map_of(z: Floats, row: int, r: int) -> Map:
    """The map of mode r that stands at `row`."""
    return z[row, r], z[row + 1, r], z[row + 4, r], z[row + 5, r]


@part
def mapped(m: Map, q: float, dq: float, still: float, moving: float) -> tuple[float, float]:
    """Displacement and velocity a step later, with what the ground does to them."""
    return m[0] * q + (m[1] * dq + still), m[2] * q + (m[3] * dq + moving)


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
