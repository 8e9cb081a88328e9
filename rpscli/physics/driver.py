"""Histories in lanes: step - search - observe - take over - switch.

Each lane follows one history at a time; when it is over the lane takes the next one. All lanes
make their Runge-Kutta steps together, each from its own time with its own length, so that the
processor works on them at once; whatever is particular to one - full contact, the location of an
event, a switch of phase - is done for that lane alone. No number passes from one lane to another:
a history does not depend on its neighbours.
"""

from __future__ import annotations

from rpscli.physics.acceleration import accelerate
from rpscli.physics.energy import building_energy, uplifted_energy
from rpscli.physics.flight import attend, book_energy, plan_step, set_step, settle
from rpscli.physics.inspection import observe, raise_contacts, search_events, take_over
from rpscli.physics.jit import kernel, part
from rpscli.physics.layout import (
    ACCELERATION,
    ACROSS,
    AHEAD,
    AHEAD_ACCELERATION,
    AHEAD_RATE,
    AT_REST,
    ATTEND,
    COUNTS,
    CREATING,
    EVALUATIONS,
    EVENT_KINDS,
    FLOOR_ACCELERATION,
    FRESH,
    FULL_CONTACT,
    GIVEN,
    GIVEN_FIRST,
    GROUND,
    GROUND_UPWARDS,
    INTERVAL,
    MOTION,
    NO_POINT,
    OUT_COUNTS,
    OUT_CREATING,
    OUT_EVALUATIONS,
    OUT_FLOORS,
    OUT_INTERVALS,
    OUT_MOTION,
    OUT_OUTCOME,
    OUT_PEAK,
    OUT_ROTATION,
    OUT_STORED,
    OUT_TIME,
    OUTCOME,
    PEAK,
    POINT,
    POSITION,
    QUIET,
    RUNNING,
    SCALARS,
    SIDE,
    STALE,
    STOREY_SHEAR,
    SURVIVED,
    TAKEN,
    TAKEN_FIRST,
    UPLIFT,
    UPWARDS,
    VELOCITY,
    WATCH,
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
from rpscli.physics.peak import watch_peak
from rpscli.physics.progress import store_sample
from rpscli.physics.runge_kutta import step
from rpscli.physics.standing import stand, to_floors
from rpscli.physics.switch import now
from rpscli.physics.table import podium_of
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
    b, whole = lanes.buffer, lanes.integers
    for l in range(L):
        whole[l, POINT] = NO_POINT
    waiting, active, started = 0, L, False
    while active > 0:
        if started:
            advance(lanes, shape)
        for l in range(L):
            if started and (whole[l, POINT] == NO_POINT or b[ATTEND * L + l] == 0.0):
                continue
            flies = started and attend(lanes, shape, l)
            while not flies or b[STALE * L + l] != FRESH:
                if flies:
                    refresh(lanes, shape, l)
                    flies = settle(lanes, shape, l)
                    continue
                if whole[l, POINT] != NO_POINT:
                    finish(lanes, shape, l, results)
                waiting = engage(lanes, shape, l, waiting, systems, points, results)
                flies = True
            active -= whole[l, POINT] == NO_POINT
        started = True


@part
def advance(lanes: Lanes, shape: Shape) -> None:
    """Take a step in all lanes, and what needs no decision: most steps hold no event."""
    L = len(shape.stride)
    b = lanes.buffer
    step(b, shape, (len(shape.floors) + 1) * L)
    search_events(b, shape)
    for l in range(L):
        if b[WATCH * L + l] > 0.0:
            watch_peak(lanes, shape, l)
    observe(b, shape)
    take_over(b, shape)
    if len(shape.audit) > 0:
        for l in range(L):
            if b[QUIET * L + l] > 0.0:
                book_energy(b, shape, l)


@part
def refresh(lanes: Lanes, shape: Shape, l: int) -> None:
    """Accelerations of one lane at its present state and time."""
    n, L = len(shape.floors), len(shape.stride)
    b = lanes.buffer
    for c in range(n + 1):
        position = b[(SCALARS + POSITION * (n + 1) + c) * L + l]
        velocity = b[(SCALARS + VELOCITY * (n + 1) + c) * L + l]
        b[(SCALARS + AHEAD * (n + 1) + c) * L + l] = position
        b[(SCALARS + AHEAD_RATE * (n + 1) + c) * L + l] = velocity
    accelerate(b, alone(shape), l, 0.0)
    for c in range(n + 1):
        acceleration = b[(SCALARS + AHEAD_ACCELERATION * (n + 1) + c) * L + l]
        b[(SCALARS + ACCELERATION * (n + 1) + c) * L + l] = acceleration
    b[EVALUATIONS * L + l] += 1.0
    b[GIVEN_FIRST * L + l], b[TAKEN_FIRST * L + l] = b[GIVEN * L + l], b[TAKEN * L + l]


@kernel
def alone(shape: Shape) -> Shape:
    """The same sizes for one lane of many."""
    return Shape(shape.floors, shape.stride, (0,), (0,), shape.audit, shape.dense)


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
    b = lanes.buffer
    while waiting < points.integers.shape[0]:
        begin(lanes, shape, l, waiting, systems, points)
        waiting += 1
        rotation = podium_of(lanes.podium, l).initial_rotation
        if rotation != 0.0:
            lean(lanes, shape, l, rotation)
            plan_step(b, shape, l)
            return waiting
        store_sample(lanes, shape, l)
        b[GROUND * L + l], b[GROUND_UPWARDS * L + l] = b[ACROSS * L + l], b[UPWARDS * L + l]
        raise_contacts(b, L, l, 1.0, 0.0, 0.0, 0.0)
        if stand(lanes, shape, l):
            plan_step(b, shape, l)
            return waiting
        finish(lanes, shape, l, results)
    lanes.integers[l, POINT] = NO_POINT
    b[STALE * L + l] = FRESH
    set_step(b, shape, l, 0.0)
    return waiting


@part
def finish(lanes: Lanes, shape: Shape, l: int, results: Results) -> None:
    """Write what the history leaves behind."""
    n, L = len(shape.floors), len(shape.stride)
    b, whole = lanes.buffer, lanes.integers
    if whole[l, MOTION] == FULL_CONTACT:
        to_floors(lanes, L, l)
        stored = building_energy(b, n, L, l, 0.0)
    else:
        stored = uplifted_energy(b, n, L, l)
    if whole[l, OUTCOME] == RUNNING:
        released = podium_of(lanes.podium, l).initial_rotation != 0.0
        moved = released or whole[l, COUNTS + UPLIFT] > 0
        whole[l, OUTCOME] = SURVIVED if moved else AT_REST
    numbers, integers = results.numbers[whole[l, POINT]], results.integers[whole[l, POINT]]
    numbers[OUT_TIME] = now(lanes, L, l)
    numbers[OUT_ROTATION] = b[SIDE * L + l] * b[(SCALARS + POSITION * (n + 1)) * L + l]
    for i in range(OUT_FLOORS - OUT_PEAK):
        numbers[OUT_PEAK + i] = b[(PEAK + i) * L + l]
    numbers[OUT_STORED] = stored
    for i in range(n):
        numbers[OUT_FLOORS + i] = b[(SCALARS + STOREY_SHEAR * (n + 1) + i) * L + l]
        numbers[OUT_FLOORS + n + i] = b[(SCALARS + FLOOR_ACCELERATION * (n + 1) + i) * L + l]
    integers[OUT_OUTCOME], integers[OUT_MOTION] = whole[l, OUTCOME], whole[l, MOTION]
    integers[OUT_INTERVALS] = whole[l, INTERVAL]
    integers[OUT_EVALUATIONS] = int(b[EVALUATIONS * L + l])
    integers[OUT_CREATING] = whole[l, CREATING]
    for i in range(EVENT_KINDS):
        integers[OUT_COUNTS + i] = whole[l, COUNTS + i]
