"""Storey shears and floor accelerations are left unformed only where none can be raised:
none of the largest is missed."""

from __future__ import annotations

import numpy as np
import pytest
from paper_structures import FLAT, building, needs_compiled_kernels, podium, waves

from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import denser_trace, time_history
from rpscli.model.superstructure import ModalDamping, RayleighDamping


@needs_compiled_kernels
@pytest.mark.parametrize("damping", [RayleighDamping(0.05), ModalDamping(0.02)], ids=str)
@pytest.mark.parametrize(("storeys", "rho"), [(1, FLAT), (4, 0.5), (7, 1.5), (11, FLAT)])
def test_maxima_are_those_of_a_dense_trace(
    storeys: int, rho: float, damping: RayleighDamping | ModalDamping
) -> None:
    structure = podium(storeys, 0.15, rho, superstructure=building(storeys, damping=damping))
    record = waves(10.0, 0.01, 2.5 * structure.uplift_acceleration, seed=3)
    result = time_history(structure, record, TimeHistorySettings(free_vibration=3.0))
    assert result.impacts > 10
    for trace, tolerance in ((result.trace, 0.1), (denser_trace(result, 5e-4), 2e-3)):
        shears = np.max(np.abs(trace.storey_shears), axis=0)
        accelerations = np.max(np.abs(trace.floor_accelerations), axis=0)
        # nothing is missed at a sample; stored ones are relative to the ground: u_b + v rounds v
        assert np.all(result.storey_shears >= (1.0 - 1e-3) * shears)
        assert result.storey_shears == pytest.approx(shears, rel=tolerance)
        assert result.floor_accelerations == pytest.approx(accelerations, rel=tolerance)
