"""One swing of a frame with devices: what is left of the energy at the impact, in closed form."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.analyses.trace import tilting_inertia
from rpscli.analyses.verification.comparison import Comparison, compare, within
from rpscli.analyses.verification.structures import FLAT, paper_podium
from rpscli.model.devices import FrictionDamper, RollingResistance, Stop, Tendon
from rpscli.model.podium import Device, PodiumStructure
from rpscli.records.ground_motion import GroundMotion

GROUP = "One swing of a rigid frame with devices (energy at the impact)"
EXACT = 1e-9
START = 0.7
"""Tilt from which it is let go, over theta_cr."""

COLUMNS = 4


def devices() -> Iterator[Comparison]:
    """Energy at the first impact over that without devices."""
    for rho in (FLAT, 0.5):
        bare = replace(paper_podium(1, 0.15, rho), superstructure=None, columns=COLUMNS)
        x = START * bare.critical_rotation
        F, u, v = (float(value[0]) for value in bare.path(np.array([x])))
        e = float(bare.bearing.tendon_elongation(np.array([x]))[0])
        W, lifted = bare.weight, bare.weight * v
        F_d, k_s, d = 0.3 * F, 5.0 * F / u, 0.4 * u
        f, P, k_t = 0.01 * bare.bearing.half_width, 0.02 * W, 0.1 * W / e
        swings: tuple[tuple[str, Device, float], ...] = (
            ("friction", FrictionDamper(F_d), -F_d * u),
            ("rolling resistance", RollingResistance(f), -2.0 * W * f * x),
            ("stop", Stop(d, k_s), 0.5 * k_s * (u - d) ** 2),
            ("tendons", Tendon(P, k_t), COLUMNS * (P * e + 0.5 * k_t * e**2)),
        )
        for name, device, change in swings:
            known = within(1.0 + change / lifted, EXACT)
            found = energy_of_impact(replace(bare, devices=(device,)), x) / lifted
            ends = f"rho = {rho:g}" if rho else "flat"
            yield compare(GROUP, f"E/(W v_b), {name}, {ends}", "-", known, found)


def energy_of_impact(structure: PodiumStructure, rotation: float) -> float:
    """Kinetic energy of the first impact after a release [J].

    Parameters
    ----------
    structure
        Podium, bearings and building.
    rotation
        At release [rad].
    """
    settings = TimeHistorySettings(initial_rotation=rotation, free_vibration=3.0)
    still = GroundMotion(np.zeros(2), 0.01, "stillness", "made", "made")
    result = time_history(structure, still, settings)
    rate = next(event.rotation_rate_before for event in result.events if event.kind == "impact")
    at = np.zeros(1)
    b = structure.bearing
    B, C = np.sin(b.alpha) + at, np.cos(b.alpha) + at
    return float(0.5 * tilting_inertia(structure, B, C)[0] * rate**2)
