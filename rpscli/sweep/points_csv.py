"""The points of a study as columns: as arrays, and as `points.csv`.

The file has one line a point, in the order of the study, and the same bytes on every run.
"""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rpscli.sweep.evaluation.results import SCALARS
from rpscli.sweep.intensities import unit_of
from rpscli.sweep.points.layout import StudyPoints
from rpscli.sweep.table import Array, Table
from rpscli.units import in_si

Columns = dict[str, NDArray[Any]]

LINES_A_PIECE = 1000


def points_csv(table: Table) -> Iterator[str]:
    """The text, in pieces. Numbers have all their digits; what does not exist is empty."""
    layout, scales, names = table.layout, _scales(table), units_of_columns(table.layout)
    units = dict(names)
    known = [
        (layout.places[of], [_cell(value, units[name]) for value in values])
        for name, (of, values) in layout.identifying.items()
    ]
    results = [(table.columns[name], q.whole) for name, q in SCALARS[layout.plan.analysis].items()]
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(f"{name} [{of}]" for name, of in names)
    for first in range(0, len(table), LINES_A_PIECE):
        piece = slice(first, first + LINES_A_PIECE)
        columns = [[cells[i] for i in places[piece].tolist()] for places, cells in known]
        columns += [] if scales is None else [_numbers(scales[piece])]
        columns.append(table.outcomes[piece].tolist())
        columns += [_numbers(column[piece], whole=whole) for column, whole in results]
        writer.writerows(zip(*columns, strict=True))
        yield buffer.getvalue()
        buffer.seek(0)
        buffer.truncate()


def units_of_columns(layout: StudyPoints) -> list[tuple[str, str]]:
    """Names and units of all columns."""
    columns = [(name, unit_of(name)) for name in layout.identifying]
    if layout.plan.analysis == "timehistory":
        columns.append(("scale", "-"))
    columns.append(("outcome", "-"))
    results = SCALARS[layout.plan.analysis]
    return columns + [(path, quantity.unit) for path, quantity in results.items()]


def _scales(table: Table) -> Array | None:
    """Factors on the records; known beforehand unless a measure decides about them."""
    plan = table.layout.plan
    if plan.analysis != "timehistory":
        return None
    return table.layout.factors if plan.measure is None else table.scale


def point_columns(table: Table) -> Columns:
    """(points,) of each column of `points.csv` by name: SI numbers, NaN for none, else objects."""
    layout, scales = table.layout, _scales(table)
    units = dict(units_of_columns(layout))
    columns = {
        name: array([in_si(value, units[name]) for value in values])[layout.places[of]]
        for name, (of, values) in layout.identifying.items()
    }
    if scales is not None:
        columns["scale"] = scales
    return {**columns, "outcome": table.outcomes, **table.columns}


def array(values: Any) -> NDArray[Any]:
    """Numbers if all of them are, with NaN for None; else objects."""
    kept = list(values)
    numbers = [np.nan if value is None else np.inf if value == "inf" else value for value in kept]
    if all(isinstance(value, int | float) for value in numbers):
        return np.array(numbers)
    found = np.empty(len(kept), dtype=object)
    found[:] = kept
    return found


def _numbers(values: Array, *, whole: bool = False) -> list[str]:
    finite = np.isfinite(values).tolist()
    if not any(finite):
        return [""] * len(finite)
    if whole:
        return [str(int(v)) if ok else "" for v, ok in zip(values.tolist(), finite, strict=True)]
    return [repr(v) if ok else "" for v, ok in zip(values.tolist(), finite, strict=True)]


def _cell(value: object, unit: str) -> str:
    """A value in the unit of its column; lists and mappings as JSON."""
    value = in_si(value, unit)
    if isinstance(value, str):
        return value
    return "" if value is None else json.dumps(value)
