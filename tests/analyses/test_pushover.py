"""Capacity curves: statics of the storey, and of the building that it carries."""

import numpy as np
import pytest
from conformance import conforms
from hypothesis import given
from hypothesis import strategies as st
from paper_structures import FLAT, building, known, podium, yielding

from rpscli.analyses.pushover import PATTERNS, load_pattern, pushover
from rpscli.model.superstructure import RayleighDamping, Superstructure, stiffness_matrix


@pytest.mark.evidence("pushover", "exact")
@pytest.mark.parametrize("rho", [FLAT, 0.26, 0.5, 1.5])
@pytest.mark.parametrize("storeys", [0, 3])
def test_storey_curve(storeys, rho):
    structure = podium(storeys, 0.15, rho)
    result = pushover(structure, points=401)
    curve, W = result.curve, structure.weight
    assert curve.rotation[0] == curve.displacement[0] == curve.lift[0] == 0.0
    assert curve.force[0] == pytest.approx(result.uplift_force, rel=1e-13)
    conforms(
        "pushover", "uplift force [N]", W * 0.15, curve.force[0], 1e-13 * W,
        "closed form", "W tan(alpha)",
    )  # fmt: skip
    assert curve.rotation[-1] == result.critical_rotation == structure.critical_rotation
    assert curve.displacement[-1] == result.critical_displacement
    assert abs(curve.force[-1]) < 1e-12 * W
    assert np.all(np.diff(curve.displacement) > 0.0)
    assert np.all(curve.force[:-1] > 0.0)
    # int F du_b = W v_b; trapezoids over 400 parts: 1/12/400^2 of a smooth curve
    work = np.trapezoid(curve.force, curve.displacement)
    raised = W * curve.lift[-1]
    conforms(
        "pushover", "work up to theta_cr [J]", raised, work, 2e-5 * raised,
        "identity", "integral of F du_b = W v_b",
    )  # fmt: skip
    beta = structure.bearing.beta
    rolls_then_rocks = 0.0 < beta < structure.critical_rotation
    assert len(curve.rotation) == (402 if rolls_then_rocks else 401)
    assert (beta in curve.rotation) is (rolls_then_rocks or rho == FLAT)


@pytest.mark.evidence("pushover", "published")
def test_figure_1_of_the_paper():
    """Slope after uplift: negative, zero, positive for rho < 0.5, = 0.5, > 0.5."""
    slopes = []
    for rho in (FLAT, 0.3, 0.5, 0.7, 1.5):
        structure = podium(0, 0.10, rho)
        result = pushover(structure)
        curve = result.curve
        slope = (curve.force[1] - curve.force[0]) / curve.displacement[1]
        assert slope == pytest.approx(
            result.initial_stiffness, abs=0.02 * structure.weight / 3.0
        )
        slopes.append(result.initial_stiffness / (structure.weight / 3.0))
    assert np.all(np.diff(slopes) > 0.0)
    conforms(
        "pushover", "slopes after uplift over W/2R, five rho",
        [-1.0, -0.4, 0.0, 0.4, 2.0], slopes, 0.05, "published", "2 rho - 1, Figure 1c",
    )  # fmt: skip


@pytest.mark.evidence("pushover", "exact")
@pytest.mark.parametrize("pattern", PATTERNS)
def test_capacity_is_elastic_to_uplift_and_the_storey_beyond(pattern):
    structure = podium(4, 0.15, 0.5)
    above = known(structure.superstructure)
    result = pushover(structure)
    capacity = next(c for c in result.capacity if c.pattern == pattern)
    assert capacity.forces.sum() == pytest.approx(1.0, rel=1e-14)
    assert capacity.sum_of_floor_forces[0] == capacity.roof_displacement[0] == 0.0
    # up to uplift the building alone yields, on a fixed base
    shears = np.cumsum(capacity.forces[::-1])[::-1]
    sway = float(np.sum(shears / above.stiffnesses))
    assert capacity.sum_of_floor_forces[1] == pytest.approx(
        structure.uplift_force, rel=1e-13
    )
    uplift = structure.uplift_force * sway
    conforms(
        "pushover", "roof displacement at uplift [m]", uplift,
        capacity.roof_displacement_at_uplift, 1e-12 * uplift,
        "hand calculation", "storeys in series under the forces",
    )  # fmt: skip
    assert capacity.roof_displacement[1] == pytest.approx(uplift, rel=1e-12)
    # beyond, it is carried along and unloads with the storey
    assert capacity.sum_of_floor_forces[1:].tolist() == result.curve.force.tolist()
    assert (
        capacity.cap_beam_displacement[1:].tolist() == result.curve.displacement.tolist()
    )
    expected = capacity.cap_beam_displacement + capacity.sum_of_floor_forces * sway
    assert capacity.roof_displacement == pytest.approx(expected, rel=1e-12)
    assert capacity.roof_displacement[-1] == pytest.approx(
        result.critical_displacement, rel=1e-9
    )


def event_to_event(above, forces, most):
    """Roof under floor forces lambda p: tangent stiffness from one storey's yield to the next."""
    forces_at_yield = known(above.strengths) / forces[::-1].cumsum()[::-1]
    events = sorted(F for F in [*forces_at_yield, most] if most >= F)
    stiffnesses, roof, pushed = above.stiffnesses.copy(), 0.0, 0.0
    for force in events:
        tangent = stiffness_matrix(stiffnesses)
        roof += (force - pushed) * np.linalg.solve(tangent, forces)[-1]
        pushed = force
        yields = forces_at_yield <= force
        stiffnesses = np.where(
            yields, above.hardening * above.stiffnesses, above.stiffnesses
        )
    return roof


