"""What a single history finds in its samples: velocities, roof, forces of a column; by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from paper_structures import block, building, ground, podium, stillness, waves

from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.superstructure import Superstructure

AT_ONCE = TimeHistorySettings(free_vibration=0.0)


def test_a_stiff_building_in_full_contact_moves_with_the_ground() -> None:
    """1 m/s2 for 0.5 s after a rise of 0.1 s: 0.05 + 0.5 = 0.55 m/s, kept to the end."""
    above = building(2)
    stiff = Superstructure(above.masses, 1e4 * above.stiffnesses, above.damping)
    push = ground([0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0], 0.1)
    result = time_history(podium(2, superstructure=stiff), push, AT_ONCE)
    assert result.outcome == "at_rest"
    # and 0.05 m/s as it falls again
    assert result.floor_velocities == pytest.approx([0.6, 0.6], rel=1e-3)
    assert result.fixed_base is not None
    assert result.fixed_base.floor_velocities == pytest.approx(result.floor_velocities, rel=1e-9)
    assert result.max_floor_velocity == max(result.floor_velocities)
    assert result.fixed_base_ratio == pytest.approx(1.0, rel=1e-5)


def test_columns_at_rest_carry_the_weight_and_the_mass_times_acceleration() -> None:
    """Cap beam 200 t on 4 columns of 5 t: N = 490.3 and 539.4 kN; 1 m/s2 on them, 50 and 55 kN."""
    frame = replace(podium(0, 0.15, 0.5), columns=4)
    result = time_history(frame, ground([0.0, 1.0, 0.0], 0.1), AT_ONCE)
    top, bottom = result.column_forces["top"], result.column_forces["bottom"]
    assert (top.shear, bottom.shear) == pytest.approx((50e3, 55e3), rel=1e-12)
    assert top.largest_normal == top.least_normal == pytest.approx(50e3 * 9.80665, rel=1e-12)
    assert bottom.largest_normal == pytest.approx(55e3 * 9.80665, rel=1e-12)
    assert (result.max_column_shear, result.max_column_force) == (55e3, bottom.largest_normal)
    assert result.min_column_force == top.least_normal
    assert (result.max_roof_displacement, result.max_floor_velocity) == (None, None)


def test_a_released_roof_starts_above_its_cap_beam() -> None:
    """Unstrained, it is as far from its place as the cap beam."""
    structure = podium(2, 0.15, 0.5)
    start = TimeHistorySettings(free_vibration=0.0, initial_rotation=0.05)
    result = time_history(structure, stillness(0.01), start)
    _, u, _ = structure.path(np.array([0.05]))
    assert result.max_roof_displacement == pytest.approx(u[0], rel=1e-12)


def test_the_ratio_to_the_fixed_base_is_a_reduction() -> None:
    result = time_history(podium(3), waves(4.0, 0.02, 6.0, seed=21))
    assert result.fixed_base is not None
    assert result.fixed_base_ratio == result.max_base_shear / result.fixed_base.base_shear < 1.0
    assert time_history(block(0.3, 0.4), stillness(0.02)).fixed_base_ratio is None
