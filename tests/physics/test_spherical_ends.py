"""Columns without a flat part: they roll from rest, through the upright position, without impact.

What is known of them does without the program's formulas: a Lagrangian of its own in the signed
tilt, whose contact is built from rotated points, and closed forms in height and radius.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from paper_structures import building, ground, known, needs_compiled_kernels, stillness, waves
from scipy.integrate import DOP853

from rpscli.analyses.demand import Request, demand, demands
from rpscli.analyses.modal import modal
from rpscli.analyses.pushover import pushover
from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.bearing import Bearing
from rpscli.model.devices import FrictionDamper, RollingResistance, Stop, Tendon, ViscousDamper
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import Device, PodiumStructure
from rpscli.records.ground_motion import GroundMotion, MotionComponents
from rpscli.report.tables.timehistory import outcome_text

H, RADIUS, HALF_WEDGE, INERTIA = 1.5, 2.0, 0.45, 4.0 / 3.0
COLUMNS, BEAM, G = 2e4, 2e5, 9.80665


def on_spheres(
    storeys: int = 0, *devices: Device, flat: float = 0.0, law: ImpactLaw | None = None
) -> PodiumStructure:
    """Four columns 3 m high with ends of 2 m radius, 0.9 m wide."""
    R = math.hypot(H, H * flat)
    bearing = Bearing(R, flat, HALF_WEDGE / H, RADIUS / (2.0 * H), INERTIA)
    above = building(storeys) if storeys else None
    return PodiumStructure(
        bearing, COLUMNS, BEAM, above, law or ImpactLaw(), G, tuple(devices), columns=4
    )


def column_centre(theta: float) -> tuple[complex, complex, complex]:
    """How far a column's centre has moved, with two derivatives by the tilt [m]: across + 1j up.

    A clockwise turn is a factor exp(-1j theta): on what leads from the arc's centre, which rolls
    along, to the column's; and beyond the arc on what leads there from its end, which stands.
    """
    end, side = math.asin(HALF_WEDGE / RADIUS), math.copysign(1.0, theta)
    turn = complex(math.cos(theta), -math.sin(theta))
    if abs(theta) < end:
        arm = 1j * (H - RADIUS) * turn
        return RADIUS * (theta + 1j) + arm - 1j * H, RADIUS - 1j * arm, -arm
    edge = complex(side * HALF_WEDGE, RADIUS * (1.0 - math.cos(end)) - H) * turn
    return side * RADIUS * end - edge - 1j * H, 1j * edge, edge


class OwnLagrangian:
    """The tilt and the floors' absolute coordinates under a linear ground acceleration."""

    def __init__(self, structure: PodiumStructure) -> None:
        above, self.devices = structure.superstructure, structure.devices
        self.n = structure.storeys
        self.masses = np.zeros(0) if above is None else above.masses
        self.stiffness = np.zeros((0, 0)) if above is None else above.stiffness_matrix
        self.damping = np.zeros((0, 0)) if above is None else above.damping_matrix

    def rates(self, y: np.ndarray, a_g: float, a_v: float) -> np.ndarray:
        n = self.n
        theta, u, rate, v = y[0], y[1 : n + 1], y[n + 1], y[n + 2 :]
        # the cap beam moves twice as far as the centres
        at, slope, bend = (2.0 * z for z in column_centre(theta))
        beam, beam_rate = at.real, slope.real * rate
        springs = self.stiffness @ (u - beam) + self.damping @ (v - beam_rate)
        pull, weight = 0.0, G + a_v
        for device in self.devices:
            if isinstance(device, ViscousDamper):
                speed = abs(beam_rate) ** device.exponent
                pull += device.coefficient * math.copysign(speed, beam_rate)
            elif isinstance(device, Stop):
                beyond = max(abs(beam) - device.gap, 0.0)
                pull += device.stiffness * math.copysign(beyond, beam)
        # columns move half as far, and turn
        own = 0.25 * COLUMNS + BEAM
        lifted = own + self.masses.sum()
        inertia = COLUMNS * (INERTIA - 1.0) * H * H + own * slope.real**2 + lifted * slope.imag**2
        moment = (own * slope.real * bend.real + lifted * slope.imag * bend.imag) * rate**2
        gravity = (0.5 * COLUMNS + BEAM + self.masses.sum()) * weight * slope.imag
        thrust = slope.real * (springs.sum() - pull - (0.5 * COLUMNS + BEAM) * a_g)
        return np.concatenate(
            [[rate], v, [(thrust - gravity - moment) / inertia], -springs / self.masses - a_g]
        )

    def follow(self, record: GroundMotion, up: GroundMotion | None, start: float) -> np.ndarray:
        """(samples, 2 (n + 1)) at the record's samples; restarted where the tilt passes beta."""
        y = np.zeros(2 * (self.n + 1))
        y[0] = start
        y[1 : self.n + 1] = 2.0 * column_centre(start)[0].real
        found, h = [y], record.dt
        rises = np.zeros(record.npts) if up is None else up.acceleration
        for k in range(record.npts - 1):
            a, b = record.acceleration[k : k + 2], rises[k : k + 2]

            def right(t: float, y: np.ndarray, a: np.ndarray = a, b: np.ndarray = b) -> np.ndarray:
                s = t / h
                return self.rates(y, a[0] + (a[1] - a[0]) * s, b[0] + (b[1] - b[0]) * s)

            solver = DOP853(right, 0.0, y, h, rtol=1e-12, atol=1e-13)
            while solver.status == "running":
                solver.step()
            y = solver.y
            found.append(y)
        return np.array(found)


