"""Devices under both components: a second integrator, the planar limit, symmetry, energy.

Their kernel takes a minute to compile: the tests that need it are long, and what stands beside the
second integrator in the suite is interpreted.
"""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from oracles.spatial_integrator import SpatialSimulation, simulate_pair
from paper_structures import (
    Array,
    ground,
    needs_compiled_kernels,
    oracle_devices,
    oracle_system,
    waves,
)
from two_components import followed, frame, pair, two_pulses

from rpscli.analyses.kernels.history import sampled_history
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.devices import Stop, Tendon, ViscousDamper
from rpscli.model.podium import Device, PodiumStructure
from rpscli.physics.state import STOP_LEFT, STOP_MET, TENDON_YIELDING
from rpscli.records.ground_motion import MotionComponents

with_kernel = pytest.mark.long, needs_compiled_kernels

STEP = 0.01
ARCS: dict[str, Any] = {"tan_wedge": 0.3, "rho": 0.5}
W = frame(3, 3.0).weight

KINDS: dict[str, Device] = {
    "linear": ViscousDamper(0.3 * W),
    "root": ViscousDamper(0.2 * W, 0.5),
    "power": ViscousDamper(0.3 * W, 1.8),
    "stop": Stop(0.05, 20.0 * W, 2.0 * W),
    "no gap": Stop(0.0, 0.5 * W, 0.2 * W),
    "tendon": Tendon(0.05 * W, 3.0 * W),
    "yields": Tendon(0.05 * W, 3.0 * W, 0.11 * W),
}


def equipped(kind: str, storeys: int = 3, **options: Any) -> PodiumStructure:
    return frame(storeys, 3.0, contact_time=2e-3, devices=(KINDS[kind],), **options)


def fine(accuracy: float = 4.0) -> TimeHistorySettings:
    return TimeHistorySettings(free_vibration=0.0, accuracy=accuracy)


def beside_the_second_integrator(
    kind: str, arcs: bool, x: Array, y: Array, storeys: int = 3, accuracy: float = 4.0
) -> None:
    """Cartesian, adaptive, laws as functions: the same tilts throughout."""
    structure = equipped(kind, storeys, **(ARCS if arcs else {}))
    ours = followed(structure, pair(x, y, STEP), fine(accuracy))
    run = SpatialSimulation(
        oracle_system(structure),
        axial=structure.bearing.inertia_ratio_axial,
        contact_time=2e-3,
        integrated_spin=True,
        begins_at=1e-9,
        devices=oracle_devices(structure),
    )
    states = simulate_pair(run, np.array([x, y, 0.0 * x]), STEP, STEP * (len(x) - 1))
    assert run.max_tilt > 1e-3
    gap = np.abs(states[:, 0] + 1j * states[:, 1] - ours.tilt)
    assert np.max(gap) < 1e-9  # 1e-12 are found, 1e-10 where a damped stop lets go
    # 1e-12 are found; the promise of steps of usual length is 1e-6
    assert abs(ours.residual) < (1e-9 if accuracy > 1.0 else 1e-6)


@pytest.mark.parametrize("arcs", [False, True])
@pytest.mark.parametrize("kind", [pytest.param(kind, marks=with_kernel) for kind in KINDS])
def test_against_the_second_integrator(kind: str, arcs: bool) -> None:
    beside_the_second_integrator(kind, arcs, *two_pulses(2.0))


def test_a_third_of_a_second_interpreted() -> None:
    script = (
        "from physics.spatial.test_devices import beside_the_second_integrator, two_pulses\n"
        "x, y = two_pulses()[:, 80:115]; x[0] = y[0] = 0.0\n"
        "beside_the_second_integrator('root', True, x, y, 1, 1.0)"
    )
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), "NUMBA_DISABLE_JIT": "1"}
    subprocess.run([sys.executable, "-P", "-c", script], env=environment, check=True)


