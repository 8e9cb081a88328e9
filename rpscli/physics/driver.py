"""Histories in lanes: step - search - observe - take over - switch.

Each lane follows one history at a time; when it is over the lane takes the next one. All lanes
make their Taylor steps together, each from its own time with its own length, so that the processor
works on them at once; whatever is particular to one - full contact, the location of an event, a
switch of phase - is done for that lane alone. No number passes from one lane to another: a history
does not depend on its neighbours.
"""

from __future__ import annotations

from rpscli.physics.acceleration import accelerate
from rpscli.physics.energy import book_energy, building_energy, uplifted_energy
from rpscli.physics.flight import attend, plan_step, settle
from rpscli.physics.floor_demands import raise_floors
from rpscli.physics.inspection import observe, raise_contacts, search_events, take_over
from rpscli.physics.jit import kernel
from rpscli.physics.lane import Lane, lane_of
from rpscli.physics.layout import (
    ACROSS,
    AT_REST,
    ATTEND,
    COUNTS,
    CREATING,
    DQ,
    EVENT_KINDS,
    FLOOR_ACCELERATION,
    FRESH,
    FULL_CONTACT,
    GROUND,
    GROUND_UPWARDS,
    INTERVAL,
    MOTION,
    NEXT_DQ,
    NEXT_Q,
    NEXT_RATE,
    NEXT_TILT,
    NO_POINT,
    OUT_COUNTS,
    OUT_CREATING,
    OUT_FLOORS,
    OUT_INTERVALS,
    OUT_MOTION,
    OUT_OUTCOME,
    OUT_PEAK,
    OUT_ROTATION,
    OUT_STEPS,
    OUT_STORED,
    OUT_TIME,
    OUTCOME,
    PEAK,
    POINT,
    QUIET,
    RAISE,
    RATE,
    RUNNING,
    SIDE,
    STALE,
    STATE,
    STEP,
    STEPS,
    STOREY_SHEAR,
    SURVIVED,
    TILT,
    UPLIFT,
    UPWARDS,
    WATCH,
    Q,
)
from rpscli.physics.loading import begin, lean
from rpscli.physics.parameters import (
    Floats,
    Lanes,
    Points,
    Results,
    Shape,
    Systems,
)
from rpscli.physics.part import part, routine
from rpscli.physics.peak import watch_peak
from rpscli.physics.podium_layout import INITIAL_ROTATION
from rpscli.physics.progress import store_sample
from rpscli.physics.series import step
from rpscli.physics.standing import from_modes, stand
from rpscli.physics.switch import now
from rpscli.physics.workspace import empty_lanes


def integrate(
    systems: Systems, acceleration: Floats, points: Points, shape: Shape, results: Results
) -> None:
    """Follow every history of `points` from rest; writes `results`.

    Parameters
    ----------
    systems, acceleration, points
        What to run: structures, records of the ground end to end, and which of them meet.
    shape
        Sizes: n must be that of the systems, the lanes at least one.
    """
    integrate_lanes(systems, points, shape, results, empty_lanes(acceleration, shape, results))


@kernel
def integrate_lanes(
    systems: Systems, points: Points, shape: Shape, results: Results, lanes: Lanes
) -> None:
    """The same, in lanes that are made already."""
    L = len(shape.stride)
    s, whole = lanes.numbers, lanes.integers
    for l in range(L):
        whole[l, POINT] = NO_POINT
    waiting, active, started = 0, L, False
    while active > 0:
        if started:
            advance(lanes, shape)
        for l in range(L):
            if started and (whole[l, POINT] == NO_POINT or s[l, ATTEND] == 0.0):
                continue
            flies = started and attend(lane_of(lanes, l), shape)
            while not flies or s[l, STALE] != FRESH:
                if flies:
                    refresh(lanes, shape, l)
                    flies = settle(lane_of(lanes, l), shape)
                    continue
                if whole[l, POINT] != NO_POINT:
                    finish(lane_of(lanes, l), results)
                waiting = engage(lanes, shape, l, waiting, systems, points, results)
                flies = True
            active -= whole[l, POINT] == NO_POINT
        started = True


