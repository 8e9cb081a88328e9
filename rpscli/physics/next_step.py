"""Length of the next step of a lane."""

from __future__ import annotations

import math

import numpy as np

from rpscli.physics.compile import inlined
from rpscli.physics.lane import ways_of
from rpscli.physics.state import Record

ARC = 0.2
"""Longest step over x/|r'| near upright, where the tilt may go to any side."""


@inlined
def even_part(left: float, longest: float) -> float:
    """The longest even part of what is left of an interval."""
    return left / max(np.ceil(left / longest - 1e-9), 1.0)  # type: ignore[no-any-return]


@inlined
def near_limit(s: Record, l: int) -> float:
    """Longest step that the distance from upright allows."""
    x = s.x[l]
    fast = 0.0
    pulled = 0.0
    for axis in range(ways_of(s)):
        fast += s.tilt_rate[axis, l] * s.tilt_rate[axis, l]
        pulled += s.bend[axis, l] * s.bend[axis, l]
    pulled = math.sqrt(pulled) + 2.0 * s.tan_a[l] * s.weigh[l] * s.gravity[l] / s.one[l]
    turns = x / max(pulled, 1e-300)
    limit = min(x / math.sqrt(fast + 1e-300), 2.0 * math.sqrt(turns))
    return ARC * limit  # type: ignore[no-any-return]


@inlined
def plan(s: Record, l: int) -> float:
    """Length of a lane's next step: an even part of what is left,
    or what its motion allows.
    """
    step = min(even_part(max(s.dt[l] - s.time[l], 0.0), s.h_most[l]), s.h_limit[l])
    if ways_of(s) == 2:
        near = near_limit(s, l)
        step = min(step, near if (s.moves[l] > 0.0) & (s.x_low[l] > 0.0) else step)
    return step  # type: ignore[no-any-return]
