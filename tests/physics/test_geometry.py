"""Contact geometry: identities over random admissible shapes, the printed table; and sines."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from paper_structures import COMPILED
from scipy.optimize import brentq

from rpscli.model.bearing import Bearing
from rpscli.physics import geometry
from rpscli.physics.laws import sines

pytestmark = pytest.mark.evidence("geometry of columns", "exact")

ROUNDING = 2e-14
"""A few dozen roundings of numbers of the size 1 + 4 rho, which every tolerance is scaled by."""


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
    }
    return table[name][0 if rolling else 1]


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
