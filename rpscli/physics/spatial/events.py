"""What a lane does after each step: go on, pass near upright, change its phase, or end."""

from __future__ import annotations

import math

from rpscli.physics.core.compile import compiled, kernel
from rpscli.physics.core.quintic import (
    NEAR,
    NO_PASSAGE,
    SETTLED,
    first_descent,
    lower_hull,
    offset,
    peak_in_step,
    slope,
    upper_hull,
    value,
)
from rpscli.physics.core.records import NO_HISTORY, Floats, Record
from rpscli.physics.core.series import slope as slope_of
from rpscli.physics.core.series import value as value_of
from rpscli.physics.planar.equation_of_motion import cap_beam_lift, lifted_mass, rotation_terms
from rpscli.physics.planar.events import too_many_events
from rpscli.physics.planar.full_contact.follow import REST_EVERY
from rpscli.physics.planar.geometry import Phase
from rpscli.physics.planar.run import Output
from rpscli.physics.planar.state import (
    CRITICAL_PASSAGE,
    FAILED_NOT_FINITE,
    FOLLOW_CONTACT,
    GOES_ON,
    IS_OVER,
    NO_EVENT,
    OVERTURNED_ROCKING,
    OVERTURNED_ROLLING,
    OVERTURNING,
    PASS,
    ROCKING,
    ROCKING_TO_ROLLING,
    ROLLING,
    ROLLING_TO_ROCKING,
)
from rpscli.physics.planar.steps import fraction_at, path_of, tilt_at
from rpscli.physics.planar.transitions import event_above
from rpscli.physics.spatial.demands import observe_end_3d, observe_start_3d, raise_contacts_3d
from rpscli.physics.spatial.energy import book_energy_3d, direction_at, uplifted_energy_3d
from rpscli.physics.spatial.equation_of_motion import enter_phase_3d
from rpscli.physics.spatial.full_contact import enter_interval_3d
from rpscli.physics.spatial.passes import log_event_3d, pass_upright, settles
from rpscli.physics.spatial.samples import store_within_3d
from rpscli.physics.spatial.state import Pair
from rpscli.physics.spatial.steps import end_step_at_3d, plan_step, rate_path, take_end

NEAR_PASS = -2
"""Kind of an event: the tilt falls below theta_c, and the map takes over."""

HALVE = -3
"""No event: the step holds too much to be searched, and is halved."""

WOBBLES = 20.0
"""So long after the record a wobbling structure is left, once no larger tilt can come [s]."""


@compiled
def locate_event_3d(s: Record, l: int, system: Record, block: Record) -> tuple[float, float, int]:
    """Fraction of the step just taken at which its first event happens, tilt there, and which."""
    path, piece, rate = path_of(s, l), block.piece, rate_path(s, l)
    first, level, kind = NO_PASSAGE, 0.0, NO_EVENT
    t = first_descent(offset(path, 1.0, s.theta_low[l]), NEAR, piece)
    if t < first:
        returns = s.phase[l] == ROCKING and system.beta > 0.0
        first, level = t, s.theta_low[l]
        kind = ROCKING_TO_ROLLING if returns else NEAR_PASS
    t = first_descent(offset(path, -1.0, s.theta_high[l]), NEAR, piece)
    if t < first:
        first, level, kind = t, s.theta_high[l], event_above(s, l, system)
    if kind != NO_EVENT:
        first = fraction_at(s, l, level, first)
    if rate[0] < 0.0:
        t = first_descent(offset(rate, -1.0, 0.0), NEAR, piece)
        if t <= 1.0:
            t = turning_point(s, l, t)
            if t < first:
                first, level, kind = t, tilt_at(s, l, t), PASS
    elif rate[5] >= 0.0 and lower_hull(rate) < 0.0 and first_descent(rate, NEAR, piece) <= 1.0:
        return 0.5, 0.0, HALVE
    return first, level, kind


@compiled
def turning_point(s: Record, l: int, guess: float) -> float:
    """Fraction of the step at which p is zero, near a guess: Newton's method on its series."""
    t, terms = guess, rotation_terms(s, l)
    for _ in range(8):
        rise = slope_of(terms, t)
        change = -value_of(terms, t) / rise if rise != 0.0 else 2.0
        if not 0.0 <= t + change <= 1.0:
            break
        t += change
        if abs(change) < SETTLED:
            break
    return t


@compiled
def observe_step(s: Record, l: int, systems: Pair, output: Output, fraction: float) -> None:
    """Book the first part of a lane's step, and look at what it demands."""
    if s.audited > 0:
        book_energy_3d(s, l, fraction)
        if output.finer > 1:
            store_within_3d(s, l, systems, output, fraction)
    raise_contacts_3d(s, l, fraction)


