"""Forces between columns, ground and beam by Newton's law for every mass; maxima of floors."""

from __future__ import annotations

import numpy as np
import pytest
from paper_structures import (
    FLAT,
    Array,
    block,
    building,
    ground,
    needs_compiled_kernels,
    podium,
    stillness,
    waves,
)

from rpscli.analyses.kernels.history import SampledHistory, sampled_history
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import denser_trace, time_history
from rpscli.analyses.trace import trace_of
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import ModalDamping, RayleighDamping
from rpscli.physics.geometry import path_along
from rpscli.physics.state import FULL_CONTACT, IMPACT
from rpscli.records.ground_motion import MotionComponents

DT = 0.005
RECORD, VERTICAL = waves(1.5, DT, 4.0, seed=2), waves(1.5, DT, 3.0, seed=3)


def stored_samples(structure: PodiumStructure) -> SampledHistory:
    """The kernel's samples under both components, and its demands."""
    settings = TimeHistorySettings(free_vibration=0.0)
    run = sampled_history(structure, MotionComponents(RECORD, VERTICAL), settings)
    assert run.history.events[IMPACT] > 0
    return run


def base_accelerations(structure: PodiumStructure, run: SampledHistory) -> tuple[Array, Array]:
    """u_b'' and v_b'' by the chain rule on u_b(theta), v_b(theta) (Theory, section 8)."""
    bearing, samples = structure.bearing, run.samples
    theta, rate, acceleration = samples.theta, samples.theta_dot, samples.theta_ddot
    side, x = np.sign(theta), np.abs(theta)
    B, C, _, _ = path_along(bearing.rolling, bearing.rocking, bearing.beta, x)
    falls = np.where(x < bearing.beta, bearing.rolling.c, 0.0) - C
    lean = side + (theta == 0.0) * np.sign(acceleration)
    diameter = 2.0 * bearing.semi_diagonal
    moving = samples.phase != FULL_CONTACT
    u = diameter * (C * acceleration + lean * B * rate**2)
    v = diameter * (lean * B * acceleration + falls * rate**2)
    return u * moving, v * moving


@pytest.mark.evidence("forces in columns, friction", "exact")
@pytest.mark.parametrize(
    "structure", [podium(0, 0.15, 0.5), podium(2, 0.15, FLAT), podium(3, 0.15, 0.5)], ids=str
)
def test_demands_are_newtons_sums_over_all_masses(structure: PodiumStructure) -> None:
    run = stored_samples(structure)
    samples, history, above = run.samples, run.history, structure.superstructure
    u_b, v_b = base_accelerations(structure, run)
    a_h, a_v = RECORD.acceleration, VERTICAL.acceleration
    beam, columns, g = structure.cap_beam_mass, structure.columns_mass, structure.gravity
    floors = np.zeros(len(samples))
    if above is not None:
        bearing = structure.bearing
        _, C, path, _ = path_along(
            bearing.rolling, bearing.rocking, bearing.beta, np.abs(samples.theta)
        )
        base = 2.0 * bearing.semi_diagonal * np.sign(samples.theta) * path
        base_rate = 2.0 * bearing.semi_diagonal * C * samples.theta_dot
        base_rate *= samples.phase != FULL_CONTACT
        u, du = run.floors[:, 0], run.floors[:, 1]
        pull = (u - base[:, None]) @ above.stiffness_matrix
        pull += (du - base_rate[:, None]) @ above.damping_matrix
        absolute = -pull / above.masses  # u'' + a_g of each floor by itself
        floors = absolute @ above.masses
    shear_top = floors + beam * (u_b + a_h)
    shear_bottom = shear_top + columns * (0.5 * u_b + a_h)
    normal_top = (beam + structure.superstructure_mass) * (g + a_v + v_b)
    normal_bottom = normal_top + columns * (g + a_v + 0.5 * v_b)
    weight = (beam + structure.superstructure_mass) * g
    friction = [
        np.max(np.abs(shear_top) / normal_top),
        np.max(np.abs(shear_bottom) / normal_bottom),
    ]
    normal = [np.min(normal_top) / weight, np.min(normal_bottom) / (weight + columns * g)]
    found = np.array([history.friction_top, history.friction_bottom])
    least = np.array([history.normal_top, history.normal_bottom])
    # sums in another order, sines of |theta| by another series; between samples there is more
    assert np.all(found >= (1.0 - 1e-11) * np.array(friction))
    assert np.all(least <= (1.0 + 1e-11) * np.array(normal))
    assert found == pytest.approx(friction, rel=0.02)
    assert least == pytest.approx(normal, rel=0.05)
    trace = trace_of(structure, run)
    for ours, known in (
        (trace.shear_top, shear_top),
        (trace.shear_bottom, shear_bottom),
        (trace.normal_top, normal_top),
        (trace.normal_bottom, normal_bottom),
    ):
        assert ours == pytest.approx(known, abs=1e-11 * weight)


@pytest.mark.evidence("forces in columns, friction", "exact")
def test_a_block_that_begins_to_rock_needs_the_friction_of_its_slope() -> None:
    """Quasi-static: F = N tan(alpha), at the bottom; nothing rests on a free block."""
    structure = block(0.15, 1.0)
    peak = -1.0000001 * structure.uplift_acceleration
    result = time_history(
        structure, ground([0.0, peak, 0.0], 0.1), TimeHistorySettings(free_vibration=0.0)
    )
    assert result.uplifts == 1
    assert result.friction_demand == pytest.approx(0.15, rel=1e-6)
    assert (result.history.friction_top, result.history.normal_top) == (0.0, np.inf)


@pytest.mark.evidence("forces in columns, friction", "exact")
def test_a_falling_ground_takes_the_contact_away_and_the_user_is_told() -> None:
    falling = ground(np.full(20, -1.2 * 9.80665), 0.01)
    result = time_history(
        podium(0, 0.15, 0.5), stillness(0.01), TimeHistorySettings(), vertical=falling
    )
    assert result.friction_demand == np.inf
    assert result.scalars()["friction_demand"] is None
    assert any("contact is lost" in warning for warning in result.warnings)
    # -0.2 while they stand, which they do for no time at all: their motion upwards adds 0.004
    assert any("-0.196 of the weight" in warning for warning in result.warnings)


@needs_compiled_kernels
@pytest.mark.parametrize("damping", [RayleighDamping(0.05), ModalDamping(0.02)], ids=str)
@pytest.mark.parametrize(("storeys", "rho"), [(1, FLAT), (4, 0.5), (7, 1.5), (11, FLAT)])
def test_maxima_are_those_of_a_dense_trace(
    storeys: int, rho: float, damping: RayleighDamping | ModalDamping
) -> None:
    """None of those that the search leaves unformed would have been larger."""
    structure = podium(storeys, 0.15, rho, superstructure=building(storeys, damping=damping))
    record = waves(10.0, 0.01, 2.5 * structure.uplift_acceleration, seed=3)
    result = time_history(structure, record, TimeHistorySettings(free_vibration=3.0))
    assert result.impacts > 10
    for trace, tolerance in ((result.trace, 0.1), (denser_trace(result, 5e-4), 2e-3)):
        shears = np.max(np.abs(trace.storey_shears), axis=0)
        accelerations = np.max(np.abs(trace.floor_accelerations), axis=0)
        # nothing is missed at a sample; stored ones are relative to the ground: u_b + v rounds v
        assert np.all(result.storey_shears >= (1.0 - 1e-3) * shears)
        assert result.storey_shears == pytest.approx(shears, rel=tolerance)
        assert result.floor_accelerations == pytest.approx(accelerations, rel=tolerance)
