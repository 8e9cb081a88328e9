"""Structure, record and settings as the kernels want them."""

from __future__ import annotations

import math

import numpy as np

from rpscli.analyses.settings import LONGEST_FREE_VIBRATION, TimeHistorySettings
from rpscli.model.damping import RayleighDamping
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import Superstructure
from rpscli.physics.parameters import Floors, Ground, Numerics, Podium
from rpscli.records.ground_motion import GroundMotion

FLIGHT_ANGLE = 0.25
"""Largest step times the highest uplifted frequency [rad], at accuracy 1; see `tests/physics`."""

CONTACT_ANGLE = 0.5
"""The same for the exact steps in full contact, where it only guards the search of uplift."""


def podium_parameters(structure: PodiumStructure, settings: TimeHistorySettings) -> Podium:
    """Parameters of the rocking storey."""
    b = structure.bearing
    return Podium(
        R=b.semi_diagonal,
        alpha=b.alpha,
        beta=b.beta,
        theta_cr=b.critical_rotation,
        theta_limit=settings.overturning_limit * b.critical_rotation,
        rolling=b.rolling,
        rocking=b.rocking,
        Io=b.inertia_ratio,
        gamma=structure.gamma,
        eta=structure.eta,
        columns_mass=structure.columns_mass,
        cap_beam_mass=structure.cap_beam_mass,
        floors_mass=structure.superstructure_mass,
        gravity=structure.gravity,
        restitution=structure.restitution,
        floors_jump=structure.impact_law.floors_jump,
    )


def floor_parameters(building: Superstructure | None) -> Floors:
    """Parameters of the building; empty arrays without one."""
    if building is None:
        none, square = np.empty(0), np.empty((0, 0))
        return Floors(none, none, none, 0.0, 0.0, square, none, none, square, none)
    a0, a1, full = 0.0, 0.0, np.empty((0, 0))
    if isinstance(building.damping, RayleighDamping):
        a0, a1 = building.damping.coefficients(building.frequencies)
    else:
        full = np.ascontiguousarray(building.damping_matrix)
    return Floors(
        mass=np.array(building.masses),
        inverse_mass=1.0 / building.masses,
        stiffness=np.array(building.stiffnesses),
        a0=a0,
        a1=a1,
        damping=full,
        omega=building.frequencies,
        xi=building.damping_ratios,
        shapes=np.ascontiguousarray(building.shapes),
        participation=building.participation,
    )


def ground_parameters(record: GroundMotion, vertical: GroundMotion | None) -> Ground:
    """Ground acceleration of one or two components; the shorter one goes on as zero."""
    horizontal = np.array(record.acceleration)
    if vertical is None:
        return Ground(horizontal, np.empty(0), record.dt)
    length = max(record.npts, vertical.npts)
    padded = [np.pad(m.acceleration, (0, length - m.npts)) for m in (record, vertical)]
    return Ground(padded[0], padded[1], record.dt)


def numerics(structure: PodiumStructure, dt: float, settings: TimeHistorySettings) -> Numerics:
    """Steps within a record interval, and how long to go on after its end."""
    highest = highest_frequency(structure)
    free = settings.free_vibration
    longest = LONGEST_FREE_VIBRATION if free is None else free
    return Numerics(
        substeps=max(1, math.ceil(dt * highest * settings.accuracy / FLIGHT_ANGLE)),
        contact_substeps=max(1, math.ceil(dt * highest / CONTACT_ANGLE)),
        free_samples=math.ceil(longest / dt - 1e-9),
        until_rest=free is None,
        recontact_tolerance=settings.recontact_tolerance,
        max_events=settings.max_events,
        initial_rotation=settings.initial_rotation,
    )


def highest_frequency(structure: PodiumStructure) -> float:
    """A bound on the frequencies of the uplifted structure [rad/s].

    Freeing the cap beam, whose inertia is at least N m_c Io/4 + m_b, adds at most the first storey
    spring over that mass (Theory, section 6; Weyl's inequality).
    """
    square = (structure.gravity / structure.bearing.semi_diagonal) * (
        1.0 + abs(2.0 * structure.bearing.curvature_ratio - 1.0)
    )
    if structure.superstructure is not None:
        building = structure.superstructure
        freed = 0.25 * structure.columns_mass * structure.bearing.inertia_ratio
        base = building.stiffnesses[0] / (freed + structure.cap_beam_mass)
        square += float(building.frequencies[-1] ** 2 + base)
    return math.sqrt(square)
