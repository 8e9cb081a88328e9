"""Rows of samples of a history under two components, see `planar.samples`."""

from __future__ import annotations

import math

from rpscli.physics.core.compile import compiled, variant
from rpscli.physics.core.records import Record
from rpscli.physics.core.series import integral, slope, value
from rpscli.physics.planar.equation_of_motion import rotation_terms
from rpscli.physics.planar.run import Output
from rpscli.physics.planar.samples import store_row, store_row_within
from rpscli.physics.planar.state import FULL_CONTACT
from rpscli.physics.spatial.devices import rates_with_devices, store_devices_3d
from rpscli.physics.spatial.equation_of_motion import (
    beam_motion,
    direction_at,
    place_of,
    turning_terms,
)


@variant(store_row, "cos_phi")
def store_row_3d(s: Record, l: int, systems: Record, output: Output, row: int) -> None:
    """Keep the state of a lane, its modes as they stand in `looked_at`, if there is room."""
    rates, stands = (0.0, 0.0, 0.0, 0.0), s.phase[l] == FULL_CONTACT
    if not stands:
        rates = rates_with_devices(s, l)
    write_row(s, l, systems, output, row, 0.0 if stands else s.theta[l], rates)


@variant(store_row_within, "cos_phi")
def store_row_within_3d(
    s: Record, l: int, systems: Record, output: Output, row: int, t: float
) -> None:
    """Keep the state a fraction t into the step."""
    h, p, w = s.step[l], rotation_terms(s, l), turning_terms(s, l)
    rates = value(p, t), value(w, t), slope(p, t) / h, slope(w, t) / h
    cos_phi, sin_phi = s.cos_phi[l], s.sin_phi[l]
    s.cos_phi[l], s.sin_phi[l] = direction_at(s, l, t)
    write_row(s, l, systems, output, row, s.theta[l] + h * integral(p, t), rates)
    s.cos_phi[l], s.sin_phi[l] = cos_phi, sin_phi


@compiled
def write_row(
    s: Record,
    l: int,
    systems: Record,
    output: Output,
    row: int,
    theta: float,
    rates: tuple[float, float, float, float],
) -> None:
    """Keep a tilt and its rates p, w, p' and w', towards the present azimuth."""
    if row >= output.samples.shape[0]:
        return
    sample, half = output.samples[row], s.storeys
    sample.theta, sample.phase = theta, s.phase[l]
    sample.azimuth = math.atan2(s.sin_phi[l], s.cos_phi[l]) if theta > 0.0 else 0.0
    sample.theta_dot, sample.turning, sample.theta_ddot, sample.turning_rate = rates
    if s.devices[l] > 0:
        store_devices_3d(s, l, output.devices[row], theta, (rates[0], rates[1]))
    sample.push_x, sample.push_y = s.push_x[l], s.push_y[l]
    sample.energy_input, sample.energy_damped = s.energy_input[l], s.energy_damped[l]
    sample.energy_lost = s.energy_lost[l]
    beam = 0.0, 0.0, 0.0, 0.0
    if s.phase[l] != FULL_CONTACT:
        beam = beam_motion(s, l, place_of(s, l, theta), rates[0], rates[1])
    for axis in range(2):
        for i in range(half):
            u, du = beam[axis], beam[2 + axis]
            for r in range(half):
                u += systems[axis].phi[r, i] * s.looked_at[0, half * axis + r]
                du += systems[axis].phi[r, i] * s.looked_at[1, half * axis + r]
            output.floors[row, 0, half * axis + i], output.floors[row, 1, half * axis + i] = u, du
