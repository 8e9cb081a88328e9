"""Geometry and equation of motion beside Lagrange's equations and the theory; the misprints."""

import math
from typing import NamedTuple

import numpy as np
import pytest
from conformance import conforms
from hypothesis import given
from hypothesis import strategies as st
from oracles.storey_lagrangian import Contact, StoreyLagrangian
from paper_structures import (
    FLAT,
    needs_compiled_kernels,
    oracle_system,
    podium,
    stillness,
    waves,
)
from scipy.optimize import brentq

from rpscli.analyses.kernels.history import sampled_history
from rpscli.analyses.modal import linearised_matrices
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.model.bearing import Bearing, uplifted_state
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import ModalDamping, RayleighDamping, Superstructure
from rpscli.physics.laws import geometry
from rpscli.physics.state import FULL_CONTACT, ROLLING
from rpscli.records.ground_motion import MotionComponents

ROUNDING = 2e-14
"""A few dozen roundings of numbers of the size 1 + 4 rho, which every tolerance is scaled by."""


class Path(NamedTuple):
    """Theory, section 1, as it stands in the table."""

    B: float
    C: float
    u: float
    v: float


def printed(bearing, x, *, rolling):
    a, k, sin, cos = bearing.alpha, 2.0 * bearing.curvature_ratio, math.sin, math.cos
    k, b = k * cos(a), x if rolling else bearing.beta
    return Path(
        B=sin(a - x) + k * (sin(b - x) + sin(x)),
        C=cos(a - x) + k * (cos(b - x) - cos(x)),
        u=sin(a) - sin(a - x) + k * (b - sin(x) - sin(b - x)),
        v=cos(a - x) - cos(a) + k * (cos(b - x) - cos(x)),
    )


def shape_of(tan_alpha, widening, sin_beta):
    rise = tan_alpha * (widening - 1.0)
    return Bearing(1.0, tan_alpha, tan_alpha + rise, rise / (2.0 * sin_beta))


shapes = st.builds(
    shape_of, st.floats(0.02, 0.6), st.floats(1.05, 3.0), st.floats(0.02, 0.999)
)


@pytest.mark.evidence("geometry of columns", "exact")
@given(shapes)
def test_critical_rotation_is_the_first_root_on_the_branch_travelled(bearing):
    def B(x):
        return printed(bearing, x, rolling=x < bearing.beta).B

    grid = np.linspace(0.0, 1.999 * math.pi, 801)  # B stays negative for half a turn
    signs = np.array([B(x) for x in grid])
    first = int(np.argmax(signs < 0.0))
    assert signs[0] > 0.0
    assert first > 0
    root = float(brentq(B, grid[first - 1], grid[first], xtol=1e-15))
    # B falls by at least its slope -C, |C| > 0.1 here; rounding of B is that of k
    size = 1.0 + 4.0 * bearing.curvature_ratio
    assert bearing.critical_rotation == pytest.approx(root, abs=1e-12 * size)


@pytest.mark.evidence("geometry of columns", "exact")
@given(shapes, st.lists(st.floats(0.0, 1.4), min_size=1, max_size=5))
def test_the_path_takes_each_point_in_its_own_phase(bearing, tilt):
    x = np.array(tilt)
    path = np.array(
        geometry.path_along(bearing.rolling, bearing.rocking, bearing.beta, x)
    )
    expected = [printed(bearing, t, rolling=t < bearing.beta) for t in tilt]
    size = 1.0 + 4.0 * bearing.curvature_ratio
    assert path == pytest.approx(np.array(expected).T, abs=ROUNDING * size)


@st.composite
def structures(draw):
    n = draw(st.integers(0, 4))
    positive = st.floats(0.2, 5.0)
    above = None
    if n:
        dampings = [
            RayleighDamping(0.05),
            ModalDamping(0.03),
        ]
        damping = draw(st.sampled_from(dampings))
        masses, stiffnesses = (
            np.array(draw(st.lists(positive, min_size=n, max_size=n))) for _ in range(2)
        )
        above = Superstructure(1e5 * masses, 1e8 * stiffnesses, damping)
    tan_alpha = draw(st.floats(0.05, 0.3))
    rho = draw(st.sampled_from([0.0, 0.3, 0.5, 1.5]))
    bearing = Bearing(draw(positive), tan_alpha, 2.0 * tan_alpha, rho)
    rigid = ImpactLaw("rigid")  # of which any of these shapes goes over
    return PodiumStructure(
        bearing, 1e4 * draw(positive), 1e5 * draw(positive), above, rigid
    )


