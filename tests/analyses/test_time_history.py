"""Results of a time history agree with its own samples and with statics; what users are told."""

import math
import re
import tracemalloc
from collections.abc import Iterator
from dataclasses import replace
from itertools import islice

import numpy as np
import pytest
from paper_structures import (
    COMPILED,
    FLAT,
    building,
    ground,
    known,
    needs_compiled_kernels,
    podium,
    stillness,
    waves,
)

from rpscli.analyses.demand import demand
from rpscli.analyses.fixed_base import fixed_base_response, reference_shears
from rpscli.analyses.kernels.history import FIRST_LOG, MOST_NUMBERS, numbers_of_a_sample
from rpscli.analyses.settings import LONGEST_FREE_VIBRATION, TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.errors import CaseError, RecordError
from rpscli.model.devices import ViscousDamper
from rpscli.model.impact import ImpactLaw
from rpscli.model.superstructure import ModalDamping, RayleighDamping, Superstructure
from rpscli.records.ground_motion import MotionComponents
from rpscli.report.bundles import timehistory_files
from rpscli.report.figures.look import Look

SECONDS = 5.0 if COMPILED else 1.5
SETTINGS = TimeHistorySettings(free_vibration=1.0)
RECORD = waves(SECONDS, 0.02, 4.0, seed=21)
VERTICAL = waves(0.6 * SECONDS, 0.02, 2.0, seed=22)

STRUCTURES = [
    podium(0, 0.15, 0.5),
    podium(2, 0.15, FLAT),
    podium(3, 0.20, 0.26, law=ImpactLaw("flexible")),
    podium(3, 0.10, 1.5, superstructure=building(3, damping=ModalDamping(0.04))),
]


@pytest.fixture(scope="module", params=STRUCTURES)
def result(request):
    return time_history(request.param, RECORD, SETTINGS, vertical=VERTICAL)


def test_maxima_are_not_below_the_samples(result):
    trace = result.trace
    rotation = np.abs(trace.rotation)
    # turning points lie between samples: x'' dt^2/8 above the nearest at most
    assert 0.0 <= result.max_rotation - rotation.max() <= 50.0 * 0.02**2 / 8.0
    assert result.max_rotation_time == pytest.approx(
        trace.time[rotation.argmax()], abs=0.02
    )
    if result.structure.storeys == 0:
        assert result.max_base_shear == 0.0
        assert result.base_shear_ratio is None
        return
    shears = np.max(np.abs(trace.storey_shears), axis=0)
    assert np.all(result.storey_shears >= (1.0 - 1e-11) * shears)
    assert result.storey_shears == pytest.approx(shears, rel=0.05)
    accelerations = np.max(np.abs(trace.floor_accelerations), axis=0)
    assert np.all(result.floor_accelerations >= (1.0 - 1e-9) * accelerations)
    stiffnesses = known(result.structure.superstructure).stiffnesses
    assert result.max_drifts == pytest.approx(
        result.storey_shears / stiffnesses, rel=1e-11
    )
    ratio = result.storey_shears[0] / result.structure.static_base_shear
    assert result.base_shear_ratio == pytest.approx(ratio, rel=1e-11)


def test_floors_stand_on_the_cap_beam(result):
    trace, above = result.trace, result.structure.superstructure
    _, u, lift = result.structure.path(np.abs(trace.rotation))
    assert trace.cap_beam_displacement == pytest.approx(
        np.sign(trace.rotation) * u, abs=1e-15
    )
    assert trace.lift == pytest.approx(lift, abs=1e-15)
    assert np.all(trace.lift >= -1e-16)
    if above is None:
        return
    stacked = trace.cap_beam_displacement[:, None] + np.cumsum(trace.drifts, axis=1)
    assert trace.floor_displacements == pytest.approx(stacked, abs=1e-14)
    assert trace.storey_shears == pytest.approx(
        above.stiffnesses * trace.drifts, rel=1e-15
    )


def test_the_record_is_zero_after_its_end(result):
    a = result.trace.ground_acceleration
    assert len(a) == RECORD.npts + 50
    assert a[: RECORD.npts].tolist() == RECORD.acceleration.tolist()
    assert not np.any(a[RECORD.npts :])
    assert result.trace.time == pytest.approx(0.02 * np.arange(len(a)), abs=1e-12)
    assert result.duration == pytest.approx(RECORD.duration + 1.0, rel=1e-12)


