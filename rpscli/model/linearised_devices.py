"""What devices add to small motions about theta = 0 on one side (Theory, sections 6 and 11)."""

from __future__ import annotations

from collections.abc import Iterator

from rpscli.model.devices import (
    FrictionDamper,
    RollingResistance,
    Stop,
    Tendon,
    ViscousDamper,
)
from rpscli.model.podium import PodiumStructure


def stiffness_after_uplift(structure: PodiumStructure) -> float:
    """What devices add to dF/du_b at u_b = 0+, on the way out [N/m], exact.

    With the arm 2 R C = 2 H + 2 B x of a horizontal force and the elongation 2 B x + r x^2 of a
    tendon, a moment M + M' x is the force M/2H + (M' - M B/H) x/2H, and du_b = 2 H dx.
    """
    bearing = structure.bearing
    B, H = bearing.half_width, bearing.half_height
    r = 0.0 if bearing.is_flat else bearing.radius
    found = 0.0
    for device in structure.devices:
        moment, growth = 0.0, 0.0
        if isinstance(device, Tendon):
            moment = structure.columns * device.prestress * 2.0 * B
            growth = structure.columns * (
                device.stiffness * 4.0 * B**2 + device.prestress * 2.0 * r
            )
        elif isinstance(device, RollingResistance):
            moment = 2.0 * structure.weight * device.lever
        elif isinstance(device, Stop) and device.gap == 0.0:
            found += device.stiffness
        found += (growth - moment * B / H) / (4.0 * H**2)
    return found


def linear_damping(structure: PodiumStructure) -> float:
    """c of all linear viscous dampers, which belongs to u_b' [N s/m]."""
    return sum(
        device.coefficient
        for device in structure.devices
        if isinstance(device, ViscousDamper) and device.exponent == 1.0
    )


def tendon_stiffness(structure: PodiumStructure, kappa: float, angle: float) -> float:
    """What elastic tendons add to u_bR = 2 R theta, to first order [N/m].

    Parameters
    ----------
    structure
        Podium with its devices.
    kappa
        2 rho - 1 rolling, -1 rocking.
    angle
        alpha rolling, alpha' rocking [rad].

    Notes
    -----
    To first order e = 2 R (a theta + (kappa + 1) theta^2/2), so N T de/dtheta over 2 R is
    N P_0 a + [N k_t a^2 + N P_0 (kappa + 1)/2R] u_bR.
    """
    diameter = 2.0 * structure.bearing.semi_diagonal
    tendons = [device for device in structure.devices if isinstance(device, Tendon)]
    return structure.columns * sum(
        tendon.stiffness * angle**2 + tendon.prestress * (kappa + 1.0) / diameter
        for tendon in tendons
    )


def left_out(structure: PodiumStructure) -> Iterator[str]:
    """What modes cannot hold of the devices, in words."""
    reasons = {
        FrictionDamper: "friction",
        RollingResistance: "rolling resistance",
        Stop: "stops",
    }
    for kind, reason in reasons.items():
        if any(isinstance(device, kind) for device in structure.devices):
            yield reason
    viscous = [device for device in structure.devices if isinstance(device, ViscousDamper)]
    if any(device.exponent != 1.0 for device in viscous):
        yield "dampers whose exponent is not 1"
    if any(isinstance(device, Tendon) for device in structure.devices):
        yield "yielding of tendons"
