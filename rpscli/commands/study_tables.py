"""A study as tables for a terminal: demands of each system at each intensity, and verdicts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from rpscli.case.conditions import condition_text
from rpscli.report.numbers import large, shown
from rpscli.report.table import Part, Table

if TYPE_CHECKING:
    from rpscli.analyses.result_quantities import ResultQuantity
    from rpscli.sweep.statistics.fractiles import Spread
    from rpscli.sweep.statistics.summary import Summary
    from rpscli.sweep.statistics.verdicts import Verdict

MOST_ROWS = 40
"""The CSV files have them all."""
DIGITS = 3
A_TABLE = 3
"""Quantities side by side in a table that fits a page."""


def summary_tables(summary: Summary) -> Iterator[Part]:
    """Outcomes; then median, 84 % fractile and largest value of the main demands."""
    rows = summary.rows[:MOST_ROWS]
    heads, cells = _system_columns(summary, [row.values for row in rows])
    shares = [(row.failed, row.overturned) for row in rows]
    outcomes = [
        [str(over.of), str(failed), str(over.number), over.interval] for failed, over in shares
    ]
    yield Table.of_texts(
        [*heads, "counted", "failed", "overturned", "95 % interval"],
        [[*system, *outcome] for system, outcome in zip(cells, outcomes, strict=True)],
        words=len(heads),
        keys=len(heads),
    )
    main = [place for place, quantity in enumerate(summary.quantities) if quantity.demand]
    for first in range(0, len(main), A_TABLE):
        places = main[first : first + A_TABLE]
        named = [_head(summary.quantities[place]) for place in places]
        spreads = [
            [_spread(row.spreads[place], summary.quantities[place]) for place in places]
            for row in rows
        ]
        yield Table.of_texts(
            [*heads, *named],
            [[*system, *spread] for system, spread in zip(cells, spreads, strict=True)],
            words=len(heads),
            keys=len(heads),
        )
    yield (
        "demands: median / 84 % fractile / largest; an overturned history is larger than any"
        " demand (inf)"
    )
    if summary.pooled:
        yield f"each row is over all records and {' and '.join(summary.pooled)}"
    if len(summary.rows) > len(rows):
        yield f"the first {len(rows)} of {len(summary.rows)} rows; all are in statistics.csv"


def _system_columns(
    summary: Summary, rows: Sequence[tuple[object, ...]]
) -> tuple[list[str], list[list[str]]]:
    from rpscli.report.study.labels import plain, symbol
    from rpscli.sweep.intensities import unit_of
    from rpscli.units import in_si

    units = [unit_of(key) for key in summary.keys]
    named = zip(map(symbol, summary.keys), units, strict=True)
    heads = [name if unit == "-" else f"{name} {unit}" for name, unit in named]
    return heads, [[plain(in_si(*cell)) for cell in zip(row, units, strict=True)] for row in rows]


def _head(quantity: ResultQuantity) -> str:
    _, unit = large(None, quantity.unit)
    return f"{quantity.label} {unit}".strip()


def _spread(spread: Spread, quantity: ResultQuantity) -> str:
    values = [large(value, quantity.unit)[0] for value in spread]
    return " / ".join(shown(value, DIGITS) for value in values)


def verdict_table(summary: Summary, verdicts: Sequence[Verdict]) -> Table:
    """Every limit of each system and intensity; those that are exceeded first."""
    from rpscli.report.study.statistics import verdict_text

    ordered = sorted(verdicts, key=lambda verdict: not verdict.exceeded)[:MOST_ROWS]
    heads, cells = _system_columns(summary, [verdict.values for verdict in ordered])
    rows = [
        [
            *system,
            verdict.condition.name,
            "EXCEEDED" if verdict.exceeded else "met",
            condition_text(verdict.condition),
            verdict_text(verdict),
        ]
        for system, verdict in zip(cells, ordered, strict=True)
    ]
    keys = len(heads) + 1
    heads += ["limit", "", "asked for", "found"]
    return Table.of_texts(heads, rows, words=keys + 2, keys=keys)
