"""What is read off a history under both horizontal components."""

import json
from dataclasses import replace

import numpy as np
import pytest
from paper_structures import building, known, needs_compiled_kernels, podium, waves

from rpscli.analyses.column_forces import no_bound
from rpscli.analyses.fixed_base import fixed_base_response
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.analyses.trace import sampled
from rpscli.errors import CaseError
from rpscli.model.impact import ImpactLaw
from rpscli.records.ground_motion import GroundMotion, MotionComponents
from rpscli.report.bundles import event_columns, history_columns
from rpscli.report.files import json_text
from rpscli.report.timehistory import timehistory_document

pytestmark = needs_compiled_kernels

DT = 0.01
BUILDING = replace(podium(3), impact_law=ImpactLaw("flexible"))


def wave(period, size, seconds=4.0):
    t = np.arange(round(seconds / DT) + 1) * DT
    fade = np.minimum(1.0, 2.0 * (seconds - t) / seconds)
    return GroundMotion(
        size * fade * np.sin(2.0 * np.pi * t / period), DT, f"wave {period:g} s"
    )


@pytest.fixture(scope="module")
def motion():
    return MotionComponents(wave(0.9, 3.5), wave(0.3, 1.0), y=wave(0.62, 3.0))


@pytest.fixture(scope="module")
def result(motion):
    return time_history(BUILDING, motion, TimeHistorySettings(free_vibration=2.0))


@pytest.mark.evidence("both components", "exact")
def test_the_energies_balance_at_every_sample(result):
    # Those put in, damped and lost are the kernel's; what is stored follows from the samples.
    t = result.trace
    stored = t.energy_input - t.energy_damped - t.energy_impact
    assert result.uplifts == 1
    assert known(result.passes) > 3
    assert np.max(np.abs(t.energy_stored - stored)) < 1e-6 * np.max(t.energy_input)


def test_samples_do_not_exceed_the_largest_values(result):
    t, y = result.trace, known(result.trace.y)
    for name, largest in (
        ("cap_beam_displacement", result.max_cap_beam_displacement),
        ("storey_shears", result.storey_shears),
        ("floor_accelerations", result.floor_accelerations),
    ):
        seen = np.max(t.size(name), axis=0)
        # Samples every 10 ms miss little of what vibrates with 0.05 s and more.
        assert np.all(seen <= largest * (1.0 + 1e-9))
        assert np.all(seen > 0.97 * largest)
    # In a pass that floors cannot follow friction demands are those of other instants.
    turning = t.rotation * known(t.azimuth_rate)
    slow = 2.5e-2 * np.hypot(t.rotation_rate, turning) <= t.rotation
    friction = np.max((t.size("shear_bottom") / t.normal_bottom)[slow])
    assert (
        0.9 * result.friction_demand < friction <= result.friction_demand * (1.0 + 1e-9)
    )
    assert result.max_cap_beam_displacement_x == pytest.approx(
        np.max(np.abs(t.cap_beam_displacement)), rel=1e-3
    )
    assert result.max_base_shear_y == pytest.approx(
        np.abs(y.storey_shears[:, 0]).max(), rel=0.02
    )
    assert known(result.max_base_shear_x) <= result.max_base_shear


@pytest.mark.evidence("both components", "exact")
def test_a_turned_pair_turns_results(result, motion):
    other = time_history(BUILDING, motion.turned(30.0), result.settings)
    assert other.max_rotation == pytest.approx(result.max_rotation, rel=1e-9)
    assert other.max_base_shear == pytest.approx(result.max_base_shear, rel=1e-9)
    assert other.max_floor_velocity == pytest.approx(result.max_floor_velocity, rel=1e-6)
    assert other.max_roof_displacement == pytest.approx(
        result.max_roof_displacement, rel=1e-6
    )
    ahead = known(other.max_rotation_azimuth) - known(result.max_rotation_azimuth)
    assert np.cos(ahead - np.radians(30.0)) == pytest.approx(1.0, abs=1e-9)
    one, turned = known(result.fixed_base), known(other.fixed_base)
    assert turned.base_shear == pytest.approx(one.base_shear, rel=1e-6)


