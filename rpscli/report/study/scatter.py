"""Points of a study as scatter: one demand against another,
systems against one, pulses.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import PurePath
from typing import Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from rpscli.analyses.outcomes import STOOD
from rpscli.case.schema.case_file import Time
from rpscli.case.schema.fields import Quantity, Section, Text
from rpscli.case.study.reports import ReportOptions, ReportRequest, VariedKeys
from rpscli.case.study.schema import Axis
from rpscli.case.text.document import Document, Fault, Path, dotted
from rpscli.errors import CaseError, RecordError, hint, is_number
from rpscli.records.measures import MEASURES
from rpscli.records.source import Source
from rpscli.report.figures import style
from rpscli.report.study import panels
from rpscli.report.study.bilinear import FEWEST, Bilinear, bilinear_fit
from rpscli.report.study.fragility import (
    measure_name,
    measure_without_period,
)
from rpscli.report.study.fragility_options import MeasureOptions
from rpscli.report.study.report import (
    Found,
    Report,
    keyed,
    without_uplift,
)
from rpscli.sweep.evaluation import SCALARS
from rpscli.sweep.motions import RecordRequest
from rpscli.sweep.names import labels, symbol, unit_of
from rpscli.sweep.points import StudyPoints
from rpscli.sweep.statistics.grouping import (
    INTENSITY,
    Grouping,
    Histories,
    grouping,
    shown_keys,
)
from rpscli.sweep.table import (
    Array,
    PointTable,
    StoredPoints,
    groups,
    leading_keys,
)
from rpscli.units import in_si


class DemandOptions(ReportOptions):
    """Base shear against rotation with its bilinear summary."""

    panels: VariedKeys | None = Field(
        None, description="varied keys, one panel for each value"
    )
    series: VariedKeys | None = Field(
        None, description="varied keys, one colour for each value"
    )


class ScatterOptions(DemandOptions):
    """Demands, measures of the motion or varied keys, a marker for
    each history that stood.
    """

    x: Text = Field(
        description="to the right: a demand, a measure as PGV, or a varied key"
    )
    y: Text = Field(description="upwards: likewise")


COEFFICIENTS = {
    "saturation_rotation_ratio": "break_x",
    "saturation_base_shear_ratio": "break_y",
    "k_s": "slope_after",
    "slope_before": "slope",
    "base_shear_ratio_at_uplift": "start",
    "residual": "residual",
}
"""Names of what a bilinear curve is made of in the table, and its attributes."""


class Ordinate(NamedTuple):
    """Values of all points on an axis (points,) [SI]."""

    name: str
    values: Array
    unit: str
    scale: panels.Scale

    @property
    def head(self) -> str:
        """Of its column."""
        return f"{self.name} [{self.unit}]"


def ordinate(table: PointTable, name: str) -> Ordinate:
    """A demand, a measure of the scaled motion (at T1), or a varied
    key, NaN where no number.
    """
    if (quantity := SCALARS["timehistory"].get(name)) is not None:
        scale = panels.scale_of_result(quantity)
        return Ordinate(name, table.columns[name], quantity.unit, scale)
    if name in MEASURES.names():
        found = table.intensity(name)
        scale = panels.scale_of(measure_name(found), found.unit)
        return Ordinate(name, found.values, found.unit, scale)
    values = np.full(len(table), np.nan)
    for group in groups(table.layout, [name]):
        value = in_si(group.values[0], unit_of(name))
        values[group.points] = value if is_number(value) else np.nan
    unit = unit_of(name)
    words = symbol(*shown_keys(table.layout, [name]))
    return Ordinate(name, values, unit, panels.scale_of(words, unit.strip("-")))


class Cloud(NamedTuple):
    """A panel: its histories, those of them that are drawn, and
    the curve through these.
    """

    values: tuple[object, ...]
    histories: Histories
    shown: Histories
    fit: Bilinear | None = None
    note: str | None = None  # why there is no curve


def scatter(study: StoredPoints, options: ScatterOptions) -> Found:
    """Every history that stood."""
    table = study.table
    series = options.series or ()
    both = ordinate(table, options.x), ordinate(table, options.y)
    found = grouping(table, options.panels, series)
    clouds = _clouds(found, both, ~table.overturned)
    rows = [
        (
            (*cloud.values, *part.values),
            n + 1,
            table.outcomes[n],
            *(of.values[n] for of in both),
        )
        for cloud in clouds
        for part in cloud.shown.parts(series)
        for n in part.points.tolist()
    ]
    keys = (*found.keys, *shown_keys(table.layout, series))
    heads = f"point, outcome, {both[0].head}, {both[1].head}"
    return Found(
        {"": keyed(keys, heads, rows)},
        _figure(table, found, clouds, both, series),
        found.notes,
    )


def demand(study: StoredPoints, options: DemandOptions) -> Found:
    """Histories that lifted off and stood, with a curve in each panel."""
    table = study.table
    leading = leading_keys(study.table.layout)
    series = options.series if options.series is not None else leading[1:-1]
    x, y = both = [
        ordinate(table, name) for name in ("rotation_ratio", "base_shear_ratio")
    ]
    found = grouping(table, options.panels, series)
    clouds = []
    for cloud in _clouds(found, both, np.isin(table.outcomes, STOOD)):
        at = x.values[cloud.shown.points]
        few = f"{len(np.unique(at))} different rotations of survivors"
        fit = bilinear_fit(at, y.values[cloud.shown.points])
        note = None if fit else f"{few}; the curve needs {2 * FEWEST}"
        clouds.append(cloud._replace(fit=fit, note=note))
    rows = [
        (
            cloud.values,
            *(getattr(cloud.fit, attribute, None) for attribute in COEFFICIENTS.values()),
            len(cloud.shown),
            int((table.outcomes[cloud.histories.points] == "at_rest").sum()),
            cloud.histories.overturned.number,
            cloud.histories.failed,
            cloud.note,
        )
        for cloud in clouds
    ]
    heads = f"{', '.join(COEFFICIENTS)}, counted, at_rest, overturned, failed, note"
    notes = list(found.notes)
    without = [cloud.note for cloud in clouds if cloud.note]
    if without:
        notes.append(
            f"{len(without)} of {len(clouds)} panels have no curve: {without[0]}"
        )
    figure = _figure(table, found, clouds, both, series, curves=True)
    return Found({"": keyed(found.keys, heads, rows)}, figure, notes)


def _clouds(
    found: Grouping, both: Sequence[Ordinate], kept: NDArray[np.bool_]
) -> list[Cloud]:
    """The points of each group that did not fail and have both values."""
    table = found.groups[0].table
    kept = kept & ~table.failed & np.isfinite([of.values for of in both]).all(axis=0)
    return [
        Cloud(of.values, of, Histories(table, of.values, of.points[kept[of.points]]))
        for of in found.groups
    ]


MARKS: dict[str, Any] = {"ls": "", "ms": 3.0, "mew": 0.0, "alpha": 0.7}
"""Look of points of a cloud."""


def _figure(
    table: PointTable,
    found: Grouping,
    clouds: Sequence[Cloud],
    both: Sequence[Ordinate],
    series: tuple[str, ...],
    *,
    curves: bool = False,
) -> Callable[[str], style.Draw]:
    x, y = both
    series_keys = shown_keys(table.layout, series)
    every = np.concatenate([cloud.shown.points for cloud in clouds])
    most = max(len(cloud.shown.parts(series)) for cloud in clouds)
    highest, top = (float(of.values[every].max(initial=0.0)) for of in both)

    def draw(axes: style.Axes, cloud: Cloud) -> None:
        for place, part in enumerate(cloud.shown.parts(series)):
            at = part.points
            look = MARKS | panels.look(place, most)
            name = labels(series_keys, part.values) or None
            axes.plot(x.values[at], y.values[at], label=name, **look)
        if curves:
            _draw_curve(axes, cloud.fit, x.values[cloud.shown.points], highest, top)

    return panels.in_panels(
        found.keys,
        clouds,
        draw,
        x_label=x.scale,
        y_label=y.scale,
        limits=lambda axes: axes.set(xlim=(0.0, 1.04 * highest or 1.0), ylim=(0.0, None)),
        note=panels.noted(
            found,
            "fits without bands" * any(cloud.fit for cloud in clouds),
            panels.shaded(most),
            f"{found.overturned} overturned points left out" * bool(found.overturned),
        ),
    )


def _draw_curve(
    axes: style.Axes, fit: Bilinear | None, x: Array, highest: float, top: float
) -> None:
    """The curve as far as its points (m,) go, with its numbers where
    it leaves room for them.
    """
    apart = panels.break_if_narrow(axes)
    text = "no curve: too few points"
    place = ("right", "bottom")
    if fit is not None:
        ends = np.array([x.min(), fit.break_x, x.max()])
        axes.plot(ends, fit(ends), color=style.BLACK, lw=1.6, label="bilinear fit")
        text = (
            f"saturation at{apart}{fit.break_x:.3f}, {fit.break_y:.2f}"
            f"\nslope kₛ{apart}{fit.slope_after:.2f} beyond,"
            f"\nfrom {int((x > fit.break_x).sum())} of {len(x)}"
        )
        if np.min(fit(np.linspace(0.3, 1.0, 8) * highest)) < 0.35 * top:
            place = ("left", "top")  # the curve runs through the lower right
    if not style.tight(axes.figure):
        box = {"fc": "white", "ec": "none", "alpha": 0.8, "pad": 1.5}
        panels.corner(axes, *place, text, bbox=box)


def unknown_axes(
    _document: Document, axes: Sequence[Axis], request: ReportRequest
) -> Iterator[Fault]:
    """Axes of what is no demand, no measure, and does not vary as a number."""
    assert isinstance(request.options, ScatterOptions), (
        "requests have the options of their kind"
    )
    varied = {
        key
        for axis in axes
        for place, key in enumerate(axis.keys)
        if all(is_number(in_si(row[place], unit_of(key))) for row in axis.rows)
    }
    known = [*SCALARS["timehistory"], *MEASURES.names(), *varied, INTENSITY]
    for option in ("x", "y"):
        if (name := getattr(request.options, option)) not in known:
            path: Path = (*request.path, request.kind, option)
            otherwise = "`rps explain results` and `rps explain measures` list them"
            meant = hint(name, known, otherwise, 0.6)
            text = (
                f"{dotted(path)} = {name} is no demand, no measure and no varied number;"
                f" {meant}"
            )
            yield Fault(path, text)


def measures_without_period(
    layout: StudyPoints, options: ScatterOptions
) -> Iterator[str]:
    """Measures at T1 where systems have none."""
    for name in {options.x, options.y} & {*MEASURES.names()}:
        yield from measure_without_period(
            layout, MeasureOptions.model_construct(measure=name)
        )


NEGLIGIBLE = 1e-6
"""Rotation over the critical one below which a figure shows no uplift: at an amplitude of
exactly g tan(alpha) rounding decides about the outcome."""


class PulseSection(Section):
    """What a record that is not made from a formula has for a pulse."""

    period: Time = Field(description="of the pulse")
    amplitude: Annotated[float, Quantity("m/s2", above=0)] | None = None
    """peak acceleration of the unscaled pulse; that of the record by default"""


class SpectrumOptions(DemandOptions):
    """Overturning spectrum of pulses: amplitude over g tan(alpha)
    against frequency over p.
    """

    pulses: dict[str, PulseSection] = Field(
        {},
        description="period and amplitude of records that are files, by source or name",
    )


LOOKS = (
    ("at_rest", "at rest", style.GREY, ".", 2.0),
    ("survived", "survived", style.SKY, "o", 3.0),
    ("stays_tilted", "stays tilted", style.BLUE, "o", 3.0),
    ("overturned", "overturned", style.RED, "s", 3.0),
)


class Spectrum(NamedTuple):
    """Pulses in the plane of dimensionless frequency and amplitude, and their outcomes."""

    frequency: Array  # (points,), as all others
    amplitude: Array
    outcomes: NDArray[np.str_]  # as they are drawn
    series: tuple[str, ...]
    parts: dict[Histories, list[Histories]]  # the series of each group

    @property
    def most(self) -> int:
        """Series of the group that has most of them."""
        return max(map(len, self.parts.values()))


def overturning_spectrum(study: StoredPoints, options: SpectrumOptions) -> Found:
    """Amplitude and frequency of every point, made dimensionless by its own system."""
    table = study.table
    series = options.series or ()
    both = _pulses_of(study, options)
    found = grouping(table, options.panels, (*series, INTENSITY, "record"))
    series_keys = shown_keys(table.layout, series)
    parts = {group: group.parts(series) for group in found.groups}
    spectrum = Spectrum(*both, _without_uplift(table), series_keys, parts)
    rows = [
        (
            (*group.values, *part.values),
            *(of[n] for of in (*both, table.columns["rotation_ratio"], table.outcomes)),
        )
        for group, parts_of_it in parts.items()
        for part in parts_of_it
        for n in part.every.tolist()
    ]
    heads = "frequency_over_p, amplitude_over_g_tan_alpha, rotation_ratio, outcome"
    most = spectrum.most
    figure = panels.in_panels(
        found.keys,
        found.groups,
        partial(_draw_spectrum, spectrum=spectrum),
        x_label=r"$\omega/p$ [-]",
        y_label=r"$a_p/(g\,\tan\alpha)$ [-]",
        limits=lambda axes: axes.set(xlim=(0.0, None), ylim=(0.0, None)),
        note=panels.noted(
            found, "only what overturned" * (most > 1), panels.shaded(most)
        ),
    )
    return Found({"": keyed((*found.keys, *series_keys), heads, rows)}, figure)


def _without_uplift(table: PointTable) -> NDArray[np.str_]:
    """The outcomes; at rest is what a figure shows as such."""
    rotation = table.columns["rotation_ratio"]
    negligible = (table.outcomes == "survived") & (rotation < NEGLIGIBLE)
    return np.where(negligible, "at_rest", table.outcomes)


def _draw_spectrum(axes: style.Axes, group: Histories, spectrum: Spectrum) -> None:
    """Outcomes of one series with their boundary, or what overturned of several."""
    frequency = spectrum.frequency
    amplitude = spectrum.amplitude
    most = spectrum.most
    for place, part in enumerate(spectrum.parts[group]):
        boundary = _boundary(part, frequency, amplitude)
        if most > 1:
            # What overturned and the least that did; survivors would hide the other
            # series.
            fell = part.points[part.fallen]
            name = labels(spectrum.series, part.values)
            look = panels.look(place, most)
            faint = look | {"ls": "", "ms": 2.6, "mew": 0.0, "alpha": 0.35}
            axes.plot(frequency[fell], amplitude[fell], **faint)
            axes.plot(*boundary, ms=3.4, lw=1.3, label=name, **look)
        else:
            _draw_outcomes(axes, part, spectrum)
            axes.plot(*boundary, color=style.BLACK, lw=1.2, label="least that overturns")


def _draw_outcomes(axes: style.Axes, part: Histories, spectrum: Spectrum) -> None:
    """A mark for each history, by its outcome."""
    outcomes = spectrum.outcomes[part.every]
    for word, name, shade, mark, size in LOOKS:
        chosen = part.every[np.char.startswith(outcomes, word)]
        if len(chosen):
            look: dict[str, Any] = {"color": shade, "marker": mark, "ms": size}
            look |= {"ls": "", "mew": 0.0}
            at = spectrum.frequency[chosen], spectrum.amplitude[chosen]
            axes.plot(*at, label=name, **look)


def _pulses_of(study: StoredPoints, options: SpectrumOptions) -> tuple[Array, Array]:
    """(points,) frequency of the pulse over p, and its amplitude over g tan(alpha)."""
    table = study.table
    layout = study.table.layout
    pulses: dict[RecordRequest, PulseSection] = {}
    frequency, amplitude = np.full((2, len(table)), np.nan)
    for point in layout:
        assert point.record is not None, "points of histories have a record"
        of = layout.properties[point.system]
        number = point.number
        if (pulse := pulses.get(point.record)) is None:
            pulse = pulses[point.record] = pulse_of(point.record.source, options)
        frequency[number] = 2.0 * math.pi / pulse.period / of.frequency_parameter
        if not table.failed[number]:
            peak = pulse.amplitude or study.context.records.intensity(point.record, "PGA")
            amplitude[number] = peak * abs(table.scale[number]) / of.uplift_acceleration
    return frequency, amplitude


def _boundary(part: Histories, frequency: Array, amplitude: Array) -> tuple[Array, Array]:
    """Frequency ratios, and the least amplitude ratios that
    overturned; NaN where none did.
    """
    fallen = part.points[part.fallen]
    ratios = np.unique(frequency[part.every])
    least = [
        amplitude[fallen[frequency[fallen] == r]].min(initial=np.inf) for r in ratios
    ]
    return ratios, np.where(np.isfinite(least), least, np.nan)


def pulse_of(source: str, options: SpectrumOptions) -> PulseSection:
    """The pulse of a record; a CaseError if it is none, and the
    options do not say what it is.

    >>> pulse_of("pulse:sine?amplitude=0.4g&period=1.2&factor=2", SpectrumOptions())
    PulseSection(period=1.2, amplitude=None)
    """
    given = options.pulses.get(source) or options.pulses.get(PurePath(source).name)
    if given is not None:
        return given
    if (of := Source.parse(source)).scheme != "pulse":
        raise CaseError(
            f"{source} is not a pulse with a period such as"
            " pulse:sine?amplitude=1g&period=1; give that of a file: pulses:"
            f" {{{PurePath(source).name}: {{period: 0.8, amplitude: 3.9}}}}"
        )
    return PulseSection.model_construct(period=of.quantity("period", "time"))


def records_without_period(
    layout: StudyPoints, options: SpectrumOptions
) -> Iterator[str]:
    """Records of a study that have no place in a spectrum."""
    yield from without_uplift(layout, options)
    requests = {properties.record for properties in layout.properties}
    wanted = [request or other for request in layout.records for other in requests]
    for request in filter(None, dict.fromkeys(wanted)):
        try:
            pulse_of(request.source, options)
        except (CaseError, RecordError) as error:
            yield str(error)
            return


SCATTER = Report(
    ScatterOptions,
    scatter,
    check=unknown_axes,
    requires=measures_without_period,
    results=lambda of: [name for name in (of.x, of.y) if name in SCALARS["timehistory"]],
)
DEMAND = Report(DemandOptions, demand)
OVERTURNING_SPECTRUM = Report(
    SpectrumOptions, overturning_spectrum, requires=records_without_period
)
