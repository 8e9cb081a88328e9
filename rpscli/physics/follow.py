"""Histories in lanes: step, detect, locate, switch, store.

All lanes take a step together, each as long as its own motion allows. What has come to a
sample goes on into the next interval; what has come to an event, or to the end of its
record, is looked at alone. A lane whose history is over takes the next one.
"""

from __future__ import annotations

import math

from rpscli.physics.beginning import begin_history, idle
from rpscli.physics.compile import compiled, inlined
from rpscli.physics.demands import observe, observe_start
from rpscli.physics.devices.branches import kink_limit
from rpscli.physics.devices.own import find_branches
from rpscli.physics.ending import finish_history
from rpscli.physics.event_table import EVENTS
from rpscli.physics.events import check_steps
from rpscli.physics.ground import set_ground
from rpscli.physics.groups import (
    MOVING,
    STANDING,
    WAITING,
    copy_lane,
    free_lane,
    is_called,
    leave,
    standing_is_next,
    waiting_place,
)
from rpscli.physics.landing import resolve_step
from rpscli.physics.lane import lanes_of, ways_of
from rpscli.physics.next_step import plan
from rpscli.physics.rest import REST_EVERY, is_over
from rpscli.physics.run import KernelOutput
from rpscli.physics.samples import store_sample, store_within
from rpscli.physics.standing import stand, stands_exactly
from rpscli.physics.state import (
    BEDDED,
    CHANGE,
    EVENT_KINDS,
    FAILED_STEP_TOO_SMALL,
    FAILED_TOO_MANY_EVENTS,
    FAILED_TOO_MANY_STEPS,
    FULL_CONTACT,
    NO_HISTORY,
    NOTHING,
    RUNNING,
    YIELD,
    Floats,
    Record,
)
from rpscli.physics.step import renew, take_steps
from rpscli.physics.storeys import keep_slips, review_storeys


@compiled
def follow(
    state: Record,
    systems: Record,
    requests: Record,
    acceleration: Floats,
    results: Record,
    output: KernelOutput,
) -> None:
    """Follow every history of `requests` from rest, in a state of one
    record; writes `results`.
    """
    if lanes_of(state[0]) > 1:
        follow_many(state, systems, requests, acceleration, results, output)
        return
    s = state[0]
    s.audited = 1 if output.samples.shape[0] > 0 else 0
    for history in range(requests.shape[0]):
        begin_history(s, 0, systems, requests, history, acceleration, output)
        over = False
        while not over and s.stop == 0:
            if stands_exactly(s, 0):
                advance(s, systems, output, True)
            else:
                advance(s, systems, output, False)
            next_intervals(s, acceleration)
            if s.due[0] > 0.0:
                first = s.system[0]
                over = look_after(s, 0, systems[first : first + s.axes], output)
        if over:
            finish_history(s, 0, systems[s.system[0]], results)


@compiled
def follow_many(
    state: Record,
    systems: Record,
    requests: Record,
    acceleration: Floats,
    results: Record,
    output: KernelOutput,
) -> None:
    """Follow histories side by side (`groups`)."""
    moving = state[MOVING]
    standing = state[STANDING]
    for k in range(state.shape[0]):
        empty(state[k])
    begin_histories(state, systems, requests, acceleration, output)
    while moving.present + standing.present > 0 and moving.stop == 0:
        if standing_is_next(moving, standing):
            advance(standing, systems, output, True)
            next_intervals(standing, acceleration)
            look_after_all(state, STANDING, systems, results, output)
        else:
            advance(moving, systems, output, False)
            next_intervals(moving, acceleration)
            look_after_all(state, MOVING, systems, results, output)
        call_in(state)
        if standing.waiting < requests.shape[0]:
            begin_histories(state, systems, requests, acceleration, output)


@compiled
def empty(s: Record) -> None:
    """Begin without histories."""
    s.audited = 0
    s.waiting = 0
    s.present = 0
    s.active = 0
    for l in range(lanes_of(s)):
        idle(s, l)


