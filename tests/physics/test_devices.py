"""Devices against closed forms: energy of one swing, free motion, uplift, sticking."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from paper_structures import FLAT, SLENDER, Array, ground, podium, stillness, waves

from rpscli.analyses.demand import demand
from rpscli.analyses.kernels.systems import linear_speed, steps_a_second
from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.constants import STANDARD_GRAVITY
from rpscli.model.devices import (
    FrictionDamper,
    RollingResistance,
    Stop,
    Tendon,
    ViscousDamper,
)
from rpscli.model.podium import Device, PodiumStructure
from rpscli.model.statics import (
    largest_recentring_friction,
    recentres,
    restoring_force,
)

G = STANDARD_GRAVITY
EXACT = 1e-9
"""Steps of order 7 leave less of an energy."""

SHAPES = [(0.15, FLAT), (0.15, 0.5), (0.2, 1.5), (0.1, 0.3)]
shapes = pytest.mark.parametrize(("slope", "rho"), SHAPES)


def frame(slope: float, rho: float, *devices: Device) -> PodiumStructure:
    """A rigid frame on four columns with devices."""
    return replace(podium(0, slope, rho), devices=devices, columns=4)


def released(
    structure: PodiumStructure, rotation: float, seconds: float = 3.0
) -> TimeHistoryResult:
    """Let go at rest at a tilt."""
    settings = TimeHistorySettings(initial_rotation=rotation, free_vibration=seconds)
    return time_history(structure, stillness(0.005), settings)


def energy_of_impact(result: TimeHistoryResult) -> float:
    """Kinetic energy with which the first impact is reached [J]."""
    s = result.structure
    rate = next(e.rotation_rate_before for e in result.events if e.kind == "impact")
    A = s.bearing.inertia_ratio - 1.0 + (1.0 + 4.0 * s.gamma)
    A += 4.0 * s.gamma * s.eta * math.sin(s.bearing.alpha) ** 2
    return 0.5 * s.columns_mass * s.bearing.semi_diagonal**2 * A * rate**2


def changes(result: TimeHistoryResult) -> list[str]:
    """Kinds of events, those between rolling and rocking left out."""
    return [event.kind for event in result.events if "_to_" not in event.kind]


def path(structure: PodiumStructure, rotation: float) -> tuple[float, float, float]:
    """Restoring force F, u_b and v_b."""
    force, u, v = structure.path(np.array([rotation]))
    return float(force[0]), float(u[0]), float(v[0])


def part_of_weight(structure: PodiumStructure, part: float) -> float:
    return part * structure.weight


@pytest.mark.evidence("devices", "exact")
@shapes
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_friction_costs_its_force_times_the_path(slope: float, rho: float, side: float) -> None:
    bare = frame(slope, rho)
    start = 0.6 * bare.critical_rotation
    _, u, v = path(bare, start)
    F_d = 0.3 * largest_recentring_friction(bare, start)
    result = released(replace(bare, devices=(FrictionDamper(F_d),)), side * start)
    assert energy_of_impact(result) == pytest.approx(bare.weight * v - F_d * u, rel=EXACT)


@pytest.mark.evidence("devices", "exact")
@shapes
def test_rolling_resistance_costs_its_moment_times_the_tilt(slope: float, rho: float) -> None:
    bare = frame(slope, rho)
    start = 0.6 * bare.critical_rotation
    _, _, v = path(bare, start)
    f = 0.02 * bare.bearing.half_width
    result = released(replace(bare, devices=(RollingResistance(f),)), start)
    left = bare.weight * (v - 2.0 * f * start)
    assert energy_of_impact(result) == pytest.approx(left, rel=EXACT)


@pytest.mark.evidence("devices", "exact")
@shapes
def test_a_stop_gives_back_what_it_took(slope: float, rho: float) -> None:
    bare = frame(slope, rho)
    start = 0.7 * bare.critical_rotation
    _, u, v = path(bare, start)
    k = 5.0 * bare.uplift_force / u
    structure = replace(bare, devices=(Stop(0.4 * u, k),))
    result = released(structure, start)
    E = bare.weight * v + 0.5 * k * (0.6 * u) ** 2
    assert energy_of_impact(result) == pytest.approx(E, rel=EXACT)
    assert changes(result)[:2] == ["stop_left", "impact"]
    # beyond the impact: 1/2 k (u_b - d)^2 + W v_b = e^2 E at the highest rotation
    peak = float(np.max(-result.trace.rotation))
    kept = structure.restitution**2 * E
    _, u1, v1 = path(bare, peak)
    reached = bare.weight * v1 + 0.5 * k * max(u1 - 0.4 * u, 0.0) ** 2
    assert reached == pytest.approx(kept, rel=1e-3)  # samples are 5 ms apart
    assert result.devices[0].force <= k * 0.6 * u * (1.0 + EXACT)


@pytest.mark.evidence("devices", "exact")
@shapes
def test_a_tendon_gives_back_what_it_took(slope: float, rho: float) -> None:
    bare = frame(slope, rho)
    start = 0.7 * bare.critical_rotation
    _, _, v = path(bare, start)
    e = float(bare.bearing.tendon_elongation(np.array([start]))[0])
    P, k = 0.02 * bare.weight, 0.1 * bare.weight / e
    result = released(replace(bare, devices=(Tendon(P, k),)), start)
    E = bare.weight * v + 4.0 * ((P + k * e) ** 2 - P**2) / (2.0 * k)
    assert energy_of_impact(result) == pytest.approx(E, rel=EXACT)
    assert result.lost_prestress == 0.0


@pytest.mark.evidence("devices", "exact")
def test_the_elongation_of_flat_ends() -> None:
    bearing = podium(0, 0.2, FLAT).bearing
    x = np.array([0.0, 1e-9, 1e-3, 0.2, 0.7])
    expected = 4.0 * bearing.half_width * np.sin(0.5 * x)
    assert bearing.tendon_elongation(x) == pytest.approx(expected, rel=1e-12)
    assert bearing.tendon_lever(x) == pytest.approx(2.0 * bearing.half_width * np.cos(0.5 * x))


@pytest.mark.evidence("devices", "exact")
@shapes
def test_the_lever_of_a_tendon_is_the_slope_of_its_elongation(slope: float, rho: float) -> None:
    bearing = podium(0, slope, rho).bearing
    x, h = np.linspace(0.01, 0.6, 40), 1e-5
    rise = bearing.tendon_elongation(x + h) - bearing.tendon_elongation(x - h)
    assert bearing.tendon_lever(x) == pytest.approx(rise / (2.0 * h), rel=1e-7)


@shapes
def test_a_tendon_that_yielded_is_slack_before_it_closes(slope: float, rho: float) -> None:
    bare = frame(slope, rho)
    start = 0.7 * bare.critical_rotation
    _, _, v = path(bare, start)
    e = float(bare.bearing.tendon_elongation(np.array([start]))[0])
    P, P_y = 0.01 * bare.weight, 0.02 * bare.weight
    k = 0.2 * bare.weight / e
    result = released(replace(bare, devices=(Tendon(P, k, P_y),)), start)
    assert changes(result)[:2] == ["tendon_slack", "impact"]
    E = bare.weight * v + 4.0 * P_y**2 / (2.0 * k)
    assert energy_of_impact(result) == pytest.approx(E, rel=EXACT)
    assert result.lost_prestress == 1.0


def sliding_time(result: TimeHistoryResult, kind: str) -> float:
    return next(event.time for event in result.events if event.kind == kind)


RAMP = 1.0
"""Growth of the ground's acceleration [m/s3]."""


