"""A time history as tables and texts for readers, and as a document."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict, replace
from operator import attrgetter
from typing import Any

import numpy as np

from rpscli.analyses.column_design import WITHOUT_IMPULSE
from rpscli.analyses.column_forces import AMPLE
from rpscli.analyses.neighbours import OTHER_LOSS
from rpscli.analyses.result_quantities import (
    EVERY,
    SAMPLED,
    STOREYS,
    STOREYS_YIELDING,
    values_of,
)
from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.model.podium import PodiumStructure
from rpscli.report.column_table import column_table
from rpscli.report.derived import UPPER
from rpscli.report.limits import doubt_texts, limits_table
from rpscli.report.storey_demands import Array, fixed_base_demands, isolated_demands
from rpscli.report.table import (
    LARGE_UNITS,
    Column,
    Heading,
    Part,
    Table,
    Units,
    measured,
    percent,
    shown,
    standing,
)
from rpscli.report.twist import twist_document, twist_parts
from rpscli.sweep.statistics.verdicts import Verdict

OUTCOMES = {
    "at_rest": "at rest: stays in full contact",
    "survived": "survived: uplifts and comes back",
    "stays_tilted": "stays tilted: uplifts, and friction holds it",
    "overturned_rolling": "overturned, rolling",
    "overturned_rocking": "overturned, rocking",
    "failed": "the analysis failed",
}

Row = tuple[str, str, str, str]

DASHPOTS = 0.05
"""Part of the base shear that dashpots of storeys add, from which it is told."""


def timehistory_tables(
    result: TimeHistoryResult,
    verdicts: Sequence[Verdict],
    title: str,
    scaled_to: str = "",
) -> Iterator[Part]:
    """Outcome and largest demands; storeys, devices and limits, if there are any."""
    yield Heading(f"{title}, {result.record.name}")
    if scaled_to:
        yield f"record scaled to {scaled_to}"
    yield f"outcome: {outcome_text(result)}"
    yield from filter(None, [contact_text(result.structure)])
    yield from demand_tables(result)
    yield from column_table(result)
    yield from twist_parts(result)
    if verdicts:
        yield limits_table(verdicts)
        yield from doubt_texts(verdicts)


def demand_tables(
    result: TimeHistoryResult, units: Units = LARGE_UNITS
) -> Iterator[Table | str]:
    """Largest demands; of storeys, of those that yield and of
    devices, if there are any.
    """
    rows = [
        *_of_storey(result, units),
        *_of_building(result, units),
        *_of_contacts(result, units),
        *_energy(result),
    ]
    heads = ["", "on bearings", "", f"{_elastic(result)}fixed base"]
    columns = len(heads) - (result.fixed_base is None)
    yield Table.of_texts(heads[:columns], [row[:columns] for row in rows])
    if result.structure.storeys:
        yield _storeys_table(result)
    yield from _yielded_tables(result)
    if result.devices:
        yield _devices_table(result, units)


def outcome_text(result: TimeHistoryResult) -> str:
    """The end of the history, its nearness to overturning, and sliding of the columns."""
    parts = [OUTCOMES[result.outcome]]
    passed = result.critical_passage_time
    if result.structure.bearing.is_spherical:
        parts = [parts[0].replace("uplifts", "rolls")]
    if result.outcome.startswith("overturned"):
        parts.append(overturned_text(result.structure, result.settings))
    if result.is_near_critical and passed is not None:
        parts.append(f"passed the critical rotation at t = {shown(passed)} s")
    elif result.is_near_critical:
        parts.append(f"near the critical rotation ({shown(result.rotation_ratio)} of it)")
    if result.slides:
        when = result.sliding_time
        parts.append("slides" if when is None else f"slides at t = {shown(when)} s")
    elif result.friction_ratio:
        parts.append(f"does not slide (margin {shown(1.0 / result.friction_ratio)})")
    return "; ".join(parts)


def overturned_text(structure: PodiumStructure, settings: TimeHistorySettings) -> str:
    """The rotation and the displacement that count as overturned."""
    limit = settings.overturning_limit * structure.critical_rotation
    path = structure.path(np.array([limit]))
    return (
        f"overturned: beyond {shown(settings.overturning_limit, 3)} theta_cr ="
        f" {shown(limit)} rad, {measured(float(path[1][0]), 'm')} of the cap beam"
    )


def restitution_text(structure: PodiumStructure) -> str:
    """The restitution at impact, its law, and what half of its loss would leave."""
    law = structure.impact_law
    e = structure.restitution
    if structure.bearing.is_spherical:
        return "no impacts: columns without a flat part roll through the upright position"
    parts = [
        f"restitution at impact: e = {shown(e)} (law {law.kind}), e2 = {shown(e * e)}"
    ]
    parts += filter(None, [contact_text(structure)])
    if law.kind != "value" and law.loss > OTHER_LOSS:
        other = replace(structure, impact_law=replace(law, loss=OTHER_LOSS)).restitution
        parts.append(f"with podium.impact.loss {OTHER_LOSS:g} it would be {shown(other)}")
    return "; ".join(parts)


def contact_text(structure: PodiumStructure) -> str | None:
    """Kind, period and settlement of compliant ends; None of rigid ones."""
    if (bed := structure.bed) is None:
        return None
    kind = structure.contact.kind
    ratio = bed.period_ratio
    parts = [f"{kind} contact"]
    if ratio is not None:
        period = shown(bed.period, 3)
        parts.append(f"period {period} s in full contact ({ratio:.2f} x fixed base)")
    if (
        structure.superstructure_y is not None
        and (across := structure.across.bed) is not None
    ):
        parts.append(
            f"in y {shown(across.period, 3)} s ({across.period_ratio:.2f} x fixed base)"
        )
    if bed.settlement is not None:
        parts.append(f"a joint settles {shown(1e3 * bed.settlement, 2)} mm")
    other = "edges" if kind == "plane" else "plane"
    return f"{', '.join(parts)}; a period does not reveal the kind: compare with {other}"


def direction_note(pairs: Iterable[bool], refused: str) -> str:
    """That one direction says too little, and what to do; `refused`
    is why both cannot be had.
    """
    if all(pairs):
        return ""
    remedy = (
        f"both components together cannot be followed: {refused}"
        if refused
        else (
            "write ?both behind a pair, as in fema_p695:farfield/1?both, and both"
            " components act together"
        )
    )
    return f"one horizontal direction at a time, not conservative: {remedy}"


def note_of_direction(result: TimeHistoryResult) -> str:
    """The note on the direction of a history; empty where both components act."""
    both = result.motion.y is not None
    return direction_note([both], result.structure.planar_only)


def _rows(
    result: TimeHistoryResult,
    *names: str,
    normalised: str = "",
    fixed: float | None = None,
    units: Units = LARGE_UNITS,
) -> Iterator[Row]:
    """A row of each result that the history has."""
    for name in names:
        _, unit, label, *_ = EVERY[name]
        if (value := getattr(result, name)) is not None:
            beside = "" if fixed is None else measured(fixed, unit, units=units)
            yield label, measured(value, unit, units=units), normalised, beside


def _of_storey(result: TimeHistoryResult, units: Units) -> Iterator[Row]:
    """Rotation and displacement of the columns, and what remains of them."""
    yield from _rows(
        result, "max_rotation", normalised=f"{shown(result.rotation_ratio)} theta_cr"
    )
    yield from _azimuth(result.max_rotation_azimuth)
    yield from _rows(result, "max_rotation_time", "critical_passage_time")
    ways = _ways(result, "max_cap_beam_displacement", units)
    yield from _rows(result, "max_cap_beam_displacement", normalised=ways, units=units)
    yield from _rows(result, "max_lift", units=units)
    if result.residual_rotation > 0.0:
        ratio = f"{shown(result.residual_rotation / result.critical_rotation)} theta_cr"
        yield from _rows(result, "residual_rotation", normalised=ratio)
        yield from _azimuth(result.residual_azimuth)
        yield from _rows(result, "residual_displacement", units=units)
    yield from _rows(result, "max_damper_force", "max_stop_force", "lost_prestress")


def _of_building(result: TimeHistoryResult, units: Units) -> Iterator[Row]:
    if (fixed := result.fixed_base) is None:
        return
    spherical = result.structure.bearing.is_spherical  # never lifts
    ratio = "" if spherical else f"{shown(result.base_shear_ratio)} V_st"
    yield from _rows(result, "max_base_shear", normalised=ratio, fixed=fixed.base_shear)
    if result.both_components:
        yield "  in x, in y", _ways(result, "max_base_shear", units), "", ""
    yield from _with_dashpots(result)
    yield from _rows(result, *["uplift_shear_ratio"] * (not spherical))
    yield from _rows(result, "fixed_base_ratio")
    largest = float(np.max(fixed.floor_accelerations))
    yield from _rows(result, "max_floor_acceleration", fixed=largest)
    further = (
        "floor_acceleration_over_fixed",
        "max_roof_displacement",
        "max_floor_velocity",
    )
    yield from _rows(result, *further, units=units)
    demands = fixed_base_demands(result)
    if demands is not None and demands.storey_drift_ratios is not None:
        yield from _rows(
            result, "drift_ratio", fixed=float(max(demands.storey_drift_ratios))
        )
    if result.structure.yields:
        residual = result.residual_drift_ratio
        yield from _rows(result, "ductility", "plastic_drift", units=units)
        of_height = "" if residual is None else f"{shown(residual)} of the height"
        yield from _rows(result, "residual_drift", normalised=of_height, units=units)


def _with_dashpots(result: TimeHistoryResult) -> Iterator[Row]:
    """Base shear with dashpots of storeys, where these carry a part that counts."""
    both = result.base_shear_with_dashpots
    springs = result.max_base_shear
    if both is None or not both > (1.0 + DASHPOTS) * springs:
        return
    words = f"{percent(both - springs, springs)} more than springs"
    yield "  with dashpots of storeys", measured(both, "N"), words, ""


def _of_contacts(result: TimeHistoryResult, units: Units) -> Iterator[Row]:
    """Impacts or passes, joints, friction, and forces of one
    column, or of all together.
    """
    structure = result.structure
    e = result.structure.restitution
    if not structure.bearing.is_spherical:
        yield "restitution at impact e", shown(e), f"e2 = {shown(e * e)}", ""
    yield from _passes(result, units)
    if structure.bed is not None:
        yield from _rows(
            result, "full_contact_share", "max_impact_number", "edge_pressure_ratio"
        )
    of_mu = (
        "" if result.friction_ratio is None else f"{shown(result.friction_ratio)} of mu"
    )
    yield from _rows(result, "friction_demand", normalised=of_mu)
    yield from (
        (f"  {text}", "", "", "")
        for text in without_passes(structure, result.both_components)
    )
    lifts = structure.upwards and not structure.bearing.is_spherical
    if lifts and result.axial is not None and result.axial.sliding_time > 0.0:
        time = f"{shown(1e3 * result.axial.sliding_time)} ms"
        yield f"  above {AMPLE:g} tan(alpha) for", time, "", ""
    yield from _forces_of_columns(result)
    designed = ("column_moment", "contact_pressure_ratio", "crushed_width_ratio")
    yield from _rows(result, "overturning_ratio", *designed)
    for what in left_out_of_columns(result):
        yield f"  without {what}", "", "", ""
    yield from _rows(result, "duration")


def _forces_of_columns(result: TimeHistoryResult) -> Iterator[Row]:
    """Largest forces of one column, and whose they are."""
    forces = _rows(result, "max_column_shear", "max_column_force", "min_column_force")
    axial = "axial force of a column"
    shear = f"shear, {result.shear_is_of}"
    if result.structure.columns == 1:  # their number is not known
        axial = "axial force, all columns"
        if result.overturning_ratio is not None:
            axial = "axial force of an outer column, times columns"
    labels = shear, axial, f"minimum {axial}"
    yield from ((label, *row[1:]) for label, row in zip(labels, forces, strict=True))


def left_out_of_columns(result: TimeHistoryResult) -> list[str]:
    """Parts that forces, and moments and pressures, of columns do not hold."""
    hits = not result.structure.bearing.is_spherical
    impulse = [WITHOUT_IMPULSE] * (result.column_demand is not None and hits)
    return [*result.left_out_of_columns, *impulse]


def without_passes(structure: PodiumStructure, both: bool) -> Iterator[str]:  # noqa: FBT001
    """Instants that the friction demand of pairs leaves out (Theory (13.19))."""
    if both and not structure.passes_smoothly:
        yield f"without passes near upright shorter than {1e3 * structure.shock_time:g} ms"


def _elastic(result: TimeHistoryResult) -> str:
    """Begins the name of the fixed base, whose building never yields."""
    return "elastic, " if result.structure.yields else ""


def _azimuth(angle: float | None) -> Iterator[Row]:
    if angle is not None:
        yield "  towards", f"{shown(math.degrees(angle))} deg from x", "", ""


def _ways(result: TimeHistoryResult, name: str, units: Units) -> str:
    """A result in x and in y; empty where one component acts."""
    if not result.both_components:
        return ""
    unit = EVERY[name].unit
    x, y = (measured(getattr(result, f"{name}_{way}"), unit, units=units) for way in "xy")
    return f"x {x}, y {y}"


def _passes(result: TimeHistoryResult, units: Units) -> Iterator[Row]:
    """Uplifts and impacts, or passes near upright: their number, the
    closest, and the shortest; none of ends that never lift.
    """
    if result.structure.bearing.is_spherical:
        pass  # they roll from rest, without uplift and impacts
    elif not result.both_components or result.passes is None:
        yield "uplifts, impacts", f"{result.uplifts}, {result.impacts}", "", ""
    else:
        yield "uplifts, passes", f"{result.uplifts}, {result.passes:.0f}", "", ""
    if result.both_components and result.passes:
        yield EVERY["passes_as_impacts"].label, f"{result.passes_as_impacts:.0f}", "", ""
        yield EVERY["closest_pass"].label, f"{shown(result.closest_pass)} alpha", "", ""
        yield from _rows(result, "shortest_pass")
    if result.both_components:
        yield from _rows(result, "torsion_lever", units=units)


ROUND = (
    "columns are taken as round: square ones, which would wobble over corners, are not"
    " followed"
)
OF_REVOLUTION = (
    "ends are taken as bodies of revolution (spherical), up to a circular edge; ends that"
    " are curved otherwise are not followed"
)


def passes_text(result: TimeHistoryResult) -> str | None:
    """Assumptions on both components at upright, and on columns; None where one acts."""
    if not result.both_components:
        return None
    if result.structure.bed is not None:
        return (
            "under both components compliant ends follow the law of a strip in every"
            " direction: a round joint of the same stiffness tilts some 6 % more, with 8"
            " % less base shear; the impact's loss acts where columns come back within"
            f" the tilt at uplift, wider passes lose in the joints alone; {ROUND}"
        )
    shape = OF_REVOLUTION if result.structure.bearing.is_of_revolution else ROUND
    if not result.passes:
        return shape
    lost = result.passes_as_impacts or 0
    return (
        f"{result.passes:.0f} passes near upright, however wide; {lost:.0f} of them lose"
        " like an impact (l > 0.5); contact time"
        f" {1e3 * result.structure.impact_law.contact_time:g} ms assumed: it decides how"
        " the motion dies out, and moves medians of largest rotations by up to 9 %"
        f" (0.5 to 4 ms); {accumulated(result)}{shape}"
    )


def accumulated(result: TimeHistoryResult) -> str:
    """Words on passes that follow each other ever nearer to upright; empty without."""
    if not (count := result.accumulations):
        return ""
    return (
        f"{count:.0f} times passes followed each other ever nearer to upright, and were"
        " begun anew as an uplift in a direction that no program resolves; "
    )


ENERGIES = (
    ("damped", "damped", ""),
    ("damped vertically", "damped_vertical", "upwards"),
    ("in storeys that yield", "yielded", "yields"),
    ("in devices", "devices", "devices"),
    ("in the joints", "bed", "bed"),
    ("lost at impacts", "impact", "bearing.half_width"),
    ("still stored", "stored", ""),
    ("residual", "residual", ""),
)
"""Words for parts of the energy, and what a structure must have for each."""


def _energy(result: TimeHistoryResult) -> Iterator[Row]:
    energy = result.energy
    structure = result.structure
    parts = {
        f"  {label}": float(getattr(energy, name))
        for label, name, needed in ENERGIES
        if not needed or attrgetter(needed)(structure)
    }
    yield "energy input", measured(energy.input, "J"), "", ""
    for label, part in parts.items():
        yield label, measured(part, "J"), percent(part, sum(parts.values())), ""


def _storeys_table(result: TimeHistoryResult) -> Table:
    """Largest demands of each storey, on bearings and on a fixed base."""
    isolated = isolated_demands(result)
    fixed = fixed_base_demands(result)
    drift = ("drift mm", "storey_drifts", 1e3)
    if isolated.storey_drift_ratios is not None:
        drift = ("drift ratio", "storey_drift_ratios", 1.0)
    shear = ("shear kN", "storey_shears", 1e-3)
    acceleration = ("acceleration m/s2", "floor_accelerations", 1.0)
    return _by_storey(
        (label, factor * getattr(demands, name))
        for head, name, factor in (shear, drift, acceleration)
        for label, demands in (
            (head, isolated),
            (f"{_elastic(result)}fixed", fixed or isolated),
        )
    )


def _by_storey(columns: Iterable[tuple[str, Array]]) -> Table:
    """Columns with a value of each storey, the roof on top."""
    known = [Column(head, "-", values[::-1], head, standing) for head, values in columns]
    storeys = range(len(known[0].values), 0, -1)  # type: ignore[arg-type]
    return Table([Column("storey", "-", storeys, "storey", str), *known])


def _yielded_tables(result: TimeHistoryResult) -> Iterator[Table | str]:
    """Effects of a history on storeys that yield, and which of them yield most."""
    building = result.structure.superstructure
    if building is None or not building.yields:
        return
    yield _by_storey([
        ("ductility", result.ductilities),
        ("plastic drift mm", 1e3 * result.plastic_drifts),
        ("residual mm", 1e3 * result.residual_drifts),
        ("yielded kJ", 1e-3 * result.energies_yielded),
        ("first at s", result.first_yields),
    ])  # fmt: skip
    most = int(result.ductilities.argmax())
    if most > 0 and result.ductilities[most] > 1.0:
        reason = f": {UPPER}" if building.yields_by_first_mode else ""
        yield f"storey {most + 1}, not the first, has the largest ductility{reason}"


def _devices_table(result: TimeHistoryResult, shown_in: Units) -> Table:
    """Largest demands of each device, and what its prestress is at the end."""
    units = {"force": "N", "stroke": "m", "velocity": "m/s", "energy": "J"}
    rows = []
    for index, demand in enumerate(result.devices):
        texts = [
            measured(getattr(demand, name), unit, units=shown_in)
            for name, unit in units.items()
        ]
        left = demand.remaining_prestress
        prestress = "" if left is None else f"prestress {measured(left, 'N')} left"
        rows.append([f"{index + 1} {demand.kind}", *texts, prestress])
    return Table.of_texts(["device", *units, ""], rows)


OF_RECORD = ("name", "source", "npts", "dt", "pga")
"""Attributes of its record in the document of a history."""


def timehistory_document(result: TimeHistoryResult) -> dict[str, Any]:
    """Scalar results, demands of each storey, energies [J], and what to be warned of."""
    fixed = fixed_base_demands(result)
    column = result.column_demand
    structure = result.structure
    unknown = {
        name for _, name, needed in ENERGIES[1:3] if not getattr(structure, needed)
    }
    return {
        "record": {name: getattr(result.record, name) for name in OF_RECORD},
        "failure": result.failure,
        "samples": result.sampling,
        **result.scalars(),
        **values_of(result, SAMPLED),
        "column_forces": {
            end: asdict(forces) for end, forces in result.column_forces.items()
        },
        "max_column_shear_is_of": result.shear_is_of,
        "column_forces_leave_out": list(result.left_out_of_columns),
        "column_instants": [asdict(each) for each in column.instants] if column else [],
        **values_of(isolated_demands(result), STOREYS),
        **values_of(result, STOREYS_YIELDING if structure.yields else ()),
        "fixed_base": None if fixed is None else values_of(fixed, STOREYS),
        "energy": {
            name: of for name, of in asdict(result.energy).items() if name not in unknown
        },
        "devices": [asdict(demand) for demand in result.devices],
        "twist": twist_document(result.twist),
        "warnings": result.warnings,
    }
