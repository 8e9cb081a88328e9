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
from rpscli.physics.lane import Lane
from rpscli.physics.layout import (
    ACROSS,
    ACROSS_SLOPE,
    INTERVAL,
    INTERVAL_LENGTH,
    NPTS,
    PER_INTERVAL,
    RECORD,
    SCALE,
    STANDARD_GRAVITY,
    START,
    TIME,
    UPWARDS,
    UPWARDS_SLOPE,
    VERTICAL,
)
from rpscli.physics.parameters import Floats
from rpscli.physics.part import part


class Shaking(NamedTuple):
    """a_g and g + a_v at the start of an interval [m/s2], and their slopes over it [m/s3]."""

    across: float
    across_slope: float
    upwards: float
    upwards_slope: float


@part
def shaking_in(lane: Lane, interval: int) -> Shaking:
    """How the ground moves in an interval of the lane's record."""
    s, whole, record = lane.numbers, lane.whole, lane.acceleration
    gravity, scale = s[STANDARD_GRAVITY], s[SCALE]
    if interval + 1 >= whole[NPTS]:
        return Shaking(0.0, 0.0, gravity, 0.0)
    per_time = s[PER_INTERVAL]
    i = whole[RECORD] + interval
    across, end = scale * record[i], scale * record[i + 1]
    slope = (end - across) * per_time
    if whole[VERTICAL] < 0:
        return Shaking(across, slope, gravity, 0.0)
    i = whole[VERTICAL] + interval
    upwards, end = scale * record[i], scale * record[i + 1]
    return Shaking(across, slope, gravity + upwards, (end - upwards) * per_time)


@part
def shake(lane: Lane) -> None:
    """Set the acceleration of the interval that begins."""
    s, interval = lane.numbers, lane.whole[INTERVAL]
    shaking = shaking_in(lane, interval)
    s[START], s[TIME] = interval * s[INTERVAL_LENGTH], 0.0
    s[ACROSS], s[ACROSS_SLOPE] = shaking.across, shaking.across_slope
    s[UPWARDS], s[UPWARDS_SLOPE] = shaking.upwards, shaking.upwards_slope


@part
def shake_block(lane: Lane, c: Floats, h: float, each: int, steps: int) -> None:
    """Write the ground's motion at the instants of a block of steps of length h.

    `each` steps lead to the next sample, and from one to the next. The last instant belongs to the
    step before it: the ground acceleration may jump there.
    """
    whole, gravity = lane.whole, lane.numbers[STANDARD_GRAVITY]
    i = whole[INTERVAL]
    if each == 1 and lane.numbers[TIME] == 0.0 and i + 1 < whole[NPTS]:
        copy_samples(lane, c, AT, whole[RECORD] + i, steps, 0.0)
        if whole[VERTICAL] >= 0:
            copy_samples(lane, c, RISE, whole[VERTICAL] + i, steps, gravity)
        else:
            for k in range(COLUMNS):
                c[RISE * COLUMNS + k], c[RISE_SLOPE * COLUMNS + k] = gravity, 0.0
    else:
        divide_intervals(lane, c, h, each, steps)


@part
def copy_samples(lane: Lane, c: Floats, row: int, start: int, steps: int, rest: float) -> None:
    """Write `rest` plus a record to a row and its slope to the next: a step is an interval."""
    scale, per_time = lane.numbers[SCALE], lane.numbers[PER_INTERVAL]
    first, slopes = row * COLUMNS, (row + 1) * COLUMNS
    samples = lane.acceleration[start : start + steps + 1]
    for k in range(samples.shape[0]):
        c[first + k] = rest + scale * samples[k]
    for k in range(steps):
        c[slopes + k] = (c[first + k + 1] - c[first + k]) * per_time
    for k in range(steps, COLUMNS):
        c[slopes + k] = 0.0
    for k in range(steps + 1, COLUMNS):
        c[first + k] = rest


@part
def divide_intervals(lane: Lane, c: Floats, h: float, each: int, steps: int) -> None:
    """The same where a step does not lead from sample to sample."""
    interval, time = lane.whole[INTERVAL], lane.numbers[TIME]
    shaking = shaking_in(lane, interval)
    to_sample = each
    for k in range(COLUMNS):
        if to_sample == 0:
            interval, time, to_sample = interval + 1, 0.0, each
            shaking = shaking_in(lane, interval)
        c[AT * COLUMNS + k] = shaking.across + shaking.across_slope * time
        c[SLOPE * COLUMNS + k] = shaking.across_slope
        c[RISE * COLUMNS + k] = shaking.upwards + shaking.upwards_slope * time
        c[RISE_SLOPE * COLUMNS + k] = shaking.upwards_slope
        time += h
        to_sample -= 1
    for row, slope in ((AT, SLOPE), (RISE, RISE_SLOPE)):
        before = c[row * COLUMNS + steps - 1]
        c[row * COLUMNS + steps] = before + c[slope * COLUMNS + steps - 1] * h
