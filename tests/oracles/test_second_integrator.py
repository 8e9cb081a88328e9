"""The second integrator: what bounces add at re-contact, and digits under recorded motions.

Closed forms that it shares with the program stand in `certified`, where it is the first road.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Literal, NamedTuple

import numpy as np
import pytest
from paper_structures import RecordLoader, oracle_system, podium

from .crossings import Array
from .second_integrator import _Simulation, simulate
from .storey_lagrangian import OracleSystem


@pytest.mark.parametrize(
    ("law", "restitution"),
    [("rigid", 0.7), pytest.param("flexible", 0.5, marks=pytest.mark.long)],
)
def test_locking_needs_no_small_tolerance(
    law: Literal["rigid", "flexible"], restitution: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    system = replace(oracle_system(podium(2, 0.15, 0.0)), law=law, restitution=restitution)
    followed_far = drifts_at_the_end(system, 1e-11)
    size = float(np.max(np.abs(followed_far)))
    assert drifts_at_the_end(system, 1e-6) == pytest.approx(followed_far, abs=1e-4 * size)
    # without what bounces add, a part is missing that shrinks like the square root of the tolerance
    monkeypatch.setattr(_Simulation, "left_out", lambda *_: 0.0)
    assert np.max(np.abs(drifts_at_the_end(system, 1e-6) - followed_far)) > 1e-2 * size
    assert drifts_at_the_end(system, 1e-11) == pytest.approx(followed_far, abs=1e-3 * size)


def drifts_at_the_end(system: OracleSystem, tolerance: float) -> Array:
    """Drifts at the last samples, upright, after a release from 0.02 rad."""
    result = simulate(
        system,
        np.zeros(1),
        0.02,
        free_vibration=2.0,
        recontact_tolerance=tolerance,
        initial_rotation=0.02,
    )
    assert result.theta[-1] == 0.0
    return result.drifts[-20:]


class Row(NamedTuple):
    record: str
    storeys: int
    tan_alpha: float
    rho: float
    max_rotation: float
    shear_ratio: float
    impacts: int


ROWS = [
    Row("farfield/1/b", 3, 0.15, 0.5, 0.1494765, 2.486381, 127),
    Row("farfield/1/b", 6, 0.20, 0.25, 0.1107931, 1.779236, 89),
    Row("farfield/1/b", 9, 0.15, 1.5, 0.1057440, 2.270530, 373),
    Row("farfield/1/b", 6, 0.15, 0.0, 0.1206736, 1.865404, 205),
    Row("farfield/17/a", 6, 0.20, 0.25, 0.0147332, 1.682869, 223),
    Row("farfield/17/a", 9, 0.15, 1.5, 0.0109837, 1.385401, 301),
    Row("farfield/17/a", 6, 0.15, 0.0, 0.0374753, 1.604492, 627),
    Row("nearfield_pulse/9/a", 3, 0.15, 0.5, 0.1885908, 2.382181, 226),
    Row("nearfield_pulse/9/a", 6, 0.20, 0.25, 0.1807587, 1.845996, 93),
    Row("nearfield_pulse/9/a", 9, 0.15, 1.5, 0.2042489, 1.970985, 126),
    Row("nearfield_pulse/9/a", 6, 0.15, 0.0, 0.1222458, 1.515862, 176),
]


@pytest.mark.evidence("buildings on bearings under earthquakes", "program")
@pytest.mark.parametrize(
    "row",
    [row if row is ROWS[4] else pytest.param(row, marks=pytest.mark.long) for row in ROWS],
    ids=lambda row: f"{row.record}-{row.storeys}-{row.rho}",
)
def test_earthquakes(row: Row, fema_record: RecordLoader) -> None:
    """Digits that a hundredth of the tolerance leaves alone."""
    structure = podium(row.storeys, row.tan_alpha, row.rho)
    record = fema_record(row.record)
    result = simulate(oracle_system(structure), record.acceleration, record.dt)
    shear_ratio = result.max_storey_shears_at_samples[0] / structure.static_base_shear
    # seven and six decimals are given
    assert result.max_rotation == pytest.approx(row.max_rotation, abs=5.5e-8)
    assert shear_ratio == pytest.approx(row.shear_ratio, abs=1e-6)
    assert result.impacts == row.impacts