MOTION = waves(4.0, 0.02, 5.0, 3)
RISING = waves(4.0, 0.02, 2.0, 4)
SHORT = TimeHistorySettings(free_vibration=0.0)


@pytest.mark.evidence("spherical ends", "program")
@needs_compiled_kernels
@pytest.mark.parametrize(
    ("structure", "scale", "up"),
    [
        (on_spheres(), 1.0, False),
        (on_spheres(), 4.0, True),
        (on_spheres(3), 1.0, True),
        (on_spheres(3), 4.0, False),
        (on_spheres(2, ViscousDamper(3e5)), 2.0, False),
        (on_spheres(0, ViscousDamper(1e5, 1.5), Stop(0.1, 2e6)), 2.0, False),
        (on_spheres(0, Stop(0.0, 1e6)), 1.0, False),
    ],
    ids=["frame", "frame, rocking", "storeys", "storeys, rocking", "damper", "stop", "no gap"],
)
def test_motion_is_that_of_an_own_lagrangian(
    structure: PodiumStructure, scale: float, up: bool
) -> None:
    record, settings = replace(MOTION, acceleration=scale * MOTION.acceleration), SHORT
    vertical = RISING if up else None
    result = time_history(structure, record, settings, vertical=vertical, with_fixed_base=False)
    n, known = structure.storeys, OwnLagrangian(structure).follow(record, vertical, 0.0)
    theta = result.trace.rotation
    size = np.max(np.abs(known[:, 0]))
    assert result.outcome == "survived"
    assert (size > structure.bearing.beta) == (scale == 4.0)
    np.testing.assert_allclose(theta, known[: len(theta), 0], rtol=0.0, atol=1e-7 * size)
    if n:
        floors = result.trace.floor_displacements
        np.testing.assert_allclose(floors, known[:, 1 : n + 1], rtol=0.0, atol=1e-7 * size)
    assert result.impacts == result.uplifts == 0
    assert np.count_nonzero(np.diff(np.sign(theta[1:]))) > 0
    assert abs(result.energy.residual) < 1e-7 * abs(result.energy.input)


def swing(structure: PodiumStructure, start: float, seconds: float) -> TimeHistoryResult:
    """Released from rest at a tilt on a ground that stands still."""
    settings = TimeHistorySettings(free_vibration=seconds, initial_rotation=start)
    return time_history(structure, stillness(0.01), settings, with_fixed_base=False)


def own_period(structure: PodiumStructure) -> float:
    """Of the slowest mode, rolling [s]."""
    rolling = known(modal(structure).rolling)
    assert rolling.own_period is not None
    return rolling.own_period


