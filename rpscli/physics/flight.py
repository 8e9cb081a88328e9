"""What a lane does after each uplifted step: go on, locate an event, or switch.

A step is taken as if its phase of motion went on for ever. If the tilt then leaves the range of
the phase, the step is taken again up to the passage: first to the root of the interpolating
quintic, then corrected by Newton's method. The other lanes meanwhile go on with steps of their own.
"""

from __future__ import annotations

import math

from rpscli.physics.events import NO_PASSAGE, first_descent, offset
from rpscli.physics.inspection import tilt_path
from rpscli.physics.jit import kernel, merged, part
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
    MOTION,
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
    SCALARS,
    SIDE,
    STALE,
    STALLED,
    STEP,
    STEPS,
    TAKEN,
    TAKEN_FIRST,
    TAKEN_MEAN,
    TIME,
    VELOCITY,
)
from rpscli.physics.parameters import Floats, Lanes, Podium, Shape
from rpscli.physics.peak import watch_peak
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
from rpscli.physics.table import podium_of

RESTEPS = 4
"""At most so many re-steps locate an event; two suffice but for grazing."""

STALL = 100
"""So many events in a row without time passing: the step cannot be made small enough."""


@merged
def set_step(b: Floats, shape: Shape, l: int, h: float) -> None:
    """Set the length of the next step of a lane [s]."""
    n, L = len(shape.floors), len(shape.stride)
    b[STEP * L + l] = h
    for c in range(n + 1):
        b[(SCALARS + STEPS * (n + 1) + c) * L + l] = h


@kernel
def plan_step(b: Floats, shape: Shape, l: int) -> None:
    """Length of the next steps: even parts of what is left of the interval.

    Nothing may be left after an event on the very sample; a step of length 0 then leads over.
    """
    L = len(shape.stride)
    left = b[INTERVAL_LENGTH * L + l] - b[TIME * L + l]
    steps = max(math.ceil(left / b[FLIGHT_STEP * L + l] - 1e-9), 1)
    set_step(b, shape, l, max(left, 0.0) / steps)
    b[LEFT * L + l] = steps
    b[LOCATING * L + l] = 0.0


@kernel
def book_energy(b: Floats, shape: Shape, l: int) -> None:
    """Book the energy of the step that was taken over, if it is audited."""
    L = len(shape.stride)
    if len(shape.audit) > 0:
        b[INPUT * L + l] += b[STEP * L + l] * b[GIVEN_MEAN * L + l]
        b[DAMPED * L + l] += b[STEP * L + l] * b[TAKEN_MEAN * L + l]
        b[GIVEN_FIRST * L + l], b[TAKEN_FIRST * L + l] = b[GIVEN * L + l], b[TAKEN * L + l]


@part
def aim(lanes: Lanes, shape: Shape, l: int, podium: Podium) -> bool:
    """Find the first event within the step just taken, and plan the re-step that leads there.

    False if the step is not finite. If the quintic turns out to stay in range, the alarm was
    false: the same step is taken once more and then passes.
    """
    n, L = len(shape.floors), len(shape.stride)
    b, whole = lanes.buffer, lanes.integers
    path = tilt_path(b, n, L, l)
    if not math.isfinite(path[1] + path[3] + path[5]):
        return False
    first, level, kind = NO_PASSAGE, 0.0, NOTHING
    low, high = b[LOW * L + l], b[HIGH * L + l]
    t = first_descent(offset(path, 1.0, low), lanes.piece)
    if t < first:
        first, level, kind = t, low, event_below(podium, whole[l, MOTION])
    t = first_descent(offset(path, -1.0, high), lanes.piece)
    if t < first:
        first, level, kind = t, high, event_above(podium, whole[l, MOTION])
    if kind == NOTHING:
        b[LOCATING * L + l] = -1.0
        return True
    whole[l, EVENT] = kind
    b[LEVEL * L + l], b[LONGEST * L + l] = level, b[STEP * L + l]
    set_step(b, shape, l, first * b[STEP * L + l])
    b[LOCATING * L + l] = 1.0
    return True


@part
def correct(b: Floats, shape: Shape, l: int) -> bool:
    """Whether the re-step ends on the event; if not, correct its length."""
    n, L = len(shape.floors), len(shape.stride)
    miss = b[(SCALARS + AHEAD * (n + 1)) * L + l] - b[LEVEL * L + l]
    rate = b[(SCALARS + AHEAD_RATE * (n + 1)) * L + l]
    change = -miss / rate if rate != 0.0 else math.inf
    longest = b[LONGEST * L + l]
    length = b[STEP * L + l] + change
    if abs(miss) < 1e-15 or abs(change) < 1e-15 * longest or not 0.0 <= length <= longest:
        return True
    if b[LOCATING * L + l] >= RESTEPS:
        return True
    set_step(b, shape, l, length)
    b[LOCATING * L + l] += 1.0
    return False


