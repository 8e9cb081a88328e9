"""The summary of several records on a page: verdicts first, then one table."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from rpscli.analyses.result_quantities import EVERY, ResultQuantity
from rpscli.case.conditions import EVENTS
from rpscli.commands.records_table import STATISTICS
from rpscli.commands.timehistory_run import Computed, set_tables
from rpscli.report.limits import VERDICT, verdict_texts, verdicts_in_short, worst_text
from rpscli.report.page import Block
from rpscli.report.table import PAGE_UNITS, Heading, Table, large, shown, standing
from rpscli.sweep.statistics.fractiles import Spread
from rpscli.units import Written, si_factor

MAIN = (
    "rotation_ratio",
    "max_cap_beam_displacement",
    "max_corner_displacement",
    "corner_factor",
    "max_base_shear",
    "drift_ratio",
    "ductility",
    "max_floor_acceleration",
    "friction_demand",
    "max_column_force",
)
"""Results that stand beside those with limits, as far as there is room."""
SAME = {"rotation_ratio": "max_rotation", "friction_demand": "friction_ratio"}
"""Results that differ from others by a constant factor, beside which they do
not stand.
"""
COLUMNS = 8
"""Results side by side, which fit paper."""


def records_in_short(found: Computed) -> Iterator[Block]:
    """Verdicts on several records, one table of them, and remarks."""
    yield verdicts_in_short(found.verdicts)
    if found.verdicts:
        rows = [[*verdict_texts(v)[:-1], worst_text(v)] for v in found.verdicts]
        yield Table.of_texts(VERDICT, rows, words=4)
    yield records_table(found)
    yield (
        "All results of these records: statistics.csv and records.csv of `rps timehistory`,"
        " by the command at the end of this page."
    )
    for part in set_tables([found]):
        if not isinstance(part, Table | Heading):
            yield part


def records_table(found: Computed) -> Table:
    """A row each record, and statistics below: results with limits, then main ones."""
    (row,) = found.together.rows
    spreads = dict(zip(found.together.quantities, row.spreads, strict=True))
    chosen = _chosen(found, spreads)
    units = [_unit(found, quantity) for quantity in chosen]
    rows = []
    for label, history in zip(found.labels, found.histories, strict=True):
        document = history.document
        word = str(document["outcome"]).replace("_", " ")
        values = [document[quantity.name] for quantity in chosen]
        rows.append([label, word, *_texts(values, units, shown)])
    for name, label in STATISTICS.items():
        values = [getattr(spreads[quantity], name) for quantity in chosen]
        rows.append([label, "", *_texts(values, units, standing)])
    heads = [
        f"{quantity.label} {name}".strip()
        for quantity, (name, _) in zip(chosen, units, strict=True)
    ]
    return Table.of_texts(["record", "", *heads], rows, words=2)


def _chosen(
    found: Computed, spreads: dict[ResultQuantity, Spread]
) -> list[ResultQuantity]:
    """Results with limits, and main ones up to the number of columns."""
    limited = [
        verdict.condition.name
        for verdict in found.verdicts
        if verdict.condition.name not in EVENTS
    ]
    known = [EVERY[name] for name in dict.fromkeys(limited) if EVERY[name] in spreads]
    main = [EVERY[name] for name in MAIN if EVERY[name] in spreads]
    further = [
        quantity
        for quantity in main
        if not {quantity.name, SAME.get(quantity.name)} & set(limited)
    ]
    return [*known, *further[: max(0, COLUMNS - len(known))]]


def _unit(found: Computed, quantity: ResultQuantity) -> tuple[str, float]:
    """The unit of a result on the page, that of its limit if it was written with one."""
    for verdict in found.verdicts:
        limit = verdict.condition.limit
        same = verdict.condition.name == quantity.name
        if same and isinstance(limit, Written) and limit.unit:
            return limit.unit, 1.0 / si_factor(limit.unit, quantity.unit)
    factor, name = large(1.0, quantity.unit, PAGE_UNITS)
    return name, factor or 1.0


def _texts(
    values: Sequence[float | None],
    units: Sequence[tuple[str, float]],
    form: Callable[[float | None], str],
) -> list[str]:
    """Values in SI as texts in their units."""
    return [
        form(None if value is None else factor * value)
        for value, (_, factor) in zip(values, units, strict=True)
    ]
