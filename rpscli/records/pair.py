"""Two horizontal components of one motion: turned to a direction between them, or together."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from rpscli.records.ground_motion import GroundMotion, MotionComponents, require_one_step


def turned(motion: MotionComponents, rotation: float) -> MotionComponents:
    """A pair turned from x towards y [deg]: what acted along x then acts at that azimuth."""
    if motion.y is None or rotation % 360.0 == 0.0:
        return motion
    x, y = motion.horizontal, motion.y
    along, across = (
        replace(
            rotated(x, y, direction - rotation),
            name=f"{of.name}_{rotation:g}deg",
            source=of.source,
            description=f"{of.description}; pair turned by {rotation:g} deg".lstrip("; "),
        )
        for of, direction in ((x, 0.0), (y, 90.0))
    )
    return replace(motion, horizontal=along, y=across)


def rotated(first: GroundMotion, second: GroundMotion, angle: float) -> GroundMotion:
    """The motion in a plane that stands at an angle to the first component."""
    require_one_step(first, second, "second")
    cosine, sine = _exact_at_right_angles(angle)
    values = np.zeros(max(first.npts, second.npts))
    values[: first.npts] += cosine * first.acceleration
    values[: second.npts] += sine * second.acceleration
    note = f"turned by {angle:g} deg towards {second.name}"
    return replace(
        first,
        acceleration=values,
        description=f"{first.description}; {note}".lstrip("; "),
        warnings=tuple(dict.fromkeys((*first.warnings, *second.warnings))),
    )


def _exact_at_right_angles(angle: float) -> tuple[float, float]:
    """Cosine and sine of an angle [deg]; a component itself is not changed by rounding."""
    quarters, rest = divmod(angle, 90.0)
    c, s = math.cos(math.radians(rest)), math.sin(math.radians(rest))
    return ((c, s), (-s, c), (-c, -s), (s, -c))[int(quarters) % 4]
