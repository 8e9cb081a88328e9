"""Ground acceleration of a lane: linear between the samples of the record, zero after the last."""

from __future__ import annotations

from typing import NamedTuple

from rpscli.physics.contact_layout import (
    AT,
    COLUMNS,
    RISE,
    RISE_SLOPE,
    SLOPE,
)
from rpscli.physics.jit import merged, part
from rpscli.physics.layout import (
    ACROSS,
    ACROSS_SLOPE,
    INTERVAL,
    INTERVAL_LENGTH,
    NPTS,
    RECORD,
    SCALE,
    STANDARD_GRAVITY,
    START,
    TIME,
    UPWARDS,
    UPWARDS_SLOPE,
    VERTICAL,
)
from rpscli.physics.parameters import Floats, Lanes


class Shaking(NamedTuple):
    """a_g and g + a_v at the start of an interval [m/s2], and their slopes over it [m/s3]."""

    across: float
    across_slope: float
    upwards: float
    upwards_slope: float


@merged
def shaking_in(lanes: Lanes, L: int, l: int, interval: int) -> Shaking:
    """How the ground moves in an interval of the lane's record."""
    b, whole, record = lanes.buffer, lanes.integers, lanes.acceleration
    gravity, scale = b[STANDARD_GRAVITY * L + l], b[SCALE * L + l]
    if interval + 1 >= whole[l, NPTS]:
        return Shaking(0.0, 0.0, gravity, 0.0)
    per_time = 1.0 / b[INTERVAL_LENGTH * L + l]
    i = whole[l, RECORD] + interval
    across, end = scale * record[i], scale * record[i + 1]
    slope = (end - across) * per_time
    if whole[l, VERTICAL] < 0:
        return Shaking(across, slope, gravity, 0.0)
    i = whole[l, VERTICAL] + interval
    upwards, end = scale * record[i], scale * record[i + 1]
    return Shaking(across, slope, gravity + upwards, (end - upwards) * per_time)


@merged
def shake(lanes: Lanes, L: int, l: int) -> None:
    """Set the acceleration of the interval that begins."""
    b = lanes.buffer
    interval = lanes.integers[l, INTERVAL]
    shaking = shaking_in(lanes, L, l, interval)
    b[START * L + l], b[TIME * L + l] = interval * b[INTERVAL_LENGTH * L + l], 0.0
    b[ACROSS * L + l], b[ACROSS_SLOPE * L + l] = shaking.across, shaking.across_slope
    b[UPWARDS * L + l], b[UPWARDS_SLOPE * L + l] = shaking.upwards, shaking.upwards_slope


@part
def shake_block(lanes: Lanes, L: int, l: int, c: Floats, h: float, each: int, steps: int) -> None:
    """Write the ground's motion at the instants of a block of steps of length h.

    `each` steps lead to the next sample, and from one to the next. The last instant belongs to the
    step before it: the ground acceleration may jump there.
    """
    b = lanes.buffer
    interval, time = lanes.integers[l, INTERVAL], b[TIME * L + l]
    shaking = shaking_in(lanes, L, l, interval)
    to_sample = each
    for k in range(COLUMNS):
        if to_sample == 0:
            interval, time, to_sample = interval + 1, 0.0, each
            shaking = shaking_in(lanes, L, l, interval)
        c[AT * COLUMNS + k] = shaking.across + shaking.across_slope * time
        c[SLOPE * COLUMNS + k] = shaking.across_slope
        c[RISE * COLUMNS + k] = shaking.upwards + shaking.upwards_slope * time
        c[RISE_SLOPE * COLUMNS + k] = shaking.upwards_slope
        time += h
        to_sample -= 1
    for row, slope in ((AT, SLOPE), (RISE, RISE_SLOPE)):
        before = c[row * COLUMNS + steps - 1]
        c[row * COLUMNS + steps] = before + c[slope * COLUMNS + steps - 1] * h
