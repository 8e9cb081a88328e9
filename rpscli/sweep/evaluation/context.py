"""What the points of a study share: its systems and its ground motions, each made or read once."""

from __future__ import annotations

import hashlib
import json
from collections import OrderedDict
from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from threading import RLock
from typing import Any, Generic, TypeVar

import numpy as np

from rpscli.analyses.demand import Request
from rpscli.analyses.result_quantities import LIMITED
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.case.case import Case, case_from_mapping
from rpscli.errors import RecordError
from rpscli.model.podium import PodiumStructure
from rpscli.records.ground_motion import MotionComponents
from rpscli.records.loading import load_components
from rpscli.records.measures import Measure, Of, factor_to, measured, pair_measure
from rpscli.sweep.evaluation.points import Plan, Point, RecordRequest
from rpscli.sweep.evaluation.results import Array

Key = TypeVar("Key", bound=Hashable)
Value = TypeVar("Value")

SAMPLES_KEPT = 32_000_000
"""Samples of ground motions held in memory (256 MB); the longest unused one goes first."""


class Recent(Generic[Key, Value]):
    """Values that were asked for last, sizes of `room` in all; safe to share among threads."""

    def __init__(self, room: float, size: Callable[[Value], float] = lambda _: 1.0) -> None:
        self._room, self._size, self._held = room, size, 0.0
        self._values: OrderedDict[Key, Value] = OrderedDict()
        self._lock = RLock()

    def value(self, key: Key, make: Callable[[], Value]) -> Value:
        """The value of a key, made if it is not at hand. Two threads never make the same one."""
        with self._lock:
            if key in self._values:
                self._values.move_to_end(key)
                return self._values[key]
            made = self._values[key] = make()
            self._held += self._size(made)
            while self._held > self._room and len(self._values) > 1:
                _, oldest = self._values.popitem(last=False)
                self._held -= self._size(oldest)
            return made


class RecordCache:
    """Motions, the intensity of each, and the reasons why some cannot be had."""

    def __init__(self) -> None:
        self._motions: Recent[RecordRequest, MotionComponents | str] = Recent(
            SAMPLES_KEPT, _samples
        )
        self._digests: Recent[RecordRequest, bytes] = Recent(float("inf"))
        self._intensities: Recent[tuple[object, ...], float] = Recent(1e6)

    def motion(self, request: RecordRequest) -> MotionComponents:
        """The motion of a request."""
        found = self._motions.value(request, lambda: _load(request))
        if isinstance(found, str):
            raise RecordError(found)
        return found

    def digest(self, request: RecordRequest) -> bytes:
        """Digest of a motion's content; of the reason, if it cannot be read."""

        def make() -> bytes:
            try:
                return self.motion(request).digest
            except RecordError as error:
                text = f"unreadable: {request.source}: {error}"
                return hashlib.sha256(text.encode("utf-8", "surrogateescape")).digest()

        return self._digests.value(request, make)

    def intensity(
        self,
        request: RecordRequest,
        measure: Measure,
        period: float | None = None,
        damping: float = 0.05,
        of: Of = "component",
    ) -> float:
        """A measure of the unscaled horizontal motion or, if it has one, of its pair, SI units."""
        both = None if of == "component" else request.pair

        def make() -> float:
            if both is None:
                return measured(self.motion(request).horizontal, measure, period, damping)
            alone = request._replace(vertical=None, pair=None, y=None, rotation=0.0)
            parts = (alone._replace(source=source) for source in both)
            one, other = (self.motion(part).horizontal for part in parts)
            return pair_measure(one, other, measure, of, period, damping)

        # All directions of a pair share its measure, and both components together.
        shared = request._replace(source="", vertical=None, y=None, rotation=0.0)
        whose = request if both is None else (shared, of)
        return self._intensities.value((whose, measure, period, damping), make)


def _samples(found: MotionComponents | str) -> float:
    """Room that a motion takes, both components together; a reason hardly any."""
    if isinstance(found, str):
        return 1.0
    return sum(motion.npts for motion in found.named.values())


