"""Long histories with fewer samples, for figures: the extremes of every stretch stay."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rpscli.report.figures.displacement import shown_floors

if TYPE_CHECKING:
    from rpscli.analyses.results import TimeHistoryResult

MOST = 50_000
"""Samples that are drawn as they are."""

STRETCHES = 2_000
"""More than a figure has points across."""


def extremes(*curves: NDArray[Any]) -> NDArray[np.intp]:
    """Samples to draw, in order: the first, the last, and the least and largest of each stretch.

    Parameters
    ----------
    *curves
        (samples,) each; all samples where they are few.
    """
    count = len(curves[0])
    if count <= MOST:
        return np.arange(count)
    length = -(-count // STRETCHES)
    ends = np.array([0, count - 1])
    found = [ends]
    for curve in curves:
        rows = np.pad(curve, (0, -count % length), mode="edge").reshape(-1, length)
        starts = np.arange(len(rows)) * length
        found += [starts + rows.argmin(axis=1), starts + rows.argmax(axis=1)]
    return np.unique(np.minimum(np.concatenate(found), count - 1))


def thinned(result: TimeHistoryResult) -> TimeHistoryResult:
    """The history with the samples that its figures need; maxima and events stay what they are.

    But for those of velocities, which are of all samples, and are not drawn: these are no numbers.
    """
    trace = result.trace
    if len(trace.time) <= MOST:
        return result
    floors = [floor - 1 for floor in shown_floors(result.structure.storeys)]
    kept = extremes(
        trace.ground_acceleration, trace.rotation, trace.phase, trace.cap_beam_displacement,
        trace.driving_moment, trace.energy_input, trace.energy_stored,
        *trace.floor_displacements.T[floors], *trace.devices.force.T, *trace.devices.displacement.T,
    )  # fmt: skip
    few = trace.at(kept)
    few = replace(few, floor_velocities=np.full_like(few.floor_velocities, np.nan))
    return replace(result, trace=few, fixed_base=_without_histories(result))


def _without_histories(result: TimeHistoryResult) -> Any:
    fixed = result.fixed_base
    if fixed is None:
        return None
    none = np.empty((0, result.structure.storeys))
    return replace(fixed, floor_displacements=none, acceleration_histories=none)
