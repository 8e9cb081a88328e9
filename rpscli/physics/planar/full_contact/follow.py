"""A lane in full contact: over the record's intervals until it uplifts or the history ends."""

from __future__ import annotations

import math
from typing import NamedTuple

from rpscli.physics.core.compile import by_record, compiled, kernel
from rpscli.physics.core.lanes import (
    along,
    directions,
    enter_interval,
    record_along,
    set_ground_of_block,
)
from rpscli.physics.core.records import INSTANTS, NO_HISTORY, Floats, Record
from rpscli.physics.planar.demands import set_below_all_maxima
from rpscli.physics.planar.devices.rest import (
    begin_excursion,
    pull_at_rest,
    slide,
    write_push_at_rest,
)
from rpscli.physics.planar.full_contact.demands import (
    contacts_may_rise,
    may_raise,
    observe_contacts,
    raise_floors_of_block,
)
from rpscli.physics.planar.full_contact.modal_block import (
    book_energy_of_block,
    fill_map,
    fill_work,
    follow_modes,
    keep_state,
)
from rpscli.physics.planar.full_contact.uplift_search import (
    Margin,
    first_uplift,
    locate_uplift,
    margin_of,
    raise_alarms,
)
from rpscli.physics.planar.run import Output
from rpscli.physics.planar.samples import store_at_rest, store_sample
from rpscli.physics.planar.state import (
    FAILED_NOT_FINITE,
    GOES_ON,
    IS_OVER,
    SHORT_STEP,
    STUCK,
    WHOLE_STEP,
)
from rpscli.physics.planar.steps import plan_steps
from rpscli.physics.planar.transitions import uplift


@compiled
def modes_to_block(s: Record, l: int, block: Record) -> None:
    """Begin full contact with the modes as they are."""
    for axis in range(directions(s)):
        to = along(s, block, axis)
        for r in range(to.n):
            to.q[r], to.dq[r] = s.q[axis * to.n + r, l], s.dq[0, axis * to.n + r, l]


@compiled
def modes_from_block(s: Record, l: int, block: Record) -> None:
    """Take the modes over from full contact; the tilt rests."""
    for axis in range(directions(s)):
        of = along(s, block, axis)
        for r in range(of.n):
            s.q[axis * of.n + r, l], s.dq[0, axis * of.n + r, l] = of.q[r], of.dq[r]


class Plan(NamedTuple):
    """Steps to take at once."""

    steps: int  # how many
    h: float  # length of each [s]
    each: int  # how many lead to a sample
    which: int  # where their map stands: WHOLE_STEP, which is known, or SHORT_STEP


FINE = 4
"""A step in which the margin comes near zero is taken again in so many: their interpolating quintic
is 4^6 times as good."""

NEAR = 1e-3
"""What is near, over the limit: some forty times the largest error of the quintic of a step."""


