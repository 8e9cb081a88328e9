"""The end of a history: what it leaves behind."""

from __future__ import annotations

from rpscli.physics.compile import compiled
from rpscli.physics.devices.table import stored_in
from rpscli.physics.devices.worked import worked
from rpscli.physics.energy import total_energy
from rpscli.physics.floors import row_along, rows_of
from rpscli.physics.ground import azimuth_of, time_of
from rpscli.physics.lane import tilt_of, ways_of
from rpscli.physics.state import (
    AT_REST,
    BEDDED,
    EVENT_KINDS,
    RUNNING,
    STUCK,
    SURVIVED,
    UPLIFT,
    Record,
)


@compiled
def finish_storeys(s: Record, l: int, result: Record) -> None:
    """Write what storeys that may yield leave behind."""
    for axis in range(ways_of(s)):
        for i in range(s.n):
            r = axis * s.n + i
            free = 1.0 - s.hardening[l]
            most = max(s.drift_most[r, l], s.largest[row_along(s, axis), l, i])
            if s.yielded[r, l] > 0.0:  # else its drift is its shear over k
                most = s.drift_most[r, l]
            result.ductility[axis, i] = most / s.strength[r, l]
            result.slip[axis, i] = free * s.middle[r, l]
            result.slip_most[axis, i] = free * s.middle_most[r, l]
            result.slip_least[axis, i] = free * s.middle_least[r, l]
            result.yielded[axis, i] = s.yielded[r, l]
            result.first_yield[axis, i] = s.first_yield[r, l]


@compiled
def finish_history(s: Record, l: int, system: Record, results: Record) -> None:
    """Write what the history leaves behind [results (P,)]."""
    result = results[s.history[l]]
    ways = ways_of(s)
    result.energy_stored = total_energy(s, l, system)
    if s.outcome[l] == RUNNING:
        released = system.initial_rotation != 0.0 or s.max_theta[l] > system.bed_uplift
        s.outcome[l] = SURVIVED if released or s.events[UPLIFT, l] > 0 else AT_REST
    result.outcome = s.outcome[l]
    result.phase = s.phase[l]
    result.intervals = s.interval[l]
    result.ways = ways
    if s.phase[l] == STUCK and s.bed_k[l] > 0.0:
        result.phase = BEDDED
    for i in range(s.kept.shape[0]):
        result.kept[i] = s.kept[i, l]
    result.steps = int(s.steps[l])
    result.time = time_of(s, l)
    result.rotation = s.tilt[0, l] if ways == 1 else s.x[l]
    result.azimuth = azimuth_of(s, l)
    for i in range(EVENT_KINDS):
        result.events[i] = s.events[i, l]
    rows = rows_of(s)
    for i in range(s.n):
        result.storey_shear[i] = s.largest[0, l, i]
        result.floor_acceleration[i] = s.largest[rows, l, i]
        if ways == 2:
            result.storey_shear_x[i] = s.largest[row_along(s, 0), l, i]
            result.storey_shear_y[i] = s.largest[row_along(s, 1), l, i]
            result.floor_acceleration_x[i] = s.largest[rows + row_along(s, 0), l, i]
            result.floor_acceleration_y[i] = s.largest[rows + row_along(s, 1), l, i]
    result.max_x = s.max_beam[0, l]
    result.max_y = s.max_beam[ways - 1, l]
    if s.yields[l] > 0:
        finish_storeys(s, l, result)
    if s.devices[l] > 0:
        at = worked(s, l, tilt_of(s, l), (0.0, 0.0))
        for i in range(s.devices[l]):
            result.device_force[i] = s.device_force[i, l]
            result.device_velocity[i] = s.device_velocity[i, l]
            result.device_energy[i] = s.device_energy[i, l]
            result.device_stored[i] = stored_in(s, l, i, at)
            result.permanent[i] = s.permanent[i, l]
