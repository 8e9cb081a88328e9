"""The shear building: profiles, matrices, modes, and damping in every mode."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from paper_structures import building

from rpscli.model.superstructure import (
    ModalDamping,
    RayleighDamping,
    Superstructure,
    profile_stiffnesses,
    stiffness_matrix,
)

PROFILES = ("sine", "uniform", "linear", "flexural")


def positive(size, most=5.0):
    return st.lists(st.floats(0.2, most), min_size=size, max_size=size).map(np.array)


buildings = st.integers(1, 12).flatmap(
    lambda n: st.builds(
        lambda m, k: Superstructure(1e5 * m, 1e8 * k, RayleighDamping(0.05)),
        positive(n),
        positive(n),
    )
)


@given(
    st.integers(1, 12).flatmap(positive),
    st.floats(0.05, 5.0),
    st.sampled_from([p for p in PROFILES if p != "uniform"]),
)
def test_a_profile_has_its_period_and_mode(masses, period, profile):
    n = len(masses)
    k = profile_stiffnesses(masses, period, profile)
    above = Superstructure(masses, k, RayleighDamping(0.0))
    assert above.periods[0] == pytest.approx(period, rel=1e-10)
    first = above.shapes[:, 0] / above.shapes[-1, 0]
    wanted = {
        "sine": np.sin(np.pi * np.arange(1, n + 1) / (2 * n)),
        "linear": np.arange(1, n + 1) / n,
        "flexural": 1.0 - np.cos(np.pi * np.arange(1, n + 1) / (2 * n)),
    }[profile]
    assert first == pytest.approx(wanted, abs=1e-9)


@given(st.integers(1, 12), st.floats(0.05, 5.0))
def test_uniform_stiffness_of_equal_floors_is_the_textbook_chain(n, period):
    """w_r = 2 sqrt(k/m) sin((2 r - 1) pi/(2 (2 n + 1)))."""
    masses = np.full(n, 3.0)
    k = profile_stiffnesses(masses, period, "uniform")
    assert np.ptp(k) == 0.0
    above = Superstructure(masses, k, RayleighDamping(0.0))
    r = np.arange(1, n + 1)
    chain = 2.0 * np.sqrt(k[0] / 3.0) * np.sin((2 * r - 1) * np.pi / (2 * (2 * n + 1)))
    assert above.frequencies == pytest.approx(chain, rel=1e-9)
    assert above.periods[0] == pytest.approx(period, rel=1e-10)


def test_the_stiffness_matrix_is_that_of_springs_in_series():
    """Energy of the springs; a unit force at the roof is carried by all of them."""
    k = np.array([3.0, 2.0, 5.0])
    K = stiffness_matrix(k)
    u = np.array([0.1, -0.4, 0.7])
    assert u @ K @ u == pytest.approx(np.sum(k * np.diff(u, prepend=0.0) ** 2), rel=1e-14)
    assert np.linalg.solve(K, [0.0, 0.0, 1.0]) == pytest.approx(
        np.cumsum(1.0 / k), rel=1e-14
    )
    assert K.sum() == pytest.approx(k[0], rel=1e-14)


@given(buildings)
def test_modes_are_normalised_and_complete(above):
    phi, M, K = above.shapes, above.mass_matrix, above.stiffness_matrix
    n = above.storeys
    assert phi.T @ M @ phi == pytest.approx(np.eye(n), abs=1e-11)
    w2 = above.frequencies**2
    assert phi.T @ K @ phi == pytest.approx(np.diag(w2), abs=1e-11 * w2[-1])
    assert np.all(np.diff(above.frequencies) > 0.0)
    assert np.all(phi[-1] > 0.0)
    assert np.sum(above.participation**2) == pytest.approx(above.mass, rel=1e-11)
    assert above.mass == pytest.approx(M.sum(), rel=1e-14)


@given(
    buildings, st.floats(0.001, 0.3), st.tuples(st.integers(1, 12), st.integers(1, 12))
)
def test_rayleigh_damping_has_its_ratio_in_both_modes(above, ratio, modes):
    damping = RayleighDamping(ratio, modes)
    above = Superstructure(above.masses, above.stiffnesses, damping)
    xi, w = above.damping_ratios, above.frequencies
    for mode in modes:
        assert xi[min(mode, above.storeys) - 1] == pytest.approx(ratio, rel=1e-12)
    generalised = above.shapes.T @ above.damping_matrix @ above.shapes
    size = 1e-11 * float(np.max(generalised))
    assert generalised == pytest.approx(np.diag(2.0 * xi * w), abs=size)
    a0, a1 = damping.coefficients(w)
    assert a0 >= 0.0
    assert a1 > 0.0


def test_one_storey_takes_stiffness_proportional_damping():
    assert RayleighDamping(0.05, (1, 2)).coefficients(np.array([20.0])) == (0.0, 0.005)
    assert RayleighDamping(0.05, (2, 2)).coefficients(np.array([10.0, 20.0])) == (
        0.0,
        0.005,
    )


@given(buildings, st.floats(0.0, 0.3))
def test_modal_damping_is_the_same_in_every_mode(above, ratio):
    above = Superstructure(above.masses, above.stiffnesses, ModalDamping(ratio))
    assert above.damping_ratios.tolist() == [ratio] * above.storeys
    generalised = above.shapes.T @ above.damping_matrix @ above.shapes
    expected = np.diag(2.0 * ratio * above.frequencies)
    assert generalised == pytest.approx(expected, abs=1e-11 * above.frequencies[-1])


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"stiffnesses": [1.0]}, "one length"),
        ({"storey_heights": [3.0]}, "one length"),
        ({"masses": [], "stiffnesses": []}, "one length"),
        ({"masses": [1.0, -2.0]}, "masses must be"),
        ({"masses": [[1.0, 2.0]]}, "masses must be"),
        ({"stiffnesses": [0.0, 2.0]}, "stiffnesses must be"),
        ({"stiffnesses": [1.0, math.inf]}, "stiffnesses must be"),
        ({"storey_heights": [3.0, math.nan]}, "storey_heights must be"),
        ({"strengths": [1.0]}, "one length"),
        ({"strengths": [1.0, 0.0]}, "strengths must be"),
        ({"hardening": 1.0}, "hardening = 1 must be"),
        ({"hardening": math.nan}, "hardening = nan must be"),
    ],
)
def test_what_is_no_building_is_refused(given, said):
    whole = {"masses": np.ones(2), "stiffnesses": np.ones(2)}
    with pytest.raises(ValueError, match=said):
        Superstructure(damping=RayleighDamping(0.05), **(whole | given))


def test_a_building_cannot_be_changed_from_outside():
    masses = np.ones(2)
    above = Superstructure(masses, np.ones(2), RayleighDamping(0.05))
    masses[0] = 7.0
    assert above.mass == 2.0
    with pytest.raises(ValueError, match="read-only"):
        above.masses[0] = 7.0
    assert building(3).storeys == 3
