"""The intensity of the ground motion at every point of a study."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from pydantic import Field

from rpscli.case.schema.case_file import Time
from rpscli.case.schema.keys import unit as key_unit
from rpscli.case.study.reports import ReportOptions
from rpscli.case.study.schema import DampingRatio
from rpscli.errors import RecordError
from rpscli.records.measures import MEASURE_UNITS, Measure
from rpscli.sweep.evaluation.context import StudyContext
from rpscli.sweep.points.layout import StudyPoints
from rpscli.sweep.table import Array, Table


def unit_of(name: str) -> str:
    """SI unit of a measure or of a varied key; ``-`` for plain numbers and words.

    >>> unit_of("PGA"), unit_of("superstructure.period"), unit_of("scale")
    ('m/s2', 's', '-')
    """
    return next(
        (unit for measure, unit in MEASURE_UNITS.items() if measure == name), key_unit(name)
    )


class MeasureOptions(ReportOptions):
    """Options of reports that need an intensity measure."""

    measure: Measure | None = Field(
        None, description="the one that the study scales to by default, else PGV"
    )
    period: Time | None = Field(None, description="of Sa; T1 of each system by default")
    damping: DampingRatio = Field(0.05, description="of Sa")


def measure_without_period(layout: StudyPoints, options: MeasureOptions) -> Iterator[str]:
    """What keeps a report from having the measure that it asks for."""
    at_first_period = options.measure == "Sa" and options.period is None
    if at_first_period and any(system.period is None for system in layout.properties):
        yield "Sa at T1 needs storeys; give the report a `period`"


class Intensity(NamedTuple):
    """A measure of the scaled records.

    `values` are (points,), NaN where a record cannot be read; `period` is that of Sa, None for T1
    of each system.
    """

    measure: Measure
    unit: str
    period: float | None
    values: Array


def intensity(table: Table, context: StudyContext, options: MeasureOptions) -> Intensity:
    """The measure that a report asks for; by default the one that the study scales to, else PGV."""
    scaled = table.layout.plan.measure
    measure, period, damping = options.measure, options.period, options.damping
    if measure is None and scaled is not None:
        measure, period, damping = scaled.measure, scaled.period, scaled.damping
    measure = measure or "PGV"
    target = scaled is not None and (measure, period, damping) == (
        scaled.measure,
        scaled.period,
        scaled.damping,
    )
    values = np.full(len(table), np.nan)
    for point in table.layout:
        assert point.record is not None, "points of histories have a record"
        if target:
            # Not by way of the factor, whose rounding would blur equal intensities.
            values[point.number] = point.scale * _effect(measure, point.scale_change)
            continue
        at = None
        if measure == "Sa":
            at = period or table.layout.properties[point.system].period
            assert at is not None, "`measure_without_period` was asked before"
        try:
            unscaled = context.records.intensity(point.record, measure, at, damping)
        except RecordError:
            continue
        values[point.number] = unscaled * _effect(measure, table.scale[point.number])
    return Intensity(measure, MEASURE_UNITS[measure], period, values)


def _effect(measure: Measure, factor: float) -> float:
    """What a factor on the record does to the measure."""
    return factor**2 if measure == "Arias" else abs(factor)
