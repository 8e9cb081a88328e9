"""Fragility: probability of exceeding a limit state against the
intensity of the motion.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray
from pydantic_core import PydanticCustomError

from rpscli.records.measures import measure_label, needs_period
from rpscli.report.figures import style
from rpscli.report.study import panels
from rpscli.report.study.fragility_options import (
    FragilityOptions,
    LimitState,
    MeasureOptions,
)
from rpscli.report.study.report import Found, Report, keyed
from rpscli.report.study.statistics import counted_columns, share_columns
from rpscli.report.table import Column, told_once
from rpscli.sweep.names import labels
from rpscli.sweep.points import StudyPoints
from rpscli.sweep.statistics.fractiles import Share, share_of
from rpscli.sweep.statistics.grouping import (
    INTENSITY,
    Grouping,
    Histories,
    grouping,
    own_keys,
)
from rpscli.sweep.statistics.lognormal import Bootstrap, Lognormal, band, lognormal_fit
from rpscli.sweep.statistics.verdicts import exceeds
from rpscli.sweep.table import (
    Array,
    Indices,
    Intensity,
    Outcomes,
    PointTable,
    StoredPoints,
)

Item = TypeVar("Item")

CURVE_POINTS = 101
MOST_BINS = 10
MOST_BANDS = 4  # curves in one panel beyond which bands would hide each other


class Binned(NamedTuple):
    """Points that exceed the limit within a bin of intensities, each (bins,)."""

    intensity: Array
    shares: Sequence[Share]

    @property
    def share(self) -> Array:
        """Their parts of all."""
        return np.array([share.number / share.of for share in self.shares])


@dataclass(frozen=True, eq=False)
class Fragility:
    """Data and fit of one limit state of one group of systems;
    `failed` points are left out.
    """

    values: tuple[object, ...]
    limit: LimitState
    fit: Lognormal
    grid: Array
    observed: Binned
    counted: int
    exceeded: int
    overturned: int  # of those that exceed the limit
    failed: int
    place: int  # of the group
    total: float  # beta with what is uncertain besides the records
    largest: float  # intensity that was computed
    smallest: float  # likewise


@dataclass(frozen=True, eq=False)
class Fragilities:
    """All curves of a report."""

    intensity: Intensity
    confidence: float
    systems: Grouping
    limits: tuple[LimitState, ...]
    curves: tuple[Fragility, ...]
    apart: int = 0  # keys of systems that tell panels apart, the first ones

    @property
    def notes(self) -> Iterator[str]:
        """Notes on what is pooled, on overturning beyond limits, and on
        fits that are not plain.
        """
        yield from self.systems.notes
        limited = [curve for curve in self.curves if curve.limit.threshold is not None]
        if fallen := sum(curve.overturned for curve in limited):
            counts = (
                f"{fallen} of {sum(c.exceeded for c in limited)} histories beyond a limit"
            )
            yield f"an overturned history exceeds every limit: {counts} overturned"
        yield from self.told((curve, curve.fit.note) for curve in self.curves)

    def placed(self, curve: Fragility) -> tuple[str, str, int, int]:
        """Panel, name and place among how many: systems in panels
        of states, or the reverse.
        """
        keys = self.systems.keys
        limit = curve.limit.title
        if of := self.apart:
            panel = labels(keys[:of], curve.values[:of])
            name = labels(keys[of:], curve.values[of:])
            place = self.series.index(repr(curve.values[of:]))
            title = f"{limit}, {panel}" if len(self.limits) > 1 else panel
            return title, name, place, len(self.series)
        system = labels(keys, curve.values)
        if len(self.systems.groups) > len(panels.COLOURS):
            return system, limit, self.limits.index(curve.limit), len(self.limits)
        return limit, system, curve.place, len(self.systems.groups)

    @cached_property
    def series(self) -> list[str]:
        """Values that tell curves of one panel apart, as texts."""
        values = (repr(group.values[self.apart :]) for group in self.systems.groups)
        return [*dict.fromkeys(values)]

    def in_panels(
        self, items: Iterable[Item], of: Callable[[Item], Fragility]
    ) -> dict[str, list[Item]]:
        """Items whose curves share a panel, by its title."""
        found: dict[str, list[Item]] = {}
        for item in items:
            found.setdefault(self.placed(of(item))[0], []).append(item)
        return found

    def figure(
        self,
        groups: Mapping[str, list[Item]],
        draw: Callable[[style.Axes, list[Item]], None],
        **words: Any,
    ) -> Callable[[str], style.Draw]:
        """A figure of panels by their titles."""
        x_label = f"{measure_name(self.intensity)} [{self.intensity.unit}]"
        row = 2 if len(groups) == 4 else 3
        if self.apart:
            row = panels.in_row(
                [group.values[: self.apart] for group in self.systems.groups]
            )
        shown = [*groups.values()]
        return panels.PanelFigure(
            [*groups], shown, draw, in_row=row, x_label=x_label, **words
        )

    def told(self, notes: Iterable[tuple[Fragility, str | None]]) -> Iterator[str]:
        """Notes on curves, a line for each kind."""
        named = ((self.named(curve), text) for curve, text in notes if text)
        yield from told_once(named, len(self.curves), "curves")

    def named(self, curve: Fragility) -> str:
        """A curve's limit state with the values of its systems."""
        values = labels(self.systems.keys, curve.values)
        return f"{curve.limit.label}, {values}" if values else curve.limit.label


