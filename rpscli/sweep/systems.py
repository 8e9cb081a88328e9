"""The systems of a study in order, the product of its axes and its
sample, each examined first.
"""

from __future__ import annotations

import hashlib
import itertools
import math
import warnings
from collections.abc import Callable, Iterator, Sequence
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from rpscli.analyses.result_quantities import HISTORY, SAMPLED, YIELDING
from rpscli.case.case import Case, case_from_mapping
from rpscli.case.conditions import (
    Condition,
    conditions_of,
    unknown_of_pairs,
    with_friction,
)
from rpscli.case.overrides import Override
from rpscli.case.plausibility import Doubt, doubts_of_directions
from rpscli.case.study.schema import PerturbSection, RangeSection, SampleSection, Values
from rpscli.case.study.study import StudyInput
from rpscli.case.text.document import Fault, Position
from rpscli.errors import CaseError, RecordError
from rpscli.model.podium import Array
from rpscli.records.measures import Of, needs_period
from rpscli.records.source import Source
from rpscli.sweep.evaluation import (
    SYSTEMS_KEPT,
    Plan,
    StudyContext,
    System,
)
from rpscli.sweep.motions import RecordRequest

Watched: TypeAlias = Callable[[range], Iterator[int]]
"""Goes through numbers and may show how far it is."""

OF_HISTORIES = (*HISTORY, *YIELDING, *SAMPLED)
"""Results of histories, some of which need something."""

MOST_FAULTY = 8
"""Inadmissible systems after which the search for more gives up."""


def sample(section: SampleSection) -> Array:
    """The sample, (size, keys): scrambled Sobol or Latin hypercube, fixed by the seed."""
    unit = unit_cube(section, len(section.ranges))
    return np.column_stack([*map(_values, unit.T, section.ranges.values())])


def unit_cube(section: SampleSection, dimensions: int) -> Array:
    """(size, dimensions) of the section's sequence, in the unit cube."""
    from scipy.stats import qmc

    engine = {"sobol": qmc.Sobol, "latin_hypercube": qmc.LatinHypercube}[section.method]
    sequence: Any = engine(dimensions, seed=np.random.default_rng(section.seed))
    with warnings.catch_warnings():
        # Sobol sequences are balanced at powers of two; `balance_note` tells the user.
        warnings.simplefilter("ignore", UserWarning)
        return np.asarray(sequence.random(section.size), dtype=np.float64)


def balance_note(section: SampleSection) -> str | None:
    """Remark on the size of a Sobol sample; None if it is even."""
    size = section.size
    if section.method != "sobol" or size & (size - 1) == 0:
        return None
    better = 1 << (size.bit_length() - 1)
    return f"sample.size = {size} is not a power of 2; Sobol samples are even at {better}"


def _values(unit: Array, given: RangeSection) -> Array:
    """One parameter from its place in the unit interval."""
    from scipy.stats import lognorm, norm

    if given.low is not None and given.high is not None:
        return given.low + (given.high - given.low) * unit
    mean = given.mean
    cov = given.cov
    assert mean is not None and cov is not None, "a rule of the file"  # noqa: PT018
    deviation = cov * abs(mean)
    if given.distribution == "uniform":
        return mean + math.sqrt(3.0) * deviation * (2.0 * unit - 1.0)
    kinds = {
        "normal": norm(mean, deviation),
        "lognormal": lognorm(
            math.sqrt(math.log1p(cov**2)), scale=mean / math.sqrt(1.0 + cov**2)
        ),
    }
    # A scrambled sequence may hit zero, whose quantile is minus infinity.
    return np.asarray(kinds[given.distribution].ppf(np.maximum(unit, 1e-16)))


class Change(NamedTuple):
    """Factors on the record's scale and on the restitution; a turn of pairs [deg]."""

    scale: float
    restitution: float
    rotation: float = 0.0


def changes(section: PerturbSection | None) -> tuple[Change, ...]:
    """The members of an ensemble, uniform within the given shares;
    the first is unperturbed.
    """
    unchanged = Change(1.0, 1.0)
    if section is None:
        return (unchanged,)
    generator = np.random.default_rng(section.seed)
    drawn = generator.uniform(-1.0, 1.0, (section.members - 1, 2)).tolist()
    # A sequence of their own: more members leave the earlier ones.
    turning = np.random.default_rng([section.seed, 1])
    turns = (section.rotation * turning.uniform(-1.0, 1.0, section.members - 1)).tolist()
    others = (
        Change(1.0 + section.scale * a, 1.0 + section.restitution * b, turn)
        for (a, b), turn in zip(drawn, turns, strict=True)
    )
    return (unchanged, *others)


