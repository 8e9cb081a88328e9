"""From one sample of the record to the next: store, and see whether the history is over."""

from __future__ import annotations

from rpscli.physics.lane import Lane
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
    SIDE,
    VELOCITY,
)
from rpscli.physics.part import part, routine
from rpscli.physics.rest import is_over
from rpscli.physics.shaking import shake

REST_EVERY = 8
"""After the record, so many samples pass between looks at whether anything can still happen."""


@routine
def store_sample(lane: Lane) -> None:
    """Keep the state at the start of the present interval, if there is room."""
    s, x, whole = lane.numbers, lane.blocks, lane.whole
    if whole[INTERVAL] >= lane.samples.shape[0]:
        return
    row, n, side = lane.samples[whole[INTERVAL]], x.shape[1] - 1, s[SIDE]
    row[ROW_ROTATION], row[ROW_RATE] = side * x[POSITION, 0], side * x[VELOCITY, 0]
    stands = whole[MOTION] == FULL_CONTACT
    row[ROW_ACCELERATION] = 0.0 if stands else side * x[ACCELERATION, 0]
    row[ROW_PHASE] = whole[MOTION]
    row[ROW_INPUT], row[ROW_DAMPED], row[ROW_LOST] = s[INPUT], s[DAMPED], s[LOST]
    for i in range(n):
        row[ROW_FLOORS + i] = x[POSITION, i + 1]
        row[ROW_FLOORS + n + i] = x[VELOCITY, i + 1]


@part
def enter_interval(lane: Lane, interval: int) -> bool:
    """Begin an interval of the record; True if the history ends instead."""
    whole = lane.whole
    whole[INTERVAL] = interval
    shake(lane)
    if interval >= whole[INTERVALS]:
        return True
    free = interval + 1 - whole[NPTS]
    return free > 0 and free % REST_EVERY == 0 and is_over(lane)
