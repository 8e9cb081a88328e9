"""A study names points that depend on the length of steps."""

from __future__ import annotations

import numpy as np
import pytest
from paper_structures import FLAT, building, needs_compiled_kernels, podium, stillness, waves

from rpscli.analyses.demand import Request, demands
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.records.ground_motion import MotionComponents
from rpscli.sweep import steps
from rpscli.sweep.steps import step_notes

pytestmark = needs_compiled_kernels


class Points:
    """What is asked of a table, its layout and its context: every fourth history is chaotic."""

    def __init__(self, count: int) -> None:
        self.failed = np.zeros(count, bool)
        self.layout = self.context = self
        self.structure = podium(1, 0.15, FLAT, superstructure=building(1, 0.1))
        self.chaotic = waves(60.0, 0.01, 3.0 * self.structure.uplift_acceleration, seed=3)
        found = demands([self.history(number) for number in range(count)])
        self.outcomes = np.array([one.outcome for one in found])
        names = "max_rotation", "max_base_shear"
        self.columns = {name: np.array([getattr(one, name) for one in found]) for name in names}

    def __getitem__(self, number: int) -> int:
        return number

    def history(self, number: int) -> Request:
        motion = self.chaotic if number % 4 == 2 else stillness(1.0)
        settings = TimeHistorySettings(free_vibration=1.0)
        return Request(self.structure, MotionComponents(motion), settings)


def notes(points: Points) -> list[str]:
    return list(step_notes(points))  # type: ignore[arg-type]


def test_points_that_change_are_named(monkeypatch: pytest.MonkeyPatch) -> None:
    (found,) = notes(Points(4))
    assert found.startswith("steps: of 4 points (of 4) computed again")
    assert "1 changed: point 3 (max_rotation " in found
    monkeypatch.setattr(steps, "MOST", 2)
    (found,) = notes(Points(4))  # the first and the third
    assert found.startswith("steps: of 2 points (of 4) computed again")
    assert "point 3 (" in found


def test_what_is_computed_the_same_or_failed_is_not_told() -> None:
    assert notes(Points(2)) == []
    failed = Points(4)
    failed.failed[2] = True
    assert notes(failed) == []


def test_what_was_not_tried_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(steps, "is_ready", lambda *_: False)
    (found,) = notes(Points(4))
    assert "steps of half the length was not tried" in found
    assert "the kernel that computes them is not compiled yet" in found
