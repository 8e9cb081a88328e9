"""Ground acceleration of a lane: linear between the samples of the record, zero after the last.

The ground moves in one direction, or in x and in y: then what is called `system`, `block` or
`margin` are two, of which `along` takes one.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from rpscli.physics.core.compile import compiled, compiled_with, prefetch
from rpscli.physics.core.records import INSTANTS, NO_RECORD, Floats, Record


class Ground(NamedTuple):
    """How the ground moves in an interval."""

    a_g: float  # a_g and g + a_v at the start of an interval [m/s2]
    a_g_slope: float  # their slopes over it [m/s3]
    g_up: float  # a_g and g + a_v at the start of an interval [m/s2]
    g_up_slope: float  # their slopes over it [m/s3]


@compiled_with("record_y", otherwise=1)
def directions(_s: Record) -> int:
    """Horizontal directions in which the ground moves."""
    return 2


def _itself(_s: Record, given: Any, _axis: int) -> Any:
    return given


@compiled_with("record_y", otherwise=_itself)
def along(_s: Record, given: Any, axis: int) -> Any:
    """What belongs to a direction, of what there is one in each."""
    return given[axis]


def _record_of_one(s: Record, l: int, _axis: int) -> int:
    return int(s.record[l])


@compiled_with("record_y", otherwise=_record_of_one)
def record_along(s: Record, l: int, axis: int) -> int:
    """Offset of a lane's record in a direction."""
    return int(s.record[l] if axis == 0 else s.record_y[l])


AHEAD = 16
"""Samples, two lines of the cache: every lane reads elsewhere, which no processor foresees."""


@compiled
def ground_in(s: Record, l: int, acceleration: Floats, interval: int, record: int) -> Ground:
    """How the ground moves in an interval, along the direction of one of the lane's records."""
    gravity, scale = s.gravity[l], s.scale[l]
    if interval + 1 >= s.npts[l]:
        return Ground(0.0, 0.0, gravity, 0.0)
    rate = s.sampling_rate[l]
    i = record + interval
    prefetch(acceleration, i + AHEAD)
    a_g, end = scale * acceleration[i], scale * acceleration[i + 1]
    slope = (end - a_g) * rate
    if s.vertical[l] == NO_RECORD:
        return Ground(a_g, slope, gravity, 0.0)
    i = s.vertical[l] + interval
    a_v, end = scale * acceleration[i], scale * acceleration[i + 1]
    return Ground(a_g, slope, gravity + a_v, (end - a_v) * rate)


@compiled
def set_ground(s: Record, l: int, acceleration: Floats) -> None:
    """Set the acceleration of the interval that begins."""
    interval = s.interval[l]
    ground = ground_in(s, l, acceleration, interval, s.record[l])
    s.interval_start[l], s.time[l] = interval * s.dt[l], 0.0
    s.a_g[l], s.a_g_slope[l] = ground.a_g, ground.a_g_slope
    s.g_up[l], s.g_up_slope[l] = ground.g_up, ground.g_up_slope
    set_ground_in_y(s, l, acceleration)


@compiled_with("record_y")
def set_ground_in_y(s: Record, l: int, acceleration: Floats) -> None:
    """The same of the second record."""
    ground = ground_in(s, l, acceleration, s.interval[l], s.record_y[l])
    s.a_g_y[l], s.a_g_y_slope[l] = ground.a_g, ground.a_g_slope


@compiled
def set_ground_of_block(
    s: Record,
    l: int,
    block: Record,
    acceleration: Floats,
    h: float,
    each: int,
    steps: int,
    record: int,
) -> None:
    """Write the ground's motion, of one of the lane's records, at the instants of a block [h s].

    The last instant belongs to the step before it: the ground acceleration may jump there.
    """
    i = s.interval[l]
    if each == 1 and s.time[l] == 0.0 and i + 1 < s.npts[l]:
        start = record + i
        copy_samples(s, l, acceleration, block.a_g, block.a_g_slope, start, steps, 0.0)
        if s.vertical[l] == NO_RECORD:
            for k in range(INSTANTS):
                block.g_up[k], block.g_up_slope[k] = s.gravity[l], 0.0
        else:
            start = s.vertical[l] + i
            copy_samples(
                s, l, acceleration, block.g_up, block.g_up_slope, start, steps, s.gravity[l]
            )
    else:
        divide_intervals(s, l, block, acceleration, h, each, steps, record)


@compiled
def copy_samples(
    s: Record,
    l: int,
    acceleration: Floats,
    values: Floats,
    slopes: Floats,
    start: int,
    steps: int,
    rest: float,
) -> None:
    """Write `rest` plus a record to values and slopes: a step is an interval."""
    scale, rate = s.scale[l], s.sampling_rate[l]
    for k in range(steps + 1):
        values[k] = rest + scale * acceleration[start + k]
    for k in range(steps):
        slopes[k] = (values[k + 1] - values[k]) * rate
    for k in range(steps, INSTANTS):
        slopes[k] = 0.0
    for k in range(steps + 1, INSTANTS):
        values[k] = rest


@compiled
def divide_intervals(
    s: Record,
    l: int,
    block: Record,
    acceleration: Floats,
    h: float,
    each: int,
    steps: int,
    record: int,
) -> None:
    """The same where a step does not lead from sample to sample."""
    interval, time = s.interval[l], s.time[l]
    ground = ground_in(s, l, acceleration, interval, record)
    to_sample = each
    for k in range(INSTANTS):
        if to_sample == 0:
            interval, time, to_sample = interval + 1, 0.0, each
            ground = ground_in(s, l, acceleration, interval, record)
        block.a_g[k] = ground.a_g + ground.a_g_slope * time
        block.a_g_slope[k] = ground.a_g_slope
        block.g_up[k] = ground.g_up + ground.g_up_slope * time
        block.g_up_slope[k] = ground.g_up_slope
        time += h
        to_sample -= 1
    last = steps - 1
    block.a_g[steps] = block.a_g[last] + block.a_g_slope[last] * h
    block.g_up[steps] = block.g_up[last] + block.g_up_slope[last] * h


# Counting and logging events.


@compiled
def time_of(s: Record, l: int) -> float:
    """Time of a lane since the start of its record [s]."""
    return float(s.interval_start[l] + s.time[l])


@compiled
def log_event(
    s: Record,
    l: int,
    log: Record,
    time: float,
    kind: int,
    theta: float,
    before: float,
    after: float,
    lost: float,
) -> int:
    """Count an event, and log it if there is room (the caller sees from the counts if not).

    Returns its row in the log, or -1.
    """
    row = -1
    if log.shape[0] > 0:
        row = 0
        for i in range(s.events.shape[1]):
            row += s.events[l, i]
        if row < log.shape[0]:
            entry = log[row]
            entry.time, entry.kind, entry.theta = time, kind, theta
            entry.theta_dot_before, entry.theta_dot_after = before, after
            entry.energy_lost = lost
        else:
            row = -1
    s.events[l, kind] += 1
    return row


@compiled
def enter_interval(s: Record, l: int, acceleration: Floats, interval: int) -> bool:
    """Begin an interval of the record; True if it is beyond the history's end."""
    s.interval[l] = interval
    set_ground(s, l, acceleration)
    return bool(interval >= s.intervals[l])
