"""What one column carries: weight, overturning moment, shock of impacts (Theory (8.7), (8.8))."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.trace import Event, Trace
from rpscli.model.podium import PodiumStructure
from rpscli.physics import state

Array = NDArray[np.float64]

VERTICAL_DAMPING = 0.05
"""Of each vertical mode of the building, over critical."""


@dataclass(frozen=True)
class AxialForces:
    """Axial forces of single columns, of all rows and times, and what the rows share."""

    largest: dict[str, float]
    least: dict[str, float]
    """At the `top` and at the `bottom` of a column, compression positive [N]."""
    overturning_ratio: float | None
    """Largest r: what the moment of the floors' inertia about the cap beam adds to an outer row,
    over its mean force; None without rows."""
    lift_off: float | None
    """When an outer row would first lift off [s]; None if never."""


def axial_forces(structure: PodiumStructure, trace: Trace, events: Sequence[Event]) -> AxialForces:
    """Axial forces of single columns from a trace that is dense beside the vertical period."""
    normal = {"top": trace.normal_top, "bottom": trace.normal_bottom}
    shocked = shock(structure, trace.time, events)
    uneven, ratio, lift_off = np.zeros_like(shocked), None, None
    if structure.rows:
        rows = np.array(structure.rows) - np.mean(structure.rows)
        lever = float(np.mean(rows**2) / np.max(np.abs(rows)))
        moment = overturning_moment(structure, trace)
        ratio = float(np.max(np.abs(moment) / (np.maximum(trace.normal_top, 1.0) * lever)))
        uneven = np.abs(moment + thrust_moment(structure, trace)) / lever
        lifts = np.flatnonzero(uneven > trace.normal_top)
        lift_off = float(trace.time[lifts[0]]) if len(lifts) else None
    N = structure.columns
    return AxialForces(
        {end: float(np.max(force + shocked + uneven)) / N for end, force in normal.items()},
        {end: float(np.min(force + shocked - uneven)) / N for end, force in normal.items()},
        ratio,
        lift_off,
    )


def overturning_moment(structure: PodiumStructure, trace: Trace) -> Array:
    """Moment of the floors' inertia about the cap beam (samples,) [N m], positive to the right."""
    building = structure.superstructure
    if building is None or building.storey_heights is None:
        return np.zeros_like(trace.time)
    return -(trace.floor_accelerations @ (building.masses * np.cumsum(building.storey_heights)))


def thrust_moment(structure: PodiumStructure, trace: Trace) -> Array:
    """What leaning thrust lines and drifts add to that moment (samples,) [N m]."""
    # Columns bear on the beam at the edge they turn about, or where one at rest is in equilibrium.
    b, t = structure.bearing, trace
    B = structure.weight_arm(np.abs(t.rotation))
    edge = np.sign(t.rotation) * b.semi_diagonal * B + 0.5 * t.cap_beam_displacement
    height = b.semi_diagonal * math.cos(b.alpha)
    rest = -height * (t.shear_top + t.shear_bottom)
    rest = rest / np.maximum(t.normal_top + t.normal_bottom, 1.0)
    beside = np.where(t.phase == state.FULL_CONTACT, rest, edge)
    carried = structure.cap_beam_mass + structure.superstructure_mass
    weighs = np.zeros_like(t.time)
    if (building := structure.superstructure) is not None:
        drifted = t.floor_displacements - t.cap_beam_displacement[:, None]
        weighs = t.normal_top / carried * (drifted @ building.masses)
    return t.normal_top * beside + weighs


def shock(structure: PodiumStructure, time: Array, events: Sequence[Event]) -> Array:
    """What impacts add to the force under the building (samples,) [N]."""
    # 2 B (|w-| + |w+|) on the beam rings in the floors, a chain of equal vertical springs.
    building = structure.superstructure
    found = np.zeros_like(time)
    impacts = [event for event in events if event.kind == "impact"]
    if building is None or building.vertical_period is None or not impacts:
        return found
    width = 2.0 * structure.bearing.semi_diagonal * math.sin(structure.bearing.alpha)
    at = np.array([event.time for event in impacts])
    jumps = [abs(e.rotation_rate_before) + abs(e.rotation_rate_after) for e in impacts]
    last = np.searchsorted(at, time, side="right") - 1
    rings = last >= 0
    for w, mass in zip(*building.vertical_modes, strict=True):
        xi = VERTICAL_DAMPING
        free = w * math.sqrt(1.0 - xi * xi)
        root = complex(-xi * w, free)
        # Of a jump by 1 the acceleration is the real part of this times exp(root t).
        unit = complex(2.0 * xi * w, -w * w * (1.0 - 2.0 * xi * xi) / free)
        amplitudes, amplitude = np.empty(len(at), complex), 0j
        for i, jump in enumerate(jumps):
            amplitude = amplitude * np.exp(root * (at[i] - at[max(i - 1, 0)])) + width * jump * unit
            amplitudes[i] = amplitude
        since = time[rings] - at[last[rings]]
        found[rings] += mass * (amplitudes[last[rings]] * np.exp(root * since)).real
    return found
