"""Numbers of a study beside what was observed: outcomes, fragilities, maxima; fitted, held out."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, NamedTuple

import numpy as np
from pydantic import Field

from rpscli.case.schema.fields import Quantity, Section
from rpscli.case.study.axes import Axis
from rpscli.case.study.observed import OVERTURNED, Observed
from rpscli.case.study.reports import ReportRequest
from rpscli.case.study.schema import Keys, Seed
from rpscli.case.text.document import Document, Fault, dotted
from rpscli.errors import listed
from rpscli.records.measures import Measure
from rpscli.report.study.fragility import (
    BandOptions,
    MeasureOptions,
    binned,
    fragility_fit,
    intensity_grid,
    measure_without_period,
)
from rpscli.report.study.fragility import Observed as Binned
from rpscli.sweep.fits.lognormal import Lognormal
from rpscli.sweep.intensities import Intensity
from rpscli.sweep.points.layout import StudyPoints
from rpscli.sweep.statistics.fractiles import demand, fractiles
from rpscli.sweep.statistics.grouping import axis_keys, pooled, pooling_notes, shown_keys
from rpscli.sweep.statistics.observations import (
    Agreement,
    Flags,
    Maxima,
    Pairs,
    Worth,
    agreement,
    best_place,
    maxima,
    observed_pairs,
    outcome_worth,
    threshold,
    unpaired,
)
from rpscli.sweep.study_results import StudyResults
from rpscli.sweep.table import Array, Group, Indices, Table, groups, leading_keys

BASELINES: tuple[Measure, ...] = ("PGA", "PGV")
"""Measures whose thresholds a model has to beat."""

FITTED, HELD_OUT, ALL = "fitted", "held out", "all"


class FitSection(Section):
    """Choose values of varied keys on a share of the records; the rest is held out."""

    keys: Keys | None = None
    """varied keys to be chosen; all but those of the observations"""
    share: Annotated[float, Quantity(above=0, below=1)] = 0.5
    """share of the recordings that they are chosen on"""
    seed: Seed = Field(1, description="of the draw of these records")


class ComparisonOptions(BandOptions):
    """Outcomes and maxima beside those that were observed."""

    fit: FitSection | None = Field(None, description="choose a parameter, judge it on the rest")


class Threshold(NamedTuple):
    """A measure beyond which everything is taken to overturn, chosen as the parameter is."""

    measure: str
    unit: str
    value: float
    agreement: Agreement


class Curve(NamedTuple):
    """A fragility with the data that it goes through."""

    fit: Lognormal
    binned: Binned
    grid: Array


class Outcomes(NamedTuple):
    """Overturning in one part of the records; None where nothing could be counted."""

    agreement: Agreement
    thresholds: tuple[Threshold, ...]
    observed: Curve
    computed: Curve


@dataclass(frozen=True, eq=False)
class Compared:
    """One quantity of one system in one part of the records.

    `chosen` are values of the keys of the fit; `pairs` are places in the pairs of the report.
    """

    values: tuple[object, ...]
    chosen: tuple[object, ...]
    part: str
    quantity: str
    found: Outcomes | Maxima
    pairs: Indices
    failed: int


class Candidate(NamedTuple):
    """What a choice of the fitted keys would have been worth, on the fitted records."""

    values: tuple[object, ...]
    chosen: tuple[object, ...]
    worth: Worth
    taken: bool


@dataclass(frozen=True, eq=False)
class ComparisonReport:
    """All of it.

    `computed` (quantities, pairs) is 1 for overturned, and infinite for maxima of overturned
    histories.
    """

    table: Table
    intensity: Intensity
    confidence: float
    system_keys: tuple[str, ...]
    fit_keys: tuple[str, ...]
    quantities: tuple[str, ...]
    pairs: Pairs
    computed: Array
    compared: tuple[Compared, ...]
    candidates: tuple[Candidate, ...]
    pooling: tuple[str, ...]

    @property
    def judged(self) -> list[Compared]:
        """What counts: what was held out, or everything if nothing was fitted."""
        return [each for each in self.compared if each.part != FITTED]

    @property
    def notes(self) -> Iterator[str]:
        """What was left out, and what the user might take the numbers for."""
        yield from (*self.pairs.notes, *self.pooling)
        ends: dict[tuple[object, ...], list[bool]] = {}
        for each in self.candidates:
            ends.setdefault(each.values, []).append(each.taken)
        if any(len(taken) > 2 and (taken[0] or taken[-1]) for taken in ends.values()):
            yield "the fit chose a value at an end of its axis; extend the axis"


def comparison_report(study: StudyResults, options: ComparisonOptions) -> ComparisonReport:
    """Compare every system, or the best one of each group, with its observations."""
    table, layout = study.table, study.table.layout
    observed = layout.study.observed
    assert observed is not None, "`unpaired` was asked before"
    pairs = observed_pairs(layout, observed)
    fit_keys = _fit_keys(_leading(layout), observed, options.fit)
    system_keys = tuple(key for key in _leading(layout) if not _same_axis(layout, key, fit_keys))
    measured = study.intensity(options)
    baselines = [study.intensity(MeasureOptions(measure=measure)) for measure in BASELINES]
    if measured.measure not in BASELINES:
        baselines.append(measured)
    work = _Work(table, options, measured, baselines, observed.quantities, pairs)
    compared: list[Compared] = []
    candidates: list[Candidate] = []
    for system in groups(layout, system_keys):
        best = Group((), system.points)
        if options.fit is not None:
            rows = [
                Candidate(system.values, group.values, work.worth(group.points), taken=False)
                for group in groups(layout, fit_keys, system.points)
            ]
            place = best_place([row.worth for row in rows])
            candidates += [row._replace(taken=n == place) for n, row in enumerate(rows)]
            best = groups(layout, fit_keys, system.points)[place]
        compared += work.compared(system.values, best)
    return ComparisonReport(
        table=table,
        intensity=measured,
        confidence=options.confidence,
        system_keys=shown_keys(layout, system_keys),
        fit_keys=shown_keys(layout, fit_keys),
        quantities=observed.quantities,
        pairs=pairs,
        computed=work.computed,
        compared=tuple(compared),
        candidates=tuple(candidates),
        pooling=pooling_notes(pooled(layout, (*system_keys, *fit_keys, "scale"))),
    )


def fit_faults(_: Document, axes: Sequence[Axis], request: ReportRequest) -> Iterator[Fault]:
    """Keys of the fit that do not vary, and a fit with nothing to choose."""
    options = request.options
    assert isinstance(options, ComparisonOptions)
    known = [key for axis in axes for key in axis.keys]
    path = (*request.path, request.kind, "fit")
    if options.fit is None:
        return
    if not known:
        yield Fault(path, f"{dotted(path)} needs keys under `vary` to choose from; add them")
    for key in options.fit.keys or ():
        if known and key not in known:
            text = f"{dotted(path)}.keys: {key} does not vary in this study; use {listed(known)}"
            yield Fault(path, text)


def uncomparable(layout: StudyPoints, options: ComparisonOptions) -> Iterator[str]:
    """What keeps a study from this report."""
    yield from unpaired(layout)
    yield from measure_without_period(layout, options)
    observed = layout.study.observed
    if options.fit is None or observed is None:
        return
    keys = _fit_keys(_leading(layout), observed, options.fit)
    named = [key for key in observed.keys if _same_axis(layout, key, keys)]
    if not keys or named:
        which = f"{listed(named, 'and')} tells what was observed" if named else "no key is left"
        yield f"fit: {which}, and cannot be chosen; vary another key, and name it in fit.keys"
    elif len(np.unique(layout.recordings[observed_pairs(layout, observed).points])) < 2:
        yield "fit: less than two recordings are observed, and one part must be held out"


def _leading(layout: StudyPoints) -> tuple[str, ...]:
    """What tells systems apart: the first key of every axis, and the scale."""
    return (*leading_keys(layout), "scale") if len(layout.scales) > 1 else leading_keys(layout)


def _fit_keys(
    leading: Sequence[str], observed: Observed, fit: FitSection | None
) -> tuple[str, ...]:
    if fit is None:
        return ()
    if fit.keys is not None:
        return tuple(fit.keys)
    return tuple(key for key in leading if key not in (*observed.keys, "scale"))


def _same_axis(layout: StudyPoints, key: str, keys: Iterable[str]) -> bool:
    """Whether a key belongs to the axis of one of others."""
    return bool(set(axis_keys(layout, key)) & set(keys))


@dataclass(frozen=True, eq=False)
class _Work:
    """What all comparisons of a report share."""

    _table: Table
    _options: ComparisonOptions
    _measured: Intensity
    _baselines: Sequence[Intensity]
    _quantities: Sequence[str]
    _pairs: Pairs

    @cached_property
    def computed(self) -> Array:
        """(quantities, pairs) computed values; NaN of failed points."""
        table = self._table
        fallen = np.where(table.failed, np.nan, table.overturned)
        values = [
            fallen if name == OVERTURNED else demand(table, table.columns[name])
            for name in self._quantities
        ]
        return np.array(values)[:, self._pairs.points]

    @cached_property
    def _parts(self) -> Mapping[str, Flags]:
        """Pairs of each part of the records."""
        clusters = self._table.layout.recordings[self._pairs.points]
        records, fit = np.unique(clusters), self._options.fit
        if fit is None:
            return {ALL: np.ones(len(self._pairs.points), dtype=bool)}
        count = min(max(round(fit.share * len(records)), 1), len(records) - 1)
        drawn = np.random.default_rng(fit.seed).permutation(records)[:count]
        fitted = np.isin(clusters, drawn)
        return {FITTED: fitted, HELD_OUT: ~fitted}

    def _chosen(self, points: Indices, part: str, quantity: int) -> Indices:
        """Places of the pairs of some points in a part, where the quantity was observed."""
        seen = np.isfinite(self._pairs.values[quantity])
        return np.flatnonzero(np.isin(self._pairs.points, points) & self._parts[part] & seen)

    def worth(self, points: Indices) -> Worth:
        """What a fit makes small, for the first quantity of the observations."""
        places = self._chosen(points, FITTED, 0)
        computed, observed = self.computed[0][places], self._pairs.values[0][places]
        known = ~np.isnan(computed)
        computed, observed = computed[known], observed[known]
        if not len(computed):
            return Worth(math.inf, math.inf, 0.0)
        if self._quantities[0] == OVERTURNED:
            return outcome_worth(computed == 1.0, observed == 1.0)
        with np.errstate(divide="ignore", invalid="ignore"):
            off = np.abs(np.log(computed / observed))
        return Worth(float(fractiles(np.nan_to_num(off, nan=np.inf), [0.5])[0]), 0.0, 0.0)

    def compared(self, values: tuple[object, ...], best: Group) -> Iterator[Compared]:
        """Every quantity in every part."""
        for quantity, name in enumerate(self._quantities):
            for part in self._parts:
                places = self._chosen(best.points, part, quantity)
                known = places[~np.isnan(self.computed[quantity][places])]
                if not len(places):
                    continue
                found = (
                    self._outcomes(best.points, known, quantity)
                    if name == OVERTURNED
                    else maxima(self.computed[quantity, known], self._pairs.values[quantity, known])
                )
                failed = len(places) - len(known)
                yield Compared(values, best.values, part, name, found, known, failed)

    def _outcomes(self, points: Indices, places: Indices, quantity: int) -> Outcomes:
        computed = self.computed[quantity] == 1.0
        observed = self._pairs.values[quantity] == 1.0
        learnt = self._chosen(points, next(iter(self._parts)), quantity)
        intensity = self._measured.values[self._pairs.points]
        cluster = self._table.layout.clusters[self._pairs.points]
        shaken = places[intensity[places] > 0.0]
        grid = intensity_grid(intensity[shaken])
        return Outcomes(
            agreement=agreement(computed[places], observed[places], cluster[places]),
            thresholds=tuple(self._thresholds(observed, learnt, places)),
            observed=self._curve(shaken, observed, intensity, grid),
            computed=self._curve(shaken, computed, intensity, grid),
        )

    def _curve(self, places: Indices, beyond: Flags, intensity: Array, grid: Array) -> Curve:
        data = self._table, self._pairs.points[places], intensity[places], beyond[places]
        return Curve(fragility_fit(*data, grid, self._options.bootstrap), binned(*data), grid)

    def _thresholds(self, observed: Flags, learnt: Indices, judged: Indices) -> Iterator[Threshold]:
        """Thresholds chosen on one part of the records and judged on another."""
        for measured in self._baselines:
            intensity = measured.values[self._pairs.points]
            known = learnt[intensity[learnt] > 0.0]
            if len(known):
                value = threshold(intensity[known], observed[known])
                beyond = intensity[judged] >= value
                cluster = self._table.layout.clusters[self._pairs.points[judged]]
                counts = agreement(beyond, observed[judged], cluster)
                yield Threshold(measured.measure, measured.unit, value, counts)
