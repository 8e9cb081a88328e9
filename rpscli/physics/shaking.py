"""Ground acceleration of a lane in its present interval of the record."""

from __future__ import annotations

from rpscli.physics.jit import part
from rpscli.physics.layout import (
    ACROSS,
    ACROSS_SLOPE,
    INTERVAL,
    INTERVAL_LENGTH,
    NPTS,
    RECORD,
    SCALE,
    STANDARD_GRAVITY,
    TIME,
    UPWARDS,
    UPWARDS_SLOPE,
    VERTICAL,
)
from rpscli.physics.parameters import Floats, Lanes


@part
def shake(lanes: Lanes, L: int, l: int) -> None:
    """Set the acceleration of the interval that begins: linear, and zero after the record."""
    b, whole = lanes.buffer, lanes.integers
    i, scale = whole[l, INTERVAL], b[SCALE * L + l]
    per_time = 1.0 / b[INTERVAL_LENGTH * L + l]
    b[TIME * L + l] = 0.0
    b[ACROSS * L + l], b[ACROSS_SLOPE * L + l] = 0.0, 0.0
    b[UPWARDS * L + l], b[UPWARDS_SLOPE * L + l] = b[STANDARD_GRAVITY * L + l], 0.0
    if i + 1 >= whole[l, NPTS]:
        return
    start, end = between(lanes.acceleration, whole[l, RECORD] + i, scale)
    b[ACROSS * L + l], b[ACROSS_SLOPE * L + l] = start, (end - start) * per_time
    if whole[l, VERTICAL] >= 0:
        start, end = between(lanes.acceleration, whole[l, VERTICAL] + i, scale)
        b[UPWARDS * L + l] += start
        b[UPWARDS_SLOPE * L + l] = (end - start) * per_time


@part
def between(acceleration: Floats, i: int, scale: float) -> tuple[float, float]:
    """Scaled accelerations at the ends of an interval [m/s2]."""
    return scale * acceleration[i], scale * acceleration[i + 1]
