"""Histories under both components in one plane: in x, in y, or where the columns lean."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.trace import Trace

Way = Literal["x", "y"]
WAYS: tuple[Way, ...] = get_args(Way)


def record_name(result: TimeHistoryResult) -> str:
    """What shook it horizontally."""
    name, y = result.record.name, result.motion.y
    pair, found, turned = name.partition("_both")
    if y is None or not found:
        return name if y is None else f"{name}, y: {y.name}"
    rest = "both components" if y.name.startswith(pair) else f"y: {y.name}"
    return f"{pair}{turned}, {rest}"


def lean_azimuth(trace: Trace) -> NDArray[np.float64]:
    """Of the plane in which columns lean (samples,) [rad]: no half turns, in contact in between."""
    assert trace.azimuth is not None, "both components act"
    leans = np.flatnonzero(trace.rotation > 0.0)
    if not leans.size:
        return np.zeros_like(trace.azimuth)
    # A plane has no front: passing upright leaves it where it is.
    turned = np.unwrap(trace.azimuth[leans], period=np.pi)
    return np.interp(np.arange(len(trace.azimuth)), leans, turned)


def component(result: TimeHistoryResult, way: Way) -> TimeHistoryResult:
    """What a history has in x or in y; rotation and energies stay those of both."""
    trace = result.trace
    in_y = {} if trace.y is None or way == "x" else vars(trace.y)
    return replace(result, trace=replace(trace, **in_y, azimuth=None, y=None))


def in_plane(result: TimeHistoryResult, *, one_sided: bool = False) -> TimeHistoryResult:
    """The history where the columns lean, to both sides or to one; planar ones as they are."""
    trace = result.trace
    if trace.y is None or trace.azimuth is None:
        return result
    plane = trace.azimuth if one_sided else lean_azimuth(trace)
    along = {}
    for name in (each.name for each in fields(trace.y)):
        x, y = getattr(trace, name), getattr(trace.y, name)
        cosine, sine = (of(plane).reshape(-1, *[1] * (x.ndim - 1)) for of in (np.cos, np.sin))
        along[name] = cosine * x + sine * y
    side = np.where(np.cos(trace.azimuth - plane) < 0.0, -1.0, 1.0)
    rotation, rate = side * trace.rotation, side * trace.rotation_rate
    seen = replace(trace, **along, rotation=rotation, rotation_rate=rate, azimuth=None, y=None)
    return replace(result, trace=seen)
