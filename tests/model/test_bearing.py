"""One bearing: the published table of geometry, the limit rho_cr, and shapes that are refused."""

import math
from dataclasses import replace

import numpy as np
import pytest
from conformance import conforms
from hypothesis import given
from hypothesis import strategies as st
from paper_structures import FLAT
from scipy.optimize import brentq

from rpscli.analyses.known_systems import SLENDERNESSES, geometry_numbers, shape
from rpscli.model.bearing import Bearing
from rpscli.model.podium import PodiumStructure
from rpscli.physics.laws import geometry

GEOMETRIES = [
    # tan(alpha), rho; printed digits of beta, theta_cr, and of u_b and the lift v_b there
    (0.10, 0.25, "0.2014", "0.1974", "0.593", "0.030"),
    (0.10, 0.5, "0.1002", "0.1984", "0.5975", "0.044"),
    (0.10, 1.5, "0.0333", "0.1977", "0.5971", "0.054"),
    (0.15, 0.25, "0.3047", "0.2915", "0.877", "0.065"),
    (0.15, 0.5, "0.1506", "0.2946", "0.8917", "0.099"),
    (0.15, 1.5, "0.0500", "0.2925", "0.8902", "0.120"),
    (0.20, 0.25, "0.4115", "0.3805", "1.148", "0.113"),
    (0.20, 0.5, "0.2014", "0.3876", "1.1807", "0.172"),
    (0.20, 1.5, "0.0667", "0.3828", "1.1771", "0.208"),
    (0.10, FLAT, "0.0000", "0.0997", "0.2985", "0.015"),
    (0.15, FLAT, "0.0000", "0.1489", "0.4450", "0.033"),
    (0.20, FLAT, "0.0000", "0.1974", "0.5883", "0.058"),
]


NUMBERS = dict(geometry_numbers())


@pytest.mark.evidence("geometry of columns", "published")
@pytest.mark.parametrize(
    ("tan", "rho", "beta", "critical", "displacement", "lift"), GEOMETRIES
)
def test_table_of_geometry(tan, rho, beta, critical, displacement, lift):
    printed = {
        "beta": beta,
        "theta_cr": critical,
        "u_b at theta_cr [m]": displacement,
        "v_b at theta_cr [m]": lift,
    }
    for quantity, digits in printed.items():
        if quantity == "beta" and not rho:
            continue
        name = f"{quantity}, {shape(tan, rho)}"
        # half of the last digit; .098495 is printed as .099, rounded twice
        within = 0.51 * 10.0 ** -len(digits.partition(".")[2])
        conforms(
            "geometry of columns", name, float(digits), NUMBERS[name], within,
            "published", "table of the geometry of the paper's columns",
        )  # fmt: skip


@pytest.mark.evidence("geometry of columns", "exact")
@pytest.mark.parametrize("tan", SLENDERNESSES)
def test_limits_of_overturning_while_rolling(tan):
    """Where tan(beta) (1 - 2 rho) is tan(alpha), with sin(beta) = tan(alpha)/(2 rho)."""
    alone = brentq(
        lambda rho: tan / (2.0 * rho) * (1.0 - 2.0 * rho)
        - tan * math.sqrt(1.0 - (tan / (2.0 * rho)) ** 2),
        0.6 * tan, 0.5, xtol=1e-15,
    )  # fmt: skip
    name = f"rho_cr, tan(alpha) {tan:.2f}"
    conforms(
        "geometry of columns", name, alone, NUMBERS[name], 1e-10 * alone,
        "closed form", "root of tan(beta) (1 - 2 rho) = tan(alpha)",
    )  # fmt: skip


slopes = st.floats(0.01, 0.5)
widenings = st.floats(1.02, 2.9)


@pytest.mark.evidence("geometry of columns", "exact")
@given(slopes, widenings)
def test_the_exact_limit_of_overturning_while_rolling(tan_alpha, widening):
    rise = tan_alpha * (widening - 1.0)

    def excess(rho):
        """tan(beta) (1 - 2 rho) - tan(alpha), multiplied out by cos(beta)."""
        return rise / (2.0 * rho) * (1.0 - 2.0 * rho) - tan_alpha * math.sqrt(
            1.0 - min(rise / (2.0 * rho), 1.0) ** 2
        )

    bearing = Bearing(1.0, tan_alpha, tan_alpha + rise, 5.0)
    expected = brentq(excess, 0.5 * rise * (1.0 + 1e-12), 0.5, xtol=1e-15)
    rho_cr = bearing.critical_curvature_ratio
    assert rho_cr == pytest.approx(expected, rel=1e-10)
    below, at, above = (
        Bearing(1.0, tan_alpha, tan_alpha + rise, factor * rho_cr)
        for factor in (1.0 - 1e-6, 1.0, 1.0 + 1e-6)
        if 2.0 * factor * rho_cr > rise
    )
    assert at.critical_rotation == pytest.approx(at.beta, rel=1e-7)
    assert below.overturns_rolling
    assert not above.overturns_rolling
    # the first-order value is near, and goes over into it for slender columns
    paper = at.critical_curvature_ratio_of_paper
    assert paper == pytest.approx(
        rho_cr, rel=2.0 * (widening * tan_alpha) ** 2 * widening
    )


