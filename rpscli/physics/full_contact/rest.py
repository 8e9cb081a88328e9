"""When the free vibration after the record can be left off."""

from __future__ import annotations

import math

from rpscli.physics.compile import compiled
from rpscli.physics.full_contact.uplift_search import Margin
from rpscli.physics.state import Record

REST_EVERY = 8
"""After the record, so many samples pass between looks at whether anything can still happen."""


@compiled
def is_over(s: Record, l: int, system: Record, block: Record, margin: Margin) -> bool:
    """Whether no later moment of the free vibration in full contact can bring a new maximum.

    Each mode decays from its present energy, which bounds every demand and the push that could
    uplift the storey again. While uplifted a history is never over: impacts excite the building
    until the storey is down.

    Parameters
    ----------
    margin
        See `uplift_search.margin_of`.
    """
    free = s.interval[l] + 1 - s.npts[l]
    if system.until_rest == 0 or free <= 0 or free % REST_EVERY != 0:
        return False
    return stays_down(system, block, margin) and demands_stand(s, l, system, block)


@compiled
def modal_speed(system: Record, block: Record, r: int) -> float:
    """sqrt(2 E_r): mode r never moves faster than this, nor farther than this over w."""
    return math.sqrt(block.dq[r] ** 2 + (system.omega[r] * block.q[r]) ** 2)


@compiled
def stays_down(system: Record, block: Record, margin: Margin) -> bool:
    """Whether the freely vibrating building can never again push hard enough to uplift.

    Parameters
    ----------
    margin
        See `uplift_search.margin_of`.
    """
    largest = 0.0
    for r in range(system.n):
        force = system.omega[r] + system.two_xi_omega[r]
        largest += abs(system.Gamma[r]) * force * modal_speed(system, block, r)
    limit = min(
        system.gravity * margin.right + margin.held_right,
        system.gravity * margin.left + margin.held_left,
    )
    return system.n == 0 or bool(margin.shear_share * largest < limit)


@compiled
def demands_stand(s: Record, l: int, system: Record, block: Record) -> bool:
    """Whether free vibration in full contact can raise no storey shear and no acceleration."""
    for i in range(system.n):
        shear, acceleration = 0.0, 0.0
        for r in range(system.n):
            speed, omega = modal_speed(system, block, r), system.omega[r]
            shear += abs(system.storey_shear_of[r, i]) * speed / omega
            acceleration += abs(system.phi[r, i]) * (omega + system.two_xi_omega[r]) * speed
        if shear > s.storey_shear[l, i] or acceleration > s.floor_acceleration[l, i]:
            return False
    return True
