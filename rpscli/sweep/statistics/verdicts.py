"""A study against its limits: each system at each intensity is judged by itself."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rpscli.case.conditions import EVENTS, Condition
from rpscli.sweep.statistics.fractiles import demand, fractiles
from rpscli.sweep.statistics.share import Share, share
from rpscli.sweep.statistics.summary import Summary, SummaryRow
from rpscli.sweep.table import Table


@dataclass(frozen=True)
class StudyVerdict:
    """What became of a condition for one system at one intensity.

    Parameters
    ----------
    values
        Of the keys of the summary.
    condition
        What was asked for.
    beyond
        Histories that exceed it; every overturned one does.
    overturned
        Those of them that overturned, where the condition is on a result: it is exceeded for no
        other reason, perhaps.
    fractile
        The demand at the fractile of the condition, infinite if so many overturned; None where
        the condition has a share.
    exceeded
        Whether the condition is not kept; without any history it is not.
    """

    values: tuple[object, ...]
    condition: Condition
    beyond: Share
    overturned: int
    fractile: float | None
    exceeded: bool


def judged(
    table: Table, summary: Summary, conditions: Iterable[Condition] = ()
) -> list[StudyVerdict]:
    """Verdicts in the order of the summary's rows.

    Parameters
    ----------
    table
        Of time histories.
    summary
        Whose rows are judged.
    conditions
        Besides the limits of study and cases.
    """
    further = tuple(conditions)
    layout = table.layout
    found = []
    for row in summary.rows:
        if len(row.points):
            system = int(row.points[0]) // layout.points_of_system
            limits = layout.properties[system].limits
            found += [_verdict(table, row, condition) for condition in (*limits, *further)]
    return found


def exceeds(table: Table, name: str, limit: float) -> NDArray[np.bool_]:
    """(points,) in which a result is beyond a limit; overturned ones exceed every limit.

    A history that has no such result does not keep the limit either.

    Parameters
    ----------
    name
        Of a result, ``overturning`` or ``uplift``.
    limit
        In SI units; of no meaning for an event.
    """
    if name == "overturning":
        return table.overturned
    if name == "uplift":
        return np.asarray(table.overturned | (table.columns["uplifts"] > 0.0))
    kept = Condition(name, limit, "").kept_by(table.columns[name])
    return np.asarray(table.overturned | ~kept)


def _verdict(table: Table, row: SummaryRow, condition: Condition) -> StudyVerdict:
    count = int(exceeds(table, condition.name, condition.limit)[row.points].sum())
    beyond = share(count, len(row.points))
    fallen = 0 if condition.name in EVENTS else row.overturned.number
    if condition.fractile is None:
        exceeded = count / len(row.points) > condition.share
        return StudyVerdict(row.values, condition, beyond, fallen, None, exceeded)
    column = table.columns[condition.name]
    demands = demand(table, column, from_below=condition.from_below)[row.points]
    (at,) = fractiles(demands, [condition.fractile]).tolist()
    return StudyVerdict(row.values, condition, beyond, fallen, at, not condition.kept_by(at))
