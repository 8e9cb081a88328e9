"""Structures and settings as the kernels read them: records of `physics.planar.state.SYSTEM`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from rpscli.analyses.kernels.step_lengths import LAST_TERM, contact_rate, uplifted_rate
from rpscli.analyses.settings import LONGEST_FREE_VIBRATION, TimeHistorySettings
from rpscli.model.devices import DEVICES
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import Superstructure
from rpscli.physics.core.records import ORDER, Record, record_type, records
from rpscli.physics.planar.state import SYSTEM

DEVICE_KINDS = {kind: code for code, kind in enumerate(DEVICES.values())}
"""Codes of laws in the kernels."""

LEAST_SHAKEN = 1e-3
"""Modes that hardly take part are not given more weight than those that take part so much."""


SYSTEMS_KEPT = 128
"""Records of systems that are kept: to make one takes longer than to copy what of it is used."""

_PLAIN = record_type(SYSTEM)
_SQUARE = ("phi", "storey_shear_of")
"""Matrices of modes, most of a record, which stand together; of few storeys little is used."""


def stacked_systems(systems: Sequence[tuple[PodiumStructure, TimeHistorySettings]]) -> Record:
    """Structures with the same number of storeys, each with its settings: (S,) records to read."""
    if len(systems) == 1:
        return _system(*systems[0])
    stacked = records(SYSTEM, count=len(systems))
    n, rows = systems[0][0].storeys, stacked.view(_PLAIN, np.ndarray)
    places = [_PLAIN.fields[name][1] for name in _SQUARE]  # type: ignore[index]
    before, behind = min(places), max(places) + _PLAIN[_SQUARE[0]].itemsize
    into = rows.view(np.uint8).reshape(len(systems), -1)
    for row, (structure, settings) in enumerate(systems):
        plain = _system(structure, settings).view(_PLAIN, np.ndarray)
        numbers = plain.view(np.uint8)
        into[row, :before], into[row, behind:] = numbers[:before], numbers[behind:]
        for name in _SQUARE:
            rows[name][row, :n, :n] = plain[name][0, :n, :n]
    return stacked


@lru_cache(SYSTEMS_KEPT)
def _system(structure: PodiumStructure, settings: TimeHistorySettings) -> Record:
    """One structure with its settings, (1,)."""
    system = records(SYSTEM)
    record = system.view(_PLAIN, np.ndarray)[0]  # attributes take ten times as long
    fill_podium(record, structure)
    fill_settings(record, structure, settings)
    if structure.superstructure is not None:
        fill_building(record, structure.superstructure)
    return system


def building_system(building: Superstructure) -> Record:
    """A building alone, (1,): what full contact on a fixed base reads."""
    system = records(SYSTEM)
    fill_building(system.view(_PLAIN, np.ndarray)[0], building)
    return system


def fill_podium(record: Record, structure: PodiumStructure) -> None:
    """The rocking storey."""
    b = structure.bearing
    record["n"] = structure.storeys
    record["R"], record["alpha"], record["beta"] = b.semi_diagonal, b.alpha, b.beta
    record["theta_cr"] = b.critical_rotation
    record["rolling"], record["rocking"] = b.rolling, b.rocking
    record["Io"], record["gamma"], record["eta"] = b.inertia_ratio, structure.gamma, structure.eta
    record["columns_mass"] = structure.columns_mass
    record["cap_beam_mass"] = structure.cap_beam_mass
    record["floors_mass"] = structure.superstructure_mass
    record["gravity"] = structure.gravity
    record["restitution"] = structure.restitution
    record["floors_jump"] = structure.impact_law.floors_jump
    fill_devices(record, structure)


LINEAR_SPEED = 1e-8
"""Of sqrt(g R): up to this velocity a power of it is taken as linear, too little to be felt."""


def fill_devices(record: Record, structure: PodiumStructure) -> None:
    """The devices, each with the constants of its law."""
    record["columns"], record["devices"] = structure.columns, len(structure.devices)
    speed = math.sqrt(structure.gravity * structure.bearing.semi_diagonal)
    record["linear_speed"] = LINEAR_SPEED * speed
    for i, device in enumerate(structure.devices):
        record["device_kind"][i] = DEVICE_KINDS[type(device)]
        constants = device.constants(structure)
        record["device_constants"][i, : len(constants)] = constants


def fill_settings(
    record: Record, structure: PodiumStructure, settings: TimeHistorySettings
) -> None:
    """How the motion is followed.

    Raises
    ------
    ValueError
        If the structure would start beyond the overturning limit, or the model ends before it.
    """
    critical, end = structure.critical_rotation, structure.bearing.largest_rotation
    limit = settings.overturning_limit * critical
    if limit > end:
        raise ValueError(
            f"overturning_limit = {settings.overturning_limit:.6g} times theta_cr must not exceed"
            f" {end:.6g} rad, where the columns lie down; use less than {end / critical:.4g}"
        )
    if abs(settings.initial_rotation) >= limit:
        raise ValueError(
            f"initial_rotation = {settings.initial_rotation:.6g} rad must stay below the"
            f" overturning limit {limit:.6g} rad"
        )
    free = settings.free_vibration
    record["theta_limit"] = limit
    record["uplifted_rate"] = settings.accuracy * uplifted_rate(structure)
    record["contact_rate"] = contact_rate(structure)
    record["last_term"] = LAST_TERM * settings.accuracy**-ORDER
    record["recontact_tolerance"] = settings.recontact_tolerance
    record["bounces"] = bounces_left_out(structure) if settings.recontact_rule == "limit" else 0.0
    record["max_events"] = settings.max_events
    record["initial_rotation"] = settings.initial_rotation
    record["free_vibration"] = LONGEST_FREE_VIBRATION if free is None else free
    record["until_rest"] = free is None


def bounces_left_out(structure: PodiumStructure) -> float:
    """What the impacts after re-contact would add to each floor's relative velocity, over u_b'.

    Left to bounce for ever, the cap beam stops, and the floors keep their absolute velocity but
    for the jumps of the impact law: 2/(1 + e) if they jump with the beam, 1 if they do not
    (Theory, section 3).
    """
    return 2.0 / (1.0 + structure.restitution) if structure.impact_law.floors_jump else 1.0


def fill_building(record: Record, building: Superstructure) -> None:
    """The modes of the fixed base, mass-normalised, with the storey shears of each.

    The weights of `physics.planar.demands` may be any; these, tried on buildings of three and nine
    storeys, let the fewest steps pass the bound.
    """
    n = record["n"] = building.storeys
    omega, xi, shapes = building.frequencies, building.damping_ratios, building.shapes.T
    omega2, shaken = omega * omega, np.abs(building.participation)
    shaken = np.maximum(shaken, LEAST_SHAKEN * shaken.max())
    shears = np.diff(shapes, prepend=0.0) * building.stiffnesses
    record["omega"][:n], record["xi"][:n], record["Gamma"][:n] = omega, xi, building.participation
    record["omega2"][:n], record["two_xi_omega"][:n] = omega2, 2.0 * xi * omega
    record["phi"][:n, :n], record["storey_shear_of"][:n, :n] = shapes, shears
    of_shears, of_accelerations = omega**3 * shaken**-0.3, omega**-0.6 * shaken**-0.5
    record["shear_weight"][:n], record["acceleration_weight"][:n] = of_shears, of_accelerations
    record["shear_bound_of"][:n] = 1.0 / np.sum(shears.T**2 / of_shears, axis=1)
    record["acceleration_bound_of"][:n] = 1.0 / np.sum(shapes.T**2 / of_accelerations, axis=1)
