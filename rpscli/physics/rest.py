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
from rpscli.physics.lane import Lane
from rpscli.physics.layout import FLOOR_ACCELERATION, FULL_CONTACT, MOTION, STOREY_SHEAR
from rpscli.physics.parameters import Floats
from rpscli.physics.part import part, routine
from rpscli.physics.podium_layout import ALPHA, ETA, FLOORS_MASS, GAMMA, GRAVITY, UNTIL_REST


@routine
def is_over(lane: Lane) -> bool:
    """Whether no later moment of the free vibration can bring a new maximum.

    Never while uplifted: impacts excite the building until the storey is down. In full contact
    each mode decays from its present energy, which bounds every demand and the push that could
    uplift the storey again.
    """
    if lane.podium[UNTIL_REST] == 0.0 or lane.whole[MOTION] != FULL_CONTACT:
        return False
    return stays_down(lane) and demands_stand(lane)


@part
def modal_speed(z: Floats, r: int) -> float:
    """sqrt(2 E_r): mode r never moves faster than this, nor farther than this over w."""
    w = z[OMEGA, r]
    return math.sqrt(z[DQ, r] ** 2 + (w * z[Q, r]) ** 2)


@part
def stays_down(lane: Lane) -> bool:
    """Whether the freely vibrating building can never again push hard enough to uplift."""
    z, p = lane.modes, lane.podium
    own, carried = 1.0 + 2.0 * p[GAMMA], 2.0 * p[GAMMA] * p[ETA]
    largest = 0.0
    for r in range(z.shape[1]):
        pull = z[OMEGA, r] + z[DRAG, r]
        largest += abs(z[PARTICIPATION, r]) * pull * modal_speed(z, r)
    limit = p[GRAVITY] * math.tan(p[ALPHA]) * (own + carried)
    return z.shape[1] == 0 or bool(carried / p[FLOORS_MASS] * largest < limit)


@part
def demands_stand(lane: Lane) -> bool:
    """Whether free vibration in full contact can raise no storey shear and no acceleration."""
    x, z = lane.blocks, lane.modes
    n = z.shape[1]
    for i in range(n):
        shear, acceleration = 0.0, 0.0
        for r in range(n):
            speed = modal_speed(z, r)
            shear += abs(z[SHAPES + n + r, i]) * speed / z[OMEGA, r]
            acceleration += abs(z[SHAPES + r, i]) * (z[OMEGA, r] + z[DRAG, r]) * speed
        if shear > x[STOREY_SHEAR, i] or acceleration > x[FLOOR_ACCELERATION, i]:
            return False
    return True
