"""Forces along one column and the pressure under its ends, against numbers of another program."""

import math
from dataclasses import replace

import numpy as np
import pytest
from conformance import conforms
from paper_structures import known
from scipy.integrate import quad

from rpscli.model.bearing import Bearing
from rpscli.model.column import ColumnDesign, ColumnState
from rpscli.model.podium import PodiumStructure

STATES = [
    # side, x, x', F and N below, F and N above; P, Q, M at every half of H
    (
        (1, 0.23811128711822446, 0.09913112285501614, -49376.96909623491, 7391581.242615685,
         -31048.55311076634, 7177271.802634789),
        (7171382.8, 7120343.2, 7069340.1, 7018373.4, 6967443.1),
        (-1791418.5, -1763308.2, -1742544.7, -1729128.2, -1723058.6),
        (2629370.2, 1311713.3, 12181.413, -1274674.8, -2554304.6),
    ),
    (
        (-1, 0.14190248504153427, 0.08823974899665779, 491490.1840812633, 7998029.625785885,
         502343.06780178356, 7790318.191047987),
        (7848129.4, 7796296.4, 7744492.4, 7692717.2, 7640970.8),
        (-1617685.3, -1610710.5, -1605280.2, -1601394.4, -1599053.1),
        (2414533.8, 1217409.4, 24885.388, -1164183.7, -2350943.5),
    ),
    (
        (-1, 0.11883949347535636, 0.011916632244497696, 231497.0387169002, 7994979.814939541,
         241076.52693028227, 7814728.757914057),
        (7911144.1, 7866114.4, 7821085.3, 7776056.7, 7731028.6),
        (-1177748.8, -1176262.3, -1173790.3, -1170333.0, -1165890.2),
        (1760314.0, 887243.53, 15641.019, -853762.6, -1720236.4),
    ),
]  # fmt: skip
"""Two of a column on arcs, the last one of a column on flat ends, by an integrator of its own."""

ROUND = ColumnDesign("round", 35e9, 0.2, 25e6)
SQUARE = ColumnDesign("square", 35e9, 0.2, 25e6, edge_length=0.45)


def arcs(radius, width, wedge=0.5):
    """A column whose arcs have this radius, around a flat part of this half width."""
    H = radius / 1.2
    return Bearing(math.hypot(H, width), width / H, wedge / H, 0.6)


@pytest.mark.evidence("forces in columns, friction", "program")
@pytest.mark.parametrize("number", range(3))
def test_forces_along_a_column(number):
    (side, x, rate, F_b, N_b, F_t, N_t), *wanted = STATES[number]
    H, B, r, beta = 1.4834045, 0.22251068, 0.59336181, 0.38439677
    if number == 2:
        r = beta = 0.0
    bearing = Bearing(math.hypot(H, B), B / H, (B + r * math.sin(beta)) / H, 0.5 * r / H)
    y = min(x, beta)
    lever, rise = B + r * math.sin(y), r * (1.0 - math.cos(y))
    state = ColumnState(side, x, rate, lever, rise, F_b, N_b, F_t, N_t)
    found = state.section_forces(bearing, 2e4, np.linspace(0.0, 2.0, 5) * H)
    for name, values, other in zip("PQM", found, wanted, strict=True):
        expected = np.array(other)
        of_column(f"{name} at five places, state {number + 1}", expected, values)


def of_column(quantity, expected, found):
    """A number of another program, with eight digits."""
    conforms(
        "forces in columns, friction", quantity, expected, found, 1e-6 * np.abs(expected),
        "independent program", "integrator of a column, and Hertz by quadrature",
    )  # fmt: skip


@pytest.mark.evidence("forces in columns, friction", "program")
@pytest.mark.parametrize(
    ("design", "force", "radii", "largest", "widths"),
    [
        (ROUND, 525e3, (1.483, 1.483), 248525380.0, (0.031758865, 0.031758865)),
        (ROUND, 525e3, (1.483, 3.71), 187301990.0, (0.026979523, 0.049604836)),
        (ColumnDesign("round", 210e9, 0.3, 1e9), 1.2e6, (0.9, 12.5), 766295970.0,
         (0.011629538, 0.06429299)),
        (SQUARE, 525e3, (1.483, 3.71), 67563368.0, (0.010992985, math.inf)),
    ],
)  # fmt: skip
def test_pressure_on_points_and_lines(design, force, radii, largest, widths):
    x = 0.02
    bearing = arcs(radii[0], (radii[1] - radii[0]) * math.sin(x))
    found = design.pressed(bearing, np.array(x), np.array(force))
    assert math.isfinite(found[2]) == math.isfinite(widths[1])
    of_column("largest pressure [Pa]", largest, float(found[0]))
    of_column("half width of the contact [m]", widths[0], float(found[1]))


