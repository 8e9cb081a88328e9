"""Restitution from momentum balances made anew with numbers, and what is refused."""

import math
from itertools import product

import numpy as np
import pytest
from conformance import conforms
from hypothesis import given
from hypothesis import strategies as st
from oracles.storey_lagrangian import StoreyLagrangian
from paper_structures import FLAT, building, oracle_system, podium

from rpscli.analyses.known_systems import LAWS, SLENDERNESSES, impact_numbers
from rpscli.model.bearing import Bearing
from rpscli.model.impact import ImpactLaw, flexible_restitution, rigid_restitution
from rpscli.model.podium import PodiumStructure

NUMBERS = dict(impact_numbers())

bearings = st.builds(
    lambda tan_alpha, inertia: Bearing(1.3, tan_alpha, 2.0 * tan_alpha, 0.5, inertia),
    st.floats(0.02, 0.45),
    st.floats(1.0, 1.6),
)
ratios = st.floats(0.0, 50.0)


def angular_momentum_ratio(bearing, gamma, eta, *, floors_jump, reach=1.0):
    """theta'+/theta'- of one column and its share of beam and floors, by Newton's laws.

    Unknown: the rate after, and the impulses (X, Y) at the new lower and upper edges, where the
    ground and the beam hold the column, or at this part of the way from the middle to them, the
    `reach`. Old edges leave without impulse. m_c = R = 1; positions from the column's centre,
    tilting right before and on. Floors take part in horizontal momentum if they jump, in vertical
    momentum always.
    """
    h, b = math.cos(bearing.alpha), math.sin(bearing.alpha)
    spin = bearing.inertia_ratio - 1.0
    beam, floors = gamma, gamma * eta

    # Velocities per unit rate. Rate > 0 turns clockwise. Before, the column turns about the lower
    # left edge (-b, -h) while falling from theta < 0 to 0; after, about the lower right (b, -h).
    def centre(pivot_x):
        return h, pivot_x  # (u, v) of the centre: clockwise about (pivot_x, -h)

    before, after = centre(-b), centre(b)
    # the beam moves twice as far as the centre, without turning
    matrix, known = np.zeros((5, 5)), np.zeros(5)
    for row, axis in ((0, 0), (1, 1)):  # column, horizontal and vertical
        matrix[row, 0], known[row] = after[axis], before[axis]
        matrix[row, 1 + axis] = matrix[row, 3 + axis] = -1.0
    # clockwise moment of (X, Y) at (x, y): y X - x Y; at (b, -h) and the upper edge (-b, h)
    matrix[2] = [spin, h, reach * b, -h, -reach * b]
    known[2] = spin
    carried = (beam + floors if floors_jump else beam, beam + floors)
    for row, axis in ((3, 0), (4, 1)):  # what is carried gets the opposite impulse
        matrix[row, 0] = 2.0 * carried[axis] * after[axis]
        known[row] = 2.0 * carried[axis] * before[axis]
        matrix[row, 3 + axis] = 1.0
    return float(np.linalg.solve(matrix, known)[0])


@pytest.mark.evidence("impact laws", "exact")
@given(bearings, ratios, ratios)
def test_restitution_is_the_momentum_balance(bearing, gamma, eta):
    for law, floors_jump in ((rigid_restitution, True), (flexible_restitution, False)):
        expected = angular_momentum_ratio(bearing, gamma, eta, floors_jump=floors_jump)
        assert law(bearing, gamma, eta) == pytest.approx(expected, abs=1e-11)


@pytest.mark.evidence("impact laws", "exact")
@pytest.mark.parametrize("tan", SLENDERNESSES)
def test_restitution_of_known_systems(tan):
    """Of three columns, by the momentum balances and by Housner."""
    bearing = Bearing(1.5, tan, 2.0 * tan, 0.5)
    for law, eta in product(LAWS, (0.0, 1.0, 3.0, 9.0)):
        name = f"e, {law}, tan(alpha) {tan:.2f}, eta {eta:g}"
        expected = angular_momentum_ratio(bearing, 10.0, eta, floors_jump=law == "rigid")
        conforms(
            "impact laws", name, expected, NUMBERS[name], 1e-11,
            "hand calculation", "momentum balance with unknown impulses, five equations",
        )  # fmt: skip
    name = f"e, rectangular block, tan(alpha) {tan:.2f}"
    conforms(
        "impact laws", name, 1.0 - 1.5 * math.sin(bearing.alpha) ** 2, NUMBERS[name], 1e-14,
        "published", "Housner (1963)",
    )  # fmt: skip


