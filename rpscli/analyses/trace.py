"""Samples and events of a history, and what its devices saw: the kernel's records in words.

>>> from rpscli.physics.planar import state
>>> EVENT_NAMES[state.UPLIFT], EVENT_NAMES[state.OVERTURNING], EVENT_NAMES[state.TENDON_TAUT]
('uplift', 'overturning', 'tendon_taut')
>>> len(EVENT_NAMES) == state.EVENT_KINDS
True
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields
from typing import Any, Literal, NamedTuple, Self, TypeAlias, get_args

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.kernels.history import SampledHistory
from rpscli.model.podium import PodiumStructure
from rpscli.physics.core.records import Record
from rpscli.physics.planar import geometry, state
from rpscli.records.ground_motion import MotionComponents
from rpscli.shown import Frozen, Shown

Array = NDArray[np.float64]
Rows: TypeAlias = slice | NDArray[np.intp]
"""Numbers of samples."""

EventKind = Literal[
    "uplift",
    "impact",
    "recontact",
    "rolling_to_rocking",
    "rocking_to_rolling",
    "critical_rotation_passed",
    "overturning",
    "sticking",
    "sliding",
    "stop_met",
    "stop_left",
    "tendon_yielding",
    "tendon_slack",
    "tendon_taut",
    "pass",
]

EVENT_NAMES: tuple[EventKind, ...] = get_args(EventKind)
"""By the codes of the kernels."""


@dataclass(frozen=True)
class Event:
    """One event of a history."""

    time: float
    """Since the start of the record [s]."""
    kind: EventKind
    """What happened."""
    rotation: float
    """theta [rad]."""
    rotation_rate_before: float
    rotation_rate_after: float
    """theta' [rad/s]."""
    energy_lost: float
    """[J], negative where an impact created energy."""
    azimuth: float | None = None
    """Of the tilt, from x towards y [rad]; None where one component acts."""
    least_tilt: float | None = None
    """Of a pass near upright: theta_min [rad]; of others 0."""
    nearness: float | None = None
    """Of a pass: s, the time it takes over that of an impact; infinite if that takes none."""
    loss_share: float | None = None
    """Of a pass: l, how much of what an impact would lose."""


def event_list(log: Record) -> tuple[Event, ...]:
    """Events from the rows of the kernel's log."""
    return tuple(Event(time, EVENT_NAMES[kind], *told) for time, kind, *told in log.tolist())


@dataclass(frozen=True)
class DeviceDemand:
    """Largest demands of one device.

    Looked at within steps and on both sides of events: the samples of a `DeviceTrace` may be less.
    """

    kind: str
    """Name of its law."""
    force: float
    """At the cap beam [N]: of a tendon the tension of one, of rolling resistance the horizontal
    force that does the same."""
    stroke: float
    """|u_b| [m]; of a tendon its elongation."""
    velocity: float
    """Rate of the stroke [m/s]."""
    energy: float
    """Dissipated, by all tendons together [J]."""
    remaining_prestress: float | None
    """Of a tendon at the end, upright [N]; None of others."""


def device_demands(structure: PodiumStructure, history: Record) -> tuple[DeviceDemand, ...]:
    """Demands of each device from a `state.RESULT`, in the order of the structure's."""
    rotation = np.array([history["max_theta"]])
    return tuple(
        DeviceDemand(
            device.kind,
            float(history["device_force"][i]),
            float(device.stroke(structure, rotation)[0]),
            float(history["device_velocity"][i]),
            float(history["device_energy"][i]),
            device.remaining_prestress(float(history["permanent"][i])),
        )
        for i, device in enumerate(structure.devices)
    )


class _Sampled:
    """Base of dataclasses with a value at each sample in every field, or None."""

    def at(self, rows: Rows) -> Self:
        """Only some samples."""
        values = {each.name: getattr(self, each.name) for each in fields(self)}  # type: ignore[arg-type]
        known = {name: of for name, of in values.items() if of is not None}
        parts = {
            n: of.at(rows) if isinstance(of, _Sampled) else of[rows] for n, of in known.items()
        }
        return type(self)(**parts)


