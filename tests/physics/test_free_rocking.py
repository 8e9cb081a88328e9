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
    known,
    needs_compiled_kernels,
    podium,
    steps_an_interval,
    stillness,
)
from scipy.integrate import quad

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


@pytest.mark.evidence("free-standing blocks", "exact")
def test_a_flat_block_swings_as_long_as_the_integral_of_energy_says() -> None:
    """x'^2/2 = w^2 [cos(alpha - x0) - cos(alpha - x)]; no small angle is assumed."""
    structure, start = podium(0, 0.3, FLAT), 0.2
    alpha, gamma = structure.bearing.alpha, structure.gamma
    w2 = structure.gravity / 1.5 * (1.0 + 2.0 * gamma) / (4.0 / 3.0 + 4.0 * gamma)

    def fall(s: float) -> float:
        """dt/ds with x = x0 - s^2, which takes the singularity at rest away."""
        half = 0.5 * s**2
        speed = math.sqrt(4.0 * math.sin(alpha - start + half) * math.sin(half) * w2)
        return 2.0 * s / speed if s > 0.0 else math.sqrt(2.0 / (w2 * math.sin(alpha - start)))

    expected, _ = quad(fall, 0.0, math.sqrt(start), epsabs=1e-14, epsrel=1e-13)
    # the sampling interval is no divisor of anything: the impact has to be located
    result = released(structure, start, 1.0, 0.0317, accuracy=8.0)
    first = next(event for event in result.events if event.kind == "impact")
    assert first.time == pytest.approx(expected, rel=1e-11)
    speed = math.sqrt(2.0 * w2 * (math.cos(alpha - start) - math.cos(alpha)))
    assert first.rotation_rate_before == pytest.approx(-speed, rel=1e-11)
    assert first.rotation_rate_after == pytest.approx(-structure.restitution * speed, rel=1e-11)


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


@pytest.mark.evidence("buildings on bearings under earthquakes", "exact")
@needs_compiled_kernels
def test_shear_after_the_first_separate_impact() -> None:
    """The base force turns round: V swings from V_st about -V_st (Validation by closed form).

    xi_u = xi omega_u/omega_0 for stiffness-proportional damping, omega_u of the uplifted building.
    """
    structure = podium(1, 0.15, 0.5)
    above = known(structure.superstructure)
    base = 2e4 / 3.0 + 2e5 + above.mass * structure.bearing.alpha**2
    xi = 0.05 * math.sqrt(1.0 + above.mass / base)
    expected = 1.0 + 2.0 * math.exp(-math.pi * xi / math.sqrt(1.0 - xi**2))
    assert expected == pytest.approx(2.605, abs=5e-4)
    result = released(structure, 0.12, 3.0, 0.001)
    first = impact_times(result)[0]
    after = (result.trace.time > first) & (result.trace.time < first + 0.1)
    swing = np.max(np.abs(result.trace.storey_shears[after, 0])) / structure.static_base_shear
    # V before the impact still rings by exp(-xi w t), and C, A vary by alpha
    assert swing == pytest.approx(expected, rel=0.03)