@pytest.mark.evidence("impact laws", "published")
@given(st.floats(0.01, 0.5))
def test_a_rectangular_block_has_housners_restitution(tan_alpha):
    bearing = Bearing(1.0, tan_alpha, tan_alpha, FLAT)
    expected = 1.0 - 1.5 * math.sin(bearing.alpha) ** 2
    assert rigid_restitution(bearing, 0.0, 0.0) == pytest.approx(expected, abs=1e-15)


@pytest.mark.evidence("impact laws", "program")
@given(bearings)
def test_the_second_integrator_uses_the_same_restitution(bearing):
    for law in ("rigid", "flexible"):
        structure = podium(1, bearing.slenderness, law=ImpactLaw(law))
        own = StoreyLagrangian(oracle_system(structure)).restitution
        assert structure.restitution == pytest.approx(own, abs=1e-12)


@pytest.mark.evidence("impact laws", "exact")
@given(bearings, ratios, st.floats(0.0, 4.0), st.booleans(), st.floats(0.0, 1.5))
def test_loss_is_where_the_impulse_acts(bearing, gamma, eta, floors_jump, reach):
    """Impulses at p B lose kappa = p (P + Q)/(P + p Q) of what those at B lose."""
    b2 = math.sin(bearing.alpha) ** 2
    sideways = gamma * (1.0 + eta) if floors_jump else gamma
    P = bearing.inertia_ratio - 1.0 + (1.0 + 4.0 * sideways) * (1.0 - b2)
    Q = (1.0 + 4.0 * gamma * (1.0 + eta)) * b2
    kappa = reach * (P + Q) / (P + reach * Q)
    law = ImpactLaw("rigid" if floors_jump else "flexible", loss=kappa)
    own = angular_momentum_ratio(
        bearing, gamma, eta, floors_jump=floors_jump, reach=reach
    )
    assert law.ratio(bearing, gamma, eta) == pytest.approx(own, abs=1e-11)


BEARING = Bearing(1.5, 0.15, 0.3, 0.5)
FLEXIBLE, RIGID = (
    law(BEARING, 10.0, 3.0) for law in (flexible_restitution, rigid_restitution)
)


@pytest.mark.parametrize(
    ("law", "expected"),
    [
        (ImpactLaw(), FLEXIBLE),
        (ImpactLaw(loss=0.0), 1.0),
        (ImpactLaw(loss=0.4, factor=0.98), 0.98 * (0.6 + 0.4 * FLEXIBLE)),
        (ImpactLaw("value", 0.7), 0.7),
        (ImpactLaw("value", 0.7, factor=0.5), 0.35),
        (ImpactLaw("rigid", factor=0.9), 0.9 * RIGID),
    ],
)
def test_loss_value_and_factor(law, expected):
    assert law.ratio(BEARING, 10.0, 3.0) == pytest.approx(expected, rel=1e-15)
    assert law.floors_jump == (law.kind != "flexible")


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"kind": "value"}, "needs a restitution"),
        ({"kind": "rigid", "restitution": 0.9}, "needs a restitution"),
        *(({"kind": kind}, "flexible, rigid or value") for kind in ("Rigid", "mine")),
        *(({"contact_time": time}, r"contact_time = .* must be within 0 and 0.02 s")
          for time in (-1e-6, 0.0201)),
        *(({"kind": "value", "restitution": e}, r"restitution e = .* must be in \(0, 1\]")
          for e in (0.0, -0.2, 1.2)),
    ],
)  # fmt: skip
def test_laws_that_cannot_be_are_refused(given, said):
    with pytest.raises(ValueError, match=said):
        podium(2, law=ImpactLaw(**given))


def test_columns_too_stout_to_go_over_are_refused_with_a_remedy():
    """1 - 2 sin^2(alpha) <= 0 from 45 degrees on, with the rigid law under a heavy building."""
    rigid = ImpactLaw("rigid")
    for tan_alpha, admissible in ((0.99, True), (1.01, False)):
        bearing = Bearing(1.5, tan_alpha, tan_alpha, FLAT)
        if admissible:
            assert (
                PodiumStructure(bearing, 2e4, 2e5, building(3), rigid).restitution > 0.0
            )
            continue
        with pytest.raises(ValueError, match="more slender columns") as refusal:
            PodiumStructure(bearing, 2e4, 2e5, building(3), rigid)
        assert "other edge" in str(refusal.value)