@dataclass(frozen=True, eq=False)
class DeviceTrace(_Sampled, Frozen):
    """What each device does at the record's samples: arrays (samples, devices)."""

    force: Array
    """On the cap beam, positive to the right, of pairs outwards [N]; of a tendon the tension."""
    displacement: Array
    """u_b [m], under both components |u_b|; of a tendon the elongation of one."""
    energy: Array
    """Dissipated so far [J]. A damped stop that has let go dissipates what its spring still holds
    as the cap beam moves back to the gap, not at once: sums over an excursion are exact."""
    stored: Array
    """Energy over what was stored at rest [J]; of a stop `k_s (|u_b| - d)^2/2`, let go or not."""


BLOCK = 50_000
"""Samples whose quantities are derived at once."""


@dataclass(frozen=True, eq=False)
class Direction(_Sampled, Frozen):
    """What a history has in one horizontal direction, as in `Trace`: (samples, ...)."""

    ground_acceleration: Array
    cap_beam_displacement: Array
    floor_displacements: Array
    floor_velocities: Array
    floor_accelerations: Array
    drifts: Array
    storey_shears: Array
    driving_moment: Array
    shear_top: Array
    shear_bottom: Array


@dataclass(frozen=True, eq=False, repr=False)
class Trace(_Sampled, Shown):
    """Histories at the record's samples and on through the free vibration, SI units.

    What was largest between samples, and on both sides of impacts, is in the largest demands, not
    here.

    Arrays are (samples,), those of floors and storeys (samples, n) from the bottom. Displacements
    and velocities are relative to the ground.

    Parameters
    ----------
    time, ground_acceleration
        Since the start of the record [s]; a_g [m/s2].
    rotation, rotation_rate
        theta [rad], theta' [rad/s].
    phase
        0 in full contact, 1 rolling, 2 rocking, 3 held by friction, 4 in compliant
        full contact.
    cap_beam_displacement, lift
        u_b and v_b [m].
    floor_displacements, floor_velocities, floor_accelerations
        [m], [m/s], and absolute [m/s2].
    drifts, storey_shears
        d_i [m], k_i d_i [N].
    driving_moment
        What the ground and the building do about the contact points, 2 R C (V - (N m_c/2 + m_b)
        a_g) [N m]; in slow motion without devices it equals the restoring moment 2 R W s B(x).
    shear_top, shear_bottom, normal_top, normal_bottom
        Forces at the ends of all columns together [N]: F to the right on what is above, N upwards
        on it (Theory (8.4), (8.5)).
    energy_input, energy_damped, energy_impact, energy_bed, energy_stored
        [J] (Theory, sections 8 and 12).
    devices
        What each device does.
    azimuth, azimuth_rate, y
        Where both horizontal components act: phi [rad], from x towards y, and phi' [rad/s] of the
        tilt, whose size `rotation` then is; and what the history has in y. All else that has a
        direction is in x. Forces of the columns are those of the smooth motion, which in a pass
        near upright that is shorter than an impact may be large for an instant.
    """

    time: Array
    ground_acceleration: Array
    rotation: Array
    rotation_rate: Array
    phase: NDArray[np.int8]
    cap_beam_displacement: Array
    lift: Array
    floor_displacements: Array
    floor_velocities: Array
    drifts: Array
    storey_shears: Array
    floor_accelerations: Array
    driving_moment: Array
    shear_top: Array
    shear_bottom: Array
    normal_top: Array
    normal_bottom: Array
    energy_input: Array
    energy_damped: Array
    energy_impact: Array
    energy_bed: Array
    energy_stored: Array
    devices: DeviceTrace
    azimuth: Array | None = None
    azimuth_rate: Array | None = None
    y: Direction | None = None

    def size(self, name: str) -> Array:
        """Of what has a direction: its absolute value, or sqrt(x^2 + y^2)."""
        in_x = getattr(self, name)
        return np.asarray(np.abs(in_x) if self.y is None else np.hypot(in_x, getattr(self.y, name)))


