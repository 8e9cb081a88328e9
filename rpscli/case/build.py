"""A validated case file -> the structure and the settings of its analysis."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from rpscli.analyses.settings import TimeHistorySettings
from rpscli.case.schema.case_file import (
    AnalysisSection,
    BearingSection,
    CaseFile,
    DimensionsSection,
    PlanSection,
    PodiumMasses,
    SuperstructureSection,
)
from rpscli.model.bearing import Bearing, first_order_critical_curvature_ratio
from rpscli.model.contact import USUAL_LOSS, Contact
from rpscli.model.devices import DEVICES
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import (
    ModalDamping,
    RayleighDamping,
    Superstructure,
    profile_stiffnesses,
)


class Shape(NamedTuple):
    """Ratios of a column; `wedge_slenderness` equals `slenderness` where flat ends leave it out."""

    semi_diagonal: float
    slenderness: float
    wedge_slenderness: float
    curvature_ratio: float


class Podium(NamedTuple):
    """Columns and cap beam, and what they carry."""

    bearing: Bearing
    columns_mass: float
    cap_beam_mass: float
    building_mass: float
    impact_law: ImpactLaw

    @property
    def gamma(self) -> float:
        """m_b/(N m_c)."""
        return self.cap_beam_mass / self.columns_mass

    @property
    def eta(self) -> float:
        """M_tot/m_b; 0 without a cap beam."""
        return self.building_mass / self.cap_beam_mass if self.cap_beam_mass else 0.0


def shape_of(bearing: BearingSection) -> Shape | None:
    """The shape, or None if the description is not complete."""
    if bearing.dimensions is not None:
        return _shape_of_dimensions(bearing.dimensions)
    R, slenderness, wedge = bearing.semi_diagonal, bearing.slenderness, bearing.wedge_slenderness
    rho = bearing.curvature_ratio
    if R is None or slenderness is None or rho is None or (wedge is None and rho != 0.0):
        return None
    if wedge is None:
        wedge = slenderness
    if isinstance(rho, str):
        rho = first_order_critical_curvature_ratio(slenderness, wedge)
    return Shape(R, slenderness, wedge, rho)


def _shape_of_dimensions(sizes: DimensionsSection) -> Shape | None:
    if sizes.wedge_width is None and sizes.radius != 0.0:
        return None
    wedge = sizes.width if sizes.wedge_width is None else sizes.wedge_width
    h = sizes.height
    return Shape(0.5 * math.hypot(h, sizes.width), sizes.width / h, wedge / h, sizes.radius / h)


def podium_of(file: CaseFile, shape: Shape) -> Podium:
    """The podium that a validated case file describes, with columns of a given shape."""
    total = building_mass(file.superstructure)
    columns, cap_beam = podium_masses(file.podium, total)
    impact = file.podium.impact.model_dump(exclude={"law"})
    if impact["loss"] is None:
        impact["loss"] = USUAL_LOSS[file.podium.contact.kind]
    return Podium(
        Bearing(
            *shape,
            inertia_ratio=file.podium.bearing.inertia_ratio,
            inertia_ratio_axial=file.podium.bearing.inertia_ratio_axial or math.nan,
        ),
        columns,
        cap_beam,
        total,
        ImpactLaw(**impact, kind=file.podium.impact.law),
    )


def podium_structure(podium: Podium, file: CaseFile) -> PodiumStructure:
    """The whole structure: the podium with the building on it."""
    return PodiumStructure(
        bearing=podium.bearing,
        columns_mass=podium.columns_mass,
        cap_beam_mass=podium.cap_beam_mass,
        superstructure=building(file.superstructure),
        impact_law=podium.impact_law,
        gravity=file.analysis.gravity,
        devices=tuple(
            DEVICES[section.kind](**section.model_dump(exclude={"kind"}, exclude_none=True))
            for section in file.podium.devices
        ),
        columns=file.podium.columns or 1,
        friction=file.podium.friction,
        rows=_rows(file.podium.plan),
        superstructure_y=_across(file.superstructure),
        contact=Contact(**file.podium.contact.model_dump()),
    )


def _across(section: SuperstructureSection) -> Superstructure | None:
    """The building in y; None where it is that in x."""
    if section.y is None:
        return None
    return building(section.model_copy(update=section.y.model_dump()))


def _rows(plan: PlanSection | None) -> tuple[float, ...]:
    if plan is None:
        return ()
    return plan.rows or (0.0, plan.length or 0.0)


def building(section: SuperstructureSection) -> Superstructure | None:
    """The shear building; None for no storeys."""
    n, given, height = section.storeys, section.damping, section.storey_height
    if n == 0:
        return None
    assert given is not None, "the rules of the case make sure that damping is given"
    masses = np.array(each_storey(section.storey_mass, n))
    if section.period is None:
        stiffnesses = np.array(each_storey(section.stiffness, n))
    else:
        stiffnesses = profile_stiffnesses(masses, section.period, section.profile or "sine")
    heights = None if height is None else np.array(each_storey(height, n))
    damping: RayleighDamping | ModalDamping = ModalDamping(given.ratio)
    if given.modes is not None:
        damping = RayleighDamping(given.ratio, given.modes)
    return Superstructure(masses, stiffnesses, damping, heights, section.vertical_period)


def each_storey(value: float | tuple[float, ...] | None, storeys: int) -> list[float]:
    """One value for each storey from the bottom."""
    assert value is not None, "the rules of the case make sure that the value is given"
    return list(value) if isinstance(value, tuple) else [value] * storeys


def building_mass(section: SuperstructureSection) -> float:
    """M_tot [kg]; 0 without storeys."""
    return sum(each_storey(section.storey_mass, section.storeys)) if section.storeys else 0.0


def podium_masses(section: PodiumMasses, building_mass: float) -> tuple[float, float]:
    """N m_c and m_b [kg] from the masses and ratios that are given (Theory, section 2)."""
    gamma, eta = section.cap_beam_mass_ratio, section.superstructure_mass_ratio
    columns, beam = None, section.cap_beam_mass
    if section.column_mass is not None:
        columns = section.column_mass * (section.columns or 1)
    if section.without_cap_beam:
        beam = 0.0
    elif eta is not None:
        beam = building_mass / eta
    elif beam is None and gamma is not None and columns is not None:
        beam = gamma * columns
    if columns is None and gamma and beam is not None:
        columns = beam / gamma
    assert columns is not None, "the rules of the case make sure that the masses are complete"
    assert beam is not None, "the rules of the case make sure that the masses are complete"
    return columns, beam


def overturning_limit(section: AnalysisSection, bearing: Bearing) -> float:
    """What counts as overturned, over theta_cr: the least of what the case names."""
    found, critical = [section.overturning_limit], bearing.critical_rotation
    if section.overturning_rotation is not None:
        found.append(section.overturning_rotation / critical)
    if section.overturning_displacement is not None:
        found.append(bearing.rotation_at(section.overturning_displacement) / critical)
    return min(found)


def time_history_settings(section: AnalysisSection, bearing: Bearing) -> TimeHistorySettings:
    """Settings of the time history; gravity belongs to the structure."""
    others = {"gravity", "overturning_rotation", "overturning_displacement"}
    given = section.model_dump(exclude=others)
    given["overturning_limit"] = overturning_limit(section, bearing)
    if given["free_vibration"] == "auto":
        given["free_vibration"] = None
    return TimeHistorySettings(**given)
