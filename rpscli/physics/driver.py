"""Histories in lanes: step - search - observe - take over - switch.

Each lane follows one history at a time; when it is over the lane takes the next one. All lanes
make their Runge-Kutta steps together, each from its own time with its own length, so that the
processor works on them at once; whatever is particular to one - full contact, the location of an
event, a switch of phase - is done for that lane alone. No number passes from one lane to another:
a history does not depend on its neighbours.
"""

from __future__ import annotations

import math

import numpy as np

from rpscli.physics.acceleration import accelerate
from rpscli.physics.contact import SHAPES, load_modes
from rpscli.physics.energy import building_energy, uplifted_energy
from rpscli.physics.flight import attend, go_on, plan_step, set_step, settle, watch_peak
from rpscli.physics.inspection import observe, search_events, take_over
from rpscli.physics.jit import kernel, part
from rpscli.physics.layout import (
    ACCELERATION,
    AHEAD,
    AHEAD_ACCELERATION,
    AHEAD_RATE,
    AT_REST,
    BEAM,
    BLOCKS,
    BUILDING,
    CAP_BEAM_MASS,
    COLUMNS_MASS,
    CONTACT_STEP,
    COUNTS,
    CREATED,
    CREATING,
    CRITICAL_TIME,
    DAMPED,
    DAMPING,
    DIAMETER,
    DRAG,
    EVALUATIONS,
    EVENT_KINDS,
    FLIGHT_STEP,
    FLOOR_ACCELERATION,
    FLOORS_MASS,
    FRESH,
    FRICTION_BOTTOM,
    FRICTION_TOP,
    FULL_CONTACT,
    INERTIA,
    INPUT,
    INTERVAL,
    INTERVAL_LENGTH,
    INTERVALS,
    INVERSE_MASS,
    LEANING,
    LOST,
    MASS,
    MOTION,
    NO_POINT,
    NORMAL_BOTTOM,
    NORMAL_TOP,
    NPTS,
    OUT_COUNTS,
    OUT_CREATED,
    OUT_CREATING,
    OUT_CRITICAL_TIME,
    OUT_DAMPED,
    OUT_EVALUATIONS,
    OUT_FLOORS,
    OUT_FRICTION_BOTTOM,
    OUT_FRICTION_TOP,
    OUT_INPUT,
    OUT_INTERVALS,
    OUT_LOST,
    OUT_MOTION,
    OUT_NORMAL_BOTTOM,
    OUT_NORMAL_TOP,
    OUT_OUTCOME,
    OUT_PEAK,
    OUT_PEAK_TIME,
    OUT_ROTATION,
    OUT_STORED,
    OUT_TIME,
    OUTCOME,
    PEAK,
    PEAK_TIME,
    POINT,
    POSITION,
    PUSH,
    QUIET,
    RECORD,
    ROCKING,
    ROLLING,
    RUNNING,
    SCALARS,
    SCALE,
    SHEAR,
    SIDE,
    STALE,
    STANDARD_GRAVITY,
    STIFFNESS,
    STOREY_SHEAR,
    SURVIVED,
    THETA_CR,
    UPLIFT,
    VELOCITY,
    VERTICAL,
    WEIGHT,
    WHOLE_NUMBERS,
)
from rpscli.physics.parameters import (
    Floats,
    Lanes,
    Motions,
    Podium,
    Points,
    Results,
    Shape,
    Systems,
)
from rpscli.physics.progress import store_sample
from rpscli.physics.runge_kutta import EVALUATIONS as EVALUATIONS_OF_A_STEP
from rpscli.physics.runge_kutta import step
from rpscli.physics.shaking import shake
from rpscli.physics.standing import observe_contact, stand, to_floors
from rpscli.physics.switch import enter_phase, now
from rpscli.physics.table import podium_of


