"""Full contact is the linear fixed-base building."""

import numpy as np
import pytest
from conformance import conforms
from paper_structures import building, ground, linear_response, podium, waves

from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.superstructure import ModalDamping, RayleighDamping

BUILDINGS = [
    building(1),
    building(3),
    building(9),
    building(3, damping=ModalDamping(0.03)),
    building(3, damping=RayleighDamping(0.0)),
    building(2, damping=RayleighDamping(1.4)),  # both modes overdamped
    building(30),
]


of_buildings = pytest.mark.parametrize(
    "above", BUILDINGS, ids=lambda b: f"{b.storeys}-{b.damping}"
)


def by_lsim(quantity, expected, found, within):
    conforms(
        "buildings on bearings under earthquakes", f"{quantity} in full contact", expected,
        found, within, "closed form", "scipy.signal.lsim, exact for linear pieces",
    )  # fmt: skip


@pytest.mark.evidence("buildings on bearings under earthquakes", "exact")
@of_buildings
def test_full_contact_equals_lsim(above):
    n, dt = above.storeys, 0.02
    record = waves(4.0, dt, 0.2, seed=n)
    settings = TimeHistorySettings(free_vibration=1.0)
    result = time_history(podium(n, superstructure=above), record, settings)
    assert result.outcome == "at_rest"
    M, C, K = above.mass_matrix, above.damping_matrix, above.stiffness_matrix
    a_g = np.pad(record.acceleration, (0, 50))
    u, du = np.split(linear_response(M, C, K, above.masses, a_g, dt), 2, axis=1)
    # the reference is exact for a load linear between samples; steps err by some (w h)^7/1e5 of the
    # highest mode, which has a small part
    tolerance = 1e-8 * float(np.max(np.abs(u)))
    by_lsim("floor displacements [m]", u, result.trace.floor_displacements, tolerance)
    shears = above.stiffnesses * np.diff(u, axis=1, prepend=0.0)
    size = float(np.max(np.abs(shears)))
    by_lsim("storey shears [N]", shears, result.trace.storey_shears, 1e-6 * size)
    sampled = np.max(np.abs(shears), axis=0)
    assert np.all(result.storey_shears >= (1.0 - 1e-6) * sampled)
    assert result.storey_shears == pytest.approx(sampled, rel=0.05)
    absolute = -(u @ K + du @ C) / above.masses
    size = float(np.max(np.abs(absolute)))
    found = result.trace.floor_accelerations
    by_lsim("floor accelerations [m/s2]", absolute, found, 1e-5 * size)
    sampled = np.max(np.abs(absolute), axis=0)
    assert np.all(result.floor_accelerations >= (1.0 - 1e-5) * sampled)
    assert result.floor_accelerations == pytest.approx(sampled, rel=0.1)


@of_buildings
def test_the_fixed_base_yardstick_is_the_same_building(above):
    record = waves(4.0, 0.02, 0.2, seed=4)
    result = time_history(podium(above.storeys, superstructure=above), record)
    assert result.outcome == "at_rest"
    assert result.fixed_base is not None
    fixed, trace = result.fixed_base, result.trace
    size = float(np.max(np.abs(fixed.floor_displacements)))
    assert trace.floor_displacements == pytest.approx(
        fixed.floor_displacements, abs=1e-8 * size
    )
    # peaks between the ends of steps, which are not the same
    assert result.storey_shears == pytest.approx(fixed.storey_shears, rel=1e-4)
    assert result.floor_accelerations == pytest.approx(
        fixed.floor_accelerations, rel=1e-3
    )
    assert fixed.drifts == pytest.approx(result.max_drifts, rel=1e-4)
    assert fixed.base_shear == pytest.approx(result.max_base_shear, rel=1e-4)


MORE = [
    building(2, 1.0, RayleighDamping(1.0)),
    building(25, damping=RayleighDamping(1.0, (1, 1))),  # 32 in the highest mode
    building(3, damping=ModalDamping(0.0)),
    building(9, damping=ModalDamping(4.0)),
]


@pytest.mark.evidence("buildings on bearings under earthquakes", "exact")
@pytest.mark.parametrize(
    "above", BUILDINGS + MORE, ids=lambda b: f"{b.storeys}-{b.damping}"
)
@pytest.mark.parametrize("dt", [0.02, 0.05])
def test_the_energy_of_full_contact_is_accounted_for(above, dt):
    record = waves(4.0, dt, 0.2, seed=4)
    result = time_history(podium(above.storeys, superstructure=above), record)
    energy = result.energy
    assert energy.impact == energy.created == 0.0
    assert energy.input > 0.0
    # a step loses 1e-5 (w h)^8 of a vibration; the highest mode has a small part
    conforms(
        "steps, events, energy", "residual over the input in full contact", 0.0,
        energy.residual / energy.input, 1e-8, "identity", "balance of energy",
    )  # fmt: skip
    if above.damping.ratio == 0.0:
        assert energy.damped == 0.0


@pytest.mark.parametrize("slenderness", [0.05, 0.07, 0.1, 0.13, 0.15, 0.2, 0.3])
@pytest.mark.parametrize("excess", [-1e-15, 0.0, 1e-15])
def test_a_peak_that_equals_the_limit_is_full_contact(slenderness, excess):
    frame = podium(0, slenderness, 0.5)
    limit = frame.uplift_acceleration * (1.0 + excess)
    for shape in ([0.0, 0.5, 1.0, 0.5], [0.0, 1.0, 1.0, 1.0], [0.0, -1.0, 1.0, -1.0]):
        result = time_history(frame, ground(np.multiply(shape, limit), 0.1))
        assert (result.outcome, result.uplifts) == ("at_rest", 0)


@pytest.mark.parametrize("excess", [1e-12, 1e-10, 1e-8, 1e-6, 1e-4])
def test_a_peak_beyond_the_limit_uplifts_and_lands(excess):
    frame = podium(0, 0.15, 0.5)
    limit = frame.uplift_acceleration * (1.0 + excess)
    result = time_history(frame, ground(np.multiply([0.0, 0.5, 1.0, 0.5], limit), 0.1))
    assert (result.outcome, result.uplifts) == ("survived", 1)