@compiled
def plan_block(s: Record, l: int, system: Record, block: Record, finer: int) -> Plan:
    """The next steps of a lane: even parts of the intervals, or of what is left of one.

    A finer look, with steps divided by `finer`, goes no farther than the next sample.

    They end where the ground acceleration may jump, the history ends, or is looked at to see
    whether anything can still happen.
    """
    time, step, i = s.time[l], s.contact_step[l], s.interval[l]
    if finer > 1 or time > 0.0:
        left = max(s.dt[l] - time, 0.0)
        each = int(max(math.ceil(finer * left / step - 1e-9), 1))
        for axis in range(directions(s)):
            fill_map(along(s, block, axis), along(s, system, axis), SHORT_STEP, left / each)
        return Plan(min(each, INSTANTS - 1), left / each, each, SHORT_STEP)
    each = int(s.contact_steps[l])
    free = i + 1 - s.npts[l]
    ahead = min(s.intervals[l] - i, REST_EVERY - free % REST_EVERY) if free >= 0 else -free
    most = max((INSTANTS - 1) // each, 1)
    return Plan(min(each * min(ahead, most), INSTANTS - 1), step, each, WHOLE_STEP)


@compiled
def accept_block(
    s: Record,
    l: int,
    system: Record,
    block: Record,
    acceleration: Floats,
    output: Output,
    plan: Plan,
    taken: int,
    margin: Margin,
) -> bool:
    """Make the state after some steps of the block that of the lane; True if its history ends."""
    first, time = s.interval[l], s.time[l]
    passed = taken // plan.each
    if output.samples.shape[0] > 0:
        book_blocks(s, system, block, plan.which, plan.h)
        for k in range(1, taken + 1):
            book_step(s, l, block, k - 1)
            done = (k - 1) // plan.each
            s.interval[l] = first + done
            if output.finer > 1:
                begin = (k - 1 - done * plan.each) * plan.h + (time if done == 0 else 0.0)
                store_at_rest(s, l, system, block, output, k - 1, begin, plan.h)
            s.interval[l] = first + k // plan.each
            if k % plan.each == 0:
                keep_blocks(s, block, k)
                modes_from_block(s, l, block)
                x = along(s, block, 0)
                s.next_V[l], s.next_a_g[l], s.next_g_up[l] = x.V[k], x.a_g[k], x.g_up[k]
                store_sample(s, l, system, output)
    keep_blocks(s, block, taken)
    if passed == 0:
        s.time[l] = time + taken * plan.h
        return False
    over = enter_interval(s, l, acceleration, first + passed) or is_over(
        s, l, system, block, margin
    )
    s.time[l] = (taken - passed * plan.each) * plan.h
    return over


@compiled
def keep_blocks(s: Record, block: Record, k: int) -> None:
    """Make the state after k steps the present one."""
    for axis in range(directions(s)):
        keep_state(along(s, block, axis), k)


@compiled
def book_blocks(s: Record, system: Record, block: Record, which: int, h: float) -> None:
    """What ground and dampers do in each step."""
    for axis in range(directions(s)):
        if which == SHORT_STEP:
            fill_work(along(s, block, axis), along(s, system, axis), SHORT_STEP, h)
        book_energy_of_block(along(s, block, axis), along(s, system, axis), which)


@compiled
def book_step(s: Record, l: int, block: Record, k: int) -> None:
    """Add what they do in one step."""
    for axis in range(directions(s)):
        s.energy_input[l] += along(s, block, axis).input[k]
        s.energy_damped[l] += along(s, block, axis).damped[k]


@compiled
def leave_contact(
    s: Record,
    l: int,
    system: Record,
    block: Record,
    output: Output,
    pull: float,
    at: int,
    h: float,
    side: float,
) -> None:
    """Leave full contact a time h into the step after `at` others of the block [h s]."""
    for axis in range(directions(s)):
        of, each = along(s, block, axis), along(s, system, axis)
        set_ground_of_part(of, at, h)
        fill_map(of, each, SHORT_STEP, h)
        follow_modes(of, each, SHORT_STEP)
    if h > 0.0:  # columns that lift off at the instant at which they came down have not stood
        observe_block(s, l, system, block, pull, h, 1)
    if output.samples.shape[0] > 0:
        book_blocks(s, system, block, SHORT_STEP, h)
        book_step(s, l, block, 0)
        if output.finer > 1:
            store_at_rest(s, l, system, block, output, 0, s.time[l], h)
    keep_blocks(s, block, 1)
    s.time[l] += h
    modes_from_block(s, l, block)
    begin_motion(s, l, system, output.log, side)


@compiled
def set_ground_of_part(block: Record, at: int, h: float) -> None:
    """Begin a block with the ground's motion in the first part of the step after `at` others."""
    block.a_g[0], block.a_g_slope[0] = block.a_g[at], block.a_g_slope[at]
    block.g_up[0], block.g_up_slope[0] = block.g_up[at], block.g_up_slope[at]
    block.a_g[1] = block.a_g[0] + h * block.a_g_slope[0]
    block.g_up[1] = block.g_up[0] + h * block.g_up_slope[0]


@by_record
def begin_motion(s: Record, l: int, system: Record, log: Record, side: float) -> None:
    """Uplift, or slide where friction has held the storey."""
    if s.phase[l] == STUCK:
        slide(s, l, log, side)
    else:
        uplift(s, l, system, log, side)
        begin_excursion(s, l, log)


@by_record
def observe_block(
    s: Record, l: int, system: Record, block: Record, pull: float, h: float, steps: int
) -> None:
    """Raise the demands of a lane by those of the first steps of the block, of length h [s]."""
    if may_raise(s, l, block, h, steps):
        shears, accelerations = s.storey_shear[l], s.floor_acceleration[l]
        raise_floors_of_block(block, system, shears, accelerations, h, steps)
        set_below_all_maxima(s, l, system)
    write_push_at_rest(s, l, block, h, steps)
    if s.devices[l] > 0 or contacts_may_rise(s, l, block, pull, h, steps):
        observe_contacts(s, l, block, system, pull, h, steps)


@compiled
def search_block(
    s: Record, block: Record, margin: Margin, plan: Plan, least: float
) -> tuple[int, float, float, bool]:
    """Steps that end before uplift, the fraction of the next, the side, and whether uplift comes.

    With `least` 0 uplift is located; else the steps end before the first with less of the limit
    left than this share, and the side is zero.
    """
    if not raise_alarms(s, block, margin, plan.h, least):
        return plan.steps, 0.0, 0.0, False
    for taken in range(plan.steps):
        if along(s, block, 0).alarm[taken] > 0.0:
            if least > 0.0:
                return taken, 0.0, 0.0, True
            fraction, side = first_uplift(s, block, margin, plan.h, taken)
            if side != 0.0:
                return taken, fraction, side, True
    return plan.steps, 0.0, 0.0, False


@kernel
def follow_full_contact(
    s: Record, l: int, system: Record, block: Record, acceleration: Floats, output: Output
) -> int:
    """Follow a lane in full contact, or stuck: GOES_ON when it begins to move, or IS_OVER."""
    return follow_at_rest(s, l, system, block, acceleration, output)


@compiled
def follow_at_rest(
    s: Record, l: int, system: Record, block: Record, acceleration: Floats, output: Output
) -> int:
    """The same, of either kernel."""
    if s.history[l] == NO_HISTORY:
        return IS_OVER
    margin = margin_of(s, l, system)
    pull = pull_at_rest(s, l)
    set_below_all_maxima(s, l, system)
    modes_to_block(s, l, block)
    for axis in range(directions(s)):
        fill_map(along(s, block, axis), along(s, system, axis), WHOLE_STEP, s.contact_step[l])
        if output.samples.shape[0] > 0:
            fill_work(along(s, block, axis), along(s, system, axis), WHOLE_STEP, s.contact_step[l])
    clear_push(along(s, block, 0))
    side, over, fine = 0.0, False, False
    while side == 0.0 and not over and s.stop == 0:
        plan = plan_block(s, l, system, block, FINE if fine else 1)
        for axis in range(directions(s)):
            of, record = along(s, block, axis), record_along(s, l, axis)
            set_ground_of_block(s, l, of, acceleration, plan.h, plan.each, plan.steps, record)
            follow_modes(of, along(s, system, axis), plan.which)
        taken, fraction, side, alarm = search_block(s, block, margin, plan, 0.0 if fine else NEAR)
        observe_block(s, l, system, block, pull, plan.h, taken)
        if not is_finite(s, block, taken):
            s.outcome[l] = FAILED_NOT_FINITE
            over = True
            break
        fine = alarm
        over = accept_block(s, l, system, block, acceleration, output, plan, taken, margin)
        if side != 0.0:
            guess = fraction * plan.h
            h = locate_uplift(s, block, system, margin, plan.h, taken, guess, side)
            leave_contact(s, l, system, block, output, pull, taken, h, side)
    if over:
        modes_from_block(s, l, block)
    else:
        plan_steps(s, l)
    return IS_OVER if over else GOES_ON


@compiled
def clear_push(block: Record) -> None:
    """Devices do not push yet."""
    for k in range(INSTANTS):
        block.push[k], block.push_within[k] = 0.0, 0.0


@compiled
def is_finite(s: Record, block: Record, k: int) -> bool:
    """Whether the state after k steps is made of numbers."""
    total = 0.0
    for axis in range(directions(s)):
        total += along(s, block, axis).ddV[k]
    return math.isfinite(total)


# When the free vibration after the record can be left off.

REST_EVERY = 8
"""After the record, so many samples pass between looks at whether anything can still happen."""


@compiled
def is_over(s: Record, l: int, system: Record, block: Record, margin: Margin) -> bool:
    """Whether no later moment of the free vibration in full contact can bring a new maximum.

    Each mode decays from its present energy, which bounds every demand and the push that could
    uplift the storey again. While uplifted a history is never over: impacts excite the building
    until the storey is down.
    """
    free = s.interval[l] + 1 - s.npts[l]
    if along(s, system, 0).until_rest == 0 or free <= 0 or free % REST_EVERY != 0:
        return False
    return stays_down(s, system, block, margin) and demands_stand(s, l, system, block)


@compiled
def modal_speed(system: Record, block: Record, r: int) -> float:
    """sqrt(2 E_r): mode r never moves faster than this, nor farther than this over w."""
    return math.sqrt(block.dq[r] ** 2 + (system.omega[r] * block.q[r]) ** 2)


@compiled
def largest_shear(system: Record, block: Record) -> float:
    """The base shear never passes this in free vibration [N]."""
    largest = 0.0
    for r in range(system.n):
        force = system.omega[r] + system.two_xi_omega[r]
        largest += abs(system.Gamma[r]) * force * modal_speed(system, block, r)
    return largest


@by_record
def stays_down(_s: Record, system: Record, block: Record, margin: Margin) -> bool:
    """Whether the freely vibrating building can never again push hard enough to uplift."""
    limit = min(
        system.gravity * margin.right + margin.held_right,
        system.gravity * margin.left + margin.held_left,
    )
    return system.n == 0 or bool(margin.shear_share * largest_shear(system, block) < limit)


@compiled
def largest_at(system: Record, block: Record, i: int) -> tuple[float, float]:
    """Shear of a storey and acceleration of its floor that free vibration never passes."""
    shear, acceleration = 0.0, 0.0
    for r in range(system.n):
        speed, omega = modal_speed(system, block, r), system.omega[r]
        shear += abs(system.storey_shear_of[r, i]) * speed / omega
        acceleration += abs(system.phi[r, i]) * (omega + system.two_xi_omega[r]) * speed
    return shear, acceleration


@by_record
def demands_stand(s: Record, l: int, system: Record, block: Record) -> bool:
    """Whether free vibration in full contact can raise no storey shear and no acceleration."""
    for i in range(system.n):
        shear, acceleration = largest_at(system, block, i)
        if shear > s.storey_shear[l, i] or acceleration > s.floor_acceleration[l, i]:
            return False
    return True
