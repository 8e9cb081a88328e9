"""Sections of a case file -> parts of its structure, and the settings of its analysis."""

from __future__ import annotations

import math
from dataclasses import MISSING, fields

import numpy as np

from rpscli.analyses.settings import TimeHistorySettings
from rpscli.case.schema.case_file import (
    AnalysisSection,
    BearingSection,
    CaseFile,
    DeviceSection,
    PodiumSection,
    RowsSection,
    SuperstructureSection,
    TorsionSection,
    TwistSection,
)
from rpscli.model.bearing import Bearing, first_order_critical_curvature_ratio
from rpscli.model.column import ColumnDesign
from rpscli.model.contact import USUAL_LOSS, Contact
from rpscli.model.devices import DAMPERS, DEVICES, OwnDamper
from rpscli.model.impact import IMPACT_LAWS, ImpactLaw
from rpscli.model.own import DamperLaw
from rpscli.model.podium import Array, Device, PodiumStructure
from rpscli.model.superstructure import (
    VERTICAL_DAMPING,
    ModalDamping,
    RayleighDamping,
    Superstructure,
    first_mode_strengths,
    profile_stiffnesses,
)
from rpscli.model.twist import Twist

COMPLETE = "the rules of the case make sure that the value is given"


DEVICE_KEYS: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    kind: (
        tuple(field.name for field in fields(device) if field.default is MISSING),
        tuple(field.name for field in fields(device) if field.default is not MISSING),
    )
    for kind, device in DEVICES.items()
}
"""Keys that a device of each kind must have, and may have: the fields of its law."""


def bearing_of(section: BearingSection) -> Bearing:
    """The column, from ratios or sizes; flat ends may leave out their wedge."""
    kept = {"inertia_ratio", "inertia_ratio_axial", "ends"}
    given = section.model_dump(include=kept, exclude_none=True)
    if (sizes := section.dimensions) is not None:
        h = sizes.height
        width = sizes.width
        wedge = width if sizes.wedge_width is None else sizes.wedge_width
        shape = 0.5 * math.hypot(h, width), width / h, wedge / h, sizes.radius / h
        return Bearing(*shape, **given)
    R = section.semi_diagonal
    slenderness = section.slenderness
    rho = section.curvature_ratio
    assert R is not None and slenderness is not None and rho is not None, COMPLETE  # noqa: PT018
    wedge = (
        slenderness if section.wedge_slenderness is None else section.wedge_slenderness
    )
    if isinstance(rho, str):
        rho = first_order_critical_curvature_ratio(slenderness, wedge)
    return Bearing(R, slenderness, wedge, rho, **given)


def _impact_law(section: PodiumSection) -> ImpactLaw:
    """The impact law; how much it loses goes by the contact unless the case says it."""
    given = section.impact.model_dump(exclude={"law", "loss"})
    name = section.impact.law
    loss = section.impact.loss
    own = IMPACT_LAWS[section.impact.law]
    if own is not None:
        given |= {
            "own": own,
            "constants": tuple(given.pop(each) for each in own.constants),
        }
        loss = 1.0 if loss is None else loss
    loss = USUAL_LOSS[section.contact.kind] if loss is None else loss
    return ImpactLaw(name, loss=loss, **given)


def _masses(file: CaseFile) -> tuple[float, float, float]:
    """N m_c, m_b and M_tot [kg], from those and the ratios that are
    given (Theory, section 2).
    """
    podium = file.podium
    floors = file.superstructure
    building = (
        sum(each_storey(floors.storey_mass, floors.storeys)) if floors.storeys else 0.0
    )
    gamma = podium.cap_beam_mass_ratio
    eta = podium.superstructure_mass_ratio
    columns = None
    beam = podium.cap_beam_mass
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


def built(bearing: Bearing, file: CaseFile) -> PodiumStructure:
    """The whole structure: columns and cap beam with the building on them."""
    podium = file.podium
    floors = file.superstructure
    plan = file.podium.plan
    column = None
    if (of := podium.column) is not None:
        own = of.model_dump(exclude={"on"})
        plate = of.on
        column = ColumnDesign(
            **own, plate_modulus=plate.modulus, plate_poisson=plate.poisson
        )
    across = None if floors.y is None else floors.model_copy(update=floors.y.model_dump())
    columns, beam, floors_mass = _masses(file)
    at_uplift = floors_mass * file.analysis.gravity * bearing.slenderness
    return PodiumStructure(
        bearing=bearing,
        columns_mass=columns,
        cap_beam_mass=beam,
        superstructure=_building(floors, at_uplift),
        impact_law=_impact_law(podium),
        gravity=file.analysis.gravity,
        devices=tuple(map(_device, podium.devices)),
        columns=podium.columns or 1,
        friction=podium.friction,
        wind=podium.wind,
        rows=rows_of(plan),
        rows_y=rows_of(plan and plan.y),
        superstructure_y=None if across is None else _building(across, at_uplift),
        contact=Contact(**podium.contact.model_dump()),
        column=column,
        twist=twist_of(podium.twist, floors.torsion),
    )