ENERGIES = ("energy_input", "energy_damped", "energy_impact", "energy_stored")


def sampled(structure: PodiumStructure, t: Trace) -> Iterator[tuple[str, str, NDArray[Any]]]:
    """Name, SI unit and samples of each quantity, for tables."""
    # Largest results may lie between the rows. Displacements are relative to the ground, floor
    # accelerations absolute. Forces are those of one column, F to the right and N upwards on what
    # is above; of all columns together where the case does not give their number. Devices' energy
    # is what they dissipated so far, of a damped stop that has let go as the cap beam moves back to
    # the gap. Where both components act, what has a direction stands in x and in y.
    ways: list[tuple[str, Trace | Direction]] = (
        [("", t)] if t.y is None else [("_x", t), ("_y", t.y)]
    )
    yield "time", "s", t.time
    yield from ((f"ground_acceleration{way}", "m/s2", of.ground_acceleration) for way, of in ways)
    yield "rotation", "rad", t.rotation
    if t.azimuth is not None and t.azimuth_rate is not None:
        yield "azimuth", "rad", t.azimuth
        yield "azimuth_rate", "rad/s", t.azimuth_rate
        yield "rotation_x", "rad", t.rotation * np.cos(t.azimuth)
        yield "rotation_y", "rad", t.rotation * np.sin(t.azimuth)
    yield "rotation_rate", "rad/s", t.rotation_rate
    for way, of in ways:
        yield f"cap_beam_displacement{way}", "m", of.cap_beam_displacement
    yield "lift", "m", t.lift
    for name, unit, field in (
        ("floor_{}_displacement", "m", "floor_displacements"),
        ("storey_{}_drift", "m", "drifts"),
        ("storey_{}_shear", "N", "storey_shears"),
        ("floor_{}_acceleration", "m/s2", "floor_accelerations"),
    ):
        for way, of in ways:
            for i, column in enumerate(getattr(of, field).T, start=1):
                yield name.format(i) + way, unit, column
    yield from ((f"driving_moment{way}", "N m", of.driving_moment) for way, of in ways)
    for end in ("top", "bottom"):
        for way, of in ways:
            yield f"column_shear_{end}{way}", "N", getattr(of, f"shear_{end}") / structure.columns
    yield "column_force_top", "N", t.normal_top / structure.columns
    yield "column_force_bottom", "N", t.normal_bottom / structure.columns
    yield from ((name, "J", getattr(t, name)) for name in ENERGIES)
    if structure.bed is not None:
        yield "energy_bed", "J", t.energy_bed
    for index, device in enumerate(structure.devices):
        name = f"device_{index}_{device.kind}"
        yield f"{name}_force", "N", t.devices.force[:, index]
        yield f"{name}_displacement", "m", t.devices.displacement[:, index]
        yield f"{name}_energy", "J", t.devices.energy[:, index]
    yield "phase", "-", t.phase


def trace_of(structure: PodiumStructure, run: SampledHistory) -> Trace:
    """Histories from what the kernel stored, at samples or between them as well."""
    samples = run.samples
    devices = DeviceTrace(*np.moveaxis(run.devices, 1, 0))
    found = _by_blocks(lambda rows: _derived(structure, run, devices, rows), len(samples))
    in_y = {name[2:]: found.pop(name) for name in [*found] if name.startswith("y.")}
    return Trace(
        time=np.arange(len(samples), dtype=np.float64) * run.motion.dt,
        rotation=samples.theta,
        rotation_rate=samples.theta_dot,
        phase=samples.phase.astype(np.int8),
        energy_input=samples.energy_input,
        energy_damped=samples.energy_damped,
        energy_impact=samples.energy_lost,
        energy_bed=samples.bed_energy,
        devices=devices,
        azimuth=samples.azimuth if in_y else None,
        azimuth_rate=samples.turning if in_y else None,
        y=Direction(**in_y) if in_y else None,
        **found,
    )


