"""Free motions with exact solutions: periods, decay, rest, and energy that stays."""

from __future__ import annotations

import math

import numpy as np
import pytest
from paper_structures import (
    FLAT,
    SLENDER,
    building,
    ground,
    needs_compiled_kernels,
    podium,
    steps_an_interval,
    stillness,
)

from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.bearing import Bearing
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import RayleighDamping

LINEAR = 3.0 * SLENDER**2
"""What the linear theory leaves out, relative: a few alpha^2."""


def released(
    structure: PodiumStructure, rotation: float, seconds: float, dt: float, accuracy: float = 1.0
) -> TimeHistoryResult:
    settings = TimeHistorySettings(
        free_vibration=seconds, initial_rotation=rotation, accuracy=accuracy
    )
    return time_history(structure, stillness(dt), settings)


def impact_times(result: TimeHistoryResult) -> list[float]:
    return [event.time for event in result.events if event.kind == "impact"]


@pytest.mark.evidence("free-standing blocks", "exact")
@pytest.mark.parametrize("rho", [FLAT, 0.25, 0.5, 1.5])
def test_slender_columns_rock_with_the_linear_periods(rho: float) -> None:
    """x'' = -w^2 (alpha + kappa x) between impacts, w^2 = g (1+2 gamma)/(R (Io+4 gamma))."""
    alpha, start, e, gamma = SLENDER, 0.5 * SLENDER, 0.9, 10.0
    kappa = 2.0 * rho - 1.0
    bearing = Bearing(1.5, SLENDER, SLENDER + 0.1, rho)  # beta > .03: it rolls all the time
    structure = PodiumStructure(bearing, 2e4, gamma * 2e4, None, ImpactLaw("value", e))
    w2 = structure.gravity / 1.5 * (1.0 + 2.0 * gamma) / (4.0 / 3.0 + 4.0 * gamma)

    def amplitude(impacts: int) -> float:
        """Where alpha x + kappa x^2/2 has lost the factor e^2 at each impact."""
        height = e ** (2 * impacts) * (alpha * start + 0.5 * kappa * start**2)
        return 2.0 * height / (alpha + math.sqrt(alpha**2 + 2.0 * kappa * height))

    def quarter(x: float) -> float:
        """Time from rest at x to zero."""
        if kappa == 0.0:
            return math.sqrt(2.0 * x / (alpha * w2))
        ratio = alpha / (alpha + kappa * x)
        fall = math.acos(ratio) if kappa > 0.0 else math.acosh(ratio)
        return fall / math.sqrt(abs(kappa) * w2)

    times = impact_times(released(structure, start, 12.0, 0.02))
    expected = [quarter(start), *(2.0 * quarter(amplitude(i)) for i in range(1, 8))]
    assert np.diff(times[:8], prepend=0.0) == pytest.approx(expected, rel=LINEAR)


@pytest.mark.parametrize("rho", [FLAT, 0.5])
@pytest.mark.parametrize("storeys", [0, 2])
def test_nothing_moves_without_a_push(storeys: int, rho: float) -> None:
    result = time_history(podium(storeys, 0.15, rho), ground(np.zeros(101), 0.02))
    assert result.outcome == "at_rest"
    assert result.events == ()
    assert result.max_rotation == 0.0
    assert not np.any(result.trace.rotation)
    assert not np.any(result.trace.floor_displacements)
    assert result.friction_demand == 0.0
    assert result.history.normal_top == 1.0  # the weight, no more
    assert result.history.normal_bottom == 1.0


@pytest.mark.evidence("steps, events, energy", "exact")
@needs_compiled_kernels
@pytest.mark.parametrize("rho", [FLAT, 0.5, 1.5])
def test_without_damping_and_with_e_one_energy_stays(rho: float) -> None:
    above = building(2, damping=RayleighDamping(0.0))
    structure = podium(2, 0.15, rho, law=ImpactLaw("value", 1.0), superstructure=above)
    steps, drift = [], []
    for accuracy in (0.5, 1.0, 2.0):
        result = released(structure, 0.05, 20.0, 0.01, accuracy)
        stored = result.trace.energy_stored
        assert result.impacts >= 20
        assert result.energy.damped == 0.0
        assert abs(result.energy.impact) < 1e-12 * stored[0]
        steps.append(steps_an_interval(structure, 0.01, accuracy))
        drift.append(float(np.max(np.abs(stored / stored[0] - 1.0))))
    assert drift[0] < 3e-6
    orders = -np.diff(np.log(drift)) / np.diff(np.log(steps))
    # shorter steps near impacts, where their error asks for them, blur it
    assert np.mean(orders) > 6.0


@pytest.mark.evidence("free-standing blocks", "exact")
@pytest.mark.parametrize("tolerance", [1e-4, 1e-6, 1e-8])
def test_impacts_shrink_and_come_to_an_end(tolerance: float) -> None:
    """Near theta = 0 each impact leaves e^2 of the height, until it is below the tolerance."""
    structure = podium(0, 0.15, FLAT)
    alpha, e = structure.bearing.alpha, structure.restitution
    settings = TimeHistorySettings(
        free_vibration=5.0, initial_rotation=1e-3 * alpha, recontact_tolerance=tolerance
    )
    result = time_history(structure, stillness(0.01), settings)
    locked = math.ceil(math.log(tolerance / 1e-3) / math.log(e**2))
    assert result.impacts == pytest.approx(locked, abs=1)
    assert [event.kind for event in result.events][-2:] == ["impact", "recontact"]
    assert result.trace.rotation[-1] == 0.0
    # all the energy of the release has gone at impacts, and the audit knows
    assert result.energy.impact == pytest.approx(result.trace.energy_stored[0], rel=1e-9)
    ratios = np.diff(impact_times(result))
    assert ratios[1:] / ratios[:-1] == pytest.approx(e, rel=2e-3)  # height/alpha <= 1e-3
