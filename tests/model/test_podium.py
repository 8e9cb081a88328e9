"""The storey and its building as one structure: ratios, statics, limits."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from paper_structures import FLAT, building, known, podium
from scipy.integrate import quad

from rpscli.model.bearing import Bearing
from rpscli.model.contact import Contact
from rpscli.model.devices import FrictionDamper, RollingResistance, Stop, ViscousDamper
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import PodiumStructure

structures = st.builds(
    lambda n, tan_alpha, rho, size: podium(n, tan_alpha, rho, R=size),
    st.sampled_from([0, 2]),
    st.floats(0.05, 0.3),
    st.sampled_from([FLAT, 0.26, 0.5, 1.5]),
    st.floats(0.3, 5.0),
)


def test_ratios_of_the_paper():
    structure = podium(6, 0.15, 0.5)
    assert structure.gamma == 10.0
    assert structure.eta == pytest.approx(6.0, rel=1e-15)
    assert structure.gamma_total == pytest.approx(70.0, rel=1e-15)
    assert structure.superstructure_mass == pytest.approx(12e5)
    assert structure.restoring_mass == pytest.approx(1e4 + 2e5 + 12e5)
    assert structure.weight == pytest.approx(141e4 * 9.80665)
    assert structure.uplift_acceleration == pytest.approx(0.15 * 9.80665)
    assert structure.static_base_shear == pytest.approx(12e5 * 0.15 * 9.80665)
    assert structure.uplift_force == pytest.approx(structure.weight * 0.15)
    assert podium(0).eta == podium(0).static_base_shear == 0.0


@given(structures, st.floats(0.05, 1.5))
def test_the_force_does_the_work_of_lifting(structure, share):
    """Integral of F du_b = W v_b, across beta and beyond theta_cr."""
    bearing, end = structure.bearing, share * structure.critical_rotation
    diameter = 2.0 * bearing.semi_diagonal

    def power(x):
        force, _, _ = structure.path(np.array([x]))
        phase = bearing.rolling if x < bearing.beta else bearing.rocking
        C = phase.c + phase.p * math.sin(x) - phase.q * math.cos(x)
        return float(force[0]) * diameter * C

    points = [bearing.beta] if 0.0 < bearing.beta < end else None
    work, _ = quad(power, 0.0, end, points=points, epsabs=0.0, epsrel=1e-11)
    _, _, lift = structure.path(np.array([end]))
    assert work == pytest.approx(
        structure.weight * lift[0], rel=1e-9, abs=1e-9 * structure.weight
    )


@given(structures)
def test_initial_stiffness_is_the_slope_of_the_curve(structure):
    x = np.array([0.0, 1e-4, 2e-4, 3e-4])
    force, u, _ = structure.path(x)
    # cubic through four points; their spacing of 1e-4 leaves rounding 1e-16/1e-4
    slope = np.polynomial.Polynomial.fit(u, force, 3, domain=[0.0, u[-1]]).deriv()(0.0)
    size = structure.weight / structure.bearing.semi_diagonal
    assert structure.initial_stiffness == pytest.approx(float(slope), abs=1e-6 * size)


def test_the_rigid_frequency_parameter_of_a_block_is_housners():
    block = PodiumStructure(Bearing(2.0, 0.2, 0.2, FLAT), 1e3, 0.0)
    expected = math.sqrt(0.75 * 9.80665 / 2.0)
    assert block.rigid_frequency_parameter == pytest.approx(expected, rel=1e-14)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"columns_mass": 0.0}, "must be > 0, cap_beam_mass >= 0"),
        ({"columns_mass": -1.0}, "must be > 0, cap_beam_mass >= 0"),
        ({"columns_mass": math.nan}, "columns_mass = nan must be a finite number"),
        ({"columns_mass": 1e-300}, "must be > 0, cap_beam_mass >= 0"),
        ({"cap_beam_mass": -1.0}, "must be > 0, cap_beam_mass >= 0"),
        ({"gravity": 0.0}, "must be > 0, cap_beam_mass >= 0"),
        ({"cap_beam_mass": 0.0}, "the superstructure stands on it"),
        ({"superstructure_y": building(3)}, "superstructure_y must have the floors"),
        (
            {"superstructure": None, "superstructure_y": building(2)},
            "must have the floors",
        ),
    ],
)
def test_what_is_outside_the_model_is_refused(given, said):
    with pytest.raises(ValueError, match=said):
        replace(podium(2), **given)


def test_what_is_followed_in_one_plane_only():
    """Floors that jump, where there are impacts that they may jump at."""
    bearing, ball = Bearing(1.5, 0.15, 0.3, 0.5), Bearing(1.5, 0.0, 0.3, 0.8)
    jumps, above = ImpactLaw("value", 0.9), building(2)
    assert not PodiumStructure(
        bearing, 2e4, 2e5, impact_law=ImpactLaw("rigid")
    ).planar_only
    assert (
        "use the law flexible"
        in PodiumStructure(bearing, 2e4, 2e5, above, jumps).planar_only
    )
    whole = ImpactLaw("value", 1.0)
    assert not PodiumStructure(ball, 2e4, 2e5, above, whole).planar_only
    devices = (
        FrictionDamper(1e3),
        RollingResistance(1e-3),
        ViscousDamper(1e3),
        Stop(0.1, 1e6),
    )
    assert not PodiumStructure(bearing, 2e4, 2e5, devices=devices).planar_only
    soft = Contact("plane", stiffness=1e9)
    assert not PodiumStructure(bearing, 2e4, 2e5, above, contact=soft).planar_only


def test_forces_of_columns_leave_out_shocks_where_there_are_any():
    bearing, above = Bearing(1.5, 0.15, 0.3, 0.5), building(2)
    rigid = PodiumStructure(bearing, 2e4, 2e5, above)
    soft = replace(rigid, contact=Contact("plane", stiffness=1e9))
    ball = PodiumStructure(Bearing(1.5, 0.0, 0.3, 0.8), 2e4, 2e5, above)
    shear = {
        s: s.left_out_of_columns(both=True, axial=False) for s in (rigid, soft, ball)
    }
    assert ["shorter than 25 ms" in "".join(left) for left in shear.values()] == [1, 0, 0]
    assert shear[soft] == shear[ball]  # as under one component
    for of in (rigid, soft, ball):
        (moment,) = of.left_out_of_columns(both=False, axial=False)
        assert "the overturning moment of the building (podium.plan)" in moment
        rows = replace(of, rows=(0.0, 6.0), columns=4)
        assert rows.left_out_of_columns(both=False, axial=False) == ()
    frame = PodiumStructure(bearing, 2e4, 2e5)
    assert frame.left_out_of_columns(both=False) == ()
    (moment,) = replace(frame, columns=4).left_out_of_columns(both=False)
    assert moment == "the overturning moment of leaning columns (podium.plan)"
    assert "the shock of impacts" in soft.left_out_of_columns(both=True)[1]
    assert len(ball.left_out_of_columns(both=True)) == 1
    assert len(ball.left_out_of_columns(both=False)) == 1


def test_joints_are_the_same_in_both_directions():
    """The ratio of periods is that of x."""
    x, y = building(2), building(2, 0.3)
    soft = PodiumStructure(
        Bearing(1.5, 0.15, 0.3, 0.5), 2e4, 2e5, x, superstructure_y=y,
        contact=Contact("plane", period_ratio=1.2),
    )  # fmt: skip
    joint, same = known(soft.bed), known(soft.across.bed)
    assert same.stiffness == pytest.approx(joint.stiffness, rel=1e-12)
    assert soft.across.superstructure is y
    assert 1.0 < known(same.period_ratio) < 1.15


@pytest.mark.parametrize(("storeys", "tan_alpha"), [(0, 0.15), (3, 0.15), (3, 0.25)])
def test_the_turn_of_a_pass_by_the_kinetic_energy_of_a_cone(storeys, tan_alpha):
    """A straight way over the cone A dr^2 + K r^2 dphi^2, from energies of masses that move."""
    s = podium(storeys, tan_alpha, 0.5)
    b, small = s.bearing, 1e-5
    _, u, v = s.path(np.array([small, 2.0 * small]))
    across, up = (
        u[0] / small,
        float(np.diff(v)[0]) / small,
    )  # what du_b and dv_b are to dtheta
    unit = s.columns_mass * b.semi_diagonal**2
    carried = s.cap_beam_mass * np.array([across**2 + up**2, across**2])
    carried[0] += s.superstructure_mass * up**2
    # Of the column, about its edge, and round it: its middle moves by half of u_b.
    columns = [b.inertia_ratio * unit, (b.inertia_ratio - 1.0) * unit]
    columns[1] += s.columns_mass * (0.5 * across) ** 2
    falling, turning = (carried + columns) / unit
    assert s.turning_inertia == pytest.approx(turning, rel=1e-4)
    # The speed is kept and so is K r^2 phi': from afar to the nearest point 1 and away again.
    way = quad(lambda r: 1.0 / (r * math.sqrt(r**2 - 1.0)), 1.0, 2.0)[0]
    way += quad(lambda r: 1.0 / (r * math.sqrt(r**2 - 1.0)), 2.0, math.inf)[0]
    assert s.pass_turn == pytest.approx(
        2.0 * math.sqrt(falling / turning) * way, rel=1e-4
    )
    assert s.pass_turn > math.pi
