"""Numbers of single histories by hand: samples, the end, nearness to overturning and sliding."""

import math
from dataclasses import replace

import numpy as np
import pytest
from paper_structures import (
    block,
    building,
    ground,
    known,
    let_go,
    podium,
    stillness,
    waves,
)

from rpscli.analyses.demand import demand
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.superstructure import Superstructure

AT_ONCE = TimeHistorySettings(free_vibration=0.0)


def test_a_stiff_building_in_full_contact_moves_with_the_ground():
    """1 m/s2 for 0.5 s after a rise of 0.1 s: 0.05 + 0.5 = 0.55 m/s, kept to the end."""
    above = building(2)
    stiff = Superstructure(above.masses, 1e4 * above.stiffnesses, above.damping)
    push = ground([0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0], 0.1)
    result = time_history(podium(2, superstructure=stiff), push, AT_ONCE)
    assert result.outcome == "at_rest"
    # and 0.05 m/s as it falls again
    assert result.floor_velocities == pytest.approx([0.6, 0.6], rel=1e-3)
    fixed = known(result.fixed_base)
    assert fixed.floor_velocities == pytest.approx(result.floor_velocities, rel=1e-9)
    assert result.max_floor_velocity == max(result.floor_velocities)
    assert result.fixed_base_ratio == pytest.approx(1.0, rel=1e-5)


def test_columns_at_rest_carry_the_weight_and_the_mass_times_acceleration():
    """Cap beam 200 t on 4 columns of 5 t: N = 490.3 and 539.4 kN; 1 m/s2 on them, 50 and 55 kN."""
    frame = replace(podium(0, 0.15, 0.5), columns=4)
    result = time_history(frame, ground([0.0, 1.0, 0.0], 0.1), AT_ONCE)
    top, bottom = result.column_forces["top"], result.column_forces["bottom"]
    assert (top.shear, bottom.shear) == pytest.approx((50e3, 55e3), rel=1e-12)
    assert (
        top.largest_normal == top.least_normal == pytest.approx(50e3 * 9.80665, rel=1e-12)
    )
    assert bottom.largest_normal == pytest.approx(55e3 * 9.80665, rel=1e-12)
    assert (result.max_column_shear, result.max_column_force) == (
        55e3,
        bottom.largest_normal,
    )
    assert result.min_column_force == top.least_normal
    assert (result.max_roof_displacement, result.max_floor_velocity) == (None, None)


def test_a_released_roof_starts_above_its_cap_beam():
    """Unstrained, it is as far from its place as the cap beam."""
    structure = podium(2, 0.15, 0.5)
    _, u, _ = structure.path(np.array([0.05]))
    assert let_go(structure, 0.05, 0.0).max_roof_displacement == pytest.approx(
        u[0], rel=1e-12
    )


BLOCK = block(0.3, 0.4)
"""R = 0.5 m, cos(a) = 0.8, theta_cr = a = 0.6435 rad."""


def test_a_building_that_stands_again_has_no_residual():
    """Without a coefficient nothing is said of sliding."""
    result = time_history(podium(2), waves(3.0, 0.02, 4.0, seed=21))
    assert (result.outcome, result.trace.phase[-1]) == ("survived", 0)
    assert (result.residual_rotation, result.residual_displacement) == (0.0, 0.0)
    assert (result.friction_ratio, result.slides, result.sliding_time) == (
        None,
        None,
        None,
    )
    assert result.max_floor_acceleration == max(result.floor_accelerations)


def test_a_storey_that_still_moves_has_the_rotation_of_its_last_sample():
    settings = TimeHistorySettings(initial_rotation=-0.3, free_vibration=0.1)
    result = time_history(BLOCK, stillness(0.02), settings)
    assert result.trace.rotation[-1] < 0.0
    assert result.residual_rotation == -result.trace.rotation[-1]
    # flat ends: u_b = 2 R (sin a - sin(a - x)), with sin a = 0.6
    by_hand = 0.6 - math.sin(math.atan2(0.3, 0.4) - result.residual_rotation)
    assert result.residual_displacement == pytest.approx(by_hand, rel=1e-12)
    assert (
        demand(BLOCK, stillness(0.02), settings).residual_rotation
        == result.residual_rotation
    )
    assert result.max_floor_acceleration is None


def test_the_lift_is_that_of_the_largest_rotation():
    """v_b = 2 R (cos(a - x) - cos a); released at half of theta_cr: 0.94868 - 0.8."""
    start = 0.5 * BLOCK.critical_rotation
    result = time_history(
        BLOCK, stillness(0.02), TimeHistorySettings(initial_rotation=start)
    )
    assert result.max_lift == pytest.approx(0.148683, abs=1e-6)


def test_nothing_is_lifted_higher_than_at_the_critical_rotation():
    """Overturning, v_b falls again beyond theta_cr, where it was 2 R (1 - cos a) = 0.2 m."""
    push = ground([0.0, -20.0, -20.0, -20.0, 0.0], 0.2)
    result = time_history(BLOCK, push)
    assert result.overturned
    assert result.max_lift == pytest.approx(0.2, rel=1e-12)
    assert not [warning for warning in result.warnings if "critical" in warning]


def released(share):
    """A frame released from rest at a share of its critical rotation."""
    structure = podium(0, 0.15, 0.5)
    start = TimeHistorySettings(initial_rotation=share * structure.critical_rotation)
    return time_history(structure, stillness(0.02), start)


@pytest.mark.parametrize(("share", "near"), [(0.79, False), (0.81, True)])
def test_rotations_near_the_critical_one_are_told(share, near):
    result = released(share)
    assert result.outcome == "survived"
    assert result.is_near_critical is near
    assert (
        any(f"{share:g} of the critical one" in text for text in result.warnings) is near
    )


def test_a_passage_of_the_critical_rotation_is_told_with_its_time():
    result = released(0.9)
    limit = result.critical_rotation
    passed = result.history.copy()
    passed.max_theta, passed.critical_time = 1.019 * limit, 4.25
    (warning,) = (w for w in replace(result, history=passed).warnings if "critical" in w)
    assert "passed at t = 4.25 s (largest 1.02 theta_cr)" in warning


@pytest.mark.parametrize(("coefficient", "slides"), [(0.10, True), (0.20, False)])
def test_a_block_in_full_contact_slides_when_the_ground_outruns_its_friction(
    coefficient, slides
):
    """|F|/N = a_g/g: rising by 0.03 g a sample it passes 0.10 at the fourth, 0.4 s."""
    standing = replace(block(0.15, 1.0 / 1.5), friction=coefficient)  # tan(alpha) = 0.225
    rise = 0.03 * 9.80665 * np.array([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 0.0])
    result = time_history(standing, ground(rise, 0.1))
    assert result.outcome == "at_rest"
    assert result.friction_ratio == pytest.approx(0.15 / coefficient, rel=1e-12)
    assert result.slides is slides
    assert result.sliding_time == (pytest.approx(0.4) if slides else None)
    assert demand(standing, ground(rise, 0.1)).friction_ratio == result.friction_ratio
    told = [warning for warning in result.warnings if "slide from t = 0.4 s" in warning]
    assert len(told) == slides
