"""Both horizontal directions: free motion, steady wobble, near passes, and one component alone."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from rpscli.analyses.demand import Request, demands
from rpscli.analyses.kernels.history import FIRST_LOG, follow, longest_history, run_of
from rpscli.analyses.kernels.history import Request as HistoryRequest
from rpscli.analyses.kernels.systems import paired_systems
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.verification.known import (
    FLAT,
    Comparison,
    Known,
    compare,
    motion,
    paper_podium,
    within,
)
from rpscli.analyses.verification.motions import ACCURACY, shipped_record
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import PodiumStructure
from rpscli.physics.run import Run
from rpscli.records.ground_motion import MotionComponents
from rpscli.records.loading import load_record

FREE = "Free motion of a frame in both directions (energy and angular momentum)"
TURN = "Azimuth turned by a pass near upright (straight line on a cone)"
ALONE = "One component in both directions' kernel against the planar one"
EXACT, TILT, TURNING, STEADY = 1e-8, 0.12, 0.8, 0.05


def of_paper(storeys: int, rho: float, contact_time: float = 2e-3) -> PodiumStructure:
    """The paper's podium with the law flexible, and a building or none."""
    law = ImpactLaw("flexible", contact_time=contact_time)
    structure = replace(paper_podium(max(storeys, 1), 0.15, rho), impact_law=law)
    return structure if storeys else replace(structure, superstructure=None)


def released(structure: PodiumStructure, tilt: float, turning: float, seconds: float) -> Run:
    """Let go at a tilt [rad] whose azimuth turns [rad/s]."""
    settings = TimeHistorySettings(free_vibration=seconds, initial_rotation=tilt, accuracy=ACCURACY)
    systems = paired_systems([(structure, settings)]).copy()
    systems["initial_turning"] = turning
    still = motion(np.zeros(2), 0.01)
    moving, one = MotionComponents(still, y=still), [HistoryRequest(0, 0)]
    rows = longest_history(structure, settings, moving)
    run = run_of(systems, [moving], one, pairs=True, rows=rows, events=FIRST_LOG)
    follow(run, lanes=1)
    return run


def inertia(structure: PodiumStructure, x: float) -> float:
    """J of the azimuth over N m_c R^2 (Theory (13.3))."""
    b = structure.bearing
    y, k = min(x, b.beta), 2.0 * b.curvature_ratio * math.cos(b.alpha)
    out = float(structure.path(np.array([x]))[1][0]) / (2.0 * b.semi_diagonal)
    spun = 1.0 - math.cos(x) + k * (y - math.sin(y)) / (math.sin(b.alpha) + k * math.sin(y))
    turned = (b.inertia_ratio - 1.0) * math.sin(x) ** 2 + b.inertia_ratio_axial * spun**2
    return turned + (1.0 + 4.0 * structure.gamma) * out**2


def energy(structure: PodiumStructure, x: float, L: float) -> float:
    """Where the tilt neither grows nor falls [J]; L = J phi'."""
    unit = structure.columns_mass * structure.bearing.semi_diagonal**2
    lift = float(structure.path(np.array([x]))[2][0])
    return 0.5 * unit * L**2 / inertia(structure, x) + structure.weight * lift


def free_motion() -> Iterator[Comparison]:
    """Energy and L stay and tell the closest approach; a steady wobble stays as it is."""
    from scipy.optimize import brentq

    for rho in (FLAT, 0.5):
        structure = of_paper(0, rho, 0.0)
        L = inertia(structure, TILT) * TURNING
        begun = energy(structure, TILT, L)
        least = brentq(lambda x, of, L, E: energy(of, x, L) - E, 1e-3, 0.6 * TILT,
                       (structure, L, begun), xtol=1e-15)  # fmt: skip
        run = released(structure, TILT, TURNING, 10.0)
        left, log = run.results[0], run.output.log
        last = run.output.samples[int(left.intervals)]
        spin = inertia(structure, float(last.theta)) * float(last.turning)
        for name, unit, known, found in (
            ("least tilt", "rad", least, log.least_tilt[np.argmax(log.least_tilt > 0.0)]),
            ("J phi' after 10 s", "1/s", L, spin),
            ("energy after 10 s", "J", begun, left.energy_stored),
        ):
            ends = f"rho = {rho:g}" if rho else "flat"
            yield compare(FREE, f"{name}, {ends}", unit, within(known, EXACT), found)
    structure = of_paper(0, FLAT)
    b, gamma, x = structure.bearing, structure.gamma, STEADY
    # phi'^2 H = (g/R)(1 + 2 gamma) B with flat ends (Theory (13.17))
    H = (b.inertia_ratio - 1.0) * math.cos(x) + b.inertia_ratio_axial * (1.0 - math.cos(x))
    out = math.sin(b.alpha) - math.sin(b.alpha - x)
    H = H * math.sin(x) + (1.0 + 4.0 * gamma) * out * math.cos(b.alpha - x)
    square = structure.gravity / b.semi_diagonal * (1.0 + 2.0 * gamma) / H
    run = released(structure, x, math.sqrt(square * math.sin(b.alpha - x)), 10.0)
    largest = run.output.samples[: int(run.results[0].intervals) + 1].theta.max()
    yield compare(FREE, "tilt of a steady wobble", "rad", within(x, EXACT), largest)


def passes() -> Iterator[Comparison]:
    """pi sqrt(A(0)/K(0)) without loss; straight on where contacts take longer than the pass."""
    for contact_time in (0.0, 2e-3):
        structure = of_paper(0, FLAT, contact_time)
        b, heavy = structure.bearing, 1.0 + 4.0 * structure.gamma
        cone = (b.inertia_ratio - 1.0 + heavy) / (
            b.inertia_ratio - 1.0 + heavy * math.cos(b.alpha) ** 2
        )
        samples = released(structure, 0.06, 1e-6, 0.75).output.samples
        beyond = int(np.argmax((samples.theta > 2e-3) & (np.abs(samples.azimuth) > 1.0)))
        turned = math.degrees(float(samples.azimuth[beyond])) % 360.0
        known = Known(180.0 if contact_time else 180.0 * math.sqrt(cone), 0.003)
        yield compare(TURN, f"t_c = {1e3 * contact_time:g} ms", "deg", known, turned)


def one_component() -> Iterator[Comparison]:
    """Largest rotation of both kernels in 5 s, some sixty impacts and three re-contacts."""
    whole = load_record(shipped_record("synthetic_far_field"))
    x = motion(whole.acceleration[:501], whole.dt)
    still = replace(x, acceleration=np.zeros(x.npts))
    settings, structure = TimeHistorySettings(0.0, accuracy=ACCURACY), of_paper(3, 0.5)
    plane, space = (
        demands([Request(structure, moving, settings)])[0].max_rotation
        for moving in (MotionComponents(x), MotionComponents(x, y=still))
    )
    yield compare(ALONE, "theta, n = 3, rho = 0.5", "rad", within(plane, 1e-5), space)
