"""Loading a history into a lane: constants, everything at rest at the record's start."""

from __future__ import annotations

import math

from rpscli.physics import parameters as given
from rpscli.physics.contact import fill_transition
from rpscli.physics.contact_layout import WHOLE
from rpscli.physics.lane import Lane, lane_of
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
    PER_INTERVAL,
    POINT,
    RECORD,
    ROCKING,
    ROLLING,
    RUNNING,
    SCALE,
    SIDE,
    STALE,
    TILT,
    VERTICAL,
    WHOLE_NUMBERS,
)
from rpscli.physics.parameters import Lanes, Points, Systems
from rpscli.physics.part import part
from rpscli.physics.podium_layout import BETA, CONTACT_RATE, FLIGHT_RATE, FREE_VIBRATION
from rpscli.physics.shaking import shake
from rpscli.physics.switch import enter_phase


@part
def begin(lanes: Lanes, L: int, l: int, point: int, systems: Systems, points: Points) -> None:
    """Load a history into a lane, at rest in full contact at the start of its record."""
    history, system = points.integers[point], points.integers[point, given.SYSTEM]
    for row in range(systems.column.shape[1]):
        lanes.buffer[row * L + l] = systems.column[system, row]
    lane = lane_of(lanes, l)
    s, whole, p, z = lane.numbers, lane.whole, lane.podium, lane.modes
    for i in range(p.shape[0]):
        p[i] = systems.podium[system, i]
    for row in range(z.shape[0]):
        for r in range(z.shape[1]):
            z[row, r] = systems.modes[system, row, r]
    for i in range(WHOLE_NUMBERS):
        whole[i] = 0
    whole[POINT], whole[OUTCOME], whole[MOTION] = point, RUNNING, FULL_CONTACT
    whole[RECORD], whole[VERTICAL] = history[given.RECORD], history[given.VERTICAL]
    dt = points.numbers[point, given.DT]
    free = math.ceil(p[FREE_VIBRATION] / dt - 1e-9)
    whole[NPTS] = history[given.NPTS]
    whole[INTERVALS] = history[given.NPTS] - 1 + free
    s[SCALE], s[INTERVAL_LENGTH] = points.numbers[point, given.SCALE], dt
    s[PER_INTERVAL] = 1.0 / dt
    steps = max(math.ceil(dt * p[FLIGHT_RATE]), 1)
    s[FLIGHT_STEP], s[FLIGHT_STEPS] = dt / steps, steps
    steps = max(math.ceil(dt * p[CONTACT_RATE]), 1)
    s[CONTACT_STEP], s[CONTACT_STEPS] = dt / steps, steps
    fill_transition(z, dt / steps, WHOLE)
    shake(lane)


@part
def lean(lane: Lane, rotation: float) -> None:
    """Start from rest at a rotation, the building unstrained."""
    s, tilt = lane.numbers, abs(rotation)
    s[SIDE], s[PEAK], s[STALE] = math.copysign(1.0, rotation), tilt, LEANING
    s[TILT] = tilt
    enter_phase(lane, ROLLING if tilt < lane.podium[BETA] else ROCKING)