@kernel
def integrate(
    systems: Systems, motions: Motions, points: Points, shape: Shape, results: Results
) -> None:
    """Follow every history of `points` from rest; writes `results`.

    Parameters
    ----------
    systems, motions, points
        What to run.
    shape
        Sizes: n must be that of the systems, the lanes at least one.
    """
    n, L = len(shape.floors), len(shape.stride)
    rows = SCALARS + BLOCKS * (n + 1) + (n * n if len(shape.dense) > 0 else 0)
    lanes = Lanes(
        np.zeros(rows * L),
        np.zeros((L, WHOLE_NUMBERS), np.int64),
        np.zeros((L, systems.podium.shape[1])),
        np.zeros((L, SHAPES + 2 * n, n)),
        np.zeros(6),
        motions.acceleration,
        results.samples,
        results.log,
    )
    b, whole = lanes.buffer, lanes.integers
    for l in range(L):
        whole[l, POINT] = NO_POINT
    waiting, active, started = 0, L, False
    while active > 0:
        if started:
            step(b, shape, (n + 1) * L)
            search_events(b, shape)
            for l in range(L):
                if b[QUIET * L + l] > 0.0:
                    watch_peak(lanes, shape, l)
            observe(b, shape)
            take_over(b, shape)
        for l in range(L):
            flies = False
            if started:
                if whole[l, POINT] == NO_POINT:
                    continue
                whole[l, EVALUATIONS] += EVALUATIONS_OF_A_STEP
                quiet = b[QUIET * L + l] > 0.0
                flies = go_on(lanes, shape, l) if quiet else attend(lanes, shape, l)
            while not flies or b[STALE * L + l] != FRESH:
                if flies:
                    refresh(lanes, shape, l)
                    flies = settle(lanes, shape, l)
                    continue
                if whole[l, POINT] != NO_POINT:
                    finish(lanes, shape, l, results)
                waiting = engage(lanes, shape, l, waiting, systems, motions, points, results)
                flies = True
            active -= whole[l, POINT] == NO_POINT
        started = True


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
    accelerate(b, alone(shape), l, 0, 0.0)
    for c in range(n + 1):
        acceleration = b[(SCALARS + AHEAD_ACCELERATION * (n + 1) + c) * L + l]
        b[(SCALARS + ACCELERATION * (n + 1) + c) * L + l] = acceleration
    lanes.integers[l, EVALUATIONS] += 1


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
    motions: Motions,
    points: Points,
    results: Results,
) -> int:
    """Give a lane the next history that uplifts; returns the number of the one after it.

    Histories that stay in full contact to their end are finished on the way. A lane for which
    there is none left is marked by NO_POINT and makes empty steps.
    """
    L = len(shape.stride)
    b = lanes.buffer
    while waiting < points.system.shape[0]:
        begin(lanes, shape, l, waiting, systems, motions, points)
        waiting += 1
        rotation = podium_of(lanes.podium, l).initial_rotation
        if rotation != 0.0:
            lean(lanes, shape, l, rotation)
            plan_step(b, shape, l)
            return waiting
        store_sample(lanes, shape, l)
        observe_contact(lanes, L, l)
        if stand(lanes, shape, l):
            plan_step(b, shape, l)
            return waiting
        finish(lanes, shape, l, results)
    lanes.integers[l, POINT] = NO_POINT
    b[STALE * L + l] = FRESH
    set_step(b, shape, l, 0.0)
    return waiting


