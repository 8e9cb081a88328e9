"""Events: the search for them, histories where they are delicate, and ends other than by time.

All are located within the step, turning points included; failures say what happened.
"""

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import pytest
from paper_structures import (
    COMPILED,
    FLAT,
    bisected,
    ground,
    known,
    let_go,
    needs_compiled_kernels,
    podium,
    stillness,
    waves,
)
from scipy.interpolate import BPoly, PPoly

from rpscli.analyses.demand import demand
from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import PodiumStructure
from rpscli.physics.quintic import NO_PASSAGE, first_descent
from rpscli.records.ground_motion import GroundMotion

DT = 0.01
QUIET = TimeHistorySettings(free_vibration=0.0)
RANDOM_CURVES = 1500 if COMPILED else 100


def to_bernstein(powers):
    """Coefficients on (0, 1) from those of t^5 ... 1 or of less."""
    padded = np.pad(powers, (6 - len(powers), 0))
    b = BPoly.from_power_basis(PPoly(padded[:, None], [0.0, 1.0])).c[:, 0]
    return (b[0], b[1], b[2], b[3], b[4], b[5])


def descent(b):
    return first_descent(b, np.empty(6))


def descent_by_roots(b):
    """The start of the first interval between real roots on which the curve is negative."""
    powers = PPoly.from_bernstein_basis(BPoly(np.array(b)[:, None], [0.0, 1.0])).c[:, 0]
    roots = np.roots(powers)
    real = np.sort(
        roots.real[(np.abs(roots.imag) < 1e-9) & (roots.real > 0) & (roots.real < 1)]
    )
    for left, right in pairwise([0.0, *real, 1.0]):
        if right - left > 1e-9 and np.polyval(powers, 0.5 * (left + right)) < 0.0:
            return float(left)
    return NO_PASSAGE


def random_curve(rng, kind):
    if kind == 0:  # anything
        b = rng.normal(size=6)
    elif kind == 1:  # starts above, mostly stays there
        b = np.concatenate((np.abs(rng.normal(size=1)), rng.normal(size=5) + 0.5))
    elif kind == 2:  # starts at exactly zero, up or down
        b = np.concatenate(([0.0], rng.normal(size=5)))
    elif kind == 3:  # five real roots
        roots = rng.uniform(-0.3, 1.3, 5)
        return to_bernstein(np.atleast_1d(np.poly(roots)) * rng.choice([-1.0, 1.0]))
    else:  # dips below zero and back within a small part of the step
        middle, half = rng.uniform(0.01, 0.99), 10.0 ** rng.uniform(-6, -1)
        rest = np.poly(rng.uniform(1.2, 3.0, 3))
        powers = np.polymul([1.0, -2.0 * middle, middle**2 - half**2], rest)
        return to_bernstein(powers * np.sign(rest[-1]))
    return (b[0], b[1], b[2], b[3], b[4], b[5])


@pytest.mark.evidence("steps, events, energy", "exact")
@pytest.mark.parametrize("kind", range(5))
def test_the_first_descent_is_found(kind):
    rng = np.random.default_rng(kind)
    for _ in range(RANDOM_CURVES):
        b = random_curve(rng, kind)
        # numpy's roots of a close pair are good to sqrt(eps) only
        assert descent(b) == pytest.approx(descent_by_roots(b), abs=1e-7), b


