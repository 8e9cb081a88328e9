"""Structures and settings as the kernels want them: parameters and lengths of steps."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from rpscli.analyses.settings import LONGEST_FREE_VIBRATION, TimeHistorySettings
from rpscli.model.podium import PodiumStructure
from rpscli.physics.layout import ORDER
from rpscli.physics.parameters import Podium
from rpscli.records.ground_motion import GroundMotion

FLIGHT_ANGLE = 0.6
"""Largest Taylor step times the highest uplifted frequency [rad], at accuracy 1."""

FLIGHT_DECAY = 1.0
"""Largest step times the fastest decay rate, where that asks for more: Taylor steps of order 7
are unstable beyond about 4. Only strongly overdamped modes come near."""

LAST_TERM = 1e-6
"""Largest last term of the series of a step, over its first three, at accuracy 1; what a series
omits is smaller still. Steps made for the fastest mode hardly ever come near. Where the tilt itself
changes faster, in large rotations of short columns or past theta_cr under floors that weigh
hundreds of them, they are halved."""

CONTACT_ANGLE = 1.0
"""The same for the exact steps in full contact, where it guards the search of uplift: the quintic
between two instants errs by (w h)^6/46080 of a mode's push."""


def podium_parameters(structure: PodiumStructure, settings: TimeHistorySettings) -> Podium:
    """Parameters of the rocking storey and of the way its motion is followed."""
    b = structure.bearing
    limit = settings.overturning_limit * b.critical_rotation
    if abs(settings.initial_rotation) >= limit:
        raise ValueError(
            f"initial_rotation = {settings.initial_rotation:.6g} rad must stay below the"
            f" overturning limit {limit:.6g} rad"
        )
    free = settings.free_vibration
    return Podium(
        R=b.semi_diagonal,
        alpha=b.alpha,
        beta=b.beta,
        theta_cr=b.critical_rotation,
        theta_limit=limit,
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
        floors_jump=float(structure.impact_law.floors_jump),
        flight_rate=settings.accuracy * flight_rate(structure),
        contact_rate=highest_frequency(structure) / CONTACT_ANGLE,
        last_term=LAST_TERM * settings.accuracy**-ORDER,
        recontact_tolerance=settings.recontact_tolerance,
        bounces=bounces_left_out(structure) if settings.recontact_rule == "limit" else 0.0,
        max_events=float(settings.max_events),
        initial_rotation=settings.initial_rotation,
        free_vibration=LONGEST_FREE_VIBRATION if free is None else free,
        until_rest=float(free is None),
    )


def bounces_left_out(structure: PodiumStructure) -> float:
    """What the impacts after re-contact would add to each floor's relative velocity, over u_b'.

    Left to bounce for ever, the cap beam stops, and the floors keep their absolute velocity but
    for the jumps of the impact law: 2/(1 + e) if they jump with the beam, 1 if they do not
    (Theory, section 3).
    """
    return 2.0 / (1.0 + structure.restitution) if structure.impact_law.floors_jump else 1.0


def flight_rate(structure: PodiumStructure) -> float:
    """Taylor steps a second that follow the uplifted structure at accuracy 1 [1/s]."""
    by_angle = highest_frequency(structure) / FLIGHT_ANGLE
    return max(by_angle, fastest_decay(structure) / FLIGHT_DECAY)


def highest_frequency(structure: PodiumStructure) -> float:
    """A bound on the frequencies of the uplifted structure [rad/s].

    Freeing the cap beam, whose inertia is at least N m_c Io/4 + m_b, adds at most the first storey
    spring over that mass (Theory, section 6; Weyl's inequality).
    """
    square = (structure.gravity / structure.bearing.semi_diagonal) * (
        1.0 + abs(2.0 * structure.bearing.curvature_ratio - 1.0)
    )
    if (building := structure.superstructure) is not None:
        base = building.stiffnesses[0] / least_base_mass(structure)
        square += float(building.frequencies[-1] ** 2 + base)
    return math.sqrt(square)


def fastest_decay(structure: PodiumStructure) -> float:
    """A bound on the decay rates of the uplifted structure [1/s], by the same inequality for C."""
    if (building := structure.superstructure) is None:
        return 0.0
    fixed = np.max(2.0 * building.damping_ratios * building.frequencies)
    return float(fixed + building.damping_matrix.sum() / least_base_mass(structure))


def least_base_mass(structure: PodiumStructure) -> float:
    """Inertia against u_b at theta = 0 without the floors: columns and cap beam [kg]."""
    return 0.25 * structure.columns_mass * structure.bearing.inertia_ratio + structure.cap_beam_mass


def aligned(
    record: GroundMotion, vertical: GroundMotion | None
) -> tuple[GroundMotion, GroundMotion | None]:
    """Both components with the same number of samples: the shorter one goes on as zero.

    Raises
    ------
    ValueError
        If their time steps differ.
    """
    if vertical is None or (vertical.npts == record.npts and vertical.dt == record.dt):
        return record, vertical
    if vertical.dt != record.dt:
        raise ValueError(
            f"the vertical record has dt = {vertical.dt} s, the horizontal one {record.dt} s:"
            " they must agree"
        )
    npts = max(record.npts, vertical.npts)
    along, upwards = (
        replace(m, acceleration=np.pad(m.acceleration, (0, npts - m.npts)))
        for m in (record, vertical)
    )
    return along, upwards
