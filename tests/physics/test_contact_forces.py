"""Forces between columns, ground and beam by Newton's law for every mass; maxima of floors."""

import numpy as np
import pytest
from conformance import conforms
from oracles.storey_lagrangian import StoreyLagrangian
from paper_structures import (
    FLAT,
    block,
    building,
    ground,
    needs_compiled_kernels,
    oracle_system,
    podium,
    stillness,
    waves,
)

from rpscli.analyses.kernels.history import sampled_history
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import denser_trace, time_history
from rpscli.analyses.trace import trace_of
from rpscli.model.superstructure import ModalDamping, RayleighDamping
from rpscli.physics.state import FULL_CONTACT, IMPACT
from rpscli.records.ground_motion import MotionComponents

DT = 0.005
RECORD, VERTICAL = waves(1.5, DT, 4.0, seed=2), waves(1.5, DT, 3.0, seed=3)


@pytest.mark.evidence("forces in columns, friction", "exact")
@pytest.mark.parametrize(
    "structure",
    [podium(0, 0.15, 0.5), podium(2, 0.15, FLAT), podium(3, 0.15, 0.5)],
    ids=lambda s: f"{s.storeys}-{s.bearing.curvature_ratio}",
)
def test_demands_are_newtons_sums_over_all_masses(structure):
    settings = TimeHistorySettings(free_vibration=0.0)
    run = sampled_history(structure, MotionComponents(RECORD, VERTICAL), settings)
    samples, history, above = run.samples, run.history, structure.superstructure
    assert history.events[IMPACT] > 0
    # u_b and v_b, their rates and accelerations by the chain rule (Theory, section 8)
    lagrangian = StoreyLagrangian(oracle_system(structure))
    rate, acceleration = samples.theta_dot, samples.theta_ddot
    side = np.sign(samples.theta) + (samples.theta == 0.0) * np.sign(acceleration)
    w, slope, bend = np.array([
        lagrangian.cap_beam(abs(x), rolling=abs(x) < structure.bearing.beta) for x in samples.theta
    ]).T  # fmt: skip
    moved = (slope * acceleration + side * bend * rate**2) * (
        samples.phase != FULL_CONTACT
    )
    u_b, v_b = moved.real, side * moved.imag
    a_h, a_v = RECORD.acceleration, VERTICAL.acceleration
    beam, columns, g = structure.cap_beam_mass, structure.columns_mass, structure.gravity
    floors = np.zeros(len(samples))
    if above is not None:
        base_rate = slope.real * rate * (samples.phase != FULL_CONTACT)
        pull = (run.floors[:, 0] - (side * w.real)[:, None]) @ above.stiffness_matrix
        pull += (run.floors[:, 1] - base_rate[:, None]) @ above.damping_matrix
        floors = -pull.sum(axis=1)  # masses times u'' + a_g of each floor by itself
    shear_top = floors + beam * (u_b + a_h)
    shear_bottom = shear_top + columns * (0.5 * u_b + a_h)
    carried = beam + structure.superstructure_mass
    normal_top = carried * (g + a_v + v_b)
    normal_bottom = normal_top + columns * (g + a_v + 0.5 * v_b)
    ends = (
        (shear_top, normal_top, carried),
        (shear_bottom, normal_bottom, carried + columns),
    )
    friction = np.array([np.max(np.abs(shear) / normal) for shear, normal, _ in ends])
    normal = np.array([np.min(normal) / (mass * g) for _, normal, mass in ends])
    found = np.array([history.friction_top, history.friction_bottom])
    least = np.array([history.normal_top, history.normal_bottom])
    # sums in another order, sines of |theta| by another series; between samples there is more
    assert np.all(found >= (1.0 - 1e-11) * friction)
    assert np.all(least <= (1.0 + 1e-11) * normal)
    assert found == pytest.approx(friction, rel=0.02)
    assert least == pytest.approx(normal, rel=0.05)
    trace = trace_of(structure, run)
    for where, (shear, pressure, _) in zip(("top", "bottom"), ends, strict=True):
        for kind, known in (("shear", shear), ("normal", pressure)):
            ours = getattr(trace, f"{kind}_{where}")
            conforms(
                "forces in columns, friction", f"{kind} at the {where} [N]", known, ours,
                1e-11 * carried * g, "identity", "Newton's law for each mass",
            )  # fmt: skip


@pytest.mark.evidence("forces in columns, friction", "exact")
def test_a_block_that_begins_to_rock_needs_the_friction_of_its_slope():
    """Quasi-static: F = N tan(alpha), at the bottom; nothing rests on a free block."""
    structure = block(0.15, 1.0)
    peak = -1.0000001 * structure.uplift_acceleration
    result = time_history(
        structure, ground([0.0, peak, 0.0], 0.1), TimeHistorySettings(free_vibration=0.0)
    )
    assert result.uplifts == 1
    conforms(
        "forces in columns, friction", "friction demand of a block", 0.15,
        result.friction_demand, 1.5e-7, "closed form", "F = N tan(alpha)",
    )  # fmt: skip
    assert (result.history.friction_top, result.history.normal_top) == (0.0, np.inf)


@pytest.mark.evidence("forces in columns, friction", "exact")
def test_a_falling_ground_takes_the_contact_away_and_the_user_is_told():
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
def test_maxima_are_those_of_a_dense_trace(storeys, rho, damping):
    """None of those that the search leaves unformed would have been larger."""
    structure = podium(
        storeys, 0.15, rho, superstructure=building(storeys, damping=damping)
    )
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
