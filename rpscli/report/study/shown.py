"""A study as readers see it: statistics, verdicts, what reports say, cut where it is long."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence

from rpscli.report.documents import direction_note
from rpscli.report.limits import VERDICT, verdict_texts
from rpscli.report.study.labels import key_cells, key_columns, symbol
from rpscli.report.study.registry import REPORTS
from rpscli.report.table import Part, Table, headed, large, standing
from rpscli.report.tables.timehistory import overturned_text, restitution_text
from rpscli.sweep.points import StudyPoints
from rpscli.sweep.statistics.fractiles import Spread
from rpscli.sweep.statistics.summary import Summary
from rpscli.sweep.statistics.verdicts import Verdict

MOST_ROWS = 40  # of a table on a page
DIGITS = 3
A_TABLE = 3  # quantities side by side in a table that fits a page


def asked(layout: StudyPoints) -> set[str] | None:
    """Results that the reports of a study are about; None where it has none."""
    requests = layout.study.reports
    if not requests:
        return None
    return set().union(*(REPORTS[each.kind].results(each.options) for each in requests))


def summary_tables(summary: Summary | None, wanted: set[str] | None = None) -> Iterator[Part]:
    """Outcomes; then median, 84 % fractile and largest value of demands: the main or some."""
    if summary is None:
        return
    rows = summary.rows
    outcomes = []
    behind = [row.overturned.by for row in rows if row.overturned.behind][:1]
    for row in rows:
        over = row.overturned
        counts = [over.of, *[over.recordings] * len(behind), row.failed, over.number]
        outcomes.append([*map(str, counts), over.interval])
    systems = [row.values for row in rows]
    heads = ["counted", *behind, "failed", "overturned", "95 % interval"]
    yield _of_systems(summary, systems, heads, outcomes)
    main = [
        place
        for place, quantity in enumerate(summary.quantities)
        if (quantity.demand if wanted is None else quantity.name in wanted)
        and not quantity.from_below
    ]
    for first in range(0, len(main), A_TABLE):
        places = main[first : first + A_TABLE]
        quantities = [summary.quantities[place] for place in places]
        named = [headed(quantity.label, quantity.unit) for quantity in quantities]
        spreads = [
            [_spread(row.spreads[place], summary.quantities[place].unit) for place in places]
            for row in rows
        ]
        yield _of_systems(summary, systems, named, spreads)
    if main:
        yield (
            "demands: median / 84 % fractile / largest; - where so many overturned, and in brackets"
            " the least and the largest of those that stand"
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
    return _of_systems(summary, systems, VERDICT, map(verdict_texts, ordered), words=4, keys=1)


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
    named = [key_cells(column, symbol(column.name)) for column in columns]
    rows = [[*(texts[place] for _, texts in named), *others] for place, others in enumerate(cells)]
    own = [head for head, _ in named]
    return Table.of_texts([*own, *heads], rows, words=len(own) + words, keys=len(own) + keys)


def of_first_system(layout: StudyPoints) -> str:
    """Overturning and restitution of the first system, others differ; limits that do not count."""
    first = layout.system(0)
    text = overturned_text(first.structure, first.settings)
    text = f"{text}; {restitution_text(first.structure)}"
    text += " (the first system)" * (len(layout.properties) > 1)
    of_base = layout.plan.base.get("limits") if layout.study.file.limits else None
    replaced = "" if not of_base else f"; own limits replace all of the base: {', '.join(of_base)}"
    return text + replaced


def note_of_directions(layout: StudyPoints) -> str:
    """That histories have one direction only; by the first system, whether they could have both."""
    return direction_note(layout.pairs, layout.system(0).structure.planar_only)


def cut(parts: Iterable[Part], rows: int = MOST_ROWS, others: str = "") -> Iterator[Part]:
    """The parts with so many rows of each table, but listings, and a remark on what is left out."""
    longest = 0
    for part in parts:
        if isinstance(part, Table) and any(part.heads) and len(part) > rows:
            longest = max(longest, len(part))
            yield part.first(rows)
        else:
            yield part
    if longest:
        yield f"the first {rows} of up to {longest} rows; all are in the CSV files{others}"
