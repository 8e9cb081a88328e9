"""Columns without a flat part: they roll through the upright position, without impact."""

import math
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from conformance import conforms
from oracles.second_integrator import simulate
from oracles.storey_lagrangian import StoreyLagrangian
from paper_structures import (
    building,
    ground,
    let_go,
    needs_compiled_kernels,
    oracle_devices,
    oracle_system,
    waves,
)

from rpscli.analyses.demand import demand
from rpscli.analyses.pushover import pushover
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.bearing import Bearing
from rpscli.model.devices import (
    FrictionDamper,
    RollingResistance,
    Stop,
    Tendon,
    ViscousDamper,
)
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import PodiumStructure
from rpscli.report.timehistory import outcome_text

H, RADIUS, COLUMNS, BEAM, G = 1.5, 2.0, 2e4, 2e5, 9.80665


def on_spheres(storeys=0, *devices, flat=0.0, law=None):
    """Four columns 3 m high with ends of 2 m radius, 0.9 m wide."""
    bearing = Bearing(math.hypot(H, H * flat), flat, 0.3, RADIUS / (2.0 * H), 4.0 / 3.0)
    above = building(storeys) if storeys else None
    return PodiumStructure(
        bearing, COLUMNS, BEAM, above, law or ImpactLaw(), G, tuple(devices), columns=4
    )


def swings(quantity, expected, found, relative):
    conforms(
        "spherical ends", quantity, expected, found, relative * abs(expected),
        "closed form", "pendulum of the length h^2/(2 r - h), Coulomb's decay",
    )  # fmt: skip


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
    ids=[
        "frame",
        "frame, rocking",
        "storeys",
        "storeys, rocking",
        "damper",
        "stop",
        "no gap",
    ],
)
def test_motion_is_that_of_the_second_integrator(structure, scale, up):
    """Released from a small tilt: from rest upright it lifts without a force to overcome."""
    record, rising = waves(4.0, 0.02, 5.0 * scale, 3), waves(4.0, 0.02, 2.0, 4)
    settings = TimeHistorySettings(free_vibration=0.0, initial_rotation=1e-3)
    vertical = rising if up else None
    result = time_history(
        structure, record, settings, vertical=vertical, with_fixed_base=False
    )
    other = simulate(
        oracle_system(structure),
        record.acceleration,
        record.dt,
        av=rising.acceleration if up else None,
        free_vibration=0.0,
        initial_rotation=1e-3,
        rtol=1e-12,
        devices=oracle_devices(structure),
    )
    size = np.max(np.abs(other.theta))
    assert result.outcome == "survived"
    assert (size > structure.bearing.beta) == (scale == 4.0)
    histories = [("tilts [rad]", other.theta, result.trace.rotation)]
    if structure.storeys:
        histories.append(("drifts [m]", other.drifts, result.trace.drifts))
    for name, expected, found in histories:
        conforms(
            "spherical ends", f"{name} of a history", expected, found, 1e-7 * size,
            "independent program", "second integrator, DOP853 in tilt and drifts",
        )  # fmt: skip
    assert result.impacts == result.uplifts == 0
    assert np.count_nonzero(np.diff(np.sign(result.trace.rotation))) > 0
    assert abs(result.energy.residual) < 1e-7 * abs(result.energy.input)


@pytest.mark.evidence("spherical ends", "exact")
@needs_compiled_kernels
def test_small_swings_have_the_period_of_height_and_radius():
    """With h = 2H, a frame on massless columns is a pendulum of the length h^2/(2 r - h)."""
    h, frame = 2.0 * H, on_spheres()
    stiffness = (0.5 * COLUMNS + BEAM) * G * (2.0 * RADIUS - h) / h**2
    known = 2.0 * math.pi * math.sqrt((COLUMNS / 3.0 + BEAM) / stiffness)
    swings("period of a frame [s]", known, frame.rolling_period, 1e-14)
    back = let_go(frame, 1e-5, 2.0 * known).trace
    assert np.interp(known, back.time, back.rotation) == pytest.approx(1e-5, rel=1e-5)
    pendulum = 2.0 * math.pi * math.sqrt(h**2 / (2.0 * RADIUS - h) / G)
    period = replace(frame, columns_mass=1.0).rolling_period
    swings("period on massless columns [s]", pendulum, period, 1e-5)


