"""The motion within the step just taken: of modes, of the tilt,
and what forces may bulge.
"""

from __future__ import annotations

import math

from rpscli.physics.compile import compiled, inlined
from rpscli.physics.lane import mode_acceleration, ways_of
from rpscli.physics.peaks import middle_of
from rpscli.physics.quintic import Quintic, quintic, slope, value
from rpscli.physics.state import Record

WITHIN = 1.5
"""Room for what a motion within a step is more than a cubic."""


@inlined
def bulge(s: Record, l: int, first: int, end: int) -> float:
    """Most by which springs' forces in some axes exceed both ends within a step [N]."""
    square = 0.0
    for axis in range(first, end):
        change = s.new_dV[axis, l] - s.dV[axis, l]
        square += change * change
    return WITHIN / 8.0 * s.h[l] * math.sqrt(square)  # type: ignore[no-any-return]


PARTS = 8
"""Of steps that are made for vertical springs, in which the motions of floors turn: a
parabola through both ends of a part and its middle leaves 4e-6 of a vibration."""


STRAIGHT = 1e-5
"""Of the floors' weight: forces of springs that leave the chord by less need no parts."""


@inlined
def parts_of(s: Record, l: int) -> int:
    """Parts of a step that are looked at, each by its ends and its middle."""
    springs = s.axes > ways_of(s)
    turns = bulge(s, l, 0, s.axes) > STRAIGHT * s.floors_mass[l] * s.gravity[l]
    return PARTS if springs and turns else 1


@compiled
def mode_path(s: Record, r: int, l: int, axis: int) -> Quintic:
    """A mode's displacement over the step just taken."""
    start = mode_acceleration(s, r, l, axis)
    end = -(s.Gamma[r, l] * s.new_shaking[axis, l]) - s.force[r, l]
    return quintic(
        s.h[l], s.q[r, l], s.dq[r, l], start, s.new_q[r, l], s.new_dq[r, l], end
    )


@compiled
def mode_within(s: Record, r: int, l: int, axis: int, t: float) -> tuple[float, float]:
    """Displacement and velocity of a mode a fraction t into the step."""
    h = s.h[l]
    q0 = s.q[r, l]
    v0 = s.dq[r, l]
    q1 = s.new_q[r, l]
    v1 = s.new_dq[r, l]
    if t == 0.0:
        return q0, v0
    if t == 1.0:
        return q1, v1
    if s.axes == ways_of(s):
        return middle_of(q0, q1, h * v0, h * v1), 1.5 / h * (q1 - q0) - 0.25 * (v0 + v1)
    path = mode_path(s, r, l, axis)
    return value(path, t), slope(path, t) / h


@inlined
def tilt_within(
    s: Record, l: int, t: float
) -> tuple[tuple[float, float], tuple[float, float]]:
    """The tilt and its rate a fraction t into the step, by quintics through both ends."""
    x = axis_path(s, l, 0)
    per_h = 1.0 / s.h[l] if s.h[l] > 0.0 else 0.0
    if ways_of(s) == 1:
        return (value(x, t), 0.0), (slope(x, t) * per_h, 0.0)
    y = axis_path(s, l, ways_of(s) - 1)
    return (value(x, t), value(y, t)), (slope(x, t) * per_h, slope(y, t) * per_h)


@inlined
def axis_path(
    s: Record, l: int, axis: int
) -> tuple[float, float, float, float, float, float]:
    """The quintic of a component of the tilt over the step."""
    return quintic(
        s.h[l],
        s.tilt[axis, l],
        s.tilt_rate[axis, l],
        s.bend[axis, l],
        s.new_tilt[axis, l],
        s.new_tilt_rate[axis, l],
        s.new_bend[axis, l],
    )
