"""All results of a study as columns, in its order: in memory, as
`points.csv`, by groups.
"""

from __future__ import annotations

import csv
import hashlib
import io
import json
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.fixed_base import reference_shears
from rpscli.analyses.result_quantities import STOREY_SHEARS, YIELDING, ResultQuantity
from rpscli.errors import RecordError
from rpscli.model.podium import PodiumStructure
from rpscli.records.ground_motion import MotionComponents
from rpscli.records.measures import MEASURES, Measure, Of, measure_label, needs_period
from rpscli.records.recordings import By
from rpscli.shown import Frozen, frozen
from rpscli.sweep.evaluation import (
    FAILED,
    MISSING,
    SCALARS,
    PointResults,
    StudyContext,
)
from rpscli.sweep.motions import RecordRequest
from rpscli.sweep.names import NONE, unit_of
from rpscli.sweep.points import StudyPoints
from rpscli.sweep.store import Store
from rpscli.units import in_si

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Columns = dict[str, NDArray[Any]]

LINES_A_PIECE = 1000
"""Of `points.csv`."""


@dataclass(frozen=True, eq=False)
class Outcomes(Frozen):
    """Outcomes and scalar results of histories, which need not be independent.

    `outcomes` are (points,) words, `columns` (points,) of each scalar result
    under its name, NaN where there is none; `clusters` are (points,) numbers
    of what is `independent`.
    """

    outcomes: NDArray[np.str_]
    columns: dict[str, Array]
    clusters: Indices
    independent: By

    def __len__(self) -> int:
        return len(self.outcomes)

    @cached_property
    def failed(self) -> NDArray[np.bool_]:
        """(points,) which have no result."""
        return frozen(np.asarray((self.outcomes == FAILED) | (self.outcomes == MISSING)))

    @cached_property
    def overturned(self) -> NDArray[np.bool_]:
        """(points,) which overturned."""
        return frozen(np.char.startswith(self.outcomes, "overturned"))


class Intensity(NamedTuple):
    """A measure of the scaled records.

    `values` are (points,), NaN where a record cannot be read; `period` is that of Sa and
    the like, None for T1 of each system; `of` says what of pairs it is, None where no
    record is measured as a pair.
    """

    measure: Measure
    unit: str
    period: float | None
    values: Array
    of: Of | None = None

    @property
    def name(self) -> str:
        """As columns call it."""
        return measure_label(self.measure, self.of)


@dataclass(frozen=True, eq=False)
class PointTable(Outcomes):
    """Outcomes of all points of a study, laid out.

    `scale` (points,) are factors on the records, NaN where one is not known; `messages`
    are reasons of failed points, by their number; `storey_shears` (points, most storeys)
    are the largest from the bottom [N], NaN above the roof.
    """

    layout: StudyPoints
    scale: Array
    messages: dict[int, str]
    storey_shears: Array

    @classmethod
    def of(
        cls, layout: StudyPoints, read: Callable[[Sequence[str]], PointResults]
    ) -> PointTable:
        """From what is read of results by their names, in the order of the study."""
        names = SCALARS[layout.plan.analysis]
        stored = read([*names, "scale", STOREY_SHEARS.name])
        unknown = np.full(len(layout), np.nan)
        most = max(properties.storeys for properties in layout.properties)
        shears = np.full((len(layout), most), np.nan)
        if (known := stored.columns.get(STOREY_SHEARS.name)) is not None:
            shears[:, : known.shape[1]] = known
        return cls(
            outcomes=stored.outcomes,
            columns={name: stored.columns.get(name, unknown) for name in names},
            clusters=layout.clusters,
            independent=layout.independent,
            layout=layout,
            scale=stored.columns.get("scale", unknown),
            messages={
                row: text or "no reason was given"
                for row, text in stored.messages.items()
            },
            storey_shears=shears,
        )

    @property
    def factors(self) -> Array | None:
        """(points,) on the records, known before unless a measure
        decides; None without records.
        """
        if self.layout.plan.analysis != "timehistory":
            return None
        return self.layout.factors if self.layout.plan.measure is None else self.scale

    def intensity(
        self,
        measure: Measure | None = None,
        period: float | None = None,
        damping: float = 0.05,
    ) -> Intensity:
        """A measure of the ground motion at every point, T1 of each
        system unless at a period.

        By default it is the one that the study scales to, else PGV.
        """
        layout = self.layout
        scaled = self.layout.plan.measure
        context = self.layout.context
        if measure is None and scaled is not None:
            measure = scaled.measure
            period = scaled.period
            damping = scaled.damping
        measure = measure or "PGV"
        same = scaled and (scaled.measure, scaled.period, scaled.damping)
        values = np.full(len(self), np.nan)
        for point in layout:
            assert point.record is not None, "points of histories have a record"
            if same == (measure, period, damping):
                # Not by way of the factor, whose rounding would blur equal intensities.
                unscaled = point.scale
                factor = point.scale_change
            else:
                own = period or layout.properties[point.system].period
                what = measure, own if needs_period(measure) else None, damping
                factor = float(self.scale[point.number])
                try:
                    unscaled = context.records.intensity(
                        point.record, *what, layout.plan.of
                    )
                except RecordError:
                    continue
            values[point.number] = unscaled * abs(factor) ** MEASURES[measure].power
        return Intensity(measure, MEASURES[measure].unit, period, values, layout.of)


