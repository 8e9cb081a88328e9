"""Samples and events of a history, and what its devices saw: the
kernel's records in words.

>>> from rpscli.physics import state
>>> EVENT_NAMES[state.UPLIFT], EVENT_NAMES[state.OVERTURNING], EVENT_NAMES[state.TENDON_TAUT]
('uplift', 'overturning', 'tendon_taut')
>>> len(EVENT_NAMES) == state.EVENT_KINDS
True
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields
from typing import Any, Literal, Self, TypeAlias, get_args

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.kernels.history import SampledHistory
from rpscli.model.podium import Array, PodiumStructure
from rpscli.physics.interface import EVENT
from rpscli.physics.state import Record
from rpscli.shown import Frozen, Shown

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
"""By the codes of the kernel."""


@dataclass(frozen=True)
class Event:
    """One event of a history."""

    time: float  # Since the start of the record [s]
    kind: EventKind  # Name of the event
    rotation: float  # theta [rad]
    rotation_rate_before: float
    rotation_rate_after: float  # theta' [rad/s]
    energy_lost: float  # [J], negative where an impact created energy
    azimuth: float | None = None
    """Of the tilt, from x towards y [rad]; None where one component acts."""
    least_tilt: float | None = (
        None  # Of a pass near upright: theta_min [rad]; of others 0
    )
    nearness: float | None = None
    """Of a pass: s, the time it takes over that of an impact;
    infinite if that takes none."""
    loss_share: float | None = None  # Of a pass: l, how much of what an impact would lose


def event_list(log: Record, *, both: bool) -> tuple[Event, ...]:
    """Events from the rows of the kernel's log, under both components or one."""
    known = len(EVENT) if both else 6
    rows = (row[:known] for row in log.tolist())
    return tuple(Event(time, EVENT_NAMES[kind], *values) for time, kind, *values in rows)


@dataclass(frozen=True)
class DeviceDemand:
    """Largest demands of one device.

    Looked at within steps and on both sides of events: the samples of a
    `DeviceTrace` may be less.
    """

    kind: str  # Name of its law
    force: float
    """At the cap beam [N]: of a tendon the tension of one, of rolling resistance the
    horizontal force that does the same."""
    stroke: float  # |u_b| [m]; of a tendon its elongation
    velocity: float  # Rate of the stroke [m/s]
    energy: float  # Dissipated, by all tendons together [J]
    remaining_prestress: (
        float | None
    )  # Of a tendon at the end, upright [N]; None of others


class _Sampled:
    """Base of dataclasses with a value at each sample in every field, or None."""

    def at(self, rows: Rows) -> Self:
        """Only some samples."""
        values = {each.name: getattr(self, each.name) for each in fields(self)}  # type: ignore[arg-type]
        parts = {
            name: of.at(rows)
            if isinstance(of, _Sampled)
            else of
            if of is None
            else of[rows]
            for name, of in values.items()
        }
        return type(self)(**parts)


@dataclass(frozen=True, eq=False)
class DeviceTrace(_Sampled, Frozen):
    """Forces, displacements and energies of devices at the samples:
    arrays (samples, devices).
    """

    force: Array
    """On the cap beam, positive to the right, of pairs outwards [N];
    of a tendon the tension."""
    displacement: (
        Array  # u_b [m], under both components |u_b|; of a tendon the elongation of one
    )
    energy: Array
    """Dissipated so far [J]. A damped stop that has let go dissipates what its
    spring still holds as the cap beam moves back to the gap, not at once: sums
    over an excursion are exact."""
    stored: Array
    """Energy over what was stored at rest [J]; of a stop `k_s (|u_b|
    - d)^2/2`, let go or not."""


@dataclass(frozen=True, eq=False, repr=False)
class DirectionTrace(_Sampled, Shown):
    """Part of a trace in one horizontal direction: arrays (samples, ...)."""

    ground_acceleration: Array  # a_g [m/s2]
    cap_beam_displacement: Array  # u_b [m]
    floor_displacements: Array  # relative to the ground [m]
    floor_velocities: Array  # likewise [m/s]
    floor_accelerations: Array  # absolute [m/s2]
    drifts: Array  # d_i [m]
    plastic_drifts: Array | None  # delta_i [m]; None of elastic storeys
    storey_shears: Array  # k_i (d_i - delta_i) [N]
    driving_moment: (
        Array  # 2 R C (V - (N m_c/2 + m_b) a_g) [N m]; in slow motion 2 R W s B(x)
    )
    shear_top: (
        Array  # of all columns together [N], to the right on what is above (Theory (8.4))
    )
    shear_bottom: Array  # [N]


