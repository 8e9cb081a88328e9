"""What a lane does after each uplifted step: go on, switch at an event, or end.

A step is taken as if its phase of motion went on for ever. If the tilt then leaves the range of
the phase, the step ends where it does: a root of its own polynomial, found from that of the
interpolating quintic by Newton's method. No step is taken again.
"""

from __future__ import annotations

import math

from rpscli.physics.energy import book_energy
from rpscli.physics.events import NEAR, NO_PASSAGE, first_descent, offset
from rpscli.physics.lane import Lane
from rpscli.physics.layout import (
    CLEARED,
    COUNTS,
    DQ,
    EVENT_KINDS,
    FAILED_NOT_FINITE,
    FAILED_STEP_TOO_SMALL,
    FAILED_TOO_MANY_EVENTS,
    FLIGHT_STEP,
    FLIGHT_STEPS,
    FRESH,
    HIGH,
    IMPACT,
    INTERVAL,
    INTERVAL_LENGTH,
    LANDED,
    LEANING,
    LEFT,
    LIFTED_OFF,
    LOW,
    MOVED_ON,
    NEXT_DQ,
    NEXT_Q,
    NEXT_RATE,
    NEXT_TILT,
    NEXT_TURN,
    NOTHING,
    NPTS,
    OUTCOME,
    OVERTURNED_ROCKING,
    OVERTURNED_ROLLING,
    OVERTURNING,
    PEAK,
    QUIET,
    RATE,
    ROCKING,
    ROLLING,
    ROLLING_TO_ROCKING,
    ROUGH,
    SIDE,
    STALE,
    STALLED,
    STEP,
    THETA_CR,
    TILT,
    TIME,
    TURN,
    Q,
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
from rpscli.physics.terms import end_at, meet

STALL = 100
"""So many events in a row without time passing: the step cannot be made small enough."""


@part
def plan_step(s: Floats) -> None:
    """Length of the next steps: even parts of what is left of the interval.

    Nothing may be left after an event on the very sample; a step of length 0 then leads over.
    """
    left = s[INTERVAL_LENGTH] - s[TIME]
    steps = max(math.ceil(left / s[FLIGHT_STEP] - 1e-9), 1)
    s[STEP], s[LEFT] = max(left, 0.0) / steps, steps


@part
def aim(lane: Lane) -> tuple[float, float, int]:
    """Fraction of the step just taken at which its first event happens, and which.

    Returns
    -------
    Fraction, level of the tilt, and kind of the event, or NOTHING: then the alarm was false.
    """
    s = lane.numbers
    path = tilt_of(s)
    first, level, kind = NO_PASSAGE, 0.0, NOTHING
    t = first_descent(offset(path, 1.0, s[LOW]), NEAR, lane.piece)
    if t < first:
        first, level, kind = t, s[LOW], event_below(lane)
    t = first_descent(offset(path, -1.0, s[HIGH]), NEAR, lane.piece)
    if t < first:
        first, level, kind = t, s[HIGH], event_above(lane)
    if kind != NOTHING:
        first = meet(s, level, first)
    return first, level, kind


@part
def arrive(lane: Lane, shape: Shape, fraction: float, level: float, kind: int) -> None:
    """End the step on an event, and switch."""
    s, x, whole = lane.numbers, lane.blocks, lane.whole
    book_energy(lane, shape, fraction)
    end_at(s, x, fraction, level)
    if s[NEXT_TILT] > s[PEAK] or (s[RATE] > 0.0 and s[NEXT_RATE] < 0.0):
        watch_peak(lane)
    s[TILT], s[RATE] = s[NEXT_TILT], s[NEXT_RATE]
    for r in range(x.shape[1]):
        x[Q, r], x[DQ, r] = x[NEXT_Q, r], x[NEXT_DQ, r]
    before = s[TIME]
    s[TIME] += s[STEP]
    whole[STALLED] = whole[STALLED] + 1 if s[TIME] == before else 0
    if kind == IMPACT:
        land(lane)
        return
    rotation, rate = s[SIDE] * s[TILT], s[SIDE] * s[RATE]
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
    s[STEP], s[LEFT] = s[FLIGHT_STEP], s[FLIGHT_STEPS]
    return True


@part
def attend(lane: Lane, shape: Shape) -> bool:
    """Deal with a step that ends at a sample or holds an event; False if the history is over.

    After a false alarm the same step is taken once more, and passes. A step that is too long for
    its series is taken again at half the length, as are those after it up to the next sample.
    """
    s, whole = lane.numbers, lane.whole
    if s[QUIET] > 0.0:
        return go_on(lane)
    if s[ROUGH] > 0.0:
        s[STEP], s[LEFT] = 0.5 * s[STEP], 2.0 * s[LEFT]
        return True
    if not math.isfinite(s[NEXT_TILT] + s[NEXT_RATE] + s[NEXT_TURN]):
        whole[OUTCOME] = FAILED_NOT_FINITE
        return False
    fraction, level, kind = aim(lane)
    if kind == NOTHING:
        s[CLEARED] = 1.0
        return True
    arrive(lane, shape, fraction, level, kind)
    plan_step(s)
    return not (whole[OUTCOME] >= 0 or too_many(lane))


@part
def settle(lane: Lane, shape: Shape) -> bool:
    """After accelerations were computed anew; False if the history of the lane is over."""
    s = lane.numbers
    why = s[STALE]
    s[STALE] = FRESH
    if why == LIFTED_OFF:
        # At the threshold theta'' is zero but for rounding, and about to grow.
        s[TURN] = max(s[TURN], 0.0)
    elif why == LEANING:
        store_sample(lane)
    elif why == LANDED and comes_to_rest(lane):
        to_modes(lane)
        if not stand(lane, shape):
            return False
        plan_step(s)
    return True
