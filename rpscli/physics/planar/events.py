"""What a lane does after each uplifted step: go on, switch at an event, or end.

A step is taken as if its phase of motion went on for ever. If the tilt then leaves the range of
the phase, the step ends where it does: a root of its own polynomial, found from that of the
interpolating quintic by Newton's method. No step is taken again.
"""

from __future__ import annotations

import math

from rpscli.physics.core.compile import by_record, compiled, kernel
from rpscli.physics.core.lanes import enter_interval, log_event, time_of
from rpscli.physics.core.quintic import (
    NEAR,
    NO_PASSAGE,
    SETTLED,
    Quintic,
    first_descent,
    offset,
    peak_in_step,
    slope,
    upper_hull,
)
from rpscli.physics.core.records import NO_HISTORY, Floats, Record
from rpscli.physics.planar.bed.terms import keep_pace
from rpscli.physics.planar.bed_block import stands_on_bed
from rpscli.physics.planar.bed_events import observe_bed, pass_on_bed, rests_on_bed
from rpscli.physics.planar.demands import observe_end, observe_start, raise_contacts_within
from rpscli.physics.planar.devices.events import change_law, has_friction, locate_change
from rpscli.physics.planar.devices.flows import book_devices, observe_devices, raise_devices
from rpscli.physics.planar.devices.forces import set_devices
from rpscli.physics.planar.devices.rest import at_reversal, begin_excursion
from rpscli.physics.planar.energy import book_energy
from rpscli.physics.planar.equation_of_motion import renew_accelerations
from rpscli.physics.planar.run import Output
from rpscli.physics.planar.samples import store_sample, store_within
from rpscli.physics.planar.state import (
    AFTER_IMPACT,
    AFTER_PHASE_CHANGE,
    AFTER_RELEASE,
    AFTER_REVERSAL,
    AFTER_UPLIFT,
    CRITICAL_PASSAGE,
    EVENT_KINDS,
    FAILED_NOT_FINITE,
    FAILED_STEP_TOO_SMALL,
    FAILED_TOO_MANY_EVENTS,
    FOLLOW_CONTACT,
    GOES_ON,
    IMPACT,
    IS_OVER,
    NO_EVENT,
    NOTHING_NEW,
    OVERTURNED_ROCKING,
    OVERTURNED_ROLLING,
    OVERTURNING,
    ROCKING,
    ROLLING,
    ROLLING_TO_ROCKING,
)
from rpscli.physics.planar.steps import (
    end_step_at,
    fraction_at,
    path_of,
    plan_steps,
    shorten_step,
    tilt_at,
)
from rpscli.physics.planar.transitions import (
    apply_impact,
    comes_to_rest,
    enter_phase,
    event_above,
    event_below,
)

CHANGE_OF_DEVICE = EVENT_KINDS
"""Kind of an event that `devices.events` knows more of."""

STALL = 100
"""So many events in a row without time passing: the step cannot be made small enough."""


@compiled
def locate_event(s: Record, l: int, system: Record, block: Record) -> tuple[float, float, int, int]:
    """Fraction of the step just taken at which its first event happens, and which.

    Returns: Fraction, level of the tilt, kind of the event, or NO_EVENT: then the alarm was false;
    and, of a CHANGE_OF_DEVICE, the function that it was watched by.
    """
    first, level, kind = leaves_range(s, l, system, block)
    which = -1
    if s.devices[l] > 0:
        t, found = locate_change(s, l, block)
        if t < first:
            first, level, kind, which = t, tilt_at(s, l, t), CHANGE_OF_DEVICE, found
    return first, level, kind, which


@compiled
def leaves_range(s: Record, l: int, system: Record, block: Record) -> tuple[float, float, int]:
    """Fraction of the step at which the tilt leaves its phase's range, where, and the event."""
    path, piece = path_of(s, l), block.piece
    first, level, kind = NO_PASSAGE, 0.0, NO_EVENT
    t = first_descent(offset(path, 1.0, s.theta_low[l]), NEAR, piece)
    if t < first:
        first, level, kind = t, s.theta_low[l], event_below(s, l, system)
    t = first_descent(offset(path, -1.0, s.theta_high[l]), NEAR, piece)
    if t < first:
        first, level, kind = t, s.theta_high[l], event_above(s, l, system)
    if kind != NO_EVENT:
        first = fraction_at(s, l, level, first)
    return first, level, kind