@compiled
def begin_histories(
    state: Record,
    systems: Record,
    requests: Record,
    acceleration: Floats,
    output: KernelOutput,
) -> None:
    """Begin histories as long as there is room, where others stand or wait to."""
    moving = state[MOVING]
    standing = state[STANDING]
    lanes = lanes_of(state[MOVING])
    while standing.waiting < requests.shape[0]:
        if moving.present + standing.present >= (state.shape[0] - 1) * lanes:
            return
        place = STANDING * lanes + free_lane(standing)
        if standing.active == lanes:
            place = waiting_place(state)
        s = state[place // lanes]
        l = place % lanes
        begin_history(s, l, systems, requests, standing.waiting, acceleration, output)
        s.active += 1
        standing.waiting += 1
        standing.present += 1
        if not stands_exactly(s, l):
            leave(state, STANDING, place)
            idle(s, l)
            s.active -= 1


@compiled
def look_after_all(
    state: Record, k: int, systems: Record, results: Record, output: KernelOutput
) -> None:
    """Do what lanes alone are to do; those whose histories are over, or go on otherwise,
    leave.
    """
    s = state[k]
    for l in range(lanes_of(s)):
        if s.due[l] == 0.0 or s.history[l] == NO_HISTORY:
            continue
        first = s.system[l]
        if look_after(s, l, systems[first : first + s.axes], output):
            finish_history(s, l, systems[first], results)
            s.present -= 1
        elif stands_exactly(s, l) != (k == STANDING):
            leave(state, k, k * lanes_of(s) + l)
        else:
            continue
        idle(s, l)
        s.active -= 1


@compiled
def call_in(state: Record) -> None:
    """Let histories that wait go on where there is room."""
    moving = state[MOVING]
    standing = state[STANDING]
    for k in range(WAITING, state.shape[0]):
        s = state[k]
        for l in range(lanes_of(s) if is_called(moving) or is_called(standing) else 0):
            if s.history[l] == NO_HISTORY:
                continue
            to = standing if stands_exactly(s, l) else moving
            if is_called(to):
                copy_lane(to, free_lane(to), s, l)
                to.active += 1
                idle(s, l)
                s.active -= 1


@inlined
def advance(s: Record, systems: Record, output: KernelOutput, stands: bool) -> None:
    """A step of all lanes together: of those that stand, or of others."""
    if stands:
        stand(s)
    else:
        take_steps(s, systems)
    check_steps(s, systems, stands)
    for l in range(lanes_of(s)):
        if s.accepted[l] == 0.0 and not resolve_step(s, l, systems):
            s.accepted[l] = 0.0
    observe(s, systems, output.log, stands)
    if lanes_of(s) == 1 and s.accepted[0] > 0.0:
        book_flows(s, systems, output)
    accept_steps(s)
    for l in range(lanes_of(s) if s.yielding > 0 and not stands else 0):
        if s.marked[l] > 0 and s.accepted[l] > 0.0:
            keep_slips(s, l, systems[s.system[l] : s.system[l] + s.axes])


@compiled
def book_flows(s: Record, systems: Record, output: KernelOutput) -> None:
    """Book what flowed in the only lane's step, and keep what lies within it."""
    if s.audited > 0:
        s.energy_input[0] += s.h[0] * s.power_input[0]
        s.energy_damped[0] += s.h[0] * s.power_damped[0]
        s.energy_upwards[0] += s.h[0] * s.power_upwards[0]
        s.bed_energy[0] += s.h[0] * s.power_bed[0]
        if output.finer > 1:
            first = s.system[0]
            store_within(s, 0, systems[first : first + s.axes], output)


@inlined
def chosen(accepted: float, end: float, start: float) -> float:
    """The end of an accepted step, else its start."""
    # Adding zero keeps the compiler from choosing between addresses, lane by lane.
    new = end + 0.0
    return new if accepted > 0.0 else start


@compiled
def accept_steps(s: Record) -> None:
    """Make the ends of accepted steps the states of their lanes."""
    lanes = lanes_of(s)
    accept_tilts(s)
    accept_floors(s)
    for l in range(lanes if s.equipped > 0 else 0):
        yes = s.accepted[l]
        s.speed[l] = chosen(yes, s.new_speed[l], s.speed[l])
        s.square_rate[l] = chosen(yes, s.new_square_rate[l], s.square_rate[l])
        s.quicker[l] = chosen(yes, s.new_quicker[l], s.quicker[l])
    for l in range(lanes):
        s.time[l] += s.h[l] if s.accepted[l] > 0.0 else 0.0
        s.steps[l] += 1.0
    if s.gives_way > 0:
        for l in range(lanes):
            bedded = (s.accepted[l] > 0.0) & (s.phase[l] == BEDDED)
            s.bedded_time[l] += s.h[l] if bedded else 0.0


@inlined
def accept_tilts(s: Record) -> None:
    """Begin the next step of accepted lanes with the tilt at the end of this one."""
    lanes = lanes_of(s)
    for axis in range(ways_of(s)):
        for l in range(lanes):
            yes = s.accepted[l]
            rate = s.tilt_rate[axis, l]
            s.tilt[axis, l] = chosen(yes, s.new_tilt[axis, l], s.tilt[axis, l])
            s.tilt_rate[axis, l] = chosen(yes, s.new_tilt_rate[axis, l], rate)
            s.bend[axis, l] = chosen(yes, s.new_bend[axis, l], s.bend[axis, l])
    for l in range(lanes):
        yes = s.accepted[l]
        s.x[l] = chosen(yes, s.new_x[l], s.x[l])
        s.v[l] = chosen(yes, s.new_v[l], s.v[l])
        s.a[l] = chosen(yes, s.new_a[l], s.a[l])
        s.lift[l] = chosen(yes, s.new_lift[l], s.lift[l])


@inlined
def accept_floors(s: Record) -> None:
    """Begin the next step of accepted lanes with modes, base shears and sums of demands
    at the end of this one.
    """
    lanes = lanes_of(s)
    for axis in range(ways_of(s)):
        for l in range(lanes):
            yes = s.accepted[l]
            sums = s.shear_sum[axis, l]
            before = s.shear_before[axis, l]
            s.shear_before[axis, l] = chosen(yes, sums, before)
            sums = s.acceleration_sum[axis, l]
            before = s.acceleration_before[axis, l]
            s.acceleration_before[axis, l] = chosen(yes, sums, before)
    for axis in range(s.axes):
        for l in range(lanes):
            yes = s.accepted[l]
            s.shaking[axis, l] = chosen(yes, s.new_shaking[axis, l], s.shaking[axis, l])
            s.V[axis, l] = chosen(yes, s.new_V[axis, l], s.V[axis, l])
            s.dV[axis, l] = chosen(yes, s.new_dV[axis, l], s.dV[axis, l])
            s.ddV[axis, l] = chosen(yes, s.new_ddV[axis, l], s.ddV[axis, l])
    for r in range(s.axes * s.n):
        for l in range(lanes):
            s.q[r, l] = chosen(s.accepted[l], s.new_q[r, l], s.q[r, l])
            s.dq[r, l] = chosen(s.accepted[l], s.new_dq[r, l], s.dq[r, l])


SAME = 1e-12
"""Of the sampling interval: nothing is left of it."""

CALM = 1 / 128
EASY = 0.25
"""Errors of a step below which the next may be twice as long, or a fifth longer."""


@compiled
def next_intervals(s: Record, acceleration: Floats) -> None:
    """Lanes that have come to a sample enter the next interval; plan the steps of all.

    `due` to those at an event, at a jump of the ground's acceleration,
    or whose end may be near.
    """
    lanes = lanes_of(s)
    for l in range(lanes):
        there = (s.accepted[l] > 0.0) & (s.kind[l] == NOTHING)
        there &= s.dt[l] - s.time[l] <= SAME * s.dt[l]
        interval = s.interval[l] + (1 if there else 0)
        free = interval + 1 - s.npts[l]  # samples behind the record's last
        at_end = (interval >= s.intervals[l]) | ((free >= 0) & (free % REST_EVERY == 0))
        looks = (there & at_end) | (s.kind[l] != NOTHING) | (s.outcome[l] >= 0)
        looks |= (s.audited > 0) & there
        s.due[l] = 1.0 if looks else (0.5 if there else 0.0)
        s.interval[l] = interval
    for l in range(lanes):
        if s.due[l] > 0.0 and s.kind[l] == NOTHING and s.history[l] != NO_HISTORY:
            set_ground(s, l, acceleration)
        s.due[l] = 1.0 if s.due[l] == 1.0 else 0.0
    for l in range(lanes):
        goes_on = (s.accepted[l] > 0.0) & (s.due[l] == 0.0)
        limit = s.h_limit[l]
        factor = 2.0 if s.error[l] < CALM else (1.2 if s.error[l] < EASY else 1.0)
        limit = factor * limit
        limit = limit if limit < s.h_most[l] else math.inf
        s.h_limit[l] = limit if s.accepted[l] > 0.0 else s.h_limit[l]
        s.h[l] = plan(s, l) if goes_on else s.h[l]
    if s.equipped > 0:
        for l in range(lanes):
            goes_on = (s.kinks[l] > 0.0) & (s.accepted[l] > 0.0) & (s.moves[l] > 0.0)
            s.h[l] = min(s.h[l], kink_limit(s, l) if goes_on else math.inf)


STALL = 100
"""So many events in a row without time passing: the step cannot be made small enough."""


@compiled
def look_after(s: Record, l: int, systems: Record, output: KernelOutput) -> bool:
    """Do what a lane alone is to do: switch at an event, store, end; True if its history
    is over.
    """
    if s.outcome[l] != RUNNING:
        return True
    kind = s.kind[l]
    system = systems[0]
    if kind != NOTHING:
        s.kind[l] = NOTHING
        stands_still = s.time[l] - s.h[l] == s.time[l]
        s.stalled[l] = s.stalled[l] + 1 if stands_still else 0
        switch(s, l, systems, output.log, kind)
        review_laws(s, l, systems, kind)
        stay_inside(s, l)
        if s.outcome[l] != RUNNING or too_many(s, l, system):
            return True
        observe_start(s, l)
    else:
        if s.interval[l] + 1 == s.npts[l]:  # the ground acceleration may jump to zero
            renew(s, l)
            stay_inside(s, l)
            observe_start(s, l)
        if s.audited > 0:
            store_sample(s, l, systems, output)
        if s.interval[l] >= s.intervals[l] or is_over(s, l, systems):
            return True
        if s.steps[l] > system.most_steps:
            s.outcome[l] = FAILED_TOO_MANY_STEPS
            return True
    s.h[l] = plan(s, l)
    if s.kinks[l] > 0.0 and s.moves[l] > 0.0:
        s.h[l] = min(s.h[l], kink_limit(s, l))
    return False


@compiled
def switch(s: Record, l: int, systems: Record, log: Record, kind: int) -> None:
    """Let the event happen on which the step ended."""
    for event in EVENTS:
        if kind == event.kind:
            event.happens(s, l, systems, log)


@compiled
def review_laws(s: Record, l: int, systems: Record, kind: int) -> None:
    """Velocities may have jumped: storeys may no longer yield, own
    laws be on another branch.
    """
    if kind != YIELD and review_storeys(s, l, systems):
        renew(s, l)
    if kind != CHANGE:
        find_branches(s, l)


@compiled
def too_many(s: Record, l: int, system: Record) -> bool:
    """True if events pile up; sets the outcome."""
    events = 0
    for i in range(EVENT_KINDS):
        events += s.events[i, l]
    if events > system.max_events:
        s.outcome[l] = FAILED_TOO_MANY_EVENTS
    elif s.stalled[l] > STALL:
        s.outcome[l] = FAILED_STEP_TOO_SMALL
    elif s.steps[l] > system.most_steps:
        s.outcome[l] = FAILED_TOO_MANY_STEPS
    return bool(s.outcome[l] != RUNNING)


@compiled
def stay_inside(s: Record, l: int) -> None:
    """Have the next step begin within its range: of a tilt to any side
    x is a root, and rounded.
    """
    # after all that renews it: one that is below its range by rounding would pass upright
    # at once
    if s.phase[l] != FULL_CONTACT:
        s.x[l] = min(max(s.x[l], s.x_low[l]), s.x_high[l])
