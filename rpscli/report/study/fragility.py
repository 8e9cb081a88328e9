"""Fragility: probability of exceeding a limit state against the intensity of the motion."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from operator import attrgetter
from typing import Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, StrictBool, create_model
from pydantic_core import PydanticCustomError

from rpscli.analyses.result_quantities import LIMITED
from rpscli.case.conditions import LIMITS
from rpscli.case.schema.case_file import Time
from rpscli.case.schema.fields import DampingRatio, Quantity, Section, Whole
from rpscli.case.schema.limits import described
from rpscli.case.schema.scale_to import MeasureName
from rpscli.case.study.reports import ReportOptions, VariedKeys
from rpscli.case.study.schema import Option, PositiveNumber, PositiveNumbers, Seed
from rpscli.records.measures import MEASURES, measure_label, needs_period
from rpscli.report.figures import style
from rpscli.report.study.labels import keyed, labels
from rpscli.report.study.panels import Layout, colour, left_out, marker, over, panel_figure, remarks
from rpscli.report.study.report import Found, Report
from rpscli.report.study.statistics import counted_columns, share_columns
from rpscli.report.table import Column
from rpscli.sweep.fits.lognormal import Bootstrap, Lognormal, band, lognormal_fit
from rpscli.sweep.points import StudyPoints
from rpscli.sweep.statistics.fractiles import CONFIDENCE, Share, share_of
from rpscli.sweep.statistics.grouping import INTENSITY, Grouping, Histories, grouping
from rpscli.sweep.statistics.verdicts import exceeds
from rpscli.sweep.table import Array, Indices, Intensity, StudyResults, Table

CURVE_POINTS = 101
MOST_BINS = 10
MOST_BANDS = 4
"""Curves in one panel beyond which bands would hide each other."""

_THRESHOLDS: Any = {
    quantity.name: (PositiveNumbers | None, Field(None, description=described(quantity)))
    for quantity in LIMITED
}


class LimitStates(create_model("LimitStates", __base__=Section, **_THRESHOLDS)):  # type: ignore[misc]
    """Limit states of a fragility; overturning exceeds every one of them."""

    overturning: StrictBool = Field(
        default=True, description="whether overturning is a limit state itself"
    )


class MeasureOptions(ReportOptions):
    """Options of reports that need an intensity measure."""

    measure: MeasureName | None = Field(
        None, description="the one that the study scales to by default, else PGV"
    )
    period: Time | None = Field(
        None, description="of Sa, AvgSa or FIV3; T1 of each system by default"
    )
    damping: DampingRatio = Field(0.05, description="of Sa, AvgSa or Housner")


class BandOptions(MeasureOptions):
    """Options of reports whose curves have bands."""

    resamples: Annotated[int, Whole(0, 10_000)] = Field(
        400, description="bootstrap samples of the records for the bands; 0 = none"
    )
    confidence: Annotated[float, Quantity(above=0, below=1)] = Field(
        CONFIDENCE, description="probability inside the bands, for the choice of records"
    )
    seed: Seed = Field(1, description="of the bootstrap")

    @property
    def bootstrap(self) -> Bootstrap:
        """How the bands are had."""
        return Bootstrap(self.resamples, self.confidence, self.seed)


Dispersion = Annotated[float, Quantity(symbol="standard deviation of ln", at_least=0, at_most=2)]


class DispersionSection(Section):
    """Uncertainties in quadrature with the scatter of records (FEMA P695, section 7.3.4)."""

    record_to_record: Dispersion | None = None
    """in place of the beta of the fit, such as 0.4"""
    design_requirements: Dispersion = 0.0
    """beta_DR, 0.1 (superior) to 0.5 (poor)"""
    test_data: Dispersion = 0.0
    """beta_TD, 0.1 to 0.5"""
    modelling: Dispersion = 0.0
    """beta_MDL, 0.1 to 0.5"""

    @property
    def given(self) -> list[tuple[str, float]]:
        """Those that the study gives."""
        return [(key, value) for key, value in self if value]

    def total(self, beta: Any) -> Any:
        """beta_TOT from that of records."""
        own = beta if self.record_to_record is None else self.record_to_record + 0.0 * beta
        return np.sqrt(own**2 + self.design_requirements**2 + self.test_data**2 + self.modelling**2)


class FragilityOptions(BandOptions):
    """Probability of exceeding a limit state against an intensity measure."""

    limits: LimitStates = Field(LimitStates(), description="limit states")
    series: VariedKeys | None = Field(None, description="varied keys, one curve for each value")
    dispersion: DispersionSection = Field(
        DispersionSection(), description="uncertainty beyond the records"
    )
    at: dict[str, Option] = Field(
        {}, description="intensities by name, {MCE: 0.6 m/s}: collapse margin ratios, probabilities"
    )
    spectral_shape: PositiveNumber = Field(
        1.0, description="factor SSF of FEMA P695 on collapse margin ratios, made for Sa(T1)"
    )


class LimitState(NamedTuple):
    """Exceeded where a result is beyond a threshold; every overturned point exceeds it."""

    result: str
    threshold: float | None

    @property
    def label(self) -> str:
        """The state in words."""
        if self.threshold is None:
            return self.result
        sign = "<" if LIMITS[self.result].from_below else ">"
        return f"{self.result} {sign} {self.threshold:g}"


class Observed(NamedTuple):
    """Points that exceed the limit within a bin of intensities, each (bins,)."""

    intensity: Array
    shares: Sequence[Share]

    @property
    def share(self) -> Array:
        """Their parts of all."""
        return np.array([share.number / share.of for share in self.shares])


@dataclass(frozen=True, eq=False)
class Fragility:
    """Data and fit of one limit state of one group of systems; `failed` points are left out.

    `overturned` of the points that exceed the limit do so because they overturned. `place` is that
    of the group, `total` the beta with what is uncertain besides the records, `largest` the largest
    intensity that was computed.
    """

    values: tuple[object, ...]
    limit: LimitState
    fit: Lognormal
    grid: Array
    observed: Observed
    counted: int
    exceeded: int
    overturned: int
    failed: int
    place: int
    total: float
    largest: float


@dataclass(frozen=True, eq=False)
class Fragilities:
    """All curves of a report."""

    intensity: Intensity
    confidence: float
    systems: Grouping
    limits: tuple[LimitState, ...]
    curves: tuple[Fragility, ...]

    def fitted(self, limit: LimitState) -> list[Fragility]:
        """The curves of a limit state that could be fitted."""
        return [curve for curve in self.curves if curve.limit == limit and curve.fit.fitted]

    @property
    def notes(self) -> list[str]:
        """What is pooled, what overturning does to limits, and what keeps fits from being plain."""
        return [
            *self.systems.notes,
            *self._overturned,
            *told(self, ((curve, curve.fit.note) for curve in self.curves)),
        ]

    @property
    def _overturned(self) -> Iterator[str]:
        limited = [curve for curve in self.curves if curve.limit.threshold is not None]
        fallen = sum(curve.overturned for curve in limited)
        if fallen:
            exceeded = sum(curve.exceeded for curve in limited)
            counts = f"{fallen} of {exceeded} histories beyond a limit"
            yield f"an overturned history exceeds every limit: {counts} overturned"

    def named(self, curve: Fragility) -> str:
        """A curve's limit state with the values of its systems."""
        values = labels(self.systems.keys, curve.values)
        return f"{curve.limit.label}, {values}" if values else curve.limit.label


