"""The intensity of the ground motion at every point of a study."""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np

from rpscli.case.schema.keys import unit as key_unit
from rpscli.errors import RecordError
from rpscli.records.measures import MEASURES, Measure, Of, measure_label, needs_period
from rpscli.sweep.evaluation.context import StudyContext
from rpscli.sweep.table import Array, Table


def unit_of(name: str) -> str:
    """SI unit of a measure or of a varied key; ``-`` for plain numbers and words."""
    alone = name.partition("(")[0]
    # Keys have dots, all but those that a study varies besides them.
    if alone in MEASURES or ("." not in name and alone in MEASURES.names()):
        return MEASURES[alone].unit
    return key_unit(name)


class Asked(Protocol):
    """Which measure is asked for, as options of a report say it."""

    @property
    def measure(self) -> Measure | None:
        """The one that the study scales to by default, else PGV."""

    @property
    def period(self) -> float | None:
        """Of Sa, AvgSa or FIV3; T1 of each system by default."""

    @property
    def damping(self) -> float:
        """Of Sa, AvgSa or Housner."""


class Intensity(NamedTuple):
    """A measure of the scaled records.

    `values` are (points,), NaN where a record cannot be read; `period` is that of Sa and the like,
    None for T1 of each system.
    """

    measure: Measure
    unit: str
    period: float | None
    values: Array
    of: Of | None = None
    """What of pairs it is; None where no record is measured as a pair."""

    @property
    def name(self) -> str:
        """As columns call it."""
        return measure_label(self.measure, self.of)


def intensity(table: Table, context: StudyContext, options: Asked) -> Intensity:
    """The measure that a report asks for; by default the one that the study scales to, else PGV."""
    scaled = table.layout.plan.measure
    measure, period, damping = options.measure, options.period, options.damping
    if measure is None and scaled is not None:
        measure, period, damping = scaled.measure, scaled.period, scaled.damping
    measure = measure or "PGV"
    wanted = measure, period, damping
    target = scaled is not None and wanted == (scaled.measure, scaled.period, scaled.damping)
    values = np.full(len(table), np.nan)
    for point in table.layout:
        assert point.record is not None, "points of histories have a record"
        if target:
            # Not by way of the factor, whose rounding would blur equal intensities.
            values[point.number] = point.scale * _effect(measure, point.scale_change)
            continue
        at = None
        if needs_period(measure):
            at = period or table.layout.properties[point.system].period
            assert at is not None, "`measure_without_period` was asked before"
        try:
            unscaled = context.records.intensity(
                point.record, measure, at, damping, table.layout.plan.of
            )
        except RecordError:
            continue
        values[point.number] = unscaled * _effect(measure, table.scale[point.number])
    return Intensity(measure, MEASURES[measure].unit, period, values, table.layout.of)


def _effect(measure: Measure, factor: float) -> float:
    """What a factor on the record does to the measure."""
    return float(abs(factor) ** MEASURES[measure].power)
