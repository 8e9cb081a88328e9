"""One uplifted step: step, detect, locate.

The step is taken as if its phase of motion went on for ever. If the tilt then leaves the range of
the phase - below 0 or above beta while rolling, below beta or above the overturning limit while
rocking - the step is taken again up to the passage.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rpscli.physics.events import (
    NO_PASSAGE,
    Quintic,
    first_descent,
    lower_hull,
    offset,
    quintic,
    slope,
    upper_hull,
    value,
)
from rpscli.physics.jit import kernel
from rpscli.physics.layout import (
    IMPACT,
    OVERTURNING,
    PEAK,
    PEAK_TIME,
    ROCKING_TO_ROLLING,
    ROLLING,
    ROLLING_TO_ROCKING,
    TILT,
    TILT_RATE,
)
from rpscli.physics.parameters import Floors, Podium
from rpscli.physics.runge_kutta import step
from rpscli.physics.uplifted import Shaking

NOTHING = -1
"""No event in the step."""

NOT_FINITE = -2
"""The step gave an infinity or no number."""

RESTEPS = 4
"""At most so many re-steps locate an event; two suffice but for grazing."""


@kernel
def tilt_path(
    y: NDArray[np.float64], k: NDArray[np.float64], end: NDArray[np.float64], h: float
) -> Quintic:
    """The tilt x over the step that was just taken."""
    return quintic(
        h,
        y[TILT],
        y[TILT_RATE],
        k[0, TILT_RATE],
        end[TILT],
        end[TILT_RATE],
        k[6, TILT_RATE],
    )


@kernel
def phase_range(podium: Podium, motion: int) -> tuple[float, float, int, int]:
    """Least and largest tilt of a phase, and the events at either."""
    if motion == ROLLING:
        return 0.0, podium.beta, IMPACT, ROLLING_TO_ROCKING
    if podium.beta > 0.0:
        return podium.beta, podium.theta_limit, ROCKING_TO_ROLLING, OVERTURNING
    return 0.0, podium.theta_limit, IMPACT, OVERTURNING


@kernel
def first_exit(
    podium: Podium, motion: int, path: Quintic, piece: NDArray[np.float64]
) -> tuple[float, float, int]:
    """Fraction of the step, tilt and kind of the first event; fraction `NO_PASSAGE` if none."""
    low, high, down, up = phase_range(podium, motion)
    if motion == ROLLING:
        high = min(high, podium.theta_limit)
        if high == podium.theta_limit:
            up = OVERTURNING
    first, level, kind = NO_PASSAGE, 0.0, NOTHING
    if lower_hull(path) < low or path[0] < low:
        first = first_descent(offset(path, 1.0, low), piece)
        if first <= 1.0:
            level, kind = low, down
    if upper_hull(path) > high or path[0] > high:
        t = first_descent(offset(path, -1.0, high), piece)
        if t < first:
            first, level, kind = t, high, up
    return first, level, kind


@kernel
def fly(
    podium: Podium,
    floors: Floors,
    motion: int,
    side: float,
    shaking: Shaking,
    time: float,
    h: float,
    y: NDArray[np.float64],
    k: NDArray[np.float64],
    end: NDArray[np.float64],
    piece: NDArray[np.float64],
) -> tuple[float, int, int]:
    """Step the uplifted structure by h, or to the first event if that comes before.

    Parameters
    ----------
    y, end
        State before and, written, after.
    k
        Slopes (7, m); row 0 is given, row 6 belongs to `end` afterwards.

    Returns
    -------
    Time advanced [s]; the event at its end, `NOTHING` or `NOT_FINITE`; steps taken.
    """
    step(podium, floors, motion, side, shaking, time, h, y, k, end)
    steps = 1
    if not math.isfinite(end[TILT] + end[TILT_RATE] + k[6, TILT_RATE]):
        return h, NOT_FINITE, steps
    fraction, level, kind = first_exit(podium, motion, tilt_path(y, k, end, h), piece)
    if kind == NOTHING:
        return h, NOTHING, steps
    advanced = fraction * h
    for _ in range(RESTEPS):
        step(podium, floors, motion, side, shaking, time, advanced, y, k, end)
        steps += 1
        miss = end[TILT] - level
        change = -miss / end[TILT_RATE] if end[TILT_RATE] != 0.0 else math.inf
        if abs(miss) < 1e-15 or not 0.0 <= advanced + change <= h or abs(change) < 1e-15 * h:
            break
        advanced += change
    end[TILT] = level
    return advanced, kind, steps


@kernel
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


@kernel
def watch_peak(
    y: NDArray[np.float64],
    k: NDArray[np.float64],
    end: NDArray[np.float64],
    h: float,
    time: float,
    tally: NDArray[np.float64],
) -> None:
    """Raise the largest tilt by that of a step of length h from `time`, turning points included."""
    height, when = end[TILT], time + h
    if y[TILT_RATE] > 0.0 and end[TILT_RATE] < 0.0:
        fraction, height = crest(tilt_path(y, k, end, h))
        when = time + fraction * h
    if height > tally[PEAK]:
        tally[PEAK], tally[PEAK_TIME] = height, when