@needs_compiled_kernels
@pytest.mark.evidence("equation of motion", "exact")
@pytest.mark.evidence("equation of motion", "program")
@pytest.mark.evidence("equation of motion", "published")
@given(structures(), st.integers(0, 99), st.floats(-0.9, 0.9))
def test_samples_obey_lagrange_and_the_theory(structure, seed, start):
    """Accelerations and energies, while rolling and rocking, under a ground that also rises."""
    settings = TimeHistorySettings(
        free_vibration=0.0, initial_rotation=start * structure.critical_rotation
    )
    record = waves(0.4, 0.01, 4.0 * structure.uplift_acceleration, seed)
    vertical = waves(0.4, 0.01, 4.0, seed + 100)
    run = sampled_history(structure, MotionComponents(record, vertical), settings)
    system, n = oracle_system(structure), structure.storeys
    lagrangian, R = StoreyLagrangian(system), structure.bearing.semi_diagonal
    gamma, eta, m_c = structure.gamma, structure.eta, structure.columns_mass
    for i, sample in enumerate(run.samples):
        if sample.phase == FULL_CONTACT:
            continue
        side, rolling = (1 if sample.theta >= 0.0 else -1), sample.phase == ROLLING
        contact, x, rate = Contact(side, rolling), side * sample.theta, sample.theta_dot
        a_g, g = record.acceleration[i], structure.gravity + vertical.acceleration[i]
        base, slope, bend = lagrangian.cap_beam(x, rolling=rolling)
        u, du, absolute = run.floors[i, :3]
        drifts = np.diff(u, prepend=side * base.real)
        drift_rates = np.diff(du, prepend=slope.real * rate)
        y = np.r_[sample.theta, drifts, rate, drift_rates]
        q2 = lagrangian.acceleration(contact, y, a_g, g)
        # the oracle solves with a full matrix, whose condition of up to 1e4 multiplies rounding
        size = 1e-11 * (1.0 + float(np.max(np.abs(q2))))
        assert sample.theta_ddot == pytest.approx(q2[0], abs=size)
        beam = slope.real * q2[0] + side * bend.real * rate**2
        floors = a_g + beam + np.cumsum(q2[1:])
        # du_b/dtheta = 2 R C, C < 5
        assert absolute == pytest.approx(floors, abs=size * (1.0 + 10.0 * R))
        stored = sum(lagrangian.energies(contact, y))
        assert sample.energy_stored == pytest.approx(stored, rel=1e-11, abs=1e-6)
        B, C, _, _ = printed(structure.bearing, x, rolling=rolling)
        forces = np.zeros(n)
        if (above := structure.superstructure) is not None:
            forces = above.stiffness_matrix @ np.cumsum(drifts)
            forces += above.damping_matrix @ np.cumsum(drift_rates)
        pull = B * g / R * (1.0 + 2.0 * gamma * (1.0 + eta))
        push = C * (2.0 * forces.sum() / (m_c * R) - a_g / R * (1.0 + 2.0 * gamma))
        A, D = coefficients(structure, x, rolling=rolling)
        tilt = (push - side * (pull + D * rate**2)) / A
        # sums of terms of up to 1e4 m/s2 in double precision
        assert q2[0] == pytest.approx(tilt, rel=1e-10, abs=1e-10)
        assert floors == pytest.approx(-forces / system.masses, rel=1e-9, abs=1e-9)


def coefficients(structure, x, *, rolling):
    """A and D of the equation of motion (Theory, section 2)."""
    bearing, gamma, eta = structure.bearing, structure.gamma, structure.eta
    B, C, _, _ = printed(bearing, x, rolling=rolling)
    k = 2.0 * bearing.curvature_ratio * math.cos(bearing.alpha) if rolling else 0.0
    A = (
        bearing.inertia_ratio
        - 1.0
        + (1.0 + 4.0 * gamma) * (B**2 + C**2)
        + 4.0 * gamma * eta * B**2
    )
    return A, (1.0 + 4.0 * gamma) * k * B + 4.0 * gamma * eta * B * (k - C)