def measured_period(result: TimeHistoryResult) -> float:
    """Of two passages of the upright position on the same way, by the rates there [s]."""
    theta, rate, time = (getattr(result.trace, k) for k in ("rotation", "rotation_rate", "time"))
    at = np.flatnonzero(np.diff(np.sign(theta)))
    near = np.where(np.abs(theta[at]) < np.abs(theta[at + 1]), at, at + 1)
    passages = time[near] - theta[near] / rate[near]
    return float(passages[-1] - passages[0]) / (0.5 * (len(passages) - 1))


@pytest.mark.evidence("spherical ends", "exact")
@needs_compiled_kernels
def test_small_swings_have_the_period_of_height_and_radius() -> None:
    """With h = 2H, a frame on massless columns is a pendulum of the length h^2/(2 r - h)."""
    h = 2.0 * H
    stiffness = (0.5 * COLUMNS + BEAM) * G * (2.0 * RADIUS - h) / h**2
    known = 2.0 * math.pi * math.sqrt((0.25 * COLUMNS * INERTIA + BEAM) / stiffness)
    frame = on_spheres()
    assert frame.rolling_period == pytest.approx(known, rel=1e-14)
    assert own_period(frame) == pytest.approx(known, rel=1e-12)
    assert measured_period(swing(frame, 1e-5, 4.0 * known)) == pytest.approx(known, rel=1e-9)
    pendulum = 2.0 * math.pi * math.sqrt(h**2 / (2.0 * RADIUS - h) / G)
    assert replace(frame, columns_mass=1.0).rolling_period == pytest.approx(pendulum, rel=1e-5)


@pytest.mark.evidence("spherical ends", "exact")
@needs_compiled_kernels
def test_under_a_building_the_period_is_that_of_its_slowest_mode() -> None:
    """The swing lasts what the eigenvalue says, on both sides; nothing but the building damps."""
    structure = on_spheres(3)
    known = own_period(structure)
    result = swing(structure, 1e-5, 3.1 * known)
    assert measured_period(result) == pytest.approx(known, rel=1e-6)
    assert result.max_rotation == 1e-5
    assert result.trace.rotation.min() == pytest.approx(
        -1e-5, rel=0.01
    )  # released, the building sways


@pytest.mark.evidence("spherical ends", "exact")
@needs_compiled_kernels
def test_a_wide_swing_keeps_its_energy() -> None:
    """Onto the ends of the arcs and back, on both sides: each turn as high as the release."""
    frame = on_spheres()
    result = swing(frame, 0.9 * frame.critical_rotation, 40.0)
    theta = result.trace.rotation
    turns = np.abs(theta[1:-1][np.diff(np.sign(np.diff(theta))) != 0])
    assert len(turns) > 3
    assert turns == pytest.approx(0.9 * frame.critical_rotation, rel=2e-5)  # at samples
    assert abs(result.energy.residual) < 1e-9 * result.trace.energy_stored[0]


@pytest.mark.evidence("spherical ends", "exact")
@needs_compiled_kernels
@pytest.mark.parametrize("holds", [FrictionDamper, RollingResistance])
def test_friction_takes_the_same_from_each_swing_and_then_holds(holds: type[Device]) -> None:
    """Coulomb: each half swing is shorter by 2 F/K; below F/K the storey stays where it is."""
    frame = on_spheres()
    K = frame.weight * (2.0 * RADIUS - 2.0 * H) / (2.0 * H) ** 2
    start, step = 1e-3, 1.3e-4
    F = K * 2.0 * H * step
    device = (
        FrictionDamper(F) if holds is FrictionDamper else RollingResistance(F * H / frame.weight)
    )
    structure = on_spheres(0, device)
    result = swing(structure, start, 40.0)
    # 1, -0.74, 0.48, -0.22 and, before it is upright again, -0.04 of the start
    assert result.trace.rotation[-1] == pytest.approx(start - 8.0 * step, rel=1e-5)
    assert result.events[-1].time == pytest.approx(2.0 * own_period(frame), rel=1e-6)
    assert result.outcome == "stays_tilted"
    assert [event.kind for event in result.events] == ["sticking"]
    # and it holds the storey upright as long as the ground asks for less
    mass = 0.5 * COLUMNS + BEAM
    least = F / mass
    for peak, moves in ((0.99, False), (1.01, True)):
        shaken = demand(structure, waves(2.0, 0.01, peak * least, 1))
        assert (shaken.max_rotation > 0.0) == moves
        assert (shaken.outcome == "at_rest") != moves