@pytest.mark.parametrize("kind", [pytest.param(kind, marks=with_kernel) for kind in KINDS])
def test_one_component_is_the_planar_program(kind: str) -> None:
    """Along x: rotations until it rests, what the device saw, and what went through it."""
    x, _ = two_pulses()
    structure = equipped(kind, **ARCS)
    history = followed(structure, pair(x, 0.0 * x, STEP), fine())
    planar = sampled_history(structure, MotionComponents(ground(x, STEP)), fine())
    until = round(history.recontacts.time[0] / STEP) if len(history.recontacts) else None
    assert np.max(np.abs(history.tilt.real - planar.samples.theta)[:until]) < 1e-6
    left, other = history.left, planar.history
    for name in ("device_force", "device_velocity", "device_energy", "permanent"):
        assert left[name][0] == pytest.approx(other[name][0], rel=1e-4, abs=1e-12), name
    if kind != "no gap":  # whose last, smallest swings differ
        for event in (STOP_MET, STOP_LEFT, TENDON_YIELDING):
            assert left.events[event] == other.events[event]


@pytest.mark.parametrize("kind", [pytest.param(kind, marks=with_kernel) for kind in KINDS])
def test_no_axis_is_special(kind: str) -> None:
    x, y = two_pulses()
    turn = np.exp(0.64j)
    turned = turn * (x + 1j * y)
    structure = equipped(kind, **ARCS)
    one = followed(structure, pair(x, y, STEP), fine())
    other = followed(structure, pair(turned.real, turned.imag, STEP), fine())
    assert np.max(np.abs(turn * one.tilt - other.tilt)) < 1e-9
    for name in ("device_force", "device_velocity", "device_energy"):
        assert other.left[name][0] == pytest.approx(one.left[name][0], rel=1e-5), name


@pytest.mark.long
@needs_compiled_kernels
def test_what_is_kept_at_samples() -> None:
    """Forces along the velocity, as geometry of sharp edges has it; the audit closes throughout."""
    x, y = two_pulses(3.0)
    structure = replace(equipped("root"), devices=(KINDS["root"], KINDS["stop"]))
    motion = pair(x, y, STEP)
    samples = followed(structure, motion, fine(1.0)).samples
    result = time_history(structure, motion, fine(1.0), with_fixed_base=False)
    alpha, diameter = structure.bearing.alpha, 2.0 * structure.bearing.semi_diagonal
    path = diameter * (np.sin(alpha) - np.sin(alpha - samples.theta)) * (samples.theta > 0.0)
    speed = np.hypot(
        diameter * np.cos(alpha - samples.theta) * samples.theta_dot, path * samples.turning
    )
    trace = result.trace
    assert -trace.devices.force[:, 0] == pytest.approx(0.2 * W * np.sqrt(speed), abs=1e-9 * W)
    assert np.allclose(trace.devices.displacement, path[:, None], atol=1e-12)
    assert np.max(speed) > 0.1
    # the stop pushes along the tilt, the damper against the velocity
    along = samples.push_x * np.cos(samples.azimuth) + samples.push_y * np.sin(samples.azimuth)
    damper = np.divide(trace.devices.force[:, 0], speed, out=0.0 * speed, where=speed > 0.0)
    outwards = diameter * np.cos(alpha - samples.theta) * samples.theta_dot
    assert along == pytest.approx(damper * outwards + trace.devices.force[:, 1], abs=1e-9 * W)
    spent = trace.energy_damped + trace.energy_impact + trace.energy_stored
    spent = spent + trace.devices.energy.sum(axis=1)
    assert np.max(np.abs(trace.energy_input - spent)) < 1e-6 * np.max(trace.energy_input)
    assert abs(result.energy.residual) < 1e-6 * np.max(trace.energy_input)
    assert result.devices[0].velocity == pytest.approx(np.max(speed), rel=1e-2)


@needs_compiled_kernels
@pytest.mark.evidence("both components", "exact")
@pytest.mark.parametrize("seed", range(4))
def test_energy_closes_where_tendons_yield_and_columns_go_round(seed: int) -> None:
    """Where x' = 0 ends yielding, what goes on across the tilt is not stopped."""
    structure = equipped("yields", 2)
    peak = 3.0 * structure.uplift_acceleration
    motion = MotionComponents(waves(6.0, 0.01, peak, seed), y=waves(6.0, 0.01, peak, seed + 50))
    result = time_history(structure, motion, TimeHistorySettings(free_vibration=1.0))
    assert sum(event.kind == "tendon_yielding" for event in result.events) >= 1
    assert result.passes >= 1
    assert abs(result.energy.residual) < 1e-7 * result.energy.input