def fragilities(study: StudyResults, options: FragilityOptions) -> Fragilities:
    """Fit every limit state of every group of systems; samples and records are pooled."""
    measured = study.table.intensity(options.measure, options.period, options.damping)
    limits = tuple(limit_states(options.limits))
    systems = grouping(study.table, options.series, (INTENSITY,))
    curves = tuple(
        _fragility(measured, options, (place, group), limit)
        for limit in limits
        for place, group in enumerate(systems.groups)
    )
    return Fragilities(measured, options.confidence, systems, limits, curves)


def limit_states(limits: LimitStates) -> Iterator[LimitState]:
    """The limit states that a study asks for."""
    for quantity in LIMITED:
        for threshold in getattr(limits, quantity.name) or ():
            yield LimitState(quantity.name, threshold)
    if limits.overturning:
        yield LimitState("overturning", None)


def _fragility(
    measured: Intensity, options: FragilityOptions, placed: tuple[int, Histories], limit: LimitState
) -> Fragility:
    place, group = placed
    table, points = group.table, group.points
    kept = points[measured.values[points] > 0.0]
    intensity = measured.values[kept]
    beyond = exceeds(table, limit.result, limit.threshold or 0.0)[kept]
    grid = intensity_grid(intensity)
    fit = fragility_fit(table, kept, intensity, beyond, grid, options.bootstrap)
    return Fragility(
        place=place,
        values=group.values,
        limit=limit,
        fit=fit,
        total=float(options.dispersion.total(fit.beta)),
        largest=float(intensity.max(initial=0.0)),
        grid=grid,
        observed=binned(table, kept, intensity, beyond),
        counted=len(kept),
        exceeded=int(beyond.sum()),
        overturned=int(table.overturned[kept].sum()),
        failed=len(group.every) - len(kept),
    )