@pytest.mark.evidence("steps, events, energy", "exact")
@pytest.mark.parametrize(
    ("b", "expected"),
    [
        ((0.0, 0.0, 0.0, 0.0, 0.0, 0.0), NO_PASSAGE),  # resting on zero
        ((0.0, 0.0, 0.0, 0.0, 0.0, 1.0), NO_PASSAGE),  # leaving upwards with t^5
        ((0.0, 0.0, 0.0, 0.0, 0.0, -1.0), 0.0),  # leaving downwards with t^5
        ((0.0, 1.0, 1.0, 1.0, 1.0, 1.0), NO_PASSAGE),
        ((0.0, -1.0, 1.0, 1.0, 1.0, 1.0), 0.0),
        ((-0.0, 1.0, 1.0, 1.0, 1.0, 1.0), NO_PASSAGE),
        ((-1.0, 1.0, 1.0, 1.0, 1.0, 1.0), 0.0),  # begins below
        (
            (1.0, 1.0, 1.0, 1.0, 1.0, 0.0),
            NO_PASSAGE,
        ),  # ends on zero: the next step's affair
        ((1.0, 1.0, 1.0, 1.0, 1.0, 1.0), NO_PASSAGE),
    ],
)
def test_starts_and_ends_on_zero(b, expected):
    assert descent(b) == expected


def test_two_crossings_right_after_a_start_on_zero():
    # t (t - a)(t - 2 a) (4 - t)^2 leaves upwards, dips below between a and 2 a
    for a in (0.3, 1e-2, 1e-4, 1e-7):
        powers = np.polymul(np.poly([0.0, a, 2.0 * a]), [1.0, -8.0, 16.0])
        b = to_bernstein(powers)
        # the conversion leaves the start on zero; coefficients round at 1e-16, slope there is a^2
        assert b[0] == 0.0
        assert descent(b) == pytest.approx(a, rel=1e-14 / a**2 + 1e-12)


@pytest.mark.parametrize("touch", [0.1, 0.37, 0.5, 0.9])
@pytest.mark.parametrize("above", [1e-12, 1e-8, 1e-3])
def test_a_curve_that_stays_above_by_any_margin_is_left_alone(touch, above):
    powers = np.convolve([1.0, -2.0 * touch, touch**2], [1.0, 0.0, 0.0, 1.0])
    powers[-1] += above
    assert descent(to_bernstein(powers)) == NO_PASSAGE


class Failure(NamedTuple):
    """A history that fails, words that say how, and what is left behind."""

    structure: PodiumStructure
    record: GroundMotion
    settings: TimeHistorySettings
    words: tuple[str, ...]
    holds: Callable[[TimeHistoryResult], bool]


USUAL, FRAME = podium(2, 0.15, 0.5), podium(0, 0.15, FLAT)
NEVER_ENDING = TimeHistorySettings(20.0, initial_rotation=1e-4, recontact_tolerance=0.0)
FAILURES = {
    "too many events": Failure(
        USUAL,
        waves(3.0, 0.02, 5.0, seed=1),
        TimeHistorySettings(max_events=3),
        ("rolling, theta = ", "raise", "analysis.max_events"),
        lambda result: (
            len(result.events) == 4
            and f"t = {result.duration:.6g} s" in known(result.failure)
        ),
    ),
    "an absurd record": Failure(
        USUAL,
        waves(1.0, 0.02, 1e200, seed=1),
        TimeHistorySettings(),
        ("no longer finite", "rolling, theta = "),
        lambda _: True,
    ),
    "overflow in full contact": Failure(
        USUAL,
        ground(1.7e308 * np.array([0.0, 0.0, 1.0, -1.0, 0.0]), 0.01),
        TimeHistorySettings(),
        ("full contact", "no longer finite"),
        lambda result: (
            result.duration <= 0.02
        ),  # where the record first overflows the push
    ),
    # infinitely many impacts in a finite time
    **{
        f"impacts without end of {structure.storeys} storeys": Failure(
            structure,
            stillness(0.05),
            replace(NEVER_ENDING, max_events=500),
            ("analysis.recontact_tolerance",),
            lambda result: result.impacts == 501,
        )
        for structure in (FRAME, podium(2, 0.15, FLAT))
    },
    # excursions shrink until their time is lost in the rounding of the clock; each is a tenth as
    # long as the last: some sixteen, and a hundred without any time
    "impacts without time": Failure(
        podium(0, 0.15, FLAT, law=ImpactLaw("value", 0.1)),
        stillness(0.05),
        replace(NEVER_ENDING, free_vibration=1.0),
        ("without time passing", "raise analysis.recontact_tolerance"),
        lambda result: 100 < result.impacts < 125,
    ),
}