@pytest.mark.parametrize(
    ("tan_alpha", "exact"), [(0.10, 0.2525), (0.15, 0.2556), (0.20, 0.2600)]
)
def test_exact_limits_that_the_theory_prints(tan_alpha, exact):
    bearing = Bearing(1.5, tan_alpha, 2.0 * tan_alpha, 0.5)
    assert bearing.critical_curvature_ratio == pytest.approx(exact, abs=5e-5)
    assert bearing.critical_curvature_ratio_of_paper == pytest.approx(0.25, abs=1e-15)


@given(slopes, st.floats(0.3, 5.0), st.sampled_from([FLAT, 0.5, 2.0]))
def test_sizes_fit_together(tan_alpha, size, rho):
    bearing = Bearing(size, tan_alpha, 1.5 * tan_alpha, rho)
    H, B = bearing.half_height, bearing.half_width
    assert math.hypot(H, B) == pytest.approx(size, rel=1e-14)
    assert pytest.approx(tan_alpha * H, rel=1e-14) == B
    assert bearing.radius == pytest.approx(2.0 * H * rho, rel=1e-14)
    # the arc of radius r spans from B to B' = H tan(alpha')
    if rho:
        reach = B + bearing.radius * math.sin(bearing.beta)
        assert reach == pytest.approx(H * math.tan(bearing.alpha_wedge), rel=1e-12)
    else:
        assert bearing.alpha_wedge == bearing.alpha


def test_an_arc_of_no_width_is_a_flat_end():
    """tan alpha' = tan alpha with a radius: the column never rolls."""
    without, flat = Bearing(1.5, 0.15, 0.15, 0.5), Bearing(1.5, 0.15, 0.15, FLAT)
    assert without.is_flat
    assert without.beta == 0.0
    assert without.critical_rotation == pytest.approx(flat.critical_rotation, rel=1e-15)
    assert without.critical_curvature_ratio == 0.0
    stiffness = PodiumStructure(without, 2e4, 2e5).initial_stiffness
    assert stiffness == pytest.approx(
        PodiumStructure(flat, 2e4, 2e5).initial_stiffness, rel=1e-14
    )


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"semi_diagonal": 0.0}, "semi_diagonal = 0.0 must be > 0"),
        ({"semi_diagonal": math.inf}, "semi_diagonal = inf must be a finite number"),
        ({"slenderness": -0.1}, "slenderness = -0.1 must be >= 0"),
        ({"slenderness": math.nan}, "slenderness = nan must be a finite"),
        ({"inertia_ratio": 0.0}, "inertia_ratio = 0.0 must be > 0"),
        ({"curvature_ratio": -0.2}, "curvature_ratio = -0.2 must be >= 0"),
        ({"curvature_ratio": math.nan}, "curvature_ratio = nan must be a finite"),
        (
            {"wedge_slenderness": 0.1},
            "wedge_slenderness = 0.1 must be >= slenderness = 0.15",
        ),
        ({"wedge_slenderness": math.nan}, "wedge_slenderness = nan must be"),
        ({"curvature_ratio": 0.07}, "curvature_ratio = 0.07 must be >= 0.075"),
        ({"inertia_ratio_axial": 0.0}, "inertia_ratio_axial = 0.0 must be > 0"),
    ],
)
def test_shapes_that_cannot_be_built_are_refused(changes, said):
    with pytest.raises(ValueError, match=said):
        replace(Bearing(1.5, 0.15, 0.30, 0.5, 4.0 / 3.0), **changes)


@pytest.mark.parametrize("rho", [0.0, 0.08, 0.25, 0.5, 2.0])
@pytest.mark.parametrize("slenderness", [0.05, 0.15, 0.7])
def test_the_cap_beam_moves_on_until_the_model_ends(rho, slenderness):
    bearing = Bearing(1.5, slenderness, 1.15 * slenderness, rho)
    end = bearing.largest_rotation
    assert bearing.critical_rotation < end
    x = np.linspace(0.0, end, 2001)
    _, C, u, _ = geometry.path_along(bearing.rolling, bearing.rocking, bearing.beta, x)
    assert np.all(np.diff(u) > 0.0)
    assert end == math.pi or C[-1] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.evidence("geometry of columns", "exact")
def test_the_axial_inertia_is_that_of_a_solid_round_column():
    """I_3 = m b^2/2 of a cylinder of half-width b, over m R^2."""
    arc, flat = Bearing(1.5, 0.15, 0.30, 0.5), Bearing(1.5, 0.15, 0.30, 0.0)
    half_width = arc.half_height * 0.30
    assert arc.inertia_ratio_axial == pytest.approx(
        0.5 * (half_width / 1.5) ** 2, rel=1e-14
    )
    assert flat.inertia_ratio_axial == pytest.approx(
        0.5 * math.sin(flat.alpha) ** 2, rel=1e-14
    )
    assert (
        Bearing(1.5, 0.15, 0.3, 0.5, inertia_ratio_axial=0.02).inertia_ratio_axial == 0.02
    )
