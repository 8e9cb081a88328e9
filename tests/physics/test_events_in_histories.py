"""Events in histories where they are delicate, and how histories end other than by time.

All are located within the step, turning points included; failures say what happened.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from paper_structures import FLAT, ground, known, needs_compiled_kernels, podium, stillness, waves

from rpscli.analyses.demand import demand
from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.analyses.trace import Event
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import PodiumStructure

DT = 0.01
QUIET = TimeHistorySettings(free_vibration=0.0)


def failed(result: TimeHistoryResult) -> str:
    """How it failed."""
    assert result.outcome == "failed"
    return known(result.failure)


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
    assert len(result.events) == 4
    failure = failed(result)
    assert f"t = {result.duration:.6g} s, rolling, theta = " in failure
    assert "analysis.max_events" in failure
    assert "raise" in failure


@needs_compiled_kernels  # interpreted, the cosine of infinity raises
def test_an_absurd_record_is_a_failure_not_a_number() -> None:
    structure = podium(2, 0.15, 0.5)
    with np.errstate(all="ignore"):
        result = time_history(structure, waves(1.0, 0.02, 1e200, seed=1))
    failure = failed(result)
    assert "no longer finite" in failure
    assert "rolling, theta = " in failure


def test_a_record_that_overflows_in_full_contact_is_a_failure() -> None:
    record = ground(1.7e308 * np.array([0.0, 0.0, 1.0, -1.0, 0.0]), 0.01)
    with np.errstate(all="ignore"):
        result = time_history(podium(2, 0.15, 0.5), record)
    failure = failed(result)
    assert "full contact" in failure
    assert "no longer finite" in failure
    assert result.duration <= 0.02  # where the record first overflows the push


@pytest.mark.parametrize("storeys", [0, 2])
def test_without_a_recontact_tolerance_impacts_never_end(storeys: int) -> None:
    """Infinitely many impacts in a finite time: the history stops, and says what to raise."""
    settings = TimeHistorySettings(
        free_vibration=20.0, initial_rotation=1e-4, recontact_tolerance=0.0, max_events=500
    )
    result = time_history(podium(storeys, 0.15, FLAT), stillness(0.05), settings)
    assert result.impacts == 501
    failure = failed(result)
    assert "analysis.recontact_tolerance" in failure


def test_impacts_without_time_between_them_end_a_history() -> None:
    """Excursions shrink until their time is lost in the rounding of the clock."""
    settings = TimeHistorySettings(
        free_vibration=1.0, initial_rotation=1e-4, recontact_tolerance=0.0
    )
    structure = podium(0, 0.15, FLAT, law=ImpactLaw("value", 0.1))
    result = time_history(structure, stillness(0.05), settings)
    failure = failed(result)
    assert "without time passing" in failure
    assert "raise analysis.recontact_tolerance" in failure
    # each excursion is a tenth as long as the last: some sixteen, and a hundred without any time
    assert 100 < result.impacts < 125


def passage_of(result: TimeHistoryResult) -> Event:
    """The only one, which the scalar result repeats."""
    (event,) = (e for e in result.events if e.kind == "critical_rotation_passed")
    assert result.critical_passage_time == event.time
    assert abs(event.rotation) == result.structure.critical_rotation
    assert event.rotation_rate_before == event.rotation_rate_after
    return event


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


def constant(structure: PodiumStructure, factor: float, seconds: float = 0.5) -> TimeHistoryResult:
    """Under a constant push of `factor` times g tan(alpha), from t = 0 on."""
    push = np.full(round(seconds / DT) + 1, factor * structure.uplift_acceleration)
    return time_history(structure, ground(push, DT), QUIET)


def kinds(result: TimeHistoryResult) -> list[str]:
    return [event.kind for event in result.events]


@pytest.mark.parametrize("rho", [FLAT, 0.25, 0.5, 1.5])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_push_of_g_tan_alpha_is_the_limit(rho: float, sign: float) -> None:
    structure = podium(0, 0.15, rho)
    assert constant(structure, sign * (1.0 - 1e-9)).outcome == "at_rest"
    uplifted = constant(structure, sign * (1.0 + 1e-9))
    assert kinds(uplifted)[0] == "uplift"
    assert uplifted.events[0].time == 0.0
    assert uplifted.trace.rotation[-1] * sign < 0.0  # the storey stays behind the ground


def test_a_push_that_only_grazes_the_limit() -> None:
    """The margin of a building under a smooth load touches zero between two samples."""
    structure = podium(1, 0.15, 0.5)
    above = known(structure.superstructure)
    record = waves(2.0, 0.05, 1.0, seed=3)
    quiet = time_history(structure, record, QUIET)
    a = quiet.trace.ground_acceleration
    V = above.masses[0] * -quiet.trace.floor_accelerations[:, 0]
    q = -a * (1.0 + 2.0 * structure.gamma) + 2.0 * structure.gamma * structure.eta * V / above.mass
    limit = structure.uplift_acceleration * (1.0 + 2.0 * structure.gamma_total)
    sampled = limit / float(np.max(np.abs(q)))
    # between samples q is larger: bisect the factor at which the first uplift appears
    low, high = 0.5 * sampled, 1.001 * sampled
    for _ in range(50):
        middle = 0.5 * (low + high)
        lifted = time_history(structure, record.scaled(middle), QUIET).uplifts > 0
        low, high = (low, middle) if lifted else (middle, high)
    grazing = time_history(structure, record.scaled(high), QUIET)
    assert high < sampled
    assert grazing.failure is None
    assert grazing.uplifts == 1
    assert grazing.max_rotation < 1e-6
    finer = ground(np.interp(np.arange(4001) * 5e-4, record.time, record.acceleration), 5e-4)
    assert time_history(structure, finer.scaled(low * (1.0 - 1e-6)), QUIET).uplifts == 0
    assert time_history(structure, finer.scaled(high * (1.0 + 1e-6)), QUIET).uplifts == 1


def test_two_impacts_within_one_step() -> None:
    """At re-contact impacts follow each other faster than the record's samples."""
    structure = podium(0, 0.15, FLAT)
    settings = TimeHistorySettings(
        free_vibration=40.0, initial_rotation=0.02, recontact_tolerance=1e-9
    )
    result = time_history(structure, stillness(0.2), replace(settings, accuracy=16.0))
    times = np.array([event.time for event in result.events if event.kind == "impact"])
    in_one_interval = np.bincount((times / 0.2).astype(int))
    assert in_one_interval.max() > 20
    fine = time_history(structure, stillness(0.002), settings)
    again = [event.time for event in fine.events if event.kind == "impact"]
    assert len(times) == len(again)
    assert times == pytest.approx(again, abs=1e-6)
    assert kinds(result).count("recontact") == 1


