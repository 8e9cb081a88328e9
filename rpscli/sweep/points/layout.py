"""The study as an ordered sequence of points, each made when it is asked for."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

from rpscli.case.study.schema import MeasureScale
from rpscli.case.study.study import Study
from rpscli.sweep.evaluation.points import Plan, Point, RecordRequest
from rpscli.sweep.evaluation.solver import solver_version
from rpscli.sweep.evaluation.systems import System, resolved, system_of
from rpscli.sweep.points.check import SystemProperties, Watched, check_systems
from rpscli.sweep.points.combinations import Combinations, combinations_of
from rpscli.sweep.points.perturbation import Change, changes


@dataclass(frozen=True, eq=False)
class StudyPoints:
    """Systems, records, scales and perturbations; the last of them runs fastest.

    Parameters
    ----------
    study
        What is laid out.
    plan
        The part of it that evaluates points.
    combinations
        The systems.
    properties
        Of every system, in order.
    records
        The records; None stands for the one of each system's own case, or for no record.
    scales
        Factors, or values of the measure; None stands for the factor of the case.
    members
        Changes of the perturbation.
    """

    study: Study
    plan: Plan
    combinations: Combinations
    properties: tuple[SystemProperties, ...]
    records: tuple[RecordRequest | None, ...]
    scales: tuple[float | None, ...]
    members: tuple[Change, ...]

    def __len__(self) -> int:
        return math.prod(self.shape)

    def __iter__(self) -> Iterator[Point]:
        return (self[index] for index in range(len(self)))

    @property
    def shape(self) -> tuple[int, ...]:
        """Lengths of the axes of the study, the sample, records, scales and members."""
        return (*self.combinations.shape, *self._within)

    @cached_property
    def _within(self) -> tuple[int, int, int]:
        return len(self.records), len(self.scales), len(self.members)

    @property
    def points_of_system(self) -> int:
        """Number of points of one system; they follow each other."""
        return math.prod(self._within)

    def __getitem__(self, index: int) -> Point:
        """The point at a place of the study's order."""
        records, scales, members = self._within
        rest, member = divmod(index, members)
        rest, scale = divmod(rest, scales)
        system, record = divmod(rest, records)
        properties, change = self.properties[system], self.members[member]
        given = self.scales[scale]
        return Point(
            number=index,
            system=system,
            values=properties.values,
            record=self.records[record] or properties.record,
            scale=properties.scale if given is None else given,
            member=member,
            scale_change=change.scale,
            restitution_change=change.restitution,
            period=self._period_of_measure(properties),
        )

    def _period_of_measure(self, properties: SystemProperties) -> float | None:
        measure = self.plan.measure
        if measure is None or measure.measure != "Sa":
            return None
        return measure.period or properties.period

    def system(self, index: int) -> System:
        """One of the systems, resolved anew."""
        return system_of(resolved(self.plan, self.properties[index].values))


def lay_out(study: Study, watched: Watched = iter) -> StudyPoints:
    """The points of a study; all its systems are examined on the way, in the hands of `watched`.

    Raises
    ------
    CaseError
        If a system is no valid case.
    """
    file, combinations = study.file, combinations_of(study)
    scale = study.scale
    measure = scale if isinstance(scale, MeasureScale) else None
    plan = Plan(
        analysis=file.analysis,
        keys=combinations.keys,
        base=study.base.content,
        base_name=study.base.name,
        base_folder=str(study.base_folder),
        measure=measure,
        whole=file.whole_histories,
        solver=solver_version(),
    )
    members = changes(file.perturb)
    folder = str(study.folder)
    return StudyPoints(
        study=study,
        plan=plan,
        combinations=combinations,
        properties=check_systems(study, plan, combinations, members, watched),
        records=tuple(RecordRequest(source, folder) for source in study.sources) or (None,),
        scales=_scales(scale),
        members=members,
    )


def _scales(scale: MeasureScale | Sequence[float] | None) -> tuple[float | None, ...]:
    if scale is None:
        return (None,)
    return tuple(scale.values if isinstance(scale, MeasureScale) else scale)
