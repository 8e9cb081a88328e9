"""A lane in full contact: the building in x and in y on a fixed base, until |z| uplifts.

Both directions are followed by the planar blocks of exact steps. The storey uplifts where |z|
passes the limit: the margin is limit - |z|. A norm is convex, so that the control points of both
pushes bound it; where they do not exclude uplift, shorter steps are searched by the quintic of
limit^2 - |z|^2, and the instant is found on the exact margin.
"""

from __future__ import annotations

import math
from typing import TypeAlias

from rpscli.physics.core.compile import compiled, kernel
from rpscli.physics.core.lanes import enter_interval, set_ground_of_block
from rpscli.physics.core.quintic import NO_PASSAGE, SETTLED, first_descent, quintic
from rpscli.physics.core.records import INSTANTS, NO_HISTORY, Floats, Record
from rpscli.physics.core.series import middle_of, peak
from rpscli.physics.planar.demands import WITHIN, raise_by, reach
from rpscli.physics.planar.equation_of_motion import (
    Measures,
    contact_forces,
    measures_of,
    uplift_push,
)
from rpscli.physics.planar.full_contact.demands import add_modes, largest_of_row
from rpscli.physics.planar.full_contact.follow import (
    FINE,
    NEAR,
    REST_EVERY,
    Plan,
    modal_speed,
    plan_block,
)
from rpscli.physics.planar.full_contact.modal_block import (
    book_energy_of_block,
    fill_map,
    fill_work,
    follow_modes,
    keep_state,
    map_of,
    mapped,
)
from rpscli.physics.planar.full_contact.uplift_search import ROUNDING, Margin, margin_of, push_path
from rpscli.physics.planar.run import Output
from rpscli.physics.planar.state import FAILED_NOT_FINITE, GOES_ON, IS_OVER, SHORT_STEP, WHOLE_STEP
from rpscli.physics.spatial.demands import set_below
from rpscli.physics.spatial.passes import uplift_3d
from rpscli.physics.spatial.samples import store_at_rest_3d, store_sample_3d
from rpscli.physics.spatial.state import Pair
from rpscli.physics.spatial.steps import plan_step

Margins: TypeAlias = tuple[Margin, Margin]
"""In x and in y; the limit is that of the first."""


@compiled
def modes_between(s: Record, l: int, blocks: Record, back: int) -> None:
    """Hand the modes of a lane to the blocks, or take them back."""
    half = s.storeys
    for axis in range(2):
        block = blocks[axis]
        for r in range(half):
            if back > 0:
                s.q[half * axis + r, l], s.dq[0, half * axis + r, l] = block.q[r], block.dq[r]
            else:
                block.q[r], block.dq[r] = s.q[half * axis + r, l], s.dq[0, half * axis + r, l]


# The search of uplift.


@compiled
def raise_alarms_3d(blocks: Record, margins: Margins, h: float, least: float) -> bool:
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


@compiled
def first_uplift_3d(blocks: Record, margins: Margins, h: float, k: int) -> float:
    """Fraction of the step after k others at which |z| passes the limit, or NO_PASSAGE."""
    limits, x, y, block = margins[0], blocks[0], blocks[1], blocks[0]
    ends = (0.0, 0.0, 0.0)
    others = (0.0, 0.0, 0.0)
    rise = limits.right * block.g_up_slope[k]
    for end in range(2):
        at = k + end
        squares = 0.0, 0.0, 0.0
        for axis in range(2):
            of, m = (x, margins[0]) if axis == 0 else (y, margins[1])
            a, slope = of.a_g[k] + end * h * of.a_g_slope[k], of.a_g_slope[k]
            push = uplift_push(m.ground_factor, m.shear_share, a, of.V[at])
            rate = uplift_push(m.ground_factor, m.shear_share, slope, of.dV[at])
            bend = m.shear_share * (of.ddV[at] - m.ground_damping * slope)
            squares = (
                squares[0] + push * push,
                squares[1] + 2.0 * push * rate,
                squares[2] + 2.0 * (rate * rate + push * bend),
            )
        limit = limits.right * (block.g_up[k] + end * h * block.g_up_slope[k]) + limits.held_right
        beyond = limit * (1.0 + ROUNDING)
        found = (
            beyond * abs(beyond) - squares[0],
            2.0 * limit * rise - squares[1],
            2.0 * rise * rise - squares[2],
        )
        ends, others = (found, others) if end == 0 else (ends, found)
    path = quintic(h, ends[0], ends[1], ends[2], others[0], others[1], others[2])
    return first_descent(path, SETTLED, block.piece)


