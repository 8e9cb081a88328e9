"""Acceleration of the tilt and pull of the building's modes, for several lanes at once.

Uplifted as in full contact the building is followed in the modes of its fixed base, relative to the
cap beam: v = Phi q with mass-normalised shapes and Gamma = Phi^T M 1 (Theory, section 2)

    q_r'' + 2 xi_r w_r q_r' + w_r^2 q_r = -Gamma_r (a_g + u_b''),    V = sum_r Gamma_r pull_r,

pull_r = w_r^2 q_r + 2 xi_r w_r q_r'. What couples the modes is the motion of the cap beam alone, so
a storey more costs one mode more and no matrix is formed.
"""

from __future__ import annotations

from rpscli.physics.geometry import Phase
from rpscli.physics.lanes import first_lane, floor_count, lane_count
from rpscli.physics.layout import (
    ACROSS,
    ACROSS_SLOPE,
    ARC,
    ARM_COS,
    ARM_SIN,
    BEAM,
    BUILDING,
    DRAG,
    GROUND,
    GROUND_UPWARDS,
    INERTIA,
    LIFT_START,
    NEXT_BASE_SHEAR,
    NEXT_DQ,
    NEXT_HEIGHT,
    NEXT_LEVER,
    NEXT_PER_INERTIA,
    NEXT_Q,
    NEXT_RATE,
    NEXT_TILT,
    NEXT_TURN,
    PARTICIPATION,
    PATH_START,
    PULL,
    PUSH,
    SCALARS,
    SHEAR,
    SIDE,
    SQUARE,
    STEP,
    TIME,
    UPWARDS,
    UPWARDS_SLOPE,
    WEIGHT,
)
from rpscli.physics.parameters import Floats, Shape
from rpscli.physics.part import lane_routine, part
from rpscli.physics.tilt import (
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
def accelerate(b: Floats, shape: Shape, lane: int, elapsed: float) -> None:
    """Acceleration of the tilt and pull of the modes at the end of the step.

    Parameters
    ----------
    b
        Lane buffer. Read: rows NEXT_TILT and NEXT_RATE, blocks NEXT_Q and NEXT_DQ;
        written: the other rows of the end, GROUND, GROUND_UPWARDS and the block PULL.
    shape, lane
        All lanes, or only the lane `lane` if `shape.alone`.
    elapsed
        1; or 0 where the step was not taken yet, so that its end is its start.
    """
    n, L = floor_count(shape), len(shape.stride)
    first = first_lane(shape, lane)
    last = first + lane_count(shape)
    for l in range(first, last):
        b[NEXT_BASE_SHEAR * L + l] = 0.0
    for r in range(n):
        row = (SCALARS + r) * L
        for l in range(first, last):
            pull = (
                b[row + SQUARE * n * L + l] * b[row + NEXT_Q * n * L + l]
                + b[row + DRAG * n * L + l] * b[row + NEXT_DQ * n * L + l]
            )
            b[row + PULL * n * L + l] = pull
            b[NEXT_BASE_SHEAR * L + l] += b[row + PARTICIPATION * n * L + l] * pull
    for l in range(first, last):
        x, rate = b[NEXT_TILT * L + l], b[NEXT_RATE * L + l]
        sin_x, cos_x = sine_cosine(x)
        phase = phase_in(b, L, l)
        B, C = lever_arm(phase, cos_x, sin_x), path_height(phase, cos_x, sin_x)
        time = b[TIME * L + l] + elapsed * b[STEP * L + l]
        ground = b[ACROSS * L + l] + b[ACROSS_SLOPE * L + l] * time
        upwards = b[UPWARDS * L + l] + b[UPWARDS_SLOPE * L + l] * time
        beam, building = b[BEAM * L + l], b[BUILDING * L + l]
        per_inertia = 1.0 / tilt_inertia(b[INERTIA * L + l], beam, building, phase, B, C)
        D = tilt_inertia_slope(beam, building, phase, B, C)
        action = ground * b[PUSH * L + l] - b[NEXT_BASE_SHEAR * L + l] * b[SHEAR * L + l]
        b[NEXT_TURN * L + l] = tilt_acceleration(
            per_inertia,
            restoring(D, B, rate, upwards * b[WEIGHT * L + l]),
            C,
            b[SIDE * L + l] * action,
        )
        b[NEXT_LEVER * L + l] = B
        b[NEXT_HEIGHT * L + l] = C
        b[NEXT_PER_INERTIA * L + l] = per_inertia
        b[GROUND * L + l] = ground
        b[GROUND_UPWARDS * L + l] = upwards
