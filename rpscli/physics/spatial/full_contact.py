"""What full contact is under two components, beside `planar.full_contact`.

Both directions are followed by the planar blocks of exact steps. The storey uplifts where |z|
passes the limit: the margin is limit - |z|. A norm is convex, so that the control points of both
pushes bound it; where they do not exclude uplift, shorter steps are searched by the quintic of
limit^2 - |z|^2, and the instant is found on the exact margin.
"""

from __future__ import annotations

import math
from typing import TypeAlias

from rpscli.physics.core.compile import compiled, exact_kernel, variant
from rpscli.physics.core.quintic import NO_PASSAGE, SETTLED, first_descent, quintic
from rpscli.physics.core.records import INSTANTS, Floats, Record
from rpscli.physics.planar.devices.rest import pull_at_rest
from rpscli.physics.planar.full_contact.follow import (
    begin_motion,
    demands_stand,
    follow_at_rest,
    largest_at,
    largest_shear,
    stays_down,
)
from rpscli.physics.planar.full_contact.uplift_search import (
    ROUNDING,
    Margin,
    first_uplift,
    margin_after,
    margin_in,
    margin_of,
    push_after,
    push_at,
    push_path,
    raise_alarms,
)
from rpscli.physics.planar.run import Output
from rpscli.physics.spatial.passes import uplift_3d

Margins: TypeAlias = tuple[Margin, Margin]
"""In x and in y; the limit is that of the first."""


@exact_kernel
def follow_full_contact_3d(
    s: Record, l: int, systems: Record, blocks: Record, acceleration: Floats, output: Output
) -> int:
    """Follow a lane in full contact: GOES_ON when it begins to tilt, or IS_OVER."""
    s.push_x[l], s.push_y[l], s.pull[l] = 0.0, 0.0, pull_at_rest(s, l)
    return follow_at_rest(s, l, systems, blocks, acceleration, output)


@variant(margin_of, "cos_phi")
def margins_of(s: Record, l: int, systems: Record) -> Margins:
    """What the margin is made of, in both directions."""
    return margin_in(s, l, systems[0]), margin_in(s, l, systems[1])


@variant(raise_alarms, "cos_phi")
def raise_alarms_3d(_s: Record, blocks: Record, margins: Margins, h: float, least: float) -> bool:
    """Write `alarm` of the first block: 0 for steps that surely keep the margin; whether any is."""
    alarms, block, limits = 0, blocks[0], margins[0]
    for k in range(INSTANTS):
        x, y = push_path(blocks[0], margins[0], h, k), push_path(blocks[1], margins[1], h, k)
        limit, change = limits.right * block.g_up[k], limits.right * block.g_up_slope[k] * h
        lowest = math.inf
        for i in range(6):
            size = math.sqrt(x[i] * x[i] + y[i] * y[i])
            lowest = min(lowest, limit + 0.2 * i * change + limits.held_right - size)
        safe = lowest >= least * (limit + limits.held_right)
        block.alarm[k] = 0.0 if safe else 1.0
        alarms |= 0 if safe else 1
    return alarms > 0


@variant(first_uplift, "cos_phi")
def first_uplift_3d(
    _s: Record, blocks: Record, margins: Margins, h: float, k: int
) -> tuple[float, float]:
    """Fraction of the step after k others at which |z| passes the limit, and 1; else 0."""
    start, end = squared_margin(blocks, margins, h, k, 0), squared_margin(blocks, margins, h, k, 1)
    path = quintic(h, start[0], start[1], start[2], end[0], end[1], end[2])
    found = first_descent(path, SETTLED, blocks[0].piece)
    return found, 1.0 if found < NO_PASSAGE else 0.0


@compiled
def squared_margin(
    blocks: Record, margins: Margins, h: float, k: int, end: int
) -> tuple[float, float, float]:
    """The limit's square less that of z with two derivatives, at the start or the end of a step."""
    x, rise = blocks[0], margins[0].right * blocks[0].g_up_slope[k]
    limit = margins[0].right * (x.g_up[k] + end * h * x.g_up_slope[k]) + margins[0].held_right
    beyond = limit * (1.0 + ROUNDING)
    value, slope, bend = beyond * abs(beyond), 2.0 * limit * rise, 2.0 * rise * rise
    for axis in range(2):
        of = blocks[axis]
        a_g = of.a_g[k] + end * h * of.a_g_slope[k]
        push, rate, curvature = push_at(of, margins[axis], a_g, k, k + end)
        value -= push * push
        slope -= 2.0 * push * rate
        bend -= 2.0 * (rate * rate + push * curvature)
    return value, slope, bend


@variant(margin_after, "cos_phi")
def margin_after_3d(
    _s: Record, blocks: Record, systems: Record, margins: Margins, h: float, k: int, _side: float
) -> tuple[float, float]:
    """The margin and its slope, a time h into the step after k others, exactly."""
    x, x_rate = push_after(blocks[0], systems[0], margins[0], h, k)
    y, y_rate = push_after(blocks[1], systems[1], margins[1], h, k)
    size, right = math.sqrt(x * x + y * y), margins[0].right
    limit = right * (blocks[0].g_up[k] + blocks[0].g_up_slope[k] * h) + margins[0].held_right
    growth = (x * x_rate + y * y_rate) / max(size, 1e-300)
    return limit - size, right * blocks[0].g_up_slope[k] - growth


@variant(begin_motion, "cos_phi")
def begin_motion_3d(s: Record, l: int, systems: Record, log: Record, _side: float) -> None:
    """Uplift along z."""
    uplift_3d(s, l, systems[0], log)


@variant(stays_down, "cos_phi")
def stays_down_3d(s: Record, systems: Record, blocks: Record, margins: Margins) -> bool:
    """Whether the freely vibrating building can never again push hard enough to uplift."""
    x, y = largest_shear(systems[0], blocks[0]), largest_shear(systems[1], blocks[1])
    limit = systems[0].gravity * margins[0].right + margins[0].held_right
    return s.storeys == 0 or bool(margins[0].shear_share * math.sqrt(x * x + y * y) < limit)


@variant(demands_stand, "cos_phi")
def demands_stand_3d(s: Record, l: int, systems: Record, blocks: Record) -> bool:
    """Whether free vibration in full contact can raise no storey shear and no acceleration."""
    for i in range(s.storeys):
        x, y = largest_at(systems[0], blocks[0], i), largest_at(systems[1], blocks[1], i)
        for kind in range(2):
            both = x[kind] * x[kind] + y[kind] * y[kind]
            rises = both > s.largest[3 * kind, l, i] * s.largest[3 * kind, l, i]
            rises |= x[kind] > s.largest[3 * kind + 1, l, i]
            if rises or y[kind] > s.largest[3 * kind + 2, l, i]:
                return False
    return True