@part
def begin(
    lanes: Lanes,
    shape: Shape,
    l: int,
    point: int,
    systems: Systems,
    motions: Motions,
    points: Points,
) -> None:
    """Load a history into a lane, at rest in full contact at the start of its record."""
    L = len(shape.stride)
    b, whole = lanes.buffer, lanes.integers
    for row in range(b.shape[0] // L):
        b[row * L + l] = 0.0
    for i in range(WHOLE_NUMBERS):
        whole[l, i] = 0
    s, motion, vertical = points.system[point], points.motion[point], points.vertical[point]
    for i in range(lanes.podium.shape[1]):
        lanes.podium[l, i] = systems.podium[s, i]
    podium = podium_of(lanes.podium, l)
    dt = motions.dt[motion]
    whole[l, POINT], whole[l, OUTCOME] = point, RUNNING
    whole[l, MOTION], whole[l, RECORD] = FULL_CONTACT, motions.start[motion]
    whole[l, NPTS] = motions.npts[motion]
    whole[l, VERTICAL] = motions.start[vertical] if vertical >= 0 else -1
    free = math.ceil(podium.free_vibration / dt - 1e-9)
    whole[l, INTERVALS] = motions.npts[motion] - 1 + free
    load_podium(b, L, l, podium)
    load_floors(b, shape, l, podium.a1, systems, s)
    b[SCALE * L + l], b[INTERVAL_LENGTH * L + l] = points.scale[point], dt
    b[FLIGHT_STEP * L + l] = dt / max(math.ceil(dt * podium.flight_rate), 1)
    b[CONTACT_STEP * L + l] = dt / max(math.ceil(dt * podium.contact_rate), 1)
    load_modes(systems, s, lanes.modes[l], b[CONTACT_STEP * L + l])
    shake(lanes, L, l)


@part
def load_podium(b: Floats, L: int, l: int, podium: Podium) -> None:
    """Fold the constants of the rocking storey."""
    gamma, eta = podium.gamma, podium.eta
    own = 1.0 + 2.0 * gamma
    b[DIAMETER * L + l] = 2.0 * podium.R
    b[INERTIA * L + l] = podium.Io - 1.0
    b[BEAM * L + l] = 1.0 + 4.0 * gamma
    b[BUILDING * L + l] = 4.0 * gamma * eta
    b[WEIGHT * L + l] = (own + 2.0 * gamma * eta) / podium.R
    b[PUSH * L + l] = own / podium.R
    b[SHEAR * L + l] = 2.0 / (podium.columns_mass * podium.R)
    b[DRAG * L + l] = podium.a0
    b[COLUMNS_MASS * L + l] = podium.columns_mass
    b[CAP_BEAM_MASS * L + l] = podium.cap_beam_mass
    b[FLOORS_MASS * L + l] = podium.floors_mass
    b[STANDARD_GRAVITY * L + l] = podium.gravity
    b[THETA_CR * L + l] = podium.theta_cr
    b[SIDE * L + l] = 1.0
    b[CRITICAL_TIME * L + l] = -1.0
    b[NORMAL_TOP * L + l], b[NORMAL_BOTTOM * L + l] = math.inf, math.inf


@part
def load_floors(b: Floats, shape: Shape, l: int, a1: float, systems: Systems, s: int) -> None:
    """Masses, stiffnesses and damping of the floors."""
    n, L = len(shape.floors), len(shape.stride)
    for i in range(n):
        b[(SCALARS + STIFFNESS * (n + 1) + i) * L + l] = systems.stiffness[s, i]
        b[(SCALARS + DAMPING * (n + 1) + i) * L + l] = a1 * systems.stiffness[s, i]
        b[(SCALARS + MASS * (n + 1) + i) * L + l] = systems.mass[s, i]
        b[(SCALARS + INVERSE_MASS * (n + 1) + i) * L + l] = systems.inverse_mass[s, i]
    if len(shape.dense) > 0:
        matrix = SCALARS + BLOCKS * (n + 1)
        for i in range(n):
            for j in range(n):
                b[(matrix + i * n + j) * L + l] = systems.damping[s, i, j]


@part
def lean(lanes: Lanes, shape: Shape, l: int, rotation: float) -> None:
    """Start from rest at a rotation, the building unstrained."""
    n, L = len(shape.floors), len(shape.stride)
    b = lanes.buffer
    podium = podium_of(lanes.podium, l)
    b[SIDE * L + l] = math.copysign(1.0, rotation)
    b[(SCALARS + POSITION * (n + 1)) * L + l] = abs(rotation)
    b[PEAK * L + l] = abs(rotation)
    enter_phase(lanes, L, l, podium, ROLLING if abs(rotation) < podium.beta else ROCKING)
    b[STALE * L + l] = LEANING


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
    for column, row in (
        (OUT_PEAK, PEAK),
        (OUT_PEAK_TIME, PEAK_TIME),
        (OUT_CRITICAL_TIME, CRITICAL_TIME),
        (OUT_FRICTION_TOP, FRICTION_TOP),
        (OUT_FRICTION_BOTTOM, FRICTION_BOTTOM),
        (OUT_NORMAL_TOP, NORMAL_TOP),
        (OUT_NORMAL_BOTTOM, NORMAL_BOTTOM),
        (OUT_INPUT, INPUT),
        (OUT_DAMPED, DAMPED),
        (OUT_LOST, LOST),
        (OUT_CREATED, CREATED),
    ):
        numbers[column] = b[row * L + l]
    numbers[OUT_STORED] = stored
    for i in range(n):
        numbers[OUT_FLOORS + i] = b[(SCALARS + STOREY_SHEAR * (n + 1) + i) * L + l]
        numbers[OUT_FLOORS + n + i] = b[(SCALARS + FLOOR_ACCELERATION * (n + 1) + i) * L + l]
    integers[OUT_OUTCOME], integers[OUT_MOTION] = whole[l, OUTCOME], whole[l, MOTION]
    integers[OUT_INTERVALS] = whole[l, INTERVAL]
    integers[OUT_EVALUATIONS] = whole[l, EVALUATIONS]
    integers[OUT_CREATING] = whole[l, CREATING]
    for i in range(EVENT_KINDS):
        integers[OUT_COUNTS + i] = whole[l, COUNTS + i]
