"""The certified problems: both roads to the answers of each, by the names that pages give them.

What a problem asks stands on its page, beside the case that the program computes with. The first
road takes the numbers of the case, and shares nothing else with the program; the second is the
program, as `rps verify` follows it. A `change` of the structure makes it a wrong program.

Exact solutions come first: rigid frames by quadrature of their energy, statics, modes, and uplift.
Lengths come from the complex contact geometry of `storey_lagrangian`. Differences between two tilts
are formed as products, so that they keep their digits where a swing turns.
"""

import cmath
import math
import re
from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from oracles.compliant_storey import CompliantStorey
from oracles.devices import Friction, RollingResistance, Stop, Tendon
from oracles.full_contact import FullContact
from oracles.second_integrator import simulate
from oracles.spatial_integrator import SpatialSimulation, simulate_pair
from oracles.storey_lagrangian import Contact, StoreyLagrangian
from paper_structures import known, oracle_devices, oracle_system
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.optimize import brentq
from two_components import released

from rpscli.analyses.timehistory import time_history
from rpscli.analyses.verification import FOLDER, answers, certified
from rpscli.case.case import load_case
from rpscli.records.loading import load_components

NODES, WEIGHTS = np.polynomial.legendre.leggauss(60)


def integral(of, start, end):
    """By sixty points of Gauss: exact to rounding for what is analytic nearby."""
    half = 0.5 * (end - start)
    values = [of(start + half * (1.0 + z)) for z in NODES]
    return half * float(WEIGHTS @ np.array(values))


def tilt_at(of, value, high):
    """Where a function that grows from 0 on takes a value."""
    return float(brentq(lambda x: of(x) - value, 0.0, high, xtol=1e-16, rtol=1e-15))


class Hit(NamedTuple):
    """An impact: when, and |theta'| just before."""

    time: float
    rate: float


class RigidFrame:
    """A rigid frame or block that swings freely, with devices or without; |theta| below its end."""

    def __init__(self, system, devices=()):
        self.motion, self.devices = StoreyLagrangian(system), devices
        self.weight = self.motion.lifted_mass * system.gravity

    def moved(self, high, low):
        """w(high) - w(low) of the cap beam."""
        motion, border = self.motion, self.motion.beta
        if low < border < high:
            return self.moved(high, border) + self.moved(border, low)
        rolling = high <= border and border > 0.0
        # exp(-i low) - exp(-i high)
        turned = 2j * math.sin(0.5 * (high - low)) * cmath.exp(-0.5j * (high + low))
        if rolling:
            return 2.0 * motion.radius * (high - low) + 2.0 * motion.arc_frame * turned
        return 2.0 * motion.arc_end * turned

    def fallen(self, high, low, way):
        """Kinetic energy from a turn at `high` to `low` (way -1), or lost from `low` to it (+1)."""
        moved, far = self.moved(high, low), self.moved(high, 0.0).real
        energy = self.weight * moved.imag
        for device in self.devices:
            if isinstance(device, Friction):
                energy += way * device.force * moved.real
            elif isinstance(device, RollingResistance):
                energy += way * 2.0 * self.weight * device.lever * (high - low)
            elif isinstance(device, Stop):
                # of k (u - d)^2/2 beyond the gap
                beyond = max(far - device.gap, 0.0)
                left = max(far - moved.real - device.gap, 0.0)
                near = moved.real if left > 0.0 else beyond
                energy += 0.5 * device.stiffness * near * (beyond + left)
            elif isinstance(device, Tendon):
                # between the middles of flat ends: e = 4 B sin(x/2)
                width = 4.0 * self.motion.half_width
                e, longer = width * math.sin(0.5 * high), 2.0 * width
                longer *= math.cos(0.25 * (high + low)) * math.sin(0.25 * (high - low))
                mean = device.prestress + device.stiffness * (e - 0.5 * longer)
                energy += device.columns * longer * mean
        return energy

    def inertia(self, x):
        """Of theta'^2/2."""
        rolling = x <= self.motion.beta and self.motion.beta > 0.0
        slope = self.motion.cap_beam(x, rolling=rolling)[1]
        return self.motion.spin_inertia + self.motion.moving_mass * abs(slope) ** 2

    def breaks(self, high):
        """Tilts at which a law changes, from 0 to the turn."""
        found = [0.0, self.motion.beta]
        gaps = [device.gap for device in self.devices if isinstance(device, Stop)]
        reached = (gap for gap in gaps if self.moved(high, 0.0).real > gap > 0.0)
        found += [
            tilt_at(lambda x: self.moved(x, 0.0).real, gap, high) for gap in reached
        ]
        return [*sorted(x for x in set(found) if x < high), high]

    def duration(self, high, low, way):
        """Between the turn at `high` and `low`."""
        places = [low, *(x for x in self.breaks(high) if x > low)]

        def slowness(x):
            return math.sqrt(0.5 * self.inertia(x) / self.fallen(high, x, way))

        total = sum(integral(slowness, a, b) for a, b in pairwise(places[:-1]))
        span = high - places[-2]
        # x = high - span s^2 takes the root out of the last piece
        return total + integral(
            lambda s: 2.0 * span * s * slowness(high - span * s * s), 0.0, 1.0
        )

    def impacts(self, release, count):
        """Of a release at rest, with theta'+ = e theta'-."""
        found = []
        high, time = release, self.duration(release, 0.0, -1)
        for _ in range(count):
            energy = self.fallen(high, 0.0, -1)
            found.append(Hit(time, math.sqrt(2.0 * energy / self.inertia(0.0))))
            left = energy * self.motion.restitution**2
            high = tilt_at(partial(self.fallen, low=0.0, way=1), left, high)
            time += self.duration(high, 0.0, 1) + self.duration(high, 0.0, -1)
        return found

    def tilt_after(self, release, time):
        """Of spherical ends, which pass upright without loss: theta at a time."""
        quarter = self.duration(release, 0.0, -1)
        rest, side = time % (4.0 * quarter), 1.0
        if rest > 2.0 * quarter:  # the other half of the swing is its image
            rest, side = rest - 2.0 * quarter, -1.0
        if rest > quarter:
            rest, side = 2.0 * quarter - rest, -side
        least = release * (1.0 - 1e-6)
        return side * float(
            brentq(
                lambda x: self.duration(release, x, -1) - rest,
                0.0,
                least,
                xtol=1e-16,
                rtol=1e-15,
            )
        )