@pytest.mark.parametrize("name", FAILURES)
def test_a_failure_is_told(name):
    if name == "an absurd record" and not COMPILED:
        pytest.skip("interpreted, the cosine of infinity raises")
    structure, record, settings, words, holds = FAILURES[name]
    with np.errstate(all="ignore"):
        result = time_history(structure, record, settings)
    assert result.outcome == "failed"
    assert all(word in known(result.failure) for word in words)
    assert holds(result)


@needs_compiled_kernels
def test_passing_the_critical_rotation_and_coming_back():
    """The ground that tilts the storey beyond theta_cr also fetches it back."""
    g, critical = FRAME.uplift_acceleration, FRAME.critical_rotation
    record = ground(np.concatenate((np.full(51, -3.0 * g), np.full(100, 3.0 * g))), DT)
    result = time_history(FRAME, record, QUIET)
    assert result.outcome == "survived"
    assert critical < result.max_rotation < 2.0 * critical
    assert passage_of(result).rotation == critical
    assert abs(result.trace.rotation[-1]) < critical
    # with a limit below the turning point the same motion counts as overturned
    tight = replace(QUIET, overturning_limit=0.999 * result.max_rotation / critical)
    fallen = time_history(FRAME, record, tight)
    assert fallen.outcome == "overturned_rocking"
    assert fallen.max_rotation == pytest.approx(
        tight.overturning_limit * critical, rel=1e-14
    )
    assert fallen.duration < result.duration


@pytest.mark.parametrize(
    ("rho", "outcome"),
    [
        (FLAT, "overturned_rocking"),
        (0.25, "overturned_rolling"),
        (0.5, "overturned_rocking"),
    ],
)
def test_overturning_is_named_after_the_phase_at_theta_cr(rho, outcome):
    structure = podium(0, 0.15, rho)
    assert structure.bearing.overturns_rolling is (outcome == "overturned_rolling")
    result = let_go(structure, 1.01 * structure.critical_rotation, 8.0, 0.02)
    assert result.outcome == outcome
    assert result.overturned
    assert result.events[-1].kind == "overturning"
    assert result.events[-1].rotation == 2.0 * structure.critical_rotation
    assert result.duration == result.events[-1].time


def passage_of(result):
    """The only one, which the scalar result repeats."""
    (event,) = (e for e in result.events if e.kind == "critical_rotation_passed")
    assert result.critical_passage_time == event.time
    assert abs(event.rotation) == result.structure.critical_rotation
    assert event.rotation_rate_before == event.rotation_rate_after
    return event


@pytest.mark.evidence("steps, events, energy", "exact")
@needs_compiled_kernels
@pytest.mark.parametrize(("storeys", "rho"), [(1, FLAT), (3, 0.25), (3, 0.5), (3, 1.5)])
def test_the_passage_does_not_depend_on_the_samples(storeys, rho):
    """Before the overturning limit or on the way back: the same instant for every sampling."""
    structure = podium(storeys, 0.12, rho)
    settings = TimeHistorySettings(free_vibration=2.0, accuracy=4.0)
    coarse = np.array([0.0, 1.0, 1.0, 0.2]) * -2.5 * structure.uplift_acceleration
    times = []
    for parts in (2, 20, 75):
        dt = 0.6 / parts
        fine = np.interp(np.arange(3 * parts + 1) / parts, np.arange(4), coarse)
        result = time_history(structure, ground(fine, dt), settings)
        times.append(passage_of(result).time)
        before = int(times[-1] / dt)
        x = np.abs(result.trace.rotation)
        assert np.all(x[: before + 1] <= structure.critical_rotation)
        assert x[before + 1] > structure.critical_rotation
    # order 6 while uplifted, w h = 1/8: what differs is the steps' own error
    assert times == pytest.approx([times[-1]] * 3, rel=1e-8)


