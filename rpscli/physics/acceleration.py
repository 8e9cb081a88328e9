"""Accelerations of the uplifted structure, for several lanes at once."""

from __future__ import annotations

from rpscli.physics.geometry import Phase
from rpscli.physics.lanes import first_lane, floor_count, lane_count
from rpscli.physics.layout import (
    ACROSS,
    ACROSS_SLOPE,
    AHEAD,
    AHEAD_ACCELERATION,
    AHEAD_RATE,
    ARC,
    ARM_COS,
    ARM_SIN,
    BASE,
    BASE_RATE,
    BASE_SHEAR,
    BEAM,
    BLOCKS,
    BUILDING,
    CAP_BEAM_MASS,
    COLUMNS_MASS,
    DAMPING,
    DIAMETER,
    DRAG,
    DRIVE,
    FLOORS_MASS,
    FORCE,
    GIVEN,
    GROUND,
    GROUND_UPWARDS,
    HEIGHT,
    INERTIA,
    INVERSE_MASS,
    LEVER,
    LIFT_START,
    MASS,
    MOMENTUM,
    PATH_START,
    PER_INERTIA,
    PUSH,
    RESTORING,
    SCALARS,
    SHEAR,
    SIDE,
    STANDARD_GRAVITY,
    STEP,
    STIFFNESS,
    TAKEN,
    TIME,
    UPWARDS,
    UPWARDS_SLOPE,
    WEIGHT,
)
from rpscli.physics.parameters import Floats, Shape
from rpscli.physics.part import lane_routine, part
from rpscli.physics.tilt import (
    cap_beam_displacement,
    lever_arm,
    path_height,
    restoring,
    tilt_acceleration,
    tilt_inertia,
    tilt_inertia_slope,
)
from rpscli.physics.trigonometry import sine_cosine


@part
def phase_in(b: Floats, L: int, l: int) -> Phase:
    """Constants of the phase of motion of a lane."""
    return Phase(
        b[ARM_COS * L + l],
        b[ARM_SIN * L + l],
        b[ARC * L + l],
        b[PATH_START * L + l],
        b[LIFT_START * L + l],
    )


@lane_routine
def accelerate(b: Floats, shape: Shape, lane: int, fraction: float) -> None:
    """Accelerations of tilt and floors at a stage of a step.

    Parameters
    ----------
    b
        Lane buffer. Read: blocks AHEAD and AHEAD_RATE; written: AHEAD_ACCELERATION and the rows
        BASE to GROUND_UPWARDS.
    shape, lane
        All lanes, or only the lane `lane` if `shape.alone`.
    fraction
        Where in the step the stage stands.

    Notes
    -----
    M u'' = -M 1 a_g - K v - C v', v = u - 1 u_b (Theory, section 2). Each storey pulls on the
    floor above and below it: K is never formed.
    """
    n, L = floor_count(shape), len(shape.stride)
    first = first_lane(shape, lane)
    last = first + lane_count(shape)
    ddu = (SCALARS + AHEAD_ACCELERATION * (n + 1)) * L
    move_base(b, shape, lane, fraction)
    stretch_storeys(b, shape, lane)
    move_floors(b, shape, lane)
    if len(shape.dense) > 0:
        drag_floors(b, shape, lane)
    for l in range(first, last):
        action = b[GROUND * L + l] * b[PUSH * L + l] - b[BASE_SHEAR * L + l] * b[SHEAR * L + l]
        b[ddu + l] = tilt_acceleration(
            b[PER_INERTIA * L + l],
            b[RESTORING * L + l],
            b[HEIGHT * L + l],
            b[SIDE * L + l] * action,
        )
    if len(shape.audit) > 0:
        note_powers(b, shape, lane)


@part
def move_base(b: Floats, shape: Shape, lane: int, fraction: float) -> None:
    """Where the cap beam is, how the ground shakes, and what follows for the tilt from these."""
    n, L = floor_count(shape), len(shape.stride)
    u, du = (SCALARS + AHEAD * (n + 1)) * L, (SCALARS + AHEAD_RATE * (n + 1)) * L
    first = first_lane(shape, lane)
    for l in range(first, first + lane_count(shape)):
        x = b[u + l]
        sin_x, cos_x = sine_cosine(x)
        phase = phase_in(b, L, l)
        B, C, rate = lever_arm(phase, cos_x, sin_x), path_height(phase, cos_x, sin_x), b[du + l]
        across = b[SIDE * L + l] * b[DIAMETER * L + l]
        base_rate = across * C * rate
        time = b[TIME * L + l] + fraction * b[STEP * L + l]
        ground = b[ACROSS * L + l] + b[ACROSS_SLOPE * L + l] * time
        upwards = b[UPWARDS * L + l] + b[UPWARDS_SLOPE * L + l] * time
        beam, building = b[BEAM * L + l], b[BUILDING * L + l]
        A = tilt_inertia(b[INERTIA * L + l], beam, building, phase, B, C)
        D = tilt_inertia_slope(beam, building, phase, B, C)
        b[PER_INERTIA * L + l] = 1.0 / A
        b[RESTORING * L + l] = restoring(D, B, rate, upwards * b[WEIGHT * L + l])
        b[LEVER * L + l] = B
        b[HEIGHT * L + l] = C
        b[BASE * L + l] = across * cap_beam_displacement(phase, x, cos_x, sin_x)
        b[BASE_RATE * L + l] = base_rate
        b[GROUND * L + l] = ground
        b[GROUND_UPWARDS * L + l] = upwards
        b[DRIVE * L + l] = b[DRAG * L + l] * base_rate - ground
        b[MOMENTUM * L + l] = -b[FLOORS_MASS * L + l] * base_rate


