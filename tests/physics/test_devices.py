"""Devices against closed forms, by the program and, from a case of each, by the second integrator.

Neither takes anything of the other. A slender rigid frame whose arcs have the radius of half its
height is restored by a constant force F_0 and moves like a mass M_e on a line.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest
from oracles.second_integrator import simulate
from paper_structures import (
    FLAT,
    SLENDER,
    Array,
    ground,
    known,
    oracle_devices,
    oracle_system,
    podium,
    stillness,
    waves,
)
from scipy.integrate import quad
from scipy.signal import lsim

from rpscli.analyses.demand import demand
from rpscli.analyses.kernels.systems import steps_a_second
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.constants import STANDARD_GRAVITY
from rpscli.model.devices import FrictionDamper, RollingResistance, Stop, Tendon, ViscousDamper
from rpscli.model.podium import Device, PodiumStructure
from rpscli.model.statics import largest_recentring_friction, recentres
from rpscli.records.ground_motion import GroundMotion

G = STANDARD_GRAVITY
SMALL = 3.0 * SLENDER
"""What the slender theory leaves out: squares of it, and terms of alpha over the rotation."""


class Motion(NamedTuple):
    """Samples, rates |theta'| before impacts, kinds of events if they are told, and precision."""

    time: Array
    rotation: Array
    arrivals: tuple[float, ...]
    events: tuple[tuple[str, float], ...] = ()
    exact: float = 1e-8


def program(
    structure: PodiumStructure, motion: GroundMotion, start: float = 0.0, seconds: float = 0.0
) -> Motion:
    settings = TimeHistorySettings(initial_rotation=start, free_vibration=seconds)
    result = time_history(structure, motion, settings, with_fixed_base=False)
    rates = (e.rotation_rate_before for e in result.events if e.kind == "impact")
    events = tuple((e.kind, e.time) for e in result.events if "_to_" not in e.kind)
    # steps of order 7 leave less of an energy
    trace = result.trace
    return Motion(trace.time, trace.rotation, tuple(map(abs, rates)), events, 1e-9)


def second_integrator(
    structure: PodiumStructure, motion: GroundMotion, start: float = 0.0, seconds: float = 0.0
) -> Motion:
    found = simulate(
        oracle_system(structure),
        motion.acceleration,
        motion.dt,
        free_vibration=seconds,
        rtol=1e-11,
        initial_rotation=start,
        devices=oracle_devices(structure),
    )
    return Motion(found.time, found.theta, found.arrivals)


Follow = Callable[..., Motion]
both_roads = pytest.mark.parametrize("follow", [program, second_integrator])
SHAPES = [(0.15, FLAT), (0.15, 0.5), (0.2, 1.5), (0.1, 0.3)]
of_shapes = pytest.mark.parametrize(
    ("follow", "slope", "rho"),
    [*((program, *shape) for shape in SHAPES), (second_integrator, 0.15, 0.5)],
)


def frame(slope: float, rho: float, *devices: Device) -> PodiumStructure:
    """A rigid frame on four columns with devices."""
    return replace(podium(0, slope, rho), devices=devices, columns=4)


def path(structure: PodiumStructure, rotation: float) -> tuple[float, float, float]:
    """Restoring force F, u_b and v_b."""
    force, u, v = structure.path(np.array([rotation]))
    return float(force[0]), float(u[0]), float(v[0])


Taken = Callable[[float], float]


def device(
    kind: str, bare: PodiumStructure, start: float
) -> tuple[Device, Taken, Taken, list[str]]:
    """What it takes on the way out to a tilt and gives on the way back, and first events."""
    W, (_, far, _) = bare.weight, path(bare, start)
    if kind == "friction":
        force = 0.3 * largest_recentring_friction(bare, start)
        taken: Taken = lambda x: force * path(bare, x)[1]  # noqa: E731
        return FrictionDamper(force), taken, lambda x: -taken(x), []
    if kind == "rolling resistance":
        lever = 0.02 * bare.bearing.half_width
        taken = lambda x: 2.0 * W * lever * x  # noqa: E731
        return RollingResistance(lever), taken, lambda x: -taken(x), []
    if kind == "stop":
        gap, k = 0.4 * far, 5.0 * bare.uplift_force / far
        taken = lambda x: 0.5 * k * max(path(bare, x)[1] - gap, 0.0) ** 2  # noqa: E731
        return Stop(gap, k), taken, taken, ["stop_left"]

    def longer(x: float) -> float:
        return float(bare.bearing.tendon_elongation(np.array([x]))[0])

    share, strength = {"tendon": (0.02, math.inf), "yields": (0.02, 0.09)}.get(kind, (0.01, 0.02))
    P, k, P_y = share * W, 0.1 * W / longer(start), strength * W
    plastic = max(0.0, longer(start) - (P_y - P) / k)
    least = max(0.0, P - k * plastic)

    def stored(x: float) -> float:
        tension = max(0.0, min(P + k * (longer(x) - plastic), P_y))
        return 4.0 * (tension**2 - least**2) / (2.0 * k)

    slack = ["tendon_slack"] if least == 0.0 else []
    return Tendon(P, k, P_y), stored, stored, slack


