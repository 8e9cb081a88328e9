"""What identifies the result of a point, whatever study it belongs to."""

from __future__ import annotations

import hashlib
import struct

from rpscli.errors import RpsError
from rpscli.sweep.design.layout import Design
from rpscli.sweep.evaluation.context import StudyContext
from rpscli.sweep.evaluation.points import Point


def point_key(design: Design, context: StudyContext, point: Point) -> bytes:
    """Digest of resolved case, record content, scale, perturbation and solver version.

    A record that cannot be read counts by the reason, so that a repaired one is a new point.
    """
    digest = hashlib.sha256(design.plan.solver.encode())
    digest.update(design.plan.analysis.encode())
    digest.update(design.properties[point.system].digest)
    if design.plan.analysis == "timehistory":
        assert point.record is not None, "points of histories have a record"
        digest.update(context.records.digest(point.record))
        try:
            factor = context.factor(point)
        except RpsError:
            factor = point.scale
        digest.update(struct.pack("<2d?", factor, point.restitution_change, design.plan.whole))
    return digest.digest()


def all_keys(design: Design, context: StudyContext) -> list[bytes]:
    """Keys of all points, in the order of the study."""
    return [point_key(design, context, point) for point in design]
