"""The event-driven history: step - detect - locate - switch - store.

Time runs over the record's intervals; within one, the structure is either in full contact, where
the exact linear solution is searched for an uplift, or uplifted, where Runge-Kutta steps are
searched for an impact, a change between rolling and rocking, or overturning.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.physics.building import building_energy
from rpscli.physics.contact import fill_decay, step_contact, to_floors
from rpscli.physics.flight import NOT_FINITE, NOTHING, fly, watch_peak
from rpscli.physics.jit import kernel
from rpscli.physics.layout import (
    AT_REST,
    CREATED,
    CREATED_IMPACTS,
    CRITICAL_PASSAGE,
    CRITICAL_TIME,
    DAMPED,
    EVENT_KINDS,
    FAILED_NOT_FINITE,
    FAILED_STEP_TOO_SMALL,
    FAILED_TOO_MANY_EVENTS,
    FLOORS,
    FULL_CONTACT,
    IMPACT,
    INPUT,
    LOST,
    OVERTURNED_ROCKING,
    OVERTURNED_ROLLING,
    OVERTURNING,
    PEAK,
    PEAK_TIME,
    ROCKING,
    ROLLING,
    ROLLING_TO_ROCKING,
    RUNNING,
    SURVIVED,
    TALLY_SIZE,
    TILT,
    TILT_RATE,
    UPLIFT,
)
from rpscli.physics.observation import base_motion, observe
from rpscli.physics.parameters import Floors, Ground, Numerics, Podium
from rpscli.physics.rest import is_over
from rpscli.physics.runge_kutta import EVALUATIONS, STAGES
from rpscli.physics.switch import land, note, uplift, uplifted_phase
from rpscli.physics.uplifted import Shaking, rates_of_change, uplifted_energy

STALLED = 100
"""So many events in a row without time passing: the step cannot be made small enough."""


class History(NamedTuple):
    """What one history leaves behind besides samples and log, SI units.

    `motion`, `rotation` and `time` are those of the end, after `intervals` of the record's steps.
    Times that never came are negative. `contacts` has the entries `layout.FRICTION_TOP` and on,
    `counts` the number of events of each kind. `energies` are input, damped, lost at impacts, and
    stored at the end; the energy created at impacts counts negatively in what was lost.
    """

    outcome: int
    motion: int
    rotation: float
    time: float
    intervals: int
    max_rotation: float
    max_rotation_time: float
    critical_time: float
    storey_shears: NDArray[np.float64]
    floor_accelerations: NDArray[np.float64]
    contacts: NDArray[np.float64]
    energies: NDArray[np.float64]
    energy_created: float
    creating_impacts: int
    counts: NDArray[np.int64]
    evaluations: int


@kernel
def shaking_in(ground: Ground, interval: int) -> Shaking:
    """Ground acceleration within an interval of the record, or after its end."""
    i, dt = interval, ground.dt
    if i + 1 >= ground.horizontal.shape[0]:
        return Shaking(0.0, 0.0, 0.0, 0.0)
    a, b = ground.horizontal[i], ground.horizontal[i + 1]
    if ground.vertical.shape[0] == 0:
        return Shaking(a, (b - a) / dt, 0.0, 0.0)
    v, w = ground.vertical[i], ground.vertical[i + 1]
    return Shaking(a, (b - a) / dt, v, (w - v) / dt)


@kernel
def release(
    podium: Podium, floors: Floors, rotation: float, y: NDArray[np.float64]
) -> tuple[int, float]:
    """Start from rest at a rotation, the building unstrained; returns phase and side."""
    if rotation == 0.0:
        return FULL_CONTACT, 1.0
    side = math.copysign(1.0, rotation)
    y[TILT] = abs(rotation)
    motion = uplifted_phase(podium, y[TILT])
    base = base_motion(podium, motion, side, y, 0.0).displacement
    for i in range(floors.mass.shape[0]):
        y[FLOORS + i] = base
    return motion, side


@kernel
def integrate(
    podium: Podium,
    floors: Floors,
    ground: Ground,
    numerics: Numerics,
    samples: NDArray[np.float64],
    log: NDArray[np.float64],
) -> History:
    """Integrate one history from rest.

    Parameters
    ----------
    samples
        Written, (intervals + 1, 7 + 2 n): see `layout.ROW_...`; give no rows to keep none.
    log
        Written, (events, 6): see `layout.LOG_...`; events beyond its rows are only counted.
    """
    n = floors.mass.shape[0]
    m = FLOORS + 2 * n
    y, end, k = np.zeros(m), np.zeros(m), np.zeros((STAGES, m))
    z, z_end = np.zeros((2, n)), np.zeros((2, n))
    table, scratch, piece = np.zeros((2, n)), np.zeros((2, n)), np.zeros(6)
    storey_shears, floor_accelerations = np.zeros(n), np.zeros(n)
    contacts = np.array([0.0, 0.0, math.inf, math.inf])
    tally, counts = np.zeros(TALLY_SIZE), np.zeros(EVENT_KINDS, np.int64)
    tally[CRITICAL_TIME] = -1.0
    dt = ground.dt
    contact_step, flight_step = dt / numerics.contact_substeps, dt / numerics.substeps
    fill_decay(floors, contact_step, table)
    shaken = ground.horizontal.shape[0] - 1
    intervals = shaken + numerics.free_samples
    motion, side = release(podium, floors, numerics.initial_rotation, y)
    tally[PEAK] = y[TILT]
    outcome, evaluations, stalled, interval, time = RUNNING, 0, 0, 0, 0.0

    while outcome == RUNNING:
        shaking = shaking_in(ground, interval)
        start = interval * dt
        if motion != FULL_CONTACT and interval in (0, shaken):
            # The ground acceleration may jump here; elsewhere the last step's slope still holds.
            rates_of_change(podium, floors, motion, side, shaking, 0.0, y, k[0])
        if interval == 0:
            observe(
                podium, floors, motion, side, shaking, 0.0, 0.0, y, k[0],
                storey_shears, floor_accelerations, contacts, samples, 0,
            )  # fmt: skip
        if interval == intervals:
            break
        time = 0.0
        while dt - time > 1e-13 * dt and outcome == RUNNING:
            if motion == FULL_CONTACT:
                h, decays = min(contact_step, dt - time), table
                if abs(h - contact_step) > 1e-12 * dt:
                    decays = scratch
                    fill_decay(floors, h, decays)
                advanced, towards = step_contact(
                    podium, floors, shaking, time, h, decays, scratch, piece, y, z, z_end
                )
                time += advanced
                if towards != 0.0:
                    side = towards
                    motion = uplift(podium, floors, side, shaking, time, z, y, k[0])
                    note(log, counts, start + time, UPLIFT, 0.0, 0.0, 0.0, 0.0)
            else:
                h = (dt - time) / max(math.ceil((dt - time) / flight_step - 1e-9), 1)
                advanced, event, steps = fly(
                    podium, floors, motion, side, shaking, time, h, y, k, end, piece
                )
                evaluations += steps * EVALUATIONS
                if event == NOT_FINITE:
                    outcome = FAILED_NOT_FINITE
                    break
                watch_peak(y, k, end, advanced, start + time, tally)
                time += advanced
                for i in range(m):
                    y[i], k[0, i] = end[i], k[6, i]
                rotation, rate = side * y[TILT], side * y[TILT_RATE]
                if tally[PEAK] > podium.theta_cr and tally[CRITICAL_TIME] < 0.0:
                    tally[CRITICAL_TIME] = start + time
                    note(log, counts, start + time, CRITICAL_PASSAGE, rotation, rate, rate, 0.0)
                if event == IMPACT:
                    motion, side = land(
                        podium, floors, side, shaking, time, start, numerics.recontact_tolerance,
                        y, z, k[0], tally, counts, log,
                    )  # fmt: skip
                elif event == OVERTURNING:
                    rolls = podium.theta_cr < podium.beta
                    outcome = OVERTURNED_ROLLING if rolls else OVERTURNED_ROCKING
                    note(log, counts, start + time, OVERTURNING, rotation, rate, rate, 0.0)
                elif event != NOTHING:
                    motion = ROCKING if event == ROLLING_TO_ROCKING else ROLLING
                    note(log, counts, start + time, event, rotation, rate, rate, 0.0)
                    rates_of_change(podium, floors, motion, side, shaking, time, y, k[0])
            stalled = 0 if advanced > 0.0 else stalled + 1
            if stalled > STALLED:
                outcome = FAILED_STEP_TOO_SMALL
            elif counts.sum() > numerics.max_events:
                outcome = FAILED_TOO_MANY_EVENTS
        if outcome != RUNNING:
            break
        interval, time = interval + 1, 0.0
        if motion == FULL_CONTACT:
            to_floors(floors, z, y)
        observe(
            podium, floors, motion, side, shaking, dt, tally[LOST], y, k[0],
            storey_shears, floor_accelerations, contacts, samples, interval,
        )  # fmt: skip
        if numerics.until_rest and interval > shaken:
            peak = tally[PEAK]
            demands = (storey_shears, floor_accelerations)
            if is_over(podium, floors, motion, side, y, z, peak, *demands):
                break

    if outcome == RUNNING:
        moved = counts[UPLIFT] > 0 or numerics.initial_rotation != 0.0
        outcome = SURVIVED if moved else AT_REST
    if motion == FULL_CONTACT:
        to_floors(floors, z, y)
        stored = building_energy(floors, y, 0.0)
    else:
        stored = uplifted_energy(podium, floors, motion, side, y)
    energies = np.array([y[INPUT], y[DAMPED], tally[LOST], stored])
    return History(
        outcome, motion, side * y[TILT], interval * dt + time, interval,
        tally[PEAK], tally[PEAK_TIME], tally[CRITICAL_TIME],
        storey_shears, floor_accelerations, contacts,
        energies, tally[CREATED], int(tally[CREATED_IMPACTS]), counts, evaluations,
    )  # fmt: skip
