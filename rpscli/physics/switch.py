"""Going from one phase of motion to the next, with what is lost and logged on the way."""

from __future__ import annotations

import math

from rpscli.physics.energy import building_energy, uplifted_energy
from rpscli.physics.jit import kernel, part
from rpscli.physics.layout import (
    ACCELERATION,
    ARC,
    ARM_COS,
    ARM_SIN,
    COUNTS,
    CREATED,
    CREATING,
    EVENT_KINDS,
    FULL_CONTACT,
    HIGH,
    IMPACT,
    LANDED,
    LIFT_START,
    LIFTED_OFF,
    LOST,
    LOW,
    MOTION,
    OVERTURNING,
    PATH_START,
    POSITION,
    RECONTACT,
    ROCKING,
    ROCKING_TO_ROLLING,
    ROLLING,
    ROLLING_TO_ROCKING,
    SCALARS,
    SIDE,
    STALE,
    START,
    TIME,
    UPLIFT,
    VELOCITY,
)
from rpscli.physics.parameters import Floats, Lanes, Podium
from rpscli.physics.table import podium_of


@kernel
def now(lanes: Lanes, L: int, l: int) -> float:
    """Time since the start of the record [s]."""
    b = lanes.buffer
    return float(b[START * L + l] + b[TIME * L + l])


@kernel
def note(
    lanes: Lanes,
    l: int,
    time: float,
    kind: int,
    rotation: float,
    before: float,
    after: float,
    lost: float,
) -> None:
    """Count an event, and log it if there is room (the caller sees from the counts if not)."""
    whole, log = lanes.integers, lanes.log
    if log.shape[0] > 0:
        row = 0
        for i in range(EVENT_KINDS):
            row += whole[l, COUNTS + i]
        if row < log.shape[0]:
            log[row, 0], log[row, 1], log[row, 2] = time, kind, rotation
            log[row, 3], log[row, 4], log[row, 5] = before, after, lost
    whole[l, COUNTS + kind] += 1


@kernel
def enter_phase(lanes: Lanes, L: int, l: int, podium: Podium, motion: int) -> None:
    """Set the constants of a phase of motion and the range that the tilt has in it."""
    b = lanes.buffer
    phase = podium.rolling if motion == ROLLING else podium.rocking
    b[ARM_COS * L + l], b[ARM_SIN * L + l], b[ARC * L + l] = phase.p, phase.q, phase.c
    b[PATH_START * L + l], b[LIFT_START * L + l] = phase.u0, phase.v0
    if motion == ROLLING:
        b[LOW * L + l], b[HIGH * L + l] = 0.0, min(podium.beta, podium.theta_limit)
    else:
        b[LOW * L + l], b[HIGH * L + l] = podium.beta, podium.theta_limit
    lanes.integers[l, MOTION] = motion


@part
def event_below(podium: Podium, motion: int) -> int:
    """What happens where the tilt falls below the range of its phase."""
    return ROCKING_TO_ROLLING if motion == ROCKING and podium.beta > 0.0 else IMPACT


@part
def event_above(podium: Podium, motion: int) -> int:
    """What happens where the tilt rises above the range of its phase."""
    rolls_on = motion == ROLLING and podium.beta < podium.theta_limit
    return ROLLING_TO_ROCKING if rolls_on else OVERTURNING


@part
def lift_off(lanes: Lanes, L: int, l: int, side: float) -> None:
    """Leave full contact towards `side`; the floors' state is set already."""
    b = lanes.buffer
    podium = podium_of(lanes.podium, l)
    b[SIDE * L + l] = side
    enter_phase(lanes, L, l, podium, ROLLING if podium.beta > 0.0 else ROCKING)
    note(lanes, l, now(lanes, L, l), UPLIFT, 0.0, 0.0, 0.0, 0.0)
    b[STALE * L + l] = LIFTED_OFF


