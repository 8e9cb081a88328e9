"""Energy of a lane, relative to the ground (Theory, section 8)."""

from __future__ import annotations

from rpscli.physics.geometry import Phase
from rpscli.physics.lane import Lane
from rpscli.physics.layout import (
    ARC,
    ARM_COS,
    ARM_SIN,
    BEAM,
    BUILDING,
    CAP_BEAM_MASS,
    COLUMNS_MASS,
    DIAMETER,
    FLOORS_MASS,
    INERTIA,
    LIFT_START,
    MASS,
    PATH_START,
    POSITION,
    SIDE,
    STANDARD_GRAVITY,
    STIFFNESS,
    VELOCITY,
)
from rpscli.physics.parameters import Floats
from rpscli.physics.part import part, routine
from rpscli.physics.tilt import (
    cap_beam_displacement,
    cap_beam_lift,
    lever_arm,
    path_height,
    tilt_inertia,
)
from rpscli.physics.trigonometry import sine_cosine


@part
def building_energy(x: Floats, base: float) -> float:
    """Kinetic and strain energy of the floors [J], the cap beam standing at u_b = base.

    `x` are the blocks of the lane.
    """
    energy, below = 0.0, base
    for i in range(x.shape[1] - 1):
        u, du = x[POSITION, i + 1], x[VELOCITY, i + 1]
        energy += 0.5 * (x[MASS, i] * (du * du) + x[STIFFNESS, i] * ((u - below) * (u - below)))
        below = u
    return energy


@routine
def uplifted_energy(lane: Lane) -> float:
    """Kinetic, strain and potential energy of the uplifted structure [J]."""
    s, tilt, rate = lane.numbers, lane.blocks[POSITION, 0], lane.blocks[VELOCITY, 0]
    sine, cosine = sine_cosine(tilt)
    phase = Phase(s[ARM_COS], s[ARM_SIN], s[ARC], s[PATH_START], s[LIFT_START])
    B, C = lever_arm(phase, cosine, sine), path_height(phase, cosine, sine)
    A = tilt_inertia(s[INERTIA], s[BEAM], s[BUILDING], phase, B, C)
    diameter, columns = s[DIAMETER], s[COLUMNS_MASS]
    mass = 0.5 * columns + s[CAP_BEAM_MASS] + s[FLOORS_MASS]
    lifted = mass * s[STANDARD_GRAVITY] * diameter * cap_beam_lift(phase, cosine, sine)
    tilting = 0.125 * columns * (diameter * diameter) * A * (rate * rate)
    base = s[SIDE] * diameter * cap_beam_displacement(phase, tilt, cosine, sine)
    return float(tilting + lifted) + building_energy(lane.blocks, base)