class SystemProperties(NamedTuple):
    """Properties of a system for the layout of points and statistics, SI units.

    `values` are those of the varied keys; `period` is T1 on a fixed base,
    `frequency_parameter` that of the rigid frame, p_hat; `building` is a digest of
    the superstructure, empty without one; `limits` are those of the study or, where
    it has none, of the case; `lacking` names results that the system cannot have;
    `doubts` are what is unusual.
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


def examined(
    study: StudyInput,
    context: StudyContext,
    drawn: Array,
    members: Sequence[Change],
    watched: Watched = iter,
) -> tuple[SystemProperties, ...]:
    """Properties of all systems; the first ones are kept in the context.

    The sample `drawn` (size, keys), (1, 0) if there is none, runs faster than the
    axes. A system that is no valid case, perhaps by an unknown key, is refused at
    the places of its values.
    """
    plan = context.plan
    of = plan.measure.of if plan.measure else None
    properties: list[SystemProperties] = []
    requests: dict[RecordRequest, RecordRequest] = {}
    complaints: dict[str, None] = {}
    faulty = 0
    pairs = any(Source.parse(source).both for source in study.sources)
    numbers = watched(
        range(math.prod(len(axis.rows) for axis in study.axes) * len(drawn))
    )
    every = _combinations(study, drawn)
    for number, (rows, values) in zip(numbers, every, strict=True):
        try:
            case = _case_of(study, plan, values, rows)
            system = System.of_case(case)
            own = None if study.sources else _own_record(case, of)
            request = own and requests.setdefault(own, own)
            both = pairs if own is None else own.is_pair
            properties.append(
                _properties(study, values, case, system.digest, request, both=both)
            )
            if number < SYSTEMS_KEPT:
                context.system(number, values, system)
            _refuse_unfit(study, context, case, members, both=both)
        except CaseError as error:
            complaints |= dict.fromkeys(str(error).splitlines())
            faulty += 1
            if faulty >= MOST_FAULTY:
                break
    if complaints:
        raise CaseError("\n".join(complaints))
    return tuple(properties)


def _combinations(
    study: StudyInput, drawn: Array
) -> Iterator[tuple[tuple[int, ...], Values]]:
    """Rows of the axes and of the sample of each system, and the values in them."""
    lengths = (*(len(axis.rows) for axis in study.axes), len(drawn))
    for rows in itertools.product(*map(range, lengths)):
        varied = (axis.rows[row] for axis, row in zip(study.axes, rows, strict=False))
        yield (
            rows,
            (*itertools.chain.from_iterable(varied), *drawn[rows[-1]].tolist()),
        )


def _case_of(
    study: StudyInput, plan: Plan, values: Values, rows: tuple[int, ...]
) -> Case:
    """The case of a system, whose faults are placed at its values in the study."""
    written = _overrides(study, plan, values, rows)
    return case_from_mapping(study.base, plan.base_name, study.base_folder, written)


def _own_record(case: Case, of: Of | None) -> RecordRequest | None:
    """The case's own record, to be measured as a scale asks for."""
    if (record := case.record) is None:
        return None
    try:
        pair = case.record_pair(of)
    except RecordError as error:
        raise CaseError(str(error)) from None
    what = (
        record.vertical,
        record.dt,
        record.units,
        pair,
        record.y,
        record.rotation or 0.0,
    )
    return RecordRequest(case.record_source, str(case.folder), *what)


def _properties(
    study: StudyInput,
    values: Values,
    case: Case,
    digest: bytes,
    request: RecordRequest | None,
    *,
    both: bool,
) -> SystemProperties:
    structure = case.structure
    building = case.structure.superstructure
    buildings = filter(None, (building, structure.superstructure_y))
    return SystemProperties(
        values=values,
        digest=digest,
        storeys=structure.storeys,
        period=None if building is None else float(building.periods[0]),
        alpha=structure.bearing.alpha,
        uplift_acceleration=structure.uplift_acceleration,
        frequency_parameter=structure.rigid_frequency_parameter,
        static_base_shear=structure.static_base_shear,
        building=b"".join(
            hashlib.sha256(
                repr(each.damping).encode()
                + each.masses.tobytes()
                + each.stiffnesses.tobytes()
            ).digest()
            for each in buildings
        ),
        record=request,
        scale=1.0 if case.record is None else case.record.scale,
        limits=_limits(study, case, both=both),
        lacking=lacking(study, case),
        doubts=(*case.doubts, *doubts_of_directions(structure, both=both)),
    )


