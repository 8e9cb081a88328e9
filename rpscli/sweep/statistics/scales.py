"""Records of a study that are scaled beyond what is usual."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rpscli.records.ground_motion import LEAST, MOST
from rpscli.records.pulses import SCHEME
from rpscli.sweep.table import Array, Table


def factors(table: Table) -> Array:
    """(points,) factors on the records; NaN where there is none or the record is a pulse."""
    found = table.scale.copy()
    for number, point in enumerate(table.layout):
        if table.layout.plan.measure is None:
            found[number] = point.scale * point.scale_change
        if point.record is None or point.record.source.startswith(SCHEME):
            found[number] = np.nan
    return found


def scale_notes(table: Table) -> Iterator[str]:
    """How many points have an unusual factor, and the one that is farthest from 1."""
    scale = np.abs(factors(table))
    unusual = (scale < LEAST) | (scale > MOST)
    if unusual.any():
        distance = np.abs(np.log(np.where(unusual, np.maximum(scale, 1e-300), 1.0)))
        farthest = int(np.argmax(distance))
        record = table.layout[farthest].record
        assert record is not None, "points of histories have a record"
        yield (
            f"{np.count_nonzero(unusual)} of {len(table)} points scale their record beyond the"
            f" usual {LEAST:g} to {MOST:g}, {record.source} by {scale[farthest]:.4g}"
        )
