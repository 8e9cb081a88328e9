"""What a history says of its devices: samples, largest demands, energy, tables."""

from dataclasses import replace

import numpy as np
import pytest
from paper_structures import known, needs_compiled_kernels, podium, waves

from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.bearing import Bearing
from rpscli.model.devices import (
    FrictionDamper,
    RollingResistance,
    Stop,
    Tendon,
    ViscousDamper,
)
from rpscli.model.podium import PodiumStructure
from rpscli.physics.state import FULL_CONTACT, ROCKING, ROLLING, STUCK
from rpscli.records.loading import load_record
from rpscli.report.bundles import history_columns
from rpscli.report.timehistory import timehistory_document, timehistory_tables

F_D, P, K_T, P_Y, C, A, GAP, K_S, C_S = 3e5, 5e4, 1e7, 1.5e5, 3e5, 0.5, 0.05, 2e7, 3e5
STRUCTURE = replace(
    podium(3, 0.15, 0.5),
    devices=(
        FrictionDamper(F_D),
        Tendon(P, K_T, P_Y),
        ViscousDamper(C, A),
        Stop(GAP, K_S, C_S),
        RollingResistance(2e-3),
    ),
    columns=4,
)
RECORD = waves(6.0, 0.01, 6.0, seed=12)
SETTINGS = TimeHistorySettings(free_vibration=1.0)


@pytest.fixture(scope="module")
def result():
    return time_history(STRUCTURE, RECORD, SETTINGS)


def test_everything_happens(result):
    kinds = {event.kind for event in result.events}
    assert {"sticking", "sliding", "stop_met", "stop_left", "tendon_yielding"} <= kinds
    assert {FULL_CONTACT, ROLLING, ROCKING, STUCK} >= set(result.trace.phase.tolist())
    assert STUCK in result.trace.phase


def test_base_shear_over_that_at_uplift_with_devices(result):
    """W tan(alpha), tendons, friction and rolling resistance at the cap beam, by hand."""
    s, b = STRUCTURE, STRUCTURE.bearing
    force = (s.weight + 4 * P) * 0.15 + F_D + s.weight * 2e-3 / b.half_height
    shear = s.superstructure_mass * force / (s.weight / s.gravity)
    assert result.uplift_shear_ratio == pytest.approx(
        result.max_base_shear / shear, rel=1e-12
    )
    static = s.superstructure_mass * s.gravity * 0.15
    assert result.base_shear_ratio == pytest.approx(
        result.max_base_shear / static, rel=1e-12
    )


def test_the_audit_closes_at_every_sample(result):
    t = result.trace
    given = t.energy_input + t.energy_stored[0]
    gone = t.energy_damped + t.energy_impact + t.devices.energy.sum(axis=1)
    left = np.abs(given - gone - t.energy_stored)
    assert np.max(left) < 2e-8 * np.max(np.abs(t.energy_input))
    assert result.energy.devices == pytest.approx(t.devices.energy[-1].sum())


def test_forces_obey_the_laws(result):
    t = result.trace
    moves = (t.phase == ROLLING) | (t.phase == ROCKING)
    friction, tension, viscous, stop, rolling = t.devices.force.T
    rate = t.rotation_rate
    velocity = STRUCTURE.lever_arm(np.abs(t.rotation)) * rate
    assert friction[moves] == pytest.approx(-F_D * np.sign(rate[moves]))
    assert np.all(np.abs(friction) <= F_D * (1.0 + 1e-12))
    rests = t.phase == FULL_CONTACT
    assert not rolling[rests].any()
    assert viscous == pytest.approx(
        -C * np.sign(velocity) * np.abs(velocity) ** A, abs=1e-3
    )
    assert np.all((tension >= 0.0) & (tension <= P_Y * (1.0 + 1e-9)))
    u = t.cap_beam_displacement
    assert not stop[np.abs(u) < GAP].any()
    assert np.all(stop * u <= 0.0)
    assert np.all(np.abs(rolling[moves]) > 0.0)
    elongation = STRUCTURE.bearing.tendon_elongation(t.rotation)
    assert t.devices.displacement[:, 1] == pytest.approx(elongation, abs=1e-12)
    assert t.devices.displacement[:, 0] == pytest.approx(u, abs=1e-12)


def test_contact_forces_are_those_of_the_kernel(result):
    """The kernel looks at the same samples, at both ends of what is stuck, and between."""
    t = result.trace
    top = np.max(np.abs(t.shear_top / t.normal_top))
    assert 1.0 - 1e-6 <= result.history.friction_top / top <= 1.05
    weight = (STRUCTURE.cap_beam_mass + STRUCTURE.superstructure_mass) * STRUCTURE.gravity
    least = np.min(t.normal_top) / weight
    assert 0.95 <= result.history.normal_top / least <= 1.0 + 1e-6
    assert t.normal_top[0] == pytest.approx(weight + 4.0 * P)


