"""Where the storey comes to rest: what the excursions left out would have done to the building."""

from __future__ import annotations

from typing import Literal

import numpy as np
import pytest
from paper_structures import FLAT, Array, needs_compiled_kernels, podium, stillness

from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.impact import ImpactKind, ImpactLaw
from rpscli.model.podium import PodiumStructure

pytestmark = [needs_compiled_kernels, pytest.mark.evidence("impact laws", "exact")]

Rule = Literal["relative", "limit"]

LAWS: list[tuple[ImpactKind, float]] = [("rigid", FLAT), ("flexible", 0.5), ("value", FLAT)]
TOLERANCES = np.array([1e-5, 1e-6, 1e-7, 1e-8])


def vibration(structure: PodiumStructure, tolerance: float, rule: Rule) -> Array:
    """Drifts of a released structure long after it came to rest, while the building rings on."""
    settings = TimeHistorySettings(
        free_vibration=8.8,
        initial_rotation=0.02,
        recontact_tolerance=tolerance,
        recontact_rule=rule,
        accuracy=4.0,
    )
    result = time_history(structure, stillness(0.02), settings)
    (locked,) = (event for event in result.events if event.kind == "recontact")
    assert locked.time < 8.0
    return result.trace.drifts[401:440]


def errors(structure: PodiumStructure, rule: Rule) -> Array:
    """Against bounces followed to a millionth of the least tolerance, relative to the vibration."""
    exact = vibration(structure, 1e-13, "limit")
    gaps = [np.max(np.abs(vibration(structure, t, rule) - exact)) for t in TOLERANCES]
    return np.array(gaps) / float(np.max(np.abs(exact)))


def order(gaps: Array) -> float:
    return float(np.polyfit(np.log(TOLERANCES), np.log(gaps), 1)[0])


@pytest.mark.parametrize(("law", "rho"), LAWS)
def test_relative_errs_by_the_root_and_limit_in_proportion(law: ImpactKind, rho: float) -> None:
    """The excursions left out change the drift rates by about u_b' at locking.

    u_b' is of the size 2 R sqrt(2 theta'' tol alpha), which `relative` leaves out. What `limit`
    leaves out besides is what springs do during them, the product of two such roots or less.
    """
    structure = podium(2, 0.15, rho, law=ImpactLaw(law, 0.8 if law == "value" else None))
    relative, limit = errors(structure, "relative"), errors(structure, "limit")
    assert order(relative) == pytest.approx(0.5, abs=0.1)
    assert order(limit) > 0.8
    # at the default tolerance
    assert limit[1] < 1e-3
    assert relative[1] > 3e-2


@pytest.mark.parametrize("rule", ["relative", "limit"])
def test_without_a_building_the_rule_makes_no_difference(rule: Rule) -> None:
    structure = podium(0, 0.15, FLAT)
    settings = TimeHistorySettings(free_vibration=6.0, initial_rotation=0.02, recontact_rule=rule)
    result = time_history(structure, stillness(0.02), settings)
    plain = time_history(
        structure, stillness(0.02), TimeHistorySettings(free_vibration=6.0, initial_rotation=0.02)
    )
    assert result.events == plain.events
    assert np.array_equal(result.trace.rotation, plain.trace.rotation)
