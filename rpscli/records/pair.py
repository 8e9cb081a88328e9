"""Two horizontal components of one motion: turned to a direction between them, or together."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from rpscli.errors import RecordError
from rpscli.records.ground_motion import GroundMotion, MotionComponents, require_one_step
from rpscli.records.quantities import Query, parse_query, split_option

HALF_TURN = 180.0
"""Directions half a turn apart are the same motion with the other sign [deg]."""


class Direction(NamedTuple):
    """A source with an angle: what it is without, and the angle [deg]."""

    pair: str
    angle: float


def direction_of(source: str) -> Direction | None:
    """The pair and the angle of a source; None if it names no angle."""
    pair, angle = split_option(source, "angle")
    return None if angle is None else Direction(pair, _degrees(source, "angle", angle))


def together(source: str) -> Direction | None:
    """The pair and the rotation of a source whose components act together; None if it is single."""
    without, both = split_option(source, "both")
    pair, rotation = split_option(without, "rotation")
    if both is None and rotation is None:
        return None
    if both is None:
        raise RecordError(f"{source}: rotation turns both components together; write both&rotation")
    if split_option(pair, "angle")[1] is not None:
        raise RecordError(
            f"{source}: angle= is one direction between the components, in which a plane structure"
            " is shaken; both has them act together, in two directions: keep one of the options, or"
            " turn the pair by rotation= in place of angle="
        )
    return Direction(pair, 0.0 if rotation is None else _degrees(source, "rotation", rotation))


def turned_source(source: str, rotation: float) -> str:
    """A source of both components together, turned further [deg]."""
    both = together(source)
    if both is None or rotation == 0.0:
        return source
    mark = "&" if "?" in both.pair else "?"
    return f"{both.pair}{mark}both&rotation={both.angle + rotation!r}"


def _degrees(source: str, name: str, value: str) -> float:
    return parse_query(f"{name}={value}", source, (name,)).quantity(name, "direction")


def angle_of(query: Query) -> float:
    """The option `angle` of a source [deg]."""
    return query.quantity("angle", "direction")


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
