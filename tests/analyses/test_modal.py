"""Modes in each state: pairs of eigenvalues, closed forms, and what shapes solve."""

import math
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from conformance import conforms
from paper_structures import FLAT, building, known, podium, yielding
from scipy.linalg import eigh

from rpscli.analyses.modal import linearised_matrices, modal
from rpscli.model.bearing import Bearing, uplifted_state
from rpscli.model.devices import ViscousDamper
from rpscli.model.impact import ImpactLaw
from rpscli.model.superstructure import ModalDamping, RayleighDamping

pytestmark = pytest.mark.evidence("modes", "exact")

SIZES = [(n, rho) for n in (1, 2, 3, 6, 10) for rho in (FLAT, 0.25, 0.5, 1.5)]
SIZES += [(50, FLAT), (50, 0.5), (100, 1.5)]


@pytest.mark.parametrize(("storeys", "rho"), SIZES)
def test_frequencies_and_damping_belong_to_their_eigenvalues(storeys, rho):
    for name, modes in modal(podium(storeys, 0.15, rho)).uplifted.items():
        first, second = modes.eigenvalues[2::2], modes.eigenvalues[3::2]
        products = np.sqrt((first * second).real)
        conforms(
            "modes", f"frequencies, {name}", products, modes.frequencies, 1e-9 * products,
            "identity", "product of a pair of eigenvalues",
        )  # fmt: skip
        sums = -(first + second).real / (2.0 * products)
        conforms(
            "modes", f"damping, {name}", sums, modes.damping, 1e-7 * sums,
            "identity", "sum of a pair of eigenvalues",
        )  # fmt: skip
        assert np.all(modes.damping > 0.0)
        assert np.all(np.diff(modes.frequencies) > 0.0)
        for value in modes.eigenvalues[2:][modes.eigenvalues[2:].imag > 0.0]:
            assert np.min(np.abs(modes.frequencies - abs(value))) < 1e-8 * abs(value)


@pytest.mark.parametrize(("storeys", "ratio"), [(30, 0.05), (30, 0.2), (100, 0.05)])
def test_overdamped_modes_are_paired_as_without_damping(storeys, ratio):
    """High modes of tall buildings: the product of the paired roots is the squared frequency.

    For C = a1 K and gravity neglected each mode has the undamped frequency however damped it is.
    """
    damping = RayleighDamping(ratio, (1, 1))  # stiffness-proportional
    damped, undamped = (
        known(modal(podium(storeys, superstructure=building(storeys, damping=d))).rolling)
        for d in (damping, RayleighDamping(0.0))
    )
    assert damped.damping[-1] > 1.0
    assert damped.frequencies == pytest.approx(undamped.frequencies, rel=1e-6)


def test_overdamped_vibrations_leave_a_podium_that_swings_its_mode():
    """Their slow real roots come before its pair."""
    above = building(10, damping=ModalDamping(0.99))
    modes = known(modal(podium(10, 0.15, 5.0, superstructure=above)).rolling)
    assert np.abs(modes.eigenvalues).argmin() > 1
    swing = modes.frequency_parameter_rigid  # the building takes a little part
    assert modes.own_period == pytest.approx(2.0 * math.pi / swing, rel=0.1)
    assert len(modes.frequencies) == 10


def test_without_damping_no_mode_is_damped():
    """Not by rounding either, of any sign; the podium's own mode has roots of one size."""
    for rho in (FLAT, 0.5, 1.5):
        undamped = building(3, damping=ModalDamping(0.0))
        for modes in modal(
            podium(3, 0.15, rho, superstructure=undamped)
        ).uplifted.values():
            assert modes.damping.tolist() == [0.0] * 3
            assert not np.signbit(modes.damping).any()
            assert np.all(
                (modes.eigenvalues.real == 0.0) | (modes.eigenvalues.imag == 0.0)
            )
    # Vertical vibrations alone are damped, which nothing couples where columns stand on a point.
    above = replace(building(10, damping=ModalDamping(0.0)), vertical_period=0.1)
    usual = podium(10, law=ImpactLaw(), superstructure=above)
    ends = replace(usual, bearing=Bearing(1.5, 0.0, 0.3, 0.8))
    rolling = known(modal(ends).rolling)
    assert rolling.damping.tolist() == [0.0] * 10
    assert rolling.vertical_damping == pytest.approx(np.full(10, above.vertical_damping))


