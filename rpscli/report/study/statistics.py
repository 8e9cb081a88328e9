"""Outcomes and demands of each system at each intensity, and verdicts on them, as documents."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from rpscli.analyses.result_quantities import HISTORY, SAMPLED, YIELDING
from rpscli.report.limits import limit_unit, requirement_text, verdict_text
from rpscli.report.study.labels import key_columns, labels
from rpscli.report.table import Column
from rpscli.sweep.statistics.fractiles import Share
from rpscli.sweep.statistics.summary import Summary
from rpscli.sweep.statistics.verdicts import Verdict

SPREAD = {"median": "median", "84": "high", "largest": "largest"}
"""What follows the name of a quantity in a column, and the attribute of its spread."""
OF_RECORDS = {
    "mean_of_maxima": "mean", "median": "median", "fractile_84": "high", "largest": "largest"
}  # fmt: skip
FROM_BELOW = {"84": "16", "largest": "least"}
"""What follows the names of those of which small values are bad."""


def counted_columns(shares: Sequence[Share]) -> list[Column]:
    """Histories, and the recordings or events that they come from."""
    return [
        Column("counted", "-", [share.of for share in shares]),
        Column(shares[0].by if shares else "recordings", "-", [s.recordings for s in shares]),
    ]


def share_columns(name: str, shares: Sequence[Share]) -> list[Column]:
    """Count, share and interval; `name` is what is counted."""
    endings = {"": "number", "_share": "fraction", "_low": "low", "_high": "high"}
    return [
        Column(name + ending, "-", [getattr(share, attribute) for share in shares])
        for ending, attribute in endings.items()
    ]


def summary_columns(summary: Summary) -> list[Column]:
    """`statistics.csv`: one row a system and intensity; ``inf`` where so many overturned."""
    rows = summary.rows
    columns = key_columns(summary.keys, [row.values for row in rows])
    columns += counted_columns([row.overturned for row in rows])
    columns.append(Column("failed", "-", [row.failed for row in rows]))
    columns += share_columns("overturned", [row.overturned for row in rows])
    for place, quantity in enumerate(summary.quantities):
        for suffix, attribute in SPREAD.items():
            values = [reached(getattr(row.spreads[place], attribute)) for row in rows]
            ending = FROM_BELOW.get(suffix, suffix) if quantity.from_below else suffix
            columns.append(Column(f"{quantity.name}_{ending}", quantity.unit, values))
    return columns


def records_columns(labels: Sequence[str], histories: Sequence[Mapping[str, Any]]) -> list[Column]:
    """`records.csv`: one row a record."""
    return [
        Column("record", "-", labels),
        Column("scale", "-", [history["record"]["scale"] for history in histories]),
        Column("outcome", "-", [history["outcome"] for history in histories]),
        *(
            Column(quantity.name, quantity.unit, [history[quantity.name] for history in histories])
            for quantity in (*HISTORY, *YIELDING, *SAMPLED)
            if quantity.name in histories[0]
        ),
    ]


def demand_columns(summary: Summary) -> list[Column]:
    """`statistics.csv` of one structure: one row a demand; ``inf`` where so many overturned."""
    (row,) = summary.rows
    found = [
        (quantity, spread)
        for quantity, spread in zip(summary.quantities, row.spreads, strict=True)
        if not quantity.from_below
    ]
    return [
        Column("quantity", "-", [quantity.name for quantity, _ in found]),
        Column("unit", "-", [quantity.unit for quantity, _ in found]),
        *(
            Column(name, "SI", [reached(getattr(spread, attribute)) for _, spread in found])
            for name, attribute in OF_RECORDS.items()
        ),
    ]


def reached(value: float) -> float | str:
    """A demand for a cell of a CSV file: ``inf`` or ``-inf`` for that of an overturned history."""
    return str(value) if math.isinf(value) else value


def verdict_columns(keys: Sequence[str], verdicts: Sequence[Verdict]) -> list[Column]:
    """`verdicts.csv`: one row a limit of each system and intensity."""
    conditions = [verdict.condition for verdict in verdicts]
    fractiles = [None if v.fractile is None else reached(v.fractile) for v in verdicts]
    return [
        *key_columns(keys, [verdict.values for verdict in verdicts]),
        Column("limit", "-", [condition.name for condition in conditions]),
        Column("unit", "-", [limit_unit(c.name) for c in conditions]),
        Column("at_most", "SI", [None if c.from_below else c.limit for c in conditions]),
        Column("at_least", "SI", [c.limit if c.from_below else None for c in conditions]),
        Column(
            "admissible_share", "-", [c.share if c.fractile is None else None for c in conditions]
        ),
        Column("fractile", "-", [condition.fractile for condition in conditions]),
        Column("value_at_fractile", "SI", fractiles),
        *counted_columns([verdict.beyond for verdict in verdicts]),
        *share_columns("beyond", [verdict.beyond for verdict in verdicts]),
        Column("overturned_among_them", "-", [verdict.overturned for verdict in verdicts]),
        Column("exceeded", "-", [str(verdict.exceeded).lower() for verdict in verdicts]),
        Column("shown", "-", [str(verdict.shown).lower() for verdict in verdicts]),
        Column("shown_by_recordings", "-", [verdict.shown_by for verdict in verdicts]),
        Column("source", "-", [condition.source for condition in conditions]),
    ]


def summary_document(summary: Summary) -> list[dict[str, Any]]:
    """The rows in JSON; a demand is null where so many overturned."""
    return [
        {
            "system": dict(zip(summary.keys, row.values, strict=True)),
            "counted": row.overturned.of,
            row.overturned.by: row.overturned.recordings,
            "failed": row.failed,
            "overturned": share_document(row.overturned),
            "demands": {
                quantity.name: {
                    "mean_of_maxima": spread.mean,
                    "median": spread.median,
                    "fractile_16" if quantity.from_below else "fractile_84": spread.high,
                    "least" if quantity.from_below else "largest": spread.largest,
                }
                for quantity, spread in zip(summary.quantities, row.spreads, strict=True)
            },
        }
        for row in summary.rows
    ]


def share_document(share: Share) -> dict[str, Any]:
    """A share in JSON."""
    return {"count": share.number, "share": share.fraction, "low": share.low, "high": share.high}


def verdict_document(keys: Sequence[str], verdict: Verdict) -> dict[str, Any]:
    """A verdict in JSON; a value is null where the history overturned."""
    return {
        "system": dict(zip(keys, verdict.values, strict=True)),
        **asdict(verdict.condition),
        "counted": verdict.beyond.of,
        verdict.beyond.by: verdict.beyond.recordings,
        "beyond": share_document(verdict.beyond),
        "overturned_among_them": verdict.overturned,
        "value": verdict.value,
        "record": verdict.record,
        "value_at_fractile": verdict.fractile,
        "exceeded": verdict.exceeded,
        "shown": verdict.shown,
        "shown_by_recordings": verdict.shown_by,
        **({"interval": verdict.interval} if verdict.interval else {}),
    }


def verdict_lines(keys: Sequence[str], verdicts: Sequence[Verdict], of: str = "") -> list[str]:
    """Each limit that fails in a line."""
    lines = []
    for verdict in verdicts:
        if verdict.fails:
            what = "limit exceeded" if verdict.exceeded else "limit not shown to be met"
            system = labels(keys, verdict.values)
            asked = f"{verdict.condition.name}: {requirement_text(verdict.condition)}"
            where = f" ({system})" if system else ""
            lines.append(
                f"{what}: {of}{asked}; {verdict_text(verdict)}{where}, {verdict.condition.source}"
            )
    return lines