@compiled
def locate_uplift_3d(
    blocks: Record, systems: Pair, margins: Margins, h: float, k: int, guess: float
) -> float:
    """Time into the step after k others, near guess in [0, h], where the margin is zero [s]."""
    t = guess
    for _ in range(6):
        size2, growth = 0.0, 0.0
        for axis in range(2):
            block, system, m = blocks[axis], systems[0], margins[0]
            if axis == 1:
                system, m = systems[1], margins[1]
            push, rate = push_after(block, system, m, t, k)
            size2, growth = size2 + push * push, growth + push * rate
        size = math.sqrt(size2)
        limit = margins[0].right * (blocks[0].g_up[k] + blocks[0].g_up_slope[k] * t)
        f = limit + margins[0].held_right - size
        slope = margins[0].right * blocks[0].g_up_slope[k] - growth / max(size, 1e-300)
        if slope >= 0.0:
            break
        change = -f / slope
        if not 0.0 <= t + change <= h or abs(change) < 1e-15 * h:
            break
        t += change
    return t


@compiled
def push_after(
    block: Record, system: Record, margin: Margin, h: float, k: int
) -> tuple[float, float]:
    """The push in one direction and its rate a time h into the step after k, exactly.

    The state at the start of that step is the present one of the block.
    """
    fill_map(block, system, SHORT_STEP, h)
    start, slope, step = block.a_g[k], block.a_g_slope[k], block.step_maps[SHORT_STEP]
    a_g, V, dV = start + slope * h, 0.0, 0.0
    for r in range(system.n):
        still = step[r, 2] * start + step[r, 3] * slope
        moving = step[r, 6] * start + step[r, 7] * slope
        q, dq = mapped(map_of(step, r), block.q[r], block.dq[r], still, moving)
        force = system.omega2[r] * q + system.two_xi_omega[r] * dq
        ddq = -system.Gamma[r] * a_g - force
        V += system.Gamma[r] * force
        dV += system.Gamma[r] * (system.omega2[r] * dq + system.two_xi_omega[r] * ddq)
    factor, share = margin.ground_factor, margin.shear_share
    return uplift_push(factor, share, a_g, V), uplift_push(factor, share, slope, dV)


@compiled
def search_blocks(
    blocks: Record, margins: Margins, plan: Plan, least: float
) -> tuple[int, float, bool]:
    """Steps that end before uplift, the fraction of the next, and whether uplift comes or is near.

    With `least` 0 uplift is located; else the steps end before the first that is near it.
    """
    if not raise_alarms_3d(blocks, margins, plan.h, least):
        return plan.steps, NO_PASSAGE, False
    for taken in range(plan.steps):
        if blocks[0].alarm[taken] > 0.0:
            if least > 0.0:
                return taken, NO_PASSAGE, True
            fraction = first_uplift_3d(blocks, margins, plan.h, taken)
            if fraction <= 1.0:
                return taken, fraction, False
    return plan.steps, NO_PASSAGE, False


# Demands in full contact.


