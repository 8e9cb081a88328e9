"""The largest tilt, turning points between samples included, and the passage of theta_cr."""

from __future__ import annotations

from rpscli.physics.compile import compiled
from rpscli.physics.formulae.quintic import (
    SETTLED,
    Quintic,
    first_descent,
    offset,
    slope,
    upper_hull,
    value,
)
from rpscli.physics.state import CRITICAL_PASSAGE, Record
from rpscli.physics.transitions.log_event import log_event, time_of
from rpscli.physics.uplifted.steps import path_of


@compiled
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


@compiled
def raise_peak(s: Record, l: int, block: Record, log: Record) -> None:
    """Raise the largest tilt by that of the step just taken, turning points included."""
    height, fraction = s.next_theta[l], 1.0
    path = path_of(s, l)
    turns = s.theta_dot[l] > 0.0 and s.next_theta_dot[l] < 0.0
    if turns and upper_hull(path) > s.max_theta[l]:
        fraction, height = crest(path)
    if height > s.max_theta[l]:
        s.max_theta[l] = height
        s.max_theta_time[l] = s.interval_start[l] + (s.time[l] + fraction * s.step[l])
        if height > s.theta_cr[l] and s.critical_time[l] < 0.0:
            log_critical_passage(s, l, block, log, path)


@compiled
def log_critical_passage(s: Record, l: int, block: Record, log: Record, path: Quintic) -> None:
    """Note when theta_cr was passed for the first time, within the step just taken.

    Parameters
    ----------
    path
        The tilt over the step [rad].
    """
    level, h, side = s.theta_cr[l], s.step[l], s.side[l]
    t = min(first_descent(offset(path, -1.0, level), SETTLED, block.piece), 1.0)
    rate = side * slope(path, t) / h if h > 0.0 else 0.0
    s.critical_time[l] = time_of(s, l) + t * h
    log_event(s, l, log, s.critical_time[l], CRITICAL_PASSAGE, side * level, rate, rate, 0.0)
