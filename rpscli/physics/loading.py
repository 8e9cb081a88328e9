"""Loading a history into a lane: constants, everything at rest at the record's start."""

from __future__ import annotations

import math

from rpscli.physics import parameters as given
from rpscli.physics.contact import fill_transition
from rpscli.physics.contact_layout import WHOLE
from rpscli.physics.jit import part
from rpscli.physics.layout import (
    CONTACT_STEP,
    CONTACT_STEPS,
    FLIGHT_STEP,
    FLIGHT_STEPS,
    FULL_CONTACT,
    INTERVAL_LENGTH,
    INTERVALS,
    LEANING,
    MOTION,
    NPTS,
    OUTCOME,
    PEAK,
    POINT,
    POSITION,
    RECORD,
    ROCKING,
    ROLLING,
    RUNNING,
    SCALARS,
    SCALE,
    SIDE,
    STALE,
    VERTICAL,
    WHOLE_NUMBERS,
)
from rpscli.physics.parameters import Lanes, Points, Shape, Systems
from rpscli.physics.shaking import shake
from rpscli.physics.switch import enter_phase
from rpscli.physics.table import podium_of


@part
def begin(lanes: Lanes, shape: Shape, l: int, point: int, systems: Systems, points: Points) -> None:
    """Load a history into a lane, at rest in full contact at the start of its record."""
    L = len(shape.stride)
    b, whole, z = lanes.buffer, lanes.integers, lanes.modes[l]
    history, s = points.integers[point], points.integers[point, given.SYSTEM]
    for row in range(systems.column.shape[1]):
        b[row * L + l] = systems.column[s, row]
    for i in range(lanes.podium.shape[1]):
        lanes.podium[l, i] = systems.podium[s, i]
    for row in range(z.shape[0]):
        for r in range(z.shape[1]):
            z[row, r] = systems.modes[s, row, r]
    for i in range(WHOLE_NUMBERS):
        whole[l, i] = 0
    whole[l, POINT], whole[l, OUTCOME], whole[l, MOTION] = point, RUNNING, FULL_CONTACT
    whole[l, RECORD], whole[l, VERTICAL] = history[given.RECORD], history[given.VERTICAL]
    podium, dt = podium_of(lanes.podium, l), points.numbers[point, given.DT]
    free = math.ceil(podium.free_vibration / dt - 1e-9)
    whole[l, NPTS] = history[given.NPTS]
    whole[l, INTERVALS] = history[given.NPTS] - 1 + free
    b[SCALE * L + l], b[INTERVAL_LENGTH * L + l] = points.numbers[point, given.SCALE], dt
    steps = max(math.ceil(dt * podium.flight_rate), 1)
    b[FLIGHT_STEP * L + l], b[FLIGHT_STEPS * L + l] = dt / steps, steps
    steps = max(math.ceil(dt * podium.contact_rate), 1)
    b[CONTACT_STEP * L + l], b[CONTACT_STEPS * L + l] = dt / steps, steps
    fill_transition(z, dt / steps, WHOLE)
    shake(lanes, L, l)


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