class Group(NamedTuple):
    """Points that have the same values at some keys."""

    values: tuple[object, ...]
    points: Indices


def groups(
    layout: StudyPoints, keys: Sequence[str], within: Indices | None = None
) -> list[Group]:
    """All points, or some, grouped by the values of keys, in the order
    in which these are named.
    """
    numbers = np.arange(len(layout)) if within is None else within
    axes = layout.study.axes
    known: dict[str, tuple[int, Sequence[object]]] = {
        key: (number, [row[place] for row in axis.rows])
        for number, axis in enumerate(axes)
        for place, key in enumerate(axis.keys)
    }
    known["record"] = (
        len(axes) + 1,
        [record and record.source for record in layout.records],
    )
    known["scale"] = len(axes) + 2, layout.scales
    asked = [known[key] for key in keys]
    chosen = [*dict.fromkeys(axis for axis, _ in asked)]
    if not chosen:
        return [Group((), numbers)]
    places = np.unravel_index(numbers, layout.shape)
    lengths = [layout.shape[axis] for axis in chosen]
    codes = np.ravel_multi_index([places[axis] for axis in chosen], lengths)
    order = np.argsort(codes, kind="stable")
    parts = np.split(order, np.flatnonzero(np.diff(codes[order])) + 1)
    return [
        Group(
            tuple(values[places[axis][part[0]]] for axis, values in asked), numbers[part]
        )
        for part in parts
        if len(part)
    ]


def leading_keys(layout: StudyPoints) -> tuple[str, ...]:
    """The first key of each varied axis: what tells systems apart, sample aside."""
    return tuple(axis.keys[0] for axis in layout.study.axes)


def _shown_results(layout: StudyPoints) -> dict[str, ResultQuantity]:
    """Scalar results by their paths, those of yielding only where a system yields."""
    elastic = all("ductility" in properties.lacking for properties in layout.properties)
    every = SCALARS[layout.plan.analysis].items()
    return {
        path: quantity
        for path, quantity in every
        if not (elastic and quantity in YIELDING)
    }


def units_of_columns(layout: StudyPoints) -> dict[str, str]:
    """Units of all columns by name."""
    names = {name: unit_of(name) for name in layout.identifying}
    scale = {"scale": "-"} if layout.plan.analysis == "timehistory" else {}
    results = {path: quantity.unit for path, quantity in _shown_results(layout).items()}
    return {**names, **scale, "outcome": "-", **results}


def points_csv(table: PointTable) -> Iterator[str]:
    """The text of `points.csv`, in pieces: one line a point, the same bytes on every run.

    Numbers have all their digits; what does not exist is empty.
    """
    layout = table.layout
    scales = table.factors
    units = units_of_columns(table.layout)
    known = [
        (layout.places[of], [_cell(value, units[name]) for value in values])
        for name, (of, values) in layout.identifying.items()
    ]
    results = [
        (table.columns[name], q.whole) for name, q in _shown_results(layout).items()
    ]
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(f"{name} [{unit}]" for name, unit in units.items())
    for first in range(0, len(table), LINES_A_PIECE):
        piece = slice(first, first + LINES_A_PIECE)
        columns = [[cells[i] for i in places[piece].tolist()] for places, cells in known]
        columns += [] if scales is None else [_numbers(scales[piece])]
        columns.append(table.outcomes[piece].tolist())
        columns += [_numbers(column[piece], whole=whole) for column, whole in results]
        writer.writerows(zip(*columns, strict=True))
        yield buffer.getvalue()
        buffer.seek(0)
        buffer.truncate()


