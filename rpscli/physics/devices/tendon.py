"""A tendon in each column, which is slack, elastic, or yields (11.7) to (11.10)."""

from __future__ import annotations

import math

from rpscli.physics.compile import compiled
from rpscli.physics.devices.device import DeviceLaw, set_apart
from rpscli.physics.devices.worked import Worked, tendon_elongation, worked
from rpscli.physics.lane import tilt_of
from rpscli.physics.state import (
    BEYOND,
    IDLE,
    TENDON,
    TENDON_PRESTRESS,
    TENDON_SLACK,
    TENDON_STIFFNESS,
    TENDON_TAUT,
    TENDON_YIELD,
    TENDON_YIELDING,
    WORKING,
    Record,
)


@compiled
def load(s: Record, l: int, i: int, system: Record) -> None:
    """It is looked at by itself, and pulls from the beginning."""
    prestress = system.device_constants[i, TENDON_PRESTRESS]
    set_apart(s, l, i)
    s.tendons[l] += 1
    s.branch[i, l] = WORKING
    s.device_force[i, l] = prestress
    s.pull[l] += system.columns * prestress


@compiled
def tension(s: Record, l: int, i: int, e: float) -> float:
    """Of one tendon [N], at its elongation [m]."""
    if s.branch[i, l] == IDLE:
        return 0.0
    if s.branch[i, l] == WORKING:
        stretch = e - s.permanent[i, l]
        return float(
            s.law[i, TENDON_PRESTRESS, l] + s.law[i, TENDON_STIFFNESS, l] * stretch
        )
    return float(s.law[i, TENDON_YIELD, l])


@compiled
def power(s: Record, l: int, i: int, at: Worked) -> float:
    """While it yields."""
    if s.branch[i, l] != BEYOND:
        return 0.0
    return float(s.columns[l] * s.law[i, TENDON_YIELD, l] * at.lever * at.tilt.p)


@compiled
def stored(s: Record, l: int, i: int, at: Worked) -> float:
    """In all tendons, over that of their prestress."""
    tense = tension(s, l, i, at.e)
    prestress = s.law[i, TENDON_PRESTRESS, l]
    change = tense * tense - prestress * prestress
    return float(0.5 * s.columns[l] * change / s.law[i, TENDON_STIFFNESS, l])


@compiled
def watched(
    s: Record,
    l: int,
    i: int,
    end: int,
    second: bool,
) -> tuple[bool, float, float]:
    """Tight, or slack; second, not yielding."""
    branch = s.branch[i, l]
    limit = s.law[i, TENDON_YIELD, l]
    stiffness = s.law[i, TENDON_STIFFNESS, l]
    if branch == BEYOND or (second and (branch == IDLE or limit == math.inf)):
        return False, 0.0, 0.0
    x, p = (s.new_x[l], s.new_v[l]) if end > 0 else (s.x[l], s.v[l])
    e, lever, _, _ = tendon_elongation(s, l, x)
    tense = s.law[i, TENDON_PRESTRESS, l] + stiffness * (e - s.permanent[i, l])
    sign = -1.0 if second or branch == IDLE else 1.0
    return True, (limit - tense if second else sign * tense), sign * stiffness * lever * p


@compiled
def change(s: Record, l: int, i: int, second: bool) -> tuple[int, int]:
    """It yields, becomes slack, or tight."""
    if second:
        return BEYOND, TENDON_YIELDING
    if s.branch[i, l] == WORKING:
        return IDLE, TENDON_SLACK
    return WORKING, TENDON_TAUT


@compiled
def at(s: Record, l: int, i: int, at: Worked) -> tuple[float, float, float]:
    """Tension of one, the rate of its elongation, and that."""
    return tension(s, l, i, at.e), at.lever * at.tilt.p, at.e


DEVICE = DeviceLaw(
    TENDON,
    load,
    at,
    tension=tension,
    power=power,
    stored=stored,
    watched=watched,
    change=change,
)


UNLOADED = 1e-12
"""Share of its limit by which a tendon that yielded is below it once the tilt turns:
a margin of zero could be negative by rounding at the end of a short step, and the
tendon yield on the way back.
"""


@compiled
def reset_yielded_tendons(s: Record, l: int) -> None:
    """Tendons that yielded are elastic again, longer by what they yielded."""
    for i in range(s.devices[l]):
        if s.device_kind[i, l] == TENDON and s.branch[i, l] == BEYOND:
            e = worked(s, l, tilt_of(s, l), (0.0, 0.0)).e
            limit = s.law[i, TENDON_YIELD, l] * (1.0 - UNLOADED)
            until_yield = limit - s.law[i, TENDON_PRESTRESS, l]
            s.permanent[i, l] = e - until_yield / s.law[i, TENDON_STIFFNESS, l]
            s.branch[i, l] = WORKING


@compiled
def any_yields(s: Record, l: int) -> bool:
    """True if a tendon of a lane yields."""
    found = False
    for i in range(s.devices[l]):
        found |= (s.device_kind[i, l] == TENDON) & (s.branch[i, l] == BEYOND)
    return found
