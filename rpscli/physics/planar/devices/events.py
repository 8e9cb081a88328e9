"""Where devices change their law within a step: found, located, and made (Theory, section 11).

Each change is where a watched function of the motion falls below zero. All of them are polynomials
over a step: their Taylor terms are sums of those that the step leaves behind. Function 0 is the
rate of the tilt in the direction of friction; 1 + i and 1 + SLOTS + i belong to device i.
"""

from __future__ import annotations

import math

from rpscli.physics.core.compile import compiled
from rpscli.physics.core.lanes import log_event, time_of
from rpscli.physics.core.quintic import (
    NEAR,
    NO_PASSAGE,
    SETTLED,
    Quintic,
    first_descent,
    lower_hull,
    quintic,
)
from rpscli.physics.core.records import ORDER, Record
from rpscli.physics.planar.devices import with_devices
from rpscli.physics.planar.devices.forces import cap_beam_path, tendon_elongation
from rpscli.physics.planar.state import (
    AFTER_PHASE_CHANGE,
    AFTER_REVERSAL,
    BEYOND,
    IDLE,
    SLOTS,
    STOP,
    STOP_DAMPING,
    STOP_GAP,
    STOP_LEFT,
    STOP_MET,
    STOP_STIFFNESS,
    TENDON,
    TENDON_PRESTRESS,
    TENDON_SLACK,
    TENDON_STIFFNESS,
    TENDON_TAUT,
    TENDON_YIELD,
    TENDON_YIELDING,
    WORKING,
)

LEAST_STEP = 1e-12
"""Of the sampling interval: a step near the kink of a damper is not made shorter."""

FALLS, RISES = 0.3, 3.0
"""A step over which |u_b'| changes by more than these factors is too long for a power of it."""


@compiled
def has_friction(s: Record, l: int) -> bool:
    """Whether something holds the tilt at rest."""
    return bool(s.friction_force[l] + s.friction_moment[l] > 0.0)


@compiled
def watch(s: Record, l: int, which: int) -> bool:
    """Write a watched function's terms over the step to `event_terms`; False if there is none."""
    if which == 0:
        watched = has_friction(s, l)
        for i in range(s.devices[l]):
            watched |= s.device_kind[i, l] == TENDON and s.device_branch[i, l] == BEYOND
        for m in range(ORDER + 1):
            s.event_terms[m, l] = s.direction[l] * s.dtheta_terms[m, l]
        s.event_terms[ORDER + 1, l] = 0.0
        return watched
    second = 1 if which > SLOTS else 0
    i = which - 1 - SLOTS * second
    if i >= s.devices[l]:
        return False
    if s.device_kind[i, l] == STOP:
        return watch_stop(s, l, i, second)
    return s.device_kind[i, l] == TENDON and watch_tendon(s, l, i, second)


@compiled
def watch_stop(s: Record, l: int, i: int, second: int) -> bool:
    """Of a stop: that its gap is open, that it pushes, or does not; second, that it may again."""
    branch = s.device_branch[i, l]
    if second > 0 and branch != BEYOND:
        return False
    stiffness, damping = (s.law[i, STOP_STIFFNESS, l], s.law[i, STOP_DAMPING, l])
    if branch == IDLE or second > 0:
        stiffness, damping = 1.0, 0.0
    sign = 1.0 if branch == WORKING or second > 0 else -1.0
    beyond = s.path[l] - s.law[i, STOP_GAP, l]
    s.event_terms[0, l] = sign * (stiffness * beyond + damping * s.advance_terms[0, l])
    for m in range(1, ORDER + 2):
        term = stiffness * s.step[l] / m * s.advance_terms[m - 1, l]
        if m <= ORDER:
            term += damping * s.advance_terms[m, l]
        s.event_terms[m, l] = sign * term
    return True


@compiled
def watch_tendon(s: Record, l: int, i: int, second: int) -> bool:
    """Of a tendon: that it is tight, or slack; second, that it does not yield."""
    branch, limit = s.device_branch[i, l], s.law[i, TENDON_YIELD, l]
    if branch == BEYOND or (second > 0 and (branch == IDLE or limit == math.inf)):
        return False
    stiffness = s.law[i, TENDON_STIFFNESS, l]
    stretch = s.elongation_terms[0, l] - s.permanent[i, l]
    tense = s.law[i, TENDON_PRESTRESS, l] + stiffness * stretch
    sign = -1.0 if second > 0 or branch == IDLE else 1.0
    s.event_terms[0, l] = limit - tense if second > 0 else sign * tense
    for m in range(1, ORDER + 1):
        s.event_terms[m, l] = sign * stiffness * s.elongation_terms[m, l]
    longer, last = 0.0, ORDER + 1
    for j in range(last):
        longer += s.lever_terms[0, j, l] * s.dtheta_terms[ORDER - j, l]
    s.event_terms[last, l] = sign * stiffness * s.step[l] / last * longer
    return True


