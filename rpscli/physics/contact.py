"""Full contact: a fixed-base building, solved exactly, and the instant at which it uplifts.

While theta = theta' = 0 the building is linear and the ground acceleration is linear over an
interval, so its modes advance without error. The storey uplifts to the side s when the margin

    f(t) = (g + a_v) tan(alpha) (1 + 2 gamma + 2 gamma eta) - s q(t),
    q(t) = -a_g (1 + 2 gamma) + 2 gamma eta V/M_tot

leaves zero downwards (Theory, section 3): exactly where s theta'' of the uplifted equation would
become positive.

Exact steps may be as many as one likes before one looks at them, so they are taken in blocks: the
modes are followed through a block one after the other, then everything that is wanted of its
instants is computed for all of them at once, in vector instructions. Entry k of each row of a block
belongs to the state after k steps. What a lane needs besides stands in its modal rows z (rows, n),
see `contact_layout`.
"""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

from rpscli.physics.contact_layout import (
    ALARM,
    AT,
    COLUMNS,
    DQ,
    DRAG,
    GIVEN,
    MODAL_DQ,
    MODAL_PULL,
    MODAL_Q,
    OMEGA,
    PART,
    PARTICIPATION,
    PUSH,
    PUSH_BEND,
    PUSH_SLOPE,
    RISE,
    RISE_SLOPE,
    SLOPE,
    SQUARE,
    TAKEN,
    XI,
    Q,
)
from rpscli.physics.events import NO_PASSAGE, Quintic, first_descent, lower_hull, quintic
from rpscli.physics.oscillator import transition
from rpscli.physics.parameters import Block, Floats
from rpscli.physics.part import lane_routine, part, routine


class Stance(NamedTuple):
    """What the margin against uplift is made of.

    `own` is 1 + 2 gamma, `share` 2 gamma eta/M_tot [1/kg], `lift` tan(alpha) times the whole,
    `creep` sum Gamma^2 2 xi w.
    """

    own: float
    share: float
    lift: float
    creep: float


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


@part
def push_path(c: Floats, stance: Stance, h: float, k: int) -> Quintic:
    """What pushes the storey over, q(t) of this module, during the step after k others."""
    slope = c[SLOPE * COLUMNS + k]
    start = c[AT * COLUMNS + k]
    bend = -stance.share * stance.creep * slope
    return quintic(
        h,
        stance.share * c[PUSH * COLUMNS + k] - stance.own * start,
        stance.share * c[PUSH_SLOPE * COLUMNS + k] - stance.own * slope,
        stance.share * c[PUSH_BEND * COLUMNS + k] + bend,
        stance.share * c[PUSH * COLUMNS + k + 1] - stance.own * (start + slope * h),
        stance.share * c[PUSH_SLOPE * COLUMNS + k + 1] - stance.own * slope,
        stance.share * c[PUSH_BEND * COLUMNS + k + 1] + bend,
    )


@part
def margin_path(path: Quintic, limit: float, climb: float, side: float) -> Quintic:
    """The margin against uplift to a side: the limit is linear, its coefficients rise evenly."""
    return (
        limit - side * path[0],
        limit + 0.2 * climb - side * path[1],
        limit + 0.4 * climb - side * path[2],
        limit + 0.6 * climb - side * path[3],
        limit + 0.8 * climb - side * path[4],
        limit + climb - side * path[5],
    )


@lane_routine
def raise_alarms(c: Floats, stance: Stance, h: float, least: float) -> None:
    """Write ALARM: 0 for steps in which the margin surely stays positive to both sides.

    `least` is the share of the limit that has to be left for that.
    """
    for k in range(COLUMNS):
        path = push_path(c, stance, h, k)
        limit = stance.lift * c[RISE * COLUMNS + k]
        climb = stance.lift * (c[RISE_SLOPE * COLUMNS + k] * h)
        one = margin_path(path, limit, climb, 1.0)
        other = margin_path(path, limit, climb, -1.0)
        margin = min(lower_hull(one), one[0], lower_hull(other), other[0])
        c[ALARM * COLUMNS + k] = 0.0 if margin >= least * limit else 1.0


@routine
def first_uplift(c: Floats, stance: Stance, h: float, k: int, piece: Floats) -> tuple[float, float]:
    """Fraction of the step after k others at which the storey uplifts, and the side (0: none).

    `piece` (6,) is scratch.
    """
    path = push_path(c, stance, h, k)
    limit = stance.lift * c[RISE * COLUMNS + k]
    climb = stance.lift * (c[RISE_SLOPE * COLUMNS + k] * h)
    first, side = NO_PASSAGE, 0.0
    for sign in (1.0, -1.0):
        t = first_descent(margin_path(path, limit, climb, sign), piece)
        if t < first:
            first, side = t, sign
    return first, side


@part
def margin_after(
    c: Floats, z: Floats, stance: Stance, h: float, k: int, side: float
) -> tuple[float, float]:
    """Margin f against uplift to `side` and its slope, a time h into the step after k, exactly.

    The state at the start of that step stands in Q and DQ.
    """
    fill_transition(z, h, PART)
    at, slope = c[AT * COLUMNS + k], c[SLOPE * COLUMNS + k]
    then = at + slope * h
    V, dV = 0.0, 0.0
    for r in range(z.shape[1]):
        q, dq = z[Q, r], z[DQ, r]
        q_end = z[PART, r] * q + z[PART + 1, r] * dq
        q_end += z[PART + 2, r] * at + z[PART + 3, r] * slope
        dq_end = z[PART + 4, r] * q + z[PART + 5, r] * dq
        dq_end += z[PART + 6, r] * at + z[PART + 7, r] * slope
        pull = z[SQUARE, r] * q_end + z[DRAG, r] * dq_end
        ddq_end = -z[PARTICIPATION, r] * then - pull
        V += z[PARTICIPATION, r] * pull
        dV += z[PARTICIPATION, r] * (z[SQUARE, r] * dq_end + z[DRAG, r] * ddq_end)
    push = stance.share * V - stance.own * then
    slope_of_push = stance.share * dV - stance.own * slope
    limit = stance.lift * (c[RISE * COLUMNS + k] + c[RISE_SLOPE * COLUMNS + k] * h)
    return limit - side * push, stance.lift * c[RISE_SLOPE * COLUMNS + k] - side * slope_of_push


@part
def locate_uplift(
    c: Floats, z: Floats, stance: Stance, h: float, k: int, guess: float, side: float
) -> float:
    """Time into the step after k others, near guess in [0, h], where the margin is zero.

    Newton's method on the exact margin. A margin that only grazes zero has no steep root; the
    interpolant's own root then stands.
    """
    t = guess
    for _ in range(6):
        f, slope = margin_after(c, z, stance, t, k, side)
        if slope >= 0.0:
            break
        change = -f / slope
        if not 0.0 <= t + change <= h or abs(change) < 1e-15 * h:
            break
        t += change
    return t