@pytest.mark.evidence("steps, events, energy", "exact")
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_release_from_beyond_theta_cr_has_passed_it_at_once(sign):
    structure = podium(1, 0.15, FLAT)
    result = let_go(structure, sign * 1.2 * structure.critical_rotation, 5.0, 0.02)
    assert result.outcome == "overturned_rocking"
    assert passage_of(result).time == 0.0


@pytest.mark.evidence("steps, events, energy", "exact")
@pytest.mark.parametrize("limit", [2.0, 0.5])
@pytest.mark.parametrize("share", [1.0, -1.0, 1.5, -7.0])
def test_a_release_from_beyond_the_overturning_limit_is_refused(limit, share):
    """It would have overturned before it began."""
    structure = podium(1, 0.15, 0.5)
    rotation = share * limit * structure.critical_rotation
    settings = TimeHistorySettings(overturning_limit=limit, initial_rotation=rotation)
    for run in (time_history, demand):
        with pytest.raises(ValueError, match="overturning limit") as refusal:
            run(structure, stillness(0.02), settings)
        assert f"initial_rotation = {rotation:.6g} rad" in str(refusal.value)
        assert f"{limit * structure.critical_rotation:.6g} rad" in str(refusal.value)


@pytest.mark.evidence("steps, events, energy", "exact")
def test_a_release_from_just_below_the_limit_is_followed():
    structure = podium(1, 0.15, 0.5)
    result = let_go(
        structure, 2.0 * structure.critical_rotation * (1.0 - 1e-12), 5.0, 0.02
    )
    assert result.outcome == "overturned_rocking"
    assert result.duration < 1e-4


def kinds(result):
    return [event.kind for event in result.events]


@pytest.mark.parametrize("rho", [FLAT, 0.25, 0.5, 1.5])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_push_of_g_tan_alpha_is_the_limit(rho, sign):
    structure = podium(0, 0.15, rho)
    below, beyond = (
        time_history(
            structure,
            ground(np.full(51, push * structure.uplift_acceleration), DT),
            QUIET,
        )
        for push in (sign * (1.0 - 1e-9), sign * (1.0 + 1e-9))
    )
    assert below.outcome == "at_rest"
    assert kinds(beyond)[0] == "uplift"
    assert beyond.events[0].time == 0.0
    assert beyond.trace.rotation[-1] * sign < 0.0  # the storey stays behind the ground


def test_a_push_that_only_grazes_the_limit():
    """The margin of a building under a smooth load touches zero between two samples."""
    structure = podium(1, 0.15, 0.5)
    above = known(structure.superstructure)
    record = waves(2.0, 0.05, 1.0, seed=3)
    quiet = time_history(structure, record, QUIET)
    a = quiet.trace.ground_acceleration
    V = above.masses[0] * -quiet.trace.floor_accelerations[:, 0]
    q = (
        -a * (1.0 + 2.0 * structure.gamma)
        + 2.0 * structure.gamma * structure.eta * V / above.mass
    )
    limit = structure.uplift_acceleration * (1.0 + 2.0 * structure.gamma_total)
    sampled = limit / float(np.max(np.abs(q)))

    def uplifts(factor, motion=record):
        return time_history(structure, motion.scaled(factor), QUIET).uplifts

    # between samples q is larger: the factor at which the first uplift appears
    low, high = bisected(
        lambda factor: uplifts(factor) > 0, 0.5 * sampled, 1.001 * sampled
    )
    grazing = time_history(structure, record.scaled(high), QUIET)
    assert high < sampled
    assert grazing.failure is None
    assert grazing.uplifts == 1
    assert grazing.max_rotation < 1e-6
    finer = ground(
        np.interp(np.arange(4001) * 5e-4, record.time, record.acceleration), 5e-4
    )
    assert uplifts(low * (1.0 - 1e-6), finer) == 0
    assert uplifts(high * (1.0 + 1e-6), finer) == 1