@given(st.floats(0.01, 0.4), st.sampled_from([FLAT, 0.5]))
def test_misprint_1_d_while_rocking_lacks_4_eta_gamma(x, rho):
    """Energy needs D = A'/2: A theta'^2/2 must change by what the forces do, and no more."""
    structure, h = podium(3, 0.15, rho), 1e-3
    before, (A, ours), after = (
        coefficients(structure, x + k * h, rolling=False) for k in (-1, 0, 1)
    )
    half_slope = (after[0] - before[0]) / (4.0 * h)
    B, C, _, _ = printed(structure.bearing, x, rolling=False)
    factor = 4.0 * structure.eta * structure.gamma
    assert ours == pytest.approx(half_slope, abs=2.0 * h**2 * A)
    assert ours == pytest.approx(-factor * C * B, rel=1e-12)
    if abs(C * B) > 1e-2:
        assert abs(half_slope + C * B) > 0.9 * (factor - 1.0) * abs(C * B)


def tilt_acceleration(structure, x):
    """theta'' of a storey at rest at the tilt x, its springs at ease."""
    settings = TimeHistorySettings(free_vibration=0.0, initial_rotation=x)
    run = sampled_history(structure, MotionComponents(stillness(0.01)), settings)
    return float(run.samples[0].theta_ddot)


@pytest.mark.parametrize("rho", [FLAT, 0.3, 0.7, 1.5])
def test_misprint_2_the_sign_of_gravity_in_k_l(rho):
    """K_L must be the derivative of the forces, and a larger radius must stiffen the storey."""
    structure, h = podium(1, 1e-3, rho), 1e-6
    state = uplifted_state(structure.bearing, rolling=True, exact=False)
    M, _, K = linearised_matrices(structure, state)
    wrong_K = K.copy()
    wrong_K[0, 0] -= (
        structure.weight * (2.0 * rho - 1.0) / structure.bearing.semi_diagonal
    )
    # along u_t = u_b the spring stays slack: only gravity is left
    slope = (tilt_acceleration(structure, 2.0 * h) - tilt_acceleration(structure, h)) / h
    ours, wrong = (-(matrix[0, 0] + matrix[0, 1]) / M[0, 0] for matrix in (K, wrong_K))
    # linear to first order in alpha and in x
    size = structure.gravity / structure.bearing.semi_diagonal
    conforms(
        "equation of motion", "acceleration over a tilt [1/s2]", slope, ours, 0.01 * size,
        "identity", "K_L is the derivative of the forces",
    )  # fmt: skip
    assert abs(wrong - slope) > 0.1 * size
    assert wrong == pytest.approx(-ours, rel=1e-6)


def test_misprint_3_the_first_order_theta_cr_jumps_at_its_rho_cr():
    """theta_cr is a root of a continuous B(x), so it cannot jump; the printed branches do."""
    for tan_alpha, jump in ((0.10, 0.0099), (0.15, 0.0222), (0.20, 0.0392)):
        wedge = 2.0 * tan_alpha
        rho_cr = Bearing(1.5, tan_alpha, wedge, 0.5).critical_curvature_ratio_of_paper
        below, above = (
            Bearing(1.5, tan_alpha, wedge, rho_cr + shift) for shift in (-1e-9, 1e-9)
        )
        paper = above.critical_rotation_of_paper / below.critical_rotation_of_paper - 1.0
        assert abs(above.critical_rotation / below.critical_rotation - 1.0) < 1e-8
        assert abs(paper) == pytest.approx(jump, rel=0.01)
        conforms(
            "geometry of columns", f"theta_cr at the printed rho_cr, tan(alpha) {tan_alpha}",
            below.critical_rotation, above.critical_rotation,
            1e-8 * below.critical_rotation, "identity", "a root of a continuous B(x)",
        )  # fmt: skip
