"""Free vibration `auto`: it may stop only when no larger demand can follow."""

from __future__ import annotations

import numpy as np
import pytest
from paper_structures import (
    FLAT,
    building,
    ground,
    needs_compiled_kernels,
    podium,
    stillness,
    waves,
)

from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import RayleighDamping
from rpscli.physics.state import FULL_CONTACT
from rpscli.records.ground_motion import GroundMotion

LONG = TimeHistorySettings(free_vibration=60.0)


def random_case(seed: int) -> tuple[PodiumStructure, GroundMotion]:
    """A building of the paper and a short record that leaves it rocking."""
    rng = np.random.default_rng(seed)
    storeys, rho = int(rng.integers(1, 10)), float(rng.choice([FLAT, 0.26, 0.5, 1.5]))
    law = ImpactLaw("rigid" if rng.integers(2) else "flexible")
    structure = podium(storeys, float(rng.choice([0.10, 0.15, 0.20])), rho, law=law)
    seconds, peak = rng.uniform(0.5, 3.0), rng.uniform(1.0, 4.0)
    return structure, waves(seconds, 0.01, peak * structure.uplift_acceleration, seed)


def both(seed: int) -> tuple[TimeHistoryResult, TimeHistoryResult]:
    structure, record = random_case(seed)
    short = time_history(structure, record, with_fixed_base=False)
    long = time_history(structure, record, LONG, with_fixed_base=False)
    return short, long


@needs_compiled_kernels
@pytest.mark.parametrize("seed", [*range(40), 409])
def test_auto_finds_the_largest_demands(seed: int) -> None:
    """Seed 409 has its largest floor acceleration at an impact after long quiet rocking."""
    short, long = both(seed)
    assert short.outcome == long.outcome
    if short.outcome != "survived":
        return
    assert short.duration < short.record.duration + 40.0
    assert short.history.phase == FULL_CONTACT
    assert short.max_rotation == long.max_rotation
    assert short.storey_shears.tolist() == long.storey_shears.tolist()
    assert short.floor_accelerations.tolist() == long.floor_accelerations.tolist()
    # up to where it stopped it is the same history
    rows = len(short.trace.time)
    assert np.array_equal(short.trace.rotation, long.trace.rotation[:rows])
    assert np.array_equal(short.trace.floor_displacements, long.trace.floor_displacements[:rows])


@needs_compiled_kernels
def test_not_all_of_those_cases_are_trivial() -> None:
    results = [time_history(*random_case(seed), with_fixed_base=False) for seed in range(40)]
    survived = [r for r in results if r.outcome == "survived"]
    late = [r for r in survived if r.history.max_theta_time > r.record.duration]
    assert len(survived) > 20
    assert len(late) > 5
    again = [r for r in survived if r.uplifts > 1]
    assert len(again) > 5


def test_auto_waits_for_the_swing_of_a_building_that_never_lifts() -> None:
    """A kick at the very end of a finely sampled record: all maxima come later."""
    structure = podium(3)
    record = ground(np.concatenate((np.zeros(5), np.full(5, 1.0))), 0.001)
    result = time_history(structure, record)
    longer = time_history(structure, record, TimeHistorySettings(free_vibration=0.5))
    assert result.outcome == "at_rest"
    assert result.duration < 0.5
    sheared = np.abs(result.trace.storey_shears[:, 0])
    assert np.argmax(sheared) > record.npts + 30
    assert result.storey_shears.tolist() == longer.storey_shears.tolist()
    assert result.floor_accelerations.tolist() == longer.floor_accelerations.tolist()


@needs_compiled_kernels
@pytest.mark.parametrize(("storeys", "period"), [(1, 0.3), (3, 0.05)])
def test_undamped_stiff_buildings_do_not_drift(storeys: int, period: float) -> None:
    """Two minutes of rocking, in which nothing but the steps takes energy from the fast modes."""
    above = building(storeys, period, RayleighDamping(0.0))
    structure = podium(storeys, superstructure=above, law=ImpactLaw("value", 0.9999))
    released = 0.5 * structure.critical_rotation
    settings = TimeHistorySettings(free_vibration=120.0, initial_rotation=released)
    result = time_history(structure, stillness(0.02), settings, with_fixed_base=False)
    assert result.outcome == "survived"
    assert result.impacts > 70
    assert abs(result.energy.residual) < 1e-6 * result.trace.energy_stored[0]
