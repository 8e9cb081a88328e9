"""Histories under recorded earthquakes, as the second integrator follows them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from paper_structures import FLAT, RecordLoader, needs_compiled_kernels, podium

from rpscli.analyses.demand import demand
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history

pytestmark = [
    needs_compiled_kernels,
    pytest.mark.evidence("buildings on bearings under earthquakes", "program"),
]

# component, storeys, tan alpha, rho; max theta [rad], V_b/V_st, impacts
HISTORIES = [
    ("farfield/1/b", 3, 0.15, 0.5, "0.1494765", "2.486381", 127),
    ("farfield/1/b", 6, 0.20, 0.25, "0.1107931", "1.779236", 89),
    ("farfield/1/b", 9, 0.15, 1.5, "0.1057440", "2.270530", 373),
    ("farfield/1/b", 6, 0.15, FLAT, "0.1206736", "1.865404", 205),
    ("farfield/17/a", 6, 0.20, 0.25, "0.0147332", "1.682869", 223),
    ("farfield/17/a", 9, 0.15, 1.5, "0.0109837", "1.385401", 301),
    ("farfield/17/a", 6, 0.15, FLAT, "0.0374753", "1.604492", 627),
    ("nearfield_pulse/9/a", 3, 0.15, 0.5, "0.1885908", "2.382181", 226),
    ("nearfield_pulse/9/a", 6, 0.20, 0.25, "0.1807587", "1.845996", 93),
    ("nearfield_pulse/9/a", 9, 0.15, 1.5, "0.2042489", "1.970985", 126),
    ("nearfield_pulse/9/a", 6, 0.15, FLAT, "0.1222458", "1.515862", 176),
]


def printed(text: str) -> object:
    """Within one unit of the last digit printed."""
    return pytest.approx(float(text), abs=1.01 * 10.0 ** -len(text.partition(".")[2]))


@pytest.mark.parametrize(
    ("component", "storeys", "tan_alpha", "rho", "rotation", "shear", "impacts"), HISTORIES
)
def test_converged_histories(
    component: str,
    storeys: int,
    tan_alpha: float,
    rho: float,
    rotation: str,
    shear: str,
    impacts: int,
    fema_record: RecordLoader,
) -> None:
    structure, record = podium(storeys, tan_alpha, rho), fema_record(component)
    usual = TimeHistorySettings(free_vibration=10.0)
    fine = demand(structure, record, replace(usual, accuracy=4.0))
    assert fine.max_rotation == printed(rotation)
    # the printed shears were looked at where the record has samples
    trace = time_history(structure, record, replace(usual, accuracy=4.0)).trace
    sampled = float(np.max(np.abs(trace.storey_shears[:, 0])))
    assert sampled / structure.static_base_shear == printed(shear)
    assert sampled <= fine.storey_shears[0] < 1.02 * sampled
    assert fine.impacts == impacts
    # the default step is far within the 1e-4 that its description promises for most histories
    default = demand(structure, record, usual)
    assert default.max_rotation == pytest.approx(fine.max_rotation, rel=1e-7)
    assert default.storey_shears == pytest.approx(fine.storey_shears, rel=1e-4)
    assert default.impacts == impacts
