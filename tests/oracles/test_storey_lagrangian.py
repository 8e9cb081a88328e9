"""Lagrange's equations in tilt and drifts against the published ones."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest

from .reference_systems import podium
from .storey_lagrangian import Contact, OracleSystem, StoreyLagrangian

pytestmark = pytest.mark.evidence("equation of motion", "published")


class Coefficients(NamedTuple):
    A: float
    B: float
    C: float
    D: float


def published_coefficients(system: OracleSystem, x: float, *, rolling: bool) -> Coefficients:
    """A, B, C, D of the equation of motion, Theory, sections 1 and 2."""
    alpha, k = math.atan(system.tan_alpha), 2.0 * system.rho * math.cos(math.atan(system.tan_alpha))
    beta = math.asin((system.tan_alpha_wedge - system.tan_alpha) / (2.0 * system.rho))
    start = 0.0 if rolling else beta - x
    cap = system.cap_beam_mass / system.columns_mass
    floors = float(np.sum(system.masses)) / system.columns_mass
    B = math.sin(alpha - x) + k * (math.sin(start) + math.sin(x))
    C = math.cos(alpha - x) + k * (math.cos(start) - math.cos(x))
    B_slope = -math.cos(alpha - x) + k * math.cos(x) if rolling else -C
    A = system.inertia_ratio - 1.0 + (1.0 + 4.0 * cap) * (B**2 + C**2) + 4.0 * floors * B**2
    D = 4.0 * floors * B * B_slope + ((1.0 + 4.0 * cap) * k * B if rolling else 0.0)
    return Coefficients(A, B, C, D)


@pytest.mark.parametrize("rolling", [True, False])
@pytest.mark.parametrize("side", [1, -1])
def test_lagrange_equations_are_those_of_the_theory(side: int, rolling: bool) -> None:
    rng = np.random.default_rng(7 + side + 2 * rolling)
    for _ in range(20):
        n = 3
        system = replace(
            podium(n, rng.uniform(0.05, 0.3), rng.uniform(0.4, 1.5)),
            R=rng.uniform(0.5, 3.0),
            columns_mass=rng.uniform(0.05, 1.0),
            inertia_ratio=rng.uniform(1.1, 1.5),
        )
        x, w = rng.uniform(0.01, 0.3), rng.uniform(-1.0, 1.0)
        d, d1 = rng.uniform(-0.1, 0.1, n), rng.uniform(-1.0, 1.0, n)
        a_g, g = rng.uniform(-5.0, 5.0), rng.uniform(8.0, 12.0)
        y = np.concatenate(([side * x], d, [w], d1))
        ours = StoreyLagrangian(system).acceleration(Contact(side, rolling), y, a_g, g)

        A, B, C, D = published_coefficients(system, x, rolling=rolling)
        cap = system.cap_beam_mass / system.columns_mass
        floors = float(np.sum(system.masses)) / system.columns_mass
        between = np.eye(n) - np.eye(n, k=-1)
        stiffness_matrix = between.T @ np.diag(system.stiffnesses) @ between
        storey_forces = stiffness_matrix @ np.cumsum(d) + system.damping_matrix @ np.cumsum(d1)
        shear = float(np.sum(storey_forces))
        tilt = -side * B * g / system.R * (1 + 2 * cap + 2 * floors) - side * D * w**2
        tilt -= C * (a_g / system.R * (1 + 2 * cap) - 2 * shear / (system.columns_mass * system.R))
        cap_beam = 2.0 * system.R * (C * tilt / A + side * B * w**2)
        absolute = cap_beam + np.cumsum(ours[1:])
        # both are sums of terms of up to 1e4 m/s2 in double precision
        assert ours[0] == pytest.approx(tilt / A, rel=1e-10, abs=1e-10)
        assert absolute == pytest.approx(-a_g - storey_forces / system.masses, rel=1e-9, abs=1e-9)
