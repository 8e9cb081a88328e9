"""A lane in full contact: over the record's intervals until it uplifts or the history ends."""

from __future__ import annotations

import math
from typing import NamedTuple

from rpscli.physics.contact import (
    Stance,
    energies,
    fill_transition,
    first_uplift,
    keep,
    locate_uplift,
    march,
    raise_alarms,
)
from rpscli.physics.contact_layout import (
    ALARM,
    AT,
    COLUMNS,
    DQ,
    DRAG,
    GIVEN,
    PART,
    PARTICIPATION,
    PUSH_BEND,
    SHAPES,
    SLOPE,
    TAKEN,
    WHOLE,
    Q,
)
from rpscli.physics.jit import kernel, part
from rpscli.physics.layout import (
    CONTACT_STEP,
    CONTACT_STEPS,
    DAMPED,
    FAILED_NOT_FINITE,
    INPUT,
    INTERVAL,
    INTERVAL_LENGTH,
    INTERVALS,
    MASS,
    NPTS,
    OUTCOME,
    POSITION,
    SCALARS,
    TIME,
    VELOCITY,
)
from rpscli.physics.parameters import Lanes, Shape
from rpscli.physics.progress import REST_EVERY, enter_interval, store_sample
from rpscli.physics.shaking import shake_block
from rpscli.physics.standing_demands import (
    forget,
    hand_over,
    mark_samples,
    observe_contacts,
    observe_floors,
)
from rpscli.physics.switch import lift_off
from rpscli.physics.table import podium_of


@part
def stance_of(lanes: Lanes, l: int) -> Stance:
    """What the lane's margin against uplift is made of."""
    z, podium = lanes.modes[l], podium_of(lanes.podium, l)
    own, carried = 1.0 + 2.0 * podium.gamma, 2.0 * podium.gamma * podium.eta
    creep = 0.0
    for r in range(z.shape[1]):
        creep += z[PARTICIPATION, r] * z[PARTICIPATION, r] * z[DRAG, r]
    share = carried / podium.floors_mass if z.shape[1] > 0 else 0.0
    return Stance(own, share, math.tan(podium.alpha) * (own + carried), creep)


@part
def to_modes(lanes: Lanes, L: int, l: int) -> None:
    """Modal state of the floors: Phi^T M u."""
    b, z = lanes.buffer, lanes.modes[l]
    n = z.shape[1]
    for r in range(n):
        q, dq = 0.0, 0.0
        for i in range(n):
            weight = z[SHAPES + r, i] * b[(SCALARS + MASS * (n + 1) + i) * L + l]
            q += weight * b[(SCALARS + POSITION * (n + 1) + i + 1) * L + l]
            dq += weight * b[(SCALARS + VELOCITY * (n + 1) + i + 1) * L + l]
        z[Q, r], z[DQ, r] = q, dq