@compiled
def end_step(
    s: Record,
    l: int,
    system: Record,
    block: Record,
    output: Output,
    fraction: float,
    level: float,
) -> None:
    """End the step of a lane within, at a level of the tilt [level rad]."""
    if s.audited > 0:
        book_energy(s, l, fraction)
        if output.finer > 1:
            store_within(s, l, system, output, fraction)
    if s.devices[l] > 0:
        book_devices(s, l, fraction)
        observe_devices(s, l, fraction)
    observe_bed(s, l, fraction)
    raise_contacts_within(s, l, fraction)
    end_turn_at(s, l, fraction)
    end_step_at(s, l, fraction, level)
    observe_end(s, l, system)
    turned = s.theta_dot[l] > 0.0 and s.next_theta_dot[l] < 0.0
    if s.next_theta[l] > s.max_theta[l] or turned:
        raise_peak(s, l, block, output.log)
    s.theta[l], s.theta_dot[l] = s.next_theta[l], s.next_theta_dot[l]
    for r in range(s.n):
        s.q[r, l], s.dq[0, r, l] = s.next_q[r, l], s.next_dq[r, l]
    before = s.time[l]
    s.time[l] += s.step[l]
    s.stalled[l] = s.stalled[l] + 1 if s.time[l] == before else 0
    take_turn(s, l)


@by_record
def end_turn_at(_s: Record, _l: int, _t: float) -> None:
    """In one plane nothing else is at the end of a step."""


@by_record
def take_turn(_s: Record, _l: int) -> None:
    """In one plane nothing else becomes the state."""


@by_record
def note_peak(_s: Record, _l: int, _t: float) -> None:
    """In one plane nothing else is known of the largest tilt."""


@by_record
def note_critical(_s: Record, _l: int, _t: float, _log: Record, _row: int) -> None:
    """Nor of where theta_cr was passed."""


@compiled
def end_on_event(
    s: Record,
    l: int,
    system: Record,
    block: Record,
    output: Output,
    fraction: float,
    level: float,
    kind: int,
    which: int,
) -> None:
    """End the step on an event, and switch [level rad]."""
    log = output.log
    end_step(s, l, system, block, output, fraction, level)
    if pass_on_bed(s, l, system, log, kind):
        return
    if kind == IMPACT:
        apply_impact(s, l, system, log)
        begin_excursion(s, l, log)
        return
    if kind == CHANGE_OF_DEVICE:
        change_law(s, l, log, which)
        return
    rotation, rate = s.side[l] * s.theta[l], s.side[l] * s.theta_dot[l]
    log_event(s, l, log, time_of(s, l), kind, rotation, rate, rate, 0.0)
    if kind == OVERTURNING:
        rolls = s.theta_cr[l] < system.beta
        s.outcome[l] = OVERTURNED_ROLLING if rolls else OVERTURNED_ROCKING
        return
    enter_phase(s, l, system, ROCKING if kind == ROLLING_TO_ROCKING else ROLLING)
    s.restart_after[l] = AFTER_PHASE_CHANGE


@compiled
def too_many_events(s: Record, l: int, system: Record) -> bool:
    """Whether events pile up; sets the outcome."""
    events = 0
    for i in range(EVENT_KINDS):
        events += s.events[l, i]
    if events > system.max_events:
        s.outcome[l] = FAILED_TOO_MANY_EVENTS
        return True
    if s.stalled[l] > STALL:
        s.outcome[l] = FAILED_STEP_TOO_SMALL
        return True
    return False


@compiled
def next_interval(s: Record, l: int, system: Record, acceleration: Floats) -> int:
    """Enter the record's next interval: GOES_ON, FOLLOW_CONTACT on a bed, IS_OVER at the end."""
    if enter_interval(s, l, acceleration, s.interval[l] + 1) or rests_on_bed(s, l, system):
        return IS_OVER
    if s.interval[l] + 1 == s.npts[l]:
        s.restart_after[l] = AFTER_PHASE_CHANGE  # the ground acceleration may jump to zero
    s.step[l], s.steps_left[l] = s.uplifted_step[l], s.uplifted_steps[l]
    if s.nonsmooth_damper[l] > 0.0:
        shorten_step(s, l)
    keep_pace(s, l)
    return FOLLOW_CONTACT if stands_on_bed(s, l) else GOES_ON


