"""Effects of events: how a lane goes on from where it is.

In each the lane is at the event, and the kind of it and which are known.
"""

from __future__ import annotations

import math

from rpscli.physics.bed import first_phase
from rpscli.physics.compile import compiled
from rpscli.physics.devices.acting import has_friction
from rpscli.physics.devices.branches import SLOWING, change_law
from rpscli.physics.friction import grip_at, set_limits, sticks
from rpscli.physics.ground import log_event
from rpscli.physics.lane import place_of, polar, rate_of, tilt_of, ways_of
from rpscli.physics.laws.place import length
from rpscli.physics.state import (
    BEDDED,
    FRICTION,
    OVERTURNED_ROCKING,
    OVERTURNED_ROLLING,
    OVERTURNING,
    ROCKING,
    ROCKING_TO_ROLLING,
    ROLLING,
    ROLLING_RESISTANCE,
    ROLLING_TO_ROCKING,
    SLIDING,
    STICKING,
    STUCK,
    Record,
)
from rpscli.physics.step import renew
from rpscli.physics.storeys import turn_storey
from rpscli.physics.upright import (
    change_rate,
    enter_phase,
    keep_growing,
    pass_on_bed,
    pass_upright,
    set_polar,
    settle,
    uplift,
)


@compiled
def leave_range(s: Record, l: int, systems: Record, log: Record, rises: bool) -> None:
    """A tilt comes to an end of its range: of a bed, of an arc, of standing."""
    system = systems[0]
    phase = s.phase[l]
    if phase == BEDDED or (not rises and s.x_low[l] == system.bed_uplift):
        pass_on_bed(s, l, system, log, phase != BEDDED)
    elif rises and s.x_high[l] == system.theta_limit:
        log_event(s, l, log, OVERTURNING, s.v[l], s.v[l], 0.0)
        rolls = s.theta_cr[l] < system.beta
        s.outcome[l] = OVERTURNED_ROLLING if rolls else OVERTURNED_ROCKING
        return
    elif system.beta > 0.0 and (s.x_high[l] if rises else s.x_low[l]) == system.beta:
        event = ROLLING_TO_ROCKING if rises else ROCKING_TO_ROLLING
        now = polar(s, l, tilt_of(s, l), rate_of(s, l))
        set_polar(s, l, system.beta, now.n, now.t, now.p, now.q)
        log_event(s, l, log, event, now.p, now.p, 0.0)
        enter_phase(s, l, system, ROCKING if rises else ROLLING)
    else:  # curved ends leave their flat part, or come back to it
        enter_phase(s, l, system, phase)
    renew(s, l)


@compiled
def go_upright(s: Record, l: int, systems: Record, log: Record, near: bool) -> None:
    """A tilt passes upright: an impact, or a pass, after which it may be at rest."""
    pass_upright(s, l, systems[0], log, near)
    renew(s, l)
    settle(s, l, systems[0], log, near)


@compiled
def leave_low(s: Record, l: int, systems: Record, log: Record) -> None:
    """A tilt falls out of its range."""
    if is_upright(s, l, systems[0]):
        go_upright(s, l, systems, log, True)
    else:
        leave_range(s, l, systems, log, False)


@compiled
def leave_high(s: Record, l: int, systems: Record, log: Record) -> None:
    """A tilt rises out of its range."""
    leave_range(s, l, systems, log, True)


@compiled
def pass_nearest(s: Record, l: int, systems: Record, log: Record) -> None:
    """A tilt to any side is nearest to upright."""
    go_upright(s, l, systems, log, False)


@compiled
def lose_hold(s: Record, l: int, systems: Record, log: Record) -> None:
    """Let go what was held at rest."""
    if s.phase[l] == STUCK:
        slide(s, l, systems[0], log, s.which[l])
    else:
        uplift(s, l, systems[0], log, s.which[l])


@compiled
def yield_or_end(s: Record, l: int, systems: Record, log: Record) -> None:
    """A storey begins to yield, or no longer does."""
    turn_storey(s, l, systems, s.which[l])
    renew(s, l)


