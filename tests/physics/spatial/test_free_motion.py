"""Free motion of a tilt to any side: what is conserved, steady wobbling, the angle of turn."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from paper_structures import needs_compiled_kernels
from two_components import frame, released

from rpscli.constants import STANDARD_GRAVITY
from rpscli.model.podium import PodiumStructure

pytestmark = needs_compiled_kernels

ARCS: dict[str, Any] = {"tan_wedge": 0.3, "rho": 0.5}


def potential_and_inertia(structure: PodiumStructure, x: float) -> tuple[float, float]:
    """v_b/2R, and J over N m_c R^2, by their geometry: as the column's centre and corner move."""
    b, gamma = structure.bearing, structure.gamma
    y, k = min(x, b.beta), 2.0 * b.curvature_ratio * math.cos(b.alpha)
    # The contact has rolled to y on the arc; the corner of the flat part is seen from there.
    wide, tall = math.sin(b.alpha) + k * math.sin(y), math.cos(b.alpha) - k * (1.0 - math.cos(y))
    lift = wide * math.sin(x) + tall * math.cos(x) - math.cos(b.alpha)
    rolled = math.sin(b.alpha) + k * y
    out = rolled - (wide * math.cos(x) - tall * math.sin(x))
    spun = 1.0 - math.cos(x) + k * (y - math.sin(y)) / wide
    axial = b.inertia_ratio_axial
    J = (b.inertia_ratio - 1.0) * math.sin(x) ** 2 + axial * spun**2
    return lift, J + (1.0 + 4.0 * gamma) * out**2


@pytest.mark.evidence("both components", "exact")
@pytest.mark.parametrize(
    ("gamma", "ends", "tilt"),
    [(0.0, {}, 0.05), (10.0, ARCS, 0.1), (10.0, ARCS, 0.2)],
    ids=["single", "rolling", "rocking"],
)
def test_steady_wobble(gamma: float, ends: dict[str, Any], tilt: float) -> None:
    """Where w^2 J'/2 = V', the tilt stays."""
    structure, d = frame(gamma=gamma, **ends), 1e-4

    def slopes(h: float) -> tuple[float, float]:
        above, below = (potential_and_inertia(structure, tilt + s) for s in (h, -h))
        return (above[0] - below[0]) / (2.0 * h), (above[1] - below[1]) / (2.0 * h)

    lift, inertia = (
        (4.0 * near - far) / 3.0 for near, far in zip(slopes(d), slopes(2 * d), strict=True)
    )
    # Energy per N m_c R^2: (2 g/R)(1/2 + gamma) v_b/2R, and J w^2/2.
    w2 = 2.0 * STANDARD_GRAVITY / 1.5 * (1.0 + 2.0 * gamma) * lift / inertia
    wobble = released(structure, tilt, tilt * math.sqrt(w2), 20.0, accuracy=4.0)
    assert np.allclose(wobble.samples.theta, tilt, rtol=1e-9, atol=0.0)


@pytest.mark.evidence("both components", "exact")
@pytest.mark.parametrize("accuracy", [1.0, 4.0])
@pytest.mark.parametrize("ends", [{}, ARCS], ids=["flat", "arcs"])
def test_energy_and_momentum_stay(ends: dict[str, Any], accuracy: float) -> None:
    structure = frame(**ends)
    free = released(structure, 0.16, 0.05, 10.0, accuracy=accuracy)
    bar = 1e-6 if accuracy == 1.0 else 1e-9
    first = free.samples[0]
    weight = structure.weight * 3.0
    lift, _ = potential_and_inertia(structure, 0.16)
    _, J = potential_and_inertia(structure, 0.16)
    begun = weight * lift + 0.5 * structure.columns_mass * 2.25 * J * (0.05 / 0.16) ** 2
    assert free.left.energy_stored == pytest.approx(begun, rel=bar)
    for sample in free.samples[::97]:
        _, now = potential_and_inertia(structure, float(sample.theta))
        assert now * sample.turning == pytest.approx(J * first.turning, rel=1e-10)


@pytest.mark.evidence("both components", "program")
def test_free_motion_is_that_of_an_adaptive_integrator() -> None:
    """X and Y after 10 s and eight passes, by a program that shares nothing."""
    free = released(frame(), 0.06, 0.02, 10.0, accuracy=4.0)
    end = complex(-0.05440591401545851, 0.015897195485006645)
    assert abs(free.tilt[-1] - end) < 1e-10
    assert abs(released(frame(), 0.06, 0.02, 10.0).tilt[-1] - end) < 1e-6 * 0.06


TURNS: dict[str, tuple[dict[str, Any], float]] = {
    "frame": ({}, 181.997),
    "three storeys": ({"storeys": 3, "eta": 3.0}, 187.385),
}


@pytest.mark.evidence("both components", "exact")
@pytest.mark.parametrize("across", [4e-8, 4e-9, 1.2e-9])
@pytest.mark.parametrize("building", TURNS)
def test_angle_of_turn(building: str, across: float) -> None:
    """Without loss pi sqrt(A/K), however near (1.2e-9: the map); with an impact's straight on."""
    above, turn = TURNS[building]
    for contact_time, expected in ((0.0, turn), (2e-3, 180.0)):
        structure = frame(**above, contact_time=contact_time)
        free = released(structure, 0.06, across, 0.75, dt=1e-3)
        passed = free.passes[0]
        beyond = (np.arange(len(free.samples)) * 1e-3 > passed.time) & (free.samples.theta > 2e-3)
        azimuth = math.degrees(free.samples.azimuth[np.flatnonzero(beyond)[0]]) % 360.0
        assert azimuth == pytest.approx(expected, abs=0.003)
        if across == 1.2e-9:
            assert passed.least_tilt < 5e-10
        if not above:
            lost = 1.0 - structure.restitution**2 if contact_time else 0.0
            begun = 3.0 * structure.weight * potential_and_inertia(structure, 0.06)[0]
            share = passed.loss_share * lost * begun
            assert passed.energy_lost == pytest.approx(share, rel=1e-6, abs=1e-9 * begun)