@pytest.mark.parametrize("storeys", [1, 10, 30, 50, 100])
def test_one_root_grows_where_the_stiffness_is_negative(storeys):
    """In tall buildings vibration modes are slower than the podium's own motion."""
    for modes in modal(podium(storeys, 0.15, FLAT)).uplifted.values():
        own, rest = modes.eigenvalues[:2], modes.eigenvalues[2:]
        assert own.imag.tolist() == [0.0, 0.0]
        assert own[0].real > 0.0 > own[1].real
        assert np.all(rest.real < 0.0)
        growth = modes.frequency_parameter
        assert growth == pytest.approx(math.sqrt(-(own[0] * own[1]).real), rel=1e-12)
        assert abs(modes.shapes[0, 0]) == pytest.approx(
            np.max(np.abs(modes.shapes[:, 0]))
        )


@pytest.mark.parametrize(("tan_alpha", "period"), [(0.05, 0.1), (0.15, 0.3), (0.3, 1.0)])
def test_one_storey_in_closed_form(tan_alpha, period):
    """omega_u/omega_0 = sqrt(1 + C^2 M_tot/(N m_c Io/4 + m_b + M_tot B^2)); xi the same factor.

    B and C are a and 1 to first order. At rho = 1/2 gravity drops out, so the form is exact.
    """
    structure = podium(1, tan_alpha, 0.5, superstructure=building(1, period))
    modes = known(modal(structure).rolling)
    total, a = structure.superstructure_mass, structure.bearing.alpha
    for order, found, B, C in (
        ("exact", modes, math.sin(a), math.cos(a)),
        ("first order", known(modes.first_order), a, 1.0),
    ):
        base = structure.columns_mass / 3.0 + structure.cap_beam_mass + total * B**2
        factor = math.sqrt(1.0 + C**2 * total / base)
        for name, ratios in (
            ("omega_u/omega_0", found.frequency_ratio),
            ("xi_u/xi_0", found.damping_ratio),
        ):
            conforms(
                "modes", f"{name}, one storey, {order}", factor, ratios[0], 1e-7 * factor,
                "closed form", "sqrt(1 + C^2 M_tot/(N m_c Io/4 + m_b + M_tot B^2))",
            )  # fmt: skip


@pytest.mark.parametrize("storeys", [0, 1, 6, 100])
def test_zero_stiffness_has_a_double_zero(storeys):
    modes = known(modal(podium(storeys, 0.15, 0.5)).rolling)
    assert modes.eigenvalues[:2].tolist() == [0.0, 0.0]
    assert modes.frequency_parameter == modes.frequency_parameter_rigid == 0.0
    assert modes.shapes[:, 0].tolist() == [1.0] * (storeys + 1)  # all move along
    if storeys:
        assert np.abs(modes.elastic_shapes[:, 0]).max() == 0.0


def test_a_rigid_frame_has_only_its_own_mode():
    for rho, kappa in ((FLAT, -1.0), (0.25, -0.5), (1.5, 2.0)):
        structure = podium(0, 0.15, rho)
        result = modal(structure)
        state = known(result.rocking if rho == FLAT else result.rolling)
        modes = known(state.first_order)
        assert len(modes.frequencies) == 0
        p = structure.rigid_frequency_parameter * math.sqrt(abs(kappa))
        for name, found in (
            ("p_ext", modes.frequency_parameter),
            ("rigid estimate", modes.frequency_parameter_rigid),
        ):
            conforms(
                "modes", f"{name} [rad/s], rigid frame, kappa {kappa:g}", p, found,
                1e-12 * p, "closed form", "p sqrt(|kappa|)",
            )  # fmt: skip
        squares = modes.eigenvalues**2
        assert squares.real == pytest.approx([-kappa / abs(kappa) * p**2] * 2, rel=1e-12)
    assert modal(podium(0)).fixed_base is None
    assert modal(podium(2, 0.15, FLAT)).rolling is None


