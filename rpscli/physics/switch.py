"""Going from one phase of motion to the next, with what is lost and logged on the way."""

from __future__ import annotations

import math

from rpscli.physics.energy import building_energy, uplifted_energy
from rpscli.physics.lane import Lane
from rpscli.physics.layout import (
    ACCELERATION,
    ARM_COS,
    COUNTS,
    CREATED,
    CREATING,
    EVENT_KINDS,
    FULL_CONTACT,
    HIGH,
    IMPACT,
    LANDED,
    LIFTED_OFF,
    LOG_ENERGY_LOST,
    LOG_KIND,
    LOG_RATE_AFTER,
    LOG_RATE_BEFORE,
    LOG_ROTATION,
    LOG_TIME,
    LOST,
    LOW,
    MOTION,
    OVERTURNING,
    POSITION,
    RECONTACT,
    ROCKING,
    ROCKING_TO_ROLLING,
    ROLLING,
    ROLLING_TO_ROCKING,
    SIDE,
    STALE,
    START,
    TIME,
    UPLIFT,
    VELOCITY,
)
from rpscli.physics.parameters import Floats
from rpscli.physics.part import part, routine
from rpscli.physics.podium_layout import (
    ALPHA,
    BETA,
    BOUNCES,
    FLOORS_JUMP,
    RECONTACT_TOLERANCE,
    RESTITUTION,
    ROCKING_PHASE,
    ROLLING_PHASE,
    THETA_LIMIT,
    R,
)

PHASE_NUMBERS = 5
"""Numbers of a phase: in the podium's row, and in the lane's from ARM_COS on."""


@part
def now(lane: Lane) -> float:
    """Time since the start of the record [s]."""
    return float(lane.numbers[START] + lane.numbers[TIME])


@routine
def note(
    lane: Lane, time: float, kind: int, rotation: float, before: float, after: float, lost: float
) -> None:
    """Count an event, and log it if there is room (the caller sees from the counts if not)."""
    whole, log = lane.whole, lane.log
    if log.shape[0] > 0:
        row = 0
        for i in range(EVENT_KINDS):
            row += whole[COUNTS + i]
        if row < log.shape[0]:
            log[row, LOG_TIME], log[row, LOG_KIND], log[row, LOG_ROTATION] = time, kind, rotation
            log[row, LOG_RATE_BEFORE], log[row, LOG_RATE_AFTER] = before, after
            log[row, LOG_ENERGY_LOST] = lost
    whole[COUNTS + kind] += 1


@routine
def enter_phase(lane: Lane, motion: int) -> None:
    """Set the constants of a phase of motion and the range that the tilt has in it."""
    s, p = lane.numbers, lane.podium
    lane.whole[MOTION] = motion
    phase = ROLLING_PHASE if motion == ROLLING else ROCKING_PHASE
    for i in range(PHASE_NUMBERS):
        s[ARM_COS + i] = p[phase + i]
    s[LOW], s[HIGH] = p[BETA], p[THETA_LIMIT]
    if motion == ROLLING:
        s[LOW], s[HIGH] = 0.0, min(p[BETA], p[THETA_LIMIT])


@part
def leave_ground(lane: Lane) -> None:
    """Enter the phase in which a tilt grows from zero: rolling, unless the edges are sharp."""
    enter_phase(lane, ROLLING if lane.podium[BETA] > 0.0 else ROCKING)


@part
def event_below(lane: Lane) -> int:
    """What happens where the tilt falls below the range of its phase."""
    rocks = lane.whole[MOTION] == ROCKING and lane.podium[BETA] > 0.0
    return ROCKING_TO_ROLLING if rocks else IMPACT


@part
def event_above(lane: Lane) -> int:
    """What happens where the tilt rises above the range of its phase."""
    rolls_on = lane.whole[MOTION] == ROLLING and lane.podium[BETA] < lane.podium[THETA_LIMIT]
    return ROLLING_TO_ROCKING if rolls_on else OVERTURNING


@part
def lift_off(lane: Lane, side: float) -> None:
    """Leave full contact towards `side`; the floors' state is set already."""
    lane.numbers[SIDE], lane.numbers[STALE] = side, LIFTED_OFF
    leave_ground(lane)
    note(lane, now(lane), UPLIFT, 0.0, 0.0, 0.0, 0.0)


@part
def shift_floors(x: Floats, change: float) -> None:
    """Add the same velocity to every floor [m/s]; `x` are the blocks of the lane."""
    for i in range(1, x.shape[1]):
        x[VELOCITY, i] += change


@part
def go_over(lane: Lane) -> None:
    """Impact: from the edge on one side to the other.

    theta'+ = e theta'-, and floors that move with the cap beam jump by
    -2 R cos(alpha) (1 - e) theta'- (Theory, section 4; paper, Eq. 6). The tilt x = |theta| starts
    again from exactly zero, upwards.
    """
    s, x, p = lane.numbers, lane.blocks, lane.podium
    before = s[SIDE] * min(x[VELOCITY, 0], 0.0)
    x[POSITION, 0] = 0.0
    x[VELOCITY, 0] = p[RESTITUTION] * abs(before)
    s[SIDE] = -s[SIDE]
    if p[FLOORS_JUMP] > 0.0:
        shift_floors(x, -2.0 * p[R] * math.cos(p[ALPHA]) * (1.0 - p[RESTITUTION]) * before)


@part
def lock(lane: Lane) -> None:
    """Full contact from now on.

    The floors lose the cap beam's velocity u_b' and keep the relative one; the bounces that are
    left out would have changed it by BOUNCES u_b', which is added where asked for.
    """
    s, x, p = lane.numbers, lane.blocks, lane.podium
    base_rate = s[SIDE] * 2.0 * p[R] * math.cos(p[ALPHA]) * x[VELOCITY, 0]
    shift_floors(x, (p[BOUNCES] - 1.0) * base_rate)
    x[VELOCITY, 0] = 0.0


@part
def is_negligible(p: Floats, rate: float, acceleration: float) -> bool:
    """Whether the excursion that begins with x' = rate at x = 0 is too small to follow.

    Impacts accumulate: each excursion is e^2 times as high as the last. At constant deceleration
    it reaches x'^2/(2 |x''|). `p` are the numbers of the podium.
    """
    least = p[RECONTACT_TOLERANCE] * p[ALPHA]
    return acceleration < 0.0 and bool(rate**2 < 2.0 * abs(acceleration) * least)


@part
def land(lane: Lane) -> None:
    """Impact at theta = 0."""
    s, x = lane.numbers, lane.blocks
    leave_ground(lane)
    arriving = s[SIDE] * x[VELOCITY, 0]
    before = uplifted_energy(lane)
    go_over(lane)
    gone = before - uplifted_energy(lane)
    s[LOST] += gone
    if gone < 0.0:
        s[CREATED] -= gone
        lane.whole[CREATING] += 1
    note(lane, now(lane), IMPACT, 0.0, arriving, s[SIDE] * x[VELOCITY, 0], gone)
    s[STALE] = LANDED


@part
def comes_to_rest(lane: Lane) -> bool:
    """After an impact: lock the storey if the next excursion would be negligible."""
    s, x = lane.numbers, lane.blocks
    if not is_negligible(lane.podium, x[VELOCITY, 0], x[ACCELERATION, 0]):
        return False
    rate, before = s[SIDE] * x[VELOCITY, 0], uplifted_energy(lane)
    lock(lane)
    gone = before - building_energy(x, 0.0)
    s[LOST] += gone
    note(lane, now(lane), RECONTACT, 0.0, rate, 0.0, gone)
    lane.whole[MOTION] = FULL_CONTACT
    return True
