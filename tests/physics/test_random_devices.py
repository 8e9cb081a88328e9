"""Random structures with random devices: energy closes, and lanes give the bits of one alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from paper_structures import FLAT, building, needs_compiled_kernels, podium, waves

from rpscli.analyses.demand import Request, demands
from rpscli.analyses.largest_demands import Demand, Histories
from rpscli.analyses.result_quantities import HISTORY, IMPACTS, STOREY_SHEARS
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.devices import (
    FrictionDamper,
    RollingResistance,
    Stop,
    Tendon,
    ViscousDamper,
)
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import Device, PodiumStructure
from rpscli.records.ground_motion import GroundMotion, MotionComponents

pytestmark = pytest.mark.evidence("devices", "exact")

RESIDUAL = 1e-6
"""Of the energy that was supplied; without devices it is no smaller."""

COLUMNS = 6


def device(rng: np.random.Generator, structure: PodiumStructure) -> Device:
    """One that matters, of any kind."""
    F, B = structure.uplift_force, structure.bearing.half_width
    part = float(rng.uniform(0.05, 0.6))
    kind = int(rng.integers(5))
    if kind == 0:
        exponent = float(rng.choice([1.0, 0.2, 0.5, 1.5, 2.0]))
        return ViscousDamper(part * F / 0.3**exponent, exponent)
    if kind == 1:
        return FrictionDamper(2.0 * part * F)
    if kind == 2:
        gap = float(rng.choice([0.0, 0.02, 0.1]))
        damping = float(rng.choice([0.0, part * F]))
        return Stop(gap, 20.0 * part * F, damping)
    if kind == 3:
        P, e = 0.2 * part * structure.weight / COLUMNS, 0.1 * B
        k = 2.0 * part * structure.weight / COLUMNS / e * 0.2
        return Tendon(P, k, float(rng.choice([np.inf, 2.0 * P])))
    return RollingResistance(0.1 * part * B)


def equipped(rng: np.random.Generator) -> PodiumStructure:
    """A structure with one to four devices."""
    storeys = int(rng.choice([0, 1, 3, 6]))
    bare = podium(
        storeys,
        float(rng.uniform(0.06, 0.25)),
        float(rng.choice([FLAT, 0.3, 0.5, 1.0])),
        R=float(rng.uniform(0.7, 2.0)),
        law=ImpactLaw(str(rng.choice(["rigid", "flexible"]))),  # type: ignore[arg-type]
        superstructure=building(storeys) if storeys else None,
    )
    devices = tuple(device(rng, bare) for _ in range(int(rng.integers(1, 5))))
    return replace(bare, devices=devices, columns=COLUMNS)


def motion(rng: np.random.Generator, structure: PodiumStructure) -> GroundMotion:
    """Strong enough to uplift."""
    peak = float(rng.uniform(2.0, 5.0)) * structure.uplift_acceleration
    return waves(4.0, float(rng.choice([0.005, 0.02])), peak, seed=int(rng.integers(1000)))


def check(seed: int) -> None:
    """Energy closes, and each device dissipates, or gives back what it took."""
    rng = np.random.default_rng(seed)
    structure = equipped(rng)
    upwards = motion(rng, structure) if rng.integers(4) == 0 else None
    record = motion(rng, structure)
    if upwards is not None:
        upwards = waves(record.duration, record.dt, 2.0, seed=seed)
    start = float(rng.choice([0.0, 0.0, 0.3])) * structure.critical_rotation
    settings = TimeHistorySettings(free_vibration=1.0, initial_rotation=start)
    result = time_history(structure, record, settings, vertical=upwards)
    assert result.outcome != "failed", (seed, result.failure)
    energy = result.energy
    trace = result.trace
    supplied = max(abs(energy.input), float(np.max(np.abs(trace.energy_stored))))
    assert abs(energy.residual) < RESIDUAL * supplied, seed
    assert trace.devices.energy[-1].sum() <= energy.devices * (1.0 + 1e-12)
    dissipated = np.diff(trace.devices.energy, axis=0)
    assert np.all(dissipated >= -1e-9 * supplied), seed
    assert all(demand.force >= 0.0 for demand in result.devices)


@needs_compiled_kernels
@pytest.mark.parametrize("block", range(10))
def test_energy_closes(block: int) -> None:
    for seed in range(30 * block, 30 * block + 30):
        check(seed)


def kept(found: Demand) -> str:
    """What a study keeps."""
    alone = Histories.of_one(found.structure, found.history)
    return repr(alone.columns((*HISTORY, *IMPACTS, STOREY_SHEARS)))


@needs_compiled_kernels
def test_lanes_give_the_bits_of_one_alone() -> None:
    rng = np.random.default_rng(77)
    requests = []
    for _ in range(60):
        structure = equipped(rng)
        if rng.integers(4) == 0:
            structure = replace(structure, devices=())
        start = float(rng.choice([0.0, 0.3])) * structure.critical_rotation
        settings = TimeHistorySettings(free_vibration=0.5, initial_rotation=start)
        requests.append(Request(structure, MotionComponents(motion(rng, structure)), settings))
    together, alone = demands(requests, worth_lanes=1), demands(requests, worth_lanes=10**9)
    for one, other in zip(together, alone, strict=True):
        assert kept(one) == kept(other)
        assert one.history.device_force.tolist() == other.history.device_force.tolist()
        assert one.history.device_energy.tolist() == other.history.device_energy.tolist()
        assert one.history.energy_stored == other.history.energy_stored
        assert one.history.device_stored.tolist() == other.history.device_stored.tolist()
        assert one.history.steps == other.history.steps