def ramp(sign: float = 1.0) -> Array:
    return sign * RAMP * np.arange(0.0, 8.0, 0.01)


@pytest.mark.evidence("devices", "exact")
@shapes
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_uplift_is_delayed_by_what_devices_hold(slope: float, rho: float, sign: float) -> None:
    bare = frame(slope, rho)
    W, alpha, gamma = bare.weight, bare.bearing.alpha, bare.gamma
    F_d, P, f = 0.03 * W, 0.01 * W, 0.01 * bare.bearing.half_width
    structure = replace(bare, devices=(FrictionDamper(F_d), Tendon(P, W), RollingResistance(f)))
    settings = TimeHistorySettings(free_vibration=0.0)
    result = time_history(structure, ground(ramp(sign), 0.01), settings)
    held = F_d + 4.0 * P * math.tan(alpha)
    held += 2.0 * W * f / (2.0 * bare.bearing.semi_diagonal * math.cos(alpha))
    limit = G * math.tan(alpha) + 2.0 * held / (bare.columns_mass * (1.0 + 2.0 * gamma))
    assert sliding_time(result, "uplift") == pytest.approx(limit / RAMP, rel=1e-12)


@pytest.mark.evidence("devices", "exact")
@shapes
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_friction_sticks_and_slides_at_its_limit(slope: float, rho: float, sign: float) -> None:
    bare = frame(slope, rho)
    start = 0.5 * bare.critical_rotation
    force, _, _ = path(bare, start)
    F_d = 2.0 * force
    structure = replace(bare, devices=(FrictionDamper(F_d),))
    settings = TimeHistorySettings(initial_rotation=start, free_vibration=0.0)
    result = time_history(structure, ground(ramp(sign), 0.01), settings)
    # the ground's acceleration to the left tilts further to the right
    limit = F_d + force if sign < 0.0 else F_d - force
    mass = 0.5 * bare.columns_mass + bare.cap_beam_mass
    assert [event.kind for event in result.events[:2]] == ["sticking", "sliding"]
    assert sliding_time(result, "sliding") == pytest.approx(limit / mass / RAMP, rel=1e-10)