class Statics(NamedTuple):
    """Of the uplifted podium."""

    uplift: float
    critical: float
    displacement: float
    lift: float
    force: float
    energy: float


def statics(system, rotation):
    """Force at uplift and at a rotation, and where the weight restores no longer."""
    motion = StoreyLagrangian(system)
    weight = motion.lifted_mass * system.gravity

    def at(x):
        return motion.cap_beam(x, rolling=x <= motion.beta and motion.beta > 0.0)

    critical = brentq(lambda x: at(x)[1].imag, 1e-3, 0.6, xtol=1e-16, rtol=1e-15)
    first, there, far = at(0.0)[1], at(rotation)[1], at(critical)[0]
    return Statics(
        weight * first.imag / first.real, critical, far.real, far.imag,
        weight * there.imag / there.real, weight * far.imag,
    )  # fmt: skip


def uplifted_roots(system):
    """Eigenvalues of small motions on one side from tilt 0, in tilt and drifts."""
    motion, n = StoreyLagrangian(system), len(system.masses)
    _, slope, bend = motion.cap_beam(0.0, rolling=motion.beta > 0.0)
    stiffness = np.diag(
        [motion.lifted_mass * system.gravity * bend.imag, *system.stiffnesses]
    )
    damping = np.zeros((n + 1, n + 1))
    damping[1:, 1:] = motion.drift_damping
    flow = np.zeros((2 * n + 2, 2 * n + 2))
    flow[: n + 1, n + 1 :] = np.eye(n + 1)
    both = np.column_stack((stiffness, damping))
    flow[n + 1 :] = -np.linalg.solve(motion.mass_matrix(slope), both)
    return np.asarray(np.linalg.eigvals(flow))


