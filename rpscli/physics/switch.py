"""Going from one phase of motion to the next, with what is lost and logged on the way."""

from __future__ import annotations

import math

from rpscli.physics.energy import relative_momentum, tilting_energy
from rpscli.physics.lane import Lane
from rpscli.physics.layout import (
    ARC,
    ARM_COS,
    ARM_SIN,
    COUNTS,
    CREATED,
    CREATING,
    DQ,
    EVENT_KINDS,
    FLOORS_MASS,
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
    PARTICIPATION,
    RATE,
    RECONTACT,
    ROCKING,
    ROCKING_TO_ROLLING,
    ROLLING,
    ROLLING_TO_ROCKING,
    SIDE,
    STALE,
    START,
    TILT,
    TIME,
    TURN,
    UPLIFT,
)
from rpscli.physics.parameters import Floats, Integers
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


@part
def note(
    lane: Lane, time: float, kind: int, rotation: float, before: float, after: float, lost: float
) -> None:
    """Count an event, and log it if there is room (the caller sees from the counts if not)."""
    if lane.log.shape[0] > 0:
        write_down(lane.whole, lane.log, time, kind, rotation, before, after, lost)
    lane.whole[COUNTS + kind] += 1


@routine
def write_down(
    whole: Integers,
    log: Floats,
    time: float,
    kind: int,
    rotation: float,
    before: float,
    after: float,
    lost: float,
) -> None:
    """Write an event to the next row of the log, if there is one."""
    row = 0
    for i in range(EVENT_KINDS):
        row += whole[COUNTS + i]
    if row < log.shape[0]:
        log[row, LOG_TIME], log[row, LOG_KIND], log[row, LOG_ROTATION] = time, kind, rotation
        log[row, LOG_RATE_BEFORE], log[row, LOG_RATE_AFTER] = before, after
        log[row, LOG_ENERGY_LOST] = lost


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
    motion = ROLLING if lane.podium[BETA] > 0.0 else ROCKING
    if lane.whole[MOTION] != motion:
        enter_phase(lane, motion)


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
    for r in range(x.shape[1]):
        x[DQ, r] += x[PARTICIPATION, r] * change


@part
def upright_energy(s: Floats) -> float:
    """Kinetic energy of the tilt at x = 0 [J], where B = p and C = c - q."""
    return tilting_energy(s, s[ARM_COS], s[ARC] - s[ARM_SIN], s[RATE])


@part
def go_over(lane: Lane) -> float:
    """Impact: from the edge on one side to the other; returns the energy lost [J].

    theta'+ = e theta'-, and floors that move with the cap beam jump by
    -2 R cos(alpha) (1 - e) theta'- (Theory, section 4; paper, Eq. 6); those that do not keep their
    own velocity. The tilt x = |theta| starts again from exactly zero, upwards.
    """
    s, x, p = lane.numbers, lane.blocks, lane.podium
    e, reach = p[RESTITUTION], 2.0 * p[R] * math.cos(p[ALPHA])
    rate = s[SIDE] * min(s[RATE], 0.0)
    lost = upright_energy(s)
    jump = -reach * (1.0 - e) * rate
    if p[FLOORS_JUMP] > 0.0:
        momentum = relative_momentum(x) + s[FLOORS_MASS] * (reach * rate + 0.5 * jump)
        lost -= jump * momentum
    else:
        shift_floors(x, -jump)
    s[TILT], s[RATE] = 0.0, e * abs(rate)
    s[SIDE] = -s[SIDE]
    return float(lost - upright_energy(s))


@part
def lock(lane: Lane) -> float:
    """Full contact from now on; returns the energy lost [J].

    The floors lose the cap beam's velocity u_b' and keep the relative one; the bounces that are
    left out would have changed it by BOUNCES u_b', which is added where asked for.
    """
    s, x, p = lane.numbers, lane.blocks, lane.podium
    base_rate, kept = s[SIDE] * 2.0 * p[R] * math.cos(p[ALPHA]) * s[RATE], p[BOUNCES]
    carried = relative_momentum(x) + 0.5 * (1.0 + kept) * s[FLOORS_MASS] * base_rate
    lost = upright_energy(s) + (1.0 - kept) * base_rate * carried
    shift_floors(x, kept * base_rate)
    s[TILT], s[RATE] = 0.0, 0.0
    return float(lost)


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
    s = lane.numbers
    leave_ground(lane)
    arriving = s[SIDE] * s[RATE]
    gone = go_over(lane)
    s[LOST] += gone
    if gone < 0.0:
        s[CREATED] -= gone
        lane.whole[CREATING] += 1
    note(lane, now(lane), IMPACT, 0.0, arriving, s[SIDE] * s[RATE], gone)
    s[STALE] = LANDED


@part
def comes_to_rest(lane: Lane) -> bool:
    """After an impact: lock the storey if the next excursion would be negligible."""
    s = lane.numbers
    if not is_negligible(lane.podium, s[RATE], s[TURN]):
        return False
    rate = s[SIDE] * s[RATE]
    gone = lock(lane)
    s[LOST] += gone
    note(lane, now(lane), RECONTACT, 0.0, rate, 0.0, gone)
    lane.whole[MOTION] = FULL_CONTACT
    return True
