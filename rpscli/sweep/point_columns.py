"""The points of a study as columns: what `points.csv` holds, as arrays."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from rpscli.sweep.points.described import described
from rpscli.sweep.points_csv import scale_of, units_of_columns
from rpscli.sweep.table import Table
from rpscli.units import in_si

Columns = dict[str, NDArray[Any]]


def point_columns(table: Table) -> Columns:
    """(points,) of each column of `points.csv` under its name: SI numbers, else objects.

    Results that do not exist are NaN.
    """
    layout = table.layout
    units = dict(units_of_columns(layout))
    rows = [described(layout, point) for point in layout]
    columns = {name: array([in_si(row[name], units[name]) for row in rows]) for name in rows[0]}
    if "scale" in units:
        columns["scale"] = np.array([scale_of(table, point) for point in layout])
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
