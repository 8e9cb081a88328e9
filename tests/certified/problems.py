"""The certified problems: both roads to the answers of each, by the names that pages give them.

What a problem asks stands on its page, beside the case that the program computes with. The first
road takes the numbers of the case, and shares nothing else with the program; the second is the
program, as `rps verify` follows it. A `change` of the structure makes it a wrong program.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np
from oracles.compliant_storey import CompliantStorey
from oracles.crossings import Array
from oracles.devices import OracleDevice
from oracles.second_integrator import simulate
from oracles.spatial_integrator import SpatialSimulation, simulate_pair
from oracles.storey_lagrangian import Contact, OracleSystem, StoreyLagrangian
from paper_structures import known, oracle_devices, oracle_system
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from two_components import released

from rpscli.analyses.timehistory import time_history
from rpscli.analyses.verification import FOLDER, answers, certified
from rpscli.case.case import Case, load_case
from rpscli.model.podium import PodiumStructure
from rpscli.records.ground_motion import MotionComponents
from rpscli.records.loading import load_components

from .closed_forms import RigidFrame, least_tilt, statics, uplift_time, uplifted_roots

Change = Callable[[PodiumStructure], PodiumStructure]


def unchanged(structure: PodiumStructure) -> PodiumStructure:
    """The structure itself."""
    return structure


STARTS = 0.02 + 0.0005 * np.arange(100)
"""Of the motions that part."""

TURNING = 0.8
"""Of the azimuth, where the frame begins to wobble [rad/s]."""


@dataclass(frozen=True, eq=False)
class Problem:
    """What is asked, and what the case says."""

    name: str

    @cached_property
    def asked(self) -> dict[str, tuple[str, int, list[float]]]:
        """By its quantities: unit, digits that are certified, and the certified values."""
        return {q: told for (name, q), told in certified().items() if name == self.name}

    @property
    def times(self) -> list[float]:
        """At which something is asked [s]."""
        found = (re.search(r" at ([\d.]+) s$", quantity) for quantity in self.asked)
        return [*dict.fromkeys(float(time[1]) for time in found if time)]

    @cached_property
    def case(self) -> Case:
        return load_case(FOLDER / f"{self.name}.yaml")

    @property
    def structure(self) -> PodiumStructure:
        return self.case.structure

    @property
    def start(self) -> float:
        """Tilt from which it is let go [rad]."""
        return self.case.analysis.initial_rotation

    @cached_property
    def motion(self) -> MotionComponents:
        record = known(self.case.record)
        moved = load_components(record.source, record.vertical, record.y, folder=self.case.folder)
        return moved.scaled(record.scale)

    @property
    def ground(self) -> Array:
        return self.motion.horizontal.acceleration

    @property
    def dt(self) -> float:
        return self.motion.horizontal.dt

    @cached_property
    def system(self) -> OracleSystem:
        """With the restitution that the part `loss` of what impulses at the edges take leaves."""
        system = oracle_system(self.structure)
        e = StoreyLagrangian(system).restitution
        return replace(system, restitution=1.0 - self.structure.impact_law.loss * (1.0 - e))

    @property
    def devices(self) -> tuple[OracleDevice, ...]:
        return oracle_devices(self.structure)

    def rows(self, dt: float) -> list[int]:
        """Samples at the times that are asked for."""
        return [round(t / dt) for t in self.times]

    def first(self) -> list[float]:
        return [float(z) for z in FIRST[self.name](self)]

    def second(self, change: Change) -> list[float]:
        structure, analysis = change(self.structure), self.case.analysis
        if self.name == "free_wobble":
            return [*second_wobble(self, structure)]
        if self.name == "parting_motions":
            runs = (replace(analysis, initial_rotation=float(start)) for start in STARTS)
            ends = (
                time_history(structure, self.motion, each, with_fixed_base=False) for each in runs
            )
            return [float(end.trace.rotation[-1]) for end in ends]
        found = answers(self.name, structure, self.motion, analysis)
        assert [quantity for _, quantity in found] == [*self.asked]
        return [value for (value,) in found.values()]


def release(problem: Problem) -> Iterator[float]:
    """A rigid frame or block that is let go: when impacts come, and how fast."""
    frame = RigidFrame(problem.system, problem.devices)
    for hit in frame.impacts(problem.start, len(problem.asked) // 2):
        yield from hit


def spherical(problem: Problem) -> Iterable[float]:
    frame = RigidFrame(problem.system)
    return (frame.tilt_after(problem.start, t) for t in problem.times)


def overturning(problem: Problem) -> Iterable[float]:
    """What is left at the end of the pulse, to come to the balance point."""
    system, right = problem.system, Contact(1, rolling=False)
    motion, g, slope = StoreyLagrangian(system), system.gravity, system.tan_alpha
    shape = problem.ground / problem.ground.max()
    knots = np.arange(len(shape)) * problem.dt

    def rates(t: float, y: Array, peak: float) -> Array:
        # a ground that moves to the right pushes the block to the left: mirrored
        a_g = -peak * float(np.interp(t, knots, shape))
        return np.array([y[1], motion.acceleration(right, y, a_g, g)[0]])

    def left(peak: float) -> float:
        start, y = 2.0 * problem.dt * g * slope / peak, np.zeros(2)
        places = [start, *(float(t) for t in knots if t > start)]
        for a, b in pairwise(places):
            y = solve_ivp(rates, (a, b), y, "DOP853", args=(peak,), rtol=3e-14, atol=1e-17).y[:, -1]
        top = motion.cap_beam(math.atan(slope), rolling=False)[0].imag
        return sum(motion.energies(right, y)) - motion.lifted_mass * g * top

    return [brentq(left, 5.0, 12.0, xtol=1e-15, rtol=1e-15)]


def modes(problem: Problem) -> Iterator[float]:
    roots = uplifted_roots(problem.system)
    own = [z.real for z in roots if abs(z.imag) < 1e-9]
    yield math.sqrt(abs(own[0] * own[1]))
    for z in sorted((z for z in roots if z.imag > 1e-9), key=abs):
        yield from (abs(z), -z.real / abs(z))


def building(problem: Problem) -> Iterator[float]:
    """Tilts and drifts at some times, and the first uplift if nothing but the building holds it."""
    up = problem.motion.vertical
    found = simulate(
        problem.system, problem.ground, problem.dt, av=None if up is None else up.acceleration,
        free_vibration=0.0, recontact_tolerance=1e-12, rtol=1e-13, devices=problem.devices,
    )  # fmt: skip
    if "time of uplift" in problem.asked:
        yield uplift_time(problem.system, problem.ground, problem.dt)
    for j in problem.rows(problem.dt):
        yield from (found.theta[j], found.drifts[j, 0])
    yield found.max_rotation


def giving_way(problem: Problem) -> Iterable[float]:
    system, contact = problem.system, problem.structure.contact
    motion = StoreyLagrangian(system)
    lifts = known(contact.settlement) / motion.half_width
    plane, kept = contact.kind == "plane", motion.restitution
    storey = CompliantStorey(system, lifts, contact.damping, plane, kept)
    tilt, floors = storey.history(problem.ground, problem.dt, tolerance=3e-14)[:2]
    return (z for j in problem.rows(problem.dt) for z in (tilt[j], floors[j, -1]))


def wobble(problem: Problem) -> Iterator[float]:
    """Free motion in space; its least tilt by energy and angular momentum."""
    run = SpatialSimulation(problem.system, rtol=1e-13)
    run.release((problem.start, 0.0), (0.0, problem.start * TURNING))
    states = simulate_pair(run, np.zeros((3, 2)), problem.dt, max(problem.times))
    yield least_tilt(problem.system, run.motion.axial, problem.start, TURNING)
    yield run.passes[0].time
    for j in problem.rows(problem.dt):
        yield from states[j, :2]


def second_wobble(problem: Problem, structure: PodiumStructure) -> Iterator[float]:
    """No case says the turning at the start."""
    across, accuracy = problem.start * TURNING, problem.case.analysis.accuracy
    found = released(structure, problem.start, across, max(problem.times), accuracy=accuracy)
    yield from (float(found.passes[0].least_tilt), float(found.passes[0].time))
    for j in problem.rows(0.01):
        yield from (float(found.tilt[j].real), float(found.tilt[j].imag))


def both_components(problem: Problem) -> Iterable[float]:
    run = SpatialSimulation(problem.system, rtol=1e-13, recontact=1e-12)
    run.release((problem.start, 0.0), (0.0, 0.0))
    motion = problem.motion
    ways = (motion.horizontal, known(motion.y), known(motion.vertical))
    ground = np.array([way.acceleration for way in ways])
    states = simulate_pair(run, ground, problem.dt, motion.horizontal.duration)
    return (z for j in problem.rows(problem.dt) for z in states[j, :2])


def parting(problem: Problem) -> Iterator[float]:
    """The last tilts of motions that part, at a tolerance that they outlive anyway."""
    for start in STARTS.tolist():
        found = simulate(
            problem.system, problem.ground, problem.dt, free_vibration=0.0,
            recontact_tolerance=1e-12, rtol=1e-8, initial_rotation=start,
        )  # fmt: skip
        yield float(found.theta[-1])


FIRST: Mapping[str, Callable[[Problem], Iterable[float]]] = {
    "block_release": release,
    "block_overturning": overturning,
    "flat_release": release,
    "softening_release": release,
    "stiffening_release": release,
    "spherical_swing": spherical,
    "capacity": lambda problem: statics(problem.system, 0.1),
    "uplifted_modes": modes,
    "one_storey": building,
    "three_storeys": building,
    # later floors settle in bounces that programs end in different ways
    "nine_storeys": building,
    "viscous_damper": building,
    "friction_release": release,
    "stop_release": release,
    "tendon_release": release,
    "rolling_release": release,
    "vertical_motion": building,
    "free_wobble": wobble,
    "both_components": both_components,
    "plane_joints": giving_way,
    "edges": giving_way,
    "parting_motions": parting,
}
PROBLEMS = {name: Problem(name) for name in FIRST}
