"""The largest demands of each storey, isolated and on a fixed base, side by side."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.result_quantities import STOREYS
from rpscli.analyses.results import TimeHistoryResult
from rpscli.report.table import Column

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class StoreyDemands:
    """Largest absolute values in each storey from the bottom, arrays (n,): `STOREYS` of results.

    Drift ratios are None where the case gives no storey heights.
    """

    storey_drifts: Array
    storey_drift_ratios: Array | None
    storey_shears: Array
    floor_accelerations: Array
    floor_velocities: Array


def isolated_demands(result: TimeHistoryResult) -> StoreyDemands:
    """Demands of the building on its bearings."""
    floors = result.floor_accelerations, result.floor_velocities
    return _demands(result, result.max_drifts, result.storey_shears, *floors)


def fixed_base_demands(result: TimeHistoryResult) -> StoreyDemands | None:
    """Demands of the same building on a fixed base; None without a building."""
    fixed = result.fixed_base
    if fixed is None:
        return None
    floors = fixed.floor_accelerations, fixed.floor_velocities
    return _demands(result, fixed.drifts, fixed.storey_shears, *floors)


def storey_columns(result: TimeHistoryResult) -> list[Column]:
    """`storeys.csv`: one row a storey, from the bottom."""
    count = result.structure.storeys
    columns = [Column("storey", "-", range(1, count + 1))]
    columns += _columns("", isolated_demands(result), count)
    fixed = fixed_base_demands(result)
    return [*columns, *(_columns("fixed_base_", fixed, count) if fixed else ())]


def _demands(
    result: TimeHistoryResult, drifts: Array, shears: Array, accelerations: Array, velocities: Array
) -> StoreyDemands:
    building = result.structure.superstructure
    ratios = None if building is None else building.drift_ratios(drifts)
    return StoreyDemands(drifts, ratios, shears, accelerations, velocities)


def _columns(prefix: str, demands: StoreyDemands, count: int) -> Iterator[Column]:
    for quantity in STOREYS:
        values = getattr(demands, quantity.name)
        known = [None] * count if values is None else values
        yield Column(f"{prefix}{quantity.column}", quantity.unit, known)
