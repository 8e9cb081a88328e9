"""What the points of a study share: its systems and ground motions, and how these are scaled."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rpscli.analyses.demand import Request
from rpscli.records.measures import Measure, factor_to
from rpscli.sweep.evaluation.points import Plan, Point
from rpscli.sweep.evaluation.record_cache import RecordCache
from rpscli.sweep.evaluation.results import Array
from rpscli.sweep.evaluation.systems import Systems

PEAKS: tuple[Measure, ...] = ("PGA", "PGV")
"""What the table of a study tells of each scaled motion."""


class StudyContext:
    """Systems and ground motions of a plan, shared by all batches of a process."""

    def __init__(self, plan: Plan) -> None:
        self.plan = plan
        self.records = RecordCache()
        self.systems = Systems(plan)

    def factor(self, point: Point) -> float:
        """Factor on the record of a point.

        Raises
        ------
        RpsError
            If the record cannot be read, or cannot be scaled to the measure.
        """
        measure = self.plan.measure
        if measure is None:
            return point.scale * point.scale_change
        assert point.record is not None, "points of histories have a record"
        unscaled = self.records.intensity(
            point.record, measure.measure, point.period, measure.damping
        )
        factor = factor_to(point.scale, unscaled, measure.measure, point.record.source)
        return factor * point.scale_change

    def history(self, point: Point) -> Request:
        """The history of a point; its motion is shared, and scaled while it is used."""
        assert point.record is not None, "points of histories have a record"
        system, motion = self.systems[point], self.records.motion(point.record)
        return Request(
            structure=system.perturbed(point.restitution_change),
            motion=motion,
            settings=system.settings,
            scale=self.factor(point),
        )

    def intensities(self, points: Sequence[Point], factors: Array) -> dict[str, Array]:
        """Peaks of the scaled motions of some points, (points,)."""
        requests = [point.record for point in points]
        peaks = {r: [self.records.intensity(r, m) for m in PEAKS] for r in set(requests) if r}
        found = np.array([peaks[r] for r in requests if r]).reshape(-1, len(PEAKS))
        return {m.lower(): np.abs(factors) * found[:, i] for i, m in enumerate(PEAKS)}