def _load(request: RecordRequest) -> MotionComponents | str:
    """The motion, or why there is none."""
    source, folder, above, dt, units, _, y, rotation = request
    try:
        how: dict[str, Any] = {"folder": Path(folder), "dt": dt, "units": units}
        return load_components(source, above, y, rotation, **how)
    except (RecordError, OSError) as error:
        return str(error)


SYSTEMS_KEPT = 512
"""Systems held in memory with their modes of vibration; the longest unused one goes first."""

DECIDING = ("superstructure", "podium", "analysis")
"""Sections of a resolved case on which results depend besides the record."""


@dataclass(frozen=True, eq=False)
class System:
    """One structure of a study and the settings of its analysis."""

    structure: PodiumStructure
    settings: TimeHistorySettings
    digest: bytes
    """Of everything in its resolved case that decides about results."""

    def perturbed(self, restitution_change: float) -> PodiumStructure:
        """The structure with its restitution times a factor; the building is shared."""
        if restitution_change == 1.0 or self.structure.bearing.is_spherical:
            return self.structure
        law = self.structure.impact_law
        changed = replace(law, factor=law.factor * restitution_change)
        return replace(self.structure, impact_law=changed)


def system_of(case: Case) -> System:
    """The system that a case describes."""
    deciding = {name: case.document.get(name) for name in DECIDING}
    digest = hashlib.sha256(json.dumps(deciding, sort_keys=True).encode()).digest()
    return System(case.structure, case.analysis, digest)


def record_request(case: Case, of: Of | None = None) -> RecordRequest | None:
    """The case's own record, to be measured as a scale asks for."""
    if (record := case.record) is None:
        return None
    folder, rotation = str(case.folder), record.rotation or 0.0
    what = record.vertical, record.dt, record.units, record.pair(of), record.y, rotation
    return RecordRequest(record.source, folder, *what)


def unjudged(given: Mapping[str, Any]) -> list[str]:
    """Limits of the base that a system without its building is not judged by, as is said."""
    if given.get("superstructure.storeys") != 0:
        return []
    return [f"limits.{q.name}" for q in LIMITED if "superstructure" in q.needs]


def resolved(plan: Plan, values: Sequence[Any]) -> Case:
    """The case with values at the varied keys."""
    given = dict(zip(plan.keys, values, strict=True))
    given |= dict.fromkeys(unjudged(given))
    return case_from_mapping(plan.base, plan.base_name, Path(plan.base_folder), given, label="vary")


class Systems:
    """The systems of a plan, resolved when they are needed, if not `examined`; kept for a while."""

    def __init__(self, plan: Plan, examined: Mapping[int, System]) -> None:
        self._plan, self._examined = plan, examined
        self._recent: Recent[int, System] = Recent(SYSTEMS_KEPT)

    def __getitem__(self, point: Point) -> System:
        """The system of a point."""
        known = self._examined.get(point.system)
        return known or self._recent.value(
            point.system, lambda: system_of(resolved(self._plan, point.values))
        )


PEAKS: tuple[Measure, ...] = ("PGA", "PGV")
"""What the table of a study tells of each scaled motion."""


class StudyContext:
    """Systems and ground motions of a plan, shared by all batches of a process."""

    def __init__(self, plan: Plan, examined: Mapping[int, System] | None = None) -> None:
        self.plan = plan
        self.records = RecordCache()
        self.systems = Systems(plan, examined or {})

    def factor(self, point: Point) -> float:
        """Factor on the record of a point."""
        measure = self.plan.measure
        if measure is None:
            return point.scale * point.scale_change
        assert point.record is not None, "points of histories have a record"
        unscaled = self.records.intensity(
            point.record, measure.measure, point.period, measure.damping, self.plan.of
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
        of: dict[RecordRequest, Of] = {
            r: self.plan.of if r.is_pair else "component" for r in set(requests) if r
        }
        peaks = {r: [self.records.intensity(r, m, of=of[r]) for m in PEAKS] for r in of}
        found = np.array([peaks[r] for r in requests if r]).reshape(-1, len(PEAKS))
        return {m.lower(): np.abs(factors) * found[:, i] for i, m in enumerate(PEAKS)}
