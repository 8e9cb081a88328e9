"""The instant at which a building in full contact uplifts.

The storey uplifts to the side s when the margin

    f(t) = (g + a_v) tan(alpha) (1 + 2 gamma + 2 gamma eta) - s q(t),
    q(t) = -a_g (1 + 2 gamma) + 2 gamma eta V/M_tot

leaves zero downwards (Theory, section 3): exactly where s theta'' of the uplifted equation would
become positive. Steps that surely keep it positive are told by the quintic through the push q and
its derivatives, for a whole block at once; the instant itself is found on the exact margin.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from rpscli.physics.contact import fill_transition, map_of, mapped
from rpscli.physics.contact_layout import (
    ALARM,
    AT,
    COLUMNS,
    DQ,
    DRAG,
    PART,
    PARTICIPATION,
    PUSH,
    PUSH_BEND,
    PUSH_SLOPE,
    RISE,
    RISE_SLOPE,
    SLOPE,
    SQUARE,
    Q,
)
from rpscli.physics.events import NO_PASSAGE, SETTLED, Quintic, first_descent, lower_hull, quintic
from rpscli.physics.lane import Lane
from rpscli.physics.parameters import Floats
from rpscli.physics.part import lane_routine, part, routine
from rpscli.physics.podium_layout import ALPHA, ETA, FLOORS_MASS, GAMMA


class Stance(NamedTuple):
    """What the margin against uplift is made of.

    `own` is 1 + 2 gamma, `share` 2 gamma eta/M_tot [1/kg], `lift` tan(alpha) times the whole,
    `creep` sum Gamma^2 2 xi w.
    """

    own: float
    share: float
    lift: float
    creep: float


@part
def stance_of(lane: Lane) -> Stance:
    """What the lane's margin against uplift is made of."""
    z, p = lane.modes, lane.podium
    own, carried = 1.0 + 2.0 * p[GAMMA], 2.0 * p[GAMMA] * p[ETA]
    creep = 0.0
    for r in range(z.shape[1]):
        creep += z[PARTICIPATION, r] * z[PARTICIPATION, r] * z[DRAG, r]
    share = carried / p[FLOORS_MASS] if z.shape[1] > 0 else 0.0
    return Stance(own, share, math.tan(p[ALPHA]) * (own + carried), creep)


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
def raise_alarms(c: Floats, stance: Stance, h: float, least: float) -> bool:
    """Write ALARM: 0 for steps in which the margin surely stays positive to both sides.

    `least` is the share of the limit that has to be left for that. Returns whether any is not 0.
    """
    alarms = 0
    for k in range(COLUMNS):
        path = push_path(c, stance, h, k)
        limit = stance.lift * c[RISE * COLUMNS + k]
        climb = stance.lift * (c[RISE_SLOPE * COLUMNS + k] * h)
        one = margin_path(path, limit, climb, 1.0)
        other = margin_path(path, limit, climb, -1.0)
        margin = min(lower_hull(one), one[0], lower_hull(other), other[0])
        quiet = margin >= least * limit
        c[ALARM * COLUMNS + k] = 0.0 if quiet else 1.0
        alarms |= 0 if quiet else 1
    return alarms > 0


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
        t = first_descent(margin_path(path, limit, climb, sign), SETTLED, piece)
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
        still = z[PART + 2, r] * at + z[PART + 3, r] * slope
        moving = z[PART + 6, r] * at + z[PART + 7, r] * slope
        q_end, dq_end = mapped(map_of(z, PART, r), z[Q, r], z[DQ, r], still, moving)
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
