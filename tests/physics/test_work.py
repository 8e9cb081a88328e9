"""Bounds on work: steps a sample, steps an event; and buildings of any height."""

from __future__ import annotations

import numpy as np
import pytest
from paper_structures import (
    FLAT,
    RecordLoader,
    building,
    ground,
    needs_compiled_kernels,
    podium,
    steps_an_interval,
    stillness,
    waves,
)

from rpscli.analyses.kernels.systems import fastest_decay, highest_frequency
from rpscli.analyses.modal import modal
from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.superstructure import ModalDamping, RayleighDamping

pytestmark = pytest.mark.evidence("steps, events, energy", "exact")

BEYOND_A_PLAIN_STEP = 3.5
"""Steps that an event adds on average: those taken again to its root, the one that leads on from
it, and halves of steps in which the tilt changes fast."""


def steps_an_event(result: TimeHistoryResult) -> float:
    """Steps beyond those of the intervals, over the number of events."""
    intervals = len(result.trace.time) - 1
    plain = intervals * steps_an_interval(result.structure, result.record.dt)
    return float(result.history.steps - plain) / len(result.events)


@needs_compiled_kernels
@pytest.mark.parametrize(
    ("storeys", "rho"), [(0, FLAT), (0, 1.5), (3, 0.5), (6, FLAT), (9, 0.26), (9, 1.5)]
)
def test_an_event_costs_few_steps(storeys: int, rho: float) -> None:
    structure = podium(storeys, 0.10, rho)
    for seed in range(3):
        record = waves(12.0, 0.01, 2.5 * structure.uplift_acceleration, seed)
        result = time_history(structure, record, TimeHistorySettings(free_vibration=4.0))
        assert len(result.events) > 10
        assert steps_an_event(result) < BEYOND_A_PLAIN_STEP


@needs_compiled_kernels
def test_steps_a_sample_of_an_earthquake(fema_record: RecordLoader) -> None:
    result = time_history(podium(9, 0.15, 1.5), fema_record("farfield/1/b"))
    assert len(result.events) > 300
    assert steps_an_event(result) < BEYOND_A_PLAIN_STEP


def test_full_contact_needs_no_more_than_plain_steps() -> None:
    structure = podium(3)
    result = time_history(structure, waves(2.0, 0.02, 0.2, seed=1))
    assert result.outcome == "at_rest"
    intervals = len(result.trace.time) - 1
    assert result.history.steps == intervals * steps_an_interval(structure, 0.02)


@needs_compiled_kernels
def test_work_grows_in_proportion_to_the_uplifted_time() -> None:
    structure = podium(3, 0.15, 0.5)
    ends = np.array([2.0, 4.0, 8.0])
    counts = []
    for end in ends:
        settings = TimeHistorySettings(free_vibration=float(end), initial_rotation=0.2)
        counts.append(time_history(structure, stillness(0.01), settings).history.steps)
    assert np.diff(counts) / np.diff(ends) == pytest.approx(counts[0] / 2.0, rel=0.05)


@pytest.mark.parametrize("storeys", [1, 2, 5, 30])
@pytest.mark.parametrize(
    "damping", [RayleighDamping(0.05), RayleighDamping(0.3), ModalDamping(0.05)], ids=str
)
@pytest.mark.parametrize("rho", [FLAT, 1.5])
def test_the_step_is_short_enough_for_every_uplifted_mode(
    storeys: int, damping: RayleighDamping | ModalDamping, rho: float
) -> None:
    structure = podium(storeys, 0.15, rho, superstructure=building(storeys, damping=damping))
    modes = modal(structure)
    uplifted = modes.rocking if rho == FLAT else modes.rolling
    assert uplifted is not None
    assert highest_frequency(structure) >= uplifted.frequencies[-1]
    # 2 xi w of the fastest mode is above its decay rate
    assert fastest_decay(structure) >= np.max(np.abs(uplifted.eigenvalues.real))
    # no waste either: the bounds are sharp within a factor
    assert highest_frequency(structure) < 1.5 * max(uplifted.frequencies[-1], 5.0)


@needs_compiled_kernels
@pytest.mark.parametrize("damping", [5.0, 20.0])
def test_an_overdamped_building_stays_stable(damping: float) -> None:
    """Explicit steps diverge beyond h lambda = 4; the step heeds the decay rate."""
    above = building(1, damping=RayleighDamping(damping))
    settings = TimeHistorySettings(free_vibration=6.0, initial_rotation=0.03)
    result = time_history(podium(1, superstructure=above), stillness(0.01), settings)
    assert result.outcome == "survived"
    assert result.max_rotation == 0.03
    assert abs(result.energy.residual) < 1e-4 * result.trace.energy_stored[0]


@needs_compiled_kernels
@pytest.mark.parametrize("storeys", [0, 1, 2, 10, 30, 100])
@pytest.mark.parametrize("rho", [FLAT, 0.26, 0.5, 1.5])
def test_buildings_of_any_height_are_followed_to_the_end(storeys: int, rho: float) -> None:
    structure = podium(storeys, 0.15, rho)
    record = waves(8.0, 0.02, 2.0 * structure.uplift_acceleration, seed=5)
    settings = TimeHistorySettings(free_vibration=4.0, initial_rotation=0.02)
    result = time_history(structure, record, settings)
    assert result.outcome == "survived"
    assert result.impacts > 0
    assert np.isfinite(result.trace.rotation).all()
    assert np.isfinite(result.trace.floor_accelerations).all()
    supplied = abs(result.energy.input) + result.trace.energy_stored[0]
    assert abs(result.energy.residual) < 1e-5 * supplied


def test_a_pause_longer_than_the_record_costs_only_samples() -> None:
    structure = podium(2)
    settings = TimeHistorySettings(free_vibration=20.0)
    result = time_history(structure, ground([0.0, 1.0, 0.0], 0.02), settings)
    assert len(result.trace.time) == 1003
    assert result.duration == pytest.approx(20.04, rel=1e-12)
