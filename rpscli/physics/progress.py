"""From one sample of the record to the next: store, and see whether the history is over."""

from __future__ import annotations

from rpscli.physics.contact_layout import SHAPES
from rpscli.physics.energy import phase_of
from rpscli.physics.lane import Lane
from rpscli.physics.layout import (
    DAMPED,
    DIAMETER,
    DQ,
    FULL_CONTACT,
    INPUT,
    INTERVAL,
    INTERVALS,
    LOST,
    MOTION,
    NPTS,
    RATE,
    ROW_ACCELERATION,
    ROW_DAMPED,
    ROW_FLOORS,
    ROW_INPUT,
    ROW_LOST,
    ROW_PHASE,
    ROW_RATE,
    ROW_ROTATION,
    SIDE,
    TILT,
    TURN,
    Q,
)
from rpscli.physics.part import part, routine
from rpscli.physics.rest import is_over
from rpscli.physics.shaking import shake
from rpscli.physics.tilt import cap_beam_displacement, path_height
from rpscli.physics.trigonometry import sine_cosine

REST_EVERY = 8
"""After the record, so many samples pass between looks at whether anything can still happen."""


@routine
def store_sample(lane: Lane) -> None:
    """Keep the state at the start of the present interval, if there is room."""
    s, x, z, whole = lane.numbers, lane.blocks, lane.modes, lane.whole
    if whole[INTERVAL] >= lane.samples.shape[0]:
        return
    row, n, side = lane.samples[whole[INTERVAL]], x.shape[1], s[SIDE]
    row[ROW_ROTATION], row[ROW_RATE] = side * s[TILT], side * s[RATE]
    stands = whole[MOTION] == FULL_CONTACT
    row[ROW_ACCELERATION] = 0.0 if stands else side * s[TURN]
    row[ROW_PHASE] = whole[MOTION]
    row[ROW_INPUT], row[ROW_DAMPED], row[ROW_LOST] = s[INPUT], s[DAMPED], s[LOST]
    base, base_rate = 0.0, 0.0
    if not stands:
        phase, (sine, cosine) = phase_of(s), sine_cosine(s[TILT])
        base = side * s[DIAMETER] * cap_beam_displacement(phase, s[TILT], cosine, sine)
        base_rate = side * s[DIAMETER] * path_height(phase, cosine, sine) * s[RATE]
    for i in range(n):
        u, du = base, base_rate
        for r in range(n):
            u += z[SHAPES + r, i] * x[Q, r]
            du += z[SHAPES + r, i] * x[DQ, r]
        row[ROW_FLOORS + i], row[ROW_FLOORS + n + i] = u, du


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