@pytest.mark.evidence("spherical ends", "exact")
@needs_compiled_kernels
@pytest.mark.parametrize("holds", [FrictionDamper, RollingResistance])
def test_friction_takes_the_same_from_each_swing_and_then_holds(holds):
    """Coulomb: each half swing is shorter by 2 F/K; below F/K the storey stays where it is."""
    frame = on_spheres()
    K = frame.weight * (2.0 * RADIUS - 2.0 * H) / (2.0 * H) ** 2
    start, step = 1e-3, 1.3e-4
    F = K * 2.0 * H * step
    device = (
        FrictionDamper(F)
        if holds is FrictionDamper
        else RollingResistance(F * H / frame.weight)
    )
    structure = on_spheres(0, device)
    result = let_go(structure, start, 40.0)
    # 1, -0.74, 0.48, -0.22 and, before it is upright again, -0.04 of the start
    rest = start - 8.0 * step
    swings(
        "tilt at rest after four half swings [rad]", rest, result.trace.rotation[-1], 1e-5
    )
    four_halves = 2.0 * (frame.rolling_period or 0.0)
    swings("time of rest [s]", four_halves, result.events[-1].time, 1e-6)
    assert result.outcome == "stays_tilted"
    assert [event.kind for event in result.events] == ["sticking"]
    # and it holds the podium upright as long as the ground asks for less, to either side
    least = F / (0.5 * COLUMNS + BEAM)
    for peak, beside in product((0.99, 1.01, -0.99, -1.01), ((), (Stop(0.0, 1e5),))):
        pushed = waves(2.0, 0.01, peak * least, 1)
        shaken = demand(on_spheres(0, device, *beside), pushed)
        moves = abs(peak) > 1.0
        assert (shaken.max_rotation > 0.0) == moves
        assert shaken.outcome in ({"survived", "stays_tilted"} if moves else {"at_rest"})


@needs_compiled_kernels
def test_auto_follows_two_periods_and_a_still_ground_moves_nothing():
    structure, motion = on_spheres(1), waves(4.0, 0.02, 5.0, 3)
    result = time_history(structure, motion, with_fixed_base=False)
    followed = motion.duration + 2.0 * (structure.rolling_period or 0.0)
    assert result.duration == pytest.approx(followed, abs=0.03)
    still = demand(structure, ground(np.zeros(50), 0.02))
    assert (still.outcome, still.max_rotation) == ("at_rest", 0.0)


@pytest.mark.evidence("spherical ends", "exact")
def test_restoring_force_and_where_it_ends():
    """F du_b = W dv_b along the motion of the rotated points; no force and no limit at 0."""
    structure = on_spheres()
    storey = StoreyLagrangian(oracle_system(structure))
    curve = pushover(structure, points=50).curve
    for x, force, displacement in zip(
        curve.rotation, curve.force, curve.displacement, strict=True
    ):
        at, slope, _ = storey.cap_beam(x, rolling=x < storey.beta)
        assert displacement == pytest.approx(at.real, abs=1e-14)
        known = structure.weight * slope.imag / slope.real
        assert force == pytest.approx(known, abs=1e-9 * structure.weight)
    assert curve.force[0] == structure.uplift_force == structure.static_base_shear == 0.0
    assert structure.critical_rotation == pytest.approx(
        storey.critical_rotation, abs=1e-12
    )
    h = 2.0 * H
    stiffness = structure.weight * (2.0 * RADIUS - h) / h**2
    swings("stiffness [N/m]", stiffness, structure.initial_stiffness, 1e-14)


def test_what_does_not_stand_or_strike_is_refused():
    with pytest.raises(ValueError, match=r"must be > 0\.5"):
        Bearing(H, 0.0, 0.3, 0.5)
    with pytest.raises(ValueError, match="wedge_slenderness = 0"):
        Bearing(H, 0.0, 0.0, 0.6)
    with pytest.raises(ValueError, match="without an impact"):
        on_spheres(law=ImpactLaw("value", 0.9))
    with pytest.raises(ValueError, match="tendons"):
        on_spheres(0, Tendon(1e4, 1e6))
    rigid, flexible = (on_spheres(2, law=ImpactLaw(law)) for law in ("rigid", "flexible"))
    assert rigid.restitution == flexible.restitution == 1.0


def test_the_outcome_speaks_of_rolling_where_nothing_uplifts():
    result = time_history(on_spheres(1), waves(0.3, 0.02, 4.0, seed=3))
    assert outcome_text(result).startswith("survived: rolls and comes back")
    flat = time_history(on_spheres(1, flat=0.02), waves(3.0, 0.02, 4.0, seed=3))
    assert outcome_text(flat).startswith(("survived: uplifts and", "overturned"))
