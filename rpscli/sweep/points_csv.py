"""`points.csv`: one line a point, in the order of the study, the same bytes on every run."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Iterator

from rpscli.sweep.described import described, identifying_columns
from rpscli.sweep.results import SCALARS
from rpscli.sweep.table import WHOLE, Table

LINES_A_PIECE = 1000


def points_csv(table: Table) -> Iterator[str]:
    """The text, in pieces. Numbers have all their digits; what does not exist is empty."""
    design = table.design
    histories = design.plan.analysis == "timehistory"
    header = [*identifying_columns(design), *(["scale"] if histories else []), "outcome"]
    names = SCALARS[design.plan.analysis]
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow([*header, *names])
    for number, point in enumerate(design):
        cells = [_cell(value) for value in described(design, point).values()]
        if histories:
            cells.append(_number("scale", _scale(table, number)))
        cells.append(str(table.outcomes[number]))
        cells += [_number(name, float(table.columns[name][number])) for name in names]
        writer.writerow(cells)
        if number % LINES_A_PIECE == LINES_A_PIECE - 1:
            yield buffer.getvalue()
            buffer.seek(0)
            buffer.truncate()
    yield buffer.getvalue()


def _scale(table: Table, number: int) -> float:
    """The factor on the record; known beforehand unless a measure decides about it."""
    if table.design.plan.measure is None:
        point = table.design[number]
        return point.scale * point.scale_change
    return float(table.scale[number])


def _number(name: str, value: float) -> str:
    if not math.isfinite(value):
        return ""
    return str(int(value)) if name in WHOLE else repr(value)


def _cell(value: object) -> str:
    """A value as the study has it; lists and mappings as JSON.

    >>> _cell(0.1), _cell(3), _cell("critical"), _cell([1, 2])
    ('0.1', '3', 'critical', '[1, 2]')
    """
    if isinstance(value, str):
        return value
    return "" if value is None else json.dumps(value)
