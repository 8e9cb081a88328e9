"""What is read off the motion at the record's samples: largest demands and contact forces."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.physics.building import floor_rates
from rpscli.physics.jit import kernel
from rpscli.physics.layout import (
    DAMPED,
    FLOORS,
    FRICTION_BOTTOM,
    FRICTION_TOP,
    FULL_CONTACT,
    INPUT,
    NORMAL_BOTTOM,
    NORMAL_TOP,
    ROW_ACCELERATION,
    ROW_DAMPED,
    ROW_FLOORS,
    ROW_INPUT,
    ROW_LOST,
    ROW_PHASE,
    ROW_RATE,
    ROW_ROTATION,
    TILT,
    TILT_RATE,
)
from rpscli.physics.parameters import Floors, Podium
from rpscli.physics.uplifted import (
    Shaking,
    cap_beam_displacement,
    lever_arm,
    path_height,
    phase_of,
)


class Base(NamedTuple):
    """Motion of the cap beam relative to the ground; vertical upwards [m, m/s, m/s2]."""

    displacement: float
    rate: float
    acceleration: float
    vertical_acceleration: float


class ContactForces(NamedTuple):
    """Forces of all columns together at their upper and lower ends [N] (Theory, section 8)."""

    shear_top: float
    shear_bottom: float
    normal_top: float
    normal_bottom: float


@kernel
def base_motion(
    podium: Podium, motion: int, side: float, y: NDArray[np.float64], tilt_acceleration: float
) -> Base:
    """u_b and its rates, from the tilt and its acceleration."""
    if motion == FULL_CONTACT:
        return Base(0.0, 0.0, 0.0, 0.0)
    x, rate = y[TILT], y[TILT_RATE]
    cos_x, sin_x = math.cos(x), math.sin(x)
    phase = phase_of(podium, motion)
    B = lever_arm(phase, cos_x, sin_x)
    C = path_height(phase, cos_x, sin_x)
    diameter = 2.0 * podium.R
    return Base(
        side * diameter * cap_beam_displacement(phase, x, cos_x, sin_x),
        side * diameter * C * rate,
        side * diameter * (C * tilt_acceleration + B * rate**2),
        diameter * (B * tilt_acceleration + (phase.c - C) * rate**2),
    )


@kernel
def contact_forces(
    podium: Podium, base: Base, V: float, ground: float, vertical: float
) -> ContactForces:
    """Friction and normal forces that the motion needs at the ends of the columns."""
    beam = podium.cap_beam_mass
    shear_top = beam * (base.acceleration + ground) - V
    shear_bottom = shear_top + podium.columns_mass * (0.5 * base.acceleration + ground)
    gravity = podium.gravity + vertical
    normal_top = (beam + podium.floors_mass) * (gravity + base.vertical_acceleration)
    normal_bottom = normal_top + podium.columns_mass * (gravity + 0.5 * base.vertical_acceleration)
    return ContactForces(shear_top, shear_bottom, normal_top, normal_bottom)


@kernel
def record_demands(
    floors: Floors,
    y: NDArray[np.float64],
    rates: NDArray[np.float64],
    base: float,
    ground: float,
    storey_shears: NDArray[np.float64],
    floor_accelerations: NDArray[np.float64],
) -> None:
    """Raise the largest elastic storey shears k_i d_i [N] and absolute floor accelerations."""
    n = floors.mass.shape[0]
    below = base
    for i in range(n):
        u = y[FLOORS + i]
        shear = abs(floors.stiffness[i] * (u - below))
        storey_shears[i] = max(storey_shears[i], shear)
        acceleration = abs(rates[FLOORS + n + i] + ground)
        floor_accelerations[i] = max(floor_accelerations[i], acceleration)
        below = u


@kernel
def record_contacts(
    podium: Podium,
    base: Base,
    V: float,
    a_h: float,
    a_v: float,
    contacts: NDArray[np.float64],
) -> None:
    """Raise the friction demand and lower the least normal force at both interfaces."""
    forces = contact_forces(podium, base, V, a_h, a_v)
    upper = podium.cap_beam_mass + podium.floors_mass
    if upper > 0.0:
        demand = friction(forces.shear_top, forces.normal_top)
        contacts[FRICTION_TOP] = max(contacts[FRICTION_TOP], demand)
        rest = forces.normal_top / (upper * podium.gravity)
        contacts[NORMAL_TOP] = min(contacts[NORMAL_TOP], rest)
    demand = friction(forces.shear_bottom, forces.normal_bottom)
    contacts[FRICTION_BOTTOM] = max(contacts[FRICTION_BOTTOM], demand)
    rest = forces.normal_bottom / ((upper + podium.columns_mass) * podium.gravity)
    contacts[NORMAL_BOTTOM] = min(contacts[NORMAL_BOTTOM], rest)


@kernel
def friction(shear: float, normal: float) -> float:
    """|F|/N; infinite once the contact is lost."""
    return abs(shear) / normal if normal > 0.0 else math.inf


@kernel
def observe(
    podium: Podium,
    floors: Floors,
    motion: int,
    side: float,
    shaking: Shaking,
    time: float,
    lost: float,
    y: NDArray[np.float64],
    rates: NDArray[np.float64],
    storey_shears: NDArray[np.float64],
    floor_accelerations: NDArray[np.float64],
    contacts: NDArray[np.float64],
    samples: NDArray[np.float64],
    row: int,
) -> None:
    """Read demands and contact forces at a sample, and store it if there is room."""
    n = floors.mass.shape[0]
    a_h = shaking.start + shaking.slope * time
    a_v = shaking.vertical_start + shaking.vertical_slope * time
    if motion == FULL_CONTACT:
        y[TILT], y[TILT_RATE], rates[TILT_RATE] = 0.0, 0.0, 0.0
    base = base_motion(podium, motion, side, y, rates[TILT_RATE])
    V, _ = floor_rates(floors, y, base.displacement, base.rate, a_h, rates)
    record_demands(floors, y, rates, base.displacement, a_h, storey_shears, floor_accelerations)
    record_contacts(podium, base, V, a_h, a_v, contacts)
    if row < samples.shape[0]:
        s = samples[row]
        s[ROW_ROTATION], s[ROW_RATE] = side * y[TILT], side * y[TILT_RATE]
        s[ROW_ACCELERATION], s[ROW_PHASE] = side * rates[TILT_RATE], motion
        s[ROW_INPUT], s[ROW_DAMPED], s[ROW_LOST] = y[INPUT], y[DAMPED], lost
        for i in range(2 * n):
            s[ROW_FLOORS + i] = y[FLOORS + i]