def twist_of(
    section: TwistSection | None, torsion: TorsionSection | None
) -> Twist | None:
    """How the slab turns, and the storeys on it; None where that is not computed."""
    if section is None:
        return None
    scatter = section.scatter
    storeys = {} if torsion is None else torsion.model_dump()
    return Twist(
        scatter=0.0 if scatter is None else scatter.slenderness,
        seed=1 if scatter is None else scatter.seed,
        factors=section.factors,
        pivot_friction=section.pivot_friction,
        seats=None if isinstance(section.seats, str) else section.seats,
        **storeys,
    )


def rows_of(plan: RowsSection | None) -> tuple[float, ...]:
    """Places of the rows of columns in one direction [m]; none where not known."""
    return () if plan is None else plan.rows or (0.0, plan.length or 0.0)


def _device(section: DeviceSection) -> Device:
    """A device, of ours or of another package."""
    law = DAMPERS[section.kind]
    given = section.model_dump(exclude={"kind"}, exclude_none=True)
    if not isinstance(law, DamperLaw):
        return law(**given)
    return OwnDamper(section.kind, law, tuple(given[name] for name in law.constants))


def _building(section: SuperstructureSection, at_uplift: float) -> Superstructure | None:
    """The shear building; None for no storeys. V_st is what
    ratios of strengths refer to.
    """
    n = section.storeys
    given = section.damping
    height = section.storey_height
    if n == 0:
        return None
    assert given is not None, COMPLETE
    masses = np.array(each_storey(section.storey_mass, n))
    if section.period is None:
        stiffnesses = np.array(each_storey(section.stiffness, n))
    else:
        stiffnesses = profile_stiffnesses(
            masses, section.period, section.profile or "sine"
        )

    damping: RayleighDamping | ModalDamping = ModalDamping(given.ratio)
    if given.modes is not None:
        damping = RayleighDamping(given.ratio, given.modes)
    upwards = section.vertical_damping
    return Superstructure(
        masses,
        stiffnesses,
        damping,
        None if height is None else np.array(each_storey(height, n)),
        section.vertical_period,
        VERTICAL_DAMPING if upwards is None else upwards,
        _strengths(section, masses, stiffnesses, at_uplift),
        0.0 if section.yields is None else section.yields.hardening,
    )


def _strengths(
    section: SuperstructureSection, masses: Array, stiffnesses: Array, at_uplift: float
) -> Array | None:
    """Shears at which storeys yield (n,) [N]; None of elastic buildings."""
    if (yields := section.yields) is None:
        return None
    if yields.ratio is None:
        return np.array(each_storey(yields.shears, section.storeys))
    return first_mode_strengths(masses, stiffnesses, yields.ratio * at_uplift)


def each_storey(value: float | tuple[float, ...] | None, storeys: int) -> list[float]:
    """One value for each storey from the bottom."""
    assert value is not None, COMPLETE
    return list(value) if isinstance(value, tuple) else [value] * storeys


def overturning_limit(section: AnalysisSection, bearing: Bearing) -> float:
    """Rotation that counts as overturned, over theta_cr: the
    lesser of what the case names.
    """
    if (displacement := section.overturning_displacement) is None:
        return section.overturning_limit
    rotation = bearing.rotation_at(displacement)
    return min(section.overturning_limit, rotation / bearing.critical_rotation)


def time_history_settings(
    section: AnalysisSection, bearing: Bearing
) -> TimeHistorySettings:
    """Settings of the time history; gravity belongs to the structure."""
    given = section.model_dump(exclude={"gravity", "overturning_displacement"})
    given["overturning_limit"] = overturning_limit(section, bearing)
    auto = section.free_vibration == "auto"
    return TimeHistorySettings(**given | {"free_vibration": None} if auto else given)
