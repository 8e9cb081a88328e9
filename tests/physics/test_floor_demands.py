"""Storey shears and floor accelerations are left unformed only where none can be raised."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from paper_structures import FLAT, building, needs_compiled_kernels, podium, waves

from rpscli.analyses.kernel_tables import modal_rows
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.damping import ModalDamping, RayleighDamping
from rpscli.physics import contact_layout, layout
from rpscli.physics.floor_demands import raise_floors
from rpscli.physics.inspection import observe
from rpscli.physics.layout import ROLLING

from .one_lane import OneLane

amplitudes = st.lists(st.integers(-1000, 1000).map(lambda k: 1e-3 * k), min_size=4, max_size=4)


def seen(lane: OneLane, q: list[float], dq: list[float]) -> bool:
    """Whether the lane, at a sample with this modal state, asks for its floors to be looked at."""
    s, x = lane.buffer, lane.lane.blocks
    x[layout.NEXT_Q], x[layout.NEXT_DQ] = q, dq
    x[layout.PULL] = x[layout.SQUARE] * x[layout.NEXT_Q] + x[layout.DRAG] * x[layout.NEXT_DQ]
    s[layout.SEEN] = s[layout.QUIET] = 1.0
    observe(s, lane.shape)
    return bool(s[layout.RAISE] > 0.0)


@given(amplitudes, amplitudes, st.lists(st.tuples(amplitudes, amplitudes), max_size=5))
def test_what_is_passed_over_would_raise_nothing(
    q: list[float], dq: list[float], before: list[tuple[list[float], list[float]]]
) -> None:
    lane = OneLane(podium(4, 0.15, 0.5), ROLLING)
    x = lane.lane.blocks
    for state in before:
        if seen(lane, *state):
            raise_floors(lane.buffer, lane.shape)
    reached = x[[layout.STOREY_SHEAR, layout.FLOOR_ACCELERATION]].copy()
    asked = seen(lane, q, dq)
    raise_floors(lane.buffer, lane.shape)
    raised = x[[layout.STOREY_SHEAR, layout.FLOOR_ACCELERATION]]
    assert np.all(raised >= reached)
    assert asked or np.array_equal(raised, reached)


def test_small_motion_after_large_is_passed_over() -> None:
    """Otherwise the bound would be safe, and of no use."""
    lane = OneLane(podium(4, 0.15, 0.5), ROLLING)
    x = lane.lane.blocks
    # a jerk of the ground moves modes like this
    q = x[layout.PARTICIPATION] / x[layout.SQUARE]
    assert seen(lane, q.tolist(), [0.0] * 4)
    raise_floors(lane.buffer, lane.shape)
    assert not seen(lane, (0.2 * q).tolist(), [0.0] * 4)
    assert seen(lane, (2.0 * q).tolist(), [0.0] * 4)


@pytest.mark.parametrize("storeys", [1, 2, 5, 12])
def test_the_bounds_are_sums_over_modes(storeys: int) -> None:
    """For the sums that are in proportion to what bounds them, the bound is the value."""
    structure = podium(storeys)
    lane = OneLane(structure, ROLLING)
    x, rows = lane.lane.blocks, modal_rows(structure)
    shapes, shears = np.split(rows[contact_layout.SHAPES :], 2)
    for factors, weight, bound in (
        (shears, layout.STRAIN_WEIGHT, layout.STRAIN_BOUND),
        (shapes, layout.PULLED_WEIGHT, layout.PULLED_BOUND),
    ):
        assert np.all(x[weight] > 0.0)
        for i in range(storeys):
            worst = factors[:, i] / x[weight]
            value = float(factors[:, i] @ worst)
            assert value**2 * x[bound, i] == pytest.approx(x[weight] @ worst**2, rel=1e-12)


@needs_compiled_kernels
@pytest.mark.parametrize("damping", [RayleighDamping(0.05), ModalDamping(0.02)], ids=str)
@pytest.mark.parametrize(("storeys", "rho"), [(1, FLAT), (4, 0.5), (7, 1.5), (11, FLAT)])
def test_maxima_are_those_of_all_samples(
    storeys: int, rho: float, damping: RayleighDamping | ModalDamping
) -> None:
    structure = podium(storeys, 0.15, rho, superstructure=building(storeys, damping=damping))
    record = waves(10.0, 0.01, 2.5 * structure.uplift_acceleration, seed=3)
    result = time_history(structure, record, TimeHistorySettings(free_vibration=3.0))
    assert result.impacts > 10
    trace = result.trace
    shears = np.max(np.abs(trace.storey_shears), axis=0)
    accelerations = np.max(np.abs(trace.floor_accelerations), axis=0)
    # stored samples are displacements relative to the ground: u_b + v rounds v
    assert result.storey_shears == pytest.approx(shears, rel=1e-10)
    assert result.floor_accelerations == pytest.approx(accelerations, rel=1e-9)
