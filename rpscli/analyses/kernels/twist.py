"""A structure that turns about the vertical as its kernel reads it, and running it."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from rpscli.analyses.kernels.history import prepare_kernel
from rpscli.analyses.kernels.systems import (
    LEAST_ERROR,
    STEP_ERROR,
    UPLIFTED_ANGLE,
    longest_free_vibration,
)
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.model.bearing import Bearing
from rpscli.model.podium import Array, PodiumStructure
from rpscli.model.twist import Twist
from rpscli.model.twisting import plan_of
from rpscli.physics.laws.geometry import cap_beam_displacement
from rpscli.physics.records import record_type
from rpscli.physics.state import RUNNING
from rpscli.physics.twist.state import COLUMN, DAMPER, MODE, SAMPLES, SLAB
from rpscli.records.ground_motion import MotionComponents

BOWL = 2e-6
"""U_c, within which the cone of rigid ends is a bowl [m]."""

NEAR = 100.0
"""Of U_c: all heads nearer to upright than this may come to rest."""

CREEPS = 1e-5
"""Rate of the twist below which friction in pivoting is viscous [rad/s]."""

MOST_STEPS = 20_000_000
"""Of one history: some minutes."""

SLOW = 1e-4
"""Speed below which friction dampers are viscous [m/s]."""

ARC = 0.2
"""Longest step over the time in which a head comes to upright, at accuracy 1."""

ROOM = 1 / 4
"""Of the step that the highest mode allows: the slab lifts its frequency."""


class TwistRun(NamedTuple):
    """What a history of a slab that turns has left behind."""

    slab: np.void  # of `physics.twist.state.SLAB`
    columns: np.ndarray  # (N,) of `COLUMN`
    samples: Array  # (rows, SAMPLES)
    places: Array  # (N, 2) from the centre [m]
    factors: Array  # (N,) on the slenderness
    critical: Array  # (N,) critical rotations [rad]


def follow_twist(
    structure: PodiumStructure, motion: MotionComponents, settings: TimeHistorySettings
) -> TwistRun:
    """Follow a slab and its columns from rest under both components."""
    from rpscli.physics.twist.run import is_twist_ready, twist_kernel  # few turn

    twist = structure.twist
    places = plan_of(structure)
    assert twist is not None and places is not None, "the structure says so"  # noqa: PT018
    factors = twist.factors_of(len(places))
    bearings = [scaled_bearing(structure.bearing, factor) for factor in factors.tolist()]
    columns = columns_of(structure, bearings, places, settings)
    modes, offset = modes_of(structure, twist, places)
    slab = slab_of(structure, twist, columns, places)
    fill_course(slab, structure, modes, motion, settings)
    ground = np.ascontiguousarray(motion.samples[[0, motion.row("y") or 0]])
    samples = np.zeros((int(slab["intervals"][0]) + 1, SAMPLES))
    dampers = dampers_of(structure)
    given = [each.view(np.recarray) for each in (slab, columns, modes, dampers)]
    prepare_kernel("kernel for slabs that turn", is_twist_ready, twist_kernel)
    twist_kernel()(*given, offset, ground, samples)
    kept = int(slab["interval"][0]) + 1
    critical = np.array([bearing.critical_rotation for bearing in bearings])
    return TwistRun(slab[0], columns, samples[:kept], places, factors, critical)


def scaled_bearing(bearing: Bearing, factor: float) -> Bearing:
    """A column of another slenderness, of the same semi-diagonal and wedge."""
    slenderness = factor * bearing.slenderness
    wedge = bearing.wedge_slenderness
    if bearing.is_flat or wedge < slenderness:
        wedge = slenderness
    return replace(bearing, slenderness=slenderness, wedge_slenderness=wedge)


def columns_of(
    structure: PodiumStructure,
    bearings: list[Bearing],
    places: Array,
    settings: TimeHistorySettings,
) -> np.ndarray:
    """(N,) columns, each with its part of the masses."""
    columns = np.zeros(len(bearings), record_type(COLUMN))
    count = len(bearings)
    mass = structure.columns_mass / count
    slab = structure.cap_beam_mass / count
    floors = structure.superstructure_mass / count
    columns["x"], columns["y"] = places.T
    columns["mass"] = mass
    columns["carried"] = 0.5 * mass + slab
    columns["weight"] = (0.5 * mass + slab + floors) * structure.gravity
    columns["one"] = 1.0 + 4.0 * slab / mass
    columns["both"] = 1.0 + 4.0 * (slab + floors) / mass
    columns["least_load"] = math.inf
    columns["vertical"] = mass / 4.0 + slab + floors
    for column, bearing in zip(columns, bearings, strict=True):
        _fill_shape(column, bearing)
        limit = settings.overturning_limit * bearing.critical_rotation
        column["vertical"] *= column["tan_a"] ** 2
        column["theta_limit"] = min(limit, bearing.largest_rotation)
    return columns


def _fill_shape(column: np.void, bearing: Bearing) -> None:
    """Geometry and inertia of a column."""
    beta = bearing.beta
    rolling = bearing.rolling
    column["diameter"] = 2.0 * bearing.semi_diagonal
    column["io_1"] = bearing.inertia_ratio - 1.0
    column["i_3"] = bearing.inertia_ratio_axial
    column["sin_a"] = math.sin(bearing.alpha)
    column["tan_a"] = math.tan(bearing.alpha)
    column["spin"] = rolling[2] if beta > 0.0 else 0.0
    column["sin_beta"] = math.sin(beta)
    column["excess_beta"] = beta - math.sin(beta)
    column["rolling"] = rolling
    column["rocking"] = bearing.rocking
    if beta > 0.0:
        moved = cap_beam_displacement(rolling, beta, math.cos(beta), math.sin(beta))
        column["beyond_beta"] = column["diameter"] * moved


def modes_of(
    structure: PodiumStructure, twist: Twist, places: Array
) -> tuple[np.ndarray, Array]:
    """Modes in x, in y and in twist, and what of the last the drifts of the first hold.

    All storeys are alike in twist but for their mass and stiffness: modes have the shapes
    of those in x, at `period_ratio` times their frequencies.
    """
    building = structure.superstructure
    if building is None:
        return np.zeros(0, record_type(MODE)), np.zeros((0, 0))
    n = building.storeys
    across = structure.across.superstructure or building
    lengths = np.ptp(places, axis=0)
    radius = gyration(places)
    modes = np.zeros(3 * n, record_type(MODE))
    ways = (
        (building, building.frequencies, 1.0),
        (across, across.frequencies, 1.0),
        (building, twist.period_ratio * building.frequencies, radius),
    )
    for axis, (of, frequencies, arm) in enumerate(ways):
        rows = modes[axis * n : (axis + 1) * n]
        rows["omega2"] = frequencies**2
        rows["two_xi_omega"] = 2.0 * of.damping_ratios * frequencies
        rows["Gamma"][:, axis] = arm * of.participation
    e_x, e_y = twist.eccentricity * lengths
    # Shapes are mass-normalised: of twist they are those of x over the radius.
    own = np.eye(n)
    other = across.shapes.T @ (building.masses[:, None] * building.shapes)
    return modes, np.vstack([-e_y / radius * own, e_x / radius * other])


def gyration(places: Array) -> float:
    """Radius of gyration of a slab as large as the plan of its columns [m]."""
    return float(np.linalg.norm(np.ptp(places, axis=0)) / math.sqrt(12.0))


def slab_of(
    structure: PodiumStructure, twist: Twist, columns: np.ndarray, places: Array
) -> np.ndarray:
    """(1,) the slab: inertia, weight, what resists a turn."""
    slab = np.zeros(1, record_type(SLAB))
    away = np.hypot(*places.T)
    held = columns["weight"] * columns["tan_a"]
    rigid = 0.0 if structure.superstructure else structure.superstructure_mass
    own = (structure.cap_beam_mass + rigid) * gyration(places) ** 2
    slab["inertia"] = own - np.sum(structure.cap_beam_mass / len(places) * away**2)
    slab["radius"] = away.max()
    slab["gravity"] = structure.gravity
    slab["pivot"] = twist.pivot_friction * columns["weight"].sum()
    slab["sinks"] = twist.seats or 0.0
    slab["held"] = held.sum()
    slab["holds"] = np.sum(held * away) if structure.bearing.alpha > 0.0 else 0.0
    slab["pushed"] = columns["carried"].sum()
    slab["bowl"] = BOWL if structure.bearing.alpha > 0.0 else 0.0
    slab["near"] = NEAR * BOWL
    slab["contact_time"] = structure.impact_law.contact_time
    slab["restitution"] = structure.restitution
    lawful = replace(structure.impact_law, loss=1.0, factor=1.0)
    of_law = replace(structure, impact_law=lawful, twist=None).restitution
    slab["loss"] = (1.0 - structure.restitution) / (1.0 - of_law) if of_law < 1.0 else 0.0
    slab["creeps"] = CREEPS
    slab["slow"] = SLOW
    slab["stands"] = structure.bearing.alpha > 0.0
    slab["outcome"] = RUNNING
    return slab


def fill_course(
    slab: np.ndarray,
    structure: PodiumStructure,
    modes: np.ndarray,
    motion: MotionComponents,
    settings: TimeHistorySettings,
) -> None:
    """Steps, samples and end of the history."""
    accuracy = settings.accuracy
    free = math.ceil(longest_free_vibration(structure, settings) / motion.dt - 1e-9)
    slab["dt"] = motion.dt
    slab["npts"] = motion.npts
    slab["intervals"] = motion.npts - 1 + free
    slab["arc"] = ARC / math.sqrt(accuracy)
    slab["step_error"] = max(STEP_ERROR * accuracy**-6, LEAST_ERROR)
    slab["until_rest"] = settings.free_vibration is None
    slab["most_steps"] = MOST_STEPS
    slab["h_most"] = motion.dt
    if len(modes):
        fastest = math.sqrt(float(modes["omega2"].max()))
        slab["h_most"] = min(motion.dt, ROOM * UPLIFTED_ANGLE / (accuracy * fastest))


def dampers_of(structure: PodiumStructure) -> np.ndarray:
    """Dampers at their places; those without any stand in the middle."""
    rows = []
    centre = plan_centre(structure)
    for device in structure.devices:
        where = np.array(device.places or [centre]) - centre
        for x, y in where.tolist():
            viscous = getattr(device, "coefficient", 0.0) / len(where)
            friction = getattr(device, "force", 0.0) / len(where)
            rows.append((x, y, viscous, friction))
    dampers = np.zeros(len(rows), record_type(DAMPER))
    for damper, row in zip(dampers, rows, strict=True):
        for name, value in zip(("x", "y", "constant", "friction"), row, strict=True):
            damper[name] = value
    return dampers


def plan_centre(structure: PodiumStructure) -> Array:
    """Middle of the columns in the coordinates of the plan [m]."""
    return np.array([np.mean(structure.rows), np.mean(structure.rows_y)])
