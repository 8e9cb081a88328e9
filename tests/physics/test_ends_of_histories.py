"""When a storey passes theta_cr, and how histories end other than by time.

The passage is located within the step, turning points included; failures say what happened.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from paper_structures import FLAT, ground, needs_compiled_kernels, podium, stillness, waves
from scipy.integrate import quad

from rpscli.analyses.demand import demand
from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.analyses.trace import Event
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import PodiumStructure

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


def passage_of(result: TimeHistoryResult) -> Event:
    """The only one, which the scalar result repeats."""
    (event,) = (e for e in result.events if e.kind == "critical_rotation_passed")
    assert result.critical_passage_time == event.time
    assert abs(event.rotation) == result.structure.critical_rotation
    assert event.rotation_rate_before == event.rotation_rate_after
    return event


@pytest.mark.evidence("steps, events, energy", "exact")
@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("factor", [1.5, 4.0])
def test_a_frame_under_a_constant_push_passes_when_the_integral_of_energy_says(
    factor: float, sign: float
) -> None:
    """x'^2 = 4 w^2 sin(x/2) [f tan(a) cos(a - x/2) - sin(a - x/2)]: no small angle is assumed."""
    structure, dt = podium(0, 0.3, FLAT), 0.0317
    alpha, gamma = structure.bearing.alpha, structure.gamma
    w2 = structure.gravity / 1.5 * (1.0 + 2.0 * gamma) / (4.0 / 3.0 + 4.0 * gamma)

    def over_sine(x: float) -> float:
        """x'^2/sin(x/2)."""
        push = factor * math.tan(alpha) * math.cos(alpha - 0.5 * x)
        return 4.0 * w2 * (push - math.sin(alpha - 0.5 * x))

    def rise(s: float) -> float:
        """dt/ds with x = s^2, which takes the singularity at rest away."""
        half = 0.5 * s**2
        share = math.sin(half) / half if s > 0.0 else 1.0
        return 2.0 / math.sqrt(0.5 * share * over_sine(2.0 * half))

    expected, _ = quad(rise, 0.0, math.sqrt(alpha), epsabs=1e-14, epsrel=1e-13)
    push = np.full(200, -sign * factor * structure.uplift_acceleration)
    settings = TimeHistorySettings(free_vibration=0.0, accuracy=8.0)
    event = passage_of(time_history(structure, ground(push, dt), settings))
    # steps of p h < 0.03 by a quintic: (p h)^6/720
    assert event.time == pytest.approx(expected, rel=1e-10)
    speed = math.sqrt(math.sin(0.5 * alpha) * over_sine(alpha))
    assert event.rotation_rate_before == pytest.approx(sign * speed, rel=1e-9)
    assert event.rotation == sign * alpha


@pytest.mark.evidence("steps, events, energy", "exact")
@needs_compiled_kernels
@pytest.mark.parametrize(("storeys", "rho"), [(1, FLAT), (3, 0.25), (3, 0.5), (3, 1.5)])
def test_the_passage_does_not_depend_on_the_samples(storeys: int, rho: float) -> None:
    """Before the overturning limit or on the way back: the same instant for every sampling."""
    structure = podium(storeys, 0.12, rho)
    settings = TimeHistorySettings(free_vibration=2.0, accuracy=4.0)
    coarse = np.array([0.0, 1.0, 1.0, 0.2]) * -2.5 * structure.uplift_acceleration
    times = []
    for parts in (2, 20, 75):
        dt = 0.6 / parts
        fine = np.interp(np.arange(3 * parts + 1) / parts, np.arange(4), coarse)
        result = time_history(structure, ground(fine, dt), settings)
        event = passage_of(result)
        times.append(event.time)
        before = int(event.time / dt)
        x = np.abs(result.trace.rotation)
        assert np.all(x[: before + 1] <= structure.critical_rotation)
        assert x[before + 1] > structure.critical_rotation
    # order 6 while uplifted, w h = 1/8: what differs is the steps' own error
    assert times == pytest.approx([times[-1]] * 3, rel=1e-8)


@pytest.mark.evidence("steps, events, energy", "exact")
@needs_compiled_kernels
def test_a_crest_between_samples_that_just_passes_is_seen() -> None:
    """Both samples beside it stay below theta_cr."""
    structure = podium(0, 0.15, 0.5)
    g = structure.uplift_acceleration
    shape = np.concatenate((np.full(6, -g), np.full(6, g)))

    def pushed(factor: float) -> TimeHistoryResult:
        return time_history(structure, ground(factor * shape, 0.1), QUIET)

    low, high = 3.0, 4.0
    while high - low > 1e-12:
        middle = 0.5 * (low + high)
        passed = pushed(middle).critical_passage_time is not None
        low, high = (low, middle) if passed else (middle, high)
    missed, seen = pushed(low), pushed(high)
    critical = structure.critical_rotation
    assert missed.max_rotation <= critical < seen.max_rotation
    assert seen.max_rotation == pytest.approx(critical, rel=1e-11)
    assert np.max(np.abs(seen.trace.rotation)) < critical * (1.0 - 1e-6)
    event = passage_of(seen)
    # near the crest the height is quadratic in time: the root of 1e-11 and some
    assert event.time == pytest.approx(seen.history.max_theta_time, abs=1e-5)
    assert abs(event.rotation_rate_before) < 1e-4


@pytest.mark.evidence("steps, events, energy", "exact")
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_release_from_beyond_theta_cr_has_passed_it_at_once(sign: float) -> None:
    structure = podium(1, 0.15, FLAT)
    rotation = sign * 1.2 * structure.critical_rotation
    settings = TimeHistorySettings(free_vibration=5.0, initial_rotation=rotation)
    result = time_history(structure, ground(np.zeros(2), 0.02), settings)
    assert result.outcome == "overturned_rocking"
    assert passage_of(result).time == 0.0


@pytest.mark.evidence("steps, events, energy", "exact")
@pytest.mark.parametrize("limit", [2.0, 0.5])
@pytest.mark.parametrize("share", [1.0, -1.0, 1.5, -7.0])
def test_a_release_from_beyond_the_overturning_limit_is_refused(limit: float, share: float) -> None:
    """It would have overturned before it began."""
    structure: PodiumStructure = podium(1, 0.15, 0.5)
    record = ground(np.zeros(2), 0.02)
    rotation = share * limit * structure.critical_rotation
    settings = TimeHistorySettings(overturning_limit=limit, initial_rotation=rotation)
    for run in (time_history, demand):
        with pytest.raises(ValueError, match="overturning limit") as refusal:
            run(structure, record, settings)
        assert f"initial_rotation = {rotation:.6g} rad" in str(refusal.value)
        assert f"{limit * structure.critical_rotation:.6g} rad" in str(refusal.value)


@pytest.mark.evidence("steps, events, energy", "exact")
def test_a_release_from_just_below_the_limit_is_followed() -> None:
    structure = podium(1, 0.15, 0.5)
    rotation = 2.0 * structure.critical_rotation * (1.0 - 1e-12)
    settings = TimeHistorySettings(initial_rotation=rotation)
    result = time_history(structure, ground(np.zeros(2), 0.02), settings)
    assert result.outcome == "overturned_rocking"
    assert result.duration < 1e-4
