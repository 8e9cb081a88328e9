"""Steps are made for the fastest mode; where the tilt itself is faster, its series tells."""

from __future__ import annotations

import math

import numpy as np
import pytest
from paper_structures import building, needs_compiled_kernels, steps_an_interval, stillness

from rpscli.analyses.kernels import systems
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.bearing import Bearing
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import RayleighDamping

pytestmark = needs_compiled_kernels

SHORT = PodiumStructure(Bearing(0.12, 0.3, 0.6, 2.5), 5.9e3, 5.6e4, None, ImpactLaw("value", 1.0))
"""Columns of a quarter of a metre with large radii: a tilt of 0.3 rad moves the contact far."""

HEAVY = PodiumStructure(
    Bearing(0.3, 0.15, 0.3, 0.5),
    1e3,
    1e3,
    building(2, damping=RayleighDamping(0.0)),
    ImpactLaw("value", 1.0),
)
"""Floors of hundreds of columns: near theta_cr, where they rise no more, A has a valley."""


def drift(structure: PodiumStructure, rotation: float, accuracy: float) -> tuple[float, float]:
    """Largest change of the energy that should stay, over itself; steps over the plain number."""
    settings = TimeHistorySettings(
        free_vibration=2.0,
        initial_rotation=rotation * structure.bearing.critical_rotation,
        accuracy=accuracy,
    )
    result = time_history(structure, stillness(0.05), settings)
    stored = result.trace.energy_stored
    plain = len(stored) * steps_an_interval(structure, 0.05, accuracy)
    return float(np.max(np.abs(stored / stored[0] - 1.0))), result.history.steps / plain


@pytest.mark.parametrize(("structure", "rotation"), [(SHORT, 0.55), (HEAVY, 0.95)])
def test_steps_are_halved_where_the_tilt_is_fast(
    structure: PodiumStructure, rotation: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    # undamped buildings would have short steps anyway
    monkeypatch.setattr(systems, "MOST_LOST", math.inf)
    monkeypatch.setattr(systems, "_system", systems._system.__wrapped__)  # as if never made
    kept, steps = drift(structure, rotation, 1.0)
    with monkeypatch.context() as patch:
        patch.setattr(systems, "STEP_ERROR", math.inf)
        lost, plain = drift(structure, rotation, 1.0)
    assert steps > plain
    assert kept < 1e-5
    assert lost > 5.0 * kept
    assert drift(structure, rotation, 2.0)[0] < max(0.05 * kept, 1e-11)  # or rounding
