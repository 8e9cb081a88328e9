"""Fragility: probability of exceeding a limit state against the intensity of the motion."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, StrictBool, create_model

from rpscli.analyses.result_quantities import LIMITED
from rpscli.case.conditions import LIMITS
from rpscli.case.schema.fields import Quantity, Section, Whole
from rpscli.case.schema.limits import described
from rpscli.case.study.schema import Keys, PositiveNumbers, Seed
from rpscli.sweep.fits.lognormal import Bootstrap, Lognormal, lognormal_fit
from rpscli.sweep.intensities import Intensity, MeasureOptions
from rpscli.sweep.statistics.grouping import INTENSITY, pooled, pooling_note, shown_keys
from rpscli.sweep.statistics.observations import record_of
from rpscli.sweep.statistics.verdicts import exceeds
from rpscli.sweep.table import Array, Indices, Table, groups, leading_keys

CURVE_POINTS = 101
MOST_BINS = 10


_THRESHOLDS: Any = {
    quantity.name: (PositiveNumbers | None, Field(None, description=described(quantity)))
    for quantity in LIMITED
}


class LimitStates(create_model("LimitStates", __base__=Section, **_THRESHOLDS)):  # type: ignore[misc]
    """Limit states of a fragility; overturning exceeds every one of them."""

    overturning: StrictBool = Field(
        default=True, description="whether overturning is a limit state itself"
    )


class BandOptions(MeasureOptions):
    """Options of reports whose curves have bands."""

    resamples: Annotated[int, Whole(0, 10_000)] = Field(
        200, description="bootstrap samples of the records for the bands; 0 = none"
    )
    confidence: Annotated[float, Quantity(above=0, below=1)] = Field(
        0.9, description="probability inside the bands"
    )
    seed: Seed = Field(1, description="of the bootstrap")

    @property
    def bootstrap(self) -> Bootstrap:
        """How the bands are had."""
        return Bootstrap(self.resamples, self.confidence, self.seed)


class FragilityOptions(BandOptions):
    """Probability of exceeding a limit state against an intensity measure."""

    limits: LimitStates = Field(LimitStates(), description="limit states")
    series: Keys | None = Field(None, description="varied keys, one curve for each value")


class LimitState(NamedTuple):
    """Exceeded where a result is beyond a threshold; every overturned point exceeds it."""

    result: str
    threshold: float | None

    @property
    def label(self) -> str:
        """The state in words.

        >>> LimitState("rotation_ratio", 0.5).label, LimitState("min_column_force", 1e5).label
        ('rotation_ratio > 0.5', 'min_column_force < 100000')
        """
        if self.threshold is None:
            return self.result
        sign = "<" if LIMITS[self.result].from_below else ">"
        return f"{self.result} {sign} {self.threshold:g}"


class Observed(NamedTuple):
    """Share of the points that exceed the limit within a bin of intensities, each (bins,)."""

    intensity: Array
    share: Array
    points: NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Fragility:
    """Data and fit of one limit state of one group of systems; `failed` points are left out.

    `overturned` of the points that exceed the limit do so because they overturned.
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

    @property
    def fitted(self) -> bool:
        """Whether there is a curve."""
        return self.fit.method != "none"


@dataclass(frozen=True)
class FragilityReport:
    """All curves."""

    intensity: Intensity
    confidence: float
    series_keys: tuple[str, ...]
    limits: tuple[LimitState, ...]
    curves: tuple[Fragility, ...]
    pooled: tuple[str, ...]
    pooling: tuple[str, ...]

    def fitted(self, limit: LimitState) -> list[Fragility]:
        """The curves of a limit state that could be fitted."""
        return [curve for curve in self.curves if curve.limit == limit and curve.fitted]

    @property
    def notes(self) -> list[str]:
        """What is pooled, what overturning does to limits, and what keeps fits from being plain."""
        return [*self.pooling, *self._overturning] + [
            f"{self.named(curve)}: {curve.fit.note}" for curve in self.curves if curve.fit.note
        ]

    def named(self, curve: Fragility) -> str:
        """A curve's limit state with the values of its systems."""
        keys = zip(self.series_keys, curve.values, strict=True)
        return curve.limit.label + "".join(f", {key} = {value}" for key, value in keys)

    @property
    def _overturning(self) -> list[str]:
        """Limits that are exceeded by overturned histories, whatever their demands were."""
        limited = [curve for curve in self.curves if curve.limit.threshold is not None]
        fallen = sum(curve.overturned for curve in limited)
        if not fallen:
            return []
        exceeded = sum(curve.exceeded for curve in limited)
        counts = f"{fallen} of {exceeded} histories beyond a limit"
        return [f"an overturned history exceeds every limit: {counts} overturned"]