@compiled
def observe_blocks(s: Record, l: int, systems: Pair, blocks: Record, h: float, steps: int) -> None:
    """Raise the demands of a lane by those of the first steps of the blocks, of length h [s]."""
    part, ratio = (WITHIN / 8.0 * h * h) ** 2, s.bend_ratio[l]
    found, x, y = 0, blocks[0], blocks[1]
    for k in range(INSTANTS):
        bent_x, bent_y = part * x.shear_bend[k], part * y.shear_bend[k]
        both = x.shear_bound[k] + y.shear_bound[k]
        more = reach(both, bent_x + bent_y) > s.shear_below[0, l]
        more |= reach(x.shear_bound[k], bent_x) > s.shear_below[1, l]
        more |= reach(y.shear_bound[k], bent_y) > s.shear_below[2, l]
        bent_x, bent_y = ratio * bent_x, ratio * bent_y
        both = x.acceleration_bound[k] + y.acceleration_bound[k]
        more |= reach(both, bent_x + bent_y) > s.acceleration_below[0, l]
        more |= reach(x.acceleration_bound[k], bent_x) > s.acceleration_below[1, l]
        more |= reach(y.acceleration_bound[k], bent_y) > s.acceleration_below[2, l]
        found |= 1 if more & (k <= steps) else 0
    if found > 0 and s.storeys > 0:
        raise_floors_of_blocks(s, l, systems, blocks, h, steps)
        set_below(s, l, systems)
    observe_contacts_3d(s, l, blocks, h, steps)


@compiled
def raise_floors_of_blocks(
    s: Record, l: int, systems: Pair, blocks: Record, h: float, steps: int
) -> None:
    """Raise the largest storey shears and floor accelerations by those of a block."""
    x, y = blocks[0], blocks[1]
    for axis in range(2):
        block, system = blocks[axis], systems[0]
        if axis == 1:
            system = systems[1]
        for r in range(block.n):
            omega2, damping, Gamma = system.omega2[r], system.two_xi_omega[r], system.Gamma[r]
            for k in range(INSTANTS):
                ddq = -Gamma * block.a_g[k] - block.forces[r, k]
                block.rises[r, k] = omega2 * block.dqs[r, k] + damping * ddq
    for i in range(s.storeys):
        add_modes(x, systems[0].storey_shear_of, x.qs, x.row, i)
        add_modes(x, systems[0].storey_shear_of, x.dqs, x.row_slope, i)
        add_modes(y, systems[1].storey_shear_of, y.qs, y.row, i)
        add_modes(y, systems[1].storey_shear_of, y.dqs, y.row_slope, i)
        raise_by_rows(
            s.storey_shear[l], s.storey_shear_x[l], s.storey_shear_y[l], x, y, i, h, steps
        )
        add_modes(x, systems[0].phi, x.forces, x.row, i)
        add_modes(x, systems[0].phi, x.rises, x.row_slope, i)
        add_modes(y, systems[1].phi, y.forces, y.row, i)
        add_modes(y, systems[1].phi, y.rises, y.row_slope, i)
        both = s.floor_acceleration[l]
        raise_by_rows(both, s.floor_acceleration_x[l], s.floor_acceleration_y[l], x, y, i, h, steps)


@compiled
def raise_by_rows(
    both: Floats, in_x: Floats, in_y: Floats, x: Record, y: Record, i: int, h: float, steps: int
) -> None:
    """Raise the demand of one floor by the rows of both blocks."""
    in_x[i] = max(in_x[i], largest_of_row(x, h, steps))
    in_y[i] = max(in_y[i], largest_of_row(y, h, steps))
    largest, after = both[i], 0.0
    for k in range(steps):
        x0, x1, y0, y1 = x.row[k], x.row[k + 1], y.row[k], y.row[k + 1]
        x_middle = middle_of(x0, x1, h * x.row_slope[k], h * x.row_slope[k + 1])
        y_middle = middle_of(y0, y1, h * y.row_slope[k], h * y.row_slope[k + 1])
        before = math.sqrt(x0 * x0 + y0 * y0) if k == 0 else after
        middle = math.sqrt(x_middle * x_middle + y_middle * y_middle)
        after = math.sqrt(x1 * x1 + y1 * y1)
        largest = max(largest, peak(before, middle, after))
    both[i] = largest