def _numbers(values: Array, *, whole: bool = False) -> list[str]:
    text = (lambda value: str(int(value))) if whole else repr
    finite = np.isfinite(values).tolist()
    return [
        text(v) if known else "" for v, known in zip(values.tolist(), finite, strict=True)
    ]


def _cell(value: object, unit: str) -> str:
    """A value in the unit of its column; lists and mappings as JSON."""
    value = in_si(value, unit)
    if isinstance(value, str):
        return value
    return NONE if value is None else json.dumps(value)


def point_columns(table: PointTable) -> Columns:
    """(points,) of each column of `points.csv` by name: SI numbers,
    NaN for none, else objects.
    """
    layout = table.layout
    units = units_of_columns(table.layout)
    columns = {
        name: array([in_si(value, units[name]) for value in values])[layout.places[of]]
        for name, (of, values) in layout.identifying.items()
    }
    if (scales := table.factors) is not None:
        columns["scale"] = scales
    found = {name: of for name, of in table.columns.items() if name in units}
    return {**columns, "outcome": table.outcomes, **found}


def array(values: Iterable[Any]) -> NDArray[Any]:
    """Numbers if all of them are, with NaN for None; else objects."""
    kept = list(values)
    numbers = [
        np.nan if value is None else np.inf if value == "inf" else value for value in kept
    ]
    if all(isinstance(value, int | float) for value in numbers):
        return np.array(numbers)
    objects = np.empty(len(kept), dtype=object)
    objects[:] = kept
    return objects


FixedBaseReferences = dict[tuple[int, RecordRequest], Array]
"""Largest storey shears (n,) [N] of a system on a fixed base,
under an unscaled record."""


def fixed_base_references(
    layout: StudyPoints, store: Store, jobs: int
) -> FixedBaseReferences:
    """Those of all systems with a building; what is not in the
    store is computed and stored.

    The response is linear: one run at scale 1 serves every scale, and systems that differ
    in their bearings alone share it.
    """
    known = store.fixed_base()
    records = layout.context.records
    found: dict[tuple[int, RecordRequest], bytes] = {}
    runs: dict[bytes, tuple[PodiumStructure, MotionComponents]] = {}
    structures: dict[
        bytes, PodiumStructure
    ] = {}  # buildings of many systems are the same
    for system, properties in enumerate(layout.properties):
        building = properties.building
        for request in dict.fromkeys(
            r or properties.record for r in layout.records * bool(building)
        ):
            assert request is not None, "points of histories have a record"
            what = layout.plan.solver.encode(), building, records.digest(request)
            key = hashlib.sha256(b"".join(what)).digest()
            try:
                if key not in known and key not in runs:
                    motion = records.motion(request)
                    if building not in structures:
                        structures[building] = layout.system(system).structure
                    runs[key] = structures[building], motion
            except RecordError:
                continue
            found[system, request] = key
    with ThreadPoolExecutor(jobs) as pool:
        shears = pool.map(lambda run: reference_shears(*run), runs.values())
        new = dict(zip(runs, shears, strict=True))
    if new:
        store.add_fixed_base(new)
    known |= new
    return {place: known[key] for place, key in found.items()}


@dataclass(frozen=True, eq=False)
class StoredPoints:
    """Points of a study as a table, and the ways to what the store has besides."""

    table: PointTable
    keys: list[bytes]
    store: Store
    jobs: int

    @property
    def context(self) -> StudyContext:
        """Systems and motions of the study."""
        return self.table.layout.context

    def stored(self, names: Iterable[str]) -> PointResults:
        """Stored results of each point by name; elements of lists by their index."""
        with self.store:
            return self.store.results(self.keys, names)

    @cached_property
    def fixed_base(self) -> FixedBaseReferences:
        """Storey shears on a fixed base; computed if they are not stored."""
        with self.store:
            return fixed_base_references(self.table.layout, self.store, self.jobs)

    def floor_spectra(self, number: int, damping: float) -> Array:
        """(2, 2, n, p): isolated and fixed base; pseudo-acceleration and displacement."""
        # Samples are not stored, so that the history is run once more.
        from rpscli.analyses import floor_spectra as spectra
        from rpscli.analyses.timehistory import time_history

        layout = self.table.layout
        given = layout.context.history(layout[number])
        result = time_history(
            given.structure, given.motion.scaled(given.scale), given.settings
        )
        fixed = spectra.fixed_base_floor_spectra(result, damping=damping)
        assert fixed is not None, "every system has a building"
        both = spectra.isolated_floor_spectra(result, damping=damping), fixed
        return np.array([(each.pseudo_acceleration, each.displacement) for each in both])