@pytest.mark.evidence("devices", "exact")
@of_shapes
@pytest.mark.parametrize(
    "kind", ["friction", "rolling resistance", "stop", "tendon", "yields", "goes slack"]
)
def test_energy_of_one_swing(follow: Follow, slope: float, rho: float, kind: str) -> None:
    """At the impact W v_b and what the device gives; e^2 of it carries the next swing."""
    bare = frame(slope, rho)
    start = (0.6 if kind in ("friction", "rolling resistance") else 0.7) * bare.critical_rotation
    held, out, back, events = device(kind, bare, start)
    structure = replace(bare, devices=(held,))
    A = bare.bearing.inertia_ratio + 4.0 * bare.gamma
    inertia = bare.columns_mass * bare.bearing.semi_diagonal**2 * A
    for side in (1.0, -1.0):
        motion = follow(structure, stillness(0.005), side * start, 3.0)
        E = bare.weight * path(bare, start)[2] + back(start)
        assert 0.5 * inertia * motion.arrivals[0] ** 2 == pytest.approx(E, rel=motion.exact)
        if motion.events:
            assert [name for name, _ in motion.events][: len(events) + 1] == [*events, "impact"]
        x = float(np.max(-side * motion.rotation))
        reached = bare.weight * path(bare, x)[2] + out(x)
        # samples are 5 ms apart
        assert reached == pytest.approx(structure.restitution**2 * E, rel=1e-3)


RAMP = 1.0
"""Growth of the ground's acceleration [m/s3]."""


def ramp(sign: float = 1.0, seconds: float = 8.0) -> GroundMotion:
    return ground(sign * RAMP * np.arange(0.0, seconds, 0.01), 0.01)


@pytest.mark.evidence("devices", "exact")
@of_shapes
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_uplift_is_delayed_by_what_devices_hold(
    follow: Follow, slope: float, rho: float, sign: float
) -> None:
    bare = frame(slope, rho)
    W, alpha, gamma = bare.weight, bare.bearing.alpha, bare.gamma
    F_d, P, f = 0.03 * W, 0.01 * W, 0.01 * bare.bearing.half_width
    structure = replace(bare, devices=(FrictionDamper(F_d), Tendon(P, W), RollingResistance(f)))
    held = F_d + 4.0 * P * math.tan(alpha)
    held += 2.0 * W * f / (2.0 * bare.bearing.semi_diagonal * math.cos(alpha))
    limit = G * math.tan(alpha) + 2.0 * held / (bare.columns_mass * (1.0 + 2.0 * gamma))
    motion = follow(structure, ramp(sign, limit / RAMP + 0.1))
    lifted = int(np.flatnonzero(motion.rotation)[0])
    assert motion.time[lifted - 1] <= limit / RAMP < motion.time[lifted]
    if motion.events:
        kind, time = motion.events[0]
        assert kind == "uplift"
        assert time == pytest.approx(limit / RAMP, rel=1e-12)


@pytest.mark.evidence("devices", "exact")
@pytest.mark.parametrize(("slope", "rho"), SHAPES)
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_friction_sticks_and_slides_at_its_limit(slope: float, rho: float, sign: float) -> None:
    bare = frame(slope, rho)
    start = 0.5 * bare.critical_rotation
    force, _, _ = path(bare, start)
    F_d = 2.0 * force
    motion = program(replace(bare, devices=(FrictionDamper(F_d),)), ramp(sign), start)
    # the ground's acceleration to the left tilts further to the right
    limit = F_d + force if sign < 0.0 else F_d - force
    mass = 0.5 * bare.columns_mass + bare.cap_beam_mass
    assert [kind for kind, _ in motion.events[:2]] == ["sticking", "sliding"]
    assert motion.events[1][1] == pytest.approx(limit / mass / RAMP, rel=1e-10)


