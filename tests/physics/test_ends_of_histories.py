"""How a history ends other than by time: overturning, and failures that say what happened."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from paper_structures import FLAT, ground, needs_compiled_kernels, podium, stillness, waves

from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.impact import ImpactLaw

DT = 0.01
QUIET = TimeHistorySettings(free_vibration=0.0)


@needs_compiled_kernels
def test_passing_the_critical_rotation_and_coming_back() -> None:
    """The ground that tilts the storey beyond theta_cr also fetches it back."""
    structure = podium(0, 0.15, FLAT)
    g = structure.uplift_acceleration
    record = ground(np.concatenate((np.full(51, -3.0 * g), np.full(100, 3.0 * g))), DT)
    result = time_history(structure, record, QUIET)
    critical = structure.critical_rotation
    assert result.outcome == "survived"
    assert critical < result.max_rotation < 2.0 * critical
    passage = next(e for e in result.events if e.kind == "critical_rotation_passed")
    assert result.critical_passage_time == passage.time
    assert passage.rotation == critical
    assert abs(result.trace.rotation[-1]) < critical
    # with a limit below the turning point the same motion counts as overturned
    tight = replace(QUIET, overturning_limit=0.999 * result.max_rotation / critical)
    fallen = time_history(structure, record, tight)
    assert fallen.outcome == "overturned_rocking"
    assert fallen.max_rotation == pytest.approx(tight.overturning_limit * critical, rel=1e-14)
    assert fallen.duration < result.duration


@pytest.mark.parametrize(
    ("rho", "outcome"),
    [(FLAT, "overturned_rocking"), (0.25, "overturned_rolling"), (0.5, "overturned_rocking")],
)
def test_overturning_is_named_after_the_phase_at_theta_cr(rho: float, outcome: str) -> None:
    structure = podium(0, 0.15, rho)
    assert structure.bearing.overturns_rolling is (outcome == "overturned_rolling")
    settings = TimeHistorySettings(
        free_vibration=8.0, initial_rotation=1.01 * structure.critical_rotation
    )
    result = time_history(structure, stillness(0.02), settings)
    assert result.outcome == outcome
    assert result.overturned
    assert result.events[-1].kind == "overturning"
    assert result.events[-1].rotation == 2.0 * structure.critical_rotation
    assert result.duration == result.events[-1].time


def test_max_events_ends_a_history_with_time_phase_and_rotation() -> None:
    structure = podium(2, 0.15, 0.5)
    settings = TimeHistorySettings(max_events=3)
    result = time_history(structure, waves(3.0, 0.02, 5.0, seed=1), settings)
    assert result.outcome == "failed"
    assert len(result.events) == 4
    assert result.failure is not None
    assert f"t = {result.duration:.6g} s, rolling, theta = " in result.failure
    assert "analysis.max_events" in result.failure
    assert "raise" in result.failure


@needs_compiled_kernels  # interpreted, the cosine of infinity raises
def test_an_absurd_record_is_a_failure_not_a_number() -> None:
    structure = podium(2, 0.15, 0.5)
    with np.errstate(all="ignore"):
        result = time_history(structure, waves(1.0, 0.02, 1e200, seed=1))
    assert result.outcome == "failed"
    assert result.failure is not None
    assert "no longer finite" in result.failure
    assert "rolling, theta = " in result.failure


def test_a_record_that_overflows_in_full_contact_is_a_failure() -> None:
    record = ground(1.7e308 * np.array([0.0, 0.0, 1.0, -1.0, 0.0]), 0.01)
    with np.errstate(all="ignore"):
        result = time_history(podium(2, 0.15, 0.5), record)
    assert result.outcome == "failed"
    assert result.failure is not None
    assert "full contact" in result.failure
    assert "no longer finite" in result.failure
    assert result.duration <= 0.02  # where the record first overflows the push


@pytest.mark.parametrize("storeys", [0, 2])
def test_without_a_recontact_tolerance_impacts_never_end(storeys: int) -> None:
    """Infinitely many impacts in a finite time: the history stops, and says what to raise."""
    settings = TimeHistorySettings(
        free_vibration=20.0, initial_rotation=1e-4, recontact_tolerance=0.0, max_events=500
    )
    result = time_history(podium(storeys, 0.15, FLAT), stillness(0.05), settings)
    assert result.outcome == "failed"
    assert result.impacts == 501
    assert result.failure is not None
    assert "analysis.recontact_tolerance" in result.failure


def test_impacts_without_time_between_them_end_a_history() -> None:
    """Excursions shrink until their time is lost in the rounding of the clock."""
    settings = TimeHistorySettings(
        free_vibration=1.0, initial_rotation=1e-4, recontact_tolerance=0.0
    )
    structure = podium(0, 0.15, FLAT, law=ImpactLaw("value", 0.1))
    result = time_history(structure, stillness(0.05), settings)
    assert result.outcome == "failed"
    assert result.failure is not None
    assert "without time passing" in result.failure
    assert "raise analysis.recontact_tolerance" in result.failure
    # each excursion is a tenth as long as the last: some sixteen, and a hundred without any time
    assert 100 < result.impacts < 125


def test_a_limit_that_is_reached_while_still_rolling() -> None:
    structure = podium(0, 0.15, 0.5)
    settings = TimeHistorySettings(overturning_limit=0.2)
    limit = 0.2 * structure.critical_rotation
    assert limit < structure.bearing.beta
    push = ground(np.full(200, -2.0 * structure.uplift_acceleration), DT)
    result = time_history(structure, push, settings)
    assert result.overturned
    assert result.events[-1].kind == "overturning"
    assert result.max_rotation == result.events[-1].rotation == limit
    assert result.critical_passage_time is None