@compiled
def change(s: Record, l: int, systems: Record, log: Record) -> None:
    """A watched value fell below zero: of friction at a standstill, or of a device."""
    system = systems[0]
    if s.which[l] == SLOWING:
        stop_or_turn(s, l, system, log)
        return
    stands_still = change_law(s, l, log, s.which[l])
    renew(s, l)
    if s.x[l] == 0.0 and s.v[l] == 0.0:
        keep_growing(s, l, 1.0)  # a stop without a gap is met as columns are let go
    if stands_still:
        reverse(s, l, system, log)


@compiled
def is_upright(s: Record, l: int, system: Record) -> bool:
    """True if the range of the present phase ends upright."""
    if s.phase[l] == BEDDED or system.compliant > 0:
        return False
    return bool(s.phase[l] == ROLLING or system.beta == 0.0)


@compiled
def reverse(s: Record, l: int, system: Record, log: Record) -> None:
    """At a standstill of the tilt: go on, or be held by friction."""
    if ways_of(s) == 1 and sticks(s, l, log):
        hold(s, l, system)
    else:
        renew(s, l)


@compiled
def hold(s: Record, l: int, system: Record) -> None:
    """Be held where the tilt stands."""
    enter_phase(s, l, system, STUCK)
    s.h_limit[l] = math.inf  # that of a standstill was short
    set_limits(s, l)
    renew(s, l)


@compiled
def stop_or_turn(s: Record, l: int, system: Record, log: Record) -> None:
    """Hold what slides too slowly to any side, or let it go on along what is not held
    (13.25).
    """
    grip = grip_at(s, l, 0)
    if grip.margin >= 0.0:
        set_sliding(s, l, system, 0.0, 0.0, 0.0)
        log_event(s, l, log, STICKING, 0.0, 0.0, 0.0)
        hold(s, l, system)
    else:
        set_sliding(s, l, system, grip.d_n, grip.d_t, 2.0 * s.stop_speed[l])
        renew(s, l)


@compiled
def set_sliding(
    s: Record, l: int, system: Record, d_n: float, d_t: float, speed: float
) -> None:
    """Set the rate of a tilt that hardly slides along a unit vector
    [speed m/s of the beam].

    The first device with friction books the difference.
    """
    x, _, _, _, _ = polar(s, l, tilt_of(s, l), (0.0, 0.0))
    at = place_of(s, l, x)
    rate = speed / (s.diameter[l] * length(at.C * d_n, at.h * d_t) + 1e-300)
    lost = change_rate(s, l, system, rate * d_n, rate * d_t)
    for i in range(s.devices[l]):
        if s.device_kind[i, l] in (FRICTION, ROLLING_RESISTANCE):
            s.device_energy[i, l] += lost
            break


@compiled
def slide(s: Record, l: int, system: Record, log: Record, side: int) -> None:
    """Leave a tilt that friction held, or the end of the bed, to
    the right or to the left.
    """
    if ways_of(s) == 2:
        s.direction[l] = 1.0
        move_again(s, l, log)
        grip = grip_at(s, l, 0)
        set_sliding(s, l, system, grip.d_n, grip.d_t, s.start_speed[l])
        renew(s, l)
        return
    if s.x[l] == 0.0 and system.compliant == 0:
        s.side[l] = float(side)  # upright, a tilt grows to either side
    out = side * s.side[l]
    s.direction[l] = out if has_friction(s, l) else 1.0
    move_again(s, l, log)
    if s.bed_back[l] > 0.0:
        s.bed_back[l] = 0.0
        enter_phase(s, l, system, first_phase(system) if out > 0.0 else BEDDED)
    renew(s, l)
    keep_growing(s, l, out)


@compiled
def move_again(s: Record, l: int, log: Record) -> None:
    """Free what was stuck, in the phase in which it was."""
    log_event(s, l, log, SLIDING, 0.0, 0.0, 0.0)
    phase = ROLLING if s.rolls[l] > 0.0 else ROCKING
    s.phase[l] = BEDDED if s.bed_k[l] > 0.0 else phase
    s.moves[l] = 1.0
