"""Forces between columns, ground and beam, against Newton's law for every mass."""

from __future__ import annotations

import numpy as np
import pytest
from paper_structures import FLAT, Array, block, ground, podium, stillness, waves

from rpscli.analyses.kernels.history import SampledHistory, sampled_history
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.analyses.trace import trace_of
from rpscli.model.podium import PodiumStructure
from rpscli.physics.geometry import path_along
from rpscli.physics.state import FULL_CONTACT, IMPACT
from rpscli.records.ground_motion import MotionComponents

pytestmark = pytest.mark.evidence("forces in columns, friction", "exact")

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


def test_the_chain_rule_follows_the_stored_motion() -> None:
    """Second differences of u_b and v_b, away from events, are their accelerations."""
    structure = podium(2, 0.15, 0.5)
    run = stored_samples(structure)
    bearing, theta = structure.bearing, run.samples.theta
    _, _, u, v = path_along(bearing.rolling, bearing.rocking, bearing.beta, np.abs(theta))
    diameter = 2.0 * bearing.semi_diagonal
    paths = diameter * np.sign(theta) * u, diameter * v
    phase = run.samples.phase
    same = (phase[2:] == phase[:-2]) & (phase[1:-1] == phase[2:]) & (phase[2:] > 0)
    same &= (np.sign(theta[2:]) == np.sign(theta[:-2])) & (np.abs(theta[1:-1]) > 0.01)
    assert same.sum() > 50
    for path, acceleration in zip(paths, base_accelerations(structure, run), strict=True):
        difference = (path[2:] - 2.0 * path[1:-1] + path[:-2]) / DT**2
        # order 2: (w dt)^2/12 of the fastest mode, w = 90 rad/s
        error = np.abs(difference - acceleration[1:-1])[same]
        assert np.max(error) < 0.03 * np.max(np.abs(acceleration))


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