@kernel
def resolve_step(s: Record, l: int, system: Record, block: Record, output: Output) -> int:
    """Deal with a step that was not accepted: GOES_ON or IS_OVER.

    After a false alarm the same step is taken once more, and passes. A step that is too long for
    its series is taken again at half the length, as are those after it up to the next sample.
    """
    if s.history[l] == NO_HISTORY:
        return IS_OVER
    if s.too_long[l] > 0.0:
        s.step[l], s.steps_left[l] = 0.5 * s.step[l], 2.0 * s.steps_left[l]
        if s.nonsmooth_damper[l] > 0.0:
            s.steps_left[l] = 2.0
        return GOES_ON
    if not math.isfinite(s.next_theta[l] + s.next_theta_dot[l] + s.next_theta_ddot[l]):
        s.outcome[l] = FAILED_NOT_FINITE
        return IS_OVER
    fraction, level, kind, which = locate_event(s, l, system, block)
    if kind == NO_EVENT:
        s.no_event[l] = 1.0
        return GOES_ON
    end_on_event(s, l, system, block, output, fraction, level, kind, which)
    plan_steps(s, l)
    return IS_OVER if s.outcome[l] >= 0 or too_many_events(s, l, system) else GOES_ON


@compiled
def go_on_at_reversal(s: Record, l: int, system: Record, output: Output, after: int) -> int:
    """At a standstill of the tilt: GOES_ON, or FOLLOW_CONTACT if friction holds it."""
    stuck = at_reversal(s, l, output.log)
    if after == AFTER_RELEASE:
        store_sample(s, l, system, output)
    return FOLLOW_CONTACT if stuck else GOES_ON


@kernel
def go_on_restarted(s: Record, l: int, system: Record, output: Output) -> int:
    """Accelerations anew: GOES_ON; FOLLOW_CONTACT after the last impact or held by friction."""
    if s.history[l] == NO_HISTORY:
        return IS_OVER
    if s.devices[l] > 0:
        set_devices(s, l, s.theta[l], s.theta_dot[l])
        raise_devices(s, l, s.theta[l], s.theta_dot[l], 0.0)
    renew_accelerations(s, l)
    observe_start(s, l)
    after = s.restart_after[l]
    s.restart_after[l] = NOTHING_NEW
    if after == AFTER_PHASE_CHANGE and s.theta_dot[l] == 0.0 and has_friction(s, l):
        # It has just begun to slide: the same holds as at uplift, in either direction.
        s.theta_ddot[l] = s.direction[l] * max(s.direction[l] * s.theta_ddot[l], 0.0)
    elif after == AFTER_UPLIFT:
        # At the threshold theta'' is zero but for rounding, and about to grow.
        s.theta_ddot[l] = max(s.theta_ddot[l], 0.0)
    elif after in (AFTER_RELEASE, AFTER_REVERSAL):
        return go_on_at_reversal(s, l, system, output, after)
    elif after == AFTER_IMPACT and comes_to_rest(s, l, system, output.log):
        return FOLLOW_CONTACT
    if s.nonsmooth_damper[l] > 0.0:
        plan_steps(s, l)
    return GOES_ON


# The largest tilt, turning points between samples included, and the passage of theta_cr.


@compiled
def raise_peak(s: Record, l: int, block: Record, log: Record) -> None:
    """Raise the largest tilt by that of the step just taken, turning points included."""
    height, fraction = s.next_theta[l], 1.0
    path = path_of(s, l)
    turns = s.theta_dot[l] > 0.0 and s.next_theta_dot[l] < 0.0
    if turns and upper_hull(path) > s.max_theta[l]:
        fraction, height = peak_in_step(path)
    if height > s.max_theta[l]:
        s.max_theta[l] = height
        s.max_theta_time[l] = s.interval_start[l] + (s.time[l] + fraction * s.step[l])
        note_peak(s, l, fraction)
        if height > s.theta_cr[l] and s.critical_time[l] < 0.0:
            log_critical_passage(s, l, block, log, path)


@compiled
def log_critical_passage(s: Record, l: int, block: Record, log: Record, path: Quintic) -> None:
    """Note when theta_cr was passed for the first time, within the step just taken [path rad]."""
    level, h, side = s.theta_cr[l], s.step[l], s.side[l]
    t = min(first_descent(offset(path, -1.0, level), SETTLED, block.piece), 1.0)
    rate = side * slope(path, t) / h if h > 0.0 else 0.0
    s.critical_time[l] = time_of(s, l) + t * h
    time = s.critical_time[l]
    row = log_event(s, l, log, time, CRITICAL_PASSAGE, side * level, rate, rate, 0.0)
    note_critical(s, l, t, log, row)
