"""What a change of side, of scale and of mass must not change."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from paper_structures import COMPILED, FLAT, ground, known, podium, waves

from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import Superstructure
from rpscli.records.ground_motion import GroundMotion

pytestmark = pytest.mark.evidence("equation of motion", "exact")

SETTINGS = TimeHistorySettings(free_vibration=2.0)
RECORD = waves(6.0 if COMPILED else 1.6, 0.02, 4.0, seed=11)
VERTICAL = waves(6.0 if COMPILED else 1.6, 0.02, 2.0, seed=12)

CONTACTS = ("friction_top", "friction_bottom", "normal_top", "normal_bottom")

STRUCTURES = [
    podium(0, 0.15, 0.5),
    podium(1, 0.15, FLAT),
    podium(3, 0.20, 0.26),
    podium(3, 0.15, 1.5, law=ImpactLaw("flexible")),
]


def name(structure: PodiumStructure) -> str:
    parts = structure.storeys, structure.bearing.curvature_ratio, structure.impact_law.kind
    return "-".join(map(str, parts))


@pytest.mark.parametrize("structure", STRUCTURES, ids=name)
@pytest.mark.parametrize("start", [0.0, 0.3])
def test_without_gravity_the_push_chooses_the_side(
    structure: PodiumStructure, start: float
) -> None:
    """Both margins against uplift are negative at once."""
    sway = start + 0.4 * np.linspace(0.0, 1.0, 30) ** 2
    falling = ground(np.full(30, -1.3 * structure.gravity), 0.02)
    here, there = (
        time_history(structure, ground(side * sway, 0.02), SETTINGS, vertical=falling)
        for side in (1.0, -1.0)
    )
    assert here.events[0].kind == "uplift"
    assert here.events[0].time == 0.0
    assert here.trace.rotation[1] < 0.0 < there.trace.rotation[1]
    assert np.array_equal(here.trace.rotation, -there.trace.rotation)


def with_building(structure: PodiumStructure, mass: float, stiffness: float) -> PodiumStructure:
    """All masses times `mass`, all storey stiffnesses times `stiffness`."""
    above = structure.superstructure
    if above is not None:
        above = Superstructure(mass * above.masses, stiffness * above.stiffnesses, above.damping)
    columns, beam = mass * structure.columns_mass, mass * structure.cap_beam_mass
    return replace(structure, columns_mass=columns, cap_beam_mass=beam, superstructure=above)


@pytest.mark.parametrize("structure", STRUCTURES, ids=name)
def test_lengths_times_l_and_times_times_root_l(structure: PodiumStructure) -> None:
    scale = 2.7
    bearing = replace(structure.bearing, semi_diagonal=scale * structure.bearing.semi_diagonal)
    large = replace(with_building(structure, 1.0, 1.0 / scale), bearing=bearing)
    root = np.sqrt(scale)
    slow = ground(RECORD.acceleration, root * RECORD.dt)
    settings = replace(SETTINGS, free_vibration=2.0 * root)
    one, two = time_history(structure, RECORD, SETTINGS), time_history(large, slow, settings)
    assert one.impacts == two.impacts > 0
    # equal but for rounding, which impacts amplify to about 1e4 eps
    assert two.trace.rotation == pytest.approx(one.trace.rotation, abs=1e-10)
    assert two.trace.drifts == pytest.approx(scale * one.trace.drifts, abs=1e-10)
    assert two.storey_shears == pytest.approx(one.storey_shears, rel=1e-9)
    assert two.floor_accelerations == pytest.approx(one.floor_accelerations, rel=1e-9)
    times = np.array([event.time for event in one.events])
    assert [event.time for event in two.events] == pytest.approx(root * times, rel=1e-8)


@pytest.mark.parametrize("structure", STRUCTURES, ids=name)
def test_masses_and_stiffnesses_times_anything(structure: PodiumStructure) -> None:
    factor = 3.1
    heavy = with_building(structure, factor, factor)
    one, two = time_history(structure, RECORD, SETTINGS), time_history(heavy, RECORD, SETTINGS)
    assert one.impacts == two.impacts > 0
    assert two.trace.rotation == pytest.approx(one.trace.rotation, abs=1e-10)
    assert two.storey_shears == pytest.approx(factor * one.storey_shears, rel=1e-9)
    for name in ("input", "damped", "impact", "stored"):
        larger, smaller = getattr(two.energy, name), getattr(one.energy, name)
        assert larger == pytest.approx(factor * smaller, rel=1e-7)
    for name in CONTACTS:
        assert two.history[name] == pytest.approx(one.history[name], rel=1e-8)


@pytest.mark.evidence("vertical motion", "exact")
@pytest.mark.parametrize("structure", STRUCTURES, ids=name)
def test_a_constant_vertical_acceleration_is_a_change_of_gravity(
    structure: PodiumStructure,
) -> None:
    """Up to the last sample, after which the ground stands still."""
    settings = replace(SETTINGS, free_vibration=0.0)
    rising = ground(np.full(RECORD.npts, 1.5), RECORD.dt)
    heavier = replace(structure, gravity=structure.gravity + 1.5)
    one = time_history(structure, RECORD, settings, vertical=rising)
    two = time_history(heavier, RECORD, settings)
    assert one.impacts == two.impacts > 0
    assert two.trace.rotation == pytest.approx(one.trace.rotation, abs=1e-10)
    assert two.storey_shears == pytest.approx(one.storey_shears, rel=1e-9)
    assert two.friction_demand == pytest.approx(one.friction_demand, rel=1e-8)


def test_a_rigid_building_moves_like_a_heavier_cap_beam() -> None:
    """As the periods shrink, the storey becomes the frame with gamma (1 + eta)."""
    frame = PodiumStructure(podium(0, 0.15, 0.5).bearing, 2e4, 2e5 * 3.0)
    assert frame.gamma == podium(2).gamma_total
    record = waves(1.0, 0.02, 4.0, seed=11)
    differences = []
    for period in (0.04, 0.02):
        above = known(podium(2).superstructure)
        above = replace(above, stiffnesses=above.stiffnesses * (0.2 / period) ** 2)
        stiff = time_history(podium(2, superstructure=above), record, SETTINGS)
        rigid = time_history(frame, record, SETTINGS)
        before_impact = int(rigid.events[1].time / record.dt)
        assert before_impact > 10
        gap = stiff.trace.rotation[:before_impact] - rigid.trace.rotation[:before_impact]
        differences.append(np.max(np.abs(gap)) / rigid.max_rotation)
    # drifts are of the size of a_g T^2/(4 pi^2)
    assert differences[0] < 0.05
    assert differences[1] == pytest.approx(differences[0] / 4.0, rel=0.5)


def shifted(record: GroundMotion, samples: int) -> GroundMotion:
    return ground(np.concatenate((np.zeros(samples), record.acceleration)), record.dt)


def test_quiet_before_the_record_only_delays_the_history() -> None:
    structure = podium(3, 0.2, 0.5)
    one = time_history(structure, RECORD, SETTINGS)
    two = time_history(structure, shifted(RECORD, 17), SETTINGS)
    assert np.array_equal(one.trace.rotation, two.trace.rotation[17:])
    assert one.storey_shears.tolist() == two.storey_shears.tolist()