def test_shapes_solve_the_eigenproblem_and_fixed_base_modes_are_the_buildings():
    structure = podium(6, 0.15, 1.5)
    above = known(structure.superstructure)
    result = modal(structure)
    fixed, rolling = known(result.fixed_base), known(result.rolling)
    assert fixed.frequencies == pytest.approx(above.frequencies)
    assert fixed.damping == pytest.approx(above.damping_ratios)
    assert fixed.periods[0] == pytest.approx(0.6, rel=1e-12)
    assert np.max(np.abs(fixed.shapes), axis=0) == pytest.approx(np.ones(6))
    assert rolling.shapes.shape == (7, 7)
    assert np.max(np.abs(rolling.shapes), axis=0) == pytest.approx(np.ones(7))
    # in the podium's own mode the building is carried along (paper, Figure 6)
    assert np.abs(rolling.elastic_shapes[:, 0]).max() < 0.1
    # undamped shapes are real and diagonalise both matrices
    undamped = podium(6, 0.15, 1.5, superstructure=building(6, damping=ModalDamping(0.0)))
    modes = known(modal(undamped).rolling)
    masses = np.full(7, 2e5)
    a = structure.bearing.alpha
    # of u_b = C 2 R theta
    masses[0] = (2e4 / 3.0 + 2e5 + 12e5 * math.sin(a) ** 2) / math.cos(a) ** 2
    generalised = modes.shapes.T @ np.diag(masses) @ modes.shapes
    off = generalised - np.diag(np.diag(generalised))
    assert np.abs(off).max() < 1e-9 * masses[0]


def test_the_podiums_own_mode_in_words():
    """Rigid frame to first order: lambda^2 = -kappa p^2, kappa = 2 rho - 1, rocking -1.

    With p^2 = (g/R)(1 + 2 gamma)/(Io + 4 gamma) and gamma = 10, Io = 4/3, R = 1.5 m:
    p = sqrt(6.53777 * 21/41.3333) = 1.82253 rad/s.
    """
    rolling, falling = modal(podium(0, 0.15, 1.0)).uplifted.values()
    swings, falls = known(rolling.first_order), known(falling.first_order)
    conforms(
        "modes", "own period [s], rigid frame, rho 1", 2.0 * math.pi / 1.82253,
        swings.own_period, 3.5e-5, "hand calculation", "p = 1.82253 rad/s",
    )  # fmt: skip
    assert (swings.own_growth_time, swings.own_motion) == (
        None,
        "swings with T = 3.448 s",
    )
    conforms(
        "modes", "growth time [s], rigid frame, rocking", 1.0 / 1.82253,
        falls.own_growth_time, 5.5e-6, "hand calculation", "p = 1.82253 rad/s",
    )  # fmt: skip
    assert (falls.own_period, falls.own_motion) == (None, "diverges, e-fold in 0.5487 s")
    for storeys, damper in product((0, 1, 5, 12), (0.0, 5.0, 5e5, 5e7)):
        devices = (ViscousDamper(damper),) if damper else ()
        neutral = known(
            modal(replace(podium(storeys, 0.15, 0.5), devices=devices)).rolling
        )
        assert neutral.own_motion == "is in neutral equilibrium"
        assert neutral.frequency_parameter == 0.0
        assert np.count_nonzero(neutral.eigenvalues[:2]) == len(devices)
        assert np.ptp(neutral.shapes[:, 0]) == 0.0


def test_the_storey_that_yields_first_in_a_mode():
    """Undamped, so that a solver for symmetric M and K finds the modes as well."""
    elastic = building(3, damping=ModalDamping(0.0))
    above = yielding(elastic, 1e6)
    structure = podium(3, 0.15, 0.5, superstructure=above)
    found = modal(structure).first_yield
    conforms(
        "modes", "base shear at first yield [N], full contact", 1e6,
        found["full_contact"]["base_shear"], 1e-3,
        "identity", "strengths as the shears of the first mode",
    )  # fmt: skip
    M, _, K = linearised_matrices(
        structure, uplifted_state(structure.bearing, rolling=True)
    )
    _, vectors = eigh(K, M)
    height = math.cos(structure.bearing.alpha)
    shears = above.stiffnesses * np.diff(vectors[1:, 1], prepend=height * vectors[0, 1])
    base_shears = np.abs(shears[0] / shears) * known(above.strengths)
    rolling = found["rolling"]
    conforms(
        "modes", "base shear at first yield [N], rolling", base_shears.min(),
        rolling["base_shear"], 1e-9 * base_shears.min(),
        "independent program", "scipy.linalg.eigh, undamped",
    )  # fmt: skip
    assert rolling["storey"] == base_shears.argmin() + 1 == 3
    assert "first_yield" in modal(structure).results()
    assert "first_yield" not in modal(podium(3)).results()
