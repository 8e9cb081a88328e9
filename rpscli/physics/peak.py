"""The largest tilt, turning points between samples included, and the passage of theta_cr."""

from __future__ import annotations

from rpscli.physics.events import (
    SETTLED,
    Quintic,
    first_descent,
    offset,
    quintic,
    slope,
    upper_hull,
    value,
)
from rpscli.physics.lane import Lane
from rpscli.physics.layout import (
    CRITICAL_PASSAGE,
    CRITICAL_TIME,
    NEXT_RATE,
    NEXT_TILT,
    NEXT_TURN,
    PEAK,
    PEAK_TIME,
    RATE,
    SIDE,
    START,
    STEP,
    THETA_CR,
    TILT,
    TIME,
    TURN,
)
from rpscli.physics.parameters import Floats
from rpscli.physics.part import part, routine
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
def tilt_of(s: Floats) -> Quintic:
    """The tilt of a lane over the step just taken, from its numbers."""
    return quintic(s[STEP], s[TILT], s[RATE], s[TURN], s[NEXT_TILT], s[NEXT_RATE], s[NEXT_TURN])


@routine
def watch_peak(lane: Lane) -> None:
    """Raise the largest tilt by that of the step just taken, turning points included."""
    s = lane.numbers
    height, fraction = s[NEXT_TILT], 1.0
    path = tilt_of(s)
    if s[RATE] > 0.0 and s[NEXT_RATE] < 0.0 and upper_hull(path) > s[PEAK]:
        fraction, height = crest(path)
    if height > s[PEAK]:
        s[PEAK] = height
        s[PEAK_TIME] = s[START] + (s[TIME] + fraction * s[STEP])
        if height > s[THETA_CR] and s[CRITICAL_TIME] < 0.0:
            note_critical_passage(lane, path)


@part
def note_critical_passage(lane: Lane, path: Quintic) -> None:
    """Note when theta_cr was passed for the first time, within the step just taken."""
    s = lane.numbers
    level, h, side = s[THETA_CR], s[STEP], s[SIDE]
    t = min(first_descent(offset(path, -1.0, level), SETTLED, lane.piece), 1.0)
    rate = side * slope(path, t) / h if h > 0.0 else 0.0
    s[CRITICAL_TIME] = now(lane) + t * h
    note(lane, s[CRITICAL_TIME], CRITICAL_PASSAGE, side * level, rate, rate, 0.0)
