"""Points of a study, and what they share: systems and motions, made or read once.

Together with `evaluation` this decides about stored numbers.
"""

from __future__ import annotations

import hashlib
import json
from collections import OrderedDict
from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from threading import RLock
from typing import Any, Generic, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.demand import Request
from rpscli.analyses.result_quantities import LIMITED
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.case.case import Case, case_from_mapping
from rpscli.case.study.schema import Analysis, MeasureScale
from rpscli.errors import RecordError
from rpscli.model.devices import own_laws
from rpscli.model.podium import PodiumStructure
from rpscli.records.ground_motion import MotionComponents
from rpscli.records.loading import load_components
from rpscli.records.measures import USUAL, Measure, Of, factor_to, measured, pair_measure
from rpscli.records.recordings import Pair
from rpscli.records.source import Source
from rpscli.version import VERSION

Array = NDArray[np.float64]
Key = TypeVar("Key", bound=Hashable)
Value = TypeVar("Value")

SAMPLES_KEPT = 32_000_000
"""Samples of ground motions held in memory (256 MB); the least recently used go first."""

SYSTEMS_KEPT = 512
"""Systems held in memory with their modes of vibration; the least recently used go first."""

DECIDING = ("superstructure", "podium", "analysis")
"""Sections of a resolved case on which results depend besides the record."""

PEAKS: tuple[Measure, ...] = ("PGA", "PGV")
"""Measures of each scaled motion in the table of a study."""

SOLVING = (
    *("constants.py", "units.py", "registry.py", "physics", "model", "records", "analyses", "case"),
    *("sweep/context.py", "sweep/evaluation.py"),
)
"""Files and folders of the package whose sources decide about what is stored under a key."""


@cache
def solver_version() -> str:
    """Version of rps and a digest of the sources that compute."""
    return f"{VERSION}+{digest_of_sources(Path(__file__).parents[1])[:16]}"


def digest_of_sources(package: Path) -> str:
    """SHA-256 of the names and contents of all sources that compute, in sub-folders too."""
    digest = hashlib.sha256()
    for name in SOLVING:
        place = package / name
        for source in [place] if place.is_file() else sorted(place.rglob("*.py")):
            digest.update(f"{source.relative_to(package).as_posix()}\0".encode())
            digest.update(source.read_bytes())
    return digest.hexdigest()


class RecordRequest(NamedTuple):
    """A ground motion to be loaded, and where its relative names start.

    What is measured by a `pair` has both components of that. A second component `y` acts together
    with the source, as both of a source do that says so; they are turned by a rotation [deg].
    """

    source: str
    folder: str
    vertical: str | None = None
    dt: float | None = None
    units: str | None = None
    pair: Pair | None = None
    y: str | None = None
    rotation: float = 0.0

    @property
    def name(self) -> str:
        """The source, or both."""
        return self.source if self.y is None else f"{self.source} + {self.y}"

    @property
    def is_pair(self) -> bool:
        """True if both horizontal components act."""
        return self.y is not None or Source.parse(self.source).both


class Point(NamedTuple):
    """One point, small enough to be sent anywhere.

    `number` is its place in the order of the study, from 0. `values` are those of the varied keys,
    in their order. `scale` is the factor on the record, or the value of the measure to scale it to;
    `period` is then the one of Sa and the like. The changes are factors of the perturbation, 1
    where there is none.
    """

    number: int
    system: int
    values: tuple[Any, ...]
    record: RecordRequest | None
    scale: float
    scale_change: float
    restitution_change: float
    period: float | None


