"""What follows from the devices of a structure before any analysis (Theory, section 11)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from rpscli.model.devices import (
    Device,
    FrictionDamper,
    RollingResistance,
    Stop,
    Tendon,
    ViscousDamper,
    name_of,
)
from rpscli.model.podium import PodiumStructure
from rpscli.model.recentring import (
    friction_force,
    largest_recentring_friction,
    recentres,
    restoring_force,
    yielded,
)

PARTS = (0.25, 0.5, 0.75)
"""Of the critical rotation, from which it is asked whether the structure comes back."""


class Consequence(NamedTuple):
    """A number that follows from one device: its name, words, SI unit; None if never reached.

    Parameters
    ----------
    name
        Of the number, in JSON.
    label
        The words of a table.
    unit
        SI; ``-`` for plain numbers.
    value
        None if it is never reached.
    """

    name: str
    label: str
    unit: str
    value: float | None


class Return(NamedTuple):
    """Whether the storey comes back from rest at a rotation, and against how much friction.

    Parameters
    ----------
    rotation
        From which it starts at rest [rad].
    displacement
        u_b there [m].
    largest_friction
        What friction may hold at most for it to come back, a force at the cap beam [N].
    friction
        What friction holds at most on the way [N].
    recentres
        Whether it comes back to full contact.
    """

    rotation: float
    displacement: float
    largest_friction: float
    friction: float
    recentres: bool


def uplift_force(structure: PodiumStructure) -> float:
    """Horizontal force at the cap beam that uplifts it against weight and devices [N]."""
    upright = np.zeros(1)
    return float(restoring_force(structure, upright)[0] + friction_force(structure, upright)[0])


def uplift_acceleration(structure: PodiumStructure) -> float:
    """Ground acceleration that uplifts the structure with its devices quasi-statically [m/s2]."""
    return uplift_force(structure) / structure.restoring_mass


def returns(structure: PodiumStructure) -> list[Return]:
    """Whether the storey re-centres from some rotations; empty without friction."""
    if not any(isinstance(d, FrictionDamper | RollingResistance) for d in structure.devices):
        return []
    rotations = np.array(PARTS) * structure.critical_rotation
    _, path, _ = structure.path(rotations)
    held = [float(np.max(friction_force(structure, np.linspace(0.0, x, 50)))) for x in rotations]
    return [
        Return(
            float(x),
            float(displacement),
            largest_recentring_friction(structure, float(x)),
            friction,
            recentres(structure, float(x)),
        )
        for x, displacement, friction in zip(rotations, path, held, strict=True)
    ]


def consequences(structure: PodiumStructure, device: Device) -> Iterator[Consequence]:
    """What follows from one device of a structure.

    Parameters
    ----------
    structure
        Podium, bearings and building.
    device
        One of its devices.
    """
    lifting = structure.uplift_force
    if isinstance(device, FrictionDamper):
        yield Consequence("uplift_share", "over W tan(alpha)", "-", device.force / lifting)
    elif isinstance(device, RollingResistance):
        share = device.lever / structure.bearing.half_width
        yield Consequence("uplift_share", "over W tan(alpha)", "-", share)
    elif isinstance(device, ViscousDamper):
        speed = (lifting / device.coefficient) ** (1.0 / device.exponent)
        yield Consequence("velocity_at_uplift_force", "reaches W tan(alpha) at", "m/s", speed)
    elif isinstance(device, Stop):
        x = _tilt(structure, device.gap, elongation=False)
        over = None if x is None else x / structure.critical_rotation
        yield Consequence("met_rotation", "met at", "rad", x)
        yield Consequence("met_rotation_ratio", "met at, over theta_cr", "-", over)
    else:
        yield from _of_tendon(structure, device)


def _of_tendon(structure: PodiumStructure, tendon: Tendon) -> Iterator[Consequence]:
    added = structure.columns * tendon.prestress * structure.bearing.slenderness
    share = added / structure.uplift_force
    yield Consequence("uplift_share", "prestress over weight", "-", share)
    if not np.isfinite(tendon.yield_force):
        return
    ratio = tendon.prestress / tendon.yield_force
    yield Consequence("prestress_ratio", "prestress over yield force", "-", ratio)
    stretch = (tendon.yield_force - tendon.prestress) / tendon.stiffness
    x = _tilt(structure, stretch, elongation=True)
    yield Consequence("yield_rotation", "yields at", "rad", x)
    lost = tendon.stiffness * yielded(structure, tendon, structure.critical_rotation)
    left = max(0.0, tendon.prestress - lost)
    yield Consequence("prestress_after_critical", "prestress after theta_cr", "N", left)


def _tilt(structure: PodiumStructure, length: float, *, elongation: bool) -> float | None:
    """|theta| at which u_b or a tendon's elongation reaches a length; None beyond 2 theta_cr."""

    def excess(x: float) -> float:
        at = np.array([x])
        bearing = structure.bearing
        grown = bearing.tendon_elongation(at) if elongation else structure.path(at)[1]
        return float(grown[0]) - length

    end = 2.0 * structure.critical_rotation
    if excess(end) < 0.0:
        return None
    from scipy.optimize import brentq

    return float(brentq(excess, 0.0, end))


def device_consequences(structure: PodiumStructure) -> dict[str, Any]:
    """All of them under their names."""
    return {
        "uplift_force_with_devices": uplift_force(structure),
        "uplift_acceleration_with_devices": uplift_acceleration(structure),
        "devices": [
            {
                "kind": name_of(device),
                **{found.name: found.value for found in consequences(structure, device)},
            }
            for device in structure.devices
        ],
        "recentring": [found._asdict() for found in returns(structure)],
    }
