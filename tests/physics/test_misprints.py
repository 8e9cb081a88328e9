"""The paper's misprints: each printed form breaks a law that the program's form keeps."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from paper_structures import FLAT, podium

from rpscli.analyses.modal import linearised_matrices
from rpscli.model.bearing import Bearing, uplifted_state
from rpscli.model.podium import PodiumStructure
from rpscli.physics.geometry import contact_arm, contact_height
from rpscli.physics.state import ROCKING, ROLLING

from .one_lane import OneLane


def inertia(structure: PodiumStructure, x: float) -> tuple[float, float, float]:
    """A, our D and the printed D = -C B, rocking."""
    phase = structure.bearing.rocking
    B = contact_arm(phase, math.cos(x), math.sin(x))
    C = contact_height(phase, math.cos(x), math.sin(x))
    at = OneLane(structure, ROCKING).at(x)
    return at.A, at.D, -C * B


@given(st.floats(0.01, 0.4), st.sampled_from([FLAT, 0.5]))
def test_1_d_while_rocking_lacks_4_eta_gamma(x: float, rho: float) -> None:
    """Energy needs D = A'/2: A theta'^2/2 must change by what the forces do, and no more."""
    structure = podium(3, 0.15, rho)
    h = 1e-3
    slope = (inertia(structure, x + h)[0] - inertia(structure, x - h)[0]) / (2.0 * h)
    A, ours, printed = inertia(structure, x)
    factor = 4.0 * structure.eta * structure.gamma
    assert ours == pytest.approx(0.5 * slope, abs=2.0 * h**2 * A)
    assert ours == pytest.approx(factor * printed, rel=1e-12)
    if abs(printed) > 1e-2:
        assert abs(0.5 * slope - printed) > 0.9 * (factor - 1.0) * abs(printed)


def tilt_acceleration(tan_alpha: float, rho: float, x: float, u: float) -> float:
    """theta'' of one storey at rest at the tilt x, the floor at u."""
    lane = OneLane(podium(1, tan_alpha, rho), ROLLING if rho else ROCKING)
    lane.place(np.array([x, u]), np.zeros(2))
    return float(lane.accelerations()[0])


@pytest.mark.parametrize("rho", [FLAT, 0.3, 0.7, 1.5])
def test_2_the_sign_of_gravity_in_k_l(rho: float) -> None:
    """K_L must be the derivative of the forces, and a larger radius must stiffen the storey."""
    tan_alpha = 1e-3
    structure = podium(1, tan_alpha, rho)
    kappa = 2.0 * rho - 1.0
    M, _, K = linearised_matrices(
        structure, uplifted_state(structure.bearing, rolling=True, exact=False)
    )
    printed = K.copy()
    printed[0, 0] -= 2.0 * structure.weight * kappa / (2.0 * structure.bearing.semi_diagonal)
    h = 1e-6
    diameter = 2.0 * structure.bearing.semi_diagonal
    # along u_t = u_b the spring stays slack: only gravity is left
    slope = (
        tilt_acceleration(tan_alpha, rho, 2.0 * h, 2.0 * h * diameter)
        - tilt_acceleration(tan_alpha, rho, h, h * diameter)
    ) / h
    ours, wrong = (-(matrix[0, 0] + matrix[0, 1]) / M[0, 0] for matrix in (K, printed))
    # linear to first order in alpha and in x; the spring's 1e8 N/m rounds u_b
    size = structure.gravity / structure.bearing.semi_diagonal
    assert ours == pytest.approx(slope, abs=0.01 * size)
    assert abs(wrong - slope) > 0.1 * size
    assert wrong == pytest.approx(-ours, rel=1e-6)


def test_3_the_first_order_theta_cr_jumps_at_its_rho_cr() -> None:
    """theta_cr is a root of a continuous B(x), so it cannot jump; the printed branches do."""
    for tan_alpha, jump in ((0.10, 0.0099), (0.15, 0.0222), (0.20, 0.0392)):
        wedge = 2.0 * tan_alpha
        rho_cr = Bearing(1.5, tan_alpha, wedge, 0.5).critical_curvature_ratio_of_paper
        below, above = (Bearing(1.5, tan_alpha, wedge, rho_cr + shift) for shift in (-1e-9, 1e-9))
        printed = above.critical_rotation_of_paper / below.critical_rotation_of_paper - 1.0
        ours = above.critical_rotation / below.critical_rotation - 1.0
        assert abs(ours) < 1e-8
        assert abs(printed) == pytest.approx(jump, rel=0.01)
