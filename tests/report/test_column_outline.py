"""A column that is drawn leaning stands on the ground and carries the cap beam."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rpscli.model.bearing import Bearing
from rpscli.model.podium import PodiumStructure
from rpscli.report.figures.bearing import ARC_POINTS, leaning_outline, upright_outline

slendernesses = st.floats(0.05, 0.4)
curvatures = st.sampled_from([0.0, 0.25, 0.5, 1.5, 4.0])


@given(slendernesses, curvatures, st.floats(-1.5, 1.5))
def test_it_touches_ground_and_cap_beam(slenderness: float, curvature: float, lean: float) -> None:
    bearing = Bearing(1.5, slenderness, 2.0 * slenderness, max(curvature, 0.51 * slenderness))
    if curvature == 0.0:
        bearing = Bearing(1.5, slenderness, slenderness, 0.0)
    rotation = lean * bearing.critical_rotation
    _, u, v = PodiumStructure(bearing, 1000.0, 1000.0).path(np.array([abs(rotation)]))
    displacement, lift = float(np.copysign(u[0], rotation)), float(v[0])
    outline = leaning_outline(bearing, rotation, displacement, lift)
    # A chord of the arc, one of eleven, runs this much above the arc it stands for.
    step = bearing.beta / (ARC_POINTS - 1)
    sagitta = bearing.radius * (1.0 - np.cos(0.5 * step)) + 1e-12
    assert outline[:, 1].min() == pytest.approx(0.0, abs=sagitta)
    assert outline[:, 1].max() == pytest.approx(2.0 * bearing.half_height + lift, abs=sagitta)
    # Point-symmetric about its centre, which makes half the way of the cap beam.
    assert outline.mean(axis=0) == pytest.approx(
        [0.5 * displacement, bearing.half_height + 0.5 * lift], abs=1e-12
    )


def test_an_upright_block_is_a_rectangle() -> None:
    block = Bearing(1.0, 0.75, 0.75, 0.0)
    corners = {(round(x, 12), round(y, 12)) for x, y in upright_outline(block).tolist()}
    assert corners == {(0.6, -0.8), (0.6, 0.8), (-0.6, 0.8), (-0.6, -0.8)}