def test_two_impacts_within_one_step():
    """At re-contact impacts follow each other faster than the record's samples."""
    result = let_go(FRAME, 0.02, 40.0, 0.2, recontact_tolerance=1e-9, accuracy=16.0)
    fine = let_go(FRAME, 0.02, 40.0, 0.002, recontact_tolerance=1e-9)
    times, again = (
        np.array([event.time for event in each.events if event.kind == "impact"])
        for each in (result, fine)
    )
    assert np.bincount((times / 0.2).astype(int)).max() > 20
    assert len(times) == len(again)
    assert times == pytest.approx(again, abs=1e-6)
    assert kinds(result).count("recontact") == 1


def caught(factor, at, shape, dt):
    """A falling frame under a polygon of pushes at some samples."""
    times = np.arange(round(at[-1] / dt) + 1) * dt
    push = -factor * FRAME.uplift_acceleration * np.interp(times, at, shape)
    return time_history(FRAME, ground(push, dt), replace(QUIET, initial_rotation=0.01))


def test_uplift_again_at_the_instant_of_recontact():
    """A falling storey that is caught just too late: it touches down with almost no velocity.

    The push would tilt it to the old side again, so beyond the impact it is pushed back, locks, and
    is lifted to the old side without time passing.
    """

    def history(factor):
        return caught(factor, [0.0, 0.05, 0.15, 0.8], [0.0, 0.0, 1.0, 1.0], DT)

    low, high = bisected(lambda factor: history(factor).impacts == 0, 1.0, 10.0)
    assert kinds(history(high)) == []
    touched = history(low)
    assert kinds(touched) == ["impact", "recontact", "uplift"]
    assert len({event.time for event in touched.events}) == 1
    # both continue alike: the touch takes nothing away
    assert touched.trace.rotation[-1] == pytest.approx(
        history(high).trace.rotation[-1], rel=1e-6
    )


def test_a_dip_below_zero_and_back_within_one_step():
    """Positive at both ends of the step, negative between: no sign change tells of the impact."""

    def history(factor, parts):
        at = [0.0, 0.2, 0.4, 0.6, 0.8]
        return caught(factor, at, [0.0, 1.0, 1.0, 1.0, 0.0], 0.2 / parts)

    low, high = bisected(
        lambda factor: history(factor, 100).impacts == 0, 1.0, 10.0, 1e-10
    )
    missed, touched = history(high + 1e-5, 1), history(low - 1e-5, 1)
    assert missed.impacts == 0
    first = touched.events[0]
    assert first.kind == "impact"
    # how long the dip would have lasted: two speeds over the deceleration, far less than a step
    dip = 2.0 * abs(first.rotation_rate_before) / FRAME.rigid_frequency_parameter**2
    assert dip < 0.01 < 0.2 / 3.0
    assert first.time == pytest.approx(history(low - 1e-5, 100).events[0].time, abs=1e-4)


@pytest.mark.parametrize("rho", [FLAT, 0.5])
def test_the_largest_tilt_may_lie_in_a_step_that_ends_on_an_impact(rho):
    """A push that hardly exceeds the limit: up, over the top and down again within one step."""
    structure = podium(0, 0.15, rho)
    peak = 1.02 * structure.uplift_acceleration
    record = ground([0.0, 0.5 * peak, peak, 0.5 * peak, 0.0, 0.0], 0.1)
    coarse, fine = (
        time_history(structure, record, replace(QUIET, accuracy=accuracy))
        for accuracy in (1.0, 64.0)
    )
    assert kinds(coarse) == kinds(fine)
    assert coarse.impacts > 0
    up, down = coarse.events[:2]
    assert up.time < coarse.history.max_theta_time < down.time < 0.3
    # the ground's corner at 0.2 s is a sample; behind it the motion is almost a cubic
    assert coarse.max_rotation == pytest.approx(fine.max_rotation, rel=1e-8)
    assert coarse.history.max_theta_time == pytest.approx(
        fine.history.max_theta_time, abs=1e-8
    )
