"""Contact geometry: identities over random admissible shapes, the printed table; and sines."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from paper_structures import COMPILED
from scipy.optimize import brentq

from rpscli.model.bearing import Bearing
from rpscli.physics import geometry
from rpscli.physics.geometry import Phase
from rpscli.physics.laws import sines

pytestmark = pytest.mark.evidence("geometry of columns", "exact")

ROUNDING = 2e-14
"""A few dozen roundings of numbers of the size 1 + 4 rho, which every tolerance is scaled by."""

DIFFERENCES = 1e-11
"""Central differences of order 6 with h = 1e-2 leave h^6/140 and eps/h, both below 1e-14."""


class Shape(NamedTuple):
    """tan(alpha), alpha, beta, rho and k = 2 rho cos(alpha)."""

    bearing: Bearing
    alpha: float
    beta: float
    k: float
    scale: float


def shape_of(tan_alpha: float, widening: float, sin_beta: float) -> Shape:
    rise = tan_alpha * (widening - 1.0)
    bearing = Bearing(1.0, tan_alpha, tan_alpha + rise, rise / (2.0 * sin_beta))
    k = 2.0 * bearing.curvature_ratio * math.cos(bearing.alpha)
    return Shape(bearing, bearing.alpha, bearing.beta, k, 1.0 + 4.0 * bearing.curvature_ratio)


shapes = st.builds(shape_of, st.floats(0.02, 0.6), st.floats(1.05, 3.0), st.floats(0.02, 0.999))
tilts = st.floats(0.0, 1.4)


def value(phase: Phase, name: str, x: float) -> float:
    cos_x, sin_x = math.cos(x), math.sin(x)
    if name == "u":
        return geometry.cap_beam_displacement(phase, x, cos_x, sin_x)
    formula: dict[str, Callable[[Phase, float, float], float]] = {
        "B": geometry.contact_arm,
        "C": geometry.contact_height,
        "v": geometry.cap_beam_lift,
    }
    return formula[name](phase, cos_x, sin_x)


def slope(phase: Phase, name: str, x: float, h: float = 1e-2) -> float:
    weights = {1: 45.0, 2: -9.0, 3: 1.0}
    total = sum(
        w * (value(phase, name, x + i * h) - value(phase, name, x - i * h))
        for i, w in weights.items()
    )
    return total / (60.0 * h)


def printed(shape: Shape, name: str, x: float, *, rolling: bool) -> float:
    """Theory, section 1, as it stands in the table."""
    a, b, k, sin, cos = shape.alpha, shape.beta, shape.k, math.sin, math.cos
    table = {
        "B": (sin(a - x) + k * sin(x), sin(a - x) + k * (sin(b - x) + sin(x))),
        "C": (cos(a - x) + k * (1.0 - cos(x)), cos(a - x) + k * (cos(b - x) - cos(x))),
        "u": (
            sin(a) - sin(a - x) + k * (x - sin(x)),
            sin(a) - sin(a - x) + k * (b - sin(x) - sin(b - x)),
        ),
        "v": (
            cos(a - x) - cos(a) + k * (1.0 - cos(x)),
            cos(a - x) - cos(a) + k * (cos(b - x) - cos(x)),
        ),
        "S": (
            1.0 + 2.0 * k * (cos(a - x) - cos(a)) + 2.0 * k**2 * (1.0 - cos(x)),
            1.0 + 2.0 * k * (cos(a - b) - cos(a)) + 2.0 * k**2 * (1.0 - cos(b)),
        ),
    }
    return table[name][0 if rolling else 1]


@given(shapes, tilts)
@example(shape_of(0.15, 2.0, 0.15), 0.0)
def test_folded_constants_are_the_printed_table(shape: Shape, x: float) -> None:
    for rolling, phase in ((True, shape.bearing.rolling), (False, shape.bearing.rocking)):
        tolerance = ROUNDING * shape.scale
        for name in "BCuv":
            expected = printed(shape, name, x, rolling=rolling)
            assert value(phase, name, x) == pytest.approx(expected, abs=tolerance)
        B, C = value(phase, "B", x), value(phase, "C", x)
        expected = printed(shape, "S", x, rolling=rolling)
        assert pytest.approx(expected, abs=tolerance * shape.scale) == B**2 + C**2


@given(shapes, tilts)
def test_derivatives(shape: Shape, x: float) -> None:
    a, k, cos = shape.alpha, shape.k, math.cos
    for rolling, phase in ((True, shape.bearing.rolling), (False, shape.bearing.rocking)):
        B, C = value(phase, "B", x), value(phase, "C", x)
        tolerance = DIFFERENCES * shape.scale
        assert slope(phase, "C", x) == pytest.approx(B, abs=tolerance)
        falls = -cos(a - x) + k * cos(x) if rolling else -C
        assert slope(phase, "B", x) == pytest.approx(falls, abs=tolerance)
        assert phase.c - C == pytest.approx(falls, abs=tolerance)
        assert slope(phase, "u", x) == pytest.approx(C, abs=tolerance)
        assert slope(phase, "v", x) == pytest.approx(B, abs=tolerance)


@given(shapes)
def test_nothing_jumps_where_rolling_ends(shape: Shape) -> None:
    for name in "BCuv":
        rolling = value(shape.bearing.rolling, name, shape.beta)
        rocking = value(shape.bearing.rocking, name, shape.beta)
        assert rolling == pytest.approx(rocking, abs=ROUNDING * shape.scale)


@given(st.floats(0.02, 0.6))
def test_flat_ends_rock_like_housners_block(tan_alpha: float) -> None:
    flat = Bearing(1.0, tan_alpha, 2.0 * tan_alpha, 0.0)
    a = flat.alpha
    assert flat.beta == 0.0
    assert flat.critical_rotation == pytest.approx(a, rel=1e-15)
    for x in (0.0, 0.5 * a, a):
        # differences and sums of two products below 1
        assert value(flat.rocking, "B", x) == pytest.approx(math.sin(a - x), abs=4e-16)
        assert value(flat.rocking, "C", x) == pytest.approx(math.cos(a - x), abs=4e-16)


@given(shapes)
def test_critical_rotation_is_the_first_root_on_the_branch_travelled(shape: Shape) -> None:
    def B(x: float) -> float:
        return printed(shape, "B", x, rolling=x < shape.beta)

    grid = np.linspace(0.0, 1.999 * math.pi, 801)  # B stays negative for half a turn
    signs = np.array([B(x) for x in grid])
    first = int(np.argmax(signs < 0.0))
    assert signs[0] > 0.0
    assert first > 0
    root = float(brentq(B, grid[first - 1], grid[first], xtol=1e-15))
    # B falls by at least its slope -C, |C| > 0.1 here; rounding of B is that of k
    assert shape.bearing.critical_rotation == pytest.approx(root, abs=1e-12 * shape.scale)


@given(shapes, st.lists(st.floats(0.0, 1.4), min_size=1, max_size=5))
def test_the_path_takes_each_point_in_its_own_phase(shape: Shape, tilt: list[float]) -> None:
    x = np.array(tilt)
    bearing = shape.bearing
    path = geometry.path_along(bearing.rolling, bearing.rocking, bearing.beta, x)
    for name, column in zip("BCuv", path, strict=True):
        expected = [printed(shape, name, t, rolling=t < bearing.beta) for t in tilt]
        assert column == pytest.approx(expected, abs=ROUNDING * shape.scale)


LAST_PLACES = 3.4e-16
"""Three units of the last place below 1."""

LEFT_OUT = (0.5 * math.pi) ** 21 / math.factorial(21)
"""First term of the sine that is left out, where it is largest: 2.6e-16."""

POINTS = 20_001 if COMPILED else 501


@pytest.mark.parametrize(
    ("end", "error"), [(1.4, LAST_PLACES), (0.5 * math.pi, LAST_PLACES + LEFT_OUT)]
)
def test_up_to_a_quarter_of_a_turn(end: float, error: float) -> None:
    for x in np.linspace(0.0, end, POINTS).tolist():
        sine, less, _ = sines(x)
        assert abs(sine - math.sin(x)) <= error, x
        assert abs(1.0 - less - math.cos(x)) <= LAST_PLACES, x


@given(st.floats(1e-9, 0.1))
def test_near_zero_nothing_is_lost(x: float) -> None:
    _, less, excess = sines(x)
    assert less == pytest.approx(2.0 * math.sin(0.5 * x) ** 2, rel=4e-16)
    series = x**3 / 6.0 * (1.0 - x * x / 20.0 * (1.0 - x * x / 42.0 * (1.0 - x * x / 72.0)))
    assert excess == pytest.approx(series, rel=1e-14)