@compiled
def observe_contacts_3d(s: Record, l: int, blocks: Record, h: float, steps: int) -> None:
    """Raise friction demands and forces of contacts at rest, within steps and at both ends."""
    x, y = blocks[0], blocks[1]
    beam, columns, gravity = s.cap_beam_mass[l], s.columns_mass[l], s.gravity[l]
    upper = beam + s.floors_mass[l]
    for k in range(steps):
        g_up = x.g_up[k]
        bulge = WITHIN / 8.0 * h * (abs(x.dV[k] - x.dV[k + 1]) + abs(y.dV[k] - y.dV[k + 1]))
        bulge += abs(x.V[k] - x.V[k + 1]) + abs(y.V[k] - y.V[k + 1])
        more = (beam + columns) * h * (abs(x.a_g_slope[k]) + abs(y.a_g_slope[k]))
        lighter = h * abs(x.g_up_slope[k])
        shear_x, shear_y = beam * x.a_g[k] - x.V[k], beam * y.a_g[k] - y.V[k]
        low_x, low_y = shear_x + columns * x.a_g[k], shear_y + columns * y.a_g[k]
        top = math.sqrt(shear_x * shear_x + shear_y * shear_y) + bulge + more
        bottom = math.sqrt(low_x * low_x + low_y * low_y) + bulge + more
        rises = top > s.friction_top[l] * upper * (g_up - lighter)
        rises |= bottom > s.friction_bottom[l] * (upper + columns) * (g_up - lighter)
        rises |= (top > s.shear_top[l]) | (bottom > s.shear_bottom[l])
        rises |= g_up - lighter < s.normal_bottom[l] * gravity
        rises |= g_up + lighter > s.heavy_bottom[l] * gravity
        if rises:
            V_x = middle_of(x.V[k], x.V[k + 1], h * x.dV[k], h * x.dV[k + 1])
            V_y = middle_of(y.V[k], y.V[k + 1], h * y.dV[k], h * y.dV[k + 1])
            raise_by(
                s,
                l,
                measures_at_rest(s, l, blocks, x.V[k], y.V[k], k, 0.0),
                measures_at_rest(s, l, blocks, V_x, V_y, k, 0.5 * h),
                measures_at_rest(s, l, blocks, x.V[k + 1], y.V[k + 1], k, h),
            )


@compiled
def measures_at_rest(
    s: Record, l: int, blocks: Record, V_x: float, V_y: float, k: int, t: float
) -> Measures:
    """Measures of contacts at rest, a time t into the step after k others."""
    x, y = blocks[0], blocks[1]
    g_up = x.g_up[k] + t * x.g_up_slope[k]
    a_x, a_y = x.a_g[k] + t * x.a_g_slope[k], y.a_g[k] + t * y.a_g_slope[k]
    beam, floors, columns = s.cap_beam_mass[l], s.floors_mass[l], s.columns_mass[l]
    V_x, V_y = V_x + s.push_x[l], V_y + s.push_y[l]
    top_x, low_x, top, low = contact_forces(
        beam, floors, columns, 0.0, 0.0, V_x, a_x, g_up, s.pull[l]
    )
    top_y, low_y, _, _ = contact_forces(beam, floors, columns, 0.0, 0.0, V_y, a_y, g_up, s.pull[l])
    shear_top = math.sqrt(top_x * top_x + top_y * top_y)
    shear_low = math.sqrt(low_x * low_x + low_y * low_y)
    return measures_of(beam + floors, columns, s.gravity[l], shear_top, shear_low, top, low)


# The driver.


