"""The points of a study as columns: as arrays, and as `points.csv`.

The file has one line a point, in the order of the study, and the same bytes on every run.
"""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rpscli.sweep.evaluation.results import SCALARS
from rpscli.sweep.intensities import unit_of
from rpscli.sweep.points.layout import StudyPoints, described, identifying_columns
from rpscli.sweep.table import Array, Table
from rpscli.units import in_si

Columns = dict[str, NDArray[Any]]

LINES_A_PIECE = 1000


def points_csv(table: Table) -> Iterator[str]:
    """The text, in pieces. Numbers have all their digits; what does not exist is empty."""
    layout = table.layout
    results = [(table.columns[name], q.whole) for name, q in SCALARS[layout.plan.analysis].items()]
    names, cell = units_of_columns(layout), _cells(dict(units_of_columns(layout)))
    scales = _scales(table)
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(f"{name} [{of}]" for name, of in names)
    for first in range(0, len(table), LINES_A_PIECE):
        piece = slice(first, first + LINES_A_PIECE)
        points = (layout[number] for number in range(len(table))[piece])
        known = [[cell(*item) for item in described(layout, point).items()] for point in points]
        columns = [] if scales is None else [_numbers(scales[piece])]
        columns.append(table.outcomes[piece].tolist())
        columns += [_numbers(column[piece], whole=whole) for column, whole in results]
        writer.writerows([*start, *rest] for start, *rest in zip(known, *columns, strict=True))
        yield buffer.getvalue()
        buffer.seek(0)
        buffer.truncate()


def units_of_columns(layout: StudyPoints) -> list[tuple[str, str]]:
    """Names and units of all columns."""
    columns = [(name, unit_of(name)) for name in identifying_columns(layout)]
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
    if plan.measure is not None:
        return table.scale
    return np.array([point.scale * point.scale_change for point in table.layout])


def point_columns(table: Table) -> Columns:
    """(points,) of each column of `points.csv` under its name: SI numbers, else objects.

    Results that do not exist are NaN.
    """
    layout, scales = table.layout, _scales(table)
    units = dict(units_of_columns(layout))
    rows = [described(layout, point) for point in layout]
    columns = {name: array([in_si(row[name], units[name]) for row in rows]) for name in rows[0]}
    if scales is not None:
        columns["scale"] = scales
    return {**columns, "outcome": table.outcomes, **table.columns}


def array(values: Any) -> NDArray[Any]:
    """Numbers if all of them are, with NaN for None; else objects.

    >>> array([1, None, "inf"]).tolist(), array([0.5, "critical"]).tolist()
    ([1.0, nan, inf], [0.5, 'critical'])
    """
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


def _cells(units: dict[str, str]) -> Callable[[str, object], str]:
    """What writes a value of a column; each is looked at once."""
    known: dict[tuple[str, type, object], str] = {}

    def cell(name: str, value: object) -> str:
        key = name, type(value), value
        try:
            if key not in known:
                known[key] = _cell(value, units[name])
            return known[key]
        except TypeError:  # lists and mappings
            return _cell(value, units[name])

    return cell


def _cell(value: object, unit: str) -> str:
    """A value in the unit of its column; lists and mappings as JSON.

    >>> _cell(0.1, "-"), _cell("critical", "-"), _cell([1, 2], "-"), _cell("500 mm", "m")
    ('0.1', 'critical', '[1, 2]', '0.5')
    """
    value = in_si(value, unit)
    if isinstance(value, str):
        return value
    return "" if value is None else json.dumps(value)
