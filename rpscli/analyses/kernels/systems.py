"""Structures and settings as the kernels read them, and how long their steps may be."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from rpscli.analyses.settings import LONGEST_FREE_VIBRATION, TimeHistorySettings
from rpscli.model.contact import Bed
from rpscli.model.devices import DEVICES, OwnDamper
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import Superstructure
from rpscli.physics.interface import SYSTEM
from rpscli.physics.records import record_type, records
from rpscli.physics.state import Record
from rpscli.records.ground_motion import MotionComponents

DEVICE_KINDS = {kind: code for code, kind in enumerate((*DEVICES.values(), OwnDamper))}
"""Codes of laws in the kernels."""

LEAST_SHAKEN = 1e-3
"""Modes that hardly take part are not given more weight than
those that take part so much."""


UPLIFT_TILT = 1e-12
"""Tilt with which an uplift to any side begins [rad]: maxima err in proportion to it, by
less than the steps at `accuracy` 4.
"""

SYSTEMS_KEPT = 128
"""Records of systems that are kept: to make one takes longer than to
copy what of it is used."""

STACKS_KEPT = 4
"""Records of many systems that are kept: the batches of a study share them."""

_PLAIN = record_type(SYSTEM)
_SQUARE = ("phi", "storey_shear_of")
"""Matrices of modes, most of a record, which stand together; of
few storeys little is used."""


def stacked_systems(
    systems: Sequence[tuple[PodiumStructure, TimeHistorySettings]], *, pairs: bool = False
) -> Record:
    """Structures with as many storeys and axes, each with its settings:
    (S axes,) records to read.

    Of each that in x comes first, then where both components act that in y, which planar
    ones refuse, then that upwards of floors on springs.
    """
    every = []
    for structure, settings in systems:
        if pairs and (why := structure.planar_only):
            raise ValueError(f"both horizontal components: {why}")
        every += [(each, settings) for each in directions(structure, pairs=pairs)]
    if len(every) == 1:
        return _system(*every[0])
    axes = len(every) // len(systems)
    stacked = _stacked(tuple(every), axes)
    rows = stacked.view(_PLAIN, np.ndarray)
    # one length of step for all of them
    for rate in ("step_rate", "bedded_rate"):
        rows[rate] = np.repeat(rows[rate].reshape(-1, axes).max(axis=1), axes)
    if pairs:
        rows["step_error"] = [
            step_error(settings, 1.0 if structure.passes_smoothly else PASSES_ERROR)
            for structure, settings in every
        ]
    return stacked


def directions(structure: PodiumStructure, *, pairs: bool) -> list[PodiumStructure]:
    """The structure in x, in y where both components act, and
    upwards on vertical springs.
    """
    upwards = [] if structure.upwards is None else [structure.upwards]
    return [structure, *[structure.across] * pairs, *upwards]


@lru_cache(STACKS_KEPT)
def _stacked(
    systems: tuple[tuple[PodiumStructure, TimeHistorySettings], ...], axes: int
) -> Record:
    stacked = records(SYSTEM, count=len(systems))
    n = systems[0][0].storeys
    rows = stacked.view(_PLAIN, np.ndarray)
    places = [_PLAIN.fields[name][1] for name in _SQUARE]  # type: ignore[index]
    before = min(places)
    behind = max(places) + _PLAIN[_SQUARE[0]].itemsize
    into = rows.view(np.uint8).reshape(len(systems), -1)
    for row, (structure, settings) in enumerate(systems):
        plain = _system(structure, settings).view(_PLAIN, np.ndarray)
        numbers = plain.view(np.uint8)
        into[row, :before] = numbers[:before]
        into[row, behind:] = numbers[behind:]
        for name in _SQUARE:
            rows[name][row, :n, :n] = plain[name][0, :n, :n]
    rows["axes"] = axes
    return stacked


@lru_cache(SYSTEMS_KEPT)
def _system(structure: PodiumStructure, settings: TimeHistorySettings) -> Record:
    """One structure with its settings, (1,)."""
    system = records(SYSTEM)
    record = system.view(_PLAIN, np.ndarray)[0]  # attributes take ten times as long
    fill_podium(record, structure)
    fill_settings(record, structure, settings)
    if structure.superstructure is not None:
        fill_building(record, structure.superstructure)
    return system


def fill_podium(record: Record, structure: PodiumStructure) -> None:
    """The rocking storey, its devices with the constants of their
    laws, and what it stands on.
    """
    b = structure.bearing
    record["n"] = structure.storeys
    record["axes"] = 1
    record["R"] = b.semi_diagonal
    record["alpha"] = b.alpha
    record["beta"] = b.beta
    record["theta_cr"] = b.critical_rotation
    record["rolling"] = b.rolling
    record["rocking"] = b.rocking
    record["Io"] = b.inertia_ratio
    record["gamma"] = structure.gamma
    record["eta"] = structure.eta
    record["columns_mass"] = structure.columns_mass
    record["cap_beam_mass"] = structure.cap_beam_mass
    record["floors_mass"] = structure.superstructure_mass
    record["gravity"] = structure.gravity
    record["restitution"] = structure.restitution
    record["inertia_axial"] = b.inertia_ratio_axial
    record["contact_time"] = structure.impact_law.contact_time
    record["shock_time"] = structure.shock_time
    record["floors_jump"] = structure.impact_law.floors_jump
    record["columns"] = structure.columns
    _fill_own_impact(record, structure.impact_law)
    _fill_devices(record, structure)
    if structure.bed is not None:
        _fill_bed(record, structure.bed)


def _fill_own_impact(record: Record, impact: ImpactLaw) -> None:
    """The impact law of another package, if it is of one."""
    if (own := impact.own) is None:
        return
    from rpscli.physics.own_laws import address_of  # few have such

    numbers = impact.factor * (1.0 - impact.loss), impact.factor * impact.loss
    record["impact_law"] = address_of(own.restitution, own.taken()[own.restitution])
    record["impact_constants"][: 2 + len(impact.constants)] = (
        *numbers,
        *impact.constants,
    )


def _fill_devices(record: Record, structure: PodiumStructure) -> None:
    """Kinds and constants of the devices, and the laws of other packages."""
    record["devices"] = len(structure.devices)
    for i, device in enumerate(structure.devices):
        record["device_kind"][i] = DEVICE_KINDS[type(device)]
        constants = device.constants(structure)
        record["device_constants"][i, : len(constants)] = constants
        if isinstance(device, OwnDamper):
            from rpscli.physics.own_laws import address_of

            law = device.law
            taken = device.law.taken()
            watched = (
                0 if law.watched is None else address_of(law.watched, taken[law.watched])
            )
            record["own_law"][i, 0] = address_of(law.force, taken[law.force])
            record["own_law"][i, 1:] = watched, law.linear is None


def _fill_bed(record: Record, bed: Bed) -> None:
    """Compliant full contact, from which the arms of both phases go on."""
    record["compliant"] = 1
    record["bed_uplift"] = bed.uplift_rotation
    record["bed_full"] = bed.full_rotation
    record["bed_height"] = bed.height
    record["bed_k"] = bed.spring
    record["bed_c"] = bed.damper
    record["sink"] = bed.sink
    record["root"] = bed.root
    record["lifts"] = bed.kept
    for phase in ("rolling", "rocking"):  # u_b goes on from there
        record[phase][3] += bed.shift


def fill_settings(
    record: Record, structure: PodiumStructure, settings: TimeHistorySettings
) -> None:
    """Limits and steps; refuse a start beyond the overturning limit, or
    a model that ends there.
    """
    critical = structure.critical_rotation
    end = structure.bearing.largest_rotation
    limit = settings.overturning_limit * critical
    if limit > end:
        raise ValueError(
            f"overturning_limit = {settings.overturning_limit:.6g} times theta_cr must"
            f" not exceed {end:.6g} rad, where the columns lie down; use less than"
            f" {end / critical:.4g}"
        )
    if abs(settings.initial_rotation) >= limit:
        raise ValueError(
            f"initial_rotation = {settings.initial_rotation:.6g} rad must stay below the"
            f" overturning limit {limit:.6g} rad"
        )
    record["theta_limit"] = limit
    record["step_rate"] = settings.accuracy * uplifted_rate(structure)
    record["bedded_rate"] = settings.accuracy * bedded_rate(structure)
    if structure.bed is not None:
        structure.bed.refuse_start(settings.initial_rotation)
    record["most_steps"] = MOST_POWER_STEPS
    record["linear_speed"] = linear_speed(structure, settings.accuracy)
    speed = math.sqrt(structure.gravity * structure.bearing.semi_diagonal)
    record["start_speed"] = START_SPEED * speed / settings.accuracy**2
    record["step_error"] = step_error(settings)
    record["recontact_tolerance"] = settings.recontact_tolerance
    record["max_events"] = settings.max_events
    record["uplift_tilt"] = UPLIFT_TILT
    record["initial_rotation"] = settings.initial_rotation
    record["free_vibration"] = longest_free_vibration(structure, settings)
    record["until_rest"] = settings.free_vibration is None


def fill_building(record: Record, building: Superstructure) -> None:
    """The modes of the fixed base, mass-normalised, with the storey shears of each."""
    # Any weights would do for `physics.floors`; these let the fewest steps pass the
    # bound.
    n = record["n"] = building.storeys
    omega = building.frequencies
    xi = building.damping_ratios
    shapes = building.shapes.T
    omega2 = omega * omega
    shaken = np.abs(building.participation)
    shaken = np.maximum(shaken, LEAST_SHAKEN * shaken.max())
    shears = np.diff(shapes, prepend=0.0) * building.stiffnesses
    record["omega"][:n] = omega
    record["Gamma"][:n] = building.participation
    record["omega2"][:n] = omega2
    record["two_xi_omega"][:n] = 2.0 * xi * omega
    record["phi"][:n, :n] = shapes
    record["storey_shear_of"][:n, :n] = shears
    of_shears = omega**3 * shaken**-0.3
    of_accelerations = omega**-0.6 * shaken**-0.5
    record["shear_weight"][:n] = of_shears
    record["acceleration_weight"][:n] = of_accelerations
    record["mass"][:n] = building.masses
    record["stiffness"][:n] = building.stiffnesses
    record["strength"][:n] = math.inf
    if building.strengths is not None:
        record["yields"] = 1
        record["strength"][:n] = building.strengths
        record["hardening"] = building.hardening
    record["bend_ratio"] = np.max(omega2 * omega2 * of_accelerations / of_shears)
    record["shear_bound_of"][:n] = np.sum(shears.T**2 / of_shears, axis=1) ** -0.5
    record["acceleration_bound_of"][:n] = (
        np.sum(shapes.T**2 / of_accelerations, axis=1) ** -0.5
    )


UPLIFTED_ANGLE = 0.9
"""Largest step times the highest uplifted frequency [rad], at accuracy 1."""

LOSS = 1.06e-5
"""A step of angle z takes this times z^8 from a vibration's
energy: of the rule of order 6."""

MOST_LOST = 5e-6
"""Part of its energy that steps may take from the fastest vibration, which has
`USUAL_SHARE` of all at most. It shortens the steps of buildings with less than some 7 %
of damping in their last mode, of one storey, whose only mode may have all energy, nearly
always: by that share and, since ground that changes from sample to sample gives and takes
more of it, by its square."""

USUAL_SHARE = 0.2
"""Effective mass of the last mode over all, which is its share of what impacts give: less
than this in nearly all buildings of several storeys."""

UPLIFTED_DECAY = 0.7
"""Largest step times the fastest decay rate, where that asks for more: at 1 the energy of
a building with 90 % of damping closes to 4e-6, which falls with the seventh power. The
rule is unstable beyond about 4."""

STEP_ERROR = 1e-7
"""Largest error of a step in the tilt's rate, over what that is and changes by, at
accuracy 1; as orders 6 and 5 differ. Steps made for the fastest of several modes hardly
ever come near. Where the tilt itself changes faster, over one storey, in large rotations
of short columns, past theta_cr under floors that weigh hundreds of them, or near
upright, they are shorter."""

PASSES_ERROR = 1 / 16
"""Of that under both components: the wobble of tall buildings at small tilts,
hundreds of passes each of which depends on the one before, ends too early with more.
Rotations ask for a quarter."""


def step_error(settings: TimeHistorySettings, share: float = 1.0) -> float:
    """Largest error of a step, over the velocities of the tilt;
    a share of the usual one.
    """
    return max(share * STEP_ERROR * settings.accuracy**-6, LEAST_ERROR)


LEAST_ERROR = 1e-12
"""Below it the difference of both rules is rounding: their weights are up to 176."""

STEP_SECONDS = 1.5e-6
MODE_SECONDS = 2e-7
STRENGTH_SECONDS = 2e-8
"""About the time of a step of one history, what each mode adds, and each
of a storey that yields.
"""


def uplifted_rate(structure: PodiumStructure) -> float:
    """Steps a second that follow the uplifted structure at accuracy 1 [1/s]."""
    stiffness = sum(device.bounds(structure)[0] for device in structure.devices)
    coefficient = sum(device.bounds(structure)[1] for device in structure.devices)
    mass = least_base_mass(structure)
    frequency = math.hypot(highest_frequency(structure), math.sqrt(stiffness / mass))
    decay = fastest_decay(structure) + coefficient / mass
    return max(frequency / uplifted_angle(structure), decay / UPLIFTED_DECAY)


LINEAR_SPEEDS = 1e-8, 1e-6
"""Of sqrt(g R): up to the first of these velocities a power of it is taken as linear, too
little to be felt; up to the second where the power would else decay faster than
`FASTEST_POWER`. Both at accuracy 1, which divides them."""

START_SPEED = 3e-6
"""Of sqrt(g R), over the accuracy's square: so fast a tilt to any side begins to slide.
More slowly friction turns its velocity to where it is pushed so soon that thousands of
steps would follow it. What is let go by a margin that falls by m' a second has a = m' t,
and so much after sqrt(2 v/m').
"""

FASTEST_POWER = 6e4
"""Of a power of the velocity: its decay rate where it is taken as linear, over
sqrt(g/R), if that can be had."""

MOST_POWER_STEPS = 5e8
"""Of one history whose dampers shorten its steps: some minutes."""


def powers(structure: PodiumStructure) -> list[tuple[float, float]]:
    """Coefficient and exponent of dampers whose force rises steeply about rest."""
    laws = (
        (getattr(d, "coefficient", 0.0), getattr(d, "exponent", 1.0))
        for d in structure.devices
    )
    return [(coefficient, exponent) for coefficient, exponent in laws if exponent < 1.0]


def linear_speed(structure: PodiumStructure, accuracy: float) -> float:
    """Up to this velocity of the cap beam a power of it is taken as linear [m/s]."""
    R = structure.bearing.semi_diagonal
    g = structure.gravity
    least, most = (share * math.sqrt(g * R) for share in LINEAR_SPEEDS)
    limit = FASTEST_POWER * math.sqrt(g / R) * least_base_mass(structure)
    speeds = [
        (c / limit) ** (1.0 / (1.0 - exponent)) for c, exponent in powers(structure)
    ]
    return float(min(max([least, *speeds]), most)) / accuracy


def steps_a_second(structure: PodiumStructure, accuracy: float = 1.0) -> float:
    """A bound on steps a second, with those that a power of the
    velocity asks for about rest.
    """
    speed = linear_speed(structure, accuracy)
    damping = sum(c * speed ** (exponent - 1.0) for c, exponent in powers(structure))
    about_rest = damping / least_base_mass(structure) / UPLIFTED_DECAY
    each = directions(structure, pairs=False)
    rate = max(max(bedded_rate(of), uplifted_rate(of)) for of in each)
    return float(accuracy * rate + about_rest)


def uplifted_angle(structure: PodiumStructure) -> float:
    """Largest step times the highest uplifted frequency [rad]."""
    # A step of angle z loses LOSS z^8 of a vibration's energy, thus w t z^7 of that in
    # the time t; what the dampers do not take in 1/(2 xi w) goes on for as long as
    # histories are followed.
    if (building := structure.superstructure) is None:
        return UPLIFTED_ANGLE
    damped = float(2.0 * building.damping_ratios[-1] * building.frequencies[-1])
    lasting = 1.0 / max(damped, 1.0 / LONGEST_FREE_VIBRATION)
    share = float(building.participation[-1] ** 2 / np.sum(building.participation**2))
    lost = MOST_LOST * (USUAL_SHARE / max(share, USUAL_SHARE)) ** 2
    drift = lost / (LOSS * highest_frequency(structure) * lasting)
    return float(min(UPLIFTED_ANGLE, drift ** (1.0 / 7.0)))


def most_steps(
    structure: PodiumStructure, settings: TimeHistorySettings, duration: float
) -> float:
    """Steps of a history that never comes to rest, but for those
    that events and errors add.
    """
    free = longest_free_vibration(structure, settings)
    return (duration + free) * steps_a_second(structure, settings.accuracy)


SWINGS = 2.0
"""Free vibration `auto` of columns that roll from rest and never come
to it, over their period."""


def longest_free_vibration(
    structure: PodiumStructure, settings: TimeHistorySettings
) -> float:
    """Longest time that a history may be followed after its record [s]."""
    if settings.free_vibration is not None:
        return settings.free_vibration
    period = structure.rolling_period
    return min(LONGEST_FREE_VIBRATION, math.inf if period is None else SWINGS * period)


def most_seconds(
    structure: PodiumStructure, settings: TimeHistorySettings, motion: MotionComponents
) -> float:
    """About the computing time of these [s]."""
    axes = len(directions(structure, pairs=motion.y is not None))
    above = structure.superstructure
    each = STEP_SECONDS + MODE_SECONDS * axes * structure.storeys
    if above is not None and above.strengths is not None:
        each += STRENGTH_SECONDS * axes * structure.storeys**2
    return each * most_steps(structure, settings, motion.duration)


def bedded_rate(structure: PodiumStructure) -> float:
    """Steps a second in compliant full contact [1/s]; 0 on rigid ends."""
    bed = structure.bed
    if bed is None:
        return 0.0
    stiffness = bed.stiffness
    decay = bed.damper / bed.inertia + fastest_decay(structure)
    highest = 0.0
    if (building := structure.superstructure) is not None:
        stiffness += float(building.stiffnesses[0])
        highest = float(building.frequencies[-1])
    frequency = math.hypot(highest, math.sqrt(stiffness / bed.mass))
    decay += sum(device.bounds(structure)[1] for device in structure.devices) / bed.mass
    return max(frequency / uplifted_angle(structure), decay / UPLIFTED_DECAY)


def highest_frequency(structure: PodiumStructure) -> float:
    """A bound on the frequencies of the uplifted structure [rad/s]."""
    # A free beam of at least N m_c Io/4 + m_b adds at most the first storey's spring over
    # that (Theory (10.5); Weyl's inequality).
    square = (structure.gravity / structure.bearing.semi_diagonal) * (
        1.0 + abs(2.0 * structure.bearing.curvature_ratio - 1.0)
    )
    if (building := structure.superstructure) is not None:
        base = building.stiffnesses[0] / least_base_mass(structure)
        square += float(building.frequencies[-1] ** 2 + base)
    return math.sqrt(square)


def fastest_decay(structure: PodiumStructure) -> float:
    """A bound on the decay rates of the uplifted structure [1/s], by
    the same inequality for C.
    """
    if (building := structure.superstructure) is None:
        return 0.0
    fixed = np.max(2.0 * building.damping_ratios * building.frequencies)
    return float(fixed + building.damping_matrix.sum() / least_base_mass(structure))


def least_base_mass(structure: PodiumStructure) -> float:
    """Inertia against u_b at theta = 0 without the floors: columns and cap beam [kg]."""
    return (
        0.25 * structure.columns_mass * structure.bearing.inertia_ratio
        + structure.cap_beam_mass
    )