def test_the_energy_audit_closes_at_every_sample(result):
    trace, energy = result.trace, result.energy
    assert result.impacts > 0
    gap = (
        trace.energy_input
        - trace.energy_damped
        - trace.energy_impact
        - trace.energy_stored
    )
    # order 7 uplifted, 6 for damping in full contact, w h = 1/2: (1/2)^7/7! of the largest flow
    assert np.max(np.abs(gap)) < 1.5e-6 * energy.input
    assert energy.residual == pytest.approx(gap[-1], abs=1e-9 * energy.input)
    assert energy.stored == pytest.approx(trace.energy_stored[-1], rel=1e-9, abs=1e-6)
    assert np.all(np.diff(trace.energy_damped) >= -1e-9 * energy.input)
    lost = [event.energy_lost for event in result.events]
    assert sum(lost) == pytest.approx(energy.impact, rel=1e-9)
    impacts = [event.energy_lost for event in result.events if event.kind == "impact"]
    created = -sum(change for change in impacts if change < 0.0)
    assert energy.created == pytest.approx(created, rel=1e-9, abs=1e-12)
    assert result.history.creating_impacts == sum(change < 0.0 for change in impacts)


def test_events_are_in_order_and_make_sense(result):
    events, times = result.events, [event.time for event in result.events]
    assert times == sorted(times)
    assert 0.0 <= times[0] <= times[-1] <= result.duration
    assert events[0].kind == "uplift"
    assert result.uplifts == sum(event.kind == "uplift" for event in events)
    assert result.impacts == sum(event.kind == "impact" for event in events)
    beta = result.structure.bearing.beta
    tilt = {"uplift": 0.0, "impact": 0.0, "recontact": 0.0}
    tilt |= {"rolling_to_rocking": beta, "rocking_to_rolling": beta}
    for event in events:
        if event.kind in tilt:
            assert abs(event.rotation) == tilt[event.kind]
        if event.kind == "impact":
            # the column goes over to the other edge without changing its sense of turning
            assert event.rotation_rate_before * event.rotation_rate_after >= 0.0
        if event.kind == "rolling_to_rocking":
            assert event.rotation * event.rotation_rate_before >= 0.0
            assert event.rotation_rate_before == event.rotation_rate_after
    # what leaves full contact returns to it, or ends uplifted
    kinds = [event.kind for event in events if event.kind in {"uplift", "recontact"}]
    assert kinds == ["uplift", "recontact"] * (len(kinds) // 2) + ["uplift"] * (
        len(kinds) % 2
    )


def test_phases_of_the_samples_fit_their_rotations(result):
    trace, beta = result.trace, result.structure.bearing.beta
    x = np.abs(trace.rotation)
    assert np.all(x[trace.phase == 0] == 0.0)
    assert np.all(x[trace.phase == 1] <= beta)
    assert np.all(x[trace.phase == 2] >= beta)


def test_a_study_sees_the_same_numbers(result):
    quick = demand(result.structure, RECORD, SETTINGS, vertical=VERTICAL)
    assert quick.scalars() == result.scalars()
    assert quick.storey_shears.tolist() == result.storey_shears.tolist()
    assert quick.floor_accelerations.tolist() == result.floor_accelerations.tolist()
    assert quick.energy_created == result.energy.created


def test_scalars_are_plain_and_complete(result):
    scalars = result.scalars()
    assert scalars["outcome"] == result.outcome
    assert scalars["max_rotation"] == result.max_rotation
    assert (
        scalars["rotation_ratio"]
        == result.max_rotation / result.structure.critical_rotation
    )
    assert {type(value) for value in scalars.values()} <= {type(None), str, int, float}
    assert scalars.get("failure") is None


def test_a_structure_at_rest_has_no_largest_rotation():
    still = ground(0.5 * RECORD.acceleration / RECORD.pga, 0.02)
    quiet = time_history(podium(0), still, SETTINGS)
    assert quiet.outcome == "at_rest"
    assert (quiet.max_rotation, quiet.max_rotation_time) == (0.0, None)


def test_the_restoring_moment_lifts_the_weight():
    """dW v_b/dtheta, odd in theta, zero at theta_cr."""
    structure = podium(2, 0.15, 0.5)
    result = time_history(structure, ground([0.0, 0.1, 0.0], 0.02), SETTINGS)
    beta, end, h = structure.bearing.beta, structure.critical_rotation, 1e-5
    tilt = np.array([0.01, 0.5 * beta, 0.5 * (beta + end)])
    (_, _, above), (_, _, below) = structure.path(tilt + h), structure.path(tilt - h)
    slope = structure.weight * (above - below) / (2.0 * h)
    moment = result.restoring_moment(tilt)
    assert moment == pytest.approx(slope, rel=1e-8)  # h^2, and rounding eps/h of v_b
    assert result.restoring_moment(-tilt).tolist() == (-moment).tolist()
    assert abs(result.restoring_moment(np.array([end]))[0]) < 1e-10 * moment[0]