def test_a_fixed_base_under_equal_components_has_sqrt_2_of_one():
    one = wave(0.5, 2.0)
    alone = fixed_base_response(BUILDING, MotionComponents(one), 500)
    both = fixed_base_response(BUILDING, MotionComponents(one, y=one), 500)
    # 0.3 % is what cubics through samples may miss.
    for name in ("storey_shears", "floor_accelerations", "floor_velocities", "drifts"):
        exact = np.sqrt(2.0) * getattr(alone, name)
        assert getattr(both, name) == pytest.approx(exact, rel=3e-3)


def test_files_have_both_directions(result):
    names = [name for name, *_ in sampled(result.structure, result.trace)]
    assert names == [column.name for column in history_columns(result)]
    for name in ("azimuth", "rotation_y", "floor_3_acceleration_y", "storey_1_shear_x"):
        assert name in names
    passes = [event for event in result.events if event.kind == "pass"]
    assert len(passes) == result.passes
    closest = min(event.least_tilt or 0.0 for event in passes)
    assert closest / result.structure.bearing.alpha == pytest.approx(result.closest_pass)
    assert {"azimuth", "loss_share"} <= {
        column.name for column in event_columns(result.events)
    }
    document = json.loads(json_text(timehistory_document(result)))
    for name in ("max_base_shear_y", "passes_as_impacts", "torsion_lever"):
        assert document[name] == getattr(result, name)


def test_floor_spectra_of_both_are_refused(result):
    from rpscli.analyses.floor_spectra import isolated_floor_spectra

    with pytest.raises(CaseError, match=r"without \?both"):
        isolated_floor_spectra(result)


def on_floors(period, contact_time=2e-3):
    above = replace(building(2, 0.4), vertical_period=period)
    law = ImpactLaw("flexible", contact_time=contact_time)
    return podium(2, 0.15, 0.5, superstructure=above, law=law)


@pytest.mark.evidence("forces in columns, friction", "exact")
def test_largest_forces_hardly_depend_on_the_contact_time():
    """With the smooth motion's alone, passes of .5 ms asked for several times the weight.

    Medians of 22 recorded pairs move by 7 %; of eight motions chaos leaves more.
    """
    settings = TimeHistorySettings(free_vibration=1.0)

    def median(contact_time, period):
        of = on_floors(period, contact_time)
        weight = of.gravity * (
            of.cap_beam_mass + of.superstructure_mass + of.columns_mass
        )
        peak, found = 1.8 * of.uplift_acceleration, []
        for seed in range(8):
            motion = MotionComponents(
                waves(10.0, 0.01, peak, seed=2 * seed),
                y=waves(10.0, 0.01, peak, seed=2 * seed + 1),
            )
            found.append(
                time_history(of, motion, settings).max_column_force * of.columns / weight
            )
        return float(np.median(found))

    with_floors = [median(t_c, 0.1) for t_c in (5e-4, 2e-3, 1e-2)]
    assert max(with_floors) < 1.15 * min(with_floors)
    left_out = [median(t_c, None) for t_c in (5e-4, 1e-2)]
    assert max(left_out) < 1.15 * min(left_out)
    assert max(left_out) < min(with_floors)


@pytest.mark.evidence("forces in columns, friction", "exact")
def test_limits_are_refused_for_what_is_left_out():
    known, unknown = on_floors(0.1), on_floors(None)
    assert "passes shorter than 25 ms (superstructure.vertical_period)" in no_bound(
        "max_column_shear", unknown
    )
    for name in ("max_column_shear", "max_column_force"):  # the mean of all columns
        assert "(podium.plan, with y)" in no_bound(name, known)
    assert no_bound("max_column_shear", replace(known, rows=(0, 5), rows_y=(0, 8))) == ""
    for of in (known, unknown):
        assert "(podium.plan, with y)" in no_bound("max_column_force", of)
    assert no_bound("max_rotation", unknown) == ""
    assert "passes shorter than 25 ms" in no_bound("max_column_force", podium(0))
