"""Overturning spectra: which pulses overturn, by amplitude and frequency."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import PurePath
from typing import Annotated, NamedTuple

import numpy as np
from pydantic import Field

from rpscli.case.schema.case_file import Time
from rpscli.case.schema.fields import Quantity, Section
from rpscli.case.study.reports import ReportOptions
from rpscli.case.study.schema import Keys
from rpscli.errors import CaseError, RecordError
from rpscli.records.query import Query, parse_query
from rpscli.sweep.evaluation.context import StudyContext
from rpscli.sweep.evaluation.points import RecordRequest
from rpscli.sweep.points.layout import StudyPoints
from rpscli.sweep.statistics.grouping import shown_keys
from rpscli.sweep.table import Array, Indices, Table, groups, leading_keys

PULSE_OPTIONS = (
    "amplitude", "period", "dt", "velocity_amplitude", "cycles", "phase",
)  # fmt: skip


NEGLIGIBLE = 1e-6
"""Rotation over the critical one below which a figure shows no uplift: at an amplitude of exactly
g tan(alpha) rounding decides about the outcome."""


class PulseSection(Section):
    """What a record that is not made from a formula has for a pulse."""

    period: Time = Field(description="of the pulse")
    amplitude: Annotated[float, Quantity("m/s2", above=0)] | None = Field(
        None, description="peak acceleration of the unscaled pulse; that of the record by default"
    )


class SpectrumOptions(ReportOptions):
    """Overturning spectrum of pulses: amplitude over g tan(alpha) against frequency over p."""

    panels: Keys | None = Field(None, description="varied keys, one panel for each value")
    series: Keys | None = Field(None, description="varied keys, one colour for each value")
    pulses: dict[str, PulseSection] = Field(
        {},
        description="period and amplitude of records that are files, by source or name",
    )


@dataclass(frozen=True, eq=False)
class SpectrumSeries:
    """Points of one colour, each (points,).

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

    @property
    def shown(self) -> tuple[str, ...]:
        """Outcomes for a figure: a negligible rotation is none."""
        rotations = self.rotation_ratio.tolist()
        return tuple(
            "at_rest" if outcome == "survived" and rotation < NEGLIGIBLE else outcome
            for outcome, rotation in zip(self.outcomes, rotations, strict=True)
        )


@dataclass(frozen=True)
class SpectrumPanel:
    """Series of one group of systems."""

    values: tuple[object, ...]
    series: tuple[SpectrumSeries, ...]


@dataclass(frozen=True)
class SpectrumReport:
    """All panels."""

    panel_keys: tuple[str, ...]
    series_keys: tuple[str, ...]
    panels: tuple[SpectrumPanel, ...]

    @property
    def failed(self) -> int:
        """Points left out."""
        return sum(series.failed for panel in self.panels for series in panel.series)


def spectrum_report(
    table: Table, context: StudyContext, options: SpectrumOptions
) -> SpectrumReport:
    """Amplitude and frequency of every point, made dimensionless by its own system."""
    layout = table.layout
    series = options.series or ()
    panels = options.panels
    if panels is None:
        panels = tuple(key for key in leading_keys(layout) if key not in series)
    pulses: dict[RecordRequest, Pulse] = {}
    frequency, amplitude = np.full((2, len(table)), np.nan)
    for point in table.layout:
        assert point.record is not None, "points of histories have a record"
        properties = table.layout.properties[point.system]
        if point.record not in pulses:
            pulses[point.record] = pulse_of(point.record.source, options)
        pulse = pulses[point.record]
        omega = 2.0 * math.pi / pulse.period
        frequency[point.number] = omega / properties.frequency_parameter
        if not table.failed[point.number]:
            peak = pulse.amplitude or context.records.intensity(point.record, "PGA")
            size = peak * abs(table.scale[point.number])
            amplitude[point.number] = size / properties.uplift_acceleration
    found = []
    for panel in groups(layout, panels):
        inside = groups(layout, series, panel.points)
        one = [_series(table, g.values, g.points, frequency, amplitude) for g in inside]
        found.append(SpectrumPanel(panel.values, tuple(one)))
    return SpectrumReport(shown_keys(layout, panels), shown_keys(layout, series), tuple(found))


class Pulse(NamedTuple):
    """Period [s] and peak acceleration [m/s2] of a pulse; None: that of the record."""

    period: float
    amplitude: float | None


def pulse_of(source: str, options: SpectrumOptions) -> Pulse:
    """The pulse of a record.

    Raises
    ------
    CaseError
        If the source is no pulse, and the options do not say what it is.

    Examples
    --------
    >>> pulse_of("pulse:sine?amplitude=0.4g&period=1.2", SpectrumOptions())
    Pulse(period=1.2, amplitude=None)
    """
    given = options.pulses.get(source) or options.pulses.get(PurePath(source).name)
    if given is not None:
        return Pulse(given.period, given.amplitude)
    scheme, _, rest = source.partition(":")
    if scheme != "pulse":
        raise CaseError(
            f"{source} is no pulse with a period, as pulse:sine?amplitude=1g&period=1 is; say what"
            f" a file holds: pulses: {{{PurePath(source).name}: {{period: 0.8, amplitude: 3.9}}}}"
        )
    query: Query = parse_query(rest.partition("?")[2], source, PULSE_OPTIONS)
    return Pulse(query.quantity("period", "time"), None)


def records_without_period(layout: StudyPoints, options: SpectrumOptions) -> Iterator[str]:
    """Records of a study that have no place in a spectrum."""
    requests = {properties.record for properties in layout.properties}
    wanted = [request or other for request in layout.records for other in requests]
    for request in dict.fromkeys(wanted):
        try:
            if request is not None:
                pulse_of(request.source, options)
        except (CaseError, RecordError) as error:
            yield str(error)
            return


def _series(
    table: Table,
    values: tuple[object, ...],
    points: Indices,
    frequency: Array,
    amplitude: Array,
) -> SpectrumSeries:
    over = table.overturned[points]
    boundary = []
    for ratio in np.unique(frequency[points]):
        fell = points[over & (frequency[points] == ratio)]
        boundary.append((ratio, amplitude[fell].min() if len(fell) else math.nan))
    return SpectrumSeries(
        values=values,
        frequency_ratio=frequency[points],
        amplitude_ratio=amplitude[points],
        rotation_ratio=table.columns["rotation_ratio"][points],
        outcomes=tuple(table.outcomes[points].tolist()),
        boundary=np.array(boundary),
        failed=int(table.failed[points].sum()),
    )