def test_slow_rocking_is_driven_by_what_restores_it():
    """Held still at the limit of uplift the driving moment is 2 R W B(0)."""
    structure = podium(2, 0.15, 0.5)
    rise = np.concatenate((np.linspace(0.0, -1.0000001, 4001), np.full(2, -1.0000001)))
    # applied over 40 s, far slower than the building: V = -M_tot a_g
    slow = ground(rise * structure.uplift_acceleration, 0.01)
    result = time_history(structure, slow, TimeHistorySettings(free_vibration=0.0))
    moment = 2.0 * structure.bearing.half_height * structure.uplift_force
    assert result.trace.driving_moment[4000] == pytest.approx(moment, rel=1e-5)
    shear = result.trace.storey_shears[4000, 0]
    assert shear == pytest.approx(structure.static_base_shear, rel=1e-4)


def test_drift_ratios_need_storey_heights():
    above = building(2)
    tall = Superstructure(
        above.masses, above.stiffnesses, above.damping, np.array([4.0, 2.0])
    )
    with_heights = time_history(podium(2, superstructure=tall), RECORD, SETTINGS)
    expected = float(np.max(with_heights.max_drifts / [4.0, 2.0]))
    assert with_heights.drift_ratio == pytest.approx(expected, rel=1e-15)
    assert time_history(podium(2), RECORD, SETTINGS).drift_ratio is None


def test_a_shorter_component_goes_on_as_zero():
    structure = podium(1)
    longer = ground(np.concatenate((RECORD.acceleration, np.zeros(30))), 0.02)
    settings = replace(SETTINGS, free_vibration=0.0)
    one = time_history(
        structure, RECORD, replace(SETTINGS, free_vibration=0.6), vertical=VERTICAL
    )
    two = time_history(structure, longer, settings, vertical=VERTICAL)
    assert len(one.trace.time) == len(two.trace.time)
    assert two.trace.rotation == pytest.approx(one.trace.rotation, abs=1e-12)
    # the vertical component may be the longer one
    upwards = ground(np.zeros(longer.npts), 0.02)
    three = time_history(structure, RECORD, settings, vertical=upwards)
    assert len(three.trace.time) == longer.npts
    with pytest.raises(RecordError, match="they must agree"):
        time_history(structure, RECORD, SETTINGS, vertical=ground([0.0, 1.0], 0.01))


@needs_compiled_kernels
def test_a_log_that_overflows_is_written_again():
    """More events than the first attempt has room for: all are listed."""
    structure = podium(0, 0.05, FLAT)
    pulse = 1.05 * structure.uplift_acceleration * np.sin(np.linspace(0.0, np.pi, 11))
    shaking = np.tile(np.concatenate((pulse, np.zeros(89))), 24)
    settings = TimeHistorySettings(free_vibration=0.0, recontact_tolerance=1e-9)
    result = time_history(structure, ground(shaking, 0.02), settings)
    assert len(result.events) > FIRST_LOG
    assert len(result.events) == int(result.history.events.sum())
    times = [event.time for event in result.events]
    assert times == sorted(times)
    assert times[-1] > times[FIRST_LOG - 1]


@needs_compiled_kernels
@pytest.mark.parametrize(("law", "creates"), [("rigid", True), ("flexible", False)])
def test_energy_created_by_a_release_is_told_with_a_remedy(law, creates):
    """A tall building of short period against the rigid law; no ground motion supplies energy."""
    structure = podium(
        30, 0.15, FLAT, superstructure=building(30, 0.5), law=ImpactLaw(law)
    )
    settings = TimeHistorySettings(free_vibration=1.5, initial_rotation=0.03)
    result = time_history(structure, stillness(0.01), settings)
    assert result.energy.input == 0.0
    assert (result.energy.created > 0.02 * result.trace.energy_stored[0]) is np.bool_(
        creates
    )
    assert any("law: flexible" in warning for warning in result.warnings) is creates
    assert any("still moves at the end" in warning for warning in result.warnings)
    if not creates:
        assert result.energy.created == result.history.creating_impacts == 0


