"""Bodies in contact against the second integrator in space, whose passes lose nothing here.

The engine's contacts close within 0.08 ms; passes of these motions take 60 ms and more.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from paper_structures import RecordLoader, known
from two_components import part_of_pair

from .crossings import Array
from .multibody_spatial import inertia_ratios, simulate
from .reference_systems import GRAVITY, pulse, uniform_podium
from .spatial_integrator import SpatialSimulation, simulate_pair
from .storey_lagrangian import OracleSystem

pytest.importorskip(
    "mujoco", reason="the physics engine is not installed: pip install rpscli[contact]"
)
pytestmark = [pytest.mark.long, pytest.mark.evidence("both components", "program")]

RATIO, AXIAL = inertia_ratios(0.15)


def structure(storeys: int, damping: float = 0.0) -> OracleSystem:
    """Flat ends; damping of the first mode in proportion to stiffness."""
    system = uniform_podium(storeys, 0.15, 0.0, 0.3, damping=0.0)
    between = np.eye(storeys) - np.eye(storeys, k=-1)
    springs = between.T @ np.diag(system.stiffnesses) @ between
    return replace(system, inertia_ratio=RATIO, damping_matrix=damping * 0.3 / np.pi * springs)


def differences(
    along_x: OracleSystem, along_y: OracleSystem, ground: Array, dt: float, duration: float
) -> tuple[Array, SpatialSimulation]:
    """Between both programs at the samples, over the largest tilt."""
    time, bodies = simulate(along_x, along_y, ground, dt, duration)
    run = SpatialSimulation(along_x, along_y, axial=AXIAL, rtol=1e-9)
    states = simulate_pair(run, ground, dt, duration)
    at = np.searchsorted(time, dt * np.arange(len(states)) - 1e-9)
    gap: Array = np.hypot(*(bodies[at] - states[:, :2]).T) / run.max_tilt
    return gap, run


@pytest.mark.parametrize("building", ["column", "frame", "three", "three, soft in y"])
def test_two_pulses(building: str) -> None:
    dt = 0.01
    ground = np.zeros((3, 120))
    for way, (peak, period, first) in enumerate([(0.25, 0.6, 2), (0.21, 0.7, 12)]):
        part = pulse(peak * GRAVITY, period, dt)
        ground[way, first : first + len(part)] = part
    along_x = structure(3 if "three" in building else 0, damping=0.05)
    along_y = along_x
    if building == "column":
        along_x = along_y = replace(along_x, columns_mass=1.0, cap_beam_mass=0.0)
        ground *= 0.8  # 0.9 turns it over; 0.7 hardly lifts it, and starts 1e-5 of the peak apart
    if "soft" in building:
        along_y = replace(
            along_x,
            stiffnesses=0.5 * along_x.stiffnesses,
            damping_matrix=0.5 * along_x.damping_matrix,
        )
        ground[2] = 0.4 * np.roll(ground[0], 10)
    gap, run = differences(along_x, along_y, ground, dt, 3.0)
    assert 0.03 < run.max_tilt < 0.15
    assert np.sqrt(np.mean(gap**2)) < 5e-5


@pytest.mark.parametrize(("pair", "start"), [(1, 2.0), (7, 3.0), (8, 9.0)])
def test_recorded_pairs(pair: int, start: float, fema_record: RecordLoader) -> None:
    """Three storeys without damping, until small differences have grown."""
    row = {"pair": pair, "t0": start, "T": 6.0, "scale": 1.0}
    motion = part_of_pair(row, fema_record)
    x, y, dt = motion.horizontal, known(motion.y), motion.horizontal.dt
    ground = np.array([x.acceleration, y.acceleration, np.zeros(x.npts)])
    gap, run = differences(structure(3), structure(3), ground, dt, 6.0)
    assert run.uplifts
    assert np.sqrt(np.mean(gap**2)) < 1e-3
