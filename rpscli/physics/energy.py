"""Energy of a lane, relative to the ground (Theory, section 8)."""

from __future__ import annotations

from rpscli.physics.acceleration import phase_in
from rpscli.physics.jit import kernel
from rpscli.physics.layout import (
    BEAM,
    BUILDING,
    CAP_BEAM_MASS,
    COLUMNS_MASS,
    DIAMETER,
    FLOORS_MASS,
    INERTIA,
    MASS,
    POSITION,
    SCALARS,
    SIDE,
    STANDARD_GRAVITY,
    STIFFNESS,
    VELOCITY,
)
from rpscli.physics.parameters import Floats
from rpscli.physics.tilt import (
    cap_beam_displacement,
    cap_beam_lift,
    lever_arm,
    path_height,
    tilt_inertia,
)
from rpscli.physics.trigonometry import sine_cosine


@kernel
def building_energy(b: Floats, n: int, L: int, l: int, base: float) -> float:
    """Kinetic and strain energy of the floors [J], the cap beam standing at u_b = base."""
    energy, below = 0.0, base
    for i in range(n):
        u = b[(SCALARS + POSITION * (n + 1) + i + 1) * L + l]
        du = b[(SCALARS + VELOCITY * (n + 1) + i + 1) * L + l]
        m = b[(SCALARS + MASS * (n + 1) + i) * L + l]
        k = b[(SCALARS + STIFFNESS * (n + 1) + i) * L + l]
        energy += 0.5 * (m * (du * du) + k * ((u - below) * (u - below)))
        below = u
    return energy


@kernel
def uplifted_energy(b: Floats, n: int, L: int, l: int) -> float:
    """Kinetic, strain and potential energy of the uplifted structure [J]."""
    x = b[(SCALARS + POSITION * (n + 1)) * L + l]
    rate = b[(SCALARS + VELOCITY * (n + 1)) * L + l]
    sin_x, cos_x = sine_cosine(x)
    phase = phase_in(b, L, l)
    B, C = lever_arm(phase, cos_x, sin_x), path_height(phase, cos_x, sin_x)
    diameter, columns = b[DIAMETER * L + l], b[COLUMNS_MASS * L + l]
    beam, building = b[BEAM * L + l], b[BUILDING * L + l]
    A = tilt_inertia(b[INERTIA * L + l], beam, building, phase, B, C)
    mass = 0.5 * columns + b[CAP_BEAM_MASS * L + l] + b[FLOORS_MASS * L + l]
    lifted = mass * b[STANDARD_GRAVITY * L + l] * diameter * cap_beam_lift(phase, cos_x, sin_x)
    tilting = 0.125 * columns * (diameter * diameter) * A * (rate * rate)
    base = b[SIDE * L + l] * diameter * cap_beam_displacement(phase, x, cos_x, sin_x)
    return float(tilting + lifted) + building_energy(b, n, L, l, base)