def fragilities(study: StoredPoints, options: FragilityOptions) -> Fragilities:
    """Fit every limit state of every group of systems; samples and records are pooled."""
    measured = study.table.intensity(options.measure, options.period, options.damping)
    limits = tuple(options.limits.states)
    apart = options.panels
    series = options.series
    if apart and series is None:
        series = own_keys(study.table.layout, (*apart, INTENSITY))
    keys = series if series is None else (*apart, *(k for k in series if k not in apart))
    systems = grouping(study.table, keys, (INTENSITY,))
    curves = tuple(
        _fragility(study.table, measured, options, (place, group), limit)
        for limit in limits
        for place, group in enumerate(systems.groups)
    )
    return Fragilities(measured, options.confidence, systems, limits, curves, len(apart))


def _fragility(
    table: PointTable,
    measured: Intensity,
    options: FragilityOptions,
    placed: tuple[int, Histories],
    limit: LimitState,
) -> Fragility:
    place, group = placed
    layout = table.layout
    points = group.points
    kept = points[measured.values[points] > 0.0]
    intensity = measured.values[kept]
    beyond = exceeds(table, limit.result, limit.threshold or 0.0)[kept]
    # Some way beyond the data on both sides.
    low, high = (
        (intensity.min() / 1.5, intensity.max() * 1.5) if len(kept) else (1.0, 1.0)
    )
    grid = np.geomspace(low, high, CURVE_POINTS)
    # Motions over points: directions, samples and members of an ensemble share a motion.
    shaken = layout.recordings[kept] * len(layout.scales) + layout.places.scale[kept]
    weight = len(np.unique(shaken)) / max(len(kept), 1)
    # Members of an ensemble perturb one intensity, and tell no others.
    _, cell = np.unique(kept // len(layout.members), return_inverse=True)
    means = np.bincount(cell, np.log(intensity)) / np.bincount(cell)
    level = np.exp(np.round(means, 9))[cell] if len(means) < len(kept) else intensity
    bootstrap = Bootstrap(options.resamples, options.confidence, options.seed)
    fit = lognormal_fit(
        intensity, beyond, layout.clusters[kept], weight, grid, bootstrap, level
    )
    counts = len(kept), int(beyond.sum()), int(table.overturned[kept].sum())
    total = float(options.dispersion.total(fit.beta))
    largest = float(intensity.max(initial=0.0))
    ends = largest, float(intensity.min(initial=largest))
    seen = binned(table, kept, intensity, beyond)
    failed = len(group.every) - len(kept)
    known = (fit, grid, seen, *counts, failed, place, total)
    return Fragility(group.values, limit, *known, *ends)


def binned(
    table: Outcomes, kept: Indices, intensity: Array, beyond: NDArray[np.bool_]
) -> Binned:
    """Shares at each intensity, or in bins of equal numbers of
    points if there are too many.
    """
    levels, place = np.unique(intensity, return_inverse=True)
    if len(levels) > 2 * MOST_BINS:
        order = np.argsort(np.argsort(intensity, kind="stable"), kind="stable")
        place = order * MOST_BINS // len(intensity)
        levels = np.exp([np.log(intensity[place == i]).mean() for i in range(MOST_BINS)])
    bins = [np.flatnonzero(place == i) for i in range(len(levels))]
    return Binned(levels, tuple(share_of(table, kept[of], beyond[of]) for of in bins))


def measure_without_period(layout: StudyPoints, options: MeasureOptions) -> Iterator[str]:
    """The fault of a measure at T1 in a study with systems that have none."""
    at_t1 = needs_period(options.measure) and options.period is None
    if at_t1 and any(system.period is None for system in layout.properties):
        yield f"{options.measure} at T1 needs storeys; give the report a `period`"


def fragility_faults(layout: StudyPoints, options: FragilityOptions) -> Iterator[str]:
    """Faults of the measure, and of a value under `at` that is no intensity."""
    yield from measure_without_period(layout, options)
    try:
        options.intensities(layout)
    except PydanticCustomError as error:
        yield f"at: {error.message()}"


def margins(
    study: StoredPoints, options: FragilityOptions, found: Fragilities
) -> list[Column]:
    """Collapse margin ratios and probabilities at the
    intensities that the report names.
    """
    # CMR is the median over the intensity, ACMR = SSF CMR, and P =
    # Phi(-ln(ACMR)/beta_TOT): FEMA P695 (2009), chapter 7; its table 7-3 has the ACMR of
    # probabilities of 10 and 20 %.
    from scipy.special import ndtr, ndtri

    factor = options.spectral_shape
    total = options.dispersion.total
    rows = []
    for name, value in options.intensities(study.table.layout).items():
        for curve in found.curves:
            fit = curve.fit
            (medians, betas) = curve.fit.resampled
            cmr = fit.median / value
            below, resampled = (-np.log(factor * of) for of in (cmr, medians / value))
            ends = band(ndtr(resampled / total(betas)), options.confidence)
            rows.append((
                curve.values, curve.limit.label, name, value, cmr, factor * cmr,
                *(math.exp(-ndtri(share) * curve.total) for share in (0.1, 0.2)), fit.beta,
                curve.total, ndtr(below / fit.beta), ndtr(below / curve.total), *ends,
            ))  # fmt: skip
    heads = (
        f"limit, name, {found.intensity.name} [{found.intensity.unit}], CMR, ACMR,"
        " ACMR_10"
    )
    heads += (
        ", ACMR_20, beta, beta_total, probability_of_records, probability,"
        " probability_low"
    )
    return keyed(found.systems.keys, f"{heads}, probability_high", rows)


def fragility(study: StoredPoints, options: FragilityOptions) -> Found:
    """Curves, and the data that they go through."""
    found = fragilities(study, options)
    keys = found.systems.keys
    tables = {
        "": _fit_columns(found),
        **({"_at": margins(study, options, found)} if options.at else {}),
        **_curve_columns(found),
    }
    total = ["beta_total"] * bool(options.dispersion.given)
    main = (*keys, "limit", "median", "beta", *total, "exceeded", "counted")
    remark = what_bands_hold(study.table.layout, options)
    if any(curve.fit.median > curve.largest for curve in found.curves):
        remark += "; a median beyond the largest intensity computed is extrapolated"
    return Found(
        tables,
        fragility_figure(found)
        if any(curve.fit.fitted for curve in found.curves)
        else None,
        list(found.notes),
        shown={"": dict.fromkeys(main, "")} | ({"_at": {}} if options.at else {}),
        remark=remark,
    )


def _fit_columns(found: Fragilities) -> list[Column]:
    """One row a curve: its fit with bands, and what it rests on."""
    unit = found.intensity.unit
    heads = (
        f"limit, intensity, method, median [{unit}], median_low [{unit}], median_high"
        f" [{unit}], beta, beta_low, beta_high, beta_total, exceeded, counted,"
        " overturned_among_them, failed, note"
    )
    rows = [
        (
            c.values, c.limit.label, found.intensity.name, fit.method, fit.median,
            *fit.median_band, fit.beta, *fit.beta_band, c.total, c.exceeded, c.counted,
            c.overturned, c.failed, fit.note,
        )
        for c in found.curves
        for fit in [c.fit]
    ]  # fmt: skip
    return keyed(found.systems.keys, heads, rows)


def _curve_columns(found: Fragilities) -> dict[str, list[Column]]:
    """Fitted curves with bands, and the observed shares that they go through."""
    keys = found.systems.keys
    at = f"limit, {found.intensity.name} [{found.intensity.unit}]"
    curves = [((curve.values, curve.limit.label), curve) for curve in found.curves]
    lines = [
        (*of, *numbers)
        for of, curve in curves
        if curve.fit.fitted
        for numbers in zip(curve.grid, curve.fit.curve, *curve.fit.band, strict=True)
    ]
    levels = [(*of, level) for of, curve in curves for level in curve.observed.intensity]
    shares = [share for _, curve in curves for share in curve.observed.shares]
    return {
        "_curves": keyed(keys, f"{at}, probability, low, high", lines),
        "_observed": [
            *keyed(keys, at, levels),
            *counted_columns(shares),
            *share_columns("exceeded", shares),
        ],
    }


def what_bands_hold(layout: StudyPoints, options: FragilityOptions) -> str:
    """The remark below numbers with bands."""
    drawn = len(np.unique(layout.recordings))
    chosen = (
        f"{drawn} {layout.independent}" if drawn > 1 else "histories under one record"
    )
    level = (
        f"in brackets: {style.percent(options.confidence)} bands of the choice of"
        f" {chosen}"
    )
    given = ", ".join(
        f"{key.replace('_', ' ')} {v:g}" for key, v in options.dispersion.given
    )
    beyond = (
        f"beta total: in quadrature with {given}" if given else "without modelling error"
    )
    return f"{level} (bootstrap of {options.resamples}); {beyond}; -: not determined"


def fragility_figure(report: Fragilities) -> Callable[[str], style.Draw]:
    """One panel a limit state with a fit; markers are observed
    shares, shades the bands.
    """
    drawn = [curve for curve in report.curves if curve.fit.fitted]
    groups = report.in_panels(report.curves, lambda curve: curve)
    missing = sum(not curve.fit.fitted for curve in report.curves)
    penalised = any(curve.fit.method == "penalised" for curve in report.curves)
    note = panels.remarks(
        "markers: observed",
        _remark_on_bands(report, groups.values()),
        "dotted: with further dispersion" * any(c.total != c.fit.beta for c in drawn),
        BEYOND_COMPUTED,
        "dashed: separated data, penalised fit" * penalised,
        "overturning exceeds every limit"
        * any(c.limit.threshold is not None for c in drawn),
        f"{missing} of {len(report.curves)} curves without a fit, see CSV"
        * bool(missing),
        panels.over(report.systems.pooled),
        panels.left_out(sum({curve.place: curve.failed for curve in drawn}.values())),
    )
    draw = partial(_draw_curves, report=report)
    return report.figure(groups, draw, y_label="probability of exceedance", note=note)


def _draw_curves(axes: style.Axes, curves: list[Fragility], report: Fragilities) -> None:
    """Curves of one panel, with what they go through and how sure they are."""
    from scipy.special import ndtr

    known = [curve for curve in curves if curve.fit.fitted]
    axes.set_ylim(-0.02, 1.02)
    if not known:
        panels.nothing(axes, "no curve")
        return
    for curve in known:
        fit = curve.fit
        grid = curve.grid
        seen = curve.observed
        _, name, place, count = report.placed(curve)
        look = panels.look(place, count) | {"ms": 3.2}
        dashes = "--" if fit.method == "penalised" else "-"
        axes.plot(
            grid, fit.curve, dashes, lw=1.4, markevery=[], label=name or None, **look
        )
        if len(known) <= MOST_BANDS:
            axes.fill_between(grid, *fit.band, color=look["color"], alpha=0.15, lw=0)
        axes.plot(seen.intensity, seen.share, ls="", alpha=0.8, **look)
        if curve.total != fit.beta:
            total = ndtr(np.log(grid / fit.median) / curve.total)
            axes.plot(grid, total, ":", color=look["color"], lw=1.0)
    axes.set_xlim(0.0, max(curve.grid[-1] for curve in known))
    last = max(curve.largest for curve in known)
    shade_not_computed(axes, last, axes.get_xlim()[1])


def _remark_on_bands(report: Fragilities, groups: Iterable[list[Fragility]]) -> str:
    """The bands of the figure in words, or the reason why there are none."""
    fitted = ([curve for curve in group if curve.fit.fitted] for group in groups)
    banded = [curve for group in fitted if len(group) <= MOST_BANDS for curve in group]
    if not banded:
        return f"bands of more than {MOST_BANDS} curves: see CSV"
    if not any(np.isfinite(curve.fit.band[0]).any() for curve in banded):
        return "no bands are determined"
    return f"bands: {style.percent(report.confidence)}, the choice of records"


BEYOND_COMPUTED = "grey: beyond the largest computed"


def shade_not_computed(axes: style.Axes, start: float, end: float) -> None:
    """Shade intensities at which nothing was computed, if there are any between both."""
    if start < end:
        axes.axvspan(start, end, color=style.GREY, alpha=0.15, lw=0, zorder=0)


def measure_name(intensity: Intensity) -> str:
    """The measure with its period."""
    if not needs_period(intensity.measure):
        return intensity.name
    at = "T1" if intensity.period is None else f"{intensity.period:g} s"
    return measure_label(intensity.measure, intensity.of, at)


REPORT = Report(
    FragilityOptions, fragility, results=lambda of: of.results, requires=fragility_faults
)
