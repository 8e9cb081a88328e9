"""Where the storey comes to rest: what the excursions left out would have done to the building."""

from __future__ import annotations

import numpy as np
import pytest
from paper_structures import FLAT, Array, needs_compiled_kernels, podium, stillness

from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.impact import ImpactKind, ImpactLaw
from rpscli.model.podium import PodiumStructure

pytestmark = [needs_compiled_kernels, pytest.mark.evidence("impact laws", "exact")]

LAWS: list[tuple[ImpactKind, float]] = [("rigid", FLAT), ("flexible", 0.5), ("value", FLAT)]
TOLERANCES = np.array([1e-5, 1e-6, 1e-7, 1e-8])


def vibration(structure: PodiumStructure, tolerance: float) -> Array:
    """Drifts of a released structure long after it came to rest, while the building rings on."""
    settings = TimeHistorySettings(
        free_vibration=8.8,
        initial_rotation=0.02,
        recontact_tolerance=tolerance,
        accuracy=4.0,
    )
    result = time_history(structure, stillness(0.02), settings)
    (locked,) = (event for event in result.events if event.kind == "recontact")
    assert locked.time < 8.0
    return result.trace.drifts[401:440]


@pytest.mark.parametrize(("law", "rho"), LAWS)
def test_errors_are_in_proportion_to_the_tolerance(law: ImpactKind, rho: float) -> None:
    """The excursions left out change the drift rates by about u_b', which is added (3.5).

    u_b' is of the size 2 R sqrt(2 theta'' tol alpha). What is left out besides is what springs do
    during them, the product of two such roots or less.
    """
    structure = podium(2, 0.15, rho, law=ImpactLaw(law, 0.8 if law == "value" else None))
    exact = vibration(structure, 1e-13)  # a millionth of the least tolerance
    gaps = np.array([np.max(np.abs(vibration(structure, t) - exact)) for t in TOLERANCES])
    assert np.polyfit(np.log(TOLERANCES), np.log(gaps), 1)[0] > 0.8
    assert gaps[1] < 1e-3 * np.max(np.abs(exact))  # at the default tolerance
