"""When the free vibration after the record can be left off."""

from __future__ import annotations

import math

from rpscli.physics.contact_layout import (
    DQ,
    DRAG,
    OMEGA,
    PARTICIPATION,
    SHAPES,
    Q,
)
from rpscli.physics.jit import kernel, part
from rpscli.physics.layout import (
    FLOOR_ACCELERATION,
    FULL_CONTACT,
    MOTION,
    SCALARS,
    STOREY_SHEAR,
)
from rpscli.physics.parameters import Floats, Lanes, Podium, Shape
from rpscli.physics.table import podium_of


@kernel
def is_over(lanes: Lanes, shape: Shape, l: int) -> bool:
    """Whether no later moment of the free vibration can bring a new maximum.

    Never while uplifted: impacts excite the building until the storey is down. In full contact
    each mode decays from its present energy, which bounds every demand and the push that could
    uplift the storey again.
    """
    podium = podium_of(lanes.podium, l)
    if podium.until_rest == 0.0 or lanes.integers[l, MOTION] != FULL_CONTACT:
        return False
    return stays_down(lanes, l, podium) and demands_stand(lanes, len(shape.stride), l)


@part
def modal_speed(z: Floats, r: int) -> float:
    """sqrt(2 E_r): mode r never moves faster than this, nor farther than this over w."""
    w = z[OMEGA, r]
    return math.sqrt(z[DQ, r] ** 2 + (w * z[Q, r]) ** 2)


@part
def stays_down(lanes: Lanes, l: int, podium: Podium) -> bool:
    """Whether the freely vibrating building can never again push hard enough to uplift."""
    z = lanes.modes[l]
    own, carried = 1.0 + 2.0 * podium.gamma, 2.0 * podium.gamma * podium.eta
    largest = 0.0
    for r in range(z.shape[1]):
        pull = z[OMEGA, r] + z[DRAG, r]
        largest += abs(z[PARTICIPATION, r]) * pull * modal_speed(z, r)
    limit = podium.gravity * math.tan(podium.alpha) * (own + carried)
    return z.shape[1] == 0 or carried / podium.floors_mass * largest < limit


@part
def demands_stand(lanes: Lanes, L: int, l: int) -> bool:
    """Whether free vibration in full contact can raise no storey shear and no acceleration."""
    b, z = lanes.buffer, lanes.modes[l]
    n = z.shape[1]
    for i in range(n):
        shear, acceleration = 0.0, 0.0
        for r in range(n):
            speed = modal_speed(z, r)
            shear += abs(z[SHAPES + n + r, i]) * speed / z[OMEGA, r]
            acceleration += abs(z[SHAPES + r, i]) * (z[OMEGA, r] + z[DRAG, r]) * speed
        if (
            shear > b[(SCALARS + STOREY_SHEAR * (n + 1) + i) * L + l]
            or acceleration > b[(SCALARS + FLOOR_ACCELERATION * (n + 1) + i) * L + l]
        ):
            return False
    return True
