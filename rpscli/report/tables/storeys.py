"""The largest demands of each storey, isolated and on a fixed base, side by side."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.results import TimeHistoryResult
from rpscli.report.files.csv_text import Column

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class StoreyDemands:
    """Largest absolute values in each storey from the bottom, all arrays (n,).

    Drift ratios are None where the case gives no storey heights.
    """

    drift: Array
    drift_ratio: Array | None
    shear: Array
    floor_acceleration: Array
    floor_velocity: Array


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
    return columns + (_columns("fixed_base_", fixed, count) if fixed else [])


def _demands(
    result: TimeHistoryResult, drift: Array, shear: Array, acceleration: Array, velocity: Array
) -> StoreyDemands:
    building = result.structure.superstructure
    heights = None if building is None else building.storey_heights
    ratio = None if heights is None else drift / heights
    return StoreyDemands(drift, ratio, shear, acceleration, velocity)


def _columns(prefix: str, demands: StoreyDemands, count: int) -> list[Column]:
    ratio = [None] * count if demands.drift_ratio is None else demands.drift_ratio
    return [
        Column(f"{prefix}max_drift", "m", demands.drift),
        Column(f"{prefix}drift_ratio", "-", ratio),
        Column(f"{prefix}max_shear", "N", demands.shear),
        Column(f"{prefix}floor_acceleration", "m/s2", demands.floor_acceleration),
        Column(f"{prefix}floor_velocity", "m/s", demands.floor_velocity),
    ]
