"""Statistics of a study and verdicts on them: CSV columns,
documents, and tables for readers.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict
from typing import Any

from rpscli.analyses.result_quantities import HISTORY, SAMPLED, YIELDING
from rpscli.case.conditions import replaced_limits
from rpscli.report.limits import (
    VERDICT,
    limit_unit,
    requirement_text,
    verdict_text,
    verdict_texts,
)
from rpscli.report.study.report import (
    key_cells,
    key_columns,
    keyed,
    named_cells,
    reached,
)
from rpscli.report.table import Column, Part, Table, columns_of, headed, large, standing
from rpscli.report.timehistory import direction_note, overturned_text, restitution_text
from rpscli.sweep.names import SYSTEM, labels, symbol
from rpscli.sweep.points import StudyPoints
from rpscli.sweep.statistics.fractiles import Share, Spread
from rpscli.sweep.statistics.summary import Summary
from rpscli.sweep.statistics.verdicts import Verdict

MOST_ROWS = 40  # of a table on a page
DIGITS = 3
A_TABLE = 3  # quantities side by side in a table that fits a page

SPREAD = {"median": "median", "84": "high", "largest": "largest"}
"""What follows the name of a quantity in a column, and the attribute of its spread."""
OF_RECORDS = {
    "mean_of_maxima": "mean", "median": "median", "fractile_84": "high", "largest": "largest"
}  # fmt: skip
FROM_BELOW = {"84": "16", "fractile_84": "fractile_16", "largest": "least"}
"""Names of those of which small values are bad."""


def counted_columns(shares: Sequence[Share]) -> list[Column]:
    """Histories, and the recordings or events that they come from."""
    by = shares[0].by if shares else "recordings"
    return columns_of(
        f"counted, {by}", [(share.of, share.recordings) for share in shares]
    )


def share_columns(name: str, shares: Sequence[Share]) -> list[Column]:
    """Count, share and interval; `name` is what is counted."""
    heads = f"{name}, {name}_share, {name}_low, {name}_high"
    return columns_of(
        heads, [(each.number, each.fraction, *each[2:4]) for each in shares]
    )


def summary_columns(summary: Summary) -> list[Column]:
    """`statistics.csv`: one row a system and intensity; ``inf``
    where so many overturned.
    """
    rows = summary.rows
    overturned = [row.overturned for row in summary.rows]
    columns = key_columns(summary.keys, [row.values for row in rows])
    if any(summary.systems):
        columns.append(Column(SYSTEM, "-", summary.systems))
    columns += counted_columns(overturned)
    columns.append(Column("failed", "-", [row.failed for row in rows]))
    columns += share_columns("overturned", overturned)
    for place, quantity in enumerate(summary.quantities):
        for suffix, attribute in SPREAD.items():
            values = [reached(getattr(row.spreads[place], attribute)) for row in rows]
            ending = FROM_BELOW.get(suffix, suffix) if quantity.from_below else suffix
            columns.append(Column(f"{quantity.name}_{ending}", quantity.unit, values))
    return columns


def records_columns(
    labels: Sequence[str], histories: Sequence[Mapping[str, Any]]
) -> list[Column]:
    """`records.csv`: one row a record."""
    known = [q for q in (*HISTORY, *YIELDING, *SAMPLED) if q.name in histories[0]]
    rows = [
        (label, of["record"]["scale"], of["outcome"], *(of[q.name] for q in known))
        for label, of in zip(labels, histories, strict=True)
    ]
    titles = ("record, scale, outcome", *(f"{q.name} [{q.unit}]" for q in known))
    return columns_of(", ".join(titles), rows)


def demand_columns(summary: Summary) -> list[Column]:
    """`statistics.csv` of one structure: one row a demand; ``inf``
    where so many overturned.
    """
    (row,) = summary.rows
    rows = [
        (
            of.name,
            of.unit,
            *(reached(getattr(spread, name)) for name in OF_RECORDS.values()),
        )
        for of, spread in zip(summary.quantities, row.spreads, strict=True)
        if not of.from_below
    ]
    return columns_of(
        f"quantity, unit, {', '.join(f'{name} [SI]' for name in OF_RECORDS)}", rows
    )


def verdict_columns(keys: Sequence[str], verdicts: Sequence[Verdict]) -> list[Column]:
    """`verdicts.csv`: one row a limit of each system and intensity."""
    limits = []
    results = []
    for verdict in verdicts:
        of = verdict.condition
        found = verdict.fractile
        bounds = (None, of.limit) if of.from_below else (of.limit, None)
        share = of.share if of.fractile is None and of.of is None else None
        at = None if found is None else reached(found)
        mean = None if verdict.mean is None else reached(verdict.mean)
        unit = limit_unit(of.name)
        asked = of.fractile, at, of.of, mean, verdict.judged_by
        limits.append((verdict.values, of.name, unit, *bounds, share, *asked))
        flags = verdict.exceeded, verdict.shown
        results.append(
            (verdict.overturned, *flags, verdict.shown_by, of.source, of.factor)
        )
    heads = "limit, unit, at_most [SI], at_least [SI], admissible_share, fractile"
    found_heads = "value_at_fractile [SI], of, mean_of_maxima [SI], judged_by"
    last_heads = "overturned_among_them, exceeded, shown, shown_by_recordings, source"
    beyond = [verdict.beyond for verdict in verdicts]
    return [
        *keyed(keys, f"{heads}, {found_heads}", limits),
        *counted_columns(beyond),
        *share_columns("beyond", beyond),
        *columns_of(f"{last_heads}, factor", results),
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
                    FROM_BELOW.get(name, name) if quantity.from_below else name: getattr(
                        spread, attribute
                    )
                    for name, attribute in OF_RECORDS.items()
                }
                for quantity, spread in zip(summary.quantities, row.spreads, strict=True)
            },
        }
        for row in summary.rows
    ]


def share_document(share: Share) -> dict[str, Any]:
    """A share in JSON."""
    return {
        "count": share.number,
        "share": share.fraction,
        "low": share.low,
        "high": share.high,
    }


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
        "mean_of_maxima": verdict.mean,
        "judged_by": verdict.judged_by,
        "exceeded": verdict.exceeded,
        "shown": verdict.shown,
        "shown_by_recordings": verdict.shown_by,
        "near": verdict.near,
        "reversed_by": verdict.reversed_by,
        **({"interval": verdict.interval} if verdict.interval else {}),
    }


def verdict_lines(
    keys: Sequence[str], verdicts: Sequence[Verdict], of: str = ""
) -> list[str]:
    """Each limit that fails in a line."""
    lines = []
    for verdict in filter(lambda verdict: verdict.fails, verdicts):
        what = "limit exceeded" if verdict.exceeded else "limit not shown to be met"
        system = labels(keys, verdict.values)
        limit = verdict.condition
        where = f" ({system})" if system else ""
        asked = f"{what}: {of}{limit.name}: {requirement_text(limit)}"
        lines.append(f"{asked}; {verdict_text(verdict)}{where}, {limit.source}")
    return lines


def summary_tables(
    summary: Summary | None, wanted: set[str] | None = None
) -> Iterator[Part]:
    """Outcomes; then median, 84 % fractile and largest value of
    demands: the main or some.
    """
    if summary is None:
        return
    rows = summary.rows
    systems = [row.values for row in summary.rows]
    behind = [row.overturned.by for row in rows if row.overturned.behind][:1]
    outcomes = []
    for row in rows:
        over = row.overturned
        counts = [over.of, *[over.recordings] * len(behind), row.failed, over.number]
        outcomes.append([*map(str, counts), over.interval])
    heads = ["counted", *behind, "failed", "overturned", "95 % interval"]
    yield _of_systems(summary, systems, heads, outcomes)
    shown = [
        (place, quantity)
        for place, quantity in enumerate(summary.quantities)
        if (quantity.demand if wanted is None else quantity.name in wanted)
        and not quantity.from_below
    ]
    kinds = ([each for each in shown if each[1].demand is main] for main in (True, False))
    for some in (of[n : n + A_TABLE] for of in kinds for n in range(0, len(of), A_TABLE)):
        named = [headed(quantity.label, quantity.unit) for _, quantity in some]
        spreads = [
            [_spread(row.spreads[place], of.unit) for place, of in some] for row in rows
        ]
        yield _of_systems(summary, systems, named, spreads)
    if shown:
        yield (
            "demands: median (of an even number the lower of the middle two) / 84 % fractile"
            " / largest; - where so many overturned, and"
            " in brackets the least and the largest of those that stand"
        )
    if summary.pooled:
        yield f"each row is over all records and {' and '.join(summary.pooled)}"


def _spread(spread: Spread, unit: str) -> str:
    *three, _, low, high = (standing(large(value, unit)[0], DIGITS) for value in spread)
    some = math.isinf(spread.largest) and not math.isnan(spread.low_stands)
    return " / ".join(three) + f" ({low} to {high})" * some  # the mean is in JSON


def verdict_table(summary: Summary, verdicts: Sequence[Verdict]) -> Table:
    """Every limit of each system and intensity; those that are exceeded first."""
    ordered = sorted(verdicts, key=lambda verdict: (not verdict.exceeded, verdict.shown))
    systems = [verdict.values for verdict in ordered]
    return _of_systems(
        summary, systems, VERDICT, map(verdict_texts, ordered), words=4, keys=1
    )


def _of_systems(
    summary: Summary,
    systems: Sequence[tuple[object, ...]],
    heads: Sequence[str],
    cells: Iterable[Sequence[str]],
    *,
    words: int = 0,
    keys: int = 0,
) -> Table:
    """A table whose rows begin with a system and an intensity."""
    columns = key_columns(summary.keys, systems)
    names = named_cells(columns)
    named = [
        (symbol(column.name), names[column.name])
        if column.name in names
        else key_cells(column, symbol(column.name))
        for column in columns
        if names.get(column.name) != []
    ]
    rows = [
        [*(texts[place] for _, texts in named), *others]
        for place, others in enumerate(cells)
    ]
    own = [head for head, _ in named]
    return Table.of_texts(
        [*own, *heads], rows, words=len(own) + words, keys=len(own) + keys
    )


def of_first_system(layout: StudyPoints) -> str:
    """Overturning and restitution of the first system, others differ;
    limits that do not count.
    """
    first = layout.system(0)
    text = overturned_text(first.structure, first.settings)
    text = f"{text}; {restitution_text(first.structure)}"
    text += " (the first system)" * (len(layout.properties) > 1)
    if of_base := replaced_limits(layout.plan.base, layout.study.file.limits):
        text += f"; its own limits replace those of the base case: {of_base}"
    return text


def note_of_directions(layout: StudyPoints) -> str:
    """That histories have one direction only; by the first system,
    whether they could have both.
    """
    return direction_note(layout.pairs, layout.system(0).structure.planar_only)


def first_tables(parts: Sequence[Part], count: int, others: str) -> list[Part]:
    """The first tables with their remarks, and where the others are."""
    tables = [part for part in parts if isinstance(part, Table)]
    if count >= len(tables):
        return [*parts]
    away = tables[count:]
    kept = [part for part in parts if not any(part is each for each in away)]
    return [*kept, f"further demands, {len(away)} tables: statistics.csv{others}"]


COMPARED = 4
"""Rows of a table that are not cut: variants are there to be compared."""


def cut(parts: Iterable[Part], rows: int = MOST_ROWS, others: str = "") -> Iterator[Part]:
    """The parts with so many rows of each table, but listings, and a
    remark on what is left out.
    """
    longest = 0
    for part in parts:
        most = max(rows, COMPARED)
        if isinstance(part, Table) and any(part.heads) and len(part) > most:
            longest = max(longest, len(part))
            yield part.first(most)
        else:
            yield part
    if longest:
        most = max(rows, COMPARED)
        yield f"{most} of up to {longest} rows are shown; all are in the CSV files{others}"
