"""Equation of motion while the storey is uplifted, in one phase, on one side.

The tilt is x = |theta| >= 0 and s = sign(theta); a motion to the left is the mirror image of one
to the right, so only the horizontal actions carry s. Kept beyond x = 0 and x = beta the right-hand
side is smooth, which is what the event location needs.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.physics import geometry
from rpscli.physics.building import building_energy, floor_rates
from rpscli.physics.geometry import Phase
from rpscli.physics.jit import kernel
from rpscli.physics.layout import DAMPED, FLOORS, INPUT, ROLLING, TILT, TILT_RATE
from rpscli.physics.parameters import Floors, Podium

lever_arm = kernel(geometry.lever_arm)
path_height = kernel(geometry.path_height)
squared_distance = kernel(geometry.squared_distance)
cap_beam_displacement = kernel(geometry.cap_beam_displacement)
cap_beam_lift = kernel(geometry.cap_beam_lift)


class Shaking(NamedTuple):
    """Ground acceleration within one interval, linear in the time since its start [m/s2]."""

    start: float
    slope: float
    vertical_start: float
    vertical_slope: float


@kernel
def phase_of(podium: Podium, motion: int) -> Phase:
    """Constants of the phase of motion."""
    return podium.rolling if motion == ROLLING else podium.rocking


@kernel
def tilt_inertia(podium: Podium, B: float, C: float, phase: Phase) -> float:
    """A(x) = Io - 1 + (1 + 4 gamma) S + 4 gamma eta B^2 (paper, Table 1)."""
    S = squared_distance(phase, C)
    return podium.Io - 1.0 + (1.0 + 4.0 * podium.gamma) * S + 4.0 * podium.gamma * podium.eta * B**2


@kernel
def tilt_inertia_slope(podium: Podium, B: float, C: float, phase: Phase) -> float:
    """D(x) = A'(x)/2, with S' = 2 c B and B' = c - C.

    The paper's Table 1 lacks the factor 4 gamma eta in the rocking phase (c = 0).
    """
    beam, building = 1.0 + 4.0 * podium.gamma, 4.0 * podium.gamma * podium.eta
    return B * (beam * phase.c + building * (phase.c - C))


@kernel
def tilt_acceleration(
    podium: Podium,
    phase: Phase,
    B: float,
    C: float,
    rate: float,
    push: float,
    gravity: float,
    V: float,
) -> float:
    """x'' from A x'' = -B G - C (s a_g (1 + 2 gamma) - s 2 V/(N m_c))/R - D x'^2.

    Parameters
    ----------
    rate
        x' [rad/s].
    push, V
        s a_g [m/s2] and s V [N].
    gravity
        g + a_v [m/s2].
    """
    mass = 1.0 + 2.0 * podium.gamma
    weight = (mass + 2.0 * podium.gamma * podium.eta) * gravity
    action = push * mass - 2.0 * V / podium.columns_mass
    A = tilt_inertia(podium, B, C, phase)
    D = tilt_inertia_slope(podium, B, C, phase)
    return -((B * weight + C * action) / podium.R + D * rate**2) / A


@kernel
def rates_of_change(
    podium: Podium,
    floors: Floors,
    motion: int,
    side: float,
    shaking: Shaking,
    time: float,
    y: NDArray[np.float64],
    rates: NDArray[np.float64],
) -> None:
    """dy/dt of the uplifted structure.

    Parameters
    ----------
    motion, side
        Phase of motion and s.
    time
        Since the start of the interval [s].
    rates
        Written.
    """
    x, rate = y[TILT], y[TILT_RATE]
    cos_x, sin_x = math.cos(x), math.sin(x)
    phase = phase_of(podium, motion)
    B = lever_arm(phase, cos_x, sin_x)
    C = path_height(phase, cos_x, sin_x)
    diameter = 2.0 * podium.R
    base = side * diameter * cap_beam_displacement(phase, x, cos_x, sin_x)
    base_rate = side * diameter * C * rate
    a_h = shaking.start + shaking.slope * time
    a_v = shaking.vertical_start + shaking.vertical_slope * time
    V, power = floor_rates(floors, y, base, base_rate, a_h, rates)
    rates[TILT] = rate
    rates[TILT_RATE] = tilt_acceleration(
        podium, phase, B, C, rate, side * a_h, podium.gravity + a_v, side * V
    )
    beam = 0.5 * podium.columns_mass + podium.cap_beam_mass
    n = floors.mass.shape[0]
    momentum = beam * base_rate
    for i in range(n):
        momentum += floors.mass[i] * y[FLOORS + n + i]
    lifting = (beam + podium.floors_mass) * diameter * B * rate
    rates[INPUT] = -a_h * momentum - a_v * lifting
    rates[DAMPED] = power


@kernel
def uplifted_energy(
    podium: Podium, floors: Floors, motion: int, side: float, y: NDArray[np.float64]
) -> float:
    """Kinetic, strain and potential energy relative to the ground [J] (Theory, section 8)."""
    x = y[TILT]
    cos_x, sin_x = math.cos(x), math.sin(x)
    phase = phase_of(podium, motion)
    B = lever_arm(phase, cos_x, sin_x)
    C = path_height(phase, cos_x, sin_x)
    base = side * 2.0 * podium.R * cap_beam_displacement(phase, x, cos_x, sin_x)
    inertia = podium.columns_mass * podium.R**2 * tilt_inertia(podium, B, C, phase)
    mass = 0.5 * podium.columns_mass + podium.cap_beam_mass + podium.floors_mass
    lift = 2.0 * podium.R * cap_beam_lift(phase, cos_x, sin_x)
    tilting = 0.5 * inertia * float(y[TILT_RATE]) ** 2 + mass * podium.gravity * lift
    return tilting + building_energy(floors, y, base)