def fragility_fit(
    table: Table,
    points: Indices,
    intensity: Array,
    beyond: NDArray[np.bool_],
    grid: Array,
    bootstrap: Bootstrap,
) -> Lognormal:
    """A curve through what became of some points (m,) of a study under intensities (m,)."""
    layout = table.layout
    cluster = layout.clusters[points]
    # Motions over points: directions, samples and members of an ensemble share a motion.
    shaken = layout.recordings[points] * len(layout.scales) + layout.places[2][points]
    weight = len(np.unique(shaken)) / max(len(points), 1)
    # Members of an ensemble perturb one intensity, and tell no others.
    _, cell = np.unique(points // len(table.layout.members), return_inverse=True)
    means = np.bincount(cell, np.log(intensity)) / np.bincount(cell)
    level = np.exp(np.round(means, 9))[cell] if len(means) < len(points) else intensity
    return lognormal_fit(intensity, beyond, cluster, weight, grid, bootstrap, level)


def intensity_grid(intensities: Array) -> Array:
    """Intensities at which curves are drawn: some way beyond the data on both sides."""
    if not len(intensities):
        return np.ones(CURVE_POINTS)
    return np.geomspace(intensities.min() / 1.5, intensities.max() * 1.5, CURVE_POINTS)


def binned(table: Table, kept: Indices, intensity: Array, beyond: NDArray[np.bool_]) -> Observed:
    """Shares at each intensity, or in bins of equal numbers of points if there are too many."""
    levels, place = np.unique(intensity, return_inverse=True)
    if len(levels) > 2 * MOST_BINS:
        order = np.argsort(np.argsort(intensity, kind="stable"), kind="stable")
        place = order * MOST_BINS // len(intensity)
        levels = np.exp([np.log(intensity[place == i]).mean() for i in range(MOST_BINS)])
    bins = [np.flatnonzero(place == i) for i in range(len(levels))]
    return Observed(levels, tuple(share_of(table, kept[of], beyond[of]) for of in bins))


def measure_without_period(layout: StudyPoints, options: MeasureOptions) -> Iterator[str]:
    """What keeps a report from having the measure that it asks for."""
    at_first_period = needs_period(options.measure) and options.period is None
    if at_first_period and any(system.period is None for system in layout.properties):
        yield f"{options.measure} at T1 needs storeys; give the report a `period`"


def named_intensities(layout: StudyPoints, options: FragilityOptions) -> dict[str, float]:
    """The intensities under `at` in SI; raises pydantic's error if one is none."""
    scaled = layout.plan.measure
    measure = options.measure or (scaled.measure if scaled else "PGV")
    bounds = Quantity(MEASURES[measure].unit, symbol=measure, above=0)
    return {name: float(bounds.number(value)) for name, value in options.at.items()}


def fragility_faults(layout: StudyPoints, options: FragilityOptions) -> Iterator[str]:
    """What keeps a report from having its measure, or the intensities that it names."""
    yield from measure_without_period(layout, options)
    yield from wrong_intensities(layout, options)


def wrong_intensities(layout: StudyPoints, options: FragilityOptions) -> Iterator[str]:
    """What is no intensity under `at`."""
    try:
        named_intensities(layout, options)
    except PydanticCustomError as error:
        yield f"at: {error.message()}"


def told(found: Fragilities, notes: Iterable[tuple[Fragility, str | None]]) -> Iterator[str]:
    """Notes on curves, each once with all that it is about."""
    by_text: dict[str, list[str]] = {}
    for curve, text in notes:
        if text:
            by_text.setdefault(text, []).append(found.named(curve))
    for text, named in by_text.items():
        yield f"{'; '.join(named)}: {text}"


def margins(study: StudyResults, options: FragilityOptions, found: Fragilities) -> list[Column]:
    """Collapse margin ratios and probabilities at the intensities that the report names."""
    # CMR is the median over the intensity, ACMR = SSF CMR, and P = Phi(-ln(ACMR)/beta_TOT): FEMA
    # P695 (2009), chapter 7; its table 7-3 has the ACMR of probabilities of 10 and 20 %.
    from scipy.special import ndtr, ndtri

    factor, total = options.spectral_shape, options.dispersion.total
    rows = []
    for name, value in named_intensities(study.table.layout, options).items():
        for curve in found.curves:
            fit = curve.fit
            medians, betas = (
                np.append(one, many)
                for one, many in zip((fit.median, fit.beta), fit.resampled, strict=True)
            )
            acmr = factor * medians / value
            probable = ndtr(-np.log(acmr) / total(betas))
            ends = band(probable[1:], options.confidence)
            of_records = ndtr(-math.log(acmr[0]) / fit.beta) if fit.fitted else math.nan
            rows.append((
                curve.values, curve.limit.label, name, value, medians[0] / value, acmr[0],
                *(math.exp(-ndtri(share) * curve.total) for share in (0.1, 0.2)), fit.beta,
                curve.total, of_records, probable[0], *ends,
            ))  # fmt: skip
    heads = {"limit": "-", "name": "-", found.intensity.name: found.intensity.unit}
    heads |= dict.fromkeys(
        ("CMR", "ACMR", "ACMR_10", "ACMR_20", "beta", "beta_total", "probability_of_records"), "-"
    )
    heads |= dict.fromkeys(("probability", "probability_low", "probability_high"), "-")
    return keyed(found.systems.keys, heads, rows)


def fragility(study: StudyResults, options: FragilityOptions) -> Found:
    """Curves, and the data that they go through."""
    found = fragilities(study, options)
    keys, measure, unit = found.systems.keys, found.intensity.name, found.intensity.unit
    curves = [((curve.values, curve.limit.label), curve) for curve in found.curves]
    counted = attrgetter("total", "exceeded", "counted", "overturned", "failed", "fit.note")
    fits = [(*of, measure, *fit_cells(curve.fit), *counted(curve)) for of, curve in curves]
    counts = ("beta_total", "exceeded", "counted", "overturned_among_them", "failed", "note")
    fit_heads = {"limit": "-", "intensity": "-", **fit_units(unit), **dict.fromkeys(counts, "-")}
    lines = [
        (*of, *numbers)
        for of, curve in curves
        if curve.fit.fitted
        for numbers in zip(curve.grid, curve.fit.curve, *curve.fit.band, strict=True)
    ]
    observed = [
        ((*of, level), share)
        for of, curve in curves
        for level, share in zip(curve.observed.intensity, curve.observed.shares, strict=True)
    ]
    line_heads = {"limit": "-", measure: unit, "probability": "-", "low": "-", "high": "-"}
    levels, shares = [row for row, _ in observed], [share for _, share in observed]
    tables = {
        "": keyed(keys, fit_heads, fits),
        **({"_at": margins(study, options, found)} if options.at else {}),
        "_curves": keyed(keys, line_heads, lines),
        "_observed": [
            *keyed(keys, {"limit": "-", measure: unit}, levels),
            *counted_columns(shares),
            *share_columns("exceeded", shares),
        ],
    }
    drawable = any(curve.fit.fitted for curve in found.curves)
    main = dict.fromkeys((*keys, "limit", "median", "beta", *counts[:3]), "")
    if not options.dispersion.given:
        del main["beta_total"]
    shown = {"": main} | ({"_at": {}} if options.at else {})
    figure = (lambda title: fragility_figure(found, title)) if drawable else None
    remark = what_bands_hold(study.table.layout, options)
    if any(curve.fit.median > curve.largest for curve in found.curves):
        remark += "; a median beyond the largest intensity computed is extrapolated"
    return Found(tables, figure, found.notes, shown=shown, remark=remark)


def what_bands_hold(layout: StudyPoints, options: FragilityOptions) -> str:
    """What stands below numbers with bands."""
    drawn = len(np.unique(layout.recordings))
    chosen = f"{drawn} {layout.independent}" if drawn > 1 else "histories under one record"
    level = f"in brackets: {style.percent(options.confidence)} bands of the choice of {chosen}"
    given = ", ".join(f"{key.replace('_', ' ')} {v:g}" for key, v in options.dispersion.given)
    beyond = f"beta total: in quadrature with {given}" if given else "without modelling error"
    return f"{level} (bootstrap of {options.resamples}); {beyond}; -: not determined"


def fit_units(unit: str) -> dict[str, str]:
    """Columns of a fit, with their units."""
    medians = dict.fromkeys(("median", "median_low", "median_high"), unit)
    return {"method": "-", **medians, **dict.fromkeys(("beta", "beta_low", "beta_high"), "-")}


def fit_cells(fit: Lognormal) -> tuple[object, ...]:
    """A row of these columns."""
    return (fit.method, fit.median, *fit.median_band, fit.beta, *fit.beta_band)


def fragility_figure(report: Fragilities, title: str) -> bytes:
    """One panel a limit state with a fit; markers are observed shares, shades the bands."""
    from scipy.special import ndtr

    groups = len(report.systems.groups)
    limits = [limit for limit in report.limits if report.fitted(limit)]
    panels = [report.fitted(limit) for limit in limits]

    def draw(axes: style.Axes, curves: list[Fragility]) -> None:
        for curve in curves:
            place, shade = curve.place, colour(curve.place, groups)
            named, banded = labels(report.systems.keys, curve.values), len(curves) <= MOST_BANDS
            data = curve.grid, curve.fit, curve.observed
            draw_fit(axes, *data, shade, marker(place), named or None, banded=banded)
            if curve.total != curve.fit.beta:
                total = ndtr(np.log(curve.grid / curve.fit.median) / curve.total)
                axes.plot(curve.grid, total, ":", color=shade, lw=1.0)
        axes.set_ylim(-0.02, 1.02)
        axes.set_xlim(0.0, max(curve.grid[-1] for curve in curves))
        beyond_computed(axes, max(curve.largest for curve in curves), axes.get_xlim()[1])

    drawn = [curve for panel in panels for curve in panel]
    notes = ["markers: observed", band_words(report.confidence, (c.fit for c in drawn))]
    if any(curve.total != curve.fit.beta for curve in drawn):
        notes.append("dotted: with further dispersion")
    notes.append(BEYOND_COMPUTED)
    if any(c.fit.method == "penalised" for c in report.curves):
        notes.append("dashed: separated data, penalised fit")
    if any(limit.threshold is not None for limit in limits):
        notes.append("overturning exceeds every limit")
    if missing := sum(not c.fit.fitted for c in report.curves):
        notes.append(f"{missing} of {len(report.curves)} curves without a fit, see CSV")
    notes += [
        over(report.systems.pooled),
        left_out(sum(c.failed for c in panels[0]) if panels else 0),
    ]
    return panel_figure(
        limit_panels(limits),
        panels,
        draw,
        title=title,
        x_label=f"{measure_name(report.intensity)} [{report.intensity.unit}]",
        y_label="probability of exceedance",
        note=remarks(*notes),
    )


def draw_fit(
    axes: style.Axes, grid: Array, fit: Lognormal, seen: Observed, shade: str, mark: str,
    label: str | None, *, banded: bool = True,
) -> None:  # fmt: skip
    """A fragility, its band, and the shares that it goes through."""
    if fit.fitted:
        axes.plot(
            grid, fit.curve, "--" if fit.method == "penalised" else "-", color=shade, lw=1.4,
            marker=mark, ms=3.2, markevery=[], label=label,  # the legend shows both
        )  # fmt: skip
        if banded:
            axes.fill_between(grid, *fit.band, color=shade, alpha=0.15, lw=0)
        label = None
    axes.plot(
        seen.intensity, seen.share, ls="", color=shade, marker=mark, ms=3.2, alpha=0.8, label=label
    )


def band_words(confidence: float, fits: Iterable[Lognormal]) -> str:
    """A remark on the bands of curves."""
    if not any(np.isfinite(fit.band[0]).any() for fit in fits):
        return "no bands are determined"
    return f"bands: {style.percent(confidence)}, the choice of records"


BEYOND_COMPUTED = "grey: stronger than computed"


def beyond_computed(axes: style.Axes, largest: float, end: float) -> None:
    """Shade what is beyond the largest intensity that was computed."""
    if largest < end:
        axes.axvspan(largest, end, color=style.GREY, alpha=0.15, lw=0, zorder=0)


def limit_name(limit: LimitState) -> str:
    """The limit state in the words of the results."""
    if limit.result not in LIMITS:
        return limit.label
    known = LIMITS[limit.result]
    unit = f" {known.unit}" if known.unit not in {"", "-"} else ""
    return limit.label.replace(limit.result, known.label, 1) + unit


def limit_panels(limits: Sequence[LimitState]) -> Layout:
    """A panel for each limit state, up to three in a row."""
    in_row = 2 if len(limits) == 4 else max(1, min(3, len(limits)))
    return Layout([limit_name(limit) for limit in limits], in_row)


def measure_name(intensity: Intensity) -> str:
    """The measure with its period."""
    if not needs_period(intensity.measure):
        return intensity.name
    at = "T1" if intensity.period is None else f"{intensity.period:g} s"
    return measure_label(intensity.measure, intensity.of, at)


def limited_results(options: Any) -> list[str]:
    """Results that the limit states of a report are about."""
    return [limit.result for limit in limit_states(options.limits)]


REPORT = Report(FragilityOptions, fragility, requires=fragility_faults, results=limited_results)
