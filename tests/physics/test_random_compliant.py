"""Energy of random structures on compliant ends: whatever is supplied is accounted for."""

from __future__ import annotations

import numpy as np
import pytest
from paper_structures import needs_compiled_kernels, waves

from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.bearing import Bearing
from rpscli.model.contact import Contact
from rpscli.model.devices import FrictionDamper, Stop, ViscousDamper
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import Device, PodiumStructure
from rpscli.model.superstructure import RayleighDamping, Superstructure, profile_stiffnesses

pytestmark = pytest.mark.evidence("compliant ends", "exact")

MOST = 1e-6
"""Of all energy that flowed. The largest of a thousand was 2.5e-7."""


def random_structure(rng: np.random.Generator) -> PodiumStructure:
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


def gap(seed: int) -> float:
    """Residual over what was supplied and lost; of a structure that the model takes."""
    rng = np.random.default_rng(seed)
    while True:
        try:
            structure = random_structure(rng)
            break
        except ValueError:
            continue
    motion = waves(6.0, 0.01, float(rng.uniform(0.3, 2.5)) * structure.uplift_acceleration, seed)
    result = time_history(structure, motion, TimeHistorySettings(), with_fixed_base=False)
    assert result.outcome != "failed", (seed, result.failure)
    energy = result.energy
    flows = abs(energy.input) + energy.damped + energy.devices + energy.bed + energy.impact
    return abs(energy.residual) / flows


@needs_compiled_kernels
@pytest.mark.parametrize("seed", range(12))
def test_energy_is_accounted_for(seed: int) -> None:
    assert gap(seed) < MOST


@pytest.mark.long
def test_energy_of_a_thousand() -> None:
    gaps = [gap(1000 + seed) for seed in range(1000)]
    assert max(gaps) < MOST
