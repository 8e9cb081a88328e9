"""Systems whose numbers others know: shapes and buildings of the founding paper, pulses.

Each number has the name under which `rpscli/conformance.json` says what is expected.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from rpscli.analyses.modal import UpliftedModes, modal
from rpscli.model.bearing import Bearing
from rpscli.model.impact import ImpactLaw, flexible_restitution, rigid_restitution
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import (
    RayleighDamping,
    Superstructure,
    profile_stiffnesses,
)
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.measures import intensity_measures, measured

SLENDERNESSES = (0.10, 0.15, 0.20)
RADII = (0.0, 0.25, 0.5, 1.5)
"""rho; 0 is a flat end."""
STOREYS = (1, 2, 3, 6, 10)
SIZES = ((0.25, 1.5), (1.5, 0.5), (1.5, 1.0), (1.5, 1.5), (1.5, 3.0), (0.0, 1.5))
"""rho and R [m] of six storeys."""
LAWS = {"flexible": flexible_restitution, "rigid": rigid_restitution}
DAMPINGS = (0.0, 0.05, 0.3)


def shape(tan_alpha: float, rho: float) -> str:
    """A bearing in words."""
    ends = f"rho {rho:g}" if rho else "flat"
    return f"tan(alpha) {tan_alpha:.2f}, {ends}"


def phase(rho: float) -> str:
    """What a column does in an uplifted mode: it rolls with rho, or rocks, for 0."""
    return f"rolling, rho {rho:g}" if rho else "rocking"


def geometry_numbers() -> Iterator[tuple[str, float]]:
    """Of bearings with R = 1.5 m, arcs twice as wide as their flat part."""
    for tan_alpha in SLENDERNESSES:
        for rho in RADII:
            bearing = Bearing(1.5, tan_alpha, 2.0 * tan_alpha, rho)
            end = bearing.critical_rotation
            _, moved, lifted = PodiumStructure(bearing, 2e4, 2e5).path(np.array([end]))
            name = shape(tan_alpha, rho)
            if rho:
                yield f"beta, {name}", bearing.beta
            yield f"theta_cr, {name}", end
            yield f"u_b at theta_cr [m], {name}", float(moved[0])
            yield f"v_b at theta_cr [m], {name}", float(lifted[0])
        limit = Bearing(1.5, tan_alpha, 2.0 * tan_alpha, 0.5).critical_curvature_ratio
        yield f"rho_cr, tan(alpha) {tan_alpha:.2f}", limit


def paper_podium(storeys: int, rho: float, R: float = 1.5) -> PodiumStructure:
    """gamma = 10, eta = n, T_1 = n/10 s, 5 % in modes 1 and 2, tan(alpha) = 0.15."""
    masses = np.full(storeys, 2e5)
    stiffnesses = profile_stiffnesses(masses, storeys / 10.0, "sine")
    above = Superstructure(masses, stiffnesses, RayleighDamping(0.05, (1, 2)))
    bearing = Bearing(R, 0.15, 0.30, rho)
    return PodiumStructure(bearing, 2e4, 2e5, above, ImpactLaw("rigid"))


def modal_numbers() -> Iterator[tuple[str, float]]:
    """Of uplifted states to first order in alpha, as the paper has them."""
    for storeys in STOREYS:
        for rho in RADII:
            modes = _first_order(storeys, rho)
            name = f"{storeys} storeys, {phase(rho)}"
            yield f"omega_u/omega_0, {name}", float(modes.frequency_ratio[0])
            yield f"xi_u/xi_0, {name}", float(modes.damping_ratio[0])
    for rho, R in SIZES:
        modes = _first_order(6, rho, R)
        name = f"6 storeys, {phase(rho)}, R {R:g} m"
        yield f"p_ext [rad/s], {name}", modes.frequency_parameter
        yield f"rigid estimate of p_ext [rad/s], {name}", modes.frequency_parameter_rigid


def _first_order(storeys: int, rho: float, R: float = 1.5) -> UpliftedModes:
    states = modal(paper_podium(storeys, rho or 0.5, R)).both_orders
    return states["rolling" if rho else "rocking"][1]


def impact_numbers() -> Iterator[tuple[str, float]]:
    """Restitution of columns under a beam of gamma = 10 and floors of eta = n."""
    for tan_alpha in SLENDERNESSES:
        bearing = Bearing(1.5, tan_alpha, 2.0 * tan_alpha, 0.5)
        for law, restitution in LAWS.items():
            for eta in (0.0, 1.0, 3.0, 9.0):
                name = f"e, {law}, tan(alpha) {tan_alpha:.2f}, eta {eta:g}"
                yield name, restitution(bearing, 10.0, eta)
        alone = replace(bearing, curvature_ratio=0.0)
        block = rigid_restitution(alone, 0.0, 0.0)
        yield f"e, rectangular block, tan(alpha) {tan_alpha:.2f}", block


def sudden_load() -> GroundMotion:
    """A constant acceleration of 3 m/s2 for 40 s."""
    return GroundMotion(np.full(4001, 3.0), 0.01)


def one_sine() -> GroundMotion:
    """3 sin(2 pi t) m/s2 for 1 s, with 4,000 intervals."""
    time = np.arange(4001) / 4000
    return GroundMotion(3.0 * np.sin(2.0 * np.pi * time), 1.0 / 4000)


def record_numbers() -> Iterator[tuple[str, float]]:
    """Intensity measures of motions whose integrals are known."""
    load = sudden_load()
    yield "AvgSa [m/s2], sudden load", measured(load, "AvgSa", 0.8)
    yield "Housner intensity [m], sudden load", measured(load, "Housner")
    for damping in DAMPINGS:
        found = measured(load, "Sa", 4.0, damping)
        yield f"Sa at 4 s [m/s2], sudden load, damping {damping:g}", found
    sine = intensity_measures(one_sine())
    yield "PGV [m/s], one sine", sine.pgv
    yield "PGD [m], one sine", sine.pgd
    yield "Arias intensity [m/s], one sine", sine.arias
    yield "CAV [m/s], one sine", sine.cav


NUMBERS = (geometry_numbers, modal_numbers, impact_numbers, record_numbers)
"""All of them take some seconds."""