@pytest.mark.evidence("pushover", "exact")
@pytest.mark.parametrize("pattern", PATTERNS)
@pytest.mark.parametrize(
    ("rho", "ratio"), [(FLAT, 1.1), (0.5, 1.1), (1.5, 1.45), (1.5, 1.1)]
)
def test_storeys_that_yield_bend_the_curve(pattern, rho, ratio):
    """Before columns lift and after; as the force falls storeys unload elastically."""
    static = podium(3).static_base_shear
    above = yielding(building(3), ratio * static, hardening=0.2)
    result = pushover(
        podium(3, 0.15, rho, superstructure=above), patterns=[pattern], points=2001
    )
    (curve,) = result.capacity
    pushed, own = (
        curve.sum_of_floor_forces,
        curve.roof_displacement - curve.cap_beam_displacement,
    )
    highest = int(pushed.argmax())
    points = range(1, highest + 1, 97)
    wanted = np.array(
        [event_to_event(above, curve.forces, float(pushed[p])) for p in points]
    )
    conforms(
        "pushover", "roof over the beam of storeys that yield [m]", wanted, own[points],
        1e-10 * wanted, "closed form", "tangent stiffness from event to event",
    )  # fmt: skip
    sway = float(np.linalg.solve(above.stiffness_matrix, curve.forces)[-1])
    fallen, most = (
        pushed[highest] - pushed[highest:],
        2.0 * min(known(curve.yield_forces)),
    )
    unloads = own[highest] - sway * fallen
    assert own[highest:][fallen < most] == pytest.approx(
        unloads[fallen < most], abs=1e-12
    )
    assert np.all(
        own[highest:][fallen > most + 1e3] < unloads[fallen > most + 1e3]
    )  # yields back
    weak = {
        storey for storey, force in curve.yielding.items() if force < result.uplift_force
    }
    assert "".join(result.warnings).count(f"({pattern})") == len(weak)
    assert (len(weak) > 0) == (ratio == 1.1 or pattern == "triangular")
    assert len(curve.yielding) >= (1 if rho == 1.5 else len(weak))


def test_without_hardening_the_curve_ends_as_a_mechanism():
    structure = podium(3)
    above = yielding(building(3), 1.1 * structure.static_base_shear, 0.0)
    result = pushover(podium(3, superstructure=above), patterns=["uniform"])
    (curve,) = result.capacity
    assert curve.sum_of_floor_forces[-1] == pytest.approx(
        1.1 * structure.static_base_shear
    )
    assert np.isnan(curve.roof_displacement_at_uplift)
    assert curve.cap_beam_displacement.max() == 0.0
    assert list(curve.yielding) == [1]
    assert "does not protect storey 1" in result.warnings[0]
    equal = yielding(building(3), (1.0 - 1e-12) * structure.uplift_force, 0.0)
    at_uplift = pushover(podium(3, superstructure=equal), patterns=["uniform"])
    assert np.isfinite(at_uplift.capacity[0].roof_displacement_at_uplift)
    assert at_uplift.warnings == ()
    strong = yielding(building(3), 2.0 * structure.static_base_shear, 0.0)
    (whole,) = pushover(podium(3, superstructure=strong), patterns=["uniform"]).capacity
    (elastic,) = pushover(structure, patterns=["uniform"]).capacity
    assert whole.yielding == {}
    assert whole.roof_displacement.tolist() == elastic.roof_displacement.tolist()
    assert "yield_forces" not in pushover(structure).results()["capacity"][0]


def test_patterns():
    masses, heights = np.array([3.0, 1.0, 2.0]), np.array([4.0, 3.0, 3.0])
    k = np.array([9.0, 7.0, 5.0])
    above = Superstructure(masses, k, RayleighDamping(0.05), heights)
    assert load_pattern(above, "uniform") == pytest.approx(masses / 6.0)
    moments = masses * np.array([4.0, 7.0, 10.0])
    assert load_pattern(above, "triangular") == pytest.approx(moments / moments.sum())
    without = Superstructure(masses, k, RayleighDamping(0.05))
    counted = masses * np.array([1.0, 2.0, 3.0])
    assert load_pattern(without, "triangular") == pytest.approx(counted / counted.sum())
    # inertia forces of free vibration in the first mode bend the building into that mode
    bent = np.linalg.solve(above.stiffness_matrix, load_pattern(above, "first_mode"))
    expected = above.shapes[:, 0] / above.shapes[-1, 0]
    conforms(
        "pushover", "building bent by the pattern of its first mode", expected,
        bent / bent[-1], 1e-12 * expected, "identity", "inertia forces of free vibration",
    )  # fmt: skip
    assert load_pattern(above, [0.0, 0.0, 5.0]).tolist() == [0.0, 0.0, 1.0]


@given(st.lists(st.floats(-5.0, 5.0), min_size=3, max_size=3))
def test_any_pattern_that_pushes_is_scaled_to_one(forces):
    above = building(3)
    if sum(forces) <= 0.0:
        with pytest.raises(ValueError, match="sum > 0"):
            load_pattern(above, forces)
    elif sum(forces) > 1e-9:
        assert load_pattern(above, forces).sum() == pytest.approx(1.0, rel=1e-6)


@pytest.mark.parametrize(
    "forces", [[1.0, 1.0], [], [1.0, 1.0, float("nan")], [1.0, 0.0, -1.0]]
)
def test_patterns_that_do_not_fit_are_refused(forces):
    with pytest.raises(ValueError, match="must be 3 floor forces"):
        pushover(podium(3), patterns=[forces])


def test_a_given_pattern_is_called_given_and_a_frame_has_no_capacity_curve():
    (capacity,) = pushover(podium(2), patterns=[[1.0, 3.0]]).capacity
    assert capacity.pattern == "given"
    assert capacity.forces.tolist() == [0.25, 0.75]
    assert pushover(podium(0)).capacity == ()
