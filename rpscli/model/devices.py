"""Devices between ground and cap beam: dampers, friction, stops, tendons (Theory, section 11)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TypeAlias

MOST_DEVICES = 8
"""A structure has no more; equal devices are one with the sum of their forces and stiffnesses."""


@dataclass(frozen=True)
class ViscousDamper:
    """P = -c |u_b'|^a sgn(u_b') on the cap beam, c the force at 1 m/s.

    Parameters
    ----------
    coefficient
        c [N s/m; for a != 1 N (s/m)^a].
    exponent
        a, from 0.2 to 2; 1 is linear.
    """

    coefficient: float
    exponent: float = 1.0

    def __post_init__(self) -> None:
        """Refuse what the kernels do not follow."""
        if not 0.0 < self.coefficient < math.inf:
            raise ValueError("coefficient must be > 0 and finite")
        if not 0.2 <= self.exponent <= 2.0:
            raise ValueError("exponent must be >= 0.2 and <= 2")


@dataclass(frozen=True)
class FrictionDamper:
    """P = -F_d sgn(u_b'); at rest any |P| <= F_d.

    Parameters
    ----------
    force
        F_d [N].
    """

    force: float

    def __post_init__(self) -> None:
        """Refuse what is no friction."""
        if not 0.0 < self.force < math.inf:
            raise ValueError("force must be > 0 and finite")


@dataclass(frozen=True)
class Stop:
    """s P = -(k_s (|u_b| - d) + c_s |u_b|') beyond the gap, where that pushes back.

    Parameters
    ----------
    gap
        d, alike on both sides [m].
    stiffness
        k_s [N/m].
    damping
        c_s [N s/m].
    """

    gap: float
    stiffness: float
    damping: float = 0.0

    def __post_init__(self) -> None:
        """Refuse what is no stop."""
        if not 0.0 <= self.gap < math.inf:
            raise ValueError("gap must be >= 0 and finite")
        if not 0.0 < self.stiffness < math.inf:
            raise ValueError("stiffness must be > 0 and finite")
        if not 0.0 <= self.damping < math.inf:
            raise ValueError("damping must be >= 0 and finite")


@dataclass(frozen=True)
class Tendon:
    """An unbonded tendon in the axis of each column, from the ground to the cap beam.

    Elastic up to its yield force and perfectly plastic beyond; it never pushes.

    Parameters
    ----------
    prestress
        P_0 of one tendon while the structure stands [N].
    stiffness
        k_t of one [N/m].
    yield_force
        P_y of one [N]; infinite if it does not yield.
    """

    prestress: float
    stiffness: float
    yield_force: float = math.inf

    def __post_init__(self) -> None:
        """Refuse what is no tendon."""
        if not 0.0 <= self.prestress < math.inf:
            raise ValueError("prestress must be >= 0 and finite")
        if not 0.0 < self.stiffness < math.inf:
            raise ValueError("stiffness must be > 0 and finite")
        if not self.yield_force > self.prestress:
            raise ValueError("yield_force must be > prestress")


@dataclass(frozen=True)
class RollingResistance:
    """The moment f (N_top + N_bot) against the tilt's rate, with the weight for normal forces.

    Parameters
    ----------
    lever
        f, by which the normal force runs ahead of the contact [m].
    """

    lever: float

    def __post_init__(self) -> None:
        """Refuse what resists nothing."""
        if not 0.0 < self.lever < math.inf:
            raise ValueError("lever must be > 0 and finite")


Device: TypeAlias = ViscousDamper | FrictionDamper | Stop | Tendon | RollingResistance

DEVICES: dict[str, type[Device]] = {
    "viscous": ViscousDamper,
    "friction": FrictionDamper,
    "stop": Stop,
    "tendon": Tendon,
    "rolling_resistance": RollingResistance,
}
"""By their names in a case, in the order of the kernels' codes."""


def name_of(device: Device) -> str:
    """The name of a device's kind in a case.

    >>> name_of(FrictionDamper(1e5))
    'friction'
    """
    return next(name for name, kind in DEVICES.items() if isinstance(device, kind))