def test_largest_demands_cover_the_samples(result):
    t = result.trace.devices
    demands = result.devices
    assert [d.kind for d in demands][:2] == ["friction", "tendon"]
    for i, found in enumerate(demands):
        assert found.force >= np.max(np.abs(t.force[:, i])) * (1.0 - 1e-9)
        assert found.stroke >= np.max(np.abs(t.displacement[:, i])) * (1.0 - 1e-9)
        assert found.energy == pytest.approx(t.energy[-1, i])
    assert demands[1].force == pytest.approx(P_Y)
    remaining = known(demands[1].remaining_prestress)
    assert result.lost_prestress == pytest.approx(1.0 - remaining / P)
    assert result.max_stop_force == demands[3].force
    assert result.max_damper_force == max(demands[0].force, demands[2].force)


def test_tables_and_documents(result):
    names = {column.name: list(column.values) for column in history_columns(result)}
    assert names["device_1_tendon_force"] == result.trace.devices.force[:, 1].tolist()
    document = timehistory_document(result)
    assert [entry["kind"] for entry in document["devices"]] == [
        d.kind for d in result.devices
    ]
    assert document["energy"]["devices"] == result.energy.devices
    assert len(list(timehistory_tables(result, [], "x"))) >= 4


def test_without_devices_there_is_nothing_to_tell():
    bare = time_history(replace(STRUCTURE, devices=()), RECORD, SETTINGS)
    assert bare.devices == ()
    assert bare.uplift_shear_ratio is None
    assert bare.max_damper_force is bare.max_stop_force is bare.lost_prestress is None
    assert bare.energy.devices == 0.0
    assert timehistory_document(bare)["devices"] == []


@needs_compiled_kernels
@pytest.mark.parametrize("accuracy", [1.0, 2.0, 4.0, 8.0])
def test_a_tendon_that_yielded_unloads_when_the_tilt_turns(accuracy):
    """However short the step after the turn, in which its margin is rounding."""
    trace = time_history(STRUCTURE, RECORD, replace(SETTINGS, accuracy=accuracy)).trace
    tension, elongation = trace.devices.force[:, 1], trace.devices.displacement[:, 1]
    yields = tension >= P_Y * (1.0 - 1e-9)
    assert yields.any()
    assert not (yields[1:] & (elongation[1:] < elongation[:-1])).any()


@needs_compiled_kernels
@pytest.mark.parametrize("device", [None, *STRUCTURE.devices])
def test_steps_are_as_good_as_without_devices(device):
    """The order holds through the events of every device."""
    devices = STRUCTURE.devices if device is None else (device,)
    structure = replace(STRUCTURE, devices=devices)
    coarse, fine = (
        time_history(
            structure, RECORD, TimeHistorySettings(free_vibration=0.0, accuracy=accuracy)
        )
        for accuracy in (2.0, 8.0)  # the powers of dampers are linear up to less and less
    )
    assert coarse.max_rotation == pytest.approx(fine.max_rotation, rel=1e-8)
    assert coarse.max_base_shear == pytest.approx(fine.max_base_shear, rel=3e-5)
    residuals = [
        abs(result.energy.residual) / result.energy.input for result in (coarse, fine)
    ]
    assert residuals[0] < 1e-8
    assert residuals[1] < max(residuals[0] / 4.0**5, 2e-11)  # or rounding


@needs_compiled_kernels
@pytest.mark.parametrize("exponent", [0.5, 0.8, 1.0])
def test_dampers_below_their_linear_range_are_told(exponent):
    """On ends that roll, in small motions; there a larger accuracy moves the maximum."""
    motion = load_record("synthetic:?pga=0.3g&seed=1&duration=8&dt=0.01")
    damper = ViscousDamper(2e4, exponent)
    made = PodiumStructure(Bearing(1.5, 0.0, 0.3, 1.0), 4e4, 4e5, devices=(damper,))

    def found(factor, accuracy=1.0):
        settings = TimeHistorySettings(free_vibration=2.0, accuracy=accuracy)
        return time_history(made, motion.scaled(factor), settings)

    def told(result):
        (said,) = [text for text in result.warnings if "exponent below 1" in text] or [""]
        return said

    small, large = found(1e-4), found(1.0)
    assert 0.0 < small.rotation_ratio < 1e-4 < large.rotation_ratio
    assert bool(told(small)) == (exponent < 1.0)
    assert not told(large)
    if exponent == 0.5:  # 8e-4 of it at 1.3e-6 of the critical rotation
        assert "podium.devices.0" in told(small)
        moved = small.max_rotation / found(1e-4, 16.0).max_rotation - 1.0
        assert 1e-4 < abs(moved) < 5e-3
        assert abs(large.max_rotation / found(1.0, 16.0).max_rotation - 1.0) < 1e-7