@compiled
def watched_path(s: Record, l: int) -> Quintic:
    """The watched function over the step; what has just changed begins at zero, not below it."""
    terms = s.event_terms
    terms[0, l] = max(terms[0, l], 0.0)
    end, slope, curvature = 0.0, 0.0, 0.0
    for k in range(ORDER + 1, -1, -1):
        end += terms[k, l]
        slope += k * terms[k, l]
        curvature += k * (k - 1.0) * terms[k, l]
    return quintic(1.0, terms[0, l], terms[1, l], 2.0 * terms[2, l], end, slope, curvature)


@compiled
def meets_kink(s: Record, l: int) -> bool:
    """Whether |u_b'| changes too much over the step for a power of it."""
    _, rate, _ = cap_beam_path(s, l, s.next_theta[l], s.next_theta_dot[l])
    first, least = s.advance_terms[0, l], s.linear_speed[l]
    if abs(first) <= least:
        return bool(abs(rate) > 4.0 * least)
    return not FALLS <= rate / first <= RISES


@with_devices()
def check_devices(s: Record) -> None:
    """Withdraw the acceptance of steps in which a device may change its law, or that end too far.

    Those of a damper with a kink are shortened towards it.
    """
    for l in range(s.lanes):
        if s.devices[l] == 0:
            continue
        if s.nonsmooth_damper[l] > 0.0 and s.step[l] > LEAST_STEP * s.dt[l] and meets_kink(s, l):
            s.too_long[l] = 1.0
        watched = s.accepted[l] > 0.0 and s.no_event[l] == 0.0
        alarm = s.too_long[l] > 0.0
        for which in range(1 + 2 * SLOTS):
            if watched and not alarm and watch(s, l, which):
                path = watched_path(s, l)
                alarm = min(lower_hull(path), path[0]) < 0.0
        if alarm:
            s.accepted[l], s.peak_inside[l] = 0.0, 0.0


@with_devices(otherwise=(NO_PASSAGE, -1))
def locate_change(s: Record, l: int, block: Record) -> tuple[float, int]:
    """Fraction of the step at which the first device changes its law, and the watched function."""
    first, found = NO_PASSAGE, -1
    for which in range(1 + 2 * SLOTS):
        if watch(s, l, which):
            t = first_descent(watched_path(s, l), NEAR, block.piece)
            if t <= 1.0:
                t = refined(s, l, t)
            if t < first:
                first, found = t, which
    return first, found


@compiled
def refined(s: Record, l: int, guess: float) -> float:
    """The root of the watched polynomial near a guess: Newton's method within the step."""
    t, terms = guess, s.event_terms
    for _ in range(12):
        value, slope = 0.0, 0.0
        for k in range(ORDER + 1, -1, -1):
            slope = slope * t + value
            value = value * t + terms[k, l]
        change = -value / slope if slope != 0.0 else 2.0
        if not 0.0 <= t + change <= 1.0:
            break
        t += change
        if abs(change) < SETTLED * t:
            break
    return t


@with_devices()
def change_law(s: Record, l: int, log: Record, which: int) -> None:
    """What the watched function that fell below zero stands for; the lane is where it did."""
    s.restart_after[l] = AFTER_PHASE_CHANGE
    if which == 0:
        s.theta_dot[l] = 0.0
        reset_yielded_tendons(s, l)
        if has_friction(s, l):
            s.restart_after[l] = AFTER_REVERSAL
        return
    second = which > SLOTS
    i = which - 1 - SLOTS if second else which - 1
    branch, event = s.device_branch[i, l], -1
    if s.device_kind[i, l] == STOP:
        if branch == WORKING:
            branch, event = (BEYOND if s.law[i, STOP_DAMPING, l] > 0.0 else IDLE, STOP_LEFT)
        elif second:
            branch = IDLE
        else:
            branch, event = WORKING, STOP_MET
    elif second:
        branch, event = BEYOND, TENDON_YIELDING
    elif branch == WORKING:
        branch, event = IDLE, TENDON_SLACK
    else:
        branch, event = WORKING, TENDON_TAUT
    s.device_branch[i, l] = branch
    if event >= 0:
        rate = s.side[l] * s.theta_dot[l]
        log_event(s, l, log, time_of(s, l), event, s.side[l] * s.theta[l], rate, rate, 0.0)


@compiled
def reset_yielded_tendons(s: Record, l: int) -> None:
    """Tendons that yielded are elastic again, longer by what they yielded."""
    for i in range(s.devices[l]):
        if s.device_kind[i, l] == TENDON and s.device_branch[i, l] == BEYOND:
            e, _, _, _ = tendon_elongation(s, l, s.theta[l])
            until_yield = s.law[i, TENDON_YIELD, l] - s.law[i, TENDON_PRESTRESS, l]
            s.permanent[i, l] = e - until_yield / s.law[i, TENDON_STIFFNESS, l]
            s.device_branch[i, l] = WORKING
