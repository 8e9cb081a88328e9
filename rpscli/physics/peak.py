"""The largest tilt, turning points between samples included, and the passage of theta_cr."""

from __future__ import annotations

from rpscli.physics.events import Quintic, first_descent, offset, slope, upper_hull, value
from rpscli.physics.inspection import tilt_path
from rpscli.physics.jit import part
from rpscli.physics.layout import (
    AHEAD,
    AHEAD_RATE,
    CRITICAL_PASSAGE,
    CRITICAL_TIME,
    PEAK,
    PEAK_TIME,
    SCALARS,
    SIDE,
    START,
    STEP,
    THETA_CR,
    TIME,
    VELOCITY,
)
from rpscli.physics.parameters import Lanes, Shape
from rpscli.physics.switch import note, now


@part
def crest(path: Quintic) -> tuple[float, float]:
    """Fraction of the step and height of the tilt's maximum, where x' falls through zero.

    Bisection of the slope: it never leaves the step, and is rarely needed.
    """
    low, high = 0.0, 1.0
    for _ in range(50):
        t = 0.5 * (low + high)
        if slope(path, t) > 0.0:
            low = t
        else:
            high = t
    return low, value(path, low)


@part
def watch_peak(lanes: Lanes, shape: Shape, l: int) -> None:
    """Raise the largest tilt by that of the step just taken, turning points included."""
    n, L = len(shape.floors), len(shape.stride)
    b = lanes.buffer
    height, fraction = b[(SCALARS + AHEAD * (n + 1)) * L + l], 1.0
    before = b[(SCALARS + VELOCITY * (n + 1)) * L + l]
    after = b[(SCALARS + AHEAD_RATE * (n + 1)) * L + l]
    path = tilt_path(b, n, L, l)
    if before > 0.0 and after < 0.0 and upper_hull(path) > b[PEAK * L + l]:
        fraction, height = crest(path)
    if height > b[PEAK * L + l]:
        b[PEAK * L + l] = height
        b[PEAK_TIME * L + l] = b[START * L + l] + (b[TIME * L + l] + fraction * b[STEP * L + l])
        if height > b[THETA_CR * L + l] and b[CRITICAL_TIME * L + l] < 0.0:
            note_critical_passage(lanes, shape, l)


@part
def note_critical_passage(lanes: Lanes, shape: Shape, l: int) -> None:
    """Note when theta_cr was passed for the first time, within the step just taken."""
    n, L = len(shape.floors), len(shape.stride)
    b = lanes.buffer
    level, h = b[THETA_CR * L + l], b[STEP * L + l]
    path = tilt_path(b, n, L, l)
    t = min(first_descent(offset(path, -1.0, level), lanes.piece), 1.0)
    time, side = now(lanes, L, l) + t * h, b[SIDE * L + l]
    rate = side * slope(path, t) / h if h > 0.0 else 0.0
    b[CRITICAL_TIME * L + l] = time
    note(lanes, l, time, CRITICAL_PASSAGE, side * level, rate, rate, 0.0)
