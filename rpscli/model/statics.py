"""Statics with devices: what holds a tilt, and from where the podium
comes back (Theory, 11).
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from rpscli.model.podium import Array, PodiumStructure

PARTS = (0.25, 0.5, 0.75)
"""Parts of the critical rotation from which the structure may come back."""

NEARLY = 1.0 + 1e-9
"""Forces that differ by less are equal but for rounding: what
yields together, or at uplift."""

POINTS = 400
"""Rotations that are looked at; the curve has no more than a few bends."""


class Return(NamedTuple):
    """Return of the podium from rest at a rotation, and the friction against it."""

    rotation: float  # From which it starts at rest [rad]
    displacement: float  # u_b there [m]
    largest_friction: float
    """Largest friction against which it comes back, a force at the cap beam [N]."""
    friction: float  # Largest friction on the way [N]
    recentres: bool  # True if it comes back to full contact
    dead_band: float | None = 0.0
    """|u_b| within which friction holds it at rest; None if that is everywhere [m]."""
    rest: float | None = None
    """u_b at which it stays after its last swing, outwards positive as it was let go, of
    a rigid building on ends without a flat part and without other losses [m]."""


class StoreyStrength(NamedTuple):
    """Strength of a storey beside its shear where columns lift
    under slow ground motion.
    """

    strength: float  # F_i [N]
    strength_ratio: float | None  # F_i/V_st; None on spherical ends
    shear_at_uplift: float
    """Mass above times the ground acceleration that uplifts
    rigid ends, with devices [N]."""
    uplift_first: bool  # True if columns lift before it yields
    yield_drift: float  # F_i/k_i [m]


def storey_strengths(structure: PodiumStructure) -> list[StoreyStrength]:
    """Strengths of the storeys from the bottom; empty where they stay elastic."""
    building = structure.superstructure
    static = structure.static_base_shear
    if building is None or building.strengths is None:
        return []
    at_uplift = building.carried * max(
        structure.uplift_acceleration, uplift_acceleration(structure)
    )
    columns = building.strengths, at_uplift, building.stiffnesses
    return [
        StoreyStrength(
            F, F / static if static else None, shear, shear <= NEARLY * F, F / k
        )
        for F, shear, k in zip(*(column.tolist() for column in columns), strict=True)
    ]


def restoring_force(
    structure: PodiumStructure, rotation: Array, farthest: float = 0.0
) -> Array:
    """Horizontal force at the cap beam that holds rotations > 0 at
    rest without friction [N].

    F = W B/C with what stops and tendons add.
    """
    x = np.asarray(rotation, dtype=float)
    force = structure.path(x)[0]
    for device in structure.devices:
        force = force + device.at_rest(structure, x, farthest).restoring
    return force


def secant_period(structure: PodiumStructure, rotation: float) -> float:
    """Period of the rigid building on bearings whose secant stiffness
    is that at a rotation [s].

    T = 2 pi sqrt(M u_b/F), with M the mass that F = W B/C lifts, W/g, without friction.
    """
    force = float(restoring_force(structure, np.array(rotation)))
    displacement = float(structure.path(np.array([rotation]))[1][0])
    return 2.0 * math.pi * math.sqrt(structure.restoring_mass * displacement / force)


def friction_force(structure: PodiumStructure, rotation: Array) -> Array:
    """Horizontal force at the cap beam that friction of all
    kinds can hold at rest [N].
    """
    x = np.asarray(rotation, dtype=float)
    held = np.zeros_like(x)
    for device in structure.devices:
        held = held + device.at_rest(structure, x, 0.0).held
    return held


def uplift_force(structure: PodiumStructure) -> float:
    """Horizontal force at the cap beam that uplifts it against weight and devices [N]."""
    upright = np.zeros(1)
    return float(
        restoring_force(structure, upright)[0] + friction_force(structure, upright)[0]
    )


def uplift_acceleration(structure: PodiumStructure) -> float:
    """Ground acceleration that uplifts the structure with its devices
    quasi-statically [m/s2].
    """
    return uplift_force(structure) / structure.restoring_mass


class Wind(NamedTuple):
    """The wind beside what keeps the cap beam in its place, all of it quasi-static."""

    base_shear: float  # V_w [N]
    uplift_force: float  # W tan(alpha); 0 on ends without a flat part [N]
    friction: float  # Of all kinds, while the columns stand upright [N]
    moving_force: float  # At the cap beam, with all devices [N]
    ratio: float | None  # V_w over it; None where nothing keeps the cap beam in its place

    @property
    def moves(self) -> bool:
        """True if the wind moves the building."""
        return self.ratio is None or self.ratio > NEARLY


def wind_on(structure: PodiumStructure) -> Wind | None:
    """What the base shear of the wind does; None where it is not known.

    The wind pushes the building and not the masses of the bearings' storey, so that it is
    the force at the cap beam, to be compared with W tan(alpha) rather than with V_st.
    """
    if structure.wind is None:
        return None
    moving = uplift_force(structure)
    held = float(friction_force(structure, np.zeros(1))[0])
    ratio = structure.wind / moving if moving > 0.0 else None
    return Wind(structure.wind, structure.uplift_force, held, moving, ratio)


def largest_recentring_friction(structure: PodiumStructure, rotation: float) -> float:
    """The largest friction from which the structure still comes
    back from a rotation [N].
    """
    x = np.linspace(0.0, rotation, POINTS + 1)
    return float(np.min(restoring_force(structure, x, rotation)))


def recentres(structure: PodiumStructure, rotation: float) -> bool:
    """True if the structure comes back to full contact from rest, slowly."""
    x = np.linspace(rotation / POINTS, rotation, POINTS)
    return bool(
        np.all(restoring_force(structure, x, rotation) > friction_force(structure, x))
    )


def dead_band(structure: PodiumStructure) -> float | None:
    """Largest |u_b| about upright up to which friction holds the storey at rest: F_d/K of
    ends that restore by K; None if it holds it everywhere [m].
    """
    x = np.linspace(0.0, structure.critical_rotation, 20 * POINTS)
    spare = restoring_force(structure, x) - friction_force(structure, x)
    if not (spare > 0.0).any():
        return None
    end = int(np.argmax(spare > 0.0))
    if end == 0:
        return 0.0
    inside = spare[end - 1] / (spare[end - 1] - spare[end])
    held = x[end - 1] + inside * (x[end] - x[end - 1])
    return float(structure.path(np.array([held]))[1][0])


def rest_after_swings(structure: PodiumStructure, rotation: float) -> float:
    """u_b at which a rigid storey on ends without a flat part stays after it was let go
    from rest, by energy: friction alone takes some [m].
    """
    x = np.linspace(0.0, rotation, 20 * POINTS)
    u = structure.path(x)[1]
    F = restoring_force(structure, x, rotation)
    f = friction_force(structure, x)
    stored, taken = (
        np.append(0.0, np.cumsum(0.5 * (y[1:] + y[:-1]) * np.diff(u))) for y in (F, f)
    )
    left = stored - taken  # least where friction is the restoring force
    side = 1.0
    at = float(u[-1])
    while np.interp(at, u, F) > np.interp(at, u, f):
        spare = float(np.interp(at, u, left))
        if spare <= 0.0:  # it does not reach the upright position
            falling = slice(0, int(np.argmin(left)) + 1)
            return side * float(np.interp(-spare, -left[falling], u[falling]))
        side = -side
        at = float(np.interp(spare, stored + taken, u))
    return side * at


def returns(structure: PodiumStructure) -> list[Return]:
    """Returns of the podium from some rotations; empty without friction."""
    rotations = [part * structure.critical_rotation for part in PARTS]
    spherical = structure.bearing.is_spherical
    return [
        Return(
            x,
            float(structure.path(np.array([x]))[1][0]),
            largest_recentring_friction(structure, x),
            friction,
            recentres(structure, x),
            dead_band(structure),
            rest_after_swings(structure, x) if spherical else None,
        )
        for x in rotations
        if (friction := float(np.max(friction_force(structure, np.linspace(0.0, x, 50)))))
        > 0.0
    ]


def device_consequences(structure: PodiumStructure) -> dict[str, Any]:
    """All that follows from the devices before any analysis, under its names."""
    return {
        "uplift_force_with_devices": uplift_force(structure),
        "uplift_acceleration_with_devices": uplift_acceleration(structure),
        "devices": [
            {
                "kind": device.kind,
                **{item.name: item.value for item in device.consequences(structure)},
            }
            for device in structure.devices
        ],
        "recentring": [row._asdict() for row in returns(structure)],
    }
