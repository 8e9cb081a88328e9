"""Random structures with devices or on compliant ends: energy closes, and lanes change no bit."""

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
from rpscli.model.bearing import Bearing
from rpscli.model.contact import Contact
from rpscli.model.devices import FrictionDamper, RollingResistance, Stop, Tendon, ViscousDamper
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import Device, PodiumStructure
from rpscli.model.superstructure import RayleighDamping, Superstructure, profile_stiffnesses
from rpscli.records.ground_motion import GroundMotion, MotionComponents

pytestmark = needs_compiled_kernels

RESIDUAL = 1e-6
"""Of the energy that was supplied; without devices it is no smaller."""

BED_RESIDUAL = 2e-6
"""On compliant ends, of all that flowed: the largest of a thousand is 1.2e-6, of 344 passages, and
half the step makes it 200 times smaller."""

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
        law=ImpactLaw(str(rng.choice(["rigid", "flexible"]))),
        superstructure=building(storeys) if storeys else None,
    )
    devices = tuple(device(rng, bare) for _ in range(int(rng.integers(1, 5))))
    return replace(bare, devices=devices, columns=COLUMNS)


def motion(rng: np.random.Generator, structure: PodiumStructure) -> GroundMotion:
    """Strong enough to uplift."""
    peak = float(rng.uniform(2.0, 5.0)) * structure.uplift_acceleration
    return waves(4.0, float(rng.choice([0.005, 0.02])), peak, seed=int(rng.integers(1000)))


@pytest.mark.evidence("devices", "exact")
@pytest.mark.parametrize("block", range(10))
def test_energy_with_devices(block: int) -> None:
    """Each device dissipates, or gives back what it took."""
    for seed in range(30 * block, 30 * block + 30):
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
        energy, trace = result.energy, result.trace
        supplied = max(abs(energy.input), float(np.max(np.abs(trace.energy_stored))))
        assert abs(energy.residual) < RESIDUAL * supplied, seed
        assert trace.devices.energy[-1].sum() <= energy.devices * (1.0 + 1e-12)
        dissipated = np.diff(trace.devices.energy, axis=0)
        assert np.all(dissipated >= -1e-9 * supplied), seed
        assert all(demand.force >= 0.0 for demand in result.devices)


def kept(found: Demand) -> str:
    """What a study keeps."""
    alone = Histories.of_one(found.structure, found.history)
    return repr(alone.columns((*HISTORY, *IMPACTS, STOREY_SHEARS)))


@pytest.mark.evidence("devices", "exact")
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
        for name in ("device_force", "device_energy", "device_stored", "energy_stored", "steps"):
            assert np.array_equal(one.history[name], other.history[name]), name


def on_a_bed(rng: np.random.Generator) -> PodiumStructure:
    """Flat or curved ends, 0 to 8 storeys, joints of both kinds, dampers and stops."""
    storeys, tan_alpha = int(rng.integers(0, 9)), float(rng.uniform(0.08, 0.3))
    rho = float(rng.choice([0.0, rng.uniform(0.3, 1.2)]))
    bearing = Bearing(
        float(rng.uniform(0.6, 2.5)), tan_alpha, (2.0 if rho else 1.0) * tan_alpha, rho
    )
    columns = 2e4
    beam, above = columns * float(rng.uniform(2.0, 15.0)), None
    if storeys:
        masses = np.full(storeys, beam * float(rng.uniform(0.5, 1.5)))
        stiffnesses = profile_stiffnesses(masses, storeys * float(rng.uniform(0.07, 0.15)), "sine")
        damping = RayleighDamping(float(rng.uniform(0.02, 0.07)), (1, 2))
        above = Superstructure(masses, stiffnesses, damping)
    kind = "plane" if rng.random() < 0.6 else "edges"
    weight = 9.81 * (0.5 * columns + beam + (0.0 if above is None else above.mass))
    # K_s by the first-order formula, of a phi_u of 1e-4 to 1e-2 of tan(alpha)
    share = 10.0 ** rng.uniform(-4.0, -2.0)
    stiffness = weight / (2.0 * bearing.half_height) / share
    devices: list[Device] = []
    if rng.random() < 0.3:
        devices.append(FrictionDamper(float(rng.uniform(0.02, 0.3)) * weight * tan_alpha))
    if rng.random() < 0.3:
        devices.append(ViscousDamper(float(rng.uniform(0.1, 1.0)) * weight))
    if rng.random() < 0.2:
        devices.append(Stop(0.1, 5.0 * weight, 0.1 * weight))
    contact = Contact(kind, stiffness=stiffness, damping=float(rng.uniform(0.0, 0.3)))  # type: ignore[arg-type]
    law = ImpactLaw(loss=float(rng.uniform(0.0, 0.5)))
    return PodiumStructure(
        bearing, columns, beam, above, law, devices=tuple(devices), contact=contact
    )


@pytest.mark.evidence("compliant ends", "exact")
@pytest.mark.parametrize(
    "seeds", [(0, 12), (1288, 1289), pytest.param((1000, 2000), marks=pytest.mark.long)]
)
def test_energy_on_compliant_ends(seeds: tuple[int, int]) -> None:
    """Of structures that the model takes; 1288 lands beside the end of a steep bed."""
    for seed in range(*seeds):
        rng = np.random.default_rng(seed)
        while True:
            try:
                structure = on_a_bed(rng)
                break
            except ValueError:
                continue
        peak = float(rng.uniform(0.3, 2.5)) * structure.uplift_acceleration
        result = time_history(structure, waves(6.0, 0.01, peak, seed), with_fixed_base=False)
        assert result.outcome != "failed", (seed, result.failure)
        energy = result.energy
        flows = abs(energy.input) + energy.damped + energy.devices + energy.bed + energy.impact
        assert abs(energy.residual) < BED_RESIDUAL * flows, seed