@needs_compiled_kernels
def test_a_storey_that_never_stops_is_told():
    """Without loss the free vibration `auto` gives up after its longest time."""
    above = building(1, damping=RayleighDamping(0.0))
    structure = podium(1, 0.15, 0.5, law=ImpactLaw("value", 1.0), superstructure=above)
    result = time_history(
        structure, stillness(0.05), TimeHistorySettings(initial_rotation=0.1)
    )
    assert result.duration == pytest.approx(0.05 + LONGEST_FREE_VIBRATION, rel=1e-12)
    assert any("not at rest" in warning for warning in result.warnings)


def test_the_yardstick_sees_the_whole_record_when_the_structure_falls():
    record = waves(6.0, 0.02, 10.0, seed=1)
    results = [
        time_history(of, record) for of in (podium(2, 0.10, FLAT), podium(2, 0.9, 1.5))
    ]
    assert [result.overturned for result in results] == [True, False]
    fallen, stout = (known(result.fixed_base) for result in results)
    swaying = np.abs(fallen.floor_displacements[:, 0])
    assert len(swaying) == record.npts
    assert record.dt * np.argmax(swaying) > results[0].duration + 0.1
    assert fallen.base_shear == stout.base_shear
    assert fallen.floor_accelerations.tolist() == stout.floor_accelerations.tolist()


def test_the_yardstick_goes_on_through_the_free_vibration():
    """A pulse just before the end of the record: the building answers after it."""
    record = ground(np.concatenate((np.zeros(20), [0.0, 1.0, 1.0])), 0.02)
    result = time_history(podium(3), record, TimeHistorySettings(free_vibration=0.5))
    fixed = known(result.fixed_base)
    swaying = np.abs(fixed.floor_displacements[:, 0])
    assert len(swaying) == len(result.trace.time) == record.npts + 25
    assert np.argmax(swaying) >= record.npts
    assert fixed.drifts[0] == pytest.approx(np.max(swaying), rel=0.02)
    shears = reference_shears(result.structure, MotionComponents(record))
    assert shears.tolist() == fixed.storey_shears.tolist()


def test_a_frame_has_no_yardstick():
    record = ground([0.0, 1.0, 0.0], 0.02)
    assert time_history(podium(0), record, SETTINGS).fixed_base is None
    assert time_history(podium(1), record, with_fixed_base=False).fixed_base is None
    with pytest.raises(ValueError, match="without superstructure"):
        fixed_base_response(podium(0), MotionComponents(record), 2)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("free_vibration", -1.0),
        ("free_vibration", math.inf),
        ("recontact_tolerance", -1e-9),
        ("recontact_tolerance", math.nan),
        ("overturning_limit", math.nan),
        ("accuracy", 0.0),
        ("accuracy", math.nan),
        ("accuracy", math.inf),
        ("max_events", 0),
        ("initial_rotation", math.nan),
    ],
)
def test_settings_that_no_history_ends_with_are_refused(name, value):
    with pytest.raises(ValueError, match=rf"{name} = .* must be"):
        TimeHistorySettings(**{name: value})


AT_ONCE = TimeHistorySettings(free_vibration=0.0)
DAMPED = replace(podium(3), devices=(ViscousDamper(1e5),))
FINE = 1e-5


def swaying(samples):
    return ground(3.0 * np.sin(np.arange(samples) * FINE * 12.0), FINE)


@needs_compiled_kernels
@pytest.mark.parametrize("structure", [podium(6), DAMPED], ids=["six storeys", "damper"])
def test_memory_is_what_the_ceiling_counts(structure):
    record = swaying(100_000)
    time_history(structure, swaying(100), AT_ONCE)  # loads the kernels
    tracemalloc.start()
    try:
        result = time_history(structure, record, AT_ONCE)
        files = dict(timehistory_files(result, "", Look(formats=())))
        written = files["timehistory.csv"]
        assert isinstance(written, Iterator)
        pieces = [str(piece) for piece in islice(written, 11)]
        assert "".join(pieces).count("\n") > 5000
        held, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    counted = 8.0 * record.npts * numbers_of_a_sample(structure)
    lines = 1e7  # numbers and text of some thousand
    assert 0.9 * counted < held < 1.02 * counted + lines
    # Above it stands what is in the making: the floors on a fixed base, or a block of everything.
    assert peak < 1.3 * counted + lines


def test_histories_over_the_ceiling_are_refused():
    many = podium(40)
    record = ground(np.zeros(2), 1e-5)
    rows = 12_000_003
    assert rows * numbers_of_a_sample(many) > MOST_NUMBERS
    with pytest.raises(
        CaseError, match=re.escape(f"{rows} samples of 40 storeys")
    ) as refusal:
        time_history(many, record)
    assert "GB" in str(refusal.value)
    assert "give a shorter analysis.free_vibration" in str(refusal.value)
