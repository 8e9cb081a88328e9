"""Structures, records and histories stacked into the arrays that the kernels read."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.kernel_input import podium_parameters
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.model.podium import PodiumStructure
from rpscli.physics import contact_layout, layout
from rpscli.physics.parameters import Podium, Points, Systems, podium_numbers
from rpscli.records.ground_motion import GroundMotion

LEAST_SHAKEN = 1e-3
"""Modes that hardly take part are not given more weight than those that take part so much."""


def stacked_systems(
    systems: Sequence[tuple[PodiumStructure, TimeHistorySettings]],
) -> Systems:
    """Structures with the same number of floors, stacked."""
    podiums = [podium_parameters(*system) for system in systems]
    structures = [structure for structure, _ in systems]
    return Systems(
        podium=np.array([podium_numbers(podium) for podium in podiums]),
        column=np.array([lane_column(s, p) for s, p in zip(structures, podiums, strict=True)]),
        modes=np.array([modal_rows(structure) for structure in structures]),
    )


def lane_column(structure: PodiumStructure, podium: Podium) -> NDArray[np.float64]:
    """What stands in the buffer of a lane at rest: constants folded as `physics.layout` says."""
    n = structure.storeys
    scalars, blocks = np.zeros(layout.SCALARS), np.zeros((layout.BLOCKS, n))
    own, carried = 1.0 + 2.0 * podium.gamma, 2.0 * podium.gamma * podium.eta
    for row, value in {
        layout.DIAMETER: 2.0 * podium.R,
        layout.INERTIA: podium.Io - 1.0,
        layout.BEAM: 1.0 + 4.0 * podium.gamma,
        layout.BUILDING: 2.0 * carried,
        layout.WEIGHT: (own + carried) / podium.R,
        layout.PUSH: own / podium.R,
        layout.SHEAR: 2.0 / (podium.columns_mass * podium.R),
        layout.COLUMNS_MASS: podium.columns_mass,
        layout.CAP_BEAM_MASS: podium.cap_beam_mass,
        layout.FLOORS_MASS: podium.floors_mass,
        layout.STANDARD_GRAVITY: podium.gravity,
        layout.THETA_CR: podium.theta_cr,
        layout.LAST_TERM: podium.last_term,
        layout.SIDE: 1.0,
        layout.CRITICAL_TIME: -1.0,
        layout.NORMAL_TOP: math.inf,
        layout.NORMAL_BOTTOM: math.inf,
    }.items():
        scalars[row] = value
    modes = modal_rows(structure)
    for block, row in {
        layout.SQUARE: contact_layout.SQUARE,
        layout.DRAG: contact_layout.DRAG,
        layout.PARTICIPATION: contact_layout.PARTICIPATION,
        layout.STRAIN_WEIGHT: contact_layout.STRAIN_WEIGHT,
        layout.PULLED_WEIGHT: contact_layout.PULLED_WEIGHT,
    }.items():
        blocks[block] = modes[row]
    shapes, shears = np.split(modes[contact_layout.SHAPES :], 2)
    blocks[layout.STRAIN_BOUND] = 1.0 / np.sum(shears.T**2 / blocks[layout.STRAIN_WEIGHT], axis=1)
    blocks[layout.PULLED_BOUND] = 1.0 / np.sum(shapes.T**2 / blocks[layout.PULLED_WEIGHT], axis=1)
    return np.concatenate((scalars, blocks.ravel(), shapes.ravel(), shears.ravel()))


def modal_rows(structure: PodiumStructure) -> NDArray[np.float64]:
    """What stands in the modal rows of a lane at rest (25 + 2 n, n), see `contact_layout`.

    The modes are those of the fixed base, mass-normalised, with the storey shears
    k_i (phi_i - phi_{i-1}) of each, and Gamma_r = phi_r^T M 1. The weights of
    `physics.floor_demands` are best where what a mode adds to a demand is in proportion to its
    weighted square; pulls are as large as Gamma_r, if all modes shake alike.
    """
    n, building = structure.storeys, structure.superstructure
    rows = np.zeros((contact_layout.SHAPES + 2 * n, n))
    if building is not None:
        omega, xi, shapes = building.frequencies, building.damping_ratios, building.shapes.T
        square, shaken = omega * omega, np.abs(building.participation)
        weight = 1.0 / np.maximum(shaken, LEAST_SHAKEN * shaken.max())
        rows[contact_layout.OMEGA], rows[contact_layout.XI] = omega, xi
        rows[contact_layout.PARTICIPATION] = building.participation
        rows[contact_layout.SQUARE] = square
        rows[contact_layout.DRAG] = 2.0 * xi * omega
        rows[contact_layout.STRAIN_WEIGHT] = square * square * weight
        rows[contact_layout.PULLED_WEIGHT] = weight
        rows[contact_layout.SHAPES : contact_layout.SHAPES + n] = shapes
        rows[contact_layout.SHAPES + n :] = np.diff(shapes, prepend=0.0) * building.stiffnesses
    return rows


def joined(records: Sequence[GroundMotion]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Accelerations of records end to end, and where each of them starts."""
    npts = np.array([0] + [r.npts for r in records])
    return np.concatenate([r.acceleration for r in records]), np.cumsum(npts)[:-1]


def point(
    system: int, record: GroundMotion, start: int, vertical_start: int | None, scale: float
) -> tuple[list[int], list[float]]:
    """Whole numbers and numbers of a history to run, see `Points`.

    `start` and `vertical_start` are the offsets of its records among all.
    """
    above = -1 if vertical_start is None else vertical_start
    return [system, start, record.npts, above], [scale, record.dt]


def points(rows: Sequence[tuple[list[int], list[float]]]) -> Points:
    """Histories to run, stacked."""
    return Points(
        np.array([integers for integers, _ in rows], dtype=np.int64),
        np.array([numbers for _, numbers in rows]),
    )
