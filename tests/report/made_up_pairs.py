"""Histories under both components that are made of one of a plane, looked at from elsewhere."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Any

import numpy as np

from report.small_results import KINDS, Array
from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.trace import Direction

ANGLE = np.radians(140.0)
"""Of the plane of motion, from x towards y."""


def turned(kind: str = "rolls", angle: float | Array = ANGLE) -> TimeHistoryResult:
    """A history in a vertical plane at an azimuth (samples,) [rad], told in x and y."""
    plane = KINDS[kind]()
    trace = plane.trace
    names = [each.name for each in fields(Direction)]
    cosine, sine = np.broadcast_arrays(np.cos(angle), np.sin(angle), trace.time)[:2]

    def along(part: Array) -> dict[str, Array]:
        found = {name: getattr(trace, name) for name in names}
        shapes = {n: (-1, *[1] * (v.ndim - 1)) for n, v in found.items() if v is not None}
        return found | {n: part.reshape(shape) * found[n] for n, shape in shapes.items()}

    azimuth = np.arctan2(np.sign(trace.rotation) * sine, np.sign(trace.rotation) * cosine)
    pair: dict[str, Any] = along(cosine) | {
        "rotation": np.abs(trace.rotation),
        "rotation_rate": np.sign(trace.rotation) * trace.rotation_rate,
        "azimuth": np.where(trace.rotation == 0.0, 0.0, azimuth),
        "y": Direction(**along(sine)),
    }
    x, y = (
        replace(plane.record, acceleration=plane.record.acceleration * part, name=name)
        for name, part in (("x", np.cos(ANGLE)), ("y", np.sin(ANGLE)))
    )
    events = tuple(
        replace(each, kind="pass", azimuth=ANGLE, least_tilt=3e-5, nearness=0.25, loss_share=0.5)
        if each.kind == "impact"
        else each
        for each in plane.events
    )
    return replace(
        plane, record=x, motion=replace(plane.motion, horizontal=x, y=y), events=events,
        trace=replace(trace, **pair),
    )  # fmt: skip
