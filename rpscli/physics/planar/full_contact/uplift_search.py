"""The instant at which a building in full contact uplifts.

The storey uplifts to the side s when the margin

    f(t) = (g + a_v) tan(alpha) (1 + 2 gamma + 2 gamma eta) - s q(t),
    q(t) = -a_g (1 + 2 gamma) + 2 gamma eta V/M_tot

leaves zero downwards (Theory (3.1), (3.2)): exactly where s theta'' of the uplifted equation would
become positive. Devices at rest add to the limit; a storey that friction holds tilted has another
limit on either side (section 11). Steps that surely keep it positive are told by the quintic
through the push q and its derivatives, for a whole block at once; the instant itself is found on
the exact margin.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from rpscli.physics.core.compile import by_record, compiled
from rpscli.physics.core.quintic import (
    NO_PASSAGE,
    SETTLED,
    Quintic,
    first_descent,
    lower_hull,
    quintic,
)
from rpscli.physics.core.records import INSTANTS, Record
from rpscli.physics.planar.bed.terms import hold_of_bed, lift_arm
from rpscli.physics.planar.devices.rest import arms, force_at_rest
from rpscli.physics.planar.equation_of_motion import load_factors, uplift_push
from rpscli.physics.planar.full_contact.modal_block import fill_map, map_of, mapped
from rpscli.physics.planar.state import SHORT_STEP, STUCK

ROUNDING = 1e-13
"""Share of the limit within which the margin is zero. Were it the last bit that decides, a motion
whose peak is the limit itself would uplift and land again and again, without time passing."""


class Margin(NamedTuple):
    """What the margin against uplift is made of."""

    ground_factor: float  # 1 + 2 gamma
    shear_share: float  # 2 gamma eta/M_tot [1/kg]
    right: float  # times g + a_v the limit to this side: tan(alpha) (1 + 2 gamma + 2 gamma eta)
    left: float  # likewise; both are others where it is stuck
    held_right: float  # what devices add to the limit [m/s2]
    held_left: float  # what devices add to the limit [m/s2]
    ground_damping: float  # sum Gamma^2 2 xi w [kg/s]: what the ground's slope adds to V''


@by_record
def margin_of(s: Record, l: int, system: Record) -> Margin:
    """What the margin of a structure at rest is made of, in full contact or stuck."""
    return margin_in(s, l, system)


@compiled
def margin_in(s: Record, l: int, system: Record) -> Margin:
    """The same in one direction."""
    ground_factor, building = load_factors(system.gamma, system.eta)
    damping = 0.0
    for r in range(system.n):
        damping += system.Gamma[r] * system.Gamma[r] * system.two_xi_omega[r]
    share = building / system.floors_mass if system.n > 0 else 0.0
    limit = math.tan(system.alpha) * (ground_factor + building)
    right, left, held_right, held_left = limit, limit, 0.0, 0.0
    if s.devices[l] > 0:
        elastic, friction = force_at_rest(s, l)
        elastic, friction = elastic * 2.0 / s.columns_mass[l], friction * 2.0 / s.columns_mass[l]
        held_right, held_left = elastic + friction, elastic + friction
        if s.phase[l] == STUCK:
            B, C = arms(s, l)
            elastic = hold_of_bed(s, l, s.theta[l], elastic, C)
            B = lift_arm(s, l, s.theta[l], B)
            right = s.side[l] * B / C * (ground_factor + building)
            left, elastic = -right, s.side[l] * elastic
            held_right, held_left = friction + elastic, friction - elastic
    return Margin(ground_factor, share, right, left, held_right, held_left, damping)


@compiled
def limit_to(margin: Margin, side: float) -> tuple[float, float]:
    """What multiplies g + a_v in the limit to a side, and what devices hold [m/s2]."""
    if side > 0.0:
        return margin.right, margin.held_right
    return margin.left, margin.held_left


@compiled
def push_at(block: Record, margin: Margin, a_g: float, k: int, of: int) -> tuple[float, ...]:
    """The push and its first two derivatives after `of` steps, the ground as in the k-th."""
    factor, share, slope = margin.ground_factor, margin.shear_share, block.a_g_slope[k]
    return (
        uplift_push(factor, share, a_g, block.V[of]),
        uplift_push(factor, share, slope, block.dV[of]),
        share * block.ddV[of] + -share * margin.ground_damping * slope,
    )


@compiled
def push_path(block: Record, margin: Margin, h: float, k: int) -> Quintic:
    """What pushes the storey over, q(t) of this module, during the step after k others [h s]."""
    start = push_at(block, margin, block.a_g[k], k, k)
    end = push_at(block, margin, block.a_g[k] + block.a_g_slope[k] * h, k, k + 1)
    return quintic(h, start[0], start[1], start[2], end[0], end[1], end[2])


@compiled
def margin_path(path: Quintic, limit: float, change: float, side: float, held: float) -> Quintic:
    """The margin against uplift to a side: the limit is linear, its coefficients change evenly."""
    return (
        limit - (side * path[0] - held),
        limit + 0.2 * change - (side * path[1] - held),
        limit + 0.4 * change - (side * path[2] - held),
        limit + 0.6 * change - (side * path[3] - held),
        limit + 0.8 * change - (side * path[4] - held),
        limit + change - (side * path[5] - held),
    )


@by_record
def raise_alarms(_s: Record, block: Record, margin: Margin, h: float, least: float) -> bool:
    """Write `alarm`: 0 for steps in which the margin surely stays positive to both sides [h s].

    Returns whether any is not 0.
    """
    alarms = 0
    for k in range(INSTANTS):
        path = push_path(block, margin, h, k)
        g_up, change = block.g_up[k], block.g_up_slope[k] * h
        to_right, to_left = margin.right * g_up, margin.left * g_up
        right = margin_path(path, to_right, margin.right * change, 1.0, margin.held_right)
        left = margin_path(path, to_left, margin.left * change, -1.0, margin.held_left)
        lowest = min(lower_hull(right), right[0], lower_hull(left), left[0])
        held = 0.5 * (margin.held_right + margin.held_left)
        safe = lowest >= least * (0.5 * (to_right + to_left) + held)
        block.alarm[k] = 0.0 if safe else 1.0
        alarms |= 0 if safe else 1
    return alarms > 0


@by_record
def first_uplift(
    _s: Record, block: Record, margin: Margin, h: float, k: int
) -> tuple[float, float]:
    """Fraction of the step after k others at which the storey uplifts, and the side (0: none)."""
    path = push_path(block, margin, h, k)
    # Where gravity is lost both margins are negative at once: then the push decides.
    push = 0.0
    for b in path:
        push = push if push != 0.0 else b
    likelier = -1.0 if push < 0.0 else 1.0
    first, side = NO_PASSAGE, 0.0
    for sign in (likelier, -likelier):
        factor, held = limit_to(margin, sign)
        limit = factor * block.g_up[k]
        change = factor * (block.g_up_slope[k] * h)
        beyond = limit + ROUNDING * (abs(limit) + held)
        t = first_descent(margin_path(path, beyond, change, sign, held), SETTLED, block.piece)
        if t < first:
            first, side = t, sign
    return first, side


@compiled
def push_after(
    block: Record, system: Record, margin: Margin, h: float, k: int
) -> tuple[float, float]:
    """The push q and its slope, a time h into the step after k, exactly.

    The state at the start of that step is the present one of the block.
    """
    fill_map(block, system, SHORT_STEP, h)
    start, slope, step = block.a_g[k], block.a_g_slope[k], block.step_maps[SHORT_STEP]
    a_g = start + slope * h
    V, dV = 0.0, 0.0
    for r in range(block.n):
        still = step[r, 2] * start + step[r, 3] * slope
        moving = step[r, 6] * start + step[r, 7] * slope
        q, dq = mapped(map_of(step, r), block.q[r], block.dq[r], still, moving)
        force = system.omega2[r] * q + system.two_xi_omega[r] * dq
        ddq = -system.Gamma[r] * a_g - force
        V += system.Gamma[r] * force
        dV += system.Gamma[r] * (system.omega2[r] * dq + system.two_xi_omega[r] * ddq)
    factor, share = margin.ground_factor, margin.shear_share
    return uplift_push(factor, share, a_g, V), uplift_push(factor, share, slope, dV)


@by_record
def margin_after(
    _s: Record, block: Record, system: Record, margin: Margin, h: float, k: int, side: float
) -> tuple[float, float]:
    """Margin f against uplift to `side` and its slope, a time h into the step after k, exactly."""
    push, push_slope = push_after(block, system, margin, h, k)
    factor, held = limit_to(margin, side)
    limit = factor * (block.g_up[k] + block.g_up_slope[k] * h)
    return limit - (side * push - held), factor * block.g_up_slope[k] - side * push_slope


@compiled
def locate_uplift(
    s: Record,
    block: Record,
    system: Record,
    margin: Margin,
    h: float,
    k: int,
    guess: float,
    side: float,
) -> float:
    """Time into the step after k others, near guess in [0, h], where the margin is zero [s].

    Newton's method on the exact margin. A margin that only grazes zero has no steep root; the
    interpolant's own root then stands.
    """
    t = guess
    for _ in range(6):
        f, slope = margin_after(s, block, system, margin, t, k, side)
        if slope >= 0.0:
            break
        change = -f / slope
        if not 0.0 <= t + change <= h or abs(change) < 1e-15 * h:
            break
        t += change
    return t
