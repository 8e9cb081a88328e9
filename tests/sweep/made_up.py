"""Studies with made-up results, whose statistics are known."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from types import SimpleNamespace
from typing import Any, NamedTuple, cast

import numpy as np

from rpscli.report.study.report import Found
from rpscli.sweep.evaluation import FAILED, MISSING, SCALARS, PointResults, at_path, stacked
from rpscli.sweep.points import StudyPoints, lay_out
from rpscli.sweep.table import StudyResults, Table
from sweep.small_studies import STUDY, Make


class Stored(NamedTuple):
    """What a study might hold of a point."""

    outcome: str
    message: str | None
    results: dict[str, Any]


Answer = Callable[[int], Stored]

RHO, ALPHA = "podium.bearing.curvature_ratio", "podium.bearing.slenderness"


def stored(outcome: str = "survived", **results: object) -> Stored:
    """A made-up result."""
    whole: dict[str, object] = dict.fromkeys(SCALARS["timehistory"], 0.0)
    shears = results.pop("storey_shears", [3.0, 2.0, 1.0])
    return Stored(outcome, None, {**whole, "scale": 1.0, **results, "storey_shears": shears})


def reader(rows: Iterable[Stored | None]) -> Callable[[Iterable[str]], PointResults]:
    """Reads columns of rows by their names, as a store does."""
    points = [row or Stored(MISSING, None, {}) for row in rows]
    names = dict.fromkeys(name for point in points for name in point.results)
    columns = {name: stacked([point.results.get(name) for point in points]) for name in names}
    outcomes = np.array([point.outcome for point in points], dtype="U20")
    told = {n: point.message or "" for n, point in enumerate(points) if point.outcome == FAILED}

    def read(wanted: Iterable[str]) -> PointResults:
        known = {name: at_path(columns, name) for name in wanted}
        found = {name: column for name, column in known.items() if column is not None}
        return PointResults(outcomes, told, found)

    return read


def tabulate(layout: StudyPoints, rows: Iterable[Stored | None]) -> Table:
    return Table.of(layout, reader(rows))


def table_of(make: Make, answer: Answer, *changes: tuple[str, str]) -> Table:
    """The study of 2 slendernesses x 3 curvatures x 3 records x 2 scales with made-up results."""
    layout = lay_out(make(STUDY, *changes))
    return tabulate(layout, (answer(number) for number in range(len(layout))))


def place(layout: StudyPoints, number: int) -> dict[str, object]:
    point = layout[number]
    assert point.record is not None
    named = dict(zip(layout.plan.keys, point.values, strict=True))
    return {**named, "record": int(point.record.source[-1]), "scale": point.scale}


def results_of(found: Table, rows: Iterable[Stored] = (), fixed: Any = None) -> StudyResults:
    """Results of a study as reports take them; rows are what is stored of its points."""
    results = SimpleNamespace(
        table=found, context=found.layout.context, stored=reader(rows), fixed_base=fixed
    )
    return cast("StudyResults", results)


def cells(found: Found, suffix: str = "") -> dict[str, list[Any]]:
    """Values of the columns of a table of a report, by name."""
    return {
        column.name: np.asarray(column.values, dtype=object).tolist()
        for column in found.tables[suffix]
    }