@part
def advance(lanes: Lanes, shape: Shape) -> None:
    """Take a step in all lanes, and what needs no decision: most steps hold no event."""
    L = len(shape.stride)
    b, s = lanes.buffer, lanes.numbers
    step(b, shape)
    search_events(b, shape)
    if len(shape.audit) > 0:
        for l in range(L):
            if s[l, QUIET] > 0.0:
                book_energy(lane_of(lanes, l), shape, 1.0)
    observe(b, shape)
    raised = 0.0
    for l in range(L):
        if s[l, WATCH] > 0.0:
            watch_peak(lane_of(lanes, l))
        raised += s[l, RAISE]
    if raised > 0.0:
        raise_floors(b, shape)
    take_over(b, shape)


@part
def refresh(lanes: Lanes, shape: Shape, l: int) -> None:
    """Accelerations of one lane at its present state and time."""
    lane = lane_of(lanes, l)
    s, x = lane.numbers, lane.blocks
    s[NEXT_TILT], s[NEXT_RATE] = s[TILT], s[RATE]
    for r in range(x.shape[1]):
        x[NEXT_Q, r], x[NEXT_DQ, r] = x[Q, r], x[DQ, r]
    accelerate(lanes.buffer, alone(shape), l, 0.0)
    for i in range(STATE):
        s[TILT + i] = s[NEXT_TILT + i]


@part
def alone(shape: Shape) -> Shape:
    """The same sizes for one lane of many."""
    return Shape(shape.floors, shape.stride, ((),), ((),), shape.audit)


@part
def engage(
    lanes: Lanes,
    shape: Shape,
    l: int,
    waiting: int,
    systems: Systems,
    points: Points,
    results: Results,
) -> int:
    """Give a lane the next history that uplifts; returns the number of the one after it.

    Histories that stay in full contact to their end are finished on the way. A lane for which
    there is none left is marked by NO_POINT and makes empty steps.
    """
    L = len(shape.stride)
    lane = lane_of(lanes, l)
    s = lane.numbers
    while waiting < points.integers.shape[0]:
        begin(lanes, L, l, waiting, systems, points)
        waiting += 1
        rotation = lane.podium[INITIAL_ROTATION]
        if rotation != 0.0:
            lean(lane, rotation)
            plan_step(s)
            return waiting
        store_sample(lane)
        s[GROUND], s[GROUND_UPWARDS] = s[ACROSS], s[UPWARDS]
        raise_contacts(lanes.buffer, L, l, 1.0, 0.0, 0.0, 0.0)
        if stand(lane, shape):
            plan_step(s)
            return waiting
        finish(lane, results)
    lane.whole[POINT] = NO_POINT
    s[STALE], s[STEP] = FRESH, 0.0
    return waiting


@routine
def finish(lane: Lane, results: Results) -> None:
    """Write what the history leaves behind."""
    s, x, whole = lane.numbers, lane.blocks, lane.whole
    n = x.shape[1]
    numbers, integers = results.numbers[whole[POINT]], results.integers[whole[POINT]]
    if whole[MOTION] == FULL_CONTACT:
        from_modes(lane)
        numbers[OUT_STORED] = building_energy(lane, 0.0)
    else:
        numbers[OUT_STORED] = uplifted_energy(lane)
    if whole[OUTCOME] == RUNNING:
        moved = lane.podium[INITIAL_ROTATION] != 0.0 or whole[COUNTS + UPLIFT] > 0
        whole[OUTCOME] = SURVIVED if moved else AT_REST
    numbers[OUT_TIME] = now(lane)
    numbers[OUT_ROTATION] = s[SIDE] * s[TILT]
    for i in range(OUT_FLOORS - OUT_PEAK):
        numbers[OUT_PEAK + i] = s[PEAK + i]
    for i in range(n):
        numbers[OUT_FLOORS + i] = x[STOREY_SHEAR, i]
        numbers[OUT_FLOORS + n + i] = x[FLOOR_ACCELERATION, i]
    integers[OUT_OUTCOME], integers[OUT_MOTION] = whole[OUTCOME], whole[MOTION]
    integers[OUT_INTERVALS] = whole[INTERVAL]
    integers[OUT_STEPS] = int(s[STEPS])
    integers[OUT_CREATING] = whole[CREATING]
    for i in range(EVENT_KINDS):
        integers[OUT_COUNTS + i] = whole[COUNTS + i]
