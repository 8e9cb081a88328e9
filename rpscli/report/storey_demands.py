"""Largest demands of each storey in a time history, on bearings and on a fixed base."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.results import TimeHistoryResult

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class StoreyDemands:
    """Largest absolute values in each storey from the bottom, arrays
    (n,): `STOREYS` of results.

    Drift ratios are None where the case gives no storey heights.
    """

    storey_drifts: Array
    storey_drift_ratios: Array | None
    storey_shears: Array
    floor_accelerations: Array
    floor_velocities: Array


def isolated_demands(result: TimeHistoryResult) -> StoreyDemands:
    """Demands of the building on its bearings."""
    return _demands(result, result.max_drifts, result)


def fixed_base_demands(result: TimeHistoryResult) -> StoreyDemands | None:
    """Demands of the same building on a fixed base; None without a building."""
    fixed = result.fixed_base
    return None if fixed is None else _demands(result, fixed.drifts, fixed)


def _demands(result: TimeHistoryResult, drifts: Array, of: Any) -> StoreyDemands:
    building = result.structure.superstructure
    ratios = None if building is None else building.drift_ratios(drifts)
    floors = of.floor_accelerations, of.floor_velocities
    return StoreyDemands(drifts, ratios, of.storey_shears, *floors)