@compiled
def accept_blocks(
    s: Record,
    l: int,
    systems: Pair,
    blocks: Record,
    acceleration: Floats,
    output: Output,
    plan: Plan,
    taken: int,
    margins: Margins,
) -> bool:
    """Make the state after some steps of the blocks that of the lane; True if its history ends."""
    first, time = s.interval[l], s.time[l]
    passed = taken // plan.each
    if output.samples.shape[0] > 0:
        book_blocks(blocks, systems, plan.which, plan.h)
        for k in range(1, taken + 1):
            s.energy_input[l] += blocks[0].input[k - 1] + blocks[1].input[k - 1]
            s.energy_damped[l] += blocks[0].damped[k - 1] + blocks[1].damped[k - 1]
            done = (k - 1) // plan.each
            s.interval[l] = first + done
            if output.finer > 1:
                begin = (k - 1 - done * plan.each) * plan.h + (time if done == 0 else 0.0)
                store_at_rest_3d(s, l, systems, blocks, output, k - 1, begin, plan.h)
            s.interval[l] = first + k // plan.each
            if k % plan.each == 0:
                keep_states(blocks, k)
                modes_between(s, l, blocks, 1)
                store_sample_3d(s, l, systems, output)
    keep_states(blocks, taken)
    if passed == 0:
        s.time[l] = time + taken * plan.h
        return False
    over = enter_interval_3d(s, l, acceleration, first + passed)
    over = over or is_over_3d(s, l, systems, blocks, margins)
    s.time[l] = (taken - passed * plan.each) * plan.h
    return over


@compiled
def enter_interval_3d(s: Record, l: int, acceleration: Floats, interval: int) -> bool:
    """Begin an interval of both records; True if it is beyond the history's end."""
    over = enter_interval(s, l, acceleration, interval)
    s.a_g_y[l], s.a_g_y_slope[l] = 0.0, 0.0
    if interval + 1 < s.npts[l]:
        i = s.record_y[l] + interval
        start, end = s.scale[l] * acceleration[i], s.scale[l] * acceleration[i + 1]
        s.a_g_y[l], s.a_g_y_slope[l] = start, (end - start) * s.sampling_rate[l]
    return over


@compiled
def keep_states(blocks: Record, k: int) -> None:
    """Make the states after k steps of both blocks the present ones."""
    keep_state(blocks[0], k)
    keep_state(blocks[1], k)


@compiled
def book_blocks(blocks: Record, systems: Pair, which: int, h: float) -> None:
    """What ground and dampers do in each step of both blocks."""
    if which == SHORT_STEP:
        fill_work(blocks[0], systems[0], SHORT_STEP, h)
        fill_work(blocks[1], systems[1], SHORT_STEP, h)
    book_energy_of_block(blocks[0], systems[0], which)
    book_energy_of_block(blocks[1], systems[1], which)


@compiled
def leave_contact_3d(
    s: Record, l: int, systems: Pair, blocks: Record, output: Output, at: int, h: float
) -> None:
    """Leave full contact a time h into the step after `at` others of the blocks [h s]."""
    for axis in range(2):
        block = blocks[axis]
        block.a_g[0], block.a_g_slope[0] = block.a_g[at], block.a_g_slope[at]
        block.g_up[0], block.g_up_slope[0] = block.g_up[at], block.g_up_slope[at]
        block.a_g[1] = block.a_g[0] + h * block.a_g_slope[0]
        block.g_up[1] = block.g_up[0] + h * block.g_up_slope[0]
    follow_blocks(blocks, systems, SHORT_STEP, h)
    observe_blocks(s, l, systems, blocks, h, 1)
    if output.samples.shape[0] > 0:
        book_blocks(blocks, systems, SHORT_STEP, h)
        s.energy_input[l] += blocks[0].input[0] + blocks[1].input[0]
        s.energy_damped[l] += blocks[0].damped[0] + blocks[1].damped[0]
        if output.finer > 1:
            store_at_rest_3d(s, l, systems, blocks, output, 0, s.time[l], h)
    keep_states(blocks, 1)
    s.time[l] += h
    modes_between(s, l, blocks, 1)
    uplift_3d(s, l, systems[0], output.log)


@compiled
def follow_blocks(blocks: Record, systems: Pair, which: int, h: float) -> None:
    """Follow the modes of both directions through their blocks."""
    if which == SHORT_STEP:
        fill_map(blocks[0], systems[0], SHORT_STEP, h)
        fill_map(blocks[1], systems[1], SHORT_STEP, h)
    follow_modes(blocks[0], systems[0], which)
    follow_modes(blocks[1], systems[1], which)


