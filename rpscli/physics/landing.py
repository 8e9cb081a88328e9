"""A step of a lane alone: accepted, taken again because it erred, or
taken again to its event.

A step that is to end on an event is taken again, its length corrected by Newton's method.
"""

from __future__ import annotations

import math

from rpscli.physics.compile import compiled
from rpscli.physics.event_table import EVENTS
from rpscli.physics.events import LEAST_STEP
from rpscli.physics.lane import ways_of
from rpscli.physics.quintic import NO_PASSAGE
from rpscli.physics.state import (
    CHANGE,
    FAILED_NOT_FINITE,
    LET_GO,
    NO_HISTORY,
    NOTHING,
    YIELD,
    Record,
)

CLOSE = 1e-7
"""Of the step: what is missing to an event is so short that rates lead there. What
flows in it is taken for the mean of the step, a part of what flows at its end
where a tilt has only begun."""

AT_LIMIT = 1e-9
"""The same of an uplift, over the sampling interval: a margin that is not yet zero would
have the storey land at once."""

MOST_TRIES = 8


@compiled
def first_event(s: Record, l: int, systems: Record) -> tuple[float, int, int]:
    """Fraction of the step at which its first event happens,
    its kind, and which of it.
    """
    first = NO_PASSAGE
    kind = NOTHING
    which = 0
    for event in EVENTS:
        t, found = event.first(s, l, systems)
        if t < first:
            first = t
            kind = event.kind
            which = found
    return first, kind, which


@compiled
def missing(s: Record, l: int, systems: Record) -> tuple[float, float]:
    """Amount by which the end of the step is still above the event on which it is to end,
    and its rate.
    """
    for event in EVENTS:
        if s.wanted[l] == event.kind:
            return event.missing(s, l, systems)  # type: ignore[no-any-return]
    return 0.0, 0.0


@compiled
def resolve_step(s: Record, l: int, systems: Record) -> bool:
    """A step that was not accepted: accept it, or have it taken again;
    False if it is no number.
    """
    if s.history[l] == NO_HISTORY:
        s.accepted[l] = 1.0
        return True
    total = s.new_x[l] + s.new_v[l] + s.new_a[l]
    for axis in range(ways_of(s)):
        total += s.new_V[axis, l] + s.new_dV[axis, l]
    if not math.isfinite(total):
        s.outcome[l] = FAILED_NOT_FINITE
        return False
    if s.error[l] > 1.0 and s.h[l] > LEAST_STEP * s.dt[l]:
        # also of a step that is to end on an event: there a bed may be steeper than
        # beyond it
        s.h[l] *= 0.5 if s.error[l] < 64.0 else 0.25
        s.h_limit[l] = s.h[l]
        s.wanted[l] = NOTHING
        return True
    if s.wanted[l] != NOTHING:
        land(s, l, systems)
        return True
    fraction, kind, which = first_event(s, l, systems)
    if kind == NOTHING:
        s.accepted[l] = 1.0
        return True
    s.wanted[l] = kind
    s.which[l] = which
    s.tries[l] = 0
    s.h_now[l] = s.h[l]
    s.h[l] *= fraction
    return True


@compiled
def land(s: Record, l: int, systems: Record) -> None:
    """A step that was to end on an event: near enough, or once more."""
    value, slope = missing(s, l, systems)
    change = -value / slope if slope < 0.0 else 0.0
    change = min(max(change, -0.5 * s.h[l]), s.h_now[l] - s.h[l])
    s.tries[l] += 1
    close = max(CLOSE * s.h[l], LEAST_STEP * s.dt[l])
    if s.wanted[l] == LET_GO:
        close = AT_LIMIT * s.dt[l]
    if abs(change) > close and s.tries[l] < MOST_TRIES:
        s.h[l] += change
        return
    if abs(change) <= close:  # else it only grazes, and stays where it is
        go_on_by(s, l, change)
    # a cubic from zero without slope may dip where the value grows with the third power
    # of time
    dips = s.wanted[l] in (CHANGE, YIELD) and value > 0.0 and slope >= 0.0
    kind = NOTHING if dips else s.wanted[l]
    s.accepted[l] = 1.0
    s.kind[l] = kind
    s.wanted[l] = NOTHING


@compiled
def go_on_by(s: Record, l: int, time: float) -> None:
    """Lead the end of the step on by rates: so short a time
    that its square is rounding.
    """
    for axis in range(ways_of(s)):
        bend = s.new_bend[axis, l]
        s.new_tilt[axis, l] += time * (s.new_tilt_rate[axis, l] + 0.5 * time * bend)
        s.new_tilt_rate[axis, l] += time * bend
    for axis in range(s.axes):
        for r in range(axis * s.n, (axis + 1) * s.n):
            ddq = -(s.Gamma[r, l] * s.new_shaking[axis, l]) - s.force[r, l]
            s.new_q[r, l] += time * (s.new_dq[r, l] + 0.5 * time * ddq)
            s.new_dq[r, l] += time * ddq
    s.new_x[l] += time * (s.new_v[l] + 0.5 * time * s.new_a[l])
    s.new_v[l] += time * s.new_a[l]
    s.h[l] += time
