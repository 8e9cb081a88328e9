"""A valid case file -> its structure, and the settings of its
analysis; what keys say together.

Rules join keys of sections that are valid; they come before the
model, which refuses the rest.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import MISSING, dataclass, fields

import numpy as np

from rpscli.analyses.result_quantities import LIMITED, YIELDING
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.case.schema.case_file import (
    AnalysisSection,
    BearingSection,
    CaseFile,
    DeviceSection,
    PodiumSection,
    RowsSection,
    SuperstructureSection,
)
from rpscli.case.schema.fields import Section
from rpscli.case.text.document import Document, Fault, path_of, shown
from rpscli.errors import RecordError, listed
from rpscli.model.bearing import Bearing, first_order_critical_curvature_ratio
from rpscli.model.column import ColumnDesign
from rpscli.model.contact import USUAL_LOSS, Contact
from rpscli.model.devices import DAMPERS, DEVICES, OwnDamper
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
from rpscli.records.source import Source

COMPLETE = "the rules of the case make sure that the value is given"


DEVICE_KEYS: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    kind: (
        tuple(field.name for field in fields(device) if field.default is MISSING),
        tuple(field.name for field in fields(device) if field.default is not MISSING),
    )
    for kind, device in DEVICES.items()
}
"""Keys that a device of each kind must have, and may have: the fields of its law."""


def structure_of(file: CaseFile, document: Document) -> PodiumStructure:
    """The structure of valid sections, if they are consistent and the model takes it."""
    rules = Rules(file, document)
    document.refuse(rules.faults())
    try:
        bearing = bearing_of(file.podium.bearing)
        document.refuse(rules.faults_of_bearing(bearing))
        structure = _built(bearing, file)
        if structure.bed is not None:
            structure.bed.refuse_start(file.analysis.initial_rotation)
        document.refuse(too_weak(structure))
    except ValueError as error:
        raise document.refusal([refused_by_model(error, document)]) from None
    return structure


LEAST_STRENGTH = 1e-4
"""Of the weight of the floors: storeys that are weaker yield at every step, for hours."""


def too_weak(structure: PodiumStructure) -> Iterator[Fault]:
    """Storeys without strength to speak of."""
    above = structure.superstructure
    if above is not None and above.strengths is not None:
        least = float(above.strengths.min())
        weight = above.mass * structure.gravity
        if least < LEAST_STRENGTH * weight:
            text = (
                f": a strength of {least:.3g} N is less than a ten-thousandth of the"
                " weight of"
            )
            yield _at_key(YIELD, f"{text} the floors, {weight:.3g} N; check its unit")


def bearing_of(section: BearingSection) -> Bearing:
    """The column, from ratios or sizes; flat ends may leave out their wedge."""
    kept = {"inertia_ratio", "inertia_ratio_axial"}
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


def _built(bearing: Bearing, file: CaseFile) -> PodiumStructure:
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
        rows=_rows(plan),
        rows_y=_rows(plan and plan.y),
        superstructure_y=None if across is None else _building(across, at_uplift),
        contact=Contact(**podium.contact.model_dump()),
        column=column,
    )


def _rows(plan: RowsSection | None) -> tuple[float, ...]:
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
    heights = None if height is None else np.array(each_storey(height, n))
    damping: RayleighDamping | ModalDamping = ModalDamping(given.ratio)
    if given.modes is not None:
        damping = RayleighDamping(given.ratio, given.modes)
    strengths = None
    hardening = 0.0
    if (yields := section.yields) is not None:
        hardening = yields.hardening
        if yields.ratio is None:
            strengths = np.array(each_storey(yields.shears, n))
        else:
            strengths = first_mode_strengths(
                masses, stiffnesses, yields.ratio * at_uplift
            )
    return Superstructure(
        masses,
        stiffnesses,
        damping,
        heights,
        section.vertical_period,
        VERTICAL_DAMPING
        if section.vertical_damping is None
        else section.vertical_damping,
        strengths,
        hardening,
    )


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


STOREYS, HEIGHT, YIELD = (
    f"superstructure.{key}" for key in ("storeys", "storey_height", "yield")
)
BEARING = "podium.bearing"
DIMENSIONS = "podium.bearing.dimensions"
COLUMN = "podium.column"
GAMMA = "podium.cap_beam_mass_ratio"
ETA = "podium.superstructure_mass_ratio"
BEAM = "podium.cap_beam_mass"
COLUMN_MASS = "podium.column_mass"
COLUMNS = "podium.columns"
COLUMN_LIMITS = tuple(
    q.name for q in LIMITED if q.needs in {"designed columns", "columns on arcs"}
)
RATIOS = {
    "semi_diagonal": "R = sqrt(H^2 + B^2), as in '1.5 m'",
    "slenderness": "tan(alpha) = B/H, as in 0.15",
    "wedge_slenderness": "tan(alpha') = B'/H; only flat ends need none",
    "curvature_ratio": "rho = r/2H, as in 0.5; 0 for flat ends, or the word critical",
}


def _at_key(key: str, text: str) -> Fault:
    """A fault of a key, with which the text begins."""
    return Fault(path_of(key), f"{key}{text}", at_key=True)


def _of_value(key: str, text: str) -> Fault:
    return Fault(path_of(key), f"{key}{text}")


def _given(section: object, *keys: str) -> list[str]:
    """Those of the optional keys of a section, with or without what
    precedes them, with a value.
    """
    return [
        key for key in keys if getattr(section, key.rpartition(".")[2], None) is not None
    ]


def _one_of(key: str, section: object, text: str, *keys: str) -> Iterator[Fault]:
    """A section that takes exactly one of two keys."""
    if section is not None and len(given := _given(section, *keys)) != 1:
        yield _of_value(key, f": give {text}; not {'both' if given else 'neither'}")


@dataclass(frozen=True)
class Rules:
    """What joins the keys of a case whose sections are valid."""

    file: CaseFile
    document: Document

    def faults(self) -> Iterator[Fault]:
        """Keys that are missing, said twice, or cannot be true
        together, whatever the shape.
        """
        building = self.file.superstructure
        if building.storeys:
            yield from self._building(building)
        yield from (
            self._masses_under_building() if building.storeys else self._masses_of_frame()
        )
        yield from self._bearing()
        yield from self._without_effect()
        yield from self._devices()
        yield from self._record()
        yield from self._limits()
        yield from self._columns()

    def _where(self, key: str) -> str:
        return self.document.where(path_of(key))

    def _both(self, key: str, other: str, text: str, keep: str = "one of them") -> Fault:
        """Two keys that say one thing."""
        return _at_key(key, f" and {other}{self._where(other)} both {text}; keep {keep}")

    def _building(self, building: SuperstructureSection) -> Iterator[Fault]:
        """A building needs masses, stiffness and damping, each given once."""
        if building.storey_mass is None:
            meaning = "floor mass, one value or a list from the bottom, as in '200 t'"
            yield _at_key("superstructure.storey_mass", f" is missing: {meaning}")
        if building.damping is None:
            meaning = (
                "as in {ratio: 0.05, modes: [1, 2]} (Rayleigh) or {ratio: 0.05} (every"
                " mode)"
            )
            yield _at_key("superstructure.damping", f" is missing: {meaning}")
        elif (modes := building.damping.modes) and max(modes) > max(building.storeys, 2):
            # One storey takes [1, 2] as well: stiffness-proportional, so that storeys can
            # vary.
            yield _of_value(
                "superstructure.damping.modes",
                f" = {shown(modes)} must be from 1 to {STOREYS} ="
                f" {building.storeys}{self._where(STOREYS)}; a building has as many"
                " modes as storeys",
            )
        if building.vertical_damping is not None and building.vertical_period is None:
            text = (
                " needs superstructure.vertical_period, which is missing; give it, or"
                " remove"
            )
            yield _at_key("superstructure.vertical_damping", f"{text} the key")
        text = "ratio, F_1 over V_st, or the shears at which storeys yield"
        yield from _one_of(YIELD, building.yields, text, "ratio", "shears")
        for owner, section in (
            ("superstructure", building),
            ("superstructure.y", building.y),
        ):
            if section is None:
                continue
            if section.stiffness is None and section.period is None:
                yield _at_key(
                    owner, " has no stiffness: give period (with profile), or stiffness"
                )
            for key in _given(section, f"{owner}.period", f"{owner}.profile"):
                if section.stiffness is not None:
                    yield self._both(
                        f"{owner}.stiffness", key, "fix the storey stiffnesses"
                    )
            yield from self._one_each(
                owner, section, "storey_mass", "storey_height", "stiffness"
            )
        yield from self._one_each(YIELD, building.yields, "shears")

    def _one_each(self, owner: str, section: object, *names: str) -> Iterator[Fault]:
        """Lists have one value a storey."""
        storeys = self.file.superstructure.storeys
        for name in names:
            values = getattr(section, name, None)
            if isinstance(values, tuple) and len(values) != storeys:
                yield _of_value(
                    f"{owner}.{name}",
                    f" has {len(values)} values, but {STOREYS} ="
                    f" {storeys}{self._where(STOREYS)}; give one value a storey from the"
                    " bottom, or a single value",
                )

    def _masses_under_building(self) -> Iterator[Fault]:
        """Cap beam and columns each have one mass."""
        podium = self.file.podium
        for what, keys in {
            "the mass of the cap beam": (ETA, BEAM),
            "the mass of the columns": (GAMMA, COLUMN_MASS),
        }.items():
            given = _given(podium, *keys)
            if not given:
                names = listed(key.rpartition(".")[2] for key in keys)
                yield _at_key("podium", f" leaves {what} open: give {names}")
            elif len(given) > 1:
                yield self._twice(what, given)
        yield from self._number_of_columns()
        for key, value in (
            (GAMMA, podium.cap_beam_mass_ratio),
            (BEAM, podium.cap_beam_mass),
        ):
            if value == 0.0:
                yield _of_value(
                    key,
                    f" = 0 must be > 0: the superstructure{self._where(STOREYS)} stands"
                    f" on the cap beam; 0 is for free-standing columns, with {STOREYS}:"
                    " 0",
                )

    def _masses_of_frame(self) -> Iterator[Fault]:
        """Without a building two of three: beam mass, column mass, and their ratio."""
        podium = self.file.podium
        keys = (BEAM, GAMMA, COLUMN_MASS)
        given = _given(podium, *keys)
        if podium.superstructure_mass_ratio is not None:
            text = (
                f" has no meaning with {STOREYS} = 0{self._where(STOREYS)}; give {BEAM}"
                " instead"
            )
            yield _at_key(ETA, text)
        elif len(given) > 2:
            yield self._twice("the masses of cap beam and columns", given)
        elif podium.without_cap_beam and (
            podium.cap_beam_mass_ratio or podium.cap_beam_mass
        ):
            yield _of_value(
                BEAM,
                f" and {GAMMA}{self._where(GAMMA)} contradict each other: one says that"
                " there is no cap beam; give column_mass instead of one of them",
            )
        elif podium.without_cap_beam:
            if podium.column_mass is None:
                yield _at_key(
                    COLUMN_MASS, " is missing: without a cap beam it is the only mass"
                )
        else:
            if len(given) < 2:
                others = listed(
                    key.rpartition(".")[2] for key in keys if key not in given
                )
                text = " leaves the masses of cap beam and columns open: give"
                text += (
                    f" {'one' if given else 'two'} of {others} (column_mass with columns)"
                )
                yield _at_key("podium", text)
            yield from self._number_of_columns()

    def _number_of_columns(self) -> Iterator[Fault]:
        if self.file.podium.column_mass is not None and self.file.podium.columns is None:
            yield _at_key(
                COLUMNS, " is missing: the number of columns, each of column_mass"
            )

    def _twice(self, what: str, given: list[str]) -> Fault:
        """Point at the last one written and name the places of the others."""
        *others, last = sorted(
            given, key=lambda key: self.document.key_place(path_of(key)).order
        )
        told = listed((f"{key}{self._where(key)}" for key in others), "and")
        both = "both" if len(given) == 2 else "together"
        return _at_key(last, f" and {told} {both} fix {what}; remove one of them")

    def _bearing(self) -> Iterator[Fault]:
        """One description of the column, and a complete one."""
        bearing = self.file.podium.bearing
        sizes = self.file.podium.bearing.dimensions
        ratios = _given(bearing, *RATIOS)
        if sizes is None and not ratios:
            names = listed(RATIOS, "and")
            yield _at_key(BEARING, f" has no shape: give {names}, or dimensions")
        elif sizes is None:
            optional = [] if bearing.curvature_ratio else ["wedge_slenderness"]
            for name, meaning in RATIOS.items():
                if name not in (*ratios, *optional):
                    yield _at_key(f"{BEARING}.{name}", f" is missing: {meaning}")
        elif ratios:
            said = DIMENSIONS, "describe the column", "the ratios or the dimensions"
            yield from (self._both(f"{BEARING}.{name}", *said) for name in ratios)
        elif sizes.wedge_width is None and sizes.radius:
            meaning = "2B', across the outer edges of the arcs; only flat ends need none"
            yield _at_key(f"{DIMENSIONS}.wedge_width", f" is missing: {meaning}")

    def _without_effect(self) -> Iterator[Fault]:
        """A measured restitution has no loss; ends without impacts
        have nothing to say of them.
        """
        podium = self.file.podium
        ends = ""
        if podium.impact.law == "value" and podium.impact.loss not in (None, 1.0):
            yield _at_key(
                "podium.impact.loss",
                " does not go with law value: a measured restitution includes the loss;"
                " remove it, or scale the restitution by factor",
            )
        idle: list[tuple[str, Section]] = [("podium.impact.contact_time", podium.impact)]
        if podium.contact.kind != "rigid":
            ends = (
                f"with podium.contact{self._where('podium.contact.kind')}: compliant ends"
                " do not"
            )
            ends += " bounce"
            idle.append(("analysis.recontact_tolerance", self.file.analysis))
        elif podium.bearing.slenderness == 0.0:
            ends = (
                f"without a flat part{self._where(f'{BEARING}.slenderness')}: such ends"
                " roll"
            )
            ends += " through upright without an impact"
        for key, section in idle if ends else ():
            # The default may stand there, in a case that was written out whole.
            name = key.rpartition(".")[2]
            if getattr(section, name) != type(section).model_fields[name].default:
                yield _at_key(key, f" has no effect {ends}; remove it")

    def _devices(self) -> Iterator[Fault]:
        """Each device has the keys that its kind needs, and none of another kind."""
        for index, device in enumerate(self.file.podium.devices):
            owner = f"podium.devices.{index}"
            keys = type(device).model_fields
            own = tuple(key for key, field in keys.items() if field.is_required())
            needed, optional = DEVICE_KEYS.get(device.kind, (own, ()))
            given = _given(device, *keys)
            for key in (key for key in needed if key not in given):
                meaning = DeviceSection.model_fields[key].description
                yield _at_key(f"{owner}.{key}", f" is missing: {meaning}")
            for key in (key for key in given if key not in ("kind", *needed, *optional)):
                known = listed((*needed, *optional), "and")
                text = (
                    f" is not a key of kind: {device.kind}, which has {known}; remove it"
                )
                yield _at_key(f"{owner}.{key}", text)
        kinds = [DEVICES.get(each.kind) for each in self.file.podium.devices]
        of_columns = [i for i, kind in enumerate(kinds) if kind and kind.in_each_column]
        if of_columns and self.file.podium.columns is None:
            text = f" is in each column, but {COLUMNS}, their number, is missing"
            yield _of_value(f"podium.devices.{of_columns[0]}", text)

    def _record(self) -> Iterator[Fault]:
        """A record has a factor, or a measure that fixes it; a
        pair is said in one way.
        """
        record = self.file.record
        if record is None:
            return
        if record.x is not None and self.document.has(("record", "source")):
            yield self._both("record.x", "record.source", "name the first component")
        if record.x is not None and record.y is None:
            meaning = "the second component beside x; one alone is a source"
            yield _at_key("record.y", f" is missing: {meaning}")
        both = record.y is not None
        for name in _given(record, "source" if record.x is None else "x", "y"):
            try:
                source = Source.parse(getattr(record, name))
            except RecordError as error:
                yield _of_value(f"record.{name}", f": {error}")
                continue
            if record.y is not None and source.of_pair:
                text = (
                    " names a pair or a direction between two components; name single"
                    " components"
                )
                yield _of_value(
                    f"record.{name}", f"{text} here, or leave y out and write `?both`"
                )
            both = both or source.both
        if record.rotation is not None and not both:
            text = " turns a pair: give y as well, or write `?both` behind the source"
            yield _at_key(
                "record.rotation", f"{text}; angle= is one direction between two"
            )
        if record.scale_to is not None and record.scale != 1.0:
            yield self._both("record.scale_to", "record.scale", "fix the factor")

    def _limited(self, text: str, *names: str) -> Iterator[Fault]:
        """The limits among some that are set."""
        yield from (
            _at_key(f"limits.{name}", text) for name in _given(self.file.limits, *names)
        )

    def _limits(self) -> Iterator[Fault]:
        """A limit on something that the case cannot give would never be exceeded."""
        podium = self.file.podium
        building = self.file.superstructure
        if podium.column is None:
            yield from self._limited(f" needs {COLUMN}, which is missing", *COLUMN_LIMITS)
        if building.storeys == 0:
            text = (
                f" needs a building, but {STOREYS} = 0{self._where(STOREYS)}; remove the"
                " limit"
            )
            of_building = (q.name for q in LIMITED if "superstructure" in q.needs)
            yield from self._limited(text, *of_building)
            return
        if building.storey_height is None:
            text = f" needs {HEIGHT}, which is missing"
            yield from self._limited(text, "drift_ratio", "residual_drift_ratio")
        if building.yields is None:
            text = (
                f" needs {YIELD}, strengths of storeys, which is missing; give it, or"
                " remove the"
            )
            yield from self._limited(
                f"{text} limit", *(q.name for q in YIELDING if q.limit)
            )
        needed = {
            "the overturning moment": ("podium.plan", podium.plan),
            "the shock of impacts": (
                "superstructure.vertical_period",
                building.vertical_period,
            ),
        }
        if lacking := {
            what: key for what, (key, value) in needed.items() if value is None
        }:
            text = (
                f": the force of a column is known without {listed(lacking, 'and')} only,"
                " and may"
            )
            text += (
                " be several times as large with it; give"
                f" {listed(lacking.values(), 'and')}"
            )
            yield from self._limited(
                text, "max_column_force", "min_column_force", *COLUMN_LIMITS
            )

    def _columns(self) -> Iterator[Fault]:
        """Rows have heights for the moment of the building; the
        force of one column a number.
        """
        podium = self.file.podium
        building = self.file.superstructure
        if podium.column is not None and podium.columns is None:
            yield _at_key(COLUMNS, f" is missing: {COLUMN} asks for the force of one")
        text = "length, between two rows of columns, or the places of all rows"
        yield from _one_of("podium.plan", podium.plan, text, "length", "rows")
        yield from _one_of(
            "podium.plan.y", podium.plan and podium.plan.y, text, "length", "rows"
        )
        if podium.plan is not None and (number := podium.columns) is not None:
            x = len(_rows(podium.plan))
            y = len(_rows(podium.plan.y))
            if y and number != x * y:
                of_rows = (
                    f"must be {x} x {y}: one stands wherever two rows of podium.plan"
                    " cross"
                )
                yield _of_value(COLUMNS, f" = {number} {of_rows}")
            elif number % x:
                of_rows = (
                    f"cannot stand in {x} rows of podium.plan with equally many each"
                )
                yield _of_value(COLUMNS, f" = {number} {of_rows}")
        if (
            podium.plan is not None
            and building.storeys
            and building.storey_height is None
        ):
            yield _at_key("podium.plan", f" needs {HEIGHT}: the moment has lever arms")

    def faults_of_bearing(self, bearing: Bearing) -> Iterator[Fault]:
        """Limits and strengths that its ends do not have, and
        rotations beyond the model.
        """
        file = self.file
        analysis = self.file.analysis
        critical = bearing.critical_rotation
        if bearing.is_flat:
            text = (
                " needs curved ends: flat ones stand on edges; limit crushed_width_ratio"
            )
            yield from self._limited(text, "contact_pressure_ratio")
        yields = file.superstructure.yields
        if bearing.is_spherical and yields is not None and yields.ratio is not None:
            text = (
                ": columns without a flat part have no V_st; give the shears in place of"
                " a ratio"
            )
            yield _at_key(f"{YIELD}.ratio", text)
        most = bearing.largest_rotation / critical
        if analysis.overturning_limit > most:
            yield _of_value(
                "analysis.overturning_limit",
                f" = {analysis.overturning_limit:g} times theta_cr = {critical:.6g} rad"
                f" must not exceed {bearing.largest_rotation:.6g} rad, where the columns"
                " lie down and the model ends; use at most"
                f" {math.floor(1e3 * most) / 1e3:g}",
            )
        limit = overturning_limit(analysis, bearing) * critical
        if abs(analysis.initial_rotation) >= limit:
            yield _of_value(
                "analysis.initial_rotation",
                f" = {analysis.initial_rotation:g} rad must stay below the overturning"
                f" limit, {limit:.6g} rad (overturning_limit * theta_cr, or less); use a"
                " smaller one",
            )


OF_THE_MODEL = {
    **{
        name: f"{BEARING}.{name}"
        for name in ("slenderness", "wedge_slenderness", "curvature_ratio")
    },
    "restitution": "podium.impact",
    "law": "podium.impact.restitution",
    "devices": "podium.devices",
    "yield_force": "podium.devices",
    "edge_length": f"{COLUMN}.edge_length",
    "rows": "podium.plan.rows",
    "rows_y": "podium.plan.y.rows",
    "contact": "podium.contact",
    "initial_rotation": "analysis.initial_rotation",
}
"""Keys of a case by the word with which the model begins a refusal."""


def refused_by_model(error: ValueError, document: Document) -> Fault:
    """What the model refuses, at the key that it is about."""
    text = str(error)
    key = OF_THE_MODEL.get(text.split(maxsplit=1)[0].strip(":,"), "podium")
    if document.has(path_of(DIMENSIONS)) and key.startswith(BEARING):
        key = DIMENSIONS
    parent, _, last = key.rpartition(".")
    named = text.startswith((f"{last} ", f"{last}:"))
    whole = f"{parent}.{text}" if named else f"{key}: {text}"
    return Fault(path_of(key), whole, at_key=not named)