def test_uplift_again_at_the_instant_of_recontact() -> None:
    """A falling storey that is caught just too late: it touches down with almost no velocity.

    The push would tilt it to the old side again, so beyond the impact it is pushed back, locks, and
    is lifted to the old side without time passing.
    """
    structure = podium(0, 0.15, FLAT)
    settings = replace(QUIET, initial_rotation=0.01)

    def caught(factor: float) -> TimeHistoryResult:
        push = -factor * structure.uplift_acceleration
        ramp = np.interp(np.arange(81), [0, 5, 15, 80], [0.0, 0.0, push, push])
        return time_history(structure, ground(ramp, DT), settings)

    low, high = 1.0, 10.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if caught(middle).impacts == 0 else (middle, high)
    assert kinds(caught(high)) == []
    touched = caught(low)
    assert kinds(touched) == ["impact", "recontact", "uplift"]
    assert len({event.time for event in touched.events}) == 1
    # both continue alike: the touch takes nothing away
    assert touched.trace.rotation[-1] == pytest.approx(caught(high).trace.rotation[-1], rel=1e-6)


def test_a_dip_below_zero_and_back_within_one_step() -> None:
    """Positive at both ends of the step, negative between: no sign change tells of the impact."""
    structure = podium(0, 0.15, FLAT)
    settings = replace(QUIET, initial_rotation=0.01)

    def caught(factor: float, parts: int) -> TimeHistoryResult:
        push = -factor * structure.uplift_acceleration
        fine = np.interp(np.arange(4 * parts + 1) / parts, np.arange(5), [0.0, push, push, push, 0])
        return time_history(structure, ground(fine, 0.2 / parts), settings)

    low, high = 1.0, 10.0
    while high - low > 1e-9:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if caught(middle, 100).impacts == 0 else (middle, high)
    missed, touched = caught(high + 1e-5, 1), caught(low - 1e-5, 1)
    assert missed.impacts == 0
    first = touched.events[0]
    assert first.kind == "impact"
    # how long the dip would have lasted: two speeds over the deceleration, far less than a step
    dip = 2.0 * abs(first.rotation_rate_before) / structure.rigid_frequency_parameter**2
    assert dip < 0.01 < 0.2 / 3.0
    assert first.time == pytest.approx(caught(low - 1e-5, 100).events[0].time, abs=1e-4)


@pytest.mark.parametrize("rho", [FLAT, 0.5])
def test_the_largest_tilt_may_lie_in_a_step_that_ends_on_an_impact(rho: float) -> None:
    """A push that hardly exceeds the limit: up, over the top and down again within one step."""
    structure = podium(0, 0.15, rho)
    peak = 1.02 * structure.uplift_acceleration
    record = ground([0.0, 0.5 * peak, peak, 0.5 * peak, 0.0, 0.0], 0.1)
    coarse, fine = (
        time_history(structure, record, TimeHistorySettings(accuracy=accuracy, free_vibration=0.0))
        for accuracy in (1.0, 64.0)
    )
    assert [e.kind for e in coarse.events] == [e.kind for e in fine.events]
    assert coarse.impacts > 0
    up, down = coarse.events[:2]
    assert up.time < coarse.history.max_theta_time < down.time < 0.3
    # the ground's corner at 0.2 s is a sample; behind it the motion is almost a cubic
    assert coarse.max_rotation == pytest.approx(fine.max_rotation, rel=1e-8)
    assert coarse.history.max_theta_time == pytest.approx(fine.history.max_theta_time, abs=1e-8)
