"""How near to overturning and to sliding a history came: said in its warnings."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from paper_structures import block, ground, podium, stillness, waves

from rpscli.analyses.demand import demand
from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history


def released(share: float) -> TimeHistoryResult:
    """A frame released from rest at a share of its critical rotation."""
    structure = podium(0, 0.15, 0.5)
    start = TimeHistorySettings(initial_rotation=share * structure.critical_rotation)
    return time_history(structure, stillness(0.02), start)


@pytest.mark.parametrize(("share", "near"), [(0.79, False), (0.81, True)])
def test_rotations_near_the_critical_one_are_told(share: float, near: bool) -> None:
    result = released(share)
    assert result.outcome == "survived"
    assert result.is_near_critical is near
    assert any(f"{share:g} of the critical one" in text for text in result.warnings) is near


def test_a_passage_of_the_critical_rotation_is_told_with_its_time() -> None:
    result = released(0.9)
    limit = result.critical_rotation
    passed = result.history.copy()
    passed.max_theta, passed.critical_time = 1.019 * limit, 4.25
    (warning,) = (w for w in replace(result, history=passed).warnings if "critical" in w)
    assert "passed at t = 4.25 s (largest 1.02 theta_cr)" in warning


def test_an_overturned_structure_needs_no_warning_that_it_was_near() -> None:
    push = ground([0.0, -20.0, -20.0, -20.0, 0.0], 0.2)
    result = time_history(block(0.3, 0.4), push, TimeHistorySettings())
    assert result.overturned
    assert not [warning for warning in result.warnings if "critical" in warning]


@pytest.mark.parametrize(("coefficient", "slides"), [(0.10, True), (0.20, False)])
def test_a_block_in_full_contact_slides_when_the_ground_outruns_its_friction(
    coefficient: float, slides: bool
) -> None:
    """|F|/N = a_g/g: rising by 0.03 g a sample it passes 0.10 at the fourth, 0.4 s."""
    standing = replace(block(0.15, 1.0 / 1.5), friction=coefficient)  # tan(alpha) = 0.225
    rise = 0.03 * 9.80665 * np.array([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 0.0])
    result = time_history(standing, ground(rise, 0.1), TimeHistorySettings())
    assert result.outcome == "at_rest"
    assert result.friction_ratio == pytest.approx(0.15 / coefficient, rel=1e-12)
    assert result.slides is slides
    assert result.sliding_time == (pytest.approx(0.4) if slides else None)
    assert demand(standing, ground(rise, 0.1)).friction_ratio == result.friction_ratio
    told = [warning for warning in result.warnings if "slide from t = 0.4 s" in warning]
    assert len(told) == slides


def test_without_a_coefficient_nothing_is_said_of_sliding() -> None:
    result = time_history(podium(2), waves(1.0, 0.02, 4.0, seed=21), TimeHistorySettings())
    assert (result.friction_ratio, result.slides, result.sliding_time) == (None, None, None)