@dataclass(frozen=True, eq=False, repr=False)
class Trace(DirectionTrace):
    """Histories at the record's samples and on through the free vibration, SI units.

    Arrays are (samples,), those of floors and storeys (samples, n) from the bottom. What
    was largest between samples, and on both sides of impacts, is in the largest demands.
    Forces of columns are those of the smooth motion, which in a pass near upright that is
    shorter than an impact may be large for an instant.
    """

    time: Array  # since the start of the record [s]
    rotation: Array  # theta [rad]
    rotation_rate: Array  # theta' [rad/s]
    phase: NDArray[np.int8]  # 0 in full contact, 1 rolling, 2 rocking, 3 held, 4 on a bed
    lift: Array  # v_b [m]
    normal_top: (
        Array  # of all columns together [N], upwards on what is above (Theory (8.5))
    )
    normal_bottom: Array  # [N]
    energy_input: Array  # [J], as all energies (Theory, sections 8 and 12)
    energy_damped: Array
    energy_damped_vertical: Array
    energy_impact: Array
    energy_bed: Array
    energy_yielded: Array
    energy_stored: Array
    devices: DeviceTrace
    azimuth: Array | None = None  # of the tilt of both components, from x towards y [rad]
    azimuth_rate: Array | None = None  # [rad/s]
    y: DirectionTrace | None = (
        None  # what a history of both components has in y; the rest is in x
    )
    vertical_accelerations: Array | None = None  # absolute, of floors on springs [m/s2]

    def size(self, name: str) -> Array:
        """Of what has a direction: its absolute value, or sqrt(x^2 + y^2)."""
        in_x = getattr(self, name)
        return np.asarray(
            np.abs(in_x) if self.y is None else np.hypot(in_x, getattr(self.y, name))
        )


ENERGIES = ("energy_input", "energy_damped", "energy_impact", "energy_stored")


Sampled: TypeAlias = tuple[str, str, NDArray[Any]]


def sampled(structure: PodiumStructure, t: Trace) -> Iterator[Sampled]:
    """Name, SI unit and samples of each quantity, for tables."""
    # Largest results may lie between the rows. Displacements are relative to the ground,
    # floor accelerations absolute. Forces are those of one column, F to the right and N
    # upwards on what is above; of all columns together where the case does not give their
    # number. Devices' energy is what they dissipated so far, of a damped stop that has
    # let go as the cap beam moves back to the gap. Where both components act, what has a
    # direction stands in x and in y.
    columns = structure.columns
    yield "time", "s", t.time
    yield from _directed(t, "ground_acceleration", "m/s2", "ground_acceleration")
    yield from _sampled_rotation(t)
    yield from _directed(t, "cap_beam_displacement", "m", "cap_beam_displacement")
    yield "lift", "m", t.lift
    yield from _sampled_storeys(structure, t)
    yield from _directed(t, "driving_moment", "N m", "driving_moment")
    yield from _directed(t, "column_shear_top", "N", "shear_top", columns)
    yield from _directed(t, "column_shear_bottom", "N", "shear_bottom", columns)
    yield "column_force_top", "N", t.normal_top / columns
    yield "column_force_bottom", "N", t.normal_bottom / columns
    yield from _sampled_energies(structure, t)
    for index, device in enumerate(structure.devices):
        name = f"device_{index}_{device.kind}"
        yield f"{name}_force", "N", t.devices.force[:, index]
        yield f"{name}_displacement", "m", t.devices.displacement[:, index]
        yield f"{name}_energy", "J", t.devices.energy[:, index]
    yield "phase", "-", t.phase


def _directed(
    t: Trace, name: str, unit: str, field: str, over: int = 1
) -> Iterator[Sampled]:
    """A field of each direction, and of each floor from the bottom, over a number."""
    ways: list[tuple[str, DirectionTrace]] = (
        [("", t)] if t.y is None else [("_x", t), ("_y", t.y)]
    )
    for way, of in ways:
        values = getattr(of, field)
        for i, column in enumerate(np.atleast_2d(values.T), start=1):
            yield name.format(i) + way, unit, column if over == 1 else column / over


def _sampled_rotation(t: Trace) -> Iterator[Sampled]:
    """The tilt of the columns, and where both components act its azimuth and parts."""
    yield "rotation", "rad", t.rotation
    if t.azimuth is not None and t.azimuth_rate is not None:
        yield "azimuth", "rad", t.azimuth
        yield "azimuth_rate", "rad/s", t.azimuth_rate
        yield "rotation_x", "rad", t.rotation * np.cos(t.azimuth)
        yield "rotation_y", "rad", t.rotation * np.sin(t.azimuth)
    yield "rotation_rate", "rad/s", t.rotation_rate


