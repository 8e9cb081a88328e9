"""Base shear is that of springs; what dashpots of storeys carry besides is said beside it."""

from dataclasses import replace

import numpy as np
import pytest
from conformance import conforms
from paper_structures import building, needs_compiled_kernels, podium, waves, yielding

from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.impact import ImpactLaw
from rpscli.model.superstructure import ModalDamping
from rpscli.records.ground_motion import MotionComponents
from rpscli.report.timehistory import demand_tables

pytestmark = [
    needs_compiled_kernels,
    pytest.mark.evidence("buildings on bearings under earthquakes", "exact"),
]

RECORD = waves(6.0, 0.002, 6.0, seed=12)
SETTINGS = TimeHistorySettings(free_vibration=4.0)


def damped(ratio, *, yields=False):
    above = building(3, damping=ModalDamping(ratio))
    if yields:
        above = yielding(above, 1.2 * podium(3).static_base_shear)
    return podium(3, superstructure=above, law=ImpactLaw())


def row_of(result):
    """The row beneath the base shear, in words; nothing if there is none."""
    table = next(iter(demand_tables(result)))
    rows = zip(*(column.values for column in table.columns), strict=True)
    return next((row for row in rows if row[0].strip().startswith("with dashpots")), None)


@pytest.mark.parametrize("yields", [False, True])
def test_it_changes_the_momentum_of_the_floors(yields):
    result = time_history(damped(0.15, yields=yields), RECORD, SETTINGS)
    trace = result.trace
    masses = result.structure.superstructure.masses
    momentum = trace.floor_velocities @ masses
    rates = np.diff(momentum) / np.diff(trace.time)
    ground = 0.5 * (trace.ground_acceleration[1:] + trace.ground_acceleration[:-1])
    force = np.abs(rates + masses.sum() * ground).max()
    conforms(
        "buildings on bearings under earthquakes", "base shear with dashpots [N]", force,
        result.base_shear_with_dashpots, 0.01 * force,
        "identity", "rate of the momentum of the floors",
    )  # fmt: skip
    part = result.base_shear_with_dashpots / result.max_base_shear - 1.0
    assert part > 0.05
    _, value, words, _ = row_of(result)
    assert value == f"{1e-3 * result.base_shear_with_dashpots:.0f} kN"
    assert words == f"{100.0 * part:.1f} % more than springs"


def test_without_dashpots_it_is_the_base_shear():
    result = time_history(damped(1e-6), RECORD, SETTINGS)
    shear = result.max_base_shear
    assert result.base_shear_with_dashpots == pytest.approx(shear, rel=2e-3)
    assert row_of(result) is None


def test_of_a_pair_it_is_the_largest_resultant():
    pair = MotionComponents(RECORD.scaled(0.6), y=waves(6.0, 0.002, 3.0, seed=3))
    result = time_history(damped(0.15), pair, SETTINGS)
    masses = result.structure.superstructure.masses
    both = [of.floor_accelerations @ masses for of in (result.trace, result.trace.y)]
    largest = np.hypot(*both).max()
    assert result.base_shear_with_dashpots == pytest.approx(largest, rel=1e-12)
    frame = replace(podium(0), impact_law=ImpactLaw())
    assert time_history(frame, RECORD, SETTINGS).base_shear_with_dashpots is None