@part
def arrive(lanes: Lanes, shape: Shape, l: int, podium: Podium) -> None:
    """Take over the step that ends on an event, and switch."""
    n, L = len(shape.floors), len(shape.stride)
    b, whole = lanes.buffer, lanes.integers
    b[(SCALARS + AHEAD * (n + 1)) * L + l] = b[LEVEL * L + l]
    watch_peak(lanes, shape, l)
    for state, ahead in (
        (POSITION, AHEAD),
        (VELOCITY, AHEAD_RATE),
        (ACCELERATION, AHEAD_ACCELERATION),
    ):
        for c in range(n + 1):
            end = b[(SCALARS + ahead * (n + 1) + c) * L + l]
            b[(SCALARS + state * (n + 1) + c) * L + l] = end
    before = b[TIME * L + l]
    b[TIME * L + l] += b[STEP * L + l]
    whole[l, STALLED] = whole[l, STALLED] + 1 if b[TIME * L + l] == before else 0
    book_energy(b, shape, l)
    kind = whole[l, EVENT]
    if kind == IMPACT:
        land(lanes, n, L, l, podium)
        return
    rotation = b[SIDE * L + l] * b[(SCALARS + POSITION * (n + 1)) * L + l]
    rate = b[SIDE * L + l] * b[(SCALARS + VELOCITY * (n + 1)) * L + l]
    note(lanes, l, now(lanes, L, l), kind, rotation, rate, rate, 0.0)
    if kind == OVERTURNING:
        rolls = podium.theta_cr < podium.beta
        whole[l, OUTCOME] = OVERTURNED_ROLLING if rolls else OVERTURNED_ROCKING
        return
    enter_phase(lanes, L, l, podium, ROCKING if kind == ROLLING_TO_ROCKING else ROLLING)
    b[STALE * L + l] = MOVED_ON


@part
def too_many(lanes: Lanes, l: int, podium: Podium) -> bool:
    """Whether events pile up; sets the outcome."""
    whole, events = lanes.integers, 0
    for i in range(EVENT_KINDS):
        events += whole[l, COUNTS + i]
    if events > podium.max_events:
        whole[l, OUTCOME] = FAILED_TOO_MANY_EVENTS
        return True
    if whole[l, STALLED] > STALL:
        whole[l, OUTCOME] = FAILED_STEP_TOO_SMALL
        return True
    return False


@part
def go_on(lanes: Lanes, shape: Shape, l: int) -> bool:
    """Enter the record's next interval; False if the history of the lane is over."""
    L = len(shape.stride)
    b, whole = lanes.buffer, lanes.integers
    over = enter_interval(lanes, shape, l, whole[l, INTERVAL] + 1)
    if lanes.samples.shape[0] > 0:
        store_sample(lanes, shape, l)
    if over:
        return False
    if whole[l, INTERVAL] + 1 == whole[l, NPTS]:
        b[STALE * L + l] = MOVED_ON  # the ground acceleration may jump to zero
    b[LEFT * L + l] = b[FLIGHT_STEPS * L + l]
    if b[STEP * L + l] != b[FLIGHT_STEP * L + l]:
        set_step(b, shape, l, b[FLIGHT_STEP * L + l])
    return True


@part
def attend(lanes: Lanes, shape: Shape, l: int) -> bool:
    """Deal with a step that ends at a sample or holds an event; False if the history is over."""
    L = len(shape.stride)
    b, whole = lanes.buffer, lanes.integers
    if b[QUIET * L + l] > 0.0:
        return go_on(lanes, shape, l)
    podium = podium_of(lanes.podium, l)
    if b[LOCATING * L + l] == 0.0:
        if not aim(lanes, shape, l, podium):
            whole[l, OUTCOME] = FAILED_NOT_FINITE
        return bool(whole[l, OUTCOME] < 0)
    if correct(b, shape, l):
        arrive(lanes, shape, l, podium)
        plan_step(b, shape, l)
    return not (whole[l, OUTCOME] >= 0 or too_many(lanes, l, podium))


@part
def settle(lanes: Lanes, shape: Shape, l: int) -> bool:
    """After accelerations were computed anew; False if the history of the lane is over."""
    n, L = len(shape.floors), len(shape.stride)
    b = lanes.buffer
    why = b[STALE * L + l]
    b[STALE * L + l] = FRESH
    if why == LIFTED_OFF:
        # At the threshold theta'' is zero but for rounding, and about to grow.
        row = (SCALARS + ACCELERATION * (n + 1)) * L + l
        b[row] = max(b[row], 0.0)
    elif why == LEANING:
        for i in range(n):
            b[(SCALARS + POSITION * (n + 1) + i + 1) * L + l] = b[BASE * L + l]
        store_sample(lanes, shape, l)
        b[STALE * L + l] = MOVED_ON
    elif why == LANDED and comes_to_rest(lanes, n, L, l):
        to_modes(lanes, L, l)
        if not stand(lanes, shape, l):
            return False
        plan_step(b, shape, l)
    return True
