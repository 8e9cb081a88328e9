"""Two horizontal components of one motion, turned to a direction between them."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from rpscli.records.ground_motion import GroundMotion, require_one_step
from rpscli.records.quantities import Query, parse_query

HALF_TURN = 180.0
"""Directions half a turn apart are the same motion with the other sign [deg]."""

_ANGLE = re.compile(r"(?<=[?&])angle=([^&]*)(&|$)")


class Direction(NamedTuple):
    """A source with an angle: what it is without, and the angle [deg]."""

    pair: str
    angle: float


def direction_of(source: str) -> Direction | None:
    """The pair and the angle of a source; None if it names no angle."""
    match = _ANGLE.search(source)
    if match is None:
        return None
    angle = angle_of(parse_query(match[0].rstrip("&"), source, ("angle",)))
    return Direction((source[: match.start()] + source[match.end() :]).rstrip("?&"), angle)


def angle_of(query: Query) -> float:
    """The option `angle` of a source [deg]."""
    return query.quantity("angle", "direction")


def rotated(first: GroundMotion, second: GroundMotion, angle: float) -> GroundMotion:
    """What a structure sees whose plane stands at an angle to the first component."""
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
