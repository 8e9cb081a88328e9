"""Overturning spectra: which pulses overturn, by amplitude and frequency."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from pydantic import Field

from rpscli.case.study.fields import Keys
from rpscli.case.study.reports import ReportOptions
from rpscli.errors import CaseError
from rpscli.records.query import Query, parse_query
from rpscli.sweep.evaluation.context import StudyContext
from rpscli.sweep.evaluation.points import RecordRequest
from rpscli.sweep.table import Array, Indices, Table, groups, leading_keys

PULSE_OPTIONS = (
    "amplitude", "period", "dt", "velocity_amplitude", "cycles", "phase",
)  # fmt: skip


class SpectrumOptions(ReportOptions):
    """Overturning spectrum of pulses: amplitude over g tan(alpha) against frequency over p."""

    panels: Keys | None = Field(None, description="varied keys, one panel for each value")


@dataclass(frozen=True, eq=False)
class SpectrumPanel:
    """Points of one group of systems, each (points,).

    Parameters
    ----------
    frequency_ratio
        2 pi over period of the pulse and p of the rigid frame.
    amplitude_ratio
        Peak acceleration over g tan(alpha).
    outcomes
        Words; failed points are among them.
    boundary
        (frequencies, 2) frequency ratio and least amplitude ratio that overturned; NaN where
        none did.
    """

    values: tuple[object, ...]
    frequency_ratio: Array
    amplitude_ratio: Array
    rotation_ratio: Array
    outcomes: tuple[str, ...]
    boundary: Array
    failed: int


@dataclass(frozen=True)
class SpectrumReport:
    """All panels."""

    panel_keys: tuple[str, ...]
    panels: tuple[SpectrumPanel, ...]


def spectrum_report(
    table: Table, context: StudyContext, options: SpectrumOptions
) -> SpectrumReport:
    """Amplitude and frequency of every point, made dimensionless by its own system.

    Raises
    ------
    CaseError
        If a record of the study is no pulse.
    """
    keys = options.panels if options.panels is not None else leading_keys(table.design)
    periods: dict[RecordRequest, float] = {}
    frequency, amplitude = np.full((2, len(table)), np.nan)
    for point in table.design:
        assert point.record is not None, "points of histories have a record"
        properties = table.design.properties[point.system]
        if point.record not in periods:
            periods[point.record] = pulse_period(point.record.source)
        omega = 2.0 * math.pi / periods[point.record]
        frequency[point.number] = omega / properties.frequency_parameter
        if not table.failed[point.number]:
            peak = context.records.intensity(point.record, "PGA")
            size = peak * abs(table.scale[point.number])
            amplitude[point.number] = size / properties.uplift_acceleration
    panels = (
        _panel(table, group.values, group.points, frequency, amplitude)
        for group in groups(table.design, keys)
    )
    return SpectrumReport(keys, tuple(panels))


def pulse_period(source: str) -> float:
    """Period of a pulse [s].

    Raises
    ------
    CaseError
        If the source is no pulse.

    Examples
    --------
    >>> pulse_period("pulse:sine?amplitude=0.4g&period=1.2")
    1.2
    """
    scheme, _, rest = source.partition(":")
    if scheme != "pulse":
        raise CaseError(
            f"the report overturning_spectrum needs pulses as records, as in"
            f" pulse:sine?amplitude=1 g&period=1; {source} is none"
        )
    query: Query = parse_query(rest.partition("?")[2], source, PULSE_OPTIONS)
    return query.quantity("period", "time")


def _panel(
    table: Table,
    values: tuple[object, ...],
    points: Indices,
    frequency: Array,
    amplitude: Array,
) -> SpectrumPanel:
    over = table.overturned[points]
    boundary = []
    for ratio in np.unique(frequency[points]):
        fell = points[over & (frequency[points] == ratio)]
        boundary.append((ratio, amplitude[fell].min() if len(fell) else math.nan))
    return SpectrumPanel(
        values=values,
        frequency_ratio=frequency[points],
        amplitude_ratio=amplitude[points],
        rotation_ratio=table.columns["rotation_ratio"][points],
        outcomes=tuple(table.outcomes[points].tolist()),
        boundary=np.array(boundary),
        failed=int(table.failed[points].sum()),
    )