@kernel
def follow_full_contact_3d(
    s: Record, l: int, systems: Pair, blocks: Record, acceleration: Floats, output: Output
) -> int:
    """Follow a lane in full contact: GOES_ON when it begins to tilt, or IS_OVER."""
    if s.history[l] == NO_HISTORY:
        return IS_OVER
    margins = margin_of(s, l, systems[0]), margin_of(s, l, systems[1])
    set_below(s, l, systems)
    modes_between(s, l, blocks, 0)
    for axis in range(2):
        system = systems[0]
        if axis == 1:
            system = systems[1]
        fill_map(blocks[axis], system, WHOLE_STEP, s.contact_step[l])
        if output.samples.shape[0] > 0:
            fill_work(blocks[axis], system, WHOLE_STEP, s.contact_step[l])
    uplifts, over, fine = False, False, False
    while not uplifts and not over and s.stop == 0:
        plan = plan_block(s, l, systems[0], blocks[0], FINE if fine else 1)
        for axis in range(2):
            record = s.record[l] if axis == 0 else s.record_y[l]
            set_ground_of_block(
                s, l, blocks[axis], acceleration, plan.h, plan.each, plan.steps, record
            )
        follow_blocks(blocks, systems, plan.which, plan.h)
        taken, fraction, fine = search_blocks(blocks, margins, plan, 0.0 if fine else NEAR)
        observe_blocks(s, l, systems, blocks, plan.h, taken)
        if not math.isfinite(blocks[0].ddV[taken] + blocks[1].ddV[taken]):
            s.outcome[l] = FAILED_NOT_FINITE
            over = True
            break
        uplifts = fraction <= 1.0
        over = accept_blocks(s, l, systems, blocks, acceleration, output, plan, taken, margins)
        if uplifts:
            guess = fraction * plan.h
            h = locate_uplift_3d(blocks, systems, margins, plan.h, taken, guess)
            leave_contact_3d(s, l, systems, blocks, output, taken, h)
    if over:
        modes_between(s, l, blocks, 1)
    else:
        plan_step(s, l)
    return IS_OVER if over else GOES_ON


@compiled
def is_over_3d(s: Record, l: int, systems: Pair, blocks: Record, margins: Margins) -> bool:
    """Whether no later moment of the free vibration in full contact can bring a new maximum."""
    free = s.interval[l] + 1 - s.npts[l]
    if systems[0].until_rest == 0 or free <= 0 or free % REST_EVERY != 0:
        return False
    largest = 0.0
    for axis in range(2):
        block, system = blocks[axis], systems[0]
        if axis == 1:
            system = systems[1]
        push = 0.0
        for r in range(system.n):
            force = system.omega[r] + system.two_xi_omega[r]
            push += abs(system.Gamma[r]) * force * modal_speed(system, block, r)
        largest += push * push
    limit = s.gravity[l] * margins[0].right + margins[0].held_right
    if s.storeys > 0 and not margins[0].shear_share * math.sqrt(largest) < limit:
        return False
    return demands_stand_3d(s, l, systems, blocks)


@compiled
def demands_stand_3d(s: Record, l: int, systems: Pair, blocks: Record) -> bool:
    """Whether free vibration in full contact can raise no storey shear and no acceleration."""
    for i in range(s.storeys):
        shears, accelerations = 0.0, 0.0
        for axis in range(2):
            block, system = blocks[axis], systems[0]
            most, fastest = s.storey_shear_x[l, i], s.floor_acceleration_x[l, i]
            if axis == 1:
                system = systems[1]
                most, fastest = s.storey_shear_y[l, i], s.floor_acceleration_y[l, i]
            shear, acceleration = 0.0, 0.0
            for r in range(system.n):
                speed, omega = modal_speed(system, block, r), system.omega[r]
                shear += abs(system.storey_shear_of[r, i]) * speed / omega
                acceleration += abs(system.phi[r, i]) * (omega + system.two_xi_omega[r]) * speed
            if shear > most or acceleration > fastest:
                return False
            shears += shear * shear
            accelerations += acceleration * acceleration
        if shears > s.storey_shear[l, i] ** 2 or accelerations > s.floor_acceleration[l, i] ** 2:
            return False
    return True
