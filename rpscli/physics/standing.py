"""A lane in full contact: over the record's intervals until it uplifts or the history ends."""

from __future__ import annotations

import math
from typing import NamedTuple

from rpscli.physics import contact_layout
from rpscli.physics.contact import energies, fill_transition, keep, march
from rpscli.physics.contact_layout import (
    ALARM,
    AT,
    COLUMNS,
    GIVEN,
    PART,
    PUSH_BEND,
    SLOPE,
    TAKEN,
    WHOLE,
)
from rpscli.physics.lane import Lane
from rpscli.physics.layout import (
    CONTACT_STEP,
    CONTACT_STEPS,
    DAMPED,
    DQ,
    FAILED_NOT_FINITE,
    FLOOR_ACCELERATION,
    INPUT,
    INTERVAL,
    INTERVAL_LENGTH,
    INTERVALS,
    NPTS,
    OUTCOME,
    PULLED_REACH,
    RATE,
    STOREY_SHEAR,
    STRAIN_REACH,
    TILT,
    TIME,
    Q,
)
from rpscli.physics.parameters import Shape
from rpscli.physics.part import part, routine
from rpscli.physics.progress import REST_EVERY, enter_interval, store_sample
from rpscli.physics.shaking import shake_block
from rpscli.physics.standing_demands import (
    forget,
    hand_over,
    mark_samples,
    may_raise,
    observe_contacts,
    observe_floors,
    set_reach,
)
from rpscli.physics.switch import lift_off
from rpscli.physics.uplift_search import first_uplift, locate_uplift, raise_alarms, stance_of


@part
def to_modes(lane: Lane) -> None:
    """Begin full contact with the modes as they are."""
    x, z = lane.blocks, lane.modes
    for r in range(z.shape[1]):
        z[contact_layout.Q, r], z[contact_layout.DQ, r] = x[Q, r], x[DQ, r]


@part
def from_modes(lane: Lane) -> None:
    """Take the modes over from full contact; the storey does not tilt."""
    s, x, z = lane.numbers, lane.blocks, lane.modes
    s[TILT], s[RATE] = 0.0, 0.0
    for r in range(z.shape[1]):
        x[Q, r], x[DQ, r] = z[contact_layout.Q, r], z[contact_layout.DQ, r]


class Plan(NamedTuple):
    """Steps to take at once: how many, of which length [s]; `each` of them lead to a sample.

    `row` is where their map stands in the modal rows.
    """

    steps: int
    h: float
    each: int
    row: int


FINE = 4
"""A step in which the margin comes near zero is taken again in so many: their interpolating quintic
is 4^6 times as good."""

NEAR = 1e-3
"""What is near, over the limit: some forty times the largest error of the quintic of a step."""


@part
def plan_block(lane: Lane, finer: int) -> Plan:
    """The next steps of a lane: even parts of the intervals, or of what is left of one.

    A finer look, with steps divided by `finer`, goes no farther than the next sample.

    They end where the ground acceleration may jump, the history ends, or is looked at to see
    whether anything can still happen.
    """
    s, whole = lane.numbers, lane.whole
    time, step = s[TIME], s[CONTACT_STEP]
    if finer > 1 or time > 0.0:
        left = max(s[INTERVAL_LENGTH] - time, 0.0)
        each = int(max(math.ceil(finer * left / step - 1e-9), 1))
        fill_transition(lane.modes, left / each, PART)
        return Plan(min(each, COLUMNS - 1), left / each, each, PART)
    each, i = int(s[CONTACT_STEPS]), whole[INTERVAL]
    free = i + 1 - whole[NPTS]
    ahead = min(whole[INTERVALS] - i, REST_EVERY - free % REST_EVERY) if free >= 0 else -free
    most = max((COLUMNS - 1) // each, 1)
    return Plan(min(each * min(ahead, most), COLUMNS - 1), step, each, WHOLE)


@part
def take_steps(lane: Lane, shape: Shape, plan: Plan, taken: int) -> bool:
    """Make the state after some steps of the block that of the lane; True if its history ends."""
    s, whole, z = lane.numbers, lane.whole, lane.modes
    block, c = lane.block, lane.block.rows
    first, time = whole[INTERVAL], s[TIME]
    passed = taken // plan.each
    if len(shape.audit) > 0:
        energies(block, z, plan.h)
    for k in range(1, taken + 1):
        if len(shape.audit) > 0:
            s[INPUT] += c[GIVEN * COLUMNS + k - 1]
            s[DAMPED] += c[TAKEN * COLUMNS + k - 1]
        if lane.samples.shape[0] > 0 and k % plan.each == 0:
            keep(block, z, k)
            from_modes(lane)
            whole[INTERVAL] = first + k // plan.each
            store_sample(lane)
    keep(block, z, taken)
    if passed == 0:
        s[TIME] = time + taken * plan.h
        return False
    over = enter_interval(lane, first + passed)
    s[TIME] = (taken - passed * plan.each) * plan.h
    return over


@part
def uplift(lane: Lane, shape: Shape, at: int, h: float, side: float) -> None:
    """Leave full contact a time h into the step after `at` others of the block."""
    s, z, block, c = lane.numbers, lane.modes, lane.block, lane.block.rows
    c[AT * COLUMNS], c[SLOPE * COLUMNS] = c[AT * COLUMNS + at], c[SLOPE * COLUMNS + at]
    fill_transition(z, h, PART)
    march(block, z, PART)
    if len(shape.audit) > 0:
        energies(block, z, h)
        s[INPUT] += c[GIVEN * COLUMNS]
        s[DAMPED] += c[TAKEN * COLUMNS]
    keep(block, z, 1)
    s[TIME] += h
    from_modes(lane)
    lift_off(lane, side)


@routine
def stand(lane: Lane, shape: Shape) -> bool:
    """Follow a lane in full contact; True if it uplifts, False if its history is over."""
    x, z, block, c = lane.blocks, lane.modes, lane.block, lane.block.rows
    stance = stance_of(lane)
    forget(block)
    side, over, fine = 0.0, False, False
    while side == 0.0 and not over:
        plan = plan_block(lane, FINE if fine else 1)
        shake_block(lane, c, plan.h, plan.each, plan.steps)
        march(block, z, plan.row)
        alarms = raise_alarms(c, stance, plan.h, 0.0 if fine else NEAR)
        taken, fraction, alarm = 0 if alarms else plan.steps, 0.0, False
        while taken < plan.steps and not alarm:
            alarm = c[ALARM * COLUMNS + taken] > 0.0
            if alarm and fine:
                fraction, side = first_uplift(c, stance, plan.h, taken, lane.piece)
                alarm = side != 0.0
            if not alarm:
                taken += 1
        mark_samples(c, plan.each, taken, plan.each)
        if may_raise(c, lane.numbers[STRAIN_REACH], lane.numbers[PULLED_REACH]):
            observe_floors(block, z, x[STOREY_SHEAR], x[FLOOR_ACCELERATION])
            set_reach(lane)
        observe_contacts(c, lane.numbers)
        if not math.isfinite(c[PUSH_BEND * COLUMNS + taken]):
            lane.whole[OUTCOME] = FAILED_NOT_FINITE
            return False
        fine = alarm
        over = take_steps(lane, shape, plan, taken)
        if side != 0.0:
            guess = fraction * plan.h
            h = locate_uplift(c, z, stance, plan.h, taken, guess, side)
            uplift(lane, shape, taken, h, side)
    hand_over(lane)
    return not over