def uplift_time(system, a_g, dt):
    """First uplift under a polygon, by matrix exponentials."""
    motion, n = StoreyLagrangian(system), len(system.masses)
    contact = FullContact(motion)
    flow, push = contact.flow, contact.taylor[0]
    hold = motion.lifted_mass * system.gravity * system.tan_alpha
    state = np.zeros(2 * n + 2)

    def spare(tau, begun):
        return abs(float(push @ expm(flow * tau) @ begun)) - hold

    steps = 50
    for j in range(len(a_g) - 1):
        state[2 * n :] = a_g[j], (a_g[j + 1] - a_g[j]) / dt
        for i in range(steps):
            begun = expm(flow * (i * dt / steps)) @ state
            if spare(dt / steps, begun) > 0.0:
                tau = brentq(
                    spare, 0.0, dt / steps, args=(begun,), xtol=1e-17, rtol=1e-15
                )
                return (j + i / steps) * dt + float(tau)
        state = expm(flow * dt) @ state
    raise RuntimeError("it does not lift")


def least_tilt(system, axial, tilt, turning):
    """Where free motion of a rigid frame on flat ends, begun so, comes nearest to upright.

    `axial` is the inertia of all columns about their axes [kg m2].
    """
    motion = StoreyLagrangian(system)

    def round_inertia(x):
        around = motion.moving_mass * motion.cap_beam(x, rolling=False)[0].real ** 2
        turned = motion.spin_inertia * math.sin(x) ** 2
        return float(around + turned + axial * (1.0 - math.cos(x)) ** 2)

    momentum = round_inertia(tilt) * turning
    frame = RigidFrame(system)

    def excess(x):
        """Of the energy of the turning over what the fall from the beginning gives."""
        spin = 1.0 / round_inertia(x) - 1.0 / round_inertia(tilt)
        return 0.5 * momentum**2 * spin - frame.fallen(tilt, x, -1)

    return float(brentq(excess, 1e-3, 0.7 * tilt, xtol=1e-16, rtol=1e-15))


def unchanged(structure):
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
    def asked(self):
        """By its quantities: unit, digits that are certified, and the certified values."""
        return {q: told for (name, q), told in certified().items() if name == self.name}

    @property
    def times(self):
        """At which something is asked [s]."""
        found = (re.search(r" at ([\d.]+) s$", quantity) for quantity in self.asked)
        return [*dict.fromkeys(float(time[1]) for time in found if time)]

    @cached_property
    def case(self):
        return load_case(FOLDER / f"{self.name}.yaml")

    @property
    def structure(self):
        return self.case.structure

    @property
    def start(self):
        """Tilt from which it is let go [rad]."""
        return self.case.analysis.initial_rotation

    @cached_property
    def motion(self):
        record = known(self.case.record)
        moved = load_components(
            record.source, record.vertical, record.y, folder=self.case.folder
        )
        return moved.scaled(record.scale)

    @property
    def ground(self):
        return self.motion.horizontal.acceleration

    @property
    def dt(self):
        return self.motion.horizontal.dt

    @cached_property
    def system(self):
        """With the restitution that the part `loss` of what impulses at the edges take leaves."""
        system = oracle_system(self.structure)
        e = StoreyLagrangian(system).restitution
        return replace(
            system, restitution=1.0 - self.structure.impact_law.loss * (1.0 - e)
        )

    @property
    def devices(self):
        return oracle_devices(self.structure)

    def rows(self, dt):
        """Samples at the times that are asked for."""
        return [round(t / dt) for t in self.times]

    def first(self):
        return [float(z) for z in FIRST[self.name](self)]

    def second(self, change):
        structure, analysis = change(self.structure), self.case.analysis
        if self.name == "free_wobble":
            return [*second_wobble(self, structure)]
        if self.name == "parting_motions":
            runs = (replace(analysis, initial_rotation=float(start)) for start in STARTS)
            ends = (
                time_history(structure, self.motion, each, with_fixed_base=False)
                for each in runs
            )
            return [float(end.trace.rotation[-1]) for end in ends]
        found = answers(self.name, structure, self.motion, analysis)
        assert [quantity for _, quantity in found] == [*self.asked]
        return [value for (value,) in found.values()]


