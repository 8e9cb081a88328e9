"""A time history as tables for a terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rpscli.analyses.result_quantities import HISTORY, SAMPLED
from rpscli.case.conditions import EVENTS
from rpscli.report.table import Heading, Part, Table, measured, percent, shown
from rpscli.report.tables.analyses import fixed_base_demands, isolated_demands

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from rpscli.analyses.results import TimeHistoryResult
    from rpscli.analyses.settings import TimeHistorySettings
    from rpscli.model.podium import PodiumStructure
    from rpscli.sweep.statistics.verdicts import Verdict

OUTCOMES = {
    "at_rest": "stays in full contact",
    "survived": "uplifts and comes back",
    "stays_tilted": "uplifts and stays tilted, held by friction",
    "overturned_rolling": "overturns, rolling",
    "overturned_rocking": "overturns, rocking",
    "failed": "the analysis failed",
}

QUANTITIES = {quantity.name: quantity for quantity in (*HISTORY, *SAMPLED)}

Row = tuple[str, str, str, str]


def timehistory_tables(
    result: TimeHistoryResult, verdicts: Sequence[Verdict], title: str, scaled_to: str = ""
) -> Iterator[Part]:
    """What happened; the storeys, if there are any; the limits, if there are any."""
    yield Heading(f"{title}, {result.record.name}")
    if scaled_to:
        yield f"record scaled to {scaled_to}"
    yield f"outcome: {outcome_text(result)}"
    yield outcome_table(result)
    if result.structure.storeys:
        yield storeys_table(result)
    if result.devices:
        yield devices_table(result)
    if verdicts:
        yield limits_table(verdicts)


def outcome_text(result: TimeHistoryResult) -> str:
    """How the history ended, how near to overturning, and whether the columns slide."""
    parts, passed = [OUTCOMES[result.outcome]], result.critical_passage_time
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
    """What counts as overturned."""
    limit = settings.overturning_limit * structure.critical_rotation
    path = structure.path(np.array([limit]))
    return (
        f"overturned: beyond {shown(settings.overturning_limit, 3)} theta_cr ="
        f" {shown(limit)} rad, {measured(float(path[1][0]), 'm')} of the cap beam"
    )


def outcome_table(result: TimeHistoryResult) -> Table:
    """The largest demands beside those of the fixed base."""
    rows = [
        _row(result, "max_rotation", f"{shown(result.rotation_ratio)} theta_cr"),
        _row(result, "max_rotation_time"),
        *([] if result.critical_passage_time is None else [_row(result, "critical_passage_time")]),
        _row(result, "max_cap_beam_displacement"),
        _row(result, "max_lift"),
    ]
    if result.residual_rotation > 0.0:
        residual = f"{shown(result.residual_rotation / result.critical_rotation)} theta_cr"
        rows.append(_row(result, "residual_rotation", residual))
        rows.append(_row(result, "residual_displacement"))
    rows += [
        _row(result, name)
        for name in ("max_damper_force", "max_stop_force", "lost_prestress")
        if getattr(result, name) is not None
    ]
    if result.fixed_base is not None:
        ratio, shear = f"{shown(result.base_shear_ratio)} V_st", result.fixed_base.base_shear
        rows.append(_row(result, "max_base_shear", ratio, shear))
        if result.uplift_shear_ratio is not None:
            rows.append(_row(result, "uplift_shear_ratio"))
        rows += [_row(result, "fixed_base_ratio"), _row(result, "max_roof_displacement")]
        rows.append(_row(result, "max_floor_velocity"))
    demands = fixed_base_demands(result)
    if demands is not None and demands.storey_drift_ratios is not None:
        rows.append(_row(result, "drift_ratio", fixed=float(max(demands.storey_drift_ratios))))
    rows.append(("uplifts, impacts", f"{result.uplifts}, {result.impacts}", "", ""))
    friction = result.friction_ratio
    of_friction = "" if friction is None else f"{shown(friction)} of mu"
    rows.append(_row(result, "friction_demand", of_friction))
    rows += _columns(result)
    rows += [_row(result, "duration"), *_energy(result)]
    heads = ["", "on bearings", "normalised", "fixed base"]
    if result.fixed_base is None:
        return Table.of_texts(heads[:3], [row[:3] for row in rows])
    return Table.of_texts(heads, rows)


def _row(
    result: TimeHistoryResult, name: str, normalised: str = "", fixed: float | None = None
) -> Row:
    _, unit, label, *_ = QUANTITIES[name]
    beside = "" if fixed is None else measured(fixed, unit)
    return label, measured(getattr(result, name), unit), normalised, beside


def _columns(result: TimeHistoryResult) -> list[Row]:
    """Forces of one column, or of all where their number is not known."""
    names = ("max_column_shear", "max_column_force", "min_column_force")
    rows = [_row(result, name) for name in names]
    labels = ("total column shear", "axial force, all columns", "minimum axial force, all columns")
    if result.structure.columns == 1:
        rows = [(label, *row[1:]) for label, row in zip(labels, rows, strict=True)]
    if result.overturning_ratio is not None:
        rows.append(_row(result, "overturning_ratio"))
    return [
        *rows,
        *((f"  without {what}", "", "", "") for what in result.structure.left_out_of_columns),
    ]


def _energy(result: TimeHistoryResult) -> list[Row]:
    energy = result.energy
    supplied = energy.damped + energy.devices + energy.impact + energy.stored + energy.residual
    parts = {
        "damped": energy.damped,
        **({"in devices": energy.devices} if result.structure.devices else {}),
        "lost at impacts": energy.impact,
        "still stored": energy.stored,
        "residual": energy.residual,
    }
    rows = [(f"  {k}", measured(v, "J"), percent(v, supplied), "") for k, v in parts.items()]
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
    drift = "drift ratio" if ratio else "drift mm"
    heads = ["storey", "shear kN", "fixed", drift, "fixed", "acceleration m/s2", "fixed"]
    return Table.of_texts(heads, rows)


def devices_table(result: TimeHistoryResult) -> Table:
    """Largest demands of each device, and what its prestress is at the end."""
    rows = [
        [
            f"{index} {demand.kind}",
            measured(demand.force, "N"),
            measured(demand.stroke, "m"),
            measured(demand.velocity, "m/s"),
            measured(demand.energy, "J"),
            f"prestress {measured(left, 'N')} left" if left is not None else "",
        ]
        for index, demand in enumerate(result.devices)
        for left in (demand.remaining_prestress,)
    ]
    return Table.of_texts(["device", "force", "stroke", "velocity", "energy", ""], rows)


def limits_table(verdicts: Sequence[Verdict]) -> Table:
    """Every limit with its value."""
    rows = []
    for verdict in verdicts:
        condition = verdict.condition
        value = "overturned" if verdict.overturned else shown(verdict.value)
        numbers = ("", "") if condition.name in EVENTS else (value, condition.bound)
        rows.append((condition.name, verdict.word, condition.source, *numbers))
    return Table.of_texts(["limit", "", "from", "value", "requirement"], rows, words=3)
