"""A consistent case file -> the structure and the settings of its analysis."""

from __future__ import annotations

import math

import numpy as np

from rpscli.analyses.settings import TimeHistorySettings
from rpscli.case.schema.case_file import (
    AnalysisSection,
    BearingSection,
    CaseFile,
    DeviceSection,
    PodiumSection,
    SuperstructureSection,
)
from rpscli.model.bearing import Bearing, first_order_critical_curvature_ratio
from rpscli.model.column import ColumnDesign
from rpscli.model.contact import USUAL_LOSS, Contact
from rpscli.model.devices import DAMPERS, OwnDamper
from rpscli.model.impact import IMPACT_LAWS, ImpactLaw
from rpscli.model.own import DamperLaw
from rpscli.model.podium import Device, PodiumStructure
from rpscli.model.superstructure import (
    VERTICAL_DAMPING,
    ModalDamping,
    RayleighDamping,
    Superstructure,
    first_mode_strengths,
    profile_stiffnesses,
)

COMPLETE = "the rules of the case make sure that the value is given"


def bearing_of(section: BearingSection) -> Bearing:
    """The column, from ratios or sizes; flat ends may leave out their wedge."""
    kept = {"inertia_ratio", "inertia_ratio_axial"}
    given = section.model_dump(include=kept, exclude_none=True)
    if (sizes := section.dimensions) is not None:
        h, width = sizes.height, sizes.width
        wedge = width if sizes.wedge_width is None else sizes.wedge_width
        shape = 0.5 * math.hypot(h, width), width / h, wedge / h, sizes.radius / h
        return Bearing(*shape, **given)
    R, slenderness, rho = section.semi_diagonal, section.slenderness, section.curvature_ratio
    assert R is not None and slenderness is not None and rho is not None, COMPLETE  # noqa: PT018
    wedge = slenderness if section.wedge_slenderness is None else section.wedge_slenderness
    if isinstance(rho, str):
        rho = first_order_critical_curvature_ratio(slenderness, wedge)
    return Bearing(R, slenderness, wedge, rho, **given)


def impact_law_of(section: PodiumSection) -> ImpactLaw:
    """The impact law; how much it loses goes by the contact unless the case says it."""
    given = section.impact.model_dump(exclude={"law", "loss"})
    name, loss, own = section.impact.law, section.impact.loss, IMPACT_LAWS[section.impact.law]
    if own is not None:
        given |= {"own": own, "constants": tuple(given.pop(each) for each in own.constants)}
        loss = 1.0 if loss is None else loss
    loss = USUAL_LOSS[section.contact.kind] if loss is None else loss
    return ImpactLaw(name, loss=loss, **given)


def masses_of(file: CaseFile) -> tuple[float, float, float]:
    """N m_c, m_b and M_tot [kg], from those and the ratios that are given (Theory, section 2)."""
    podium, floors = file.podium, file.superstructure
    building = sum(each_storey(floors.storey_mass, floors.storeys)) if floors.storeys else 0.0
    gamma, eta = podium.cap_beam_mass_ratio, podium.superstructure_mass_ratio
    columns, beam = None, podium.cap_beam_mass
    if podium.column_mass is not None:
        columns = podium.column_mass * (podium.columns or 1)
    if podium.without_cap_beam:
        beam = 0.0
    elif eta is not None:
        beam = building / eta
    elif beam is None and gamma is not None and columns is not None:
        beam = gamma * columns
    if columns is None and gamma and beam is not None:
        columns = beam / gamma
    assert columns is not None, COMPLETE
    assert beam is not None, COMPLETE
    return columns, beam, building


def structure_of(bearing: Bearing, file: CaseFile) -> PodiumStructure:
    """The whole structure: columns and cap beam with the building on them."""
    podium, floors, plan = file.podium, file.superstructure, file.podium.plan
    column = None
    if (of := podium.column) is not None:
        own, plate = of.model_dump(exclude={"on"}), of.on
        column = ColumnDesign(**own, plate_modulus=plate.modulus, plate_poisson=plate.poisson)
    across = None if floors.y is None else floors.model_copy(update=floors.y.model_dump())
    columns, beam, floors_mass = masses_of(file)
    at_uplift = floors_mass * file.analysis.gravity * bearing.slenderness
    return PodiumStructure(
        bearing=bearing,
        columns_mass=columns,
        cap_beam_mass=beam,
        superstructure=building(floors, at_uplift),
        impact_law=impact_law_of(podium),
        gravity=file.analysis.gravity,
        devices=tuple(map(device_of, podium.devices)),
        columns=podium.columns or 1,
        friction=podium.friction,
        rows=() if plan is None else plan.rows or (0.0, plan.length or 0.0),
        superstructure_y=None if across is None else building(across, at_uplift),
        contact=Contact(**podium.contact.model_dump()),
        column=column,
    )


def device_of(section: DeviceSection) -> Device:
    """A device, of ours or of another package."""
    law, given = DAMPERS[section.kind], section.model_dump(exclude={"kind"}, exclude_none=True)
    if not isinstance(law, DamperLaw):
        return law(**given)
    return OwnDamper(section.kind, law, tuple(given[name] for name in law.constants))


def building(section: SuperstructureSection, at_uplift: float) -> Superstructure | None:
    """The shear building; None for no storeys. V_st is what ratios of strengths refer to."""
    n, given, height = section.storeys, section.damping, section.storey_height
    if n == 0:
        return None
    assert given is not None, COMPLETE
    masses = np.array(each_storey(section.storey_mass, n))
    if section.period is None:
        stiffnesses = np.array(each_storey(section.stiffness, n))
    else:
        stiffnesses = profile_stiffnesses(masses, section.period, section.profile or "sine")
    heights = None if height is None else np.array(each_storey(height, n))
    damping: RayleighDamping | ModalDamping = ModalDamping(given.ratio)
    if given.modes is not None:
        damping = RayleighDamping(given.ratio, given.modes)
    strengths, hardening = None, 0.0
    if (yields := section.yields) is not None:
        hardening = yields.hardening
        if yields.ratio is None:
            strengths = np.array(each_storey(yields.shears, n))
        else:
            strengths = first_mode_strengths(masses, stiffnesses, yields.ratio * at_uplift)
    return Superstructure(
        masses,
        stiffnesses,
        damping,
        heights,
        section.vertical_period,
        VERTICAL_DAMPING if section.vertical_damping is None else section.vertical_damping,
        strengths,
        hardening,
    )


def each_storey(value: float | tuple[float, ...] | None, storeys: int) -> list[float]:
    """One value for each storey from the bottom."""
    assert value is not None, COMPLETE
    return list(value) if isinstance(value, tuple) else [value] * storeys


def overturning_limit(section: AnalysisSection, bearing: Bearing) -> float:
    """Rotation that counts as overturned, over theta_cr: the lesser of what the case names."""
    if (displacement := section.overturning_displacement) is None:
        return section.overturning_limit
    rotation = bearing.rotation_at(displacement)
    return min(section.overturning_limit, rotation / bearing.critical_rotation)


def time_history_settings(section: AnalysisSection, bearing: Bearing) -> TimeHistorySettings:
    """Settings of the time history; gravity belongs to the structure."""
    given = section.model_dump(exclude={"gravity", "overturning_displacement"})
    given["overturning_limit"] = overturning_limit(section, bearing)
    if given["free_vibration"] == "auto":
        given["free_vibration"] = None
    return TimeHistorySettings(**given)
