"""What a lane does after each step: go on, pass near upright, change its phase, or end."""

from __future__ import annotations

import math

from rpscli.physics.core.compile import compiled, exact_kernel, variant
from rpscli.physics.core.lanes import enter_interval
from rpscli.physics.core.quintic import NEAR, SETTLED, first_descent, lower_hull, offset
from rpscli.physics.core.records import NO_HISTORY, Floats, Record
from rpscli.physics.core.series import slope, value
from rpscli.physics.planar.devices.events import change_law, locate_change
from rpscli.physics.planar.devices.flows import raise_devices
from rpscli.physics.planar.equation_of_motion import cap_beam_lift, lifted_mass, rotation_terms
from rpscli.physics.planar.events import (
    CHANGE_OF_DEVICE,
    end_step,
    leaves_range,
    note_critical,
    note_peak,
    too_many_events,
)
from rpscli.physics.planar.full_contact.follow import REST_EVERY
from rpscli.physics.planar.geometry import Phase
from rpscli.physics.planar.run import Output
from rpscli.physics.planar.state import (
    FAILED_NOT_FINITE,
    FOLLOW_CONTACT,
    GOES_ON,
    IMPACT,
    IS_OVER,
    NO_EVENT,
    OVERTURNED_ROCKING,
    OVERTURNED_ROLLING,
    OVERTURNING,
    PASS,
    ROCKING,
    ROLLING,
    ROLLING_TO_ROCKING,
)
from rpscli.physics.planar.steps import tilt_at
from rpscli.physics.spatial.demands import observe_start_3d
from rpscli.physics.spatial.devices import mark_azimuth, take_up_stops
from rpscli.physics.spatial.energy import uplifted_energy_3d
from rpscli.physics.spatial.equation_of_motion import direction_at, enter_phase_3d
from rpscli.physics.spatial.passes import describe_event, log_event_3d, pass_upright, settles
from rpscli.physics.spatial.steps import plan_step, rate_path

NEAR_PASS = IMPACT
"""Kind of an event: the tilt falls below theta_c, and the map takes over."""

HALVE = -3
"""No event: the step holds too much to be searched, and is halved."""

WOBBLES = 20.0
"""So long after the record a wobbling structure is left, once no larger tilt can come [s]."""


@compiled
def locate_event_3d(s: Record, l: int, system: Record, block: Record) -> tuple[float, float, int]:
    """Fraction of the step just taken at which its first event happens, tilt there, and which."""
    first, level, kind = leaves_range(s, l, system, block)
    rate, piece = rate_path(s, l), block.piece
    if rate[0] < 0.0:
        t = first_descent(offset(rate, -1.0, 0.0), NEAR, piece)
        if t <= 1.0:
            t = turning_point(s, l, t)
            if t < first:
                first, level, kind = t, tilt_at(s, l, t), PASS
    elif rate[5] >= 0.0 and lower_hull(rate) < 0.0 and first_descent(rate, NEAR, piece) <= 1.0:
        return 0.5, 0.0, HALVE
    t, which = locate_change(s, l, block)
    if t < first:
        first, level, kind = t, tilt_at(s, l, t), CHANGE_OF_DEVICE + which
    return first, level, kind


@compiled
def turning_point(s: Record, l: int, guess: float) -> float:
    """Fraction of the step at which p is zero, near a guess: Newton's method on its series."""
    t, terms = guess, rotation_terms(s, l)
    for _ in range(8):
        rise = slope(terms, t)
        change = -value(terms, t) / rise if rise != 0.0 else 2.0
        if not 0.0 <= t + change <= 1.0:
            break
        t += change
        if abs(change) < SETTLED:
            break
    return t


@exact_kernel
def resolve_step_3d(s: Record, l: int, systems: Record, block: Record, output: Output) -> int:
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
    end_step(s, l, systems, block, output, fraction, level)
    rests = switch(s, l, system, output.log, kind)
    if s.outcome[l] >= 0 or too_many_events(s, l, system):
        return IS_OVER
    if not rests:
        observe_start_3d(s, l)
        plan_step(s, l)
    return FOLLOW_CONTACT if rests else GOES_ON


@compiled
def switch(s: Record, l: int, system: Record, log: Record, kind: int) -> bool:
    """What an event does; True if the storey comes to rest."""
    if kind in (PASS, NEAR_PASS):
        near = 1 if kind == NEAR_PASS else 0
        pass_upright(s, l, system, log, near)
        take_up_stops(s, l, log)
        return settles(s, l, system, log, near)
    if kind >= CHANGE_OF_DEVICE:
        change_law(s, l, log, kind - CHANGE_OF_DEVICE)
        raise_devices(s, l, s.theta[l], s.theta_dot[l], 0.0)
        mark_azimuth(s, l, log)
        return False
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
    if enter_interval(s, l, acceleration, s.interval[l] + 1) or wobbles_on(s, l, system):
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
def azimuth_at(s: Record, l: int, t: float) -> float:
    """Azimuth a fraction t into the step whose terms still stand [rad]."""
    cosine, sine = direction_at(s, l, t)
    return math.atan2(sine, cosine)


@variant(note_peak, "cos_phi")
def note_azimuth(s: Record, l: int, t: float) -> None:
    """Note the azimuth of the largest tilt so far, a fraction t into the step just taken."""
    s.max_azimuth[l] = azimuth_at(s, l, t)


@variant(note_critical, "cos_phi")
def note_critical_azimuth(s: Record, l: int, t: float, log: Record, row: int) -> None:
    """Note that of the passage of theta_cr, and complete its entry in the log."""
    s.critical_azimuth[l] = azimuth_at(s, l, t)
    describe_event(log, row, s.critical_azimuth[l], 0.0, 0.0, 0.0)