@kernel
def resolve_step_3d(s: Record, l: int, systems: Pair, block: Record, output: Output) -> int:
    """Deal with a step that was not accepted: GOES_ON, FOLLOW_CONTACT or IS_OVER."""
    if s.history[l] == NO_HISTORY:
        return IS_OVER
    system = systems[0]
    fraction, level, kind = 0.5, 0.0, HALVE
    if not math.isfinite(s.next_theta[l] + s.next_theta_dot[l] + s.next_turn[l]):
        s.outcome[l] = FAILED_NOT_FINITE
        return IS_OVER
    if s.too_long[l] == 0.0:
        fraction, level, kind = locate_event_3d(s, l, system, block)
    if kind in (HALVE, NO_EVENT):
        s.no_event[l] = 1.0 if kind == NO_EVENT else 0.0
        if kind == HALVE:
            s.step[l], s.steps_left[l] = 0.5 * s.step[l], 1.0
            s.step_limit[l] = s.step[l]
        return GOES_ON
    rests = end_on_event_3d(s, l, systems, block, output, fraction, level, kind)
    if s.outcome[l] >= 0 or too_many_events(s, l, system):
        return IS_OVER
    if not rests:
        observe_start_3d(s, l)
        plan_step(s, l)
    return FOLLOW_CONTACT if rests else GOES_ON


@compiled
def end_on_event_3d(
    s: Record,
    l: int,
    systems: Pair,
    block: Record,
    output: Output,
    fraction: float,
    level: float,
    kind: int,
) -> bool:
    """End the step on an event, and switch; True if the storey comes to rest [level rad]."""
    system, log = systems[0], output.log
    observe_step(s, l, systems, output, fraction)
    end_step_at_3d(s, l, fraction, level)
    observe_end_3d(s, l, systems)
    if s.next_theta[l] > s.max_theta[l] or (s.theta_dot[l] > 0.0 and s.next_theta_dot[l] < 0.0):
        raise_peak_3d(s, l, block, log)
    before = s.time[l]
    take_end(s, l)
    s.stalled[l] = s.stalled[l] + 1 if s.time[l] == before else 0
    if kind in (PASS, NEAR_PASS):
        near = 1 if kind == NEAR_PASS else 0
        pass_upright(s, l, system, log, near)
        return settles(s, l, system, log, near)
    log_event_3d(s, l, log, kind, s.theta_dot[l], s.theta_dot[l], 0.0)
    if kind == OVERTURNING:
        rolls = s.theta_cr[l] < system.beta
        s.outcome[l] = OVERTURNED_ROLLING if rolls else OVERTURNED_ROCKING
    else:
        enter_phase_3d(s, l, system, ROCKING if kind == ROLLING_TO_ROCKING else ROLLING)
    return False


@compiled
def next_interval_3d(s: Record, l: int, system: Record, acceleration: Floats) -> int:
    """Enter the records' next interval: GOES_ON, or IS_OVER at the history's end."""
    if enter_interval_3d(s, l, acceleration, s.interval[l] + 1) or wobbles_on(s, l, system):
        return IS_OVER
    plan_step(s, l)
    return GOES_ON


@compiled
def wobbles_on(s: Record, l: int, system: Record) -> bool:
    """Whether the free vibration after the record has lasted, and no larger tilt can come."""
    free = s.interval[l] + 1 - s.npts[l]
    if system.until_rest == 0 or free % REST_EVERY != 0 or free * s.dt[l] < WOBBLES:
        return False
    level = min(s.max_theta[l], s.theta_cr[l])
    constants = system.rolling if level < system.beta else system.rocking
    phase = Phase(constants[0], constants[1], constants[2], constants[3], constants[4])
    lift = s.diameter[l] * cap_beam_lift(phase, math.cos(level), math.sin(level))
    least = lifted_mass(s, l) * s.gravity[l] * lift
    return s.theta[l] < level and bool(uplifted_energy_3d(s, l) < least)


@compiled
def raise_peak_3d(s: Record, l: int, block: Record, log: Record) -> None:
    """Raise the largest tilt by that of the step just taken, turning points included."""
    height, fraction = s.next_theta[l], 1.0
    path = path_of(s, l)
    turns = s.theta_dot[l] > 0.0 and s.next_theta_dot[l] < 0.0
    if turns and upper_hull(path) > s.max_theta[l]:
        fraction, height = peak_in_step(path)
    if height <= s.max_theta[l]:
        return
    s.max_theta[l] = height
    s.max_theta_time[l] = s.interval_start[l] + (s.time[l] + fraction * s.step[l])
    s.max_azimuth[l] = azimuth_at(s, l, fraction)
    if height > s.theta_cr[l] and s.critical_time[l] < 0.0:
        log_critical_passage_3d(s, l, block, log)


@compiled
def azimuth_at(s: Record, l: int, t: float) -> float:
    """Azimuth a fraction t into the step whose terms still stand [rad]."""
    cosine, sine = direction_at(s, l, t)
    return math.atan2(sine, cosine)


@compiled
def log_critical_passage_3d(s: Record, l: int, block: Record, log: Record) -> None:
    """Note when theta_cr was passed for the first time, within the step just taken."""
    path, level, h = path_of(s, l), s.theta_cr[l], s.step[l]
    t = min(first_descent(offset(path, -1.0, level), SETTLED, block.piece), 1.0)
    rate = slope(path, t) / h
    kept = s.time[l], s.theta[l], s.cos_phi[l], s.sin_phi[l]
    s.critical_azimuth[l] = azimuth_at(s, l, t)
    s.time[l], s.theta[l] = kept[0] + t * h, value(path, t)
    s.cos_phi[l], s.sin_phi[l] = direction_at(s, l, t)
    s.critical_time[l] = s.interval_start[l] + s.time[l]
    log_event_3d(s, l, log, CRITICAL_PASSAGE, rate, rate, 0.0)
    s.time[l], s.theta[l], s.cos_phi[l], s.sin_phi[l] = kept
