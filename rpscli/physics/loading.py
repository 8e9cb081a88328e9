"""Loading a history into a lane: constants folded, everything at rest at the record's start."""

from __future__ import annotations

import math

from rpscli.physics.contact import load_modes
from rpscli.physics.jit import part
from rpscli.physics.layout import (
    BEAM,
    BLOCKS,
    BUILDING,
    CAP_BEAM_MASS,
    COLUMNS_MASS,
    CONTACT_STEP,
    CONTACT_STEPS,
    CRITICAL_TIME,
    DAMPING,
    DIAMETER,
    DRAG,
    FLIGHT_STEP,
    FLIGHT_STEPS,
    FLOORS_MASS,
    FULL_CONTACT,
    INERTIA,
    INTERVAL_LENGTH,
    INTERVALS,
    INVERSE_MASS,
    LEANING,
    MASS,
    MOTION,
    NORMAL_BOTTOM,
    NORMAL_TOP,
    NPTS,
    OUTCOME,
    PEAK,
    POINT,
    POSITION,
    PUSH,
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
    THETA_CR,
    VERTICAL,
    WEIGHT,
    WHOLE_NUMBERS,
)
from rpscli.physics.parameters import Floats, Lanes, Motions, Podium, Points, Shape, Systems
from rpscli.physics.shaking import shake
from rpscli.physics.switch import enter_phase
from rpscli.physics.table import podium_of


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
    steps = max(math.ceil(dt * podium.flight_rate), 1)
    b[FLIGHT_STEP * L + l], b[FLIGHT_STEPS * L + l] = dt / steps, steps
    steps = max(math.ceil(dt * podium.contact_rate), 1)
    b[CONTACT_STEP * L + l], b[CONTACT_STEPS * L + l] = dt / steps, steps
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