def _by_blocks(derived: Callable[[slice], dict[str, Array]], samples: int) -> dict[str, Array]:
    """Arrays over all samples, of which only a block at a time is in the making."""
    whole: dict[str, Array] = {}
    for first in range(0, samples, BLOCK):
        rows = slice(first, min(first + BLOCK, samples))
        for name, part in derived(rows).items():
            if name not in whole:
                whole[name] = np.empty((samples, *part.shape[1:]))
            whole[name][rows] = part
    return whole


class _Beam(NamedTuple):
    """Of the cap beam in one direction, relative to the ground, and what pushes it (samples,)."""

    displacement: Array
    velocity: Array
    acceleration: Array
    push: Array


def _derived(
    structure: PodiumStructure, run: SampledHistory, all_devices: DeviceTrace, rows: slice
) -> dict[str, Array]:
    """What follows from some samples, by the names of `Trace`; what is in y begins with `y.`."""
    # Imported here: numba is slow, and the command line imports this module's classes.
    from rpscli.physics.planar.equation_of_motion import cap_beam_acceleration

    samples, devices, motion = run.samples[rows], all_devices.at(rows), run.motion
    theta, rate = samples.theta, samples.theta_dot
    b, diameter = structure.bearing, 2.0 * structure.bearing.semi_diagonal
    B, C, path, lift = geometry.path_along(b.rolling, b.rocking, b.beta, np.abs(theta))
    potential, B_v = lift, B
    if (bed := structure.bed) is not None:
        on_bed = bed.path(np.abs(theta))
        B, C = np.where(samples.phase == state.BEDDED, 0.0, B), on_bed.height
        path, lift, potential = on_bed.displacement, on_bed.lift, on_bed.potential
        B_v = on_bed.lift_arm
    push, pull = np.zeros_like(theta), np.zeros_like(theta)
    for i, device in enumerate(structure.devices):
        to_the_right, down = device.beam_forces(structure, theta, devices.force[:, i])
        push, pull = push + to_the_right, pull + down
    side = np.sign(theta) + (theta == 0.0) * np.sign(samples.theta_ddot)
    c = np.where(samples.phase == state.ROLLING, b.rolling.c, b.rocking.c)
    moves = samples.phase != state.FULL_CONTACT
    across, upwards = (
        np.where(moves, acceleration, 0.0)
        for acceleration in cap_beam_acceleration(
            side, diameter, c, B, C, rate, side * samples.theta_ddot
        )
    )
    if bed is not None:
        upwards = diameter * (B_v * side * samples.theta_ddot + on_bed.lift_bend * rate**2)
    moving = devices.stored.sum(axis=1) + 0.5 * tilting_inertia(structure, B_v, C) * rate**2
    base, base_rate = diameter * np.sign(theta) * path, diameter * C * rate
    beams = {"": _Beam(base, base_rate, across, push)}
    if motion.y is not None:
        # Along the tilt as in one plane; going round adds what turns with it.
        w = samples.turning
        moving = moving + 0.5 * turning_inertia(structure, np.abs(theta), path) * w**2
        away = across - np.where(moves, diameter * path * w**2, 0.0)
        aside = diameter * (path * samples.turning_rate + 2.0 * C * rate * w)
        aside = np.where(moves, aside, 0.0)
        cosine, sine = np.cos(samples.azimuth), np.sin(samples.azimuth)
        beams = {
            way: _Beam(base * r, base_rate * r + base * w * t, away * r + aside * t, pushed)
            for way, r, t, pushed in (
                ("", cosine, -sine, samples.push_x),
                ("y.", sine, cosine, samples.push_y),
            )
        }
    found: dict[str, Array] = {}
    strained, swinging = np.zeros_like(theta), np.zeros_like(theta)
    for way, beam in beams.items():
        in_way, energies = _in_direction(structure, run, rows, beam, diameter * C, across=bool(way))
        strained, swinging = strained + energies[0], swinging + energies[1]
        found |= {way + name: values for name, values in in_way.items()}
    g_up = structure.gravity + _ground(motion, "vertical", rows, len(samples))
    carried = structure.cap_beam_mass + structure.superstructure_mass
    normal = carried * (g_up + upwards) + pull
    return found | {
        "lift": diameter * lift,
        "normal_top": normal,
        "normal_bottom": normal + structure.columns_mass * (g_up + 0.5 * upwards),
        "energy_stored": structure.weight * diameter * potential + strained + moving + swinging,
    }