@dataclass(frozen=True)
class Plan:
    """Everything besides the points that a process needs to evaluate them.

    `keys` are the dotted keys of the values of a point; `base` is the case at the base as plain
    values, with its file and folder for messages and relative file names; `measure` is what the
    records are scaled to, if not by factors; `whole` histories are followed with all their samples;
    all results must come from one version of the `solver`.
    """

    analysis: Analysis
    keys: tuple[str, ...]
    base: dict[str, Any]
    base_name: str
    base_folder: str
    measure: MeasureScale | None
    whole: bool
    solver: str

    @property
    def of(self) -> Of:
        """Definition of measures of pairs."""
        return (self.measure and self.measure.of) or USUAL


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
            SAMPLES_KEPT,
            # A reason takes hardly any room.
            lambda of: 1.0 if isinstance(of, str) else sum(e.npts for e in of.named.values()),
        )
        self._digests: Recent[RecordRequest, bytes] = Recent(float("inf"))
        self._intensities: Recent[tuple[object, ...], float] = Recent(1e6)

    def motion(self, request: RecordRequest) -> MotionComponents:
        """The motion of a request."""

        def load() -> MotionComponents | str:
            source, folder, above, dt, units, _, y, rotation = request
            how: dict[str, Any] = {"folder": Path(folder), "dt": dt, "units": units}
            try:
                return load_components(source, above, y, rotation, **how)
            except (RecordError, OSError) as error:
                return str(error)

        motion = self._motions.value(request, load)
        if isinstance(motion, str):
            raise RecordError(motion)
        return motion

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
        # All directions of a pair share its measure, and both components together.
        shared = request._replace(source="", vertical=None, y=None, rotation=0.0)

        def make() -> float:
            if both is None:
                return measured(self.motion(request).horizontal, measure, period, damping)
            parts = (shared._replace(source=source, pair=None) for source in both)
            one, other = (self.motion(part).horizontal for part in parts)
            return pair_measure(one, other, measure, of, period, damping)

        whose = request if both is None else (shared, of)
        return self._intensities.value((whose, measure, period, damping), make)


@dataclass(frozen=True, eq=False)
class System:
    """One structure, settings of its analysis, digest of what in its case decides about results."""

    structure: PodiumStructure
    settings: TimeHistorySettings
    digest: bytes

    @classmethod
    def of_case(cls, case: Case) -> System:
        """The system that a case describes."""
        deciding = {name: case.document.get(name) for name in DECIDING}
        if own := own_laws(case.structure):
            deciding["sources"] = {name: law.sources for name, law in own.items()}
        digest = hashlib.sha256(json.dumps(deciding, sort_keys=True).encode()).digest()
        return cls(case.structure, case.analysis, digest)

    def perturbed(self, restitution_change: float) -> PodiumStructure:
        """The structure with its restitution times a factor; the building is shared."""
        if restitution_change == 1.0 or self.structure.bearing.is_spherical:
            return self.structure
        law = self.structure.impact_law
        law = replace(law, factor=law.factor * restitution_change)
        return replace(self.structure, impact_law=law)


def unjudged(varied: Mapping[str, Any]) -> list[str]:
    """Limits of the base that a system without its building is not judged by, as is said."""
    if varied.get("superstructure.storeys") != 0:
        return []
    return [f"limits.{q.name}" for q in LIMITED if "superstructure" in q.needs]


def resolved(plan: Plan, values: Sequence[Any]) -> Case:
    """The case with values at the varied keys."""
    varied = dict(zip(plan.keys, values, strict=True))
    varied |= dict.fromkeys(unjudged(varied))
    folder = Path(plan.base_folder)
    return case_from_mapping(plan.base, plan.base_name, folder, varied, label="vary")


class StudyContext:
    """Systems and ground motions of a plan, shared by all batches of a process."""

    def __init__(self, plan: Plan) -> None:
        self.plan, self.records = plan, RecordCache()
        self._systems: Recent[int, System] = Recent(SYSTEMS_KEPT)

    def system(self, number: int, values: Sequence[Any], known: System | None = None) -> System:
        """The system of a number with these values, resolved when it is needed if not `known`."""
        return self._systems.value(
            number, lambda: known or System.of_case(resolved(self.plan, values))
        )

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
        system = self.system(point.system, point.values)
        structure = system.perturbed(point.restitution_change)
        motion = self.records.motion(point.record)
        return Request(structure, motion, system.settings, scale=self.factor(point))

    def intensities(self, points: Sequence[Point], factors: Array) -> dict[str, Array]:
        """Peaks of the scaled motions of some points, (points,)."""
        requests = [point.record for point in points if point.record]
        peaks = dict[str, Array]()
        for measure in PEAKS:
            of: dict[RecordRequest, float] = {
                r: self.records.intensity(r, measure, of=self.plan.of if r.is_pair else "component")
                for r in set(requests)
            }
            peaks[measure.lower()] = np.abs(factors) * np.array([of[r] for r in requests])
        return peaks