def _limits(study: StudyInput, case: Case, *, both: bool) -> tuple[Condition, ...]:
    """Limits of the study or, where it has none of its own, of the
    case; friction where given.
    """
    own = study.file.limits
    given = (
        (case.limits, "limits of the case")
        if own is None
        else (own, "limits of the study")
    )
    limits = conditions_of(*given)
    if both and (lines := unknown_of_pairs(limits, case.structure)):
        raise CaseError("\n".join(lines))
    return with_friction(limits, case.structure)


def lacking(study: StudyInput, case: Case) -> frozenset[str]:
    """Names of the results that histories of this case will not have."""
    without = {q.name for q in OF_HISTORIES if q.lacks(case.structure)}
    return frozenset(
        without | (set() if study.file.whole_histories else {q.name for q in SAMPLED})
    )


def needs_of(name: str, which: str = "not every") -> str:
    """Needs of a result in a study, in words."""
    needs = next(q.needed for q in OF_HISTORIES if q.name == name)
    if name in {quantity.name for quantity in SAMPLED}:
        alike = f", and in all systems {needs}" if needs else ""
        return f"{name} needs `whole_histories: true`{alike}"
    return f"{name} needs {needs}, which {which} system of the study has"


def _overrides(
    study: StudyInput, plan: Plan, values: Values, rows: Sequence[int]
) -> list[Override]:
    """The values of a system, at the places where the study wrote them."""
    places: list[Position] = [
        axis.place(key, row)
        for axis, row in zip(study.axes, rows, strict=False)
        for key in range(len(axis.keys))
    ]
    sampled = plan.keys[len(places) :]
    places += [study.document.value_place(("sample", "ranges", key)) for key in sampled]
    return [Override(*item) for item in zip(plan.keys, values, places, strict=True)]


def _refuse_unfit(
    study: StudyInput,
    context: StudyContext,
    case: Case,
    members: Sequence[Change],
    *,
    both: bool,
) -> None:
    """Refuse a case with which the perturbations, the records or both components of the
    study do not go.
    """
    _refuse_restitution(study, case, members)
    _refuse_missing(study, context, case)
    histories = context.plan.analysis == "timehistory"
    if both and histories and (why := case.structure.planar_only):
        raise CaseError(f"both components together: {why}")


def _refuse_restitution(study: StudyInput, case: Case, members: Sequence[Change]) -> None:
    """A perturbed impact must not gain energy by itself."""
    e = case.structure.restitution
    largest = max(change.restitution for change in members)
    if e * largest > 1.0 and not case.structure.bearing.is_spherical:
        text = (
            f"perturb.restitution raises the restitution {e:.4g} of a system above 1; use"
            " less"
        )
        text += f" than {1.0 / e - 1.0:.3g}"
        study.document.refuse([Fault(("perturb", "restitution"), text)])


def _refuse_missing(study: StudyInput, context: StudyContext, case: Case) -> None:
    """Refuse a case that lacks what a point needs besides."""
    if (plan := context.plan).analysis != "timehistory":
        return
    if not study.sources and case.record is None:
        text = "no record: give the study `records`, or the case at its base a `record`"
        study.document.refuse([Fault((), text)])
    measure = plan.measure
    own = None if case.record is None else case.record.scale_to
    if own is not None and study.file.scale is None:
        # The case at the base may scale its record, all of them as it does.
        target = own.measure, (own.value,), own.period, own.of
        same = (
            measure
            and (measure.measure, measure.values, measure.period, measure.of) == target
        )
        if not same:
            text = (
                "record.scale_to cannot vary in a study; vary `scale:"
                " {measure: ..., values:"
            )
            study.document.refuse([Fault((), f"{text} [...]}}`")])
    at_first_period = measure and needs_period(measure.measure) and measure.period is None
    if measure and at_first_period and case.structure.superstructure is None:
        text = (
            f"scale.period is missing: without storeys {measure.measure} has no T1 to be"
            " taken at"
        )
        study.document.refuse([Fault(("scale",), text, at_key=True)])