@pytest.mark.evidence("forces in columns, friction", "exact")
def test_an_ellipse_between_a_circle_and_a_line():
    """p_0 of a sphere in closed form; of a long ellipse, a line's with the force of its middle."""
    N, r, E = np.array(525e3), 1.483, ROUND.contact_modulus
    largest, *_ = ROUND.pressed(arcs(r, 1e-12), np.array(0.1), N)
    sphere = (6.0 * N * E**2 / (math.pi**3 * r**2)) ** (1.0 / 3.0)
    conforms(
        "forces in columns, friction", "largest pressure of a sphere [Pa]", sphere, largest,
        1e-9 * sphere, "closed form", "Hertz: (6 N E^2/(pi^3 r^2))^(1/3)",
    )  # fmt: skip
    assert ROUND.pressed(arcs(r, 0.0), np.array(0.0), N)[0] == pytest.approx(
        sphere, rel=1e-14
    )
    largest, along, across = ROUND.pressed(arcs(r, 0.2), np.array(1e-9), N)
    of_its_middle = replace(SQUARE, edge_length=4.0 / 3.0 * float(across))
    line, half, _ = of_its_middle.pressed(arcs(r, 0.2), np.array(1e-9), N)
    assert (largest, along) == pytest.approx((line, half), rel=1e-8)
    assert ROUND.pressed(arcs(r, 0.2), np.array(0.1), np.array(-1.0))[0] == 0.0


@pytest.mark.evidence("forces in columns, friction", "program")
def test_edges_that_crush():
    flat = Bearing(math.hypot(1.5, 0.2225), 0.2225 / 1.5, 0.2225 / 1.5, 0.0)
    strip = replace(SQUARE, edge_length=0.445).crushed(flat, 525e3)
    of_column("crushed depth and lever of a strip [m]", (0.047191011, 0.023595506), strip)
    circle = ROUND.crushed(flat, 525e3)
    of_column(
        "crushed depth and lever of a circle [m]", (0.085764436, 0.050820164), circle
    )
    assert ROUND.crushed(flat, -1.0) == (0.0, 0.0)
    whole = math.pi * 0.2225**2 * 25e6
    assert ROUND.crushed(flat, (1.0 - 1e-9) * whole)[0] == pytest.approx(0.445, rel=1e-3)
    assert ROUND.crushed(flat, 2.0 * whole) == pytest.approx((0.89, 0.2225), rel=1e-12)


def test_where_the_laws_of_pressure_end():
    curved, ball = Bearing(1.5, 0.15, 0.3, 0.5), arcs(1.483, 0.0)
    for design in (SQUARE, ROUND):
        assert "flat part" in design.doubt(curved, 0.001, 5e5)
        assert design.doubt(curved, 0.1, 5e5) == design.doubt(ball, 0.001, 5e5) == ""
    assert "half of the distance" in ROUND.doubt(curved, 0.1, 4e7)
    assert "r/5" in ROUND.doubt(ball, 0.1, 5e9)
    on_steel = replace(SQUARE, plate_modulus=210e9)
    pair = [
        d.pressed(curved, np.array(0.1), np.array(5e5))[0] for d in (on_steel, SQUARE)
    ]
    assert pair[0] > pair[1]


def podium_on(bearing, design):
    return PodiumStructure(bearing, 4e4, 4e5, column=design)


BALL = Bearing(1.5, 0.0, 0.3, 0.7)
ARCS = Bearing(1.5, 0.15, 0.3, 0.5)
FLAT = Bearing(1.5, 0.15, 0.15, 0.0)


@pytest.mark.parametrize(
    ("design", "bearing", "ends", "kind"),
    [
        (SQUARE, ARCS, None, "line"),
        (ROUND, ARCS, None, "point"),
        (ROUND, BALL, None, "point"),
        (SQUARE, BALL, None, "point"),  # nothing says which: the larger pressure
        (replace(SQUARE, edge_length=None), BALL, None, "point"),
        (replace(SQUARE, edge_length=None), BALL, "spherical", "point"),
        (replace(SQUARE, edge_length=None), ARCS, "spherical", "point"),
        (SQUARE, BALL, "cylindrical", "line"),
        (SQUARE, ARCS, "cylindrical", "line"),
        (replace(ROUND, edge_length=0.3), BALL, "cylindrical", "line"),
    ],
)
def test_what_ends_touch_is_a_line_or_a_point(design, bearing, ends, kind):
    """Pressure, edge and their words follow one rule; corners are those of unsaid squares."""
    bearing = replace(bearing, ends=ends)
    structure = podium_on(bearing, design)
    found = design.contact(bearing, 0.1)
    x, N = np.array(0.1), np.array(5e5)
    assert (found.kind, design.line(bearing)) == (kind, found.length)
    across = design.pressed(bearing, x, N)[2]
    assert (across == math.inf) == (kind == "line")
    depth, shorter = design.crushed(bearing, 5e5)
    assert (shorter == 0.5 * depth) == (kind == "line")
    assert design.stands_on_corners(bearing) == (ends is None and kind == "line")
    assert bool(structure.planar_only) == (ends == "cylindrical")