@pytest.mark.evidence("spherical ends", "exact")
@needs_compiled_kernels
def test_small_flat_parts_converge_to_it() -> None:
    """In proportion to their width, whatever the impact law."""
    sphere = time_history(on_spheres(2), MOTION, SHORT, with_fixed_base=False).trace.rotation
    errors = []
    for flat in (1e-4, 1e-5):
        near = time_history(on_spheres(2, flat=flat), MOTION, SHORT, with_fixed_base=False)
        errors.append(np.max(np.abs(near.trace.rotation - sphere)) / np.max(np.abs(sphere)))
    assert errors[0] < 0.02
    assert errors[1] / errors[0] == pytest.approx(0.1, rel=0.2)


@needs_compiled_kernels
def test_left_and_right_are_alike_and_lanes_change_nothing() -> None:
    structure, other = on_spheres(2), replace(MOTION, acceleration=-MOTION.acceleration)
    one, mirrored = (
        time_history(structure, m, SHORT, with_fixed_base=False) for m in (MOTION, other)
    )
    assert np.array_equal(one.trace.rotation, -mirrored.trace.rotation)
    requests = [Request(structure, MotionComponents(m), SHORT) for m in (MOTION, other)]
    for found in demands(requests, worth_lanes=1):
        assert found.max_rotation == one.max_rotation
        assert found.max_base_shear == one.max_base_shear
        assert found.base_shear_ratio is None


@needs_compiled_kernels
def test_auto_follows_two_periods_and_a_still_ground_moves_nothing() -> None:
    structure = on_spheres(1)
    result = time_history(structure, MOTION, with_fixed_base=False)
    assert result.duration == pytest.approx(
        MOTION.duration + 2.0 * (structure.rolling_period or 0.0), abs=0.03
    )
    still = demand(structure, ground(np.zeros(50), 0.02))
    assert (still.outcome, still.max_rotation) == ("at_rest", 0.0)


@pytest.mark.evidence("spherical ends", "exact")
def test_restoring_force_and_where_it_ends() -> None:
    """F du_b = W dv_b along the motion of the rotated points; no force and no limit at 0."""
    structure = on_spheres()
    curve = pushover(structure, points=50).curve
    for x, force, displacement, lift in zip(
        curve.rotation, curve.force, curve.displacement, curve.lift, strict=True
    ):
        at, slope, _ = column_centre(x)
        assert displacement == pytest.approx(2.0 * at.real, abs=1e-14)
        assert lift == pytest.approx(2.0 * at.imag, abs=1e-14)
        known = structure.weight * slope.imag / slope.real
        assert force == pytest.approx(known, abs=1e-9 * structure.weight)
    assert curve.force[0] == structure.uplift_force == structure.static_base_shear == 0.0
    assert column_centre(structure.critical_rotation)[1].imag == pytest.approx(0.0, abs=1e-12)
    h = 2.0 * H
    assert structure.initial_stiffness == pytest.approx(
        structure.weight * (2.0 * RADIUS - h) / h**2, rel=1e-14
    )


def test_what_does_not_stand_or_strike_is_refused() -> None:
    with pytest.raises(ValueError, match=r"must be > 0\.5"):
        Bearing(H, 0.0, 0.3, 0.5)
    with pytest.raises(ValueError, match="wedge_slenderness = 0"):
        Bearing(H, 0.0, 0.0, 0.6)
    with pytest.raises(ValueError, match="without an impact"):
        on_spheres(law=ImpactLaw("value", 0.9))
    with pytest.raises(ValueError, match="tendons"):
        on_spheres(0, Tendon(1e4, 1e6))
    assert {
        law: on_spheres(2, law=ImpactLaw(law)).restitution for law in ("rigid", "flexible")
    } == {"rigid": 1.0, "flexible": 1.0}


def test_the_outcome_speaks_of_rolling_where_nothing_uplifts() -> None:
    result = time_history(on_spheres(1), waves(0.3, 0.02, 4.0, seed=3))
    assert outcome_text(result).startswith("survived: rolls and comes back")
    flat = time_history(on_spheres(1, flat=0.02), waves(3.0, 0.02, 4.0, seed=3))
    assert outcome_text(flat).startswith(("survived: uplifts and", "overturned"))
