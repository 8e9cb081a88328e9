"""The certified problems: two roads to the answers of each, by the names that pages give them.

What a problem asks stands on its page, beside the case that the program computes with. The first
road shares nothing with the program; the second is the program, from the case that is shipped, as
`rps verify` follows it. A `change` of the structure makes it a wrong program.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from itertools import pairwise

import numpy as np
from oracles.compliant_storey import CompliantStorey
from oracles.crossings import Array
from oracles.devices import Friction, RollingResistance, Stop, Tendon, Viscous
from oracles.second_integrator import simulate
from oracles.spatial_integrator import SpatialSimulation, simulate_pair
from oracles.storey_lagrangian import Contact
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from two_components import released

from rpscli.analyses.timehistory import time_history
from rpscli.analyses.verification import FOLDER, answers
from rpscli.case.case import Case, load_case
from rpscli.model.podium import PodiumStructure
from rpscli.records.ground_motion import MotionComponents
from rpscli.records.loading import load_components

from .closed_forms import RigidFrame, least_tilt, statics, uplift_time, uplifted_roots
from .podiums import Floors, Podium

Change = Callable[[PodiumStructure], PodiumStructure]

DT, KNOTS = 0.1, 30
"""Of motions: polygons over three seconds."""

FINE = 0.01
"""Samples of what the ground does not move [s]."""


def polygon(*waves: tuple[float, float, float]) -> Array:
    """Sines of amplitude, period and phase under half a sine, as knots of two decimals."""
    t = np.arange(KNOTS + 1) * DT
    total = np.sum([a * np.sin(2.0 * np.pi * t / T + phase) for a, T, phase in waves], axis=0)
    return np.asarray(np.round(total * np.sin(np.pi * t / t[-1]), 2) + 0.0)


LONG, MEMBERS = 90.0, 100
"""Of motions that part: seconds, and how many."""

MOTIONS: dict[str, Array] = {
    "x": polygon((3.2, 0.9, 0.3), (1.6, 0.4, 1.0)),
    "y": polygon((2.4, 0.7, 1.2), (1.2, 0.5, 0.2)),
    "up": polygon((1.5, 0.3, 0.5), (1.0, 0.25, 0.0)),
    "triangle": np.array([0.0, 0.5, 1.0, 2.0 / 3.0, 1.0 / 3.0, 0.0]),
    "sine": np.round(2.06 * np.sin(2.0 * np.pi * np.arange(round(LONG / DT) + 1) * DT), 2) + 0.0,
    "still": np.zeros(2),
}


@dataclass(frozen=True, eq=False)
class Problem:
    """Quantities with their units, and two roads to them."""

    name: str
    units: Mapping[str, str]
    first: Callable[[], Iterable[float]]
    podium: Podium
    record: Mapping[str, str | float] = field(
        default_factory=lambda: {"source": "ground_still.csv"}
    )
    analysis: Mapping[str, float] = field(default_factory=dict)
    apart: Callable[[Change], Iterable[float]] | None = None
    """The second road of what `rps verify` leaves out."""

    def second(self, change: Change) -> Iterable[float]:
        if self.apart:
            return self.apart(change)
        case, structure, motion = shipped(self.name, change)
        found = answers(self.name, structure, motion, case.analysis)
        assert [quantity for _, quantity in found] == [*self.units]
        return [value for (value,) in found.values()]

    @property
    def members(self) -> int:
        """Of a sample; 0 where motions do not part."""
        return MEMBERS if self.name == "parting_motions" else 0

    def case(self, title: str) -> str:
        analysis = {"free_vibration": 0.0, "recontact_tolerance": 1e-12, "accuracy": 8}
        if self.podium.contact:  # compliant ends do not bounce
            del analysis["recontact_tolerance"]
        return self.podium.case(title, self.record, {**analysis, **self.analysis})


def shipped(name: str, change: Change) -> tuple[Case, PodiumStructure, MotionComponents]:
    """A case, its structure, changed, and its motion."""
    case = load_case(FOLDER / f"{name}.yaml")
    assert case.record is not None
    moved = load_components(
        case.record.source, case.record.vertical, case.record.y, folder=case.folder
    )
    return case, change(case.structure), moved.scaled(case.record.scale)


def rows(times: Sequence[float], dt: float = DT) -> list[int]:
    return [round(t / dt) for t in times]


def seen(times: Sequence[float], **quantities: str) -> dict[str, str]:
    """Units of quantities at some times."""
    return {f"{name.replace('_', ' ')} at {t:g} s": unit for t in times for name, unit in quantities.items()}  # fmt: skip  # noqa: E501


def release(name: str, podium: Podium, start: float, count: int = 4) -> Problem:
    """A rigid frame or block that is let go: when impacts come, and how fast."""
    units: dict[str, str] = {}
    for i in range(1, count + 1):
        units |= {f"time of impact {i}": "s", f"tilt rate before impact {i}": "rad/s"}

    def first() -> Iterable[float]:
        return (z for hit in frame.impacts(start, count) for z in hit)

    frame = RigidFrame(podium.oracle(), podium.devices)
    end = math.ceil(frame.impacts(start, count)[-1].time * 10) / 10 + 0.1
    analysis = {"initial_rotation": start, "free_vibration": end}
    return Problem(name, units, first, podium, analysis=analysis)


def releases() -> Iterable[Problem]:
    block = Podium(1.0 / 3.0, R=math.hypot(0.2, 0.6), columns_mass=1000.0, beam=0.0, number=1)
    yield release("block_release", block, 0.2, 6)
    yield release("flat_release", Podium(), 0.1)
    yield release("softening_release", Podium(0.12, 0.18, 0.25), 0.16)
    yield release("stiffening_release", Podium(0.15, 0.3, 1.5), 0.2)
    yield release("friction_release", Podium(devices=(Friction(3e4),)), 0.1)
    yield release("stop_release", Podium(0.15, 0.3, 0.5, devices=(Stop(0.12, 2e6),)), 0.12)
    yield release("tendon_release", Podium(devices=(Tendon(4, 5e4, 4e6),)), 0.1)
    rolling = Podium(0.15, 0.3, 0.5, devices=(RollingResistance(1e-3),))
    yield release("rolling_release", rolling, 0.15)


def spherical() -> Problem:
    times, start, podium = (0.5, 1.0, 1.5, 2.0, 3.0), 0.2, Podium(0.0, 0.3, 0.75)
    frame = RigidFrame(podium.oracle())
    return Problem(
        "spherical_swing",
        seen(times, tilt="rad"),
        lambda: (frame.tilt_after(start, t) for t in times),
        podium,
        analysis={"initial_rotation": start, "free_vibration": 3.0},
    )


def overturning() -> Problem:
    """Of the first road: what is left at the end of the pulse, to come to the balance point."""
    podium = Podium(1.0 / 3.0, R=math.hypot(0.2, 0.6), columns_mass=1000.0, beam=0.0, number=1)
    motion, right = podium.lagrangian, Contact(1, rolling=False)
    g, knots = motion.system.gravity, np.arange(6) * DT

    def rates(t: float, y: Array, peak: float) -> Array:
        # a ground that moves to the right pushes the block to the left: mirrored
        a_g = -peak * float(np.interp(t, knots, MOTIONS["triangle"]))
        return np.array([y[1], motion.acceleration(right, y, a_g, g)[0]])

    def left(peak: float) -> float:
        start, y = 0.2 * g / 3.0 / peak, np.zeros(2)
        places = [start, *(float(t) for t in knots if t > start)]
        for a, b in pairwise(places):
            y = solve_ivp(rates, (a, b), y, "DOP853", args=(peak,), rtol=3e-14, atol=1e-17).y[:, -1]
        top = motion.cap_beam(math.atan(1.0 / 3.0), rolling=False)[0].imag
        return sum(motion.energies(right, y)) - motion.lifted_mass * g * top

    return Problem(
        "block_overturning",
        {"least peak": "m/s2"},
        lambda: [brentq(left, 5.0, 12.0, xtol=1e-15, rtol=1e-15)],
        podium,
        {"source": "ground_triangle.csv", "scale": 8.0},
        {"free_vibration": 12.0},
    )


ONE = Floors((2e5,), (8.8e7,))
THREE = Floors((2e5,) * 3, (5e8, 4.2e8, 2.6e8))
NINE = Floors((2e5,) * 9, (4.4e8, 4.3e8, 4.2e8, 4e8, 3.6e8, 3.2e8, 2.7e8, 2.1e8, 1.3e8))


def capacity() -> Problem:
    x, podium = 0.1, Podium(0.15, 0.25, 0.25, above=THREE)

    units = {
        "uplift force": "N", "critical rotation": "rad", "displacement at it": "m",
        "lift at it": "m", "force at 0.1 rad": "N", "energy to overturn": "J",
    }  # fmt: skip
    return Problem("capacity", units, lambda: statics(podium.oracle(), x), podium)


def modes() -> Problem:
    podium = Podium(0.15, 0.3, 0.25, above=THREE)
    units = {"own mode": "rad/s"}
    for i in (1, 2, 3):
        units |= {f"frequency {i}": "rad/s", f"damping ratio {i}": "-"}

    def first() -> Iterable[float]:
        roots = uplifted_roots(podium.oracle())
        own = [z.real for z in roots if abs(z.imag) < 1e-9]
        yield math.sqrt(abs(own[0] * own[1]))
        for z in sorted((z for z in roots if z.imag > 1e-9), key=abs):
            yield from (abs(z), -z.real / abs(z))

    return Problem("uplifted_modes", units, first, podium)


def building(
    name: str,
    podium: Podium,
    *,
    times: Sequence[float] = (1.0, 2.0, 3.0),
    scale: float = 1.0,
    vertical: bool = False,
) -> Problem:
    """Tilts and drifts at some times, and the first uplift if nothing but the building holds it."""
    ground, lifts = scale * MOTIONS["x"], not (vertical or podium.devices)
    units = {"time of uplift": "s"} if lifts else {}
    units |= {**seen(times, tilt="rad", drift_of_the_first_storey="m"), "largest tilt": "rad"}

    def first() -> Iterable[float]:
        found = simulate(
            podium.oracle(), ground, DT, av=MOTIONS["up"] if vertical else None,
            free_vibration=0.0, recontact_tolerance=1e-12, rtol=1e-13, devices=podium.devices,
        )  # fmt: skip
        uplift = [uplift_time(podium.oracle(), ground, DT)] if lifts else []
        sampled = (z for j in rows(times) for z in (found.theta[j], found.drifts[j, 0]))
        return (*uplift, *sampled, found.max_rotation)

    record: dict[str, str | float] = {"source": "ground_x.csv"}
    record |= {"scale": scale} if scale != 1.0 else {}
    record |= {"vertical": "ground_up.csv"} if vertical else {}
    return Problem(name, units, first, podium, record)


def giving_way(name: str, kind: str, above: Floors, settles: float) -> Problem:
    times, zeta = (1.0, 2.0, 3.0), 0.05
    podium = Podium(above=above, contact=(kind, settles, zeta))
    motion = podium.lagrangian

    def first() -> Iterable[float]:
        storey = CompliantStorey(
            podium.R, math.atan(podium.slenderness), 4.0 / 3.0, podium.columns_mass, podium.beam,
            np.array(podium.masses), podium.stiffness_matrix, podium.damping_matrix,
            settles / motion.half_width, zeta, kind == "plane", motion.restitution,
        )  # fmt: skip
        tilt, floors = storey.history(MOTIONS["x"], DT, tolerance=3e-14)[:2]
        return (z for j in rows(times) for z in (tilt[j], floors[j, -1]))

    units = seen(times, tilt="rad", roof_displacement="m")
    return Problem(name, units, first, podium, {"source": "ground_x.csv"})


def wobble() -> Problem:
    """Free motion in space; its least tilt by energy and angular momentum."""
    podium, tilt, turning, times = Podium(contact_time=0.0), 0.1, 0.8, (1.0, 2.0, 3.0)

    def told(tilts: Array) -> Iterable[float]:
        return (z for j in rows(times, FINE) for z in (tilts[j].real, tilts[j].imag))

    def first() -> Iterable[float]:
        run = SpatialSimulation(podium.oracle(), axial=podium.axial, rtol=1e-13)
        run.release((tilt, 0.0), (0.0, tilt * turning))
        states = simulate_pair(run, np.zeros((3, 2)), FINE, 3.0)
        least = least_tilt(podium.oracle(), podium.axial, tilt, turning)
        return (least, run.passes[0].time, *told(states[:, 0] + 1j * states[:, 1]))

    def second(change: Change) -> Iterable[float]:
        case, structure, _ = shipped("free_wobble", change)
        accuracy = case.analysis.accuracy
        found = released(structure, tilt, tilt * turning, 3.0, accuracy=accuracy)
        near = found.passes[0]
        return (float(near.least_tilt), float(near.time), *told(found.tilt))

    units = {"least tilt": "rad", "time of the least tilt": "s"}
    units |= seen(times, tilt_towards_x="rad", tilt_towards_y="rad")
    analysis = {"initial_rotation": tilt, "free_vibration": 3.0}
    return Problem("free_wobble", units, first, podium, analysis=analysis, apart=second)


def pair() -> Problem:
    podium, start, times = Podium(above=THREE, contact_time=0.0), 0.05, (1.0, 1.5, 2.0, 2.5)

    def first() -> Iterable[float]:
        run = SpatialSimulation(podium.oracle(), axial=podium.axial, rtol=1e-13, recontact=1e-12)
        run.release((start, 0.0), (0.0, 0.0))
        ground = np.array([MOTIONS[way] for way in ("x", "y", "up")])
        states = simulate_pair(run, ground, DT, KNOTS * DT)
        return (z for j in rows(times) for z in states[j, :2])

    units = seen(times, tilt_towards_x="rad", tilt_towards_y="rad")
    record = {"source": "ground_x.csv", "y": "ground_y.csv", "vertical": "ground_up.csv"}
    analysis = {"initial_rotation": start}
    return Problem("both_components", units, first, podium, record, analysis)


STARTS = 0.02 + 0.0005 * np.arange(MEMBERS)


def long_history(start: float) -> float:
    """The last tilt of one that parts, at a tolerance that it outlives anyway."""
    podium = parting().podium
    found = simulate(
        replace(podium.oracle(), restitution=podium.restitution), MOTIONS["sine"], DT,
        free_vibration=0.0, recontact_tolerance=1e-12, rtol=1e-8, initial_rotation=start,
    )  # fmt: skip
    return float(found.theta[-1])


def parting() -> Problem:
    def second(change: Change) -> Iterable[float]:
        case, structure, motion = shipped("parting_motions", change)
        for start in STARTS:
            settings = replace(case.analysis, initial_rotation=float(start))
            found = time_history(structure, motion, settings, with_fixed_base=False)
            yield found.trace.rotation[-1]

    return Problem(
        "parting_motions",
        seen((LONG,), tilt="rad"),
        lambda: map(long_history, STARTS.tolist()),
        Podium(0.15, 0.3, 1.5, loss=0.03),
        {"source": "ground_sine.csv"},
        {"initial_rotation": 0.02, "accuracy": 1.0},
        second,
    )


@cache
def problems() -> Mapping[str, Problem]:
    damped = Podium(above=ONE, devices=(Viscous(4e5), Viscous(3e5, 1.5)))
    half = Podium(0.15, 0.3, 0.5, above=THREE)
    block, flat, softening, stiffening, *devices = releases()
    nine = Podium(0.15, 0.3, 1.5, above=NINE)
    found = (
        block, overturning(), flat, softening, stiffening, spherical(), capacity(), modes(),
        building("one_storey", Podium(above=ONE)),
        building("three_storeys", half),
        # later floors settle in bounces that programs end in different ways
        building("nine_storeys", nine, times=(1.0, 1.5, 2.0)),
        building("viscous_damper", damped, scale=1.5), *devices,
        building("vertical_motion", half, vertical=True), wobble(), pair(),
        giving_way("plane_joints", "plane", THREE, 2e-4),
        giving_way("edges", "edges", ONE, 1e-4),
        parting(),
    )  # fmt: skip
    return {problem.name: problem for problem in found}
