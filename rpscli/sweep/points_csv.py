"""`points.csv`: one line a point, in the order of the study, the same bytes on every run."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Iterator

from rpscli.sweep.evaluation.points import Point
from rpscli.sweep.evaluation.results import SCALARS
from rpscli.sweep.intensities import unit_of
from rpscli.sweep.points.described import described, identifying_columns
from rpscli.sweep.points.layout import StudyPoints
from rpscli.sweep.table import Table
from rpscli.units import in_si

LINES_A_PIECE = 1000


def points_csv(table: Table) -> Iterator[str]:
    """The text, in pieces. Numbers have all their digits; what does not exist is empty."""
    layout = table.layout
    histories = layout.plan.analysis == "timehistory"
    results = [
        (table.columns[path].tolist(), quantity.whole)
        for path, quantity in SCALARS[layout.plan.analysis].items()
    ]
    names = units_of_columns(layout)
    units = dict(names)
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(f"{name} [{of}]" for name, of in names)
    for number, point in enumerate(layout):
        cells = [_cell(value, units[name]) for name, value in described(layout, point).items()]
        if histories:
            cells.append(_number(scale_of(table, point)))
        cells.append(str(table.outcomes[number]))
        cells += [_number(column[number], whole=whole) for column, whole in results]
        writer.writerow(cells)
        if number % LINES_A_PIECE == LINES_A_PIECE - 1:
            yield buffer.getvalue()
            buffer.seek(0)
            buffer.truncate()
    yield buffer.getvalue()


def units_of_columns(layout: StudyPoints) -> list[tuple[str, str]]:
    """Names and units of all columns."""
    columns = [(name, unit_of(name)) for name in identifying_columns(layout)]
    if layout.plan.analysis == "timehistory":
        columns.append(("scale", "-"))
    columns.append(("outcome", "-"))
    results = SCALARS[layout.plan.analysis]
    return columns + [(path, quantity.unit) for path, quantity in results.items()]


def scale_of(table: Table, point: Point) -> float:
    """The factor on the record; known beforehand unless a measure decides about it."""
    if table.layout.plan.measure is None:
        return point.scale * point.scale_change
    return float(table.scale[point.number])


def _number(value: float, *, whole: bool = False) -> str:
    if not math.isfinite(value):
        return ""
    return str(int(value)) if whole else repr(value)


def _cell(value: object, unit: str) -> str:
    """A value in the unit of its column; lists and mappings as JSON.

    >>> _cell(0.1, "-"), _cell("critical", "-"), _cell([1, 2], "-"), _cell("500 mm", "m")
    ('0.1', 'critical', '[1, 2]', '0.5')
    """
    value = in_si(value, unit)
    if isinstance(value, str):
        return value
    return "" if value is None else json.dumps(value)