@pytest.mark.parametrize(
    ("design", "bearing", "ends", "reason"),
    [
        (ROUND, ARCS, "cylindrical", "L of the line on which an end bears"),
        (replace(SQUARE, edge_length=None), ARCS, None, "belongs to square columns"),
        (replace(ROUND, edge_length=0.3), ARCS, None, "round columns touch in a point"),
        (SQUARE, BALL, "spherical", "spherical ends touch in a point"),
        (SQUARE, FLAT, "spherical", "no meaning for flat ends"),
        (SQUARE, FLAT, "oval", "ends = oval must be spherical, cylindrical or None"),
    ],
)
def test_ends_and_lines_that_contradict_each_other(design, bearing, ends, reason):
    with pytest.raises(ValueError, match=reason):
        podium_on(replace(bearing, ends=ends), design)


def sunk(p_0, a, b, x, y):
    """By how much a half-space of E* = 1 sinks at (x, y) under a semi-ellipsoid of pressure:
    its integral over the distance, along rays from that point.
    """
    nodes, weights = np.polynomial.legendre.leggauss(60)
    t, of_t = 0.5 * (nodes + 1.0), 0.5 * weights
    angles = 2.0 * math.pi * np.arange(400) / 400
    total = 0.0
    for cosine, sine in zip(np.cos(angles), np.sin(angles), strict=True):
        A = (cosine / a) ** 2 + (sine / b) ** 2
        B = x * cosine / a**2 + y * sine / b**2
        C = 1.0 - (x / a) ** 2 - (y / b) ** 2
        end = (math.sqrt(B * B + A * C) - B) / A
        s = end * (1.0 - t * t)  # the root at the end becomes a polynomial in t
        root = np.sqrt(np.maximum(C - 2.0 * B * s - A * s * s, 0.0))
        total += float(of_t @ (root * 2.0 * end * t))
    return p_0 * total * (2.0 * math.pi / 400) / math.pi


@pytest.mark.evidence("forces in columns, friction", "exact")
@pytest.mark.parametrize("width", [0.0, 0.15])
def test_pressure_in_a_point_carries_the_force_and_fits_the_surfaces(width):
    """Hertz from the other side: p_0 on its ellipse is in balance with N, and presses into
    both bodies the shape of the gap, (x^2/R_2 + y^2/R_1)/2.
    """
    bearing = replace(arcs(1.483, width), ends="spherical")
    design, tilt, N = replace(SQUARE, edge_length=None), 0.1, 525e3
    p_0, a, b = map(float, design.pressed(bearing, np.array(tilt), np.array(N)))
    rho = np.linspace(0.0, 1.0, 20001)
    carried = 2.0 * math.pi * a * b * p_0 * np.trapezoid(rho * np.sqrt(1.0 - rho**2), rho)
    conforms(
        "forces in columns, friction", "force that pressures of an ellipse carry [N]", N,
        carried, 1e-5 * N,  # of the sum, whose end has no slope
        "identity", "sum of the pressures",
    )  # fmt: skip
    found = design.contact(bearing, tilt)
    E = design.contact_modulus
    middle = sunk(p_0, a, b, 0.0, 0.0)
    along = (middle - sunk(p_0, a, b, 0.6 * a, 0.0)) / E
    across = (middle - sunk(p_0, a, b, 0.0, 0.6 * b)) / E
    for name, mine, size, radius in (
        ("along", along, a, found.radius),
        ("across", across, b, known(found.radius_across)),
    ):
        expected = (0.6 * size) ** 2 / (2.0 * radius)
        conforms(
            "forces in columns, friction", f"gap closed {name} the motion [m]", expected,
            mine, 1e-9 * expected, "identity", "Boussinesq's half-space under the pressures",
        )  # fmt: skip


@pytest.mark.evidence("forces in columns, friction", "exact")
def test_pressure_on_a_line_carries_the_force_and_fits_the_surfaces():
    """A cylinder: the slope that p_0 presses into both bodies is x/r, its sum N/L."""
    bearing = replace(BALL, ends="cylindrical")
    p_0, b, _ = map(float, SQUARE.pressed(bearing, np.array(0.1), np.array(525e3)))

    def pressure(s):
        return p_0 * math.sqrt(max(1.0 - (s / b) ** 2, 0.0))

    assert quad(pressure, -b, b)[0] == pytest.approx(525e3 / 0.45, rel=1e-9)
    x = 0.6 * b
    principal = quad(pressure, -b, b, weight="cauchy", wvar=x)[0]
    slope = -2.0 * principal / (math.pi * SQUARE.contact_modulus)
    assert slope == pytest.approx(x / bearing.radius, rel=1e-7)


def test_strengths_of_codes_as_pressures():
    """Theory, section 16: 23 R f_u^2/E_d a length is 2.0 f_u, 220 R^2 f_u^3/E_d^2 2.3 f_u."""
    E, f_u, r = 210e9, 470e6, BALL.radius
    steel = ColumnDesign("square", E, 0.3, 2.0 * f_u, edge_length=0.7)
    line = replace(BALL, ends="cylindrical")
    at = np.array(0.1)
    on_line = steel.pressed(line, at, np.array(23.0 * r * f_u**2 / E * 0.7))[0]
    in_point = steel.pressed(BALL, at, np.array(220.0 * r**2 * f_u**3 / E**2))[0]
    assert float(on_line / f_u) == pytest.approx(2.006, abs=5e-4)
    assert float(in_point / f_u) == pytest.approx(2.342, abs=5e-4)
