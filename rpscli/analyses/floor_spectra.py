"""Response spectra of the floors: what impacts and uplift do to equipment."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from rpscli.analyses.fixed_base import fixed_base_response
from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.timehistory import denser_trace
from rpscli.analyses.trace import Trace
from rpscli.errors import CaseError
from rpscli.model.podium import Array
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.measures import response_spectrum
from rpscli.shown import Shown, frozen

PERIODS = frozen(np.geomspace(0.05, 4.0, 50))
"""Periods of equipment [s]."""

DAMPING = 0.05

STEP = 1e-3
"""Between instants at which floors are looked at [s], or less: 1/50 of the shortest
period, which leaves 0.1 % there."""

RINGING = 10.0
"""First periods of the building for which equipment is followed beyond the end of a
history: at resonance it is shaken most some three of them later."""


@dataclass(frozen=True, eq=False, repr=False)
class FloorSpectra(Shown):
    """Spectra of light equipment on each floor, which does not act back."""

    periods: Array  # (p,) natural periods [s]
    damping: float  # share of critical damping
    pseudo_acceleration: Array  # (n, p) [m/s2], by floors from the bottom
    displacement: Array  # (n, p) relative to the floor [m]


def isolated_floor_spectra(
    result: TimeHistoryResult, periods: Array = PERIODS, damping: float = DAMPING
) -> FloorSpectra:
    """Spectra of the floors of the building on its bearings.

    Parameters
    ----------
    result : TimeHistoryResult
        With a superstructure.
    periods : array, shape (p,) [s]
        Natural periods.
    damping : float
        Share of critical damping.

    Notes
    -----
    From the absolute floor accelerations every `STEP` or less, linear between them, and
    for ten first periods of the building after the history. Where floors keep their own
    velocities impacts make the forces of dampers jump: between two instants that is told
    by a ramp with the impulse of the jump. The same motion written ten times denser moves
    pseudo-accelerations by less than 0.5 % at 0.1 s, and by less than 1 % at 0.05 s.
    """
    if result.both_components:
        raise CaseError(
            f"{result.record.source}: floor spectra are those of one horizontal component"
            " at a time; give each component by itself, without ?both"
        )
    trace = denser_trace(result, STEP, _ringing(result))
    accelerations = trace.floor_accelerations + jumps_left_out(result, trace)
    return floor_spectra(accelerations, _step(result), periods, damping)


def _step(result: TimeHistoryResult) -> float:
    return result.record.dt / max(math.ceil(result.record.dt / STEP - 1e-9), 1)


def _ringing(result: TimeHistoryResult) -> float:
    building = result.structure.superstructure
    return 0.0 if building is None else RINGING * float(building.periods[0])


def jumps_left_out(result: TimeHistoryResult, trace: Trace) -> Array:
    """Ramps with the impulse of each jump of the accelerations, at the
    instants beside it (n,).
    """
    structure = result.structure
    building = result.structure.superstructure
    ramps = np.zeros_like(trace.floor_accelerations)
    if building is None or structure.impact_law.floors_jump or len(ramps) < 2:
        return ramps
    b = structure.bearing
    step = _step(result)
    height = 2.0 * b.semi_diagonal * math.cos(b.alpha)
    each = height * building.damping_matrix.sum(axis=1) / building.masses
    for event in result.events:
        if event.kind == "impact":
            at = event.time / step
            before = min(int(at), len(ramps) - 2)
            jump = each * (event.rotation_rate_after - event.rotation_rate_before)
            ramps[before : before + 2] += 0.5 * (0.5 - (at - before)) * jump
    return ramps


def fixed_base_floor_spectra(
    result: TimeHistoryResult, periods: Array = PERIODS, damping: float = DAMPING
) -> FloorSpectra | None:
    """Spectra of the same floors on a fixed base; None where that was not computed.

    Parameters
    ----------
    result
        With a superstructure.
    periods
        (p,) natural periods [s].
    damping
        Share of critical damping.
    """
    if result.fixed_base is None:
        return None
    parts = round(result.record.dt / _step(result))
    denser = result.motion.finer(parts)
    intervals = (len(result.fixed_base.floor_displacements) - 1) * parts
    intervals += math.ceil(_ringing(result) / denser.dt)
    fixed = fixed_base_response(result.structure, denser, intervals)
    return floor_spectra(fixed.acceleration_histories, denser.dt, periods, damping)


def floor_spectra(
    accelerations: Array, dt: float, periods: Array, damping: float
) -> FloorSpectra:
    """Spectra of histories side by side."""
    spectra = [
        response_spectrum(
            GroundMotion(floor, dt, "floor", "floor", "response"), periods, damping
        )
        for floor in accelerations.T
    ]
    return FloorSpectra(
        np.array(periods, dtype=float),
        damping,
        np.array([spectrum.pseudo_acceleration for spectrum in spectra]),
        np.array([spectrum.displacement for spectrum in spectra]),
    )
