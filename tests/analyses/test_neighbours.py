"""Histories beside one: each is what a case with that motion or law gives by itself."""

from dataclasses import replace

import numpy as np
import pytest
from paper_structures import block, known, needs_compiled_kernels, podium, waves

from rpscli.analyses import neighbours as module
from rpscli.analyses.neighbours import (
    FACTORS,
    NEAR,
    nearest,
    neighbours,
    with_half_the_step,
)
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.case.conditions import LIMITS, Condition
from rpscli.model.impact import ImpactLaw
from rpscli.report.limits import doubt_texts
from rpscli.report.neighbours import neighbours_texts, step_text
from rpscli.report.timehistory import restitution_text
from rpscli.sweep.statistics.beside import beside_verdicts
from rpscli.sweep.statistics.summary import Records, step_changes
from rpscli.sweep.statistics.verdicts import judged_records

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


def test_results_that_need_samples_are_those_of_histories_with_samples(result):
    """As a limit on the roof asks for them; the others do not move by it."""
    found = neighbours(result, ["max_roof_displacement"])
    short = neighbours(result, ["rotation_ratio"])
    assert [each.change for each in found] == [each.change for each in short]
    near = [each for each in found if "max_roof_displacement" in each.demands]
    assert [each.factor for each in near] == [*NEAR]
    for each in near:
        alone = time_history(podium(3), RECORD.scaled(each.factor), SHORT)
        assert each.demands["max_roof_displacement"] == alone.max_roof_displacement
    assert [each.rotation_ratio for each in found] == [
        each.rotation_ratio for each in short
    ]
    finer = known(with_half_the_step(result, ["max_roof_displacement"]))
    assert finer.demands["max_roof_displacement"] == pytest.approx(
        result.max_roof_displacement, rel=1e-2
    )


def test_half_the_step_is_twice_the_accuracy(result):
    finer = known(with_half_the_step(result))
    alone = time_history(podium(3), RECORD, replace(SHORT, accuracy=2.0))
    assert (finer.step, finer.change) == (0.5, "steps of half the length")
    assert finer.rotation_ratio == alone.rotation_ratio
    assert finer.max_base_shear == alone.max_base_shear
    same = finer._replace(
        max_base_shear=result.max_base_shear,
        demands={name: getattr(result, name) for name in finer.demands},
    )
    assert step_text(result, same, {}) == ""
    lift = {"max_lift": 2.0 * result.max_lift}
    moved = same._replace(demands={**same.demands, **lift})
    assert step_text(result, moved, {}) == ""
    text = step_text(result, moved, {"max_lift": 0.03})
    assert text.startswith("steps: steps of half the length change lift of the building")
    assert "by 0.5 of it" in text
    fallen = same._replace(outcome="overturned_rolling")
    assert "survived or overturned rolling" in step_text(result, fallen, {})


def test_what_is_small_beside_its_limit_is_no_change():
    before = {"residual_drift": 1e-9, "max_rotation": 0.1}
    after = {"residual_drift": 2e-9, "max_rotation": 0.1}
    assert step_changes(before, after, {"residual_drift": 1e-3}) == {}
    assert step_changes(before, after, {"residual_drift": 1e-6}) == {
        "residual_drift": 0.5
    }


def test_a_verdict_is_reversed_by_the_motion_that_crosses_its_limit(result):
    """A limit between the value and that with one percent more or less motion."""
    near = nearest(result)
    value = result.rotation_ratio
    (other,) = [each for each in near if each.factor == 1.01]
    assert other.rotation_ratio != value
    limit = Condition("rotation_ratio", 0.5 * (value + other.rotation_ratio), "")
    wide = Condition("rotation_ratio", 2.0 * max(value, other.rotation_ratio), "")
    conditions = [limit, wide]
    values = dict.fromkeys(LIMITS, np.nan) | {"rotation_ratio": value}
    alone = judged_records(
        Records.of([result.outcome], [values], ["a"]), ["a"], conditions
    )
    found, sure = beside_verdicts(alone, [near], ["a"], ["a"], conditions)
    crossed = [
        each.change
        for each in near
        if (each.rotation_ratio > limit.limit) != (value > limit.limit)
    ]
    ends = sorted(each.rotation_ratio for each in near)
    assert "1.01 times the motion" in found.reversed_by
    assert list(found.reversed_by) == crossed
    assert found.near == (ends[0], ends[1])
    assert found.word.endswith(", in doubt")
    assert (sure.reversed_by, sure.word) == ((), "met")
    assert found.exceeded == alone[0].exceeded  # it stays what it is
    text, values_text = doubt_texts([found, sure])
    assert "1.01 times the motion" in text
    assert values_text.startswith("with 1 % less or more motion rotation_ratio ")
    assert beside_verdicts(alone, [[]], ["a"], ["a"], conditions) == alone


def test_what_was_not_followed_beside_is_not_judged(result):
    """A limit on the roof, with neighbours that have no samples."""
    conditions = [Condition("max_roof_displacement", 1e-9, "")]
    values = dict.fromkeys(LIMITS, np.nan)
    values["max_roof_displacement"] = result.max_roof_displacement
    alone = judged_records(
        Records.of([result.outcome], [values], ["a"]), ["a"], conditions
    )
    found = beside_verdicts(alone, [nearest(result)], ["a"], ["a"], conditions)
    assert found == alone
    followed = neighbours(result, ["max_roof_displacement"])
    (sure,) = beside_verdicts(alone, [followed], ["a"], ["a"], conditions)
    assert sure.reversed_by == ()
    assert known(sure.near)[0] > 0.0
