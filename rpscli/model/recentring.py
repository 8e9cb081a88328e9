"""Whether a structure comes back from a tilt against the friction of its devices (Theory, 11)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rpscli.model.devices import FrictionDamper, RollingResistance, Stop, Tendon
from rpscli.model.podium import PodiumStructure

Array = NDArray[np.float64]

POINTS = 400
"""Rotations that are looked at; the curve has no more than a few bends."""


def restoring_force(structure: PodiumStructure, rotation: Array, farthest: float = 0.0) -> Array:
    """Horizontal force at the cap beam that holds rotations > 0 at rest without friction [N].

    F = W B/C with what stops and tendons add.

    Parameters
    ----------
    structure
        Podium with its devices.
    rotation
        Rotations > 0, of any shape [rad].
    farthest
        Rotation up to which tendons were drawn before, perhaps beyond yielding [rad].
    """
    x = np.asarray(rotation, dtype=float)
    force, path, _ = structure.path(x)
    arm = structure.lever_arm(x)
    elongation, lever = structure.bearing.tendon_elongation(x), structure.bearing.tendon_lever(x)
    for device in structure.devices:
        if isinstance(device, Stop):
            force = force + device.stiffness * np.maximum(path - device.gap, 0.0)
        elif isinstance(device, Tendon):
            tension = device.prestress + device.stiffness * (
                elongation - yielded(structure, device, farthest)
            )
            tension = np.clip(tension, 0.0, device.yield_force)
            force = force + structure.columns * tension * lever / arm
    return np.asarray(force)


def yielded(structure: PodiumStructure, tendon: Tendon, farthest: float) -> float:
    """What a tendon keeps of its elongation after it was drawn to a rotation [m].

    Parameters
    ----------
    structure
        Podium with its bearings.
    tendon
        One of its devices.
    farthest
        Rotation to which it was drawn [rad].
    """
    elastic = (tendon.yield_force - tendon.prestress) / tendon.stiffness
    drawn = structure.bearing.tendon_elongation(np.array([farthest]))
    return max(0.0, float(drawn[0]) - elastic)


def friction_force(structure: PodiumStructure, rotation: Array) -> Array:
    """Horizontal force at the cap beam that friction dampers and rolling resistance hold [N].

    Parameters
    ----------
    structure
        Podium with its devices.
    rotation
        Any shape, |theta| [rad].
    """
    arm = structure.lever_arm(np.asarray(rotation, dtype=float))
    held = np.zeros_like(arm)
    for device in structure.devices:
        if isinstance(device, FrictionDamper):
            held = held + device.force
        elif isinstance(device, RollingResistance):
            held = held + 2.0 * structure.weight * device.lever / arm
    return held


def largest_recentring_friction(structure: PodiumStructure, rotation: float) -> float:
    """The largest friction from which the structure still comes back from a rotation [N].

    Parameters
    ----------
    structure
        Podium with its devices; those with friction are left out.
    rotation
        Where it starts from rest [rad]; beyond the critical rotation the answer is negative unless
        stops or tendons hold it.
    """
    x = np.linspace(rotation / POINTS, rotation, POINTS)
    return float(np.min(restoring_force(structure, x, rotation)))


def recentres(structure: PodiumStructure, rotation: float) -> bool:
    """Whether the structure comes back to full contact from rest at a rotation [rad], slowly.

    Parameters
    ----------
    structure
        Podium with its devices.
    rotation
        |theta| from which it starts [rad].
    """
    x = np.linspace(rotation / POINTS, rotation, POINTS)
    return bool(np.all(restoring_force(structure, x, rotation) > friction_force(structure, x)))