@kernel
def to_floors(lanes: Lanes, L: int, l: int) -> None:
    """Floors of the modal state: Phi q; the storey does not tilt."""
    b, z = lanes.buffer, lanes.modes[l]
    n = z.shape[1]
    u, du = SCALARS + POSITION * (n + 1), SCALARS + VELOCITY * (n + 1)
    for c in range(n + 1):
        b[(u + c) * L + l], b[(du + c) * L + l] = 0.0, 0.0
    for r in range(n):
        for i in range(n):
            b[(u + i + 1) * L + l] += z[SHAPES + r, i] * z[Q, r]
            b[(du + i + 1) * L + l] += z[SHAPES + r, i] * z[DQ, r]


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
def plan_block(lanes: Lanes, L: int, l: int, finer: int) -> Plan:
    """The next steps of a lane: even parts of the intervals, or of what is left of one.

    A finer look, with steps divided by `finer`, goes no farther than the next sample.

    They end where the ground acceleration may jump, the history ends, or is looked at to see
    whether anything can still happen.
    """
    b, whole = lanes.buffer, lanes.integers
    time, step = b[TIME * L + l], b[CONTACT_STEP * L + l]
    if finer > 1 or time > 0.0:
        left = max(b[INTERVAL_LENGTH * L + l] - time, 0.0)
        each = int(max(math.ceil(finer * left / step - 1e-9), 1))
        fill_transition(lanes.modes[l], left / each, PART)
        return Plan(min(each, COLUMNS - 1), left / each, each, PART)
    each, i = int(b[CONTACT_STEPS * L + l]), whole[l, INTERVAL]
    free = i + 1 - whole[l, NPTS]
    ahead = min(whole[l, INTERVALS] - i, REST_EVERY - free % REST_EVERY) if free >= 0 else -free
    most = max((COLUMNS - 1) // each, 1)
    return Plan(min(each * min(ahead, most), COLUMNS - 1), step, each, WHOLE)


@part
def take_steps(lanes: Lanes, shape: Shape, l: int, plan: Plan, taken: int) -> bool:
    """Make the state after some steps of the block that of the lane; True if its history ends."""
    L = len(shape.stride)
    b, whole, z = lanes.buffer, lanes.integers, lanes.modes[l]
    block, c = lanes.block, lanes.block.rows
    first, time = whole[l, INTERVAL], b[TIME * L + l]
    passed = taken // plan.each
    if len(shape.audit) > 0:
        energies(block, z, plan.h)
    for k in range(1, taken + 1):
        if len(shape.audit) > 0:
            b[INPUT * L + l] += c[GIVEN * COLUMNS + k - 1]
            b[DAMPED * L + l] += c[TAKEN * COLUMNS + k - 1]
        if lanes.samples.shape[0] > 0 and k % plan.each == 0:
            keep(block, z, k)
            to_floors(lanes, L, l)
            whole[l, INTERVAL] = first + k // plan.each
            store_sample(lanes, shape, l)
    keep(block, z, taken)
    if first + passed >= whole[l, NPTS]:
        hand_over(block, b, L, l)  # the end of the free vibration depends on the demands so far
    if passed == 0:
        b[TIME * L + l] = time + taken * plan.h
        return False
    over = enter_interval(lanes, shape, l, first + passed)
    b[TIME * L + l] = (taken - passed * plan.each) * plan.h
    return over


@part
def uplift(lanes: Lanes, shape: Shape, l: int, at: int, h: float, side: float) -> None:
    """Leave full contact a time h into the step after `at` others of the block."""
    L = len(shape.stride)
    b, z, block, c = lanes.buffer, lanes.modes[l], lanes.block, lanes.block.rows
    c[AT * COLUMNS], c[SLOPE * COLUMNS] = c[AT * COLUMNS + at], c[SLOPE * COLUMNS + at]
    fill_transition(z, h, PART)
    march(block, z, PART)
    if len(shape.audit) > 0:
        energies(block, z, h)
        b[INPUT * L + l] += c[GIVEN * COLUMNS]
        b[DAMPED * L + l] += c[TAKEN * COLUMNS]
    keep(block, z, 1)
    b[TIME * L + l] += h
    to_floors(lanes, L, l)
    lift_off(lanes, L, l, side)


@kernel
def stand(lanes: Lanes, shape: Shape, l: int) -> bool:
    """Follow a lane in full contact; True if it uplifts, False if its history is over."""
    L = len(shape.stride)
    z, block, c = lanes.modes[l], lanes.block, lanes.block.rows
    stance = stance_of(lanes, l)
    forget(block)
    side, over, fine = 0.0, False, False
    while side == 0.0 and not over:
        plan = plan_block(lanes, L, l, FINE if fine else 1)
        shake_block(lanes, L, l, c, plan.h, plan.each, plan.steps)
        march(block, z, plan.row)
        raise_alarms(c, stance, plan.h, 0.0 if fine else NEAR)
        taken, fraction, alarm = 0, 0.0, False
        while taken < plan.steps and not alarm:
            alarm = c[ALARM * COLUMNS + taken] > 0.0
            if alarm and fine:
                fraction, side = first_uplift(c, stance, plan.h, taken, lanes.piece)
                alarm = side != 0.0
            if not alarm:
                taken += 1
        mark_samples(c, plan.each, taken, plan.each)
        observe_floors(block, z)
        observe_contacts(c, lanes.buffer, L, l)
        if not math.isfinite(c[PUSH_BEND * COLUMNS + taken]):
            lanes.integers[l, OUTCOME] = FAILED_NOT_FINITE
            return False
        fine = alarm
        over = take_steps(lanes, shape, l, plan, taken)
        if side != 0.0:
            guess = fraction * plan.h
            h = locate_uplift(c, z, stance, plan.h, taken, guess, side)
            uplift(lanes, shape, l, taken, h, side)
    hand_over(block, lanes.buffer, L, l)
    return not over
