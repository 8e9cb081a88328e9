"""Histories whose maxima depend on the step say so; the others do not."""

from __future__ import annotations

from dataclasses import replace

import pytest
from paper_structures import building, needs_compiled_kernels, podium, waves

from rpscli.analyses import neighbours
from rpscli.analyses.demand import demand
from rpscli.analyses.neighbours import steps_warning
from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.devices import FrictionDamper, Tendon
from rpscli.model.podium import PodiumStructure
from rpscli.model.statics import uplift_acceleration
from rpscli.model.superstructure import ModalDamping
from rpscli.records.ground_motion import GroundMotion

pytestmark = needs_compiled_kernels


def history(structure: PodiumStructure, record: GroundMotion) -> TimeHistoryResult:
    return time_history(structure, record, TimeHistorySettings(free_vibration=1.0))


def ringing(xi: float, seed: int, amplitude: float) -> TimeHistoryResult:
    """One stiff storey that hardly damps, under friction and tendons, small rotations."""
    above = building(1, 0.088, damping=ModalDamping(xi))
    bare = podium(1, 0.15, 0.5, superstructure=above)
    devices = FrictionDamper(0.1 * bare.uplift_force), Tendon(0.01 * bare.weight, bare.weight)
    structure = replace(bare, devices=devices, columns=6)
    record = waves(12.0, 0.01, 1.0, seed=seed)
    return history(
        structure, record.scaled(amplitude * uplift_acceleration(structure) / record.pga)
    )


def error(result: TimeHistoryResult, accuracy: float) -> float:
    """Of the largest rotation, against steps an eighth as long."""
    settings = replace(result.settings, accuracy=8.0)
    exact = demand(result.structure, result.record, settings).max_rotation
    shorter = replace(result.settings, accuracy=accuracy)
    return abs(demand(result.structure, result.record, shorter).max_rotation / exact - 1.0)


@pytest.mark.parametrize(("seed", "amplitude", "enough"), [(7, 1.4, 2), (155, 1.5, 2)])
def test_a_fast_vibration_between_devices_is_seen(seed: int, amplitude: float, enough: int) -> None:
    """The energy closes to 1e-7, and yet the default step is 1e-3 and more off."""
    result = ringing(0.002, seed, amplitude)
    assert abs(result.energy.residual) < 2e-7 * result.energy.input
    assert error(result, 1.0) > 1e-3
    assert error(result, enough) < 1e-4
    warning = steps_warning(result)
    assert warning is not None
    assert "the largest rotation by" in warning
    assert warning.endswith(f"use analysis.accuracy = {enough}")


def test_ordinary_damping_settles_it() -> None:
    result = ringing(0.05, 190, 1.3)
    assert error(result, 1.0) < 1e-6
    assert steps_warning(result) is None
    assert steps_warning(history(podium(0), waves(6.0, 0.01, 3.0, seed=1))) is None


def test_motions_that_never_converge_are_called_samples(monkeypatch: pytest.MonkeyPatch) -> None:
    above = building(1, 0.06, damping=ModalDamping(0.001))
    structure = podium(1, 0.15, 0.3, superstructure=above)
    result = history(structure, waves(60.0, 0.01, 3.0 * structure.uplift_acceleration, seed=7))
    warning = steps_warning(result)
    assert warning is not None
    assert warning.endswith("judge by many records")
    # what takes long is not run again
    monkeypatch.setattr(neighbours, "MOST_STEPS", 1000)
    assert steps_warning(result) is None
