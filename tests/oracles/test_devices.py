"""The devices of the second integrator against closed forms.

A slender rigid frame whose arcs have the radius of half its height is restored by a constant force
F_0 = W tan(alpha) and moves like a mass M_e on a line, in the cap beam's displacement u: what is
left out is of the order of alpha^2 = 1e-6.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Literal

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.signal import lsim

from .crossings import Array
from .devices import (
    Equipment,
    Friction,
    OracleDevice,
    RollingResistance,
    Stop,
    Tendon,
    Viscous,
)
from .full_contact import LinearGround
from .locking import drifts_at_the_end
from .reference_systems import GRAVITY, podium
from .second_integrator import OracleResult, _Simulation, simulate
from .storey_lagrangian import Contact, OracleSystem, StoreyLagrangian

pytestmark = pytest.mark.evidence("devices", "exact")

SLOPE = 1e-3
LEFT_OUT = 1e-5  # a few alpha^2, relative


def frame(rho: float = 0.5, restitution: float = 1.0) -> OracleSystem:
    """A slender rigid frame that rolls however far it tilts here, or has flat ends."""
    none = np.zeros(0)
    wedge = 0.5 if rho else SLOPE
    matrix = np.zeros((0, 0))
    return OracleSystem(
        1.5, SLOPE, wedge, rho, 4 / 3, 0.1, 1.0, none, none, matrix, restitution=restitution
    )


MOTION = StoreyLagrangian(frame())
SPAN = 2.0 * MOTION.half_height  # du_b/dtheta of a slender frame with rho = 1/2
F_0 = MOTION.lifted_mass * GRAVITY * SLOPE
M_E = float(MOTION.mass_matrix(complex(SPAN))[0, 0]) / SPAN**2


def released(
    displacement: float, until: float, *devices: OracleDevice, rho: float = 0.5, samples: int = 50
) -> OracleResult:
    """Free motion from a displacement of the cap beam."""
    return simulate(
        frame(rho),
        np.zeros(1),
        until / samples,
        free_vibration=until,
        initial_rotation=displacement / SPAN,
        devices=devices,
    )


class Throw(_Simulation):
    """A frame that leaves its upright position with a velocity of the cap beam, and comes back."""

    def __init__(self, velocity: float, *devices: OracleDevice) -> None:
        super().__init__(frame(), recontact=1e-6, overturning=2.0, rtol=1e-11, devices=devices)
        self.y[1] = velocity / SPAN
        self.contact = Contact(1, rolling=True)
        self.arrival = self.y

    def impact(self, contact: Contact, ground: LinearGround) -> None:
        self.arrival = self.y.copy()
        super().impact(contact, ground)

    def until_impact(self, dt: float) -> Throw:
        while self.impacts == 0:
            self.advance(LinearGround(0.0, 0.0, 0.0, 0.0), dt)
        return self

    @property
    def back(self) -> float:
        """Velocity of the cap beam just before the impact."""
        return SPAN * abs(float(self.arrival[1]))


def test_linear_damper() -> None:
    c, start, until = 0.05, 0.003, 0.7
    result = released(start, until, Viscous(c))
    t = result.time
    path = start + F_0 * M_E / c**2 * (1.0 - np.exp(-c * t / M_E)) - F_0 * t / c
    assert result.impacts == 0
    assert path[-1] < 0.7 * start
    assert SPAN * result.theta == pytest.approx(path, abs=LEFT_OUT * start)


@pytest.mark.parametrize("exponent", [0.2, 0.5, 2.0])
def test_damper_with_an_exponent(exponent: float) -> None:
    # thrown against F_0 + c v^a, the time to rest is the integral of M_e dv/(F_0 + c v^a)
    velocity, c = 0.01, 0.01 / 0.01**exponent
    run = Throw(velocity, Viscous(c, exponent))
    speeds = np.linspace(0.0, 1.0, 20_001) ** 3 * velocity  # fine at the kink
    resistance = F_0 + c * speeds**exponent
    middle = 0.5 * (speeds[1:] + speeds[:-1])
    simpson = np.diff(speeds) / 6.0
    slow = 1.0 / resistance
    half = 1.0 / (F_0 + c * middle**exponent)
    time = M_E * float(np.sum(simpson * (slow[1:] + 4.0 * half + slow[:-1])))
    weighted = speeds * slow
    way = M_E * float(np.sum(simpson * (weighted[1:] + 4.0 * middle * half + weighted[:-1])))
    run.advance(LinearGround(0.0, 0.0, 0.0, 0.0), time)
    assert SPAN * float(run.y[0]) == pytest.approx(way, rel=LEFT_OUT)
    assert abs(float(run.y[1])) < LEFT_OUT * velocity / SPAN


def test_one_swing_with_friction() -> None:
    start, share = 0.003, 0.3
    period = math.sqrt(2.0 * start * M_E / (F_0 * (1.0 - share)))
    before = released(start, 0.99 * period, Friction(share * F_0))
    path = start - F_0 * (1.0 - share) / (2.0 * M_E) * before.time**2
    assert SPAN * before.theta == pytest.approx(path, abs=LEFT_OUT * start)
    # the energy (F_0 - F_d) u_1 that comes back costs (F_0 + F_d) u_2 on the other side
    after = released(start, 2.5 * period, Friction(share * F_0), samples=400)
    far = SPAN * -float(np.min(after.theta))
    # the turning point lies between samples, off by less than (dt/2)^2/2 of 1.4 F_0/M_e
    assert far == pytest.approx(start * (1.0 - share) / (1.0 + share), rel=1e-4)
    assert after.device_work[0] > 0.0


def test_friction_above_the_restoring_force_holds_the_tilt() -> None:
    result = released(0.003, 1.0, Friction(1.001 * F_0))
    assert result.theta == pytest.approx(np.full(51, 0.003 / SPAN), abs=0.0)
    assert result.sticks == 1
    assert result.device_work[0] == 0.0
    assert released(0.003, 1.0, Friction(0.999 * F_0)).sticks == 0


def test_friction_delays_uplift() -> None:
    force, ramp = 0.4 * F_0, 0.01
    lifted = (F_0 + force) / MOTION.pushed_mass
    dt = lifted / ramp / 100.5
    ag: Array = -ramp * dt * np.arange(120.0)
    result = simulate(frame(), ag, dt, devices=(Friction(force),), free_vibration=0.0)
    assert result.uplifts == 1
    assert np.flatnonzero(result.theta)[0] == 101
    # from there on the push grows as the ground does: M_e u'' = pushed mass * ramp * t
    t = dt * (120 - 1) - lifted / ramp
    path = MOTION.pushed_mass * ramp * t**3 / (6.0 * M_E)
    assert SPAN * result.theta[-1] == pytest.approx(path, rel=1e-4)


def test_a_stuck_storey_carries_a_building_on_a_fixed_base_until_its_limit() -> None:
    system = podium(2, 0.15, 0.5)
    motion = StoreyLagrangian(system)
    start = 0.05
    slope = motion.cap_beam(start, rolling=True)[1]
    restoring = motion.lifted_mass * GRAVITY * slope.imag / slope.real
    force, dt = 1.5 * restoring, 0.01
    ag = 0.6 * np.sin(2.0 * math.pi * 3.0 * dt * np.arange(150)) * np.linspace(0.0, 1.0, 150)
    result = simulate(
        system, ag, dt, initial_rotation=start, devices=(Friction(force),), free_vibration=0.0
    )
    between = np.eye(2) - np.eye(2, k=-1)
    stiffness = between.T @ np.diag(system.stiffnesses) @ between
    upper, lower = (
        np.hstack([np.zeros((2, 2)), np.eye(2)]),
        -np.hstack([stiffness, system.damping_matrix]),
    )
    load = np.r_[np.zeros(2), -np.ones(2)][:, None]
    linear = (np.vstack([upper, lower]), load, np.eye(4), np.zeros((4, 1)))
    _, states, _ = lsim(linear, ag, dt * np.arange(150))
    shear = states[:, :2] @ stiffness.sum(axis=0) + states[:, 2:] @ system.damping_matrix.sum(
        axis=0
    )
    push = shear - motion.pushed_mass * ag
    freed = np.flatnonzero((push < restoring - force) | (push > restoring + force))
    assert 20 < freed[0] < 149
    held = slice(0, int(freed[0]))
    assert result.theta[held] == pytest.approx(start, abs=0.0)
    assert np.cumsum(result.drifts, axis=1)[held] == pytest.approx(states[held, :2], abs=1e-13)
    assert result.theta[-1] < start  # the way back is the shorter one


@pytest.mark.parametrize("stiffness", [5.0, 500.0])
def test_the_highest_rotation_at_a_stop(stiffness: float) -> None:
    gap, velocity = 0.002, 0.02
    run = Throw(velocity, Stop(gap, stiffness)).until_impact(0.05)
    energy = 0.5 * M_E * velocity**2
    over = brentq(lambda z: 0.5 * stiffness * z**2 + F_0 * (gap + z) - energy, 0.0, 1.0)
    assert SPAN * run.max_rotation == pytest.approx(gap + over, rel=LEFT_OUT)
    assert run.back == pytest.approx(velocity, rel=1e-9)  # nothing is lost
    assert run.branches == 2


def test_a_stop_with_a_damper_lets_go_before_its_gap() -> None:
    gap, stiffness, c, velocity = 0.002, 40.0, 4.0, 0.05
    run = Throw(velocity, Stop(gap, stiffness, c)).until_impact(0.05)
    # z = u - d from the meeting on: M_e z'' + c z' + k z + F_0 = 0
    decay, rest = c / (2.0 * M_E), F_0 / stiffness
    omega = math.sqrt(stiffness / M_E - decay**2)
    speed = math.sqrt(velocity**2 - 2.0 * F_0 * gap / M_E)

    def motion(t: float) -> tuple[float, float]:
        a, b = rest, (speed + decay * rest) / omega
        cosine, sine, damp = math.cos(omega * t), math.sin(omega * t), math.exp(-decay * t)
        z = damp * (a * cosine + b * sine) - rest
        rate = damp * ((omega * b - decay * a) * cosine - (omega * a + decay * b) * sine)
        return z, rate

    def push(t: float) -> float:
        z, rate = motion(t)
        return stiffness * z + c * rate

    times = np.linspace(1e-4, 2.0 * math.pi / omega, 20_001)
    falls = int(np.flatnonzero(np.array([push(t) for t in times]) < 0.0)[0])
    gone = brentq(push, times[falls - 1], times[falls])
    z, rate = motion(gone)
    assert z > 0.05 * gap
    back = math.sqrt(rate**2 + 2.0 * F_0 * (z + gap) / M_E)
    assert run.back == pytest.approx(back, rel=LEFT_OUT)
    # all that it took, 1/2 k z^2 included, is lost: it relaxes without pulling
    assert float(run.arrival[2]) == pytest.approx(0.5 * M_E * (velocity**2 - back**2), rel=LEFT_OUT)


def test_rolling_resistance_is_friction_on_the_tilt() -> None:
    start, lever = 0.003, 0.3 * MOTION.half_width
    result = released(start, 3.0, RollingResistance(lever), samples=400)
    far = SPAN * -float(np.min(result.theta))
    assert far == pytest.approx(start * (1.0 - 0.3) / (1.0 + 0.3), rel=1e-4)
    assert released(start, 1.0, RollingResistance(1.001 * MOTION.half_width)).sticks == 1


@pytest.mark.parametrize("wedge", [0.15, 0.17, 0.4])
def test_the_opening_is_the_path_of_two_points(wedge: float) -> None:
    rho = 0.0 if wedge == 0.15 else 0.6
    motion = StoreyLagrangian(replace(podium(2, 0.15, rho), tan_alpha_wedge=wedge))
    gear = Equipment(motion, (Tendon(1.0, 1.0, 1.0),), 1.0)
    B, H, r, beta = motion.half_width, motion.half_height, motion.radius, motion.beta
    for x in (1e-9, 1e-4, 0.01, 0.03, 0.2, 0.4):
        rolling = x < beta
        e, growth = gear.elongation(x, rolling=rolling)
        if rolling:
            du = B * (1.0 - math.cos(x)) + r * (x - math.sin(x))
            dv = B * math.sin(x) + r * (1.0 - math.cos(x))
        else:  # the lower end's middle turns about the contact as a body does
            w = motion.cap_beam(x, rolling=False)[0]
            du, dv = w.real / 2.0 - H * math.sin(x), w.imag / 2.0 + H * (1.0 - math.cos(x))
        assert e == pytest.approx(2.0 * math.hypot(du, dv), rel=1e-7)
        if rho == 0.0:
            assert e == pytest.approx(4.0 * B * math.sin(x / 2.0), rel=1e-13)
        if abs(x - beta) > 1e-3:
            h = 1e-5 * x
            ahead, behind = (gear.elongation(x + d, rolling=rolling)[0] for d in (h, -h))
            assert growth == pytest.approx((ahead - behind) / (2.0 * h), rel=1e-5)
    assert gear.elongation(0.0, rolling=rho > 0.0)[0] == 0.0
    assert gear.elongation(0.0, rolling=rho > 0.0)[1] == pytest.approx(2.0 * B, rel=1e-13)


def test_a_prestressed_frame_lifts_at_the_sum_of_weight_and_prestress() -> None:
    prestress, ramp = 0.4, 0.01
    tendon = Tendon(3.0, prestress, 100.0)
    lifted = (F_0 + 3.0 * prestress * SLOPE) / MOTION.pushed_mass
    dt = lifted / ramp / 100.5
    ag: Array = -ramp * dt * np.arange(120.0)
    result = simulate(frame(0.0), ag, dt, devices=(tendon,), free_vibration=0.0)
    assert np.flatnonzero(result.theta)[0] == 101


def test_a_frame_held_by_tendons_swings_with_the_linearised_frequency() -> None:
    # I x'' = -(W + N P_0) 2 B - (N k 4 B^2 - W 2 H) x on flat ends, slender
    system = replace(frame(0.0), tan_alpha=0.01, tan_alpha_wedge=0.01)
    motion = StoreyLagrangian(system)
    B, H, weight = motion.half_width, motion.half_height, motion.lifted_mass * GRAVITY
    N, prestress, stiffness = 3.0, 2.0, 4e4
    inertia = float(motion.mass_matrix(motion.cap_beam(0.0, rolling=False)[1])[0, 0])
    slope = N * stiffness * 4.0 * B**2 - weight * 2.0 * H
    omega = math.sqrt(slope / inertia)
    shift = (weight + N * prestress) * 2.0 * B / slope
    start = 0.003
    quarter = math.acos(shift / (start + shift)) / omega
    result = simulate(
        system,
        np.zeros(1),
        quarter / 40,
        free_vibration=4.0 * quarter,
        initial_rotation=start,
        devices=(Tendon(N, prestress, stiffness),),
    )
    t = result.time[:40]
    swing = (start + shift) * np.cos(omega * t) - shift
    # C = cos(alpha - x) and e = 4 B sin(x/2) leave out alpha x and x^2/8
    assert result.theta[:40] == pytest.approx(swing, abs=1e-4 * start)
    assert result.theta[[80, 160]] == pytest.approx([-start, start], rel=1e-4)
    assert result.device_work[0] == pytest.approx(0.0, abs=1e-6 * weight * 2 * B * start)


@pytest.mark.parametrize("reach", [0.5, 2.5])
def test_a_tendon_that_yields_loses_prestress_or_all_of_it(reach: float) -> None:
    N, prestress, stiffness, strength = 2.0, 1.0, 2000.0, 3.0
    strain = (strength - prestress) / stiffness
    farthest = strain + reach * prestress / stiffness  # 0 < reach < 1: some prestress is left
    tendon = Tendon(N, prestress, stiffness, strength)
    tilt = Equipment(MOTION, (tendon,), 0.4).tilt_at(farthest, of="elongation")
    lifting = F_0 / SLOPE * MOTION.cap_beam(tilt, rolling=True)[0].imag
    drawn = N * (0.5 * (prestress + strength) * strain + strength * (farthest - strain))
    run = Throw(math.sqrt(2.0 * (lifting + drawn) / M_E), tendon).until_impact(0.01)
    plastic = farthest - strain
    # the rotation at rest feels a miss of energy by its share: drawn is the greater part
    assert run.max_rotation == pytest.approx(tilt, rel=LEFT_OUT)
    assert run.equipment.plastic[0] == pytest.approx(plastic, rel=1e-4)
    left = max(0.0, prestress - stiffness * plastic)
    released = N * (strength**2 - left**2) / (2.0 * stiffness)
    assert 0.5 * M_E * run.back**2 == pytest.approx(lifting + released, rel=1e-4)
    assert run.equipment.branches[0] == ("elastic" if reach < 1.0 else "slack")


@pytest.mark.parametrize("share", [0.2, 0.4])
def test_locking_with_friction_needs_no_small_tolerance(share: float) -> None:
    system = replace(podium(2, 0.15, 0.0), restitution=0.6)
    friction = Friction(share * StoreyLagrangian(system).lifted_mass * GRAVITY * 0.15)
    exact = drifts_at_the_end(system, 1e-12, friction)
    found = drifts_at_the_end(system, 1e-8, friction)
    assert np.max(np.abs(found - exact)) < 1e-4 * np.max(np.abs(exact))


@pytest.mark.parametrize("law", ["rigid", "flexible"])
def test_energy_with_every_device(law: Literal["rigid", "flexible"]) -> None:
    base = podium(2, 0.15, 0.4)
    system = replace(base, law=law, damping_matrix=np.zeros((2, 2)))
    devices: tuple[OracleDevice, ...] = (
        Viscous(0.1, 0.6),
        Friction(0.3),
        Stop(0.06, 20.0, 2.0),
        Stop(0.06, 10.0),
        Tendon(4.0, 0.4, 40.0, 0.6),
        RollingResistance(0.01),
    )
    run = _Simulation(system, recontact=1e-6, overturning=2.0, rtol=1e-11, devices=devices)
    run.y[0], run.contact = -0.06, Contact(-1, rolling=True)
    run.equipment.release(0.06, rolling=True)
    run.turn(LinearGround(0.0, 0.0, 0.0, 0.0))

    def energies() -> tuple[float, float]:
        assert run.contact is not None
        x = abs(float(run.y[0]))
        stored = run.equipment.stored(x, rolling=run.contact.rolling)
        return sum(run.lagrangian.energies(run.contact, run.y)), stored

    initial, stored = energies()
    for _ in range(60):
        run.advance(LinearGround(0.0, 0.0, 0.0, 0.0), 0.02)
        if run.contact is None:
            break  # type: ignore[unreachable] # mypy does not see that `advance` may end it
        energy, now = energies()
        work = run.y[6:]
        assert energy + float(np.sum(work)) + run.energy_lost == pytest.approx(initial, rel=1e-8)
        # what is taken up and not stored is dissipated, by each kind that can
        assert float(np.sum(work)) > now - stored
    assert run.impacts > 1
    assert np.all(work[[0, 1, 5]] > 0.0)
    assert run.branches > 4


def test_mirrored_ground_motion_gives_the_mirrored_response() -> None:
    system = podium(2, 0.15, 0.5)
    record: Array = 3.0 * np.sin(2.0 * math.pi * 1.25 * 0.02 * np.arange(41))
    devices = (Friction(2.0), Stop(0.02, 30.0, 1.0), Tendon(4.0, 0.5, 20.0, 0.8), Viscous(1.0, 0.5))
    right, left = (
        simulate(system, sign * record, 0.02, free_vibration=1.0, devices=devices)
        for sign in (1, -1)
    )
    assert right.impacts == left.impacts > 0
    assert right.theta == pytest.approx(-left.theta, abs=0.0)
    assert right.device_work == pytest.approx(left.device_work, abs=0.0)
