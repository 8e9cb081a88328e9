"""A time history as tables for a terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rpscli.commands.acceptance import EVENTS, Verdict
from rpscli.commands.numbers import percent, shown
from rpscli.commands.tables import table
from rpscli.commands.tables import title as heading_line
from rpscli.report.storeys import fixed_base_demands, isolated_demands

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from rich.console import RenderableType
    from rich.table import Table

    from rpscli.analyses.results import TimeHistoryResult

OUTCOMES = {
    "at_rest": "stays in full contact",
    "survived": "uplifts and comes back",
    "overturned_rolling": "overturns, rolling",
    "overturned_rocking": "overturns, rocking",
    "failed": "the analysis failed",
}

Row = tuple[str, str, str, str]


def timehistory_tables(
    result: TimeHistoryResult, verdicts: Sequence[Verdict], title: str
) -> Iterator[RenderableType]:
    """What happened; the storeys, if there are any; the limits, if there are any."""
    yield heading_line(f"{title}, {result.record.name}")
    yield f"outcome: {OUTCOMES[result.outcome]}"
    yield outcome_table(result)
    if result.structure.storeys:
        yield storeys_table(result)
    if verdicts:
        yield limits_table(verdicts)


def outcome_table(result: TimeHistoryResult) -> Table:
    """The largest demands beside those of the fixed base."""
    fixed = result.fixed_base
    rows: list[Row] = [
        (
            "largest rotation",
            f"{shown(result.max_rotation)} rad",
            f"{shown(result.rotation_ratio)} theta_cr",
            "",
        ),
        ("cap beam displacement", f"{shown(result.max_cap_beam_displacement)} m", "", ""),
    ]
    if fixed is not None:
        rows.append(
            (
                "base shear",
                f"{shown(result.max_base_shear * 1e-3)} kN",
                f"{shown(result.base_shear_ratio)} V_st",
                f"{shown(fixed.base_shear * 1e-3)} kN",
            )
        )
        demands = fixed_base_demands(result)
        if demands is not None and demands.drift_ratio is not None:
            rows.append(
                (
                    "drift ratio",
                    shown(result.drift_ratio),
                    "",
                    shown(float(max(demands.drift_ratio))),
                )
            )
    rows += [*_motion(result), *_energy(result)]
    heads = ["", "on bearings", "normalised", "fixed base"]
    if fixed is None:
        return table(heads[:3], [row[:3] for row in rows])
    return table(heads, rows)


def _motion(result: TimeHistoryResult) -> list[Row]:
    return [
        ("uplifts, impacts", f"{result.uplifts}, {result.impacts}", "", ""),
        ("friction demand |F|/N", shown(result.friction_demand), "", ""),
        ("duration", f"{shown(result.duration)} s", "", ""),
    ]


def _energy(result: TimeHistoryResult) -> list[Row]:
    energy = result.energy
    supplied = energy.damped + energy.impact + energy.stored + energy.residual
    parts = {
        "damped": energy.damped,
        "lost at impacts": energy.impact,
        "still stored": energy.stored,
        "residual": energy.residual,
    }
    rows = [
        (f"  {name}", f"{shown(part * 1e-3)} kJ", percent(part, supplied), "")
        for name, part in parts.items()
    ]
    return [("energy input", f"{shown(energy.input * 1e-3)} kJ", "", ""), *rows]


def storeys_table(result: TimeHistoryResult) -> Table:
    """Largest demands of each storey, the roof on top."""
    pair = [isolated_demands(result), fixed_base_demands(result) or isolated_demands(result)]
    ratio = pair[0].drift_ratio is not None
    columns = [demands.shear * 1e-3 for demands in pair]
    columns += [d.drift * 1e3 if d.drift_ratio is None else d.drift_ratio for d in pair]
    columns += [demands.floor_acceleration for demands in pair]
    rows = [
        [str(storey + 1), *(shown(float(column[storey])) for column in columns)]
        for storey in reversed(range(result.structure.storeys))
    ]
    drift = "drift ratio" if ratio else "drift mm"
    heads = ["storey", "shear kN", "fixed", drift, "fixed", "acceleration m/s2", "fixed"]
    return table(heads, rows)


def limits_table(verdicts: Sequence[Verdict]) -> Table:
    """Every limit with its value."""
    rows = [
        (
            v.name,
            "EXCEEDED" if v.exceeded else "met",
            v.source,
            *(("", "") if v.name in EVENTS else (shown(v.value), f"{v.limit:g}")),
        )
        for v in verdicts
    ]
    return table(["limit", "", "from", "value", "at most"], rows, words=3)