@kernel
def shift_floors(b: Floats, n: int, L: int, l: int, change: float) -> None:
    """Add the same velocity to every floor [m/s]."""
    for i in range(n):
        b[(SCALARS + VELOCITY * (n + 1) + i + 1) * L + l] += change


@part
def go_over(b: Floats, n: int, L: int, l: int, podium: Podium) -> None:
    """Impact: from the edge on one side to the other.

    theta'+ = e theta'-, and floors that move with the cap beam jump by
    -2 R cos(alpha) (1 - e) theta'- (Theory, section 4; paper, Eq. 6). The tilt x = |theta| starts
    again from exactly zero, upwards.
    """
    tilt, rate = (SCALARS + POSITION * (n + 1)) * L + l, (SCALARS + VELOCITY * (n + 1)) * L + l
    before = b[SIDE * L + l] * min(b[rate], 0.0)
    b[tilt] = 0.0
    b[rate] = podium.restitution * abs(before)
    b[SIDE * L + l] = -b[SIDE * L + l]
    if podium.floors_jump > 0.0:
        jump = -2.0 * podium.R * math.cos(podium.alpha) * (1.0 - podium.restitution) * before
        shift_floors(b, n, L, l, jump)


@part
def lock(b: Floats, n: int, L: int, l: int, podium: Podium) -> None:
    """Full contact from now on.

    The floors lose the cap beam's velocity u_b' and keep the relative one; the bounces that are
    left out would have changed it by `podium.bounces` u_b', which is added where asked for.
    """
    rate = (SCALARS + VELOCITY * (n + 1)) * L + l
    base_rate = b[SIDE * L + l] * 2.0 * podium.R * math.cos(podium.alpha) * b[rate]
    shift_floors(b, n, L, l, (podium.bounces - 1.0) * base_rate)
    b[rate] = 0.0


@part
def is_negligible(podium: Podium, rate: float, acceleration: float) -> bool:
    """Whether the excursion that begins with x' = rate at x = 0 is too small to follow.

    Impacts accumulate: each excursion is e^2 times as high as the last. At constant deceleration
    it reaches x'^2/(2 |x''|).
    """
    least = podium.recontact_tolerance * podium.alpha
    return acceleration < 0.0 and rate**2 < 2.0 * abs(acceleration) * least


@part
def land(lanes: Lanes, n: int, L: int, l: int, podium: Podium) -> None:
    """Impact at theta = 0."""
    b = lanes.buffer
    rate = (SCALARS + VELOCITY * (n + 1)) * L + l
    enter_phase(lanes, L, l, podium, ROLLING if podium.beta > 0.0 else ROCKING)
    arriving = b[SIDE * L + l] * b[rate]
    before = uplifted_energy(b, n, L, l)
    go_over(b, n, L, l, podium)
    gone = before - uplifted_energy(b, n, L, l)
    b[LOST * L + l] += gone
    if gone < 0.0:
        b[CREATED * L + l] -= gone
        lanes.integers[l, CREATING] += 1
    note(lanes, l, now(lanes, L, l), IMPACT, 0.0, arriving, b[SIDE * L + l] * b[rate], gone)
    b[STALE * L + l] = LANDED


@part
def comes_to_rest(lanes: Lanes, n: int, L: int, l: int) -> bool:
    """After an impact: lock the storey if the next excursion would be negligible."""
    b = lanes.buffer
    podium = podium_of(lanes.podium, l)
    rate = b[(SCALARS + VELOCITY * (n + 1)) * L + l]
    acceleration = b[(SCALARS + ACCELERATION * (n + 1)) * L + l]
    if not is_negligible(podium, rate, acceleration):
        return False
    before = uplifted_energy(b, n, L, l)
    lock(b, n, L, l, podium)
    gone = before - building_energy(b, n, L, l, 0.0)
    b[LOST * L + l] += gone
    note(lanes, l, now(lanes, L, l), RECONTACT, 0.0, b[SIDE * L + l] * rate, 0.0, gone)
    lanes.integers[l, MOTION] = FULL_CONTACT
    return True
