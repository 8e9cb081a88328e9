"""Devices in the language of the physics engine, with what it has for them.

A linear damper and friction act in the joint along which the cap beam slides, a stop is a spring
with a dead band there. A tendon is a cable from the ground through the middle of both ends of a
column to the beam, which pulls beyond its own length; rolling resistance is a coefficient of the
contacts, which takes the normal force as it is at each instant. Exponents and yielding it has not.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from .devices import Friction, OracleDevice, RollingResistance, Stop, Tendon, Viscous

ANCHORED = 1e-5
"""Depth of a cable's ends beyond the joints [m]: without it it has no direction at rest."""


def beam_joint(devices: Sequence[OracleDevice], time_step: float) -> str:
    """Attributes of the joint along which the beam slides."""
    damping = sum(d.coefficient for d in devices if isinstance(d, Viscous) and d.exponent == 1.0)
    friction = sum(d.force for d in devices if isinstance(d, Friction))
    return (
        f'damping="{damping}" frictionloss="{friction}"'
        f' solreffriction="{2.0 * time_step} 1" solimpfriction="0.9999 0.9999 0.001"'
    )


def contact_friction(devices: Sequence[OracleDevice]) -> str:
    """Attributes of all contacts: they do not slide; six dimensions if they resist rolling."""
    lever = sum(d.lever for d in devices if isinstance(d, RollingResistance))
    return f'friction="3 0 {lever}" condim="{6 if lever else 3}"'


def anchors(column: int, place: float) -> str:
    """Where a cable begins in the ground."""
    return f'<site name="ground {column}" pos="{place} 0 {-ANCHORED}"/>'


def ducts(column: int, H: float) -> str:
    """The middle of both ends of a column."""
    return f'<site name="foot {column}" pos="0 0 {-H}"/><site name="head {column}" pos="0 0 {H}"/>'


def holds(column: int, place: float, underside: float) -> str:
    """Where it ends in the beam."""
    return f'<site name="beam {column}" pos="{place} 0 {underside + ANCHORED}"/>'


def springs(devices: Sequence[OracleDevice], columns: int, H: float) -> Iterator[str]:
    """Stops and cables."""
    length = 2.0 * (H + ANCHORED)
    for device in devices:
        if isinstance(device, Stop):
            yield (
                f'<fixed stiffness="{device.stiffness}"'
                f' springlength="{-device.gap} {device.gap}">'
                '<joint joint="beam across" coef="1"/></fixed>'
            )
        elif isinstance(device, Tendon):
            slack = length - device.prestress / device.stiffness
            each = device.columns / columns
            for c in range(columns):
                sites = "".join(
                    f'<site site="{name} {c}"/>' for name in ("ground", "foot", "head", "beam")
                )
                yield (
                    f'<spatial stiffness="{each * device.stiffness}" springlength="0 {slack}">'
                    f"{sites}</spatial>"
                )
