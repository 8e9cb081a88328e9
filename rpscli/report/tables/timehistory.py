"""A time history as tables for a terminal."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.column_design import WITHOUT_IMPULSE, no_line
from rpscli.analyses.column_forces import AMPLE
from rpscli.analyses.result_quantities import HISTORY, PAIR, SAMPLED, YIELDING
from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import OTHER_LOSS, Neighbour
from rpscli.errors import listed
from rpscli.model.podium import PodiumStructure
from rpscli.report.limits import limits_table
from rpscli.report.table import Heading, Part, Table, measured, percent, shown
from rpscli.report.tables.yielding import yielded_tables
from rpscli.sweep.statistics.verdicts import Verdict

OUTCOMES = {
    "at_rest": "at rest: stays in full contact",
    "survived": "survived: uplifts and comes back",
    "stays_tilted": "stays tilted: uplifts, and friction holds it",
    "overturned_rolling": "overturned, rolling",
    "overturned_rocking": "overturned, rocking",
    "failed": "the analysis failed",
}

QUANTITIES = {quantity.name: quantity for quantity in (*HISTORY, *YIELDING, *SAMPLED, *PAIR)}

Row = tuple[str, str, str, str]


def timehistory_tables(
    result: TimeHistoryResult, verdicts: Sequence[Verdict], title: str, scaled_to: str = ""
) -> Iterator[Part]:
    """Outcome and largest demands; storeys, devices and limits, if there are any."""
    yield Heading(f"{title}, {result.record.name}")
    if scaled_to:
        yield f"record scaled to {scaled_to}"
    yield f"outcome: {outcome_text(result)}"
    if (contact := contact_text(result.structure)) is not None:
        yield contact
    yield from demand_tables(result)
    yield from column_table(result)
    if verdicts:
        yield limits_table(verdicts)


def demand_tables(result: TimeHistoryResult) -> Iterator[Table | str]:
    """Largest demands; of storeys, of those that yield and of devices, if there are any."""
    yield outcome_table(result)
    if result.structure.storeys:
        yield storeys_table(result)
    yield from yielded_tables(result)
    if result.devices:
        yield devices_table(result)


def outcome_text(result: TimeHistoryResult) -> str:
    """The end of the history, its nearness to overturning, and sliding of the columns."""
    parts, passed = [OUTCOMES[result.outcome]], result.critical_passage_time
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
    law, e = structure.impact_law, structure.restitution
    if structure.bearing.is_spherical:
        return "no impacts: columns without a flat part roll through the upright position"
    text = f"restitution at impact: e = {shown(e)} (law {law.kind}), e2 = {shown(e * e)}"
    if (contact := contact_text(structure)) is not None:
        text = f"{text}; {contact}"
    if law.kind == "value" or law.loss <= OTHER_LOSS:
        return text
    other = replace(structure, impact_law=replace(law, loss=OTHER_LOSS)).restitution
    return f"{text}; with podium.impact.loss {OTHER_LOSS:g} it would be {shown(other)}"


def contact_text(structure: PodiumStructure) -> str | None:
    """Kind, period and settlement of compliant ends; None of rigid ones."""
    if (bed := structure.bed) is None:
        return None
    kind, ratio = structure.contact.kind, bed.period_ratio
    parts = [f"{kind} contact"]
    if ratio is not None:
        period = shown(bed.period, 3)
        parts.append(f"period {period} s in full contact ({ratio:.2f} x fixed base)")
    if structure.superstructure_y is not None and (across := structure.across.bed) is not None:
        parts.append(f"in y {shown(across.period, 3)} s ({across.period_ratio:.2f} x fixed base)")
    if bed.settlement is not None:
        parts.append(f"a joint settles {shown(1e3 * bed.settlement, 2)} mm")
    other = "edges" if kind == "plane" else "plane"
    return f"{', '.join(parts)}; a period does not reveal the kind: compare with {other}"


def neighbours_texts(result: TimeHistoryResult, found: Sequence[Neighbour]) -> Iterator[str]:
    """That this is one history, and how much it moves with its motion and the impact law."""
    motions = [each for each in found if each.factor != 1.0]
    passes = result.both_components and not result.structure.passes_smoothly
    if motions:
        near = [each for each in motions if abs(each.factor - 1.0) < 0.0101]
        turned = [each for each in found if each.turned]
        beside = f"; turned by 1 deg {_reached(turned)}" if turned else ""
        yield (
            f"one history: with 1 % less or more motion {_reached(near)}; with up to 3 %"
            f" {_reached(motions)}{beside}. Motions with {'passes' if passes else 'impacts'} are"
            " chaotic: judge by several records"
        )
    elif result.outcome != "failed":
        yield (
            f"one history: its {result.history['steps']} steps are too many to look at motions 1 %"
            " weaker and stronger; judge by several records"
        )
    for other in (each for each in found if each.factor == 1.0 and not each.turned):
        instead = f"{shown(other.restitution)} in place of {shown(result.structure.restitution)}"
        yield (
            f"one impact law: with podium.impact.loss {OTHER_LOSS:g}, which is e = {instead},"
            f" {_reached([other])}"
        )


def _reached(found: Sequence[Neighbour]) -> str:
    """Rotations and base shears of those that stood, and how many did not."""
    stood = [each for each in found if not each.outcome.startswith(("overturned", "failed"))]
    texts = []
    if stood:
        ratios = [each.rotation_ratio for each in stood]
        shears = [1e-3 * each.max_base_shear for each in stood]
        texts = [f"{_range(ratios)} theta_cr"]
        texts += [f"base shear {_range(shears)} kN"] * any(shears)
    for kind, word in (("overturned", "overturns"), ("failed", "fails")):
        if count := sum(each.outcome.startswith(kind) for each in found):
            texts.append(f"it {word}" + f" in {count} of {len(found)}" * (len(found) > 1))
    return " and ".join(texts)


def _range(values: Sequence[float]) -> str:
    return " to ".join(dict.fromkeys((shown(min(values)), shown(max(values)))))


def outcome_table(result: TimeHistoryResult) -> Table:
    """The largest demands beside those of the fixed base."""
    rows = [
        _row(result, "max_rotation", f"{shown(result.rotation_ratio)} theta_cr"),
        *_azimuth(result.max_rotation_azimuth),
        *_known(result, "max_rotation_time", "critical_passage_time"),
        _row(result, "max_cap_beam_displacement", _ways(result, "max_cap_beam_displacement")),
        _row(result, "max_lift"),
    ]
    if result.residual_rotation > 0.0:
        residual = f"{shown(result.residual_rotation / result.critical_rotation)} theta_cr"
        rows.append(_row(result, "residual_rotation", residual))
        rows += _azimuth(result.residual_azimuth)
        rows.append(_row(result, "residual_displacement"))
    rows += _known(result, "max_damper_force", "max_stop_force", "lost_prestress")
    rows += _of_building(result)
    e = result.structure.restitution
    if not result.structure.bearing.is_spherical:
        rows.append(("restitution at impact e", shown(e), f"e2 = {shown(e * e)}", ""))
    rows += _passes(result)
    if result.structure.bed is not None:
        rows += _known(result, "full_contact_share", "max_impact_number", "edge_pressure_ratio")
    ratio, axial = result.friction_ratio, result.axial
    rows.append(_row(result, "friction_demand", "" if ratio is None else f"{shown(ratio)} of mu"))
    if result.structure.upwards and axial is not None and axial.sliding_time > 0.0:
        time = f"{shown(1e3 * axial.sliding_time)} ms"
        rows.append((f"  above {AMPLE:g} tan(alpha) for", time, "", ""))
    rows += [*_columns(result), _row(result, "duration"), *_energy(result)]
    heads = ["", "on bearings", "normalised", f"{_elastic(result)}fixed base"]
    if result.fixed_base is None:
        return Table.of_texts(heads[:3], [row[:3] for row in rows])
    return Table.of_texts(heads, rows)


def _of_building(result: TimeHistoryResult) -> Iterator[Row]:
    if result.fixed_base is not None:
        ratio, shear = f"{shown(result.base_shear_ratio)} V_st", result.fixed_base.base_shear
        yield _row(result, "max_base_shear", ratio, shear)
        if result.both_components:
            yield "  in x, in y", _ways(result, "max_base_shear"), "", ""
        yield from _known(result, "uplift_shear_ratio")
        yield _row(result, "fixed_base_ratio")
        fixed_acceleration = float(np.max(result.fixed_base.floor_accelerations))
        yield _row(result, "max_floor_acceleration", fixed=fixed_acceleration)
        for name in (
            "floor_acceleration_over_fixed",
            "max_roof_displacement",
            "max_floor_velocity",
        ):
            yield _row(result, name)
    demands = fixed_base_demands(result)
    if demands is not None and demands.storey_drift_ratios is not None:
        yield _row(result, "drift_ratio", fixed=float(max(demands.storey_drift_ratios)))
    if result.structure.yields:
        residual = result.residual_drift_ratio
        yield from _known(result, "ductility", "plastic_drift")
        of_height = "" if residual is None else f"{shown(residual)} of the height"
        yield _row(result, "residual_drift", of_height)


def _row(
    result: TimeHistoryResult, name: str, normalised: str = "", fixed: float | None = None
) -> Row:
    _, unit, label, *_ = QUANTITIES[name]
    beside = "" if fixed is None else measured(fixed, unit)
    return label, measured(getattr(result, name), unit), normalised, beside


def _known(result: TimeHistoryResult, *names: str) -> list[Row]:
    return [_row(result, name) for name in names if getattr(result, name) is not None]


def _elastic(result: TimeHistoryResult) -> str:
    """Begins the name of the fixed base, whose building never yields."""
    return "elastic, " if result.structure.yields else ""


def _azimuth(angle: float | None) -> list[Row]:
    if angle is None:
        return []
    return [("  towards", f"{shown(math.degrees(angle))} deg from x", "", "")]


def _ways(result: TimeHistoryResult, name: str) -> str:
    """A result in x and in y; empty where one component acts."""
    if not result.both_components:
        return ""
    unit = QUANTITIES[name].unit
    x, y = (measured(getattr(result, f"{name}_{way}"), unit) for way in "xy")
    return f"x {x}, y {y}"


def _passes(result: TimeHistoryResult) -> Iterator[Row]:
    """Uplifts and impacts, or passes near upright: their number, the closest, and the shortest."""
    if result.both_components and result.passes is not None:
        yield "uplifts, passes", f"{result.uplifts}, {result.passes:.0f}", "", ""
    else:
        yield "uplifts, impacts", f"{result.uplifts}, {result.impacts}", "", ""
    if result.both_components and result.passes:
        labels = [QUANTITIES[name].label for name in ("passes_as_impacts", "closest_pass")]
        yield labels[0], f"{result.passes_as_impacts:.0f}", "", ""
        yield labels[1], f"{shown(result.closest_pass)} alpha", "", ""
        yield _row(result, "shortest_pass")
    if result.both_components:
        yield _row(result, "torsion_lever")


ROUND = "columns are taken as round: square ones, which would wobble over corners, are not followed"


def passes_text(result: TimeHistoryResult) -> str | None:
    """What both components assume at upright, and of columns; None where one acts."""
    if not result.both_components:
        return None
    if result.structure.bed is not None:
        return (
            "under both components compliant ends follow the law of a strip in every direction: a"
            " round joint of the same stiffness tilts some 6 % more, with 8 % less base shear; the"
            " impact's loss acts where columns come back within the tilt at uplift, wider passes"
            f" lose in the joints alone; {ROUND}"
        )
    if not result.passes:
        return ROUND
    lost = 0 if result.passes_as_impacts is None else int(result.passes_as_impacts)
    return (
        f"{result.passes:.0f} passes near upright, however wide; {lost} of them lose like an impact"
        " (l > 0.5);"
        f" contact time {1e3 * result.structure.impact_law.contact_time:g} ms assumed: it decides"
        f" how the motion dies out, but hardly its maxima; {ROUND}"
    )


def _columns(result: TimeHistoryResult) -> Iterator[Row]:
    """Forces of one column, or of all where their number is not known."""
    rows = _known(result, "max_column_shear", "max_column_force", "min_column_force")
    labels = ("total column shear", "axial force, all columns", "minimum axial force, all columns")
    if result.overturning_ratio is not None:
        outer = "axial force of an outer column, times columns"
        labels = (labels[0], outer, f"minimum {outer}")
    if result.structure.columns == 1:
        rows = [(label, *row[1:]) for label, row in zip(labels, rows, strict=True)]
    yield from rows
    designed = ("column_moment", "contact_pressure_ratio", "crushed_width_ratio")
    yield from _known(result, "overturning_ratio", *designed)
    impulse = [WITHOUT_IMPULSE] * (result.column_demand is not None)
    for what in (*result.left_out_of_columns, *impulse):
        yield f"  without {what}", "", "", ""


LARGEST = {
    "column_moment": "moment", "max_column_force": "axial force",
    "contact_pressure_ratio": "pressure on arcs", "crushed_width_ratio": "crushed edge",
}  # fmt: skip
"""Words for what is largest at worst instants."""


def column_table(result: TimeHistoryResult) -> Iterator[Part]:
    """Worst instants of the most loaded column, and where its pressure is another one."""
    if (column := result.column_demand) is None:
        return
    heads = ("largest", "end", "t s", "rad", "N kN", "F kN", "e m", "M kN m", "p_0 MPa", "b_c mm")
    rows = [
        (
            LARGEST[each.largest], each.end, shown(each.time, 5), shown(each.rotation),
            *(shown(1e-3 * force) for force in (each.axial_force, each.shear)),
            shown(each.eccentricity, 3), shown(1e-3 * each.moment),
            shown(each.contact_pressure and 1e-6 * each.contact_pressure),
            shown(each.crushed_depth and 1e3 * each.crushed_depth),
        )
        for each in column.instants
    ]  # fmt: skip
    yield Table.of_texts(heads, rows, words=2)
    for doubt in dict.fromkeys(each.doubt for each in column.instants if each.doubt):
        of = [LARGEST[each.largest] for each in column.instants if each.doubt == doubt]
        yield f"p_0 at the largest {listed(of, 'and')}: {doubt}"
    if corner := no_line(result.structure, both=result.both_components):
        yield f"no pressure: {corner}"


def _energy(result: TimeHistoryResult) -> list[Row]:
    energy, structure = result.energy, result.structure
    parts = [
        (name, value)
        for name, value, there in (
            ("damped", energy.damped, True),
            ("damped vertically", energy.damped_vertical, structure.upwards),
            ("in storeys that yield", energy.yielded, structure.yields),
            ("in devices", energy.devices, structure.devices),
            ("in the joints", energy.bed, structure.bed),
            ("lost at impacts", energy.impact, True),
            ("still stored", energy.stored, True),
            ("residual", energy.residual, True),
        )
        if there
    ]
    supplied = sum(value for _, value in parts)
    rows = [(f"  {name}", measured(of, "J"), percent(of, supplied), "") for name, of in parts]
    return [("energy input", measured(energy.input, "J"), "", ""), *rows]


def storeys_table(result: TimeHistoryResult) -> Table:
    """Largest demands of each storey, the roof on top."""
    pair = [isolated_demands(result), fixed_base_demands(result) or isolated_demands(result)]
    ratio = pair[0].storey_drift_ratios is not None
    columns = [demands.storey_shears * 1e-3 for demands in pair]
    columns += [
        d.storey_drifts * 1e3 if d.storey_drift_ratios is None else d.storey_drift_ratios
        for d in pair
    ]
    columns += [demands.floor_accelerations for demands in pair]
    rows = [
        [str(storey + 1), *(shown(float(column[storey])) for column in columns)]
        for storey in reversed(range(result.structure.storeys))
    ]
    fixed, drift = f"{_elastic(result)}fixed", "drift ratio" if ratio else "drift mm"
    heads = ["storey", "shear kN", fixed, drift, fixed, "acceleration m/s2", fixed]
    return Table.of_texts(heads, rows)


def devices_table(result: TimeHistoryResult) -> Table:
    """Largest demands of each device, and what its prestress is at the end."""
    units = {"force": "N", "stroke": "m", "velocity": "m/s", "energy": "J"}
    rows = []
    for index, demand in enumerate(result.devices):
        texts = [measured(getattr(demand, name), unit) for name, unit in units.items()]
        left = demand.remaining_prestress
        prestress = "" if left is None else f"prestress {measured(left, 'N')} left"
        rows.append([f"{index} {demand.kind}", *texts, prestress])
    return Table.of_texts(["device", *units, ""], rows)


Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class StoreyDemands:
    """Largest absolute values in each storey from the bottom, arrays (n,): `STOREYS` of results.

    Drift ratios are None where the case gives no storey heights.
    """

    storey_drifts: Array
    storey_drift_ratios: Array | None
    storey_shears: Array
    floor_accelerations: Array
    floor_velocities: Array


def isolated_demands(result: TimeHistoryResult) -> StoreyDemands:
    """Demands of the building on its bearings."""
    return _demands(result, result.max_drifts, result)


def fixed_base_demands(result: TimeHistoryResult) -> StoreyDemands | None:
    """Demands of the same building on a fixed base; None without a building."""
    fixed = result.fixed_base
    return None if fixed is None else _demands(result, fixed.drifts, fixed)


def _demands(result: TimeHistoryResult, drifts: Array, of: Any) -> StoreyDemands:
    building = result.structure.superstructure
    ratios = None if building is None else building.drift_ratios(drifts)
    floors = of.floor_accelerations, of.floor_velocities
    return StoreyDemands(drifts, ratios, of.storey_shears, *floors)
