"""Numbers of a study beside what was observed: outcomes, fragilities, maxima; fitted, held out."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby
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
from rpscli.sweep.statistics.grouping import (
    INTENSITY,
    Grouping,
    axis_keys,
    grouping,
    own_keys,
    shown_keys,
)
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
from rpscli.sweep.table import Array, Indices

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


class Compared(NamedTuple):
    """One quantity of one system in one part of the records.

    `chosen` are values of the keys of the fit; `points` (m,) those that did not fail, with what was
    `observed` and `computed` there.
    """

    values: tuple[object, ...]
    chosen: tuple[object, ...]
    part: str
    quantity: str
    found: Outcomes | Maxima
    points: Indices
    observed: Array
    computed: Array
    failed: int


class Candidate(NamedTuple):
    """What a choice of the fitted keys would have been worth, on the fitted records."""

    values: tuple[object, ...]
    chosen: tuple[object, ...]
    points: Indices
    worth: Worth
    taken: bool


@dataclass(frozen=True, eq=False)
class Comparison:
    """A study beside its observations: every system, or the best one of each group."""

    study: StudyResults
    options: ComparisonOptions

    @cached_property
    def observed(self) -> Observed:
        """What was observed."""
        observed = self.study.table.layout.study.observed
        assert observed is not None, "`unpaired` was asked before"
        return observed

    @cached_property
    def pairs(self) -> Pairs:
        """Points with an observation."""
        return observed_pairs(self.study.table.layout, self.observed)

    @cached_property
    def fit_keys(self) -> tuple[str, ...]:
        """Keys of the fit, as the study has them."""
        return _fit_keys(self.study.table.layout, self.observed, self.options.fit)

    @cached_property
    def systems(self) -> Grouping:
        """What is compared by itself; a fit chooses within it."""
        return grouping(self.study.table, besides=self.fit_keys)

    @cached_property
    def chosen_keys(self) -> tuple[str, ...]:
        """Keys of the fit, as tables call them."""
        return shown_keys(self.study.table.layout, self.fit_keys)

    @cached_property
    def intensity(self) -> Intensity:
        """Of every point, in the measure of the fragilities."""
        return self.study.intensity(self.options)

    @cached_property
    def baselines(self) -> list[Intensity]:
        """Measures whose thresholds are judged beside the model."""
        found = [self.study.intensity(MeasureOptions(measure=each)) for each in BASELINES]
        return found if self.intensity.measure in BASELINES else [*found, self.intensity]

    @cached_property
    def computed(self) -> Array:
        """(quantities, pairs) values, 1 for overturned, infinite maxima; NaN of failed points."""
        table = self.study.table
        fallen = np.where(table.failed, np.nan, table.overturned)
        values = [
            fallen if name == OVERTURNED else demand(table, table.columns[name])
            for name in self.observed.quantities
        ]
        return np.array(values)[:, self.pairs.points]

    @cached_property
    def parts(self) -> Mapping[str, Flags]:
        """Pairs of each part of the records; the first one is learnt from."""
        of, fit = self.study.table.layout.recordings[self.pairs.points], self.options.fit
        if fit is None:
            return {ALL: np.ones(len(of), dtype=bool)}
        records = np.unique(of)
        count = min(max(round(fit.share * len(records)), 1), len(records) - 1)
        drawn = np.random.default_rng(fit.seed).permutation(records)[:count]
        fitted = np.isin(of, drawn)
        return {FITTED: fitted, HELD_OUT: ~fitted}

    def _places(self, points: Indices, part: Flags, quantity: int) -> Indices:
        """Pairs of some points in a part, where the quantity was observed."""
        seen = np.isfinite(self.pairs.values[quantity])
        return np.flatnonzero(np.isin(self.pairs.points, points) & part & seen)

    def _learnt(self, points: Indices, quantity: int) -> Indices:
        return self._places(points, next(iter(self.parts.values())), quantity)

    @cached_property
    def candidates(self) -> list[Candidate]:
        """Every choice of every system; the one that is taken is compared."""
        found = []
        for system in self.systems.groups:
            choices = system.parts(self.fit_keys)
            worths = [self._worth(choice.every) for choice in choices]
            best = best_place(worths)
            found += [
                Candidate(system.values, choice.values, choice.every, worths[n], taken=n == best)
                for n, choice in enumerate(choices)
            ]
        return found

    def _worth(self, points: Indices) -> Worth:
        """What a fit makes small, for the first quantity of the observations."""
        places = self._learnt(points, 0)
        computed, observed = self.computed[0, places], self.pairs.values[0, places]
        known = ~np.isnan(computed)
        computed, observed = computed[known], observed[known]
        if not len(computed):
            return Worth(math.inf, math.inf, 0.0)
        if self.observed.quantities[0] == OVERTURNED:
            return outcome_worth(computed == 1.0, observed == 1.0)
        with np.errstate(divide="ignore", invalid="ignore"):
            off = np.abs(np.log(computed / observed))
        return Worth(float(fractiles(np.nan_to_num(off, nan=np.inf), [0.5])[0]), 0.0, 0.0)

    @cached_property
    def compared(self) -> list[Compared]:
        """Every quantity of every system in every part."""
        taken = [candidate for candidate in self.candidates if candidate.taken]
        return [found for candidate in taken for found in self._compared(candidate)]

    def _compared(self, best: Candidate) -> Iterator[Compared]:
        for quantity, name in enumerate(self.observed.quantities):
            for part, flags in self.parts.items():
                places = self._places(best.points, flags, quantity)
                known = places[~np.isnan(self.computed[quantity, places])]
                if not len(places):
                    continue
                points, observed = self.pairs.points[known], self.pairs.values[quantity, known]
                computed = self.computed[quantity, known]
                found = (
                    self._outcomes(points, computed == 1.0, observed == 1.0, best, quantity)
                    if name == OVERTURNED
                    else maxima(computed, observed)
                )
                failed = len(places) - len(known)
                yield Compared(
                    best.values, best.chosen, part, name, found, points, observed, computed, failed
                )

    def _outcomes(
        self, points: Indices, computed: Flags, observed: Flags, best: Candidate, quantity: int
    ) -> Outcomes:
        table, intensity = self.study.table, self.intensity.values[points]
        cluster, shaken = table.layout.clusters[points], intensity > 0.0
        grid = intensity_grid(intensity[shaken])

        def curve(beyond: Flags) -> Curve:
            data = table, points[shaken], intensity[shaken], beyond[shaken]
            return Curve(fragility_fit(*data, grid, self.options.bootstrap), binned(*data), grid)

        learnt = self._learnt(best.points, quantity)
        thresholds = []
        for measured in self.baselines:
            values = measured.values[self.pairs.points[learnt]]
            if (known := values > 0.0).any():
                overturned = self.pairs.values[quantity, learnt[known]] == 1.0
                value = threshold(values[known], overturned)
                counts = agreement(measured.values[points] >= value, observed, cluster)
                thresholds.append(Threshold(measured.name, measured.unit, value, counts))
        return Outcomes(
            agreement(computed, observed, cluster),
            tuple(thresholds),
            curve(observed),
            curve(computed),
        )

    @property
    def judged(self) -> list[Compared]:
        """What counts: what was held out, or everything if nothing was fitted."""
        return [each for each in self.compared if each.part != FITTED]

    @property
    def notes(self) -> Iterator[str]:
        """What was left out, and what the user might take the numbers for."""
        yield from (*self.pairs.notes, *self.systems.notes)
        for _, choices in groupby(self.candidates, lambda candidate: candidate.values):
            taken = [candidate.taken for candidate in choices]
            if len(taken) > 2 and (taken[0] or taken[-1]):
                yield "the fit chose a value at an end of its axis; extend the axis"
                return


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
    keys = _fit_keys(layout, observed, options.fit)
    named = [key for key in observed.keys if set(axis_keys(layout, key)) & set(keys)]
    if not keys or named:
        which = f"{listed(named, 'and')} says what was observed" if named else "no key is left"
        yield f"fit: {which}, and cannot be chosen; vary another key, and name it in fit.keys"
    elif len(np.unique(layout.recordings[observed_pairs(layout, observed).points])) < 2:
        yield "fit: fewer than two recordings are observed, and one part must be held out"


def _fit_keys(layout: StudyPoints, observed: Observed, fit: FitSection | None) -> tuple[str, ...]:
    if fit is None:
        return ()
    if fit.keys is not None:
        return tuple(fit.keys)
    return tuple(key for key in own_keys(layout) if key not in (*observed.keys, INTENSITY))