def _in_direction(
    structure: PodiumStructure,
    run: SampledHistory,
    rows: slice,
    beam: _Beam,
    height: Array,
    *,
    across: bool,
) -> tuple[dict[str, Array], tuple[Array, Array]]:
    """By the names of `Direction`, in x or across it; energies of the building's strain and motion.

    `height` is 2 R C, the height of the thrust lines [m].
    """
    n, building = structure.storeys, structure.superstructure
    floors = run.floors[rows, :, :n]
    if across:
        floors, building = run.floors[rows, :, n:], structure.superstructure_y or building
    a_g = _ground(run.motion, "y" if across else "horizontal", rows, len(beam.push))
    u, du = floors[:, 0], floors[:, 1]
    drifts = np.diff(u, axis=1, prepend=beam.displacement[:, None])
    shears, forces = np.zeros_like(u), np.zeros_like(u)
    swinging = np.zeros_like(beam.push)
    if building is not None:
        shears = building.stiffnesses * drifts
        forces = (u - beam.displacement[:, None]) @ building.stiffness_matrix
        forces = forces + (du - beam.velocity[:, None]) @ building.damping_matrix
        swinging = 0.5 * du**2 @ building.masses
    V = forces.sum(axis=1)
    top = structure.cap_beam_mass * (beam.acceleration + a_g) - (V + beam.push)
    base_mass = 0.5 * structure.columns_mass + structure.cap_beam_mass
    return {
        "ground_acceleration": a_g,
        "cap_beam_displacement": beam.displacement,
        "floor_displacements": u,
        "floor_velocities": du,
        "floor_accelerations": forces if building is None else -forces / building.masses,
        "drifts": drifts,
        "storey_shears": shears,
        "driving_moment": height * (V - base_mass * a_g),
        "shear_top": top,
        "shear_bottom": top + structure.columns_mass * (0.5 * beam.acceleration + a_g),
    }, (0.5 * np.sum(shears * drifts, axis=1), swinging)


def _ground(motion: MotionComponents, component: str, rows: slice, count: int) -> Array:
    """A component of the ground's acceleration at some samples [m/s2]; 0 where it is not known."""
    row = motion.row(component)
    return np.zeros(count) if row is None else prolonged(motion.samples[row, rows], count)


def prolonged(acceleration: Array, samples: int) -> Array:
    """The acceleration at so many samples [m/s2]: zero after the record's end."""
    length = min(samples, len(acceleration))
    return np.pad(acceleration[:length], (0, samples - length))


def tilting_inertia(structure: PodiumStructure, B: Array, C: Array) -> Array:
    """N m_c R^2 A(x) along a path (samples,) [kg m2]."""
    from rpscli.physics.planar.equation_of_motion import inertia

    io_1, beam = structure.bearing.inertia_ratio - 1.0, 4.0 * structure.gamma
    A = inertia(io_1, 1.0 + beam, beam * structure.eta, B**2 + C**2, B)
    return np.asarray(structure.columns_mass * structure.bearing.semi_diagonal**2 * A)


def turning_inertia(structure: PodiumStructure, x: Array, path: Array) -> Array:
    """N m_c R^2 J(x) along a path u = |u_b|/2R (samples,) [kg m2] (Theory (13.3))."""
    b = structure.bearing
    y, (sin_alpha, _, k, _, _) = np.minimum(x, b.beta), b.rolling
    spin = k * (y - np.sin(y)) / (sin_alpha + k * np.sin(y)) if b.beta > 0.0 else 0.0
    G = 1.0 - np.cos(x) + spin
    J = (b.inertia_ratio - 1.0) * np.sin(x) ** 2 + b.inertia_ratio_axial * G**2
    J = J + (1.0 + 4.0 * structure.gamma) * path**2
    return np.asarray(structure.columns_mass * b.semi_diagonal**2 * J)