def _sampled_storeys(structure: PodiumStructure, t: Trace) -> Iterator[Sampled]:
    """Displacements, drifts, shears and accelerations of floors and storeys."""
    yield from _directed(t, "floor_{}_displacement", "m", "floor_displacements")
    yield from _directed(t, "storey_{}_drift", "m", "drifts")
    if structure.yields:
        yield from _directed(t, "storey_{}_plastic_drift", "m", "plastic_drifts")
    yield from _directed(t, "storey_{}_shear", "N", "storey_shears")
    yield from _directed(t, "floor_{}_acceleration", "m/s2", "floor_accelerations")
    if (upwards := t.vertical_accelerations) is not None:
        for i, column in enumerate(upwards.T, start=1):
            yield f"floor_{i}_vertical_acceleration", "m/s2", column


def _sampled_energies(structure: PodiumStructure, t: Trace) -> Iterator[Sampled]:
    """Energies of every structure, then those of some."""
    of_some = {
        "energy_damped_vertical": structure.upwards is not None,
        "energy_bed": structure.bed is not None,
        "energy_yielded": structure.yields,
    }
    for name in (*ENERGIES, *(name for name, known in of_some.items() if known)):
        yield name, "J", getattr(t, name)


def trace_of(structure: PodiumStructure, run: SampledHistory) -> Trace:
    """Histories from what the kernel stored, at samples or between them as well."""
    samples = run.samples
    motion = run.motion
    pairs = motion.y is not None
    return Trace(
        time=np.arange(len(samples), dtype=np.float64) * motion.dt,
        rotation=samples.theta,
        rotation_rate=samples.theta_dot,
        phase=samples.phase.astype(np.int8),
        lift=samples.lift,
        normal_top=samples.normal_top,
        normal_bottom=samples.normal_bottom,
        energy_input=samples.energy_input,
        energy_damped=samples.energy_damped,
        energy_damped_vertical=samples.energy_upwards,
        energy_impact=samples.energy_lost,
        energy_bed=samples.energy_bed,
        energy_yielded=samples.energy_yielded,
        energy_stored=samples.energy_stored,
        devices=DeviceTrace(*np.moveaxis(run.devices, 1, 0)),
        azimuth=samples.azimuth if pairs else None,
        azimuth_rate=samples.turning if pairs else None,
        y=DirectionTrace(**_in_direction(structure, run, 1)) if pairs else None,
        vertical_accelerations=None
        if structure.upwards is None
        else run.floors[:, 2, -structure.storeys :],
        **_in_direction(structure, run, 0),
    )


def _in_direction(
    structure: PodiumStructure, run: SampledHistory, axis: int
) -> dict[str, Array]:
    """By the names of `DirectionTrace`, in x or in y."""
    n = structure.storeys
    samples = run.samples
    building = structure.superstructure
    if axis == 1:
        building = structure.superstructure_y or building
    floors = run.floors[:, :, axis * n : (axis + 1) * n]
    row = run.motion.row("y" if axis else "horizontal")
    a_g = prolonged(run.motion.samples[row], len(samples))
    beam = samples.beam[:, axis]
    drifts = np.diff(floors[:, 0], axis=1, prepend=beam[:, None])
    plastic = floors[:, 3] if structure.yields else None
    elastic = drifts if plastic is None else drifts - plastic
    base_mass = 0.5 * structure.columns_mass + structure.cap_beam_mass
    return {
        "ground_acceleration": a_g,
        "cap_beam_displacement": beam,
        "floor_displacements": floors[:, 0],
        "floor_velocities": floors[:, 1],
        "floor_accelerations": floors[:, 2],
        "drifts": drifts,
        "plastic_drifts": plastic,
        "storey_shears": elastic if building is None else building.stiffnesses * elastic,
        "driving_moment": samples.height
        * (samples.base_shear[:, axis] - base_mass * a_g),
        "shear_top": samples.shear_top[:, axis],
        "shear_bottom": samples.shear_bottom[:, axis],
    }


def prolonged(acceleration: Array, samples: int) -> Array:
    """The acceleration at so many samples [m/s2]: zero after the record's end."""
    length = min(samples, len(acceleration))
    return np.pad(acceleration[:length], (0, samples - length))
