"""Histories under both components: references, symmetries, the planar limit, energy, lanes."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from paper_structures import Array, RecordLoader, ground, needs_compiled_kernels
from two_components import followed, frame, pair, two_pulses

from rpscli.analyses.demand import Request, demands
from rpscli.analyses.kernels.history import sampled_history
from rpscli.analyses.kernels.systems import paired_systems
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import PodiumStructure
from rpscli.records.ground_motion import MotionComponents

pytestmark = needs_compiled_kernels

STEP = 0.01
ARCS: dict[str, Any] = {"tan_wedge": 0.3, "rho": 0.5}
THREE: dict[str, Any] = {"storeys": 3, "eta": 3.0, **ARCS}


def upwards() -> Array:
    """A vertical motion with its largest pulses about uplift [m/s2]."""
    t = np.arange(0.0, 6.0, STEP)
    z, y = (np.pi * (t - 1.45) / 0.4) ** 2, (np.pi * (t - 2.3) / 0.3) ** 2
    return np.asarray(2.5 * (1.0 - 2.0 * z) * np.exp(-z) - 2.0 * (1.0 - 2.0 * y) * np.exp(-y))


def of_record(
    fema_record: RecordLoader, number: int, start: float, seconds: float
) -> MotionComponents:
    """A part of a recorded pair times .6, from rest."""
    both = [fema_record(f"farfield/{number}/{way}") for way in "ab"]
    dt = both[0].dt
    first = round(start / dt)
    x, y = (0.6 * m.acceleration[first : first + round(seconds / dt) + 1] for m in both)
    x[0] = y[0] = 0.0
    return pair(x, y, dt)


@pytest.mark.evidence("both components", "program")
@pytest.mark.parametrize(
    ("vertical", "contact_time", "largest"),
    [
        (False, 0.0, 0.077501321),
        (False, 2e-3, 0.077567924),
        (True, 0.0, 0.077789294),
        (True, 2e-3, 0.077858273),
    ],
)
def test_two_pulses(vertical: bool, contact_time: float, largest: float) -> None:
    """Maxima by two other programs, vertical motion at uplift included."""
    x, y = two_pulses()
    motion = pair(x, y, STEP, upwards() if vertical else None)
    structure = frame(**THREE, contact_time=contact_time)
    fine = TimeHistorySettings(free_vibration=0.0, accuracy=3.0)
    assert followed(structure, motion, fine).left.max_theta == pytest.approx(largest, abs=1e-8)
    usual = followed(structure, motion)
    assert usual.left.max_theta == pytest.approx(largest, abs=1e-6)
    assert abs(usual.residual) < 2e-6


RECORDS = {
    # name: structure, pair, start; t: X, Y [s, rad], before re-contact; largest [rad]
    "flat": (
        {"storeys": 3, "eta": 3.0, "contact_time": 2e-3},
        (1, 2.0),
        {2: (-0.00674819, 0.00575108), 5: (0.0100137, -0.00601956), 8: (-0.01225124, -0.05620154)},
        0.0967778506,
    ),
    "arcs": (
        {**THREE},
        (2, 4.0),
        {1: (-0.0230332, 0.0180945), 4: (0.0219647, -0.0235107), 7: (0.0162141, -0.0161309)},
        0.0482232127,
    ),
    "rigid": (
        {**ARCS, "contact_time": 2e-3},
        (2, 4.0),
        {2: (0.01264699, 0.00959997), 5: (-0.01797882, 0.03279158)},
        0.0787047121,
    ),
    "nine storeys": (
        {"storeys": 9, "eta": 9.0, "period": 0.9, **ARCS, "contact_time": 2e-3},
        (1, 2.0),
        {},
        0.0831789,
    ),
}


@pytest.mark.evidence("both components", "program")
@pytest.mark.parametrize("name", RECORDS)
def test_recorded_pairs(name: str, fema_record: RecordLoader) -> None:
    """Tilts and maxima by adaptive integrators of two other programs."""
    options, (number, start), tilts, largest = RECORDS[name]
    history = followed(frame(**options), of_record(fema_record, number, start, 12.0))
    dt = 12.0 / (len(history.samples) - 1)
    for t, tilt in tilts.items():
        assert abs(history.tilt[round(t / dt)] - complex(*tilt)) < 1e-6
    assert history.left.max_theta == pytest.approx(largest, abs=1e-5)
    assert abs(history.residual) < 1e-6


@pytest.mark.evidence("both components", "exact")
@pytest.mark.parametrize("contact_time", [0.0, 2e-3])
def test_no_axis_is_special(contact_time: float) -> None:
    """Turned by any angle, the pair turns the result."""
    x, y = two_pulses()
    turn = np.exp(0.64j)
    turned = turn * (x + 1j * y)
    structure = frame(**THREE, contact_time=contact_time)
    fine = TimeHistorySettings(free_vibration=0.0, accuracy=4.0)
    one = followed(structure, pair(x, y, STEP), fine)
    other = followed(structure, pair(turned.real, turned.imag, STEP), fine)
    assert np.max(np.abs(turn * one.tilt - other.tilt)) < 1e-9
    for name in ("max_theta", "friction_bottom", "heavy_bottom", "torsion_lever"):
        assert other.left[name] == pytest.approx(one.left[name], rel=2e-3)
    for name in ("storey_shear", "floor_acceleration"):
        assert np.allclose(other.left[name][:3], one.left[name][:3], rtol=2e-4)


def test_directions_are_exchanged_with_their_buildings() -> None:
    """Another building in y: x and y change places."""
    x, y = two_pulses()
    options: dict[str, Any] = {"storeys": 3, "eta": 3.0, "contact_time": 2e-3}
    one = followed(frame(**options, period=0.3, period_y=0.5), pair(x, y, STEP))
    other = followed(frame(**options, period=0.5, period_y=0.3), pair(y, x, STEP))
    mirrored = 1j * np.conj(one.tilt)
    assert np.max(np.abs(mirrored - other.tilt)) < 1e-6 * 0.08
    assert np.allclose(one.left.storey_shear_x[:3], other.left.storey_shear_y[:3], rtol=1e-5)
    assert one.left.storey_shear_x[0] != pytest.approx(one.left.storey_shear_y[0], rel=0.01)
    same = followed(frame(**options, period=0.3, period_y=0.3), pair(x, y, STEP))
    assert same.tilt.tolist() == followed(frame(**options), pair(x, y, STEP)).tilt.tolist()


@pytest.mark.evidence("both components", "exact")
def test_one_component_is_the_planar_motion() -> None:
    """Along x with an impact's loss: Y stays 0, the planar program's rotations and demands."""
    x, _ = two_pulses()
    structure = frame(**THREE, contact_time=2e-3)
    history = followed(structure, pair(x, 0.0 * x, STEP))
    settings = TimeHistorySettings(free_vibration=0.0)
    planar = sampled_history(structure, MotionComponents(ground(x, STEP)), settings)
    assert set(history.samples.azimuth.tolist()) <= {0.0, np.pi, -np.pi}
    until = round(history.recontacts.time[0] / STEP) if len(history.recontacts) else None
    assert np.max(np.abs(history.tilt.real - planar.samples.theta)[:until]) < 1e-6
    left, other = history.left, planar.history
    assert left.max_theta == pytest.approx(other.max_theta, rel=1e-4)
    for mine in ("storey_shear", "storey_shear_x"):
        assert np.allclose(left[mine][:3], other.storey_shear[:3], rtol=1e-3)
    assert np.allclose(left.floor_acceleration[:3], other.floor_acceleration[:3], rtol=2e-3)
    assert not left.storey_shear_y.any()
    for name in ("normal_bottom", "heavy_bottom", "friction_top"):
        assert left[name] == pytest.approx(other[name], rel=5e-3)


@pytest.mark.evidence("both components", "exact")
@pytest.mark.parametrize("options", [{"contact_time": 0.0}, {"factor": 1.0 / 0.8388687078360144}])
def test_nothing_is_lost_without_contact_time_or_loss(options: dict[str, Any]) -> None:
    x, y = two_pulses()
    history = followed(frame(**{**THREE, **options}), pair(x, y, STEP))
    assert len(history.passes)
    assert history.left.energy_passes == pytest.approx(0.0, abs=1e-12 * history.left.energy_input)


def test_alone_and_in_company() -> None:
    """The same bits, whatever goes on in other lanes."""
    x, y = two_pulses()
    settings = TimeHistorySettings(free_vibration=2.0)
    requests = [
        Request(structure, pair(factor * x, y, STEP), settings)
        for structure in (frame(**THREE, contact_time=2e-3), frame(3, 3.0))
        for factor in np.linspace(0.5, 1.6, 20)
    ]
    together, alone = demands(requests), demands(requests, worth_lanes=1000)
    assert len({one.max_rotation for one in together}) > len(requests) / 2  # some overturn
    for one, other in zip(together, alone, strict=True):
        assert one.history.tobytes() == other.history.tobytes()


def test_more_instants_change_nothing() -> None:
    """Samples between samples lie on the same motion."""
    x, y = two_pulses(3.0)
    structure = frame(**THREE, contact_time=2e-3)
    usual, finer = (followed(structure, pair(x, y, STEP), finer=parts) for parts in (1, 4))
    assert np.array_equal(usual.tilt, finer.tilt[::4])
    assert np.array_equal(usual.floors, finer.floors[::4])
    middle = finer.floors[2::4, 0]
    cubic = 0.5 * (usual.floors[:-1, 0] + usual.floors[1:, 0])
    cubic += STEP / 8.0 * (usual.floors[:-1, 1] - usual.floors[1:, 1])
    assert np.max(np.abs(middle - cubic)) < 1e-3 * np.max(np.abs(cubic))


def test_what_has_no_form_in_two_directions_is_refused() -> None:
    rigid = PodiumStructure(
        frame().bearing, 1e4, 1e5, frame(**THREE).superstructure, ImpactLaw("rigid")
    )
    with pytest.raises(ValueError, match="both horizontal components: the impact law rigid"):
        paired_systems([(rigid, TimeHistorySettings())])
