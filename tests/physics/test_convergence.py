"""Observed orders of the steps: in smooth motion, and through events that have to be located."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import pytest
from paper_structures import (
    FLAT,
    Array,
    needs_compiled_kernels,
    podium,
    steps_an_interval,
    waves,
)

from rpscli.analyses.kernels import systems
from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.podium import PodiumStructure
from rpscli.records.ground_motion import GroundMotion

pytestmark = [needs_compiled_kernels, pytest.mark.evidence("steps, events, energy", "exact")]

ACCURACIES = (0.8, 1.6, 3.2)
REFERENCE = 48.0
LEAST_STATE, LEAST_ENERGY = 5.5, 5.5
"""Order six shows as 5.6 to 8, that of energy likewise: rounding is near, so the steps are few and
long, and the error that counts is not always that of the same quantity."""

LEAST_PARABOLA = 4.5
"""That of frames without stiffness, whose motion between events is almost a parabola."""


@pytest.fixture(autouse=True)
def _even_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    """No error shortens them."""
    monkeypatch.setattr(systems, "STEP_ERROR", math.inf)
    monkeypatch.setattr(systems, "_system", systems._system.__wrapped__)


class Orders(NamedTuple):
    """Slopes over three step lengths, and the history with the shortest step."""

    state: float
    energy: float
    reference: TimeHistoryResult


def final_state(result: TimeHistoryResult) -> Array:
    trace = result.trace
    return np.concatenate(
        ([trace.rotation[-1], trace.rotation_rate[-1]], trace.drifts[-1], trace.storey_shears[-1])
    )


def observed(structure: PodiumStructure, record: GroundMotion) -> Orders:
    """Released from 0.1 rad under the record, which ends the history."""

    def run(accuracy: float) -> TimeHistoryResult:
        settings = TimeHistorySettings(free_vibration=0.0, accuracy=accuracy, initial_rotation=0.1)
        return time_history(structure, record, settings)

    reference = run(REFERENCE)
    assert reference.trace.phase[-1] > 0
    exact = final_state(reference)
    steps, errors, residuals = [], [], []
    for accuracy in ACCURACIES:
        result = run(accuracy)
        assert [e.kind for e in result.events] == [e.kind for e in reference.events]
        steps.append(steps_an_interval(structure, record.dt, accuracy))
        errors.append(np.max(np.abs(final_state(result) - exact) / np.abs(exact)))
        residuals.append(abs(result.energy.residual) / result.trace.energy_stored[0])
    assert min(errors) > 1e-14  # not yet rounding
    lengths = -np.log(steps)
    state, energy = (float(np.polyfit(lengths, np.log(e), 1)[0]) for e in (errors, residuals))
    return Orders(state, energy, reference)


@pytest.mark.parametrize(
    ("storeys", "rho"),
    [(0, FLAT), (1, FLAT), (1, 0.5), (3, FLAT), (3, 0.5), (6, 0.5)],
)
def test_flight_in_one_phase_is_of_order_six(storeys: int, rho: float) -> None:
    # without springs the motion is slow: longer intervals, or one step would do for all
    dt = 0.02 if storeys else 0.2
    orders = observed(podium(storeys, 0.15, rho), waves(0.4, dt, 1.0, seed=1))
    assert orders.reference.events == ()
    assert orders.state > (LEAST_STATE if storeys else LEAST_PARABOLA)
    assert orders.energy > (LEAST_ENERGY if storeys else LEAST_PARABOLA)


@pytest.mark.parametrize(
    ("storeys", "rho"),
    # a frame without stiffness is almost a parabola, whose error has no leading term
    [(0, FLAT), (0, 0.25), (0, 1.5), *((n, rho) for n in (1, 3) for rho in (FLAT, 0.25, 0.5, 1.5))],
)
def test_events_cost_no_order(storeys: int, rho: float) -> None:
    """Impacts reset the state, and D jumps at beta: both only if met exactly."""
    dt = 0.02 if storeys else 0.2
    orders = observed(podium(storeys, 0.15, rho), waves(2.4, dt, 2.0, seed=1))
    kinds = [event.kind for event in orders.reference.events]
    assert kinds.count("impact") >= 1
    if rho == 1.5:
        assert kinds.count("rolling_to_rocking") >= 1
        assert kinds.count("rocking_to_rolling") >= 1
    assert orders.state > (LEAST_STATE if storeys else LEAST_PARABOLA)
    assert orders.energy > (LEAST_ENERGY if storeys else LEAST_PARABOLA)
