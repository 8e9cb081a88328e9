"""How long a step may be: bounds on the frequencies and decay rates of a structure."""

from __future__ import annotations

import math

import numpy as np

from rpscli.analyses.settings import LONGEST_FREE_VIBRATION, TimeHistorySettings
from rpscli.model.podium import PodiumStructure

UPLIFTED_ANGLE = 0.6
"""Largest Taylor step times the highest uplifted frequency [rad], at accuracy 1."""

MOST_LOST = 5e-6
"""What steps may take from the energy of the fastest vibration, which has some hundredths of all at
most. It shortens the steps of buildings with less than some 7 % of damping in their last mode."""

UPLIFTED_DECAY = 1.0
"""Largest step times the fastest decay rate, where that asks for more: Taylor steps of order 7
are unstable beyond about 4. Only strongly overdamped modes come near."""

LAST_TERM = 5e-7
"""Largest last term of the series of a step, over its first three, at accuracy 1; what a series
omits is smaller still. Steps made for the fastest of several modes hardly ever come near. Where the
tilt itself changes faster, over one storey, in large rotations of short columns or past theta_cr
under floors that weigh hundreds of them, they are halved."""

CONTACT_ANGLE = 1.0
"""The same for the exact steps in full contact, where it guards the search of uplift: the quintic
between two instants errs by (w h)^6/46080 of a mode's push."""

STEP_SECONDS, MODE_SECONDS = 4e-7, 4e-8
"""About the time of a step of one history, and what each mode adds."""


def uplifted_rate(structure: PodiumStructure) -> float:
    """Taylor steps a second that follow the uplifted structure at accuracy 1 [1/s]."""
    stiffness = sum(device.bounds(structure)[0] for device in structure.devices)
    coefficient = sum(device.bounds(structure)[1] for device in structure.devices)
    mass = least_base_mass(structure)
    frequency = math.hypot(highest_frequency(structure), math.sqrt(stiffness / mass))
    decay = fastest_decay(structure) + coefficient / mass
    return max(frequency / uplifted_angle(structure), decay / UPLIFTED_DECAY)


def uplifted_angle(structure: PodiumStructure) -> float:
    """Largest Taylor step times the highest uplifted frequency [rad].

    A step of the angle z loses z^8/8! of a vibration's energy, thus w t z^7/8! in the time t. What
    the dampers do not take in 1/(2 xi w) goes on for as long as histories are followed.
    """
    if (building := structure.superstructure) is None:
        return UPLIFTED_ANGLE
    damped = float(2.0 * building.damping_ratios[-1] * building.frequencies[-1])
    lasting = 1.0 / max(damped, 1.0 / LONGEST_FREE_VIBRATION)
    drift = MOST_LOST * math.factorial(8) / (highest_frequency(structure) * lasting)
    return float(min(UPLIFTED_ANGLE, drift ** (1.0 / 7.0)))


def most_steps(structure: PodiumStructure, settings: TimeHistorySettings, duration: float) -> float:
    """Taylor steps of a history that never comes to rest, a bound on those of all others.

    Parameters
    ----------
    structure, settings
        What is followed, and how.
    duration
        Of the record [s].
    """
    return longest_time(settings, duration) * settings.accuracy * uplifted_rate(structure)


def longest_time(settings: TimeHistorySettings, duration: float) -> float:
    """How long a history may be followed [s].

    Parameters
    ----------
    settings
        Of these the free vibration.
    duration
        Of the record [s].
    """
    free = settings.free_vibration
    return duration + (LONGEST_FREE_VIBRATION if free is None else free)


def most_seconds(
    structure: PodiumStructure, settings: TimeHistorySettings, duration: float
) -> float:
    """About the computing time of that [s], for the parameters of `most_steps`.

    Parameters
    ----------
    structure
        Podium, bearings and building.
    settings
        Of these the accuracy.
    duration
        Of the record [s].
    """
    each = STEP_SECONDS + MODE_SECONDS * structure.storeys
    return each * most_steps(structure, settings, duration)


def contact_rate(structure: PodiumStructure) -> float:
    """Steps a second in full contact [1/s]."""
    return highest_frequency(structure) / CONTACT_ANGLE


def highest_frequency(structure: PodiumStructure) -> float:
    """A bound on the frequencies of the uplifted structure [rad/s].

    Freeing the cap beam, whose inertia is at least N m_c Io/4 + m_b, adds at most the first storey
    spring over that mass (Theory, section 6; Weyl's inequality).
    """
    square = (structure.gravity / structure.bearing.semi_diagonal) * (
        1.0 + abs(2.0 * structure.bearing.curvature_ratio - 1.0)
    )
    if (building := structure.superstructure) is not None:
        base = building.stiffnesses[0] / least_base_mass(structure)
        square += float(building.frequencies[-1] ** 2 + base)
    return math.sqrt(square)


def fastest_decay(structure: PodiumStructure) -> float:
    """A bound on the decay rates of the uplifted structure [1/s], by the same inequality for C."""
    if (building := structure.superstructure) is None:
        return 0.0
    fixed = np.max(2.0 * building.damping_ratios * building.frequencies)
    return float(fixed + building.damping_matrix.sum() / least_base_mass(structure))


def least_base_mass(structure: PodiumStructure) -> float:
    """Inertia against u_b at theta = 0 without the floors: columns and cap beam [kg]."""
    return 0.25 * structure.columns_mass * structure.bearing.inertia_ratio + structure.cap_beam_mass
