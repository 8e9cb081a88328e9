"""Histories beside one: each is what a case with that motion or law gives by itself."""

from dataclasses import replace

import pytest
from paper_structures import block, known, needs_compiled_kernels, podium, waves

from rpscli.analyses import timehistory as module
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import FACTORS, neighbours, time_history
from rpscli.model.impact import ImpactLaw
from rpscli.report.timehistory import neighbours_texts, restitution_text

pytestmark = needs_compiled_kernels

RECORD = waves(4.0, 0.02, 6.0, seed=21)
SHORT = TimeHistorySettings(free_vibration=1.0)


@pytest.fixture(scope="module")
def result():
    return time_history(podium(3), RECORD, SHORT)


def test_they_are_histories_of_motions_that_were_scaled_before(result):
    *motions, law = neighbours(result)
    assert [each.factor for each in motions] == list(FACTORS)
    for each in motions:
        alone = time_history(podium(3), RECORD.scaled(each.factor), SHORT)
        # The same but for the order of two multiplications; impacts let that grow.
        assert each.rotation_ratio == pytest.approx(alone.rotation_ratio, rel=1e-6)
        assert each.max_base_shear == pytest.approx(alone.max_base_shear, rel=1e-6)
    half = replace(podium(3), impact_law=replace(podium(3).impact_law, loss=0.5))
    assert 1.0 - law.restitution == pytest.approx(
        0.5 * (1.0 - podium(3).restitution), rel=1e-12
    )
    assert law.rotation_ratio == time_history(half, RECORD, SHORT).rotation_ratio


def test_the_text_says_how_far_a_percent_moves_it(result):
    found = neighbours(result)
    one, other = neighbours_texts(result, found)
    near = sorted(each.rotation_ratio for each in found if each.factor in {0.99, 1.01})
    assert f"1 % less or more motion {near[0]:.4f} to {near[1]:.4f} theta_cr" in one
    assert "instead of" in other


def test_motions_that_overturn_are_counted():
    """Between two strengths, the weaker of which stands, and from which on it overturns."""
    rock, low, high = block(0.3, 0.4), 0.5, 8.0
    for _ in range(12):
        middle = 0.5 * (low + high)
        outcome = time_history(rock, RECORD.scaled(middle), SHORT).outcome
        low, high = (low, middle) if outcome.startswith("overturned") else (middle, high)
    result = time_history(rock, RECORD.scaled(low), SHORT)
    found = neighbours(result)
    fallen = sum(
        each.outcome.startswith("overturned") for each in found if each.factor != 1.0
    )
    assert 0 < fallen < len(FACTORS)
    assert f"it overturns in {fallen} of {len(FACTORS)}" in next(
        neighbours_texts(result, found)
    )


def test_a_measured_restitution_has_no_other_law():
    measured = replace(podium(2), impact_law=ImpactLaw("value", restitution=0.9))
    result = time_history(measured, RECORD, SHORT)
    assert [each.factor for each in neighbours(result)] == list(FACTORS)
    assert restitution_text(measured).endswith("e2 = 0.8100")


def test_long_histories_say_that_nothing_was_looked_at(result, monkeypatch):
    monkeypatch.setattr(module, "MOST_STEPS_BESIDE", 10)
    assert neighbours(result) == []
    (text,) = neighbours_texts(result, [])
    assert "steps are too many" in text


def test_floors_are_held_against_those_of_the_fixed_base(result):
    """A stiff building in full contact has the same accelerations; on bearings others."""
    still = time_history(podium(2), RECORD.scaled(1e-3), SHORT)
    assert still.outcome == "at_rest"
    assert still.floor_acceleration_over_fixed == pytest.approx(1.0, rel=1e-5)
    fixed = known(result.fixed_base)
    expected = max(result.floor_accelerations) / max(fixed.floor_accelerations)
    assert result.floor_acceleration_over_fixed == expected
    assert result.fixed_base_ratio == result.max_base_shear / fixed.base_shear < 1.0
    alone = time_history(block(0.3, 0.4), RECORD, SHORT)
    assert alone.floor_acceleration_over_fixed is alone.fixed_base_ratio is None