def test_more_friction_than_weight_brings_back_stays_tilted() -> None:
    bare = frame(0.15, 0.5)
    start = 0.5 * bare.critical_rotation
    most = largest_recentring_friction(bare, start)
    for factor, stays in ((1.001, True), (0.999, False)):
        structure = replace(bare, devices=(FrictionDamper(factor * most),))
        assert recentres(structure, start) is not stays
        result = released(structure, start, 120.0 if not stays else 1.0)
        assert (result.residual_rotation > 0.0) is result.stays_tilted is stays
        assert (result.residual_rotation == start) is stays
        assert result.outcome == ("stays_tilted" if stays else "survived")
        assert not result.warnings


@pytest.mark.evidence("devices", "exact")
def test_restoring_force_with_devices() -> None:
    x = np.array([1e-6, 0.02, 0.1])
    bare = frame(0.15, 0.5)
    F, u, _ = bare.path(x)
    assert restoring_force(bare, x) == pytest.approx(F)
    stopped = replace(bare, devices=(Stop(0.1, 1e6),))
    assert restoring_force(stopped, x) == pytest.approx(F + 1e6 * np.maximum(u - 0.1, 0.0))
    tied = replace(bare, devices=(Tendon(1e5, 1e7),))
    assert restoring_force(tied, x)[0] == pytest.approx(F[0] + 4e5 * 0.15, rel=1e-3)
    assert largest_recentring_friction(bare, 0.1) == pytest.approx(F.min(), rel=1e-3)


SMALL = 3.0 * SLENDER
"""What the slender theory leaves out: squares of it, and terms of alpha over the rotation."""


def slender(*devices: Device) -> tuple[PodiumStructure, float, float]:
    """A frame of constant restoring force F_0 and mass M_e against u_b."""
    structure = frame(SLENDER, 0.5, *devices)
    A = structure.bearing.inertia_ratio + 4.0 * structure.gamma
    return structure, structure.uplift_force, 0.25 * structure.columns_mass * A


def falling(structure: PodiumStructure) -> tuple[Array, Array]:
    """Time and |u_b| within 2 s until the first impact, after a release within the arc."""
    settings = TimeHistorySettings(
        initial_rotation=0.5 * structure.bearing.beta, free_vibration=2.0
    )
    result = time_history(structure, stillness(0.01), settings)
    end = next((event.time for event in result.events if event.kind == "impact"), math.inf)
    kept = result.trace.time < end
    return result.trace.time[kept], result.trace.cap_beam_displacement[kept]


@pytest.mark.evidence("devices", "exact")
def test_tendons_make_the_frame_swing_with_their_frequency() -> None:
    bare = frame(SLENDER, FLAT)
    R, W, alpha = bare.bearing.semi_diagonal, bare.weight, bare.bearing.alpha
    K = 40.0 * W / (2.0 * R)  # of all tendons against u_b: N k_t (B/R)^2
    P = 0.3 * W / 4.0
    structure = replace(bare, devices=(Tendon(P, K / (4.0 * alpha**2)),))
    M_e = 0.25 * bare.columns_mass * (bare.bearing.inertia_ratio + 4.0 * bare.gamma)
    left = K - W / (2.0 * R)
    omega, centre = math.sqrt(left / M_e), (W + 4.0 * P) * alpha / left
    start = 0.5 * alpha
    settings = TimeHistorySettings(initial_rotation=start, free_vibration=2.0)
    result = time_history(structure, stillness(0.01), settings)
    impact = next(event.time for event in result.events if event.kind == "impact")
    swing = math.acos(centre / (2.0 * R * start + centre)) / omega
    assert impact == pytest.approx(swing, rel=SMALL)


@pytest.mark.evidence("devices", "exact")
@pytest.mark.parametrize("coefficient", [2e3, 2e5, 5e6])
def test_a_linear_damper_falls_exponentially(coefficient: float) -> None:
    structure, F_0, M_e = slender(ViscousDamper(coefficient))
    t, u = falling(structure)
    rate = coefficient / M_e
    fallen = F_0 / coefficient * (t + np.expm1(-rate * t) / rate)
    assert u[0] - u == pytest.approx(fallen, abs=SMALL * u[0])


