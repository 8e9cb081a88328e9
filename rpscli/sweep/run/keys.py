"""What identifies the result of a point, whatever study it belongs to."""

from __future__ import annotations

import hashlib
import struct

from rpscli.errors import RpsError
from rpscli.sweep.evaluation.context import StudyContext
from rpscli.sweep.evaluation.points import Point
from rpscli.sweep.points.layout import StudyPoints


def point_key(layout: StudyPoints, context: StudyContext, point: Point) -> bytes:
    """Digest of resolved case, record content, scale, perturbation and solver version.

    A record that cannot be read counts by the reason, so that a repaired one is a new point.
    """
    digest = hashlib.sha256(layout.plan.solver.encode())
    digest.update(layout.plan.analysis.encode())
    digest.update(layout.properties[point.system].digest)
    if layout.plan.analysis == "timehistory":
        assert point.record is not None, "points of histories have a record"
        digest.update(context.records.digest(point.record))
        try:
            factor = context.factor(point)
        except RpsError:
            factor = point.scale
        digest.update(struct.pack("<2d?", factor, point.restitution_change, layout.plan.whole))
    return digest.digest()


def all_keys(layout: StudyPoints, context: StudyContext) -> list[bytes]:
    """Keys of all points, in the order of the study."""
    return [point_key(layout, context, point) for point in layout]
