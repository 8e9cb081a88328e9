"""Every system of a study is examined before anything runs."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path as Folder
from typing import NamedTuple, TypeAlias

from rpscli.analyses.column_forces import no_bound
from rpscli.analyses.result_quantities import HISTORY, NEEDS, SAMPLED
from rpscli.case.case import Case, case_from_mapping
from rpscli.case.conditions import Condition, conditions_of, with_friction
from rpscli.case.overrides import Override
from rpscli.case.rules.plausibility import Doubt, doubts_of_directions
from rpscli.case.schema.scale_to import ScaleToSection
from rpscli.case.study.axes import Values
from rpscli.case.study.schema import MeasureScale
from rpscli.case.study.study import Study
from rpscli.case.text.document import Fault, Path, Place
from rpscli.errors import CaseError, RecordError
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import Superstructure
from rpscli.records.measures import needs_period
from rpscli.records.source import Source
from rpscli.sweep.evaluation.context import (
    SYSTEMS_KEPT,
    System,
    record_request,
    resolved,
    system_of,
    unjudged,
)
from rpscli.sweep.evaluation.points import Plan, RecordRequest
from rpscli.sweep.points.combinations import Change, Combinations

Watched: TypeAlias = Callable[[range], Iterator[int]]
"""Goes through numbers and may show how far it is."""

MOST_FAULTY = 8
"""Inadmissible systems after which the search for more gives up."""


class SystemProperties(NamedTuple):
    """What the layout of points and statistics must know of a system, SI units.

    `values` are those of the varied keys; `period` is T1 on a fixed base, `frequency_parameter`
    that of the rigid frame, p_hat; `building` is a digest of the superstructure, empty without one;
    `limits` are those of the study or, where it has none, of
    the case; `lacking` names results that the system cannot have; `doubts` are what is unusual.
    """

    values: Values
    digest: bytes
    storeys: int
    period: float | None
    alpha: float
    uplift_acceleration: float
    frequency_parameter: float
    static_base_shear: float
    building: bytes
    record: RecordRequest | None
    scale: float
    limits: tuple[Condition, ...]
    lacking: frozenset[str]
    doubts: tuple[Doubt, ...]


def check_systems(
    study: Study,
    plan: Plan,
    combinations: Combinations,
    members: Sequence[Change],
    watched: Watched = iter,
) -> tuple[tuple[SystemProperties, ...], dict[int, System]]:
    """Properties of all systems and the first systems; `watched` goes through their numbers.

    Raises
    ------
    CaseError
        If one is no valid case, at the places of its values. Unknown keys are among them.
    """
    properties: list[SystemProperties] = []
    examined: dict[int, System] = {}
    known: dict[RecordRequest, RecordRequest] = {}
    complaints: dict[str, None] = {}
    faulty, pairs = 0, any(Source.parse(source).both for source in study.sources)
    for system in watched(range(len(combinations))):
        values = combinations.values(system)
        try:
            case = resolved(plan, values)
            found = system_of(case)
            both = pairs if case.record is None or study.sources else case.record.is_pair
            properties.append(_properties(study, values, case, found.digest, known, both=both))
            if system < SYSTEMS_KEPT:
                examined[system] = found
            _refuse_restitution(study, case, members)
            _refuse_missing(study, plan, case)
            if both and plan.analysis == "timehistory" and (why := case.structure.planar_only):
                raise CaseError(f"both components together: {why}")  # noqa: TRY301 -- placed below
        except CaseError as error:
            places = combinations.places(system)
            complaints |= dict.fromkeys(_placed(study, plan, values, places, error))
            faulty += 1
            if faulty >= MOST_FAULTY:
                break
    if complaints:
        raise CaseError("\n".join(complaints))
    return tuple(properties), examined


def _properties(
    study: Study,
    values: Values,
    case: Case,
    digest: bytes,
    known: dict[RecordRequest, RecordRequest],
    *,
    both: bool,
) -> SystemProperties:
    structure, building = case.structure, case.structure.superstructure
    request = None if study.sources else _request(study, case)
    if request is not None:
        request = known.setdefault(request, request)
    return SystemProperties(
        values=values,
        digest=digest,
        storeys=structure.storeys,
        period=None if building is None else float(building.periods[0]),
        alpha=structure.bearing.alpha,
        uplift_acceleration=structure.uplift_acceleration,
        frequency_parameter=structure.rigid_frequency_parameter,
        static_base_shear=structure.static_base_shear,
        building=b"".join(map(_digest, filter(None, (building, structure.superstructure_y)))),
        record=request,
        scale=1.0 if case.record is None else case.record.scale,
        limits=_limits(study, case, both=both),
        lacking=lacking(study, case),
        doubts=(*case.doubts, *doubts_of_directions(structure, both=both)),
    )


def _request(study: Study, case: Case) -> RecordRequest | None:
    """The record of a case, measured as the study asks for."""
    scale = study.scale
    try:
        return record_request(case, scale.of if isinstance(scale, MeasureScale) else None)
    except RecordError as error:
        raise CaseError(str(error)) from None


def _limits(study: Study, case: Case, *, both: bool) -> tuple[Condition, ...]:
    """Limits of the study or, where it has none of its own, of the case; friction where given."""
    of_study = study.file.limits
    if of_study is not None:
        limits = conditions_of(of_study, "limits of the study")
    else:
        limits = conditions_of(case.limits, "limits of the case")
    for limit in limits:
        if both and (why := no_bound(limit.name, case.structure)):
            raise CaseError(f"{limit.source}: {why}")
    return with_friction(limits, case.structure)


def lacking(study: Study, case: Case) -> frozenset[str]:
    """Names of the results that histories of this case will not have."""
    sampled = () if study.file.whole_histories else SAMPLED
    known = (*HISTORY, *SAMPLED)
    return frozenset(
        [q.name for q in known if q.needs and not HAS[q.needs](case.structure)]
        + [q.name for q in sampled]
    )


def needs_of(name: str, which: str = "not every") -> str:
    """What a study must have for a result, in words."""
    needs = {q.name: NEEDS.get(q.needs, "") for q in (*HISTORY, *SAMPLED)}[name]
    if name in {quantity.name for quantity in SAMPLED}:
        alike = f", and in all systems {needs}" if needs else ""
        return f"{name} needs `whole_histories: true`{alike}"
    return f"{name} needs {needs}, which {which} system of the study has"


def _device_with(result: str) -> Callable[[PodiumStructure], bool]:
    return lambda structure: any(result in device.results for device in structure.devices)


HAS: dict[str, Callable[[PodiumStructure], bool]] = {
    "superstructure": lambda structure: structure.superstructure is not None,
    "superstructure.storey_height": lambda structure: (
        structure.superstructure is not None and structure.superstructure.storey_heights is not None
    ),
    "superstructure, flat part": lambda structure: structure.static_base_shear > 0.0,
    "superstructure, devices": lambda structure: bool(structure.storeys and structure.devices),
    "podium.friction": lambda structure: structure.friction is not None,
    "columns": lambda structure: not structure.left_out_of_columns(both=False),
    "contact": lambda structure: structure.bed is not None,
    "plane contact": lambda structure: (
        structure.contact.kind == "plane" and structure.bearing.is_flat
    ),
    "damper": _device_with("max_damper_force"),
    "stop": _device_with("max_stop_force"),
    "tendon": _device_with("lost_prestress"),
}
"""Whether a structure has what a result needs, by the names of `NEEDS`."""


def _digest(building: Superstructure) -> bytes:
    digest = hashlib.sha256(repr(building.damping).encode())
    for array in (building.masses, building.stiffnesses):
        digest.update(array.tobytes())
    return digest.digest()


def _placed(
    study: Study, plan: Plan, values: Values, places: Sequence[Place], error: CaseError
) -> list[str]:
    """The lines of a message, at the places where the study wrote the values."""
    given = [Override(*item) for item in zip(plan.keys, values, places, strict=True)]
    without = unjudged(dict(zip(plan.keys, values, strict=True)))
    given += [Override(limit, None, places[-1]) for limit in without]
    try:
        case_from_mapping(study.base, plan.base_name, Folder(plan.base_folder), given)
    except CaseError as placed:
        return str(placed).splitlines()
    return str(error).splitlines()


def _refuse_restitution(study: Study, case: Case, members: Sequence[Change]) -> None:
    """A perturbed impact must not gain energy by itself."""
    largest = max(change.restitution for change in members)
    e = case.structure.restitution
    if e * largest > 1.0 and not case.structure.bearing.is_spherical:
        path: Path = ("perturb", "restitution")
        text = (
            f"perturb.restitution raises the restitution {e:.4g} of a system above 1; use less"
            f" than {1.0 / e - 1.0:.3g}"
        )
        study.document.refuse([Fault(path, text)])


def _refuse_missing(study: Study, plan: Plan, case: Case) -> None:
    """What a point needs besides a valid case."""
    if plan.analysis != "timehistory":
        return
    if not study.sources and case.record is None:
        text = "no record: give the study `records`, or the case at its base a `record`"
        study.document.refuse([Fault((), text)])
    own = None if case.record is None else case.record.scale_to
    if own is not None and study.file.scale is None and not _is_of_base(own, plan.measure):
        text = "record.scale_to cannot vary in a study; vary `scale: {measure: ..., values: [...]}`"
        study.document.refuse([Fault((), text)])
    measure = plan.measure
    at_first_period = measure and needs_period(measure.measure) and measure.period is None
    if measure and at_first_period and case.structure.superstructure is None:
        text = (
            f"scale.period is missing: without storeys {measure.measure} has no T1 to be taken at"
        )
        study.document.refuse([Fault(("scale",), text, at_key=True)])


def _is_of_base(target: ScaleToSection, measure: MeasureScale | None) -> bool:
    """Whether a case scales its record as the study scales all of them."""
    return measure is not None and (
        measure.measure,
        measure.values,
        measure.period,
        measure.of,
    ) == (target.measure, (target.value,), target.period, target.of)