def release(problem):
    """A rigid frame or block that is let go: when impacts come, and how fast."""
    frame = RigidFrame(problem.system, problem.devices)
    for hit in frame.impacts(problem.start, len(problem.asked) // 2):
        yield from hit


def spherical(problem):
    frame = RigidFrame(problem.system)
    return (frame.tilt_after(problem.start, t) for t in problem.times)


def overturning(problem):
    """What is left at the end of the pulse, to come to the balance point."""
    system, right = problem.system, Contact(1, rolling=False)
    motion, g, slope = StoreyLagrangian(system), system.gravity, system.tan_alpha
    shape = problem.ground / problem.ground.max()
    knots = np.arange(len(shape)) * problem.dt

    def rates(t, y, peak):
        # a ground that moves to the right pushes the block to the left: mirrored
        a_g = -peak * float(np.interp(t, knots, shape))
        return np.array([y[1], motion.acceleration(right, y, a_g, g)[0]])

    def left(peak):
        start, y = 2.0 * problem.dt * g * slope / peak, np.zeros(2)
        places = [start, *(float(t) for t in knots if t > start)]
        for a, b in pairwise(places):
            y = solve_ivp(
                rates, (a, b), y, "DOP853", args=(peak,), rtol=3e-14, atol=1e-17
            ).y[:, -1]
        top = motion.cap_beam(math.atan(slope), rolling=False)[0].imag
        return sum(motion.energies(right, y)) - motion.lifted_mass * g * top

    return [brentq(left, 5.0, 12.0, xtol=1e-15, rtol=1e-15)]


def modes(problem):
    roots = uplifted_roots(problem.system)
    own = [z.real for z in roots if abs(z.imag) < 1e-9]
    yield math.sqrt(abs(own[0] * own[1]))
    for z in sorted((z for z in roots if z.imag > 1e-9), key=abs):
        yield from (abs(z), -z.real / abs(z))


def building(problem):
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


def giving_way(problem):
    system, contact = problem.system, problem.structure.contact
    motion = StoreyLagrangian(system)
    lifts = known(contact.settlement) / motion.half_width
    plane, kept = contact.kind == "plane", motion.restitution
    storey = CompliantStorey(system, lifts, contact.damping, plane, kept)
    tilt, floors = storey.history(problem.ground, problem.dt, tolerance=3e-14)[:2]
    return (z for j in problem.rows(problem.dt) for z in (tilt[j], floors[j, -1]))


def wobble(problem):
    """Free motion in space; its least tilt by energy and angular momentum."""
    run = SpatialSimulation(problem.system, rtol=1e-13)
    run.release((problem.start, 0.0), (0.0, problem.start * TURNING))
    states = simulate_pair(run, np.zeros((3, 2)), problem.dt, max(problem.times))
    yield least_tilt(problem.system, run.motion.axial, problem.start, TURNING)
    yield run.passes[0].time
    for j in problem.rows(problem.dt):
        yield from states[j, :2]


def second_wobble(problem, structure):
    """No case says the turning at the start."""
    across, accuracy = problem.start * TURNING, problem.case.analysis.accuracy
    found = released(
        structure, problem.start, across, max(problem.times), accuracy=accuracy
    )
    yield from (float(found.passes[0].least_tilt), float(found.passes[0].time))
    for j in problem.rows(0.01):
        yield from (float(found.tilt[j].real), float(found.tilt[j].imag))


def both_components(problem):
    run = SpatialSimulation(problem.system, rtol=1e-13, recontact=1e-12)
    run.release((problem.start, 0.0), (0.0, 0.0))
    motion = problem.motion
    ways = (motion.horizontal, known(motion.y), known(motion.vertical))
    ground = np.array([way.acceleration for way in ways])
    states = simulate_pair(run, ground, problem.dt, motion.horizontal.duration)
    return (z for j in problem.rows(problem.dt) for z in states[j, :2])


def parting(problem):
    """The last tilts of motions that part, at a tolerance that they outlive anyway."""
    for start in STARTS.tolist():
        found = simulate(
            problem.system, problem.ground, problem.dt, free_vibration=0.0,
            recontact_tolerance=1e-12, rtol=1e-8, initial_rotation=start,
        )  # fmt: skip
        yield float(found.theta[-1])


FIRST = {
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
