"""Storey shears and floor accelerations are left unformed only where none can be raised."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from paper_structures import FLAT, Array, building, needs_compiled_kernels, podium, waves

from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import denser_trace, time_history
from rpscli.model.superstructure import ModalDamping, RayleighDamping
from rpscli.physics.demands import raise_floors
from rpscli.physics.state import ROLLING

from .one_lane import OneLane

amplitudes = st.lists(st.integers(-1000, 1000).map(lambda k: 1e-3 * k), min_size=4, max_size=4)


def seen(lane: OneLane, q: list[float], dq: list[float]) -> bool:
    """Whether the lane, at a sample with this modal state, asks for its floors to be looked at."""
    s = lane.s
    lane.modes("new_q")[:], lane.modes("new_dq")[:] = q, dq
    springs, dampers = lane.modes("omega2") * q, lane.modes("two_xi_omega") * dq
    lane.modes("force")[:] = springs + dampers
    s.accepted[0] = 1.0
    lane.observe()
    return bool(s.demands_rise[0] > 0.0)


def raise_by_end(lane: OneLane) -> Array:
    """Demands of storeys and floors, raised by those at the end of the step."""
    raise_floors(lane.s, 0, [lane.system])
    return demands_of(lane)


def demands_of(lane: OneLane) -> Array:
    """Largest storey shears and floor accelerations so far."""
    s, n = lane.s, lane.storeys
    return np.array([s.largest[0, 0, :n], s.largest[1, 0, :n]])


@given(amplitudes, amplitudes, st.lists(st.tuples(amplitudes, amplitudes), max_size=5))
def test_what_is_passed_over_would_raise_nothing(
    q: list[float], dq: list[float], before: list[tuple[list[float], list[float]]]
) -> None:
    lane = OneLane(podium(4, 0.15, 0.5), ROLLING)
    for state in before:
        if seen(lane, *state):
            raise_by_end(lane)
    reached = demands_of(lane)
    asked = seen(lane, q, dq)
    raised = raise_by_end(lane)
    assert np.all(raised >= reached)
    assert asked or np.array_equal(raised, reached)


def test_small_motion_after_large_is_passed_over() -> None:
    """Otherwise the bound would be safe, and of no use."""
    lane = OneLane(podium(4, 0.15, 0.5), ROLLING)
    # a jerk of the ground moves modes like this
    q = lane.modes("Gamma") / lane.modes("omega2")
    assert seen(lane, q.tolist(), [0.0] * 4)
    raise_by_end(lane)
    # what is bounded is the change since the last look, and there was none at a small motion
    assert seen(lane, (0.2 * q).tolist(), [0.0] * 4)
    raise_by_end(lane)
    assert not seen(lane, (0.1 * q).tolist(), [0.0] * 4)
    assert seen(lane, (2.0 * q).tolist(), [0.0] * 4)


@pytest.mark.parametrize("storeys", [1, 2, 5, 12])
def test_the_bounds_are_sums_over_modes(storeys: int) -> None:
    """For the sums that are in proportion to what bounds them, the bound is the value."""
    lane = OneLane(podium(storeys), ROLLING)
    n, system = storeys, lane.system
    for factors, weight, bound in (
        (system.storey_shear_of, lane.modes("shear_weight"), system.shear_bound_of),
        (system.phi, lane.modes("acceleration_weight"), system.acceleration_bound_of),
    ):
        assert np.all(weight > 0.0)
        for i in range(n):
            worst = factors[:n, i] / weight
            value = float(factors[:n, i] @ worst)
            assert (value * bound[i]) ** 2 == pytest.approx(weight @ worst**2, rel=1e-12)


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
