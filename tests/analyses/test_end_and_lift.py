"""The state at the end of a history, and how far the building was lifted."""

from __future__ import annotations

import math

import pytest
from paper_structures import block, ground, podium, stillness, waves

from rpscli.analyses.demand import demand
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history

BLOCK = block(0.3, 0.4)
"""R = 0.5 m, cos(a) = 0.8, theta_cr = a = 0.6435 rad."""


def test_a_building_that_stands_again_has_no_residual() -> None:
    result = time_history(podium(2), waves(3.0, 0.02, 4.0, seed=21), TimeHistorySettings())
    assert (result.outcome, result.trace.phase[-1]) == ("survived", 0)
    assert (result.residual_rotation, result.residual_displacement) == (0.0, 0.0)


def test_a_storey_that_still_moves_has_the_rotation_of_its_last_sample() -> None:
    settings = TimeHistorySettings(initial_rotation=-0.3, free_vibration=0.1)
    result = time_history(BLOCK, stillness(0.02), settings)
    assert result.trace.rotation[-1] < 0.0
    assert result.residual_rotation == -result.trace.rotation[-1]
    # flat ends: u_b = 2 R (sin a - sin(a - x)), with sin a = 0.6
    by_hand = 0.6 - math.sin(math.atan2(0.3, 0.4) - result.residual_rotation)
    assert result.residual_displacement == pytest.approx(by_hand, rel=1e-12)
    assert demand(BLOCK, stillness(0.02), settings).residual_rotation == result.residual_rotation


def test_the_lift_is_that_of_the_largest_rotation() -> None:
    """v_b = 2 R (cos(a - x) - cos a); released at half of theta_cr: 0.94868 - 0.8."""
    start = 0.5 * BLOCK.critical_rotation
    result = time_history(BLOCK, stillness(0.02), TimeHistorySettings(initial_rotation=start))
    assert result.max_lift == pytest.approx(0.148683, abs=1e-6)


def test_nothing_is_lifted_higher_than_at_the_critical_rotation() -> None:
    """Overturning, v_b falls again beyond theta_cr, where it was 2 R (1 - cos a) = 0.2 m."""
    push = ground([0.0, -20.0, -20.0, -20.0, 0.0], 0.2)
    result = time_history(BLOCK, push, TimeHistorySettings())
    assert result.overturned
    assert result.max_lift == pytest.approx(0.2, rel=1e-12)


def test_the_largest_floor_acceleration_needs_a_floor() -> None:
    motion = waves(1.0, 0.02, 4.0, seed=21)
    result = demand(podium(2), motion)
    assert result.max_floor_acceleration == max(result.floor_accelerations)
    assert demand(BLOCK, motion).max_floor_acceleration is None
