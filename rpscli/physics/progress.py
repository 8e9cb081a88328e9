"""From one sample of the record to the next: store, and see whether the history is over."""

from __future__ import annotations

from rpscli.physics.jit import kernel, merged
from rpscli.physics.layout import (
    ACCELERATION,
    DAMPED,
    FULL_CONTACT,
    INPUT,
    INTERVAL,
    INTERVALS,
    LOST,
    MOTION,
    NPTS,
    POSITION,
    ROW_ACCELERATION,
    ROW_DAMPED,
    ROW_FLOORS,
    ROW_INPUT,
    ROW_LOST,
    ROW_PHASE,
    ROW_RATE,
    ROW_ROTATION,
    SCALARS,
    SIDE,
    VELOCITY,
)
from rpscli.physics.parameters import Lanes, Shape
from rpscli.physics.rest import is_over
from rpscli.physics.shaking import shake

REST_EVERY = 8
"""After the record, so many samples pass between looks at whether anything can still happen."""


@kernel
def store_sample(lanes: Lanes, shape: Shape, l: int) -> None:
    """Keep the state at the start of the present interval, if there is room."""
    n, L = len(shape.floors), len(shape.stride)
    b, whole = lanes.buffer, lanes.integers
    if whole[l, INTERVAL] >= lanes.samples.shape[0]:
        return
    row = lanes.samples[whole[l, INTERVAL]]
    u, du = SCALARS + POSITION * (n + 1), SCALARS + VELOCITY * (n + 1)
    side, stands = b[SIDE * L + l], whole[l, MOTION] == FULL_CONTACT
    turning = b[(SCALARS + ACCELERATION * (n + 1)) * L + l]
    row[ROW_ROTATION], row[ROW_RATE] = side * b[u * L + l], side * b[du * L + l]
    row[ROW_ACCELERATION] = 0.0 if stands else side * turning
    row[ROW_PHASE] = whole[l, MOTION]
    row[ROW_INPUT], row[ROW_DAMPED] = b[INPUT * L + l], b[DAMPED * L + l]
    row[ROW_LOST] = b[LOST * L + l]
    for i in range(n):
        row[ROW_FLOORS + i] = b[(u + i + 1) * L + l]
        row[ROW_FLOORS + n + i] = b[(du + i + 1) * L + l]


@merged
def enter_interval(lanes: Lanes, shape: Shape, l: int, interval: int) -> bool:
    """Begin an interval of the record; True if the history ends instead."""
    whole = lanes.integers
    whole[l, INTERVAL] = interval
    shake(lanes, len(shape.stride), l)
    if whole[l, INTERVAL] >= whole[l, INTERVALS]:
        return True
    free = whole[l, INTERVAL] + 1 - whole[l, NPTS]
    return free > 0 and free % REST_EVERY == 0 and is_over(lanes, shape, l)
