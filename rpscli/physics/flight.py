"""What a lane does after each uplifted step: go on, locate an event, or switch.

A step is taken as if its phase of motion went on for ever. If the tilt then leaves the range of
the phase, the step is taken again up to the passage: first to the root of the interpolating
quintic, then corrected by Newton's method. The other lanes meanwhile go on with steps of their own.
"""

from __future__ import annotations

import math

from rpscli.physics.events import NO_PASSAGE, first_descent, offset
from rpscli.physics.lane import Lane
from rpscli.physics.layout import (
    ACCELERATION,
    AHEAD,
    AHEAD_ACCELERATION,
    AHEAD_RATE,
    BASE,
    COUNTS,
    DAMPED,
    EVENT,
    EVENT_KINDS,
    FAILED_NOT_FINITE,
    FAILED_STEP_TOO_SMALL,
    FAILED_TOO_MANY_EVENTS,
    FLIGHT_STEP,
    FLIGHT_STEPS,
    FRESH,
    GIVEN,
    GIVEN_FIRST,
    GIVEN_MEAN,
    HIGH,
    IMPACT,
    INPUT,
    INTERVAL,
    INTERVAL_LENGTH,
    LANDED,
    LEANING,
    LEFT,
    LEVEL,
    LIFTED_OFF,
    LOCATING,
    LONGEST,
    LOW,
    MOVED_ON,
    NOTHING,
    NPTS,
    OUTCOME,
    OVERTURNED_ROCKING,
    OVERTURNED_ROLLING,
    OVERTURNING,
    POSITION,
    QUIET,
    ROCKING,
    ROLLING,
    ROLLING_TO_ROCKING,
    SIDE,
    STALE,
    STALLED,
    STEP,
    STEPS,
    TAKEN,
    TAKEN_FIRST,
    TAKEN_MEAN,
    THETA_CR,
    TIME,
    VELOCITY,
)
from rpscli.physics.parameters import Floats, Shape
from rpscli.physics.part import part
from rpscli.physics.peak import tilt_of, watch_peak
from rpscli.physics.podium_layout import BETA, MAX_EVENTS
from rpscli.physics.progress import enter_interval, store_sample
from rpscli.physics.standing import stand, to_modes
from rpscli.physics.switch import (
    comes_to_rest,
    enter_phase,
    event_above,
    event_below,
    land,
    note,
    now,
)

RESTEPS = 4
"""At most so many re-steps locate an event; one suffices but for grazing."""

NEAR = 1e-6
"""A miss by so small a part of a step is made good by the derivatives at its end. The velocities,
of which no more than one is known, are then wrong by (w h NEAR)^2/2, less than 2e-13 of them."""

STALL = 100
"""So many events in a row without time passing: the step cannot be made small enough."""


@part
def set_step(s: Floats, x: Floats, h: float) -> None:
    """Set the length of a lane's next step [s], in its numbers and blocks."""
    s[STEP] = h
    for c in range(x.shape[1]):
        x[STEPS, c] = h


@part
def plan_step(s: Floats, x: Floats) -> None:
    """Length of the next steps: even parts of what is left of the interval.

    Nothing may be left after an event on the very sample; a step of length 0 then leads over.
    """
    left = s[INTERVAL_LENGTH] - s[TIME]
    steps = max(math.ceil(left / s[FLIGHT_STEP] - 1e-9), 1)
    set_step(s, x, max(left, 0.0) / steps)
    s[LEFT], s[LOCATING] = steps, 0.0


@part
def book_energy(s: Floats, shape: Shape) -> None:
    """Book the energy of the step that was taken over, if it is audited."""
    if len(shape.audit) > 0:
        s[INPUT] += s[STEP] * s[GIVEN_MEAN]
        s[DAMPED] += s[STEP] * s[TAKEN_MEAN]
        s[GIVEN_FIRST], s[TAKEN_FIRST] = s[GIVEN], s[TAKEN]


@part
def aim(lane: Lane) -> bool:
    """Find the first event within the step just taken, and plan the re-step that leads there.

    False if the step is not finite. If the quintic turns out to stay in range, the alarm was
    false: the same step is taken once more and then passes.
    """
    s, x = lane.numbers, lane.blocks
    path = tilt_of(s, x)
    if not math.isfinite(path[1] + path[3] + path[5]):
        return False
    first, level, kind = NO_PASSAGE, 0.0, NOTHING
    t = first_descent(offset(path, 1.0, s[LOW]), lane.piece)
    if t < first:
        first, level, kind = t, s[LOW], event_below(lane)
    t = first_descent(offset(path, -1.0, s[HIGH]), lane.piece)
    if t < first:
        first, level, kind = t, s[HIGH], event_above(lane)
    if kind == NOTHING:
        s[LOCATING] = -1.0
        return True
    lane.whole[EVENT] = kind
    s[LEVEL], s[LONGEST], s[LOCATING] = level, s[STEP], 1.0
    set_step(s, x, first * s[STEP])
    return True


