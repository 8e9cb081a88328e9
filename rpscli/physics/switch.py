"""Going from one phase of motion to the next, with what is lost and logged on the way."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rpscli.physics.building import building_energy
from rpscli.physics.contact import to_floors, to_modes
from rpscli.physics.impact import impact, is_negligible, lock
from rpscli.physics.jit import kernel
from rpscli.physics.layout import (
    CREATED,
    CREATED_IMPACTS,
    FULL_CONTACT,
    IMPACT,
    LOST,
    RECONTACT,
    ROCKING,
    ROLLING,
    TILT,
    TILT_RATE,
)
from rpscli.physics.parameters import Floors, Podium
from rpscli.physics.uplifted import Shaking, rates_of_change, uplifted_energy


@kernel
def note(
    log: NDArray[np.float64],
    counts: NDArray[np.int64],
    time: float,
    kind: int,
    rotation: float,
    before: float,
    after: float,
    lost: float,
) -> None:
    """Count an event, and log it if there is room (the caller sees from the counts if not)."""
    row = counts.sum()
    counts[kind] += 1
    if row < log.shape[0]:
        log[row, 0], log[row, 1], log[row, 2] = time, kind, rotation
        log[row, 3], log[row, 4], log[row, 5] = before, after, lost


@kernel
def uplifted_phase(podium: Podium, x: float) -> int:
    """Phase of motion at the tilt x."""
    return ROLLING if x < podium.beta else ROCKING


@kernel
def uplift(
    podium: Podium,
    floors: Floors,
    side: float,
    shaking: Shaking,
    time: float,
    z: NDArray[np.float64],
    y: NDArray[np.float64],
    rates: NDArray[np.float64],
) -> int:
    """Leave full contact towards `side`; writes state and slopes, returns the phase."""
    to_floors(floors, z, y)
    y[TILT], y[TILT_RATE] = 0.0, 0.0
    motion = uplifted_phase(podium, 0.0)
    rates_of_change(podium, floors, motion, side, shaking, time, y, rates)
    # At the threshold theta'' is zero but for rounding, and about to grow.
    rates[TILT_RATE] = max(rates[TILT_RATE], 0.0)
    return motion


@kernel
def land(
    podium: Podium,
    floors: Floors,
    side: float,
    shaking: Shaking,
    time: float,
    start: float,
    tolerance: float,
    y: NDArray[np.float64],
    z: NDArray[np.float64],
    rates: NDArray[np.float64],
    tally: NDArray[np.float64],
    counts: NDArray[np.int64],
    log: NDArray[np.float64],
) -> tuple[int, float]:
    """Impact at theta = 0, and re-contact if the next excursion would be negligible.

    Returns the phase of motion and the side afterwards; z is written on re-contact.
    """
    motion = uplifted_phase(podium, 0.0)
    before = uplifted_energy(podium, floors, motion, side, y)
    arriving = side * y[TILT_RATE]
    side = impact(podium, floors, side, y)
    leaving = side * y[TILT_RATE]
    gone = before - uplifted_energy(podium, floors, motion, side, y)
    tally[LOST] += gone
    if gone < 0.0:
        tally[CREATED] -= gone
        tally[CREATED_IMPACTS] += 1.0
    note(log, counts, start + time, IMPACT, 0.0, arriving, leaving, gone)
    rates_of_change(podium, floors, motion, side, shaking, time, y, rates)
    if is_negligible(podium, y[TILT_RATE], rates[TILT_RATE], tolerance):
        before = uplifted_energy(podium, floors, motion, side, y)
        lock(podium, floors, side, y)
        gone = before - building_energy(floors, y, 0.0)
        tally[LOST] += gone
        to_modes(floors, y, z)
        note(log, counts, start + time, RECONTACT, 0.0, leaving, 0.0, gone)
        motion = FULL_CONTACT
    return motion, side