@pytest.mark.evidence("devices", "exact")
@both_roads
def test_a_stuck_storey_carries_a_building_on_a_fixed_base_until_its_limit(follow: Follow) -> None:
    bare, start, dt = podium(2, 0.15, 0.5), 0.05, 0.01
    restoring, _, _ = path(bare, start)
    above, force = known(bare.superstructure), 1.5 * restoring
    ag = 0.9 * np.sin(2.0 * math.pi * 3.0 * dt * np.arange(150)) * np.linspace(0.0, 1.0, 150)
    motion = follow(replace(bare, devices=(FrictionDamper(force),)), ground(ag, dt), start)
    K, C, M = above.stiffness_matrix, above.damping_matrix, above.masses[:, None]
    upper, lower = np.hstack([np.zeros((2, 2)), np.eye(2)]), -np.hstack([K / M, C / M])
    load = np.r_[np.zeros(2), -np.ones(2)][:, None]
    linear = (np.vstack([upper, lower]), load, np.eye(4), np.zeros((4, 1)))
    _, states, _ = lsim(linear, ag, dt * np.arange(150))
    push = states @ np.r_[K.sum(axis=0), C.sum(axis=0)]
    push -= (0.5 * bare.columns_mass + bare.cap_beam_mass) * ag
    freed = np.flatnonzero((push < restoring - force) | (push > restoring + force))
    assert 20 < freed[0] < 149
    assert np.all(motion.rotation[: freed[0]] == start)
    assert motion.rotation[-1] < start  # the way back is the shorter one


@pytest.mark.evidence("devices", "exact")
@both_roads
@pytest.mark.parametrize(("factor", "stays"), [(1.001, True), (0.999, False)])
def test_more_friction_than_weight_brings_back_stays_tilted(
    follow: Follow, factor: float, stays: bool
) -> None:
    bare = frame(0.15, 0.5)
    start = 0.5 * bare.critical_rotation
    friction = FrictionDamper(factor * largest_recentring_friction(bare, start))
    structure = replace(bare, devices=(friction,))
    assert recentres(structure, start) is not stays
    motion = follow(structure, stillness(0.05), start, 1.0)
    assert np.all(motion.rotation == start) == stays
    if follow is program:
        settings = TimeHistorySettings(initial_rotation=start, free_vibration=120.0)
        result = time_history(structure, stillness(0.05), settings)
        assert (result.residual_rotation > 0.0) is result.stays_tilted is stays
        assert result.outcome == ("stays_tilted" if stays else "survived")
        assert not result.warnings


@pytest.mark.evidence("devices", "exact")
@both_roads
def test_tendons_make_the_frame_swing_with_their_frequency(follow: Follow) -> None:
    bare = frame(SLENDER, FLAT)
    R, W, alpha = bare.bearing.semi_diagonal, bare.weight, bare.bearing.alpha
    K = 40.0 * W / (2.0 * R)  # of all tendons against u_b: N k_t (B/R)^2
    P = 0.3 * W / 4.0
    structure = replace(bare, devices=(Tendon(P, K / (4.0 * alpha**2)),))
    M_e = 0.25 * bare.columns_mass * (bare.bearing.inertia_ratio + 4.0 * bare.gamma)
    left = K - W / (2.0 * R)
    omega, centre = math.sqrt(left / M_e), (W + 4.0 * P) * alpha / left / (2.0 * R)
    start = 0.5 * alpha
    quarter = math.acos(centre / (start + centre)) / omega
    motion = follow(structure, stillness(quarter / 40.0), start, quarter)
    swing = (start + centre) * np.cos(omega * motion.time[:40]) - centre
    assert motion.rotation[:40] == pytest.approx(swing, abs=SMALL * start)


@pytest.mark.evidence("devices", "exact")
@both_roads
@pytest.mark.parametrize("exponent", [0.2, 0.5, 1.0, 1.5, 2.0])
def test_a_damper_falls_towards_its_final_velocity(follow: Follow, exponent: float) -> None:
    """Time and way to 0.9 of it: integrals of M_e dv and M_e v dv over F_0 - c v^a."""
    bare = frame(SLENDER, 0.5)
    F_0, final = bare.uplift_force, 1e-3
    M_e = 0.25 * bare.columns_mass * (bare.bearing.inertia_ratio + 4.0 * bare.gamma)
    c = F_0 / final**exponent

    def whole(power: int) -> float:
        """Over v = s^2 final, which takes the kink of weak powers away."""
        return quad(
            lambda s: 2.0 * s * (s * s * final) ** power * final * M_e
            / (F_0 * (1.0 - s ** (2.0 * exponent))),
            0.0, math.sqrt(0.9), epsrel=1e-12,
        )[0]  # fmt: skip

    time, way = whole(0), whole(1)
    structure = replace(bare, devices=(ViscousDamper(c, exponent),))
    start = 0.5 * bare.bearing.beta
    motion = follow(structure, stillness(time / 50.0), start, time)
    _, far, _ = path(bare, start)
    assert way < 0.8 * far
    at = int(np.argmin(np.abs(motion.time - time)))
    assert far - path(bare, float(motion.rotation[at]))[1] == pytest.approx(way, rel=SMALL)


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