@part
def correct(s: Floats, x: Floats, shape: Shape) -> bool:
    """Whether the re-step ends on the event, or so near that it can be moved there.

    If it does not, another is planned.
    """
    miss, rate, longest = x[AHEAD, 0] - s[LEVEL], x[AHEAD_RATE, 0], s[LONGEST]
    change = -miss / rate if rate != 0.0 else math.inf
    length = s[STEP] + change
    if abs(miss) < 1e-15 or abs(change) < 1e-15 * longest or not 0.0 <= length <= longest:
        return True
    if abs(change) < NEAR * s[STEP]:
        move_end(s, x, shape, change)
        return True
    if s[LOCATING] >= RESTEPS:
        return True
    set_step(s, x, length)
    s[LOCATING] += 1.0
    return False


@part
def move_end(s: Floats, x: Floats, shape: Shape, change: float) -> None:
    """Make a step longer by very little [s]."""
    for c in range(x.shape[1]):
        x[AHEAD, c] += change * (x[AHEAD_RATE, c] + 0.5 * change * x[AHEAD_ACCELERATION, c])
        x[AHEAD_RATE, c] += change * x[AHEAD_ACCELERATION, c]
    if len(shape.audit) > 0:
        share = change / s[STEP]
        s[GIVEN_MEAN] += share * (s[GIVEN] - s[GIVEN_MEAN])
        s[TAKEN_MEAN] += share * (s[TAKEN] - s[TAKEN_MEAN])
    s[STEP] += change


@part
def arrive(lane: Lane, shape: Shape) -> None:
    """Take over the step that ends on an event, and switch."""
    s, x, whole = lane.numbers, lane.blocks, lane.whole
    x[AHEAD, 0] = s[LEVEL]
    watch_peak(lane)
    for c in range(x.shape[1]):
        x[POSITION, c], x[VELOCITY, c] = x[AHEAD, c], x[AHEAD_RATE, c]
        x[ACCELERATION, c] = x[AHEAD_ACCELERATION, c]
    before = s[TIME]
    s[TIME] += s[STEP]
    whole[STALLED] = whole[STALLED] + 1 if s[TIME] == before else 0
    book_energy(s, shape)
    kind = whole[EVENT]
    if kind == IMPACT:
        land(lane)
        return
    rotation, rate = s[SIDE] * x[POSITION, 0], s[SIDE] * x[VELOCITY, 0]
    note(lane, now(lane), kind, rotation, rate, rate, 0.0)
    if kind == OVERTURNING:
        rolls = s[THETA_CR] < lane.podium[BETA]
        whole[OUTCOME] = OVERTURNED_ROLLING if rolls else OVERTURNED_ROCKING
        return
    enter_phase(lane, ROCKING if kind == ROLLING_TO_ROCKING else ROLLING)
    s[STALE] = MOVED_ON


@part
def too_many(lane: Lane) -> bool:
    """Whether events pile up; sets the outcome."""
    whole, events = lane.whole, 0
    for i in range(EVENT_KINDS):
        events += whole[COUNTS + i]
    if events > lane.podium[MAX_EVENTS]:
        whole[OUTCOME] = FAILED_TOO_MANY_EVENTS
        return True
    if whole[STALLED] > STALL:
        whole[OUTCOME] = FAILED_STEP_TOO_SMALL
        return True
    return False


@part
def go_on(lane: Lane) -> bool:
    """Enter the record's next interval; False if the history of the lane is over."""
    s, whole = lane.numbers, lane.whole
    over = enter_interval(lane, whole[INTERVAL] + 1)
    if lane.samples.shape[0] > 0:
        store_sample(lane)
    if over:
        return False
    if whole[INTERVAL] + 1 == whole[NPTS]:
        s[STALE] = MOVED_ON  # the ground acceleration may jump to zero
    s[LEFT] = s[FLIGHT_STEPS]
    if s[STEP] != s[FLIGHT_STEP]:
        set_step(s, lane.blocks, s[FLIGHT_STEP])
    return True


@part
def attend(lane: Lane, shape: Shape) -> bool:
    """Deal with a step that ends at a sample or holds an event; False if the history is over."""
    s, whole = lane.numbers, lane.whole
    if s[QUIET] > 0.0:
        return go_on(lane)
    if s[LOCATING] == 0.0:
        if not aim(lane):
            whole[OUTCOME] = FAILED_NOT_FINITE
        return bool(whole[OUTCOME] < 0)
    if correct(s, lane.blocks, shape):
        arrive(lane, shape)
        plan_step(s, lane.blocks)
    return not (whole[OUTCOME] >= 0 or too_many(lane))


@part
def settle(lane: Lane, shape: Shape) -> bool:
    """After accelerations were computed anew; False if the history of the lane is over."""
    s, x = lane.numbers, lane.blocks
    why = s[STALE]
    s[STALE] = FRESH
    if why == LIFTED_OFF:
        # At the threshold theta'' is zero but for rounding, and about to grow.
        x[ACCELERATION, 0] = max(x[ACCELERATION, 0], 0.0)
    elif why == LEANING:
        for c in range(1, x.shape[1]):
            x[POSITION, c] = s[BASE]
        store_sample(lane)
        s[STALE] = MOVED_ON
    elif why == LANDED and comes_to_rest(lane):
        to_modes(lane)
        if not stand(lane, shape):
            return False
        plan_step(s, x)
    return True