def fragility_report(
    table: Table, measured: Intensity, options: FragilityOptions
) -> FragilityReport:
    """Fit every limit state of every group of systems; samples and records are pooled."""
    keys = options.series if options.series is not None else leading_keys(table.layout)
    limits = tuple(limit_states(options))
    systems = groups(table.layout, keys)
    curves = (
        _fragility(table, measured, options, group.values, group.points, limit)
        for limit in limits
        for group in systems
    )
    apart_by = (*keys, INTENSITY)
    return FragilityReport(
        intensity=measured,
        confidence=options.confidence,
        series_keys=shown_keys(table.layout, keys),
        limits=limits,
        curves=tuple(curves),
        pooled=pooled(table.layout, apart_by),
        pooling=tuple(pooling_note(table.layout, apart_by)),
    )


def limit_states(options: FragilityOptions) -> Iterator[LimitState]:
    """The limit states that a study asks for."""
    limits = options.limits
    for quantity in LIMITED:
        for threshold in getattr(limits, quantity.name) or ():
            yield LimitState(quantity.name, threshold)
    if limits.overturning:
        yield LimitState("overturning", None)


def _fragility(
    table: Table,
    measured: Intensity,
    options: FragilityOptions,
    values: tuple[object, ...],
    points: Indices,
    limit: LimitState,
) -> Fragility:
    kept = points[~table.failed[points] & (measured.values[points] > 0.0)]
    intensity, beyond = (
        measured.values[kept],
        exceeds(table, limit.result, limit.threshold or 0.0)[kept],
    )
    grid = intensity_grid(intensity)
    return Fragility(
        values=values,
        limit=limit,
        fit=fragility_fit(table, kept, intensity, beyond, grid, options.bootstrap),
        grid=grid,
        observed=binned(intensity, beyond),
        counted=len(kept),
        exceeded=int(beyond.sum()),
        overturned=int(table.overturned[kept].sum()),
        failed=len(points) - len(kept),
    )


def fragility_fit(
    table: Table,
    points: Indices,
    intensity: Array,
    beyond: NDArray[np.bool_],
    grid: Array,
    bootstrap: Bootstrap,
) -> Lognormal:
    """Fit a curve through what became of some points of a study.

    Parameters
    ----------
    points, intensity, beyond
        (points,) numbers of the points, intensities of their motions, and outcomes.
    grid
        Intensities at which the curve is wanted.
    bootstrap
        How the bands are had.
    """
    cluster, weight = _cluster(table, points), _weight(table, points)
    return lognormal_fit(intensity, beyond, cluster, weight, grid, bootstrap)


def _cluster(table: Table, points: Indices) -> Indices:
    """What hangs together: points of one record; each point alone if there is one record only."""
    if len(table.layout.records) == 1:
        return points
    return record_of(table.layout, points)


def _weight(table: Table, points: Indices) -> float:
    """Motions over points: samples and members of an ensemble share a motion."""
    layout = table.layout
    shaken = points % layout.points_of_system // len(layout.members)
    return len(np.unique(shaken)) / max(len(points), 1)


def intensity_grid(intensities: Array) -> Array:
    """Intensities at which curves are drawn: some way beyond the data on both sides."""
    if not len(intensities):
        return np.ones(CURVE_POINTS)
    return np.geomspace(intensities.min() / 1.5, intensities.max() * 1.5, CURVE_POINTS)


def binned(intensity: Array, beyond: NDArray[np.bool_]) -> Observed:
    """Shares at each intensity, or in bins of equal numbers of points if there are too many."""
    levels, place = np.unique(intensity, return_inverse=True)
    if len(levels) > 2 * MOST_BINS:
        order = np.argsort(np.argsort(intensity, kind="stable"), kind="stable")
        place = order * MOST_BINS // len(intensity)
        levels = np.exp([np.log(intensity[place == i]).mean() for i in range(MOST_BINS)])
    points = np.bincount(place, minlength=len(levels))
    return Observed(levels, np.bincount(place, beyond, minlength=len(levels)) / points, points)