@pytest.mark.evidence("devices", "exact")
def test_a_quadratic_damper_reaches_its_final_velocity() -> None:
    c = 4e8
    structure, F_0, M_e = slender(ViscousDamper(c, 2.0))
    t, u = falling(structure)
    final, scale = math.sqrt(F_0 / c), math.sqrt(F_0 * c) / M_e
    fallen = final / scale * np.log(np.cosh(scale * t))
    assert u[0] - u == pytest.approx(fallen, abs=SMALL * u[0])
    assert np.max(scale * t) > 3.0


@pytest.mark.parametrize(("exponent", "share"), [(0.2, 1.0), (0.3, 2.0)])
def test_a_damper_that_holds_does_not_try_every_step_anew(exponent: float, share: float) -> None:
    """Explicit steps of order 7 are stable to 3.9 over the decay rate; each is tried once or so."""
    bare = podium(1)
    structure = replace(bare, devices=(ViscousDamper(share * bare.weight, exponent),))
    record = waves(2.0, 0.01, 4.0 * bare.uplift_acceleration, seed=2)
    settings = TimeHistorySettings(free_vibration=1.0)
    found = demand(structure, record, settings)
    # it creeps slower than the power is linear up to for half of the time
    assert 0.02 < found.history["steps"] / (3.0 * steps_a_second(structure)) < 0.1
    shorter = demand(structure, record, replace(settings, accuracy=2.0))
    # a creep of 2e-4 rad, in which the speed up to which the power is linear, halved, is felt
    assert found.max_rotation == pytest.approx(shorter.max_rotation, rel=3e-5)


@pytest.mark.parametrize(("exponent", "share"), [(0.2, 1.0), (0.5, 0.3), (0.8, 1e-4)])
def test_where_a_power_is_linear_goes_with_the_columns_and_accuracy(
    exponent: float, share: float
) -> None:
    """Lengths 64 times and times 8 times as large make velocities 8 times as large."""

    def speed(R: float, accuracy: float) -> float:
        bare = podium(0, R=R)
        c = share * bare.weight / math.sqrt(bare.gravity * R) ** exponent
        of = replace(bare, devices=(ViscousDamper(c, exponent),))
        return linear_speed(of, accuracy)

    assert speed(64.0, 1.0) == pytest.approx(8.0 * speed(1.0, 1.0), rel=1e-12)
    assert speed(1.0, 4.0) == pytest.approx(speed(1.0, 1.0) / 4.0, rel=1e-12)


@pytest.mark.evidence("devices", "exact")
@pytest.mark.parametrize("exponent", [0.2, 0.5])
def test_a_weak_power_creeps_at_its_final_velocity(exponent: float) -> None:
    structure, F_0, _ = slender()
    c = 3.0 * F_0 / 0.002**exponent
    structure = replace(structure, devices=(ViscousDamper(c, exponent),))
    t, u = falling(structure)
    late = t > 0.2
    rate = np.polyfit(t[late], u[late], 1)[0]
    assert -rate == pytest.approx((F_0 / c) ** (1.0 / exponent), rel=5e-3)


ALL: Sequence[Device] = (
    ViscousDamper(2e5, 0.5),
    FrictionDamper(2e4),
    Stop(0.05, 2e7, 2e5),
    Tendon(2e4, 4e6, 5e4),
    RollingResistance(1e-3),
)


@pytest.mark.parametrize("devices", [*((d,) for d in ALL), tuple(ALL)])
def test_a_mirrored_ground_mirrors_the_motion(devices: tuple[Device, ...]) -> None:
    rng = np.random.default_rng(3)
    shaking = 5.0 * np.convolve(rng.normal(size=150), np.ones(6) / 6.0)
    structure = replace(podium(2), devices=devices, columns=4)
    settings = TimeHistorySettings(free_vibration=0.5)
    one, two = (
        time_history(structure, ground(sign * shaking, 0.02), settings) for sign in (1.0, -1.0)
    )
    assert one.uplifts > 0
    assert one.trace.rotation.tolist() == (-two.trace.rotation).tolist()
    assert one.history.device_energy.tolist() == two.history.device_energy.tolist()
    tendon = np.array([isinstance(device, Tendon) for device in devices])
    sign = np.where(tendon, 1.0, -1.0)
    assert one.trace.devices.force.tolist() == (sign * two.trace.devices.force + 0.0).tolist()
