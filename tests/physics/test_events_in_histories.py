"""Uplift, impact, re-contact and overturning where they are delicate."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from paper_structures import FLAT, ground, podium, stillness, waves

from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import PodiumStructure

DT = 0.01
QUIET = TimeHistorySettings(free_vibration=0.0)


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


@pytest.mark.parametrize("rho", [FLAT, 0.25, 0.5, 1.5])
def test_exactly_at_the_limit_nothing_happens_or_nothing_that_can_be_seen(rho: float) -> None:
    result = constant(podium(0, 0.15, rho), 1.0, seconds=3.0)
    assert result.outcome in {"at_rest", "survived"}
    # an excess of rounding, 1e-16, grows at most as exp(p t), p < 2.6
    assert result.max_rotation < 1e-12
    assert result.failure is None


@pytest.mark.parametrize("rho", [FLAT, 0.25])
def test_just_above_the_limit_the_rotation_grows_as_linear_theory_says(rho: float) -> None:
    """x'' = w^2 (-kappa x + alpha epsilon): epsilon alpha/|kappa| (cosh(p t) - 1)."""
    structure, epsilon = podium(0, 0.15, rho), 1e-6
    result = constant(structure, -(1.0 + epsilon), seconds=1.0)
    w2 = structure.rigid_frequency_parameter**2
    slope = structure.initial_stiffness / structure.weight * 2.0 * structure.bearing.semi_diagonal
    C = math.cos(structure.bearing.alpha)
    # exact tangent of F = W B/C at 0, and du_b = 2 R C dx
    rate = w2 * slope * C**2
    growth = (math.cosh(math.sqrt(-rate)) - 1.0) / -rate
    expected = w2 * math.sin(structure.bearing.alpha) * epsilon * growth
    assert result.trace.rotation[-1] == pytest.approx(expected, rel=1e-5)


def test_uplift_is_located_within_the_interval() -> None:
    structure = podium(0, 0.15, 0.5)
    ramp = ground(np.array([0.0, 3.0]), 1.0)
    result = time_history(structure, ramp, QUIET)
    expected = structure.uplift_acceleration / 3.0
    assert result.events[0].time == pytest.approx(expected, rel=1e-15)


def test_a_push_that_only_grazes_the_limit() -> None:
    """The margin of a building under a smooth load touches zero between two samples."""
    structure = podium(1, 0.15, 0.5)
    above = structure.superstructure
    assert above is not None
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


@pytest.mark.parametrize("law", ["rigid", "flexible"])
def test_impacts_jump_as_the_law_says(law: str) -> None:
    structure = podium(2, 0.15, 0.5, law=ImpactLaw("rigid" if law == "rigid" else "flexible"))
    settings = TimeHistorySettings(free_vibration=3.0, initial_rotation=0.05)
    result = time_history(structure, stillness(0.005), settings)
    impacts = [event for event in result.events if event.kind == "impact"]
    assert len(impacts) > 3
    for event in impacts:
        expected = structure.restitution * event.rotation_rate_before
        assert event.rotation_rate_after == pytest.approx(expected, rel=1e-15)
        assert event.rotation == 0.0
    # over one impact well inside an interval the floors' velocities jump together, or not at all
    sample = int(impacts[0].time / 0.005)
    velocity = np.diff(result.trace.floor_displacements, axis=0) / 0.005
    before, after = velocity[sample - 1], velocity[sample + 1]
    jump = 2.0 * structure.bearing.half_height * (1.0 - structure.restitution)
    jump *= abs(impacts[0].rotation_rate_before)
    change = (after - before).mean()
    # two intervals of accelerations below 2 g tan(alpha) blur it
    assert change == pytest.approx(jump if law == "rigid" else 0.0, abs=0.06)
    assert jump > 0.0


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
