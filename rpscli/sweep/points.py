"""The study as an ordered sequence of points; each in the user's words."""

from __future__ import annotations

import itertools
import json
import math
import shlex
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from rpscli.case.study.schema import MeasureScale
from rpscli.case.study.study import StudyInput
from rpscli.case.text.document import Fault
from rpscli.errors import RecordError, RpsError
from rpscli.model.podium import Array
from rpscli.records.measures import MEASURES, Of, measure_label, needs_period
from rpscli.records.recordings import By, clusters, pairs
from rpscli.records.source import Source
from rpscli.shown import frozen
from rpscli.sweep.evaluation import (
    Indices,
    Plan,
    Point,
    StudyContext,
    System,
    resolved,
    solver_version,
)
from rpscli.sweep.motions import RecordRequest
from rpscli.sweep.names import SYSTEM, names_of_rows
from rpscli.sweep.systems import (
    Change,
    SystemProperties,
    Watched,
    changes,
    examined,
    sample,
)
from rpscli.units import as_written


class AxisIndices(NamedTuple):
    """(points,) places of points among systems, records, scales and members."""

    system: Indices
    record: Indices
    scale: Indices
    member: Indices


@dataclass(frozen=True, eq=False)
class StudyPoints:
    """Systems, records, scales and perturbations; the last of them runs fastest.

    `context` has the plan, systems and motions, `properties` are those of every
    system, in order; `samples` systems have the same values along the axes. A record
    None stands for the one of each system's own case, or for no record; `scales` are
    factors or values of the measure, None for the factor of the case; `members` are
    changes of the perturbation.
    """

    study: StudyInput
    context: StudyContext
    properties: tuple[SystemProperties, ...]
    samples: int
    records: tuple[RecordRequest | None, ...]
    scales: tuple[float | None, ...]
    members: tuple[Change, ...]

    def __len__(self) -> int:
        return math.prod(self.shape)

    def __iter__(self) -> Iterator[Point]:
        return (self[index] for index in range(len(self)))

    @property
    def plan(self) -> Plan:
        """The part of it that evaluates points."""
        return self.context.plan

    @property
    def _within(self) -> tuple[int, int, int]:
        return len(self.records), len(self.scales), len(self.members)

    @property
    def shape(self) -> tuple[int, ...]:
        """Lengths of the axes of the study, the sample, records, scales and members."""
        return (
            *(len(axis.rows) for axis in self.study.axes),
            self.samples,
            *self._within,
        )

    @property
    def points_of_system(self) -> int:
        """Number of points of one system; they follow each other."""
        return math.prod(self._within)

    def __getitem__(self, index: int) -> Point:
        """The point at a place of the study's order."""
        rest, member = divmod(index, len(self.members))
        rest, scale = divmod(rest, len(self.scales))
        system, record = divmod(rest, len(self.records))
        properties = self.properties[system]
        change = self.members[member]
        factor = self.scales[scale]
        request = self.records[record] or properties.record
        at = system if self.records == (None,) else record
        if request is not None and change.rotation and self.pairs[at]:
            request = request._replace(rotation=request.rotation + change.rotation)
        return Point(
            number=index,
            system=system,
            values=properties.values,
            record=request,
            scale=properties.scale if factor is None else factor,
            scale_change=change.scale,
            restitution_change=change.restitution,
            period=self.period_of_measure(properties),
        )

    def system(self, index: int) -> System:
        """One of the systems."""
        return self.context.system(index, self.properties[index].values)

    @cached_property
    def places(self) -> AxisIndices:
        """Of all points."""
        shape = (len(self.properties), *self._within)
        return AxisIndices(*frozen(np.unravel_index(np.arange(len(self)), shape)))

    @cached_property
    def factors(self) -> Array:
        """(points,) factors on the records, where no measure decides about them."""
        systems, _, scales, members = self.places
        own = np.array([properties.scale for properties in self.properties])[systems]
        scale = (
            own if self.scales == (None,) else np.array(self.scales, np.float64)[scales]
        )
        return frozen(
            scale * np.array([change.scale for change in self.members])[members]
        )

    @cached_property
    def identifying(self) -> dict[str, tuple[int, Sequence[Any]]]:
        """Columns that tell points apart: of each which of
        `places`, and the values there.
        """
        # `scale` is missing: it is a result where records are scaled to a measure.
        of_systems = zip(
            *(properties.values for properties in self.properties), strict=True
        )
        columns: dict[str, tuple[int, Sequence[Any]]] = {
            key: (0, values)
            for key, values in zip(self.plan.keys, of_systems, strict=True)
        }
        if any(self.system_names):
            columns[SYSTEM] = 0, self.system_names
        if len(self.members) > 1:
            columns["member"] = 3, range(len(self.members))
            columns["restitution_change"] = (
                3,
                [change.restitution for change in self.members],
            )
            if any(self.pairs):
                columns["rotation_change"] = (
                    3,
                    [change.rotation for change in self.members],
                )
        if self.plan.measure is not None:
            columns[measure_label(self.plan.measure.measure, self.of)] = 2, self.scales
        if self.plan.analysis == "timehistory":
            own = self.records == (None,)
            columns["record"] = 0 if own else 1, [record.name for record in self.requests]
        return columns

    def described(self, number: int) -> dict[str, Any]:
        """Values that tell a point from the others: columns of
        `points.csv` before the results.
        """
        places = [place[number] for place in self.places]
        columns = self.identifying.items()
        return {
            name: values[places[of]] for name, (of, values) in columns if name != SYSTEM
        }

    @cached_property
    def system_names(self) -> list[str]:
        """Of all systems, by the axes; those of a sample have one name."""
        rows = itertools.product(*map(names_of_rows, self.study.axes))
        return [", ".join(names) for names in rows for _ in range(self.samples)]

    def system_name(self, number: int) -> str:
        """The name of the system of a point."""
        return self.system_names[number // self.points_of_system]

    @cached_property
    def requests(self) -> list[RecordRequest]:
        """The records, those of the cases where the study has none of its own."""
        own = (properties.record for properties in self.properties)
        return [
            record
            for record in (own if self.records == (None,) else self.records)
            if record
        ]

    @cached_property
    def pairs(self) -> tuple[bool, ...]:
        """Of each record whether both horizontal components act."""
        return tuple(record.is_pair for record in self.requests)

    @property
    def independent(self) -> By:
        """Recordings or events, which statistics draw and count as a whole."""
        return self.study.file.independent

    @cached_property
    def alone(self) -> bool:
        """True if all points are under a single record, or none."""
        return len(set(self.identifying.get("record", (0, ()))[1])) < 2

    @cached_property
    def recordings(self) -> Indices:
        """(points,) numbers of the recordings, or events, of all points."""
        of = self.identifying["record"][0]
        sources = [r.source for r in self.requests]
        folder = self.study.base_folder if self.records == (None,) else self.study.folder
        numbers = np.array(clusters(sources, folder, self.independent))
        return frozen(numbers[self.places[of]])

    @cached_property
    def clusters(self) -> Indices:
        """(points,) numbers of recordings or events; under a
        single record of the points.
        """
        return frozen(np.arange(len(self))) if self.alone else self.recordings

    @cached_property
    def of(self) -> Of | None:
        """Definition of measures of pairs; None where no record is measured as a pair."""
        return self.plan.of if any(record.pair for record in self.requests) else None

    @property
    def scaled_to(self) -> str:
        """Measure that the records are scaled to, in words; empty without one."""
        if (measure := self.plan.measure) is None:
            return ""
        name = measure_label(measure.measure, self.of)
        unit = MEASURES[measure.measure].unit
        if (count := len(measure.values)) > 1:
            return f"{count} values of {name}"
        return f"{name} = {as_written(measure.values[0], unit)}"

    def period_of_measure(self, properties: SystemProperties) -> float | None:
        """Period at which the records of a system are scaled;
        None unless they are [s].
        """
        measure = self.plan.measure
        if measure is None or not needs_period(measure.measure):
            return None
        return measure.period or properties.period

    def known_factor(self, point: Point) -> float:
        """Factor on the record of a point, or what is written
        where that cannot be read.
        """
        try:
            return self.context.factor(point)
        except RpsError:
            return point.scale


def lay_out(study: StudyInput, watched: Watched = iter) -> StudyPoints:
    """The points of a study, whose systems are all examined."""
    file = study.file
    scale = study.scale
    folder = str(study.folder)
    drawn = sample(file.sample) if file.sample else np.empty((1, 0))
    varied = [key for axis in study.axes for key in axis.keys]
    plan = Plan(
        analysis=file.analysis,
        keys=(*varied, *(file.sample.ranges if file.sample else ())),
        base=study.base.content,
        base_name=study.base.name,
        base_folder=str(study.base_folder),
        measure=scale if isinstance(scale, MeasureScale) else None,
        whole=file.whole_histories,
        solver=solver_version(),
    )
    context = StudyContext(plan)
    members = changes(file.perturb)
    properties = examined(study, context, drawn, members, watched)
    values = scale.values if isinstance(scale, MeasureScale) else scale
    try:
        measured = pairs(
            study.sources, plan.measure.of if plan.measure else None, study.folder
        )
    except RecordError as error:
        study.document.refuse([Fault(("scale", "of"), f"scale.of: {error}")])
        raise
    records = (
        RecordRequest(source, folder, pair=pair)
        for source, pair in zip(study.sources, measured, strict=True)
    )
    return StudyPoints(
        study=study,
        context=context,
        properties=properties,
        samples=len(drawn),
        records=tuple(records) or (None,),
        scales=(None,) if values is None else tuple(values),
        members=members,
    )


def reproduction(layout: StudyPoints, point: Point, base_file: Path) -> str:
    """One line for the shell that computes the point alone."""
    words = ["rps", layout.plan.analysis, str(base_file)]
    # Without a file of its own the base is written with them.
    overrides = [*layout.study.base_overrides] if layout.study.base_file else []
    named = zip(layout.plan.keys, point.values, strict=True)
    overrides += [f"{key}={json.dumps(value)}" for key, value in named]  # JSON is YAML
    if point.restitution_change != 1.0:
        law = dict(resolved(layout.plan, point.values).document["podium"]["impact"])
        law["factor"] *= point.restitution_change
        overrides.append(f"podium.impact={json.dumps(law)}")
    if (record := point.record) and record.y and record.rotation:
        overrides.append(f"record.rotation={record.rotation!r}")
    for text in overrides:
        words += ["--set", text]
    if record is not None and layout.plan.analysis == "timehistory":
        if record.y is None:
            words += ["--record", _source(record)]
            if record.vertical:
                words += ["--vertical", _source(record._replace(source=record.vertical))]
        words += ["--scale", repr(layout.known_factor(point))]
    return shlex.join(words)


def _source(request: RecordRequest) -> str:
    """The source as seen from the working folder."""
    source = Source.parse(request.source, Path(request.folder)).turned(request.rotation)
    file = Path(request.folder) / source.place
    if source.scheme or not file.exists():
        return str(source)
    stated = {"dt": request.dt and repr(request.dt), "units": request.units}
    return str(
        source.at(str(file)).plus(**{name: text for name, text in stated.items() if text})
    )
