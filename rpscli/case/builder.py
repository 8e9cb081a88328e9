"""A validated case file -> the structure and the settings of its analysis."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.settings import TimeHistorySettings
from rpscli.case.bearing_shape import shape_of
from rpscli.case.rules_masses import without_beam
from rpscli.case.schema import (
    AnalysisSection,
    BearingSection,
    CaseFile,
    ImpactSection,
    PodiumMasses,
    SuperstructureSection,
)
from rpscli.model.bearing import Bearing
from rpscli.model.damping import ModalDamping, RayleighDamping
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import Superstructure, profile_stiffnesses


class StoreyMasses(NamedTuple):
    """Masses of the rocking storey [kg]: all columns together, and the cap beam."""

    columns: float
    cap_beam: float


def podium_structure(file: CaseFile) -> PodiumStructure:
    """The structure that a validated case file describes.

    Raises
    ------
    ValueError
        If the structure is outside the model (restitution <= 0, numbers that overflow).
    """
    masses = storey_masses(file.podium, building_mass(file.superstructure))
    return PodiumStructure(
        bearing=bearing(file.podium.bearing),
        columns_mass=masses.columns,
        cap_beam_mass=masses.cap_beam,
        superstructure=building(file.superstructure),
        impact_law=impact_law(file.podium.impact),
        gravity=file.analysis.gravity,
    )


def bearing(section: BearingSection) -> Bearing:
    """The column, from ratios or from dimensions."""
    shape = shape_of(section)
    assert shape is not None, "the rules of the case make sure that the shape is complete"
    return Bearing(*shape, inertia_ratio=section.inertia_ratio)


def building(section: SuperstructureSection) -> Superstructure | None:
    """The shear building; None for no storeys."""
    n = section.storeys
    if n == 0:
        return None
    masses = _array(section.storey_mass, n)
    if section.period is None:
        stiffnesses = _array(section.stiffness, n)
    else:
        profile = section.profile or "sine"
        stiffnesses = profile_stiffnesses(masses, section.period, profile)
    heights = None if section.storey_height is None else _array(section.storey_height, n)
    return Superstructure(masses, stiffnesses, damping(section), heights)


def damping(section: SuperstructureSection) -> RayleighDamping | ModalDamping:
    """Rayleigh damping if two modes are named, else the ratio in every mode."""
    given = section.damping
    assert given is not None, "the rules of the case make sure that damping is given"
    if given.modes is None:
        return ModalDamping(given.ratio)
    return RayleighDamping(given.ratio, given.modes)


def each_storey(value: float | tuple[float, ...] | None, storeys: int) -> list[float]:
    """One value for each storey from the bottom.

    >>> each_storey(3.0, 2), each_storey((4.0, 3.0), 2)
    ([3.0, 3.0], [4.0, 3.0])
    """
    assert value is not None, "the rules of the case make sure that the value is given"
    return list(value) if isinstance(value, tuple) else [value] * storeys


def _array(value: float | tuple[float, ...] | None, storeys: int) -> NDArray[np.float64]:
    return np.array(each_storey(value, storeys))


def building_mass(section: SuperstructureSection) -> float:
    """M_tot [kg]; 0 without storeys."""
    return sum(each_storey(section.storey_mass, section.storeys)) if section.storeys else 0.0


def storey_masses(section: PodiumMasses, building_mass: float) -> StoreyMasses:
    """N m_c and m_b from the masses and ratios that are given (Theory, section 2)."""
    gamma, eta = section.cap_beam_mass_ratio, section.superstructure_mass_ratio
    columns, beam = None, section.cap_beam_mass
    if section.column_mass is not None:
        columns = section.column_mass * (section.columns or 1)
    if without_beam(section):
        beam = 0.0
    elif eta is not None:
        beam = building_mass / eta
    elif beam is None and gamma is not None and columns is not None:
        beam = gamma * columns
    if columns is None and gamma and beam is not None:
        columns = beam / gamma
    assert columns is not None, "the rules of the case make sure that the masses are complete"
    assert beam is not None, "the rules of the case make sure that the masses are complete"
    return StoreyMasses(columns, beam)


def impact_law(section: ImpactSection) -> ImpactLaw:
    """The impact law."""
    return ImpactLaw(section.law, section.restitution, section.factor)


def time_history_settings(section: AnalysisSection) -> TimeHistorySettings:
    """Settings of the time history; gravity belongs to the structure."""
    auto = isinstance(section.free_vibration, str)
    return TimeHistorySettings(
        free_vibration=None if auto else float(section.free_vibration),
        recontact_tolerance=section.recontact_tolerance,
        recontact_rule=section.recontact_rule,
        initial_rotation=section.initial_rotation,
        overturning_limit=section.overturning_limit,
        accuracy=section.accuracy,
        max_events=section.max_events,
    )