@part
def stretch_storeys(b: Floats, shape: Shape, lane: int) -> None:
    """Spring and damper force of each storey; none above the roof.

    The floors' loop touches rows of floors only: all its rows move together, so the compiler sees
    that none overlaps another.
    """
    n, L = floor_count(shape), len(shape.stride)
    first = first_lane(shape, lane)
    last = first + lane_count(shape)
    u, du = (SCALARS + AHEAD * (n + 1)) * L, (SCALARS + AHEAD_RATE * (n + 1)) * L
    force = (SCALARS + FORCE * (n + 1)) * L
    k, c = (SCALARS + STIFFNESS * (n + 1)) * L, (SCALARS + DAMPING * (n + 1)) * L
    for l in range(first, last):
        b[force + n * L + l] = 0.0
    if n > 0:
        for l in range(first, last):
            drift, rate = b[u + L + l] - b[BASE * L + l], b[du + L + l] - b[BASE_RATE * L + l]
            b[force + l] = b[k + l] * drift + b[c + l] * rate
    for i in range(1, n):
        here, moves, f = u + (i + 1) * L, du + (i + 1) * L, force + i * L
        for l in range(first, last):
            drift, rate = b[here + l] - b[here - L + l], b[moves + l] - b[moves - L + l]
            b[f + l] = b[k + i * L + l] * drift + b[c + i * L + l] * rate


@part
def move_floors(b: Floats, shape: Shape, lane: int) -> None:
    """Accelerations of the floors, and the base shear V = 1^T (K v + C v')."""
    n, L = floor_count(shape), len(shape.stride)
    first = first_lane(shape, lane)
    last = first + lane_count(shape)
    du = (SCALARS + AHEAD_RATE * (n + 1)) * L
    ddu = (SCALARS + AHEAD_ACCELERATION * (n + 1)) * L
    force = (SCALARS + FORCE * (n + 1)) * L
    mass = (SCALARS + MASS * (n + 1)) * L
    inverse = (SCALARS + INVERSE_MASS * (n + 1)) * L
    for i in range(n):
        a, v, f, w = ddu + (i + 1) * L, du + (i + 1) * L, force + i * L, inverse + i * L
        for l in range(first, last):
            net = (b[f + l] - b[f + L + l]) * b[w + l]
            b[a + l] = b[DRIVE * L + l] - net - b[DRAG * L + l] * b[v + l]
    for i in range(n):
        v, m = du + (i + 1) * L, mass + i * L
        for l in range(first, last):
            b[MOMENTUM * L + l] += b[m + l] * b[v + l]
    for l in range(first, last):
        b[BASE_SHEAR * L + l] = b[force + l] + b[DRAG * L + l] * b[MOMENTUM * L + l]


@part
def drag_floors(b: Floats, shape: Shape, lane: int) -> None:
    """The same for a damping matrix that is not a0 M + a1 K: what it adds."""
    n, L = floor_count(shape), len(shape.stride)
    first = first_lane(shape, lane)
    last = first + lane_count(shape)
    du = (SCALARS + AHEAD_RATE * (n + 1)) * L
    ddu = (SCALARS + AHEAD_ACCELERATION * (n + 1)) * L
    matrix = SCALARS + BLOCKS * (n + 1)
    for i in range(n):
        a, inverse = ddu + (i + 1) * L, (SCALARS + INVERSE_MASS * (n + 1) + i) * L
        for j in range(n):
            w, c = du + (j + 1) * L, (matrix + i * n + j) * L
            for l in range(first, last):
                drag = b[c + l] * (b[w + l] - b[BASE_RATE * L + l])
                b[a + l] -= drag * b[inverse + l]
                b[BASE_SHEAR * L + l] += drag


@part
def note_powers(b: Floats, shape: Shape, lane: int) -> None:
    """Energy flows at the stage [W]: what the ground puts in, and what dampers take (Theory 8)."""
    n, L = floor_count(shape), len(shape.stride)
    first = first_lane(shape, lane)
    last = first + lane_count(shape)
    du = (SCALARS + AHEAD_RATE * (n + 1)) * L
    taken = TAKEN * L
    for l in range(first, last):
        base_rate = b[BASE_RATE * L + l]
        lifted = 0.5 * b[COLUMNS_MASS * L + l] + b[CAP_BEAM_MASS * L + l] + b[FLOORS_MASS * L + l]
        momentum = lifted * base_rate + b[MOMENTUM * L + l]
        lifting = b[DIAMETER * L + l] * b[LEVER * L + l] * b[du + l]
        upwards = b[GROUND_UPWARDS * L + l] - b[STANDARD_GRAVITY * L + l]
        given = b[GROUND * L + l] * momentum + upwards * lifted * lifting
        b[GIVEN * L + l] = -given
        b[taken + l] = 0.0
    for i in range(n):
        c, m = (SCALARS + DAMPING * (n + 1) + i) * L, (SCALARS + MASS * (n + 1) + i) * L
        v = du + (i + 1) * L
        below = du + i * L if i > 0 else BASE_RATE * L
        for l in range(first, last):
            sway, slip = b[v + l] - b[below + l], b[v + l] - b[BASE_RATE * L + l]
            b[taken + l] += b[c + l] * sway * sway + b[DRAG * L + l] * b[m + l] * slip * slip
    if len(shape.dense) > 0:
        matrix = SCALARS + BLOCKS * (n + 1)
        for i in range(n):
            for j in range(n):
                v, w, c = du + (i + 1) * L, du + (j + 1) * L, (matrix + i * n + j) * L
                for l in range(first, last):
                    slip, other = b[v + l] - b[BASE_RATE * L + l], b[w + l] - b[BASE_RATE * L + l]
                    b[taken + l] += b[c + l] * slip * other
