"""Outcomes and demands of each system at each intensity."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rpscli.analyses.column_forces import OF_COLUMNS
from rpscli.analyses.demand import demands
from rpscli.analyses.largest_demands import Demand
from rpscli.analyses.neighbours import FINER
from rpscli.analyses.result_quantities import LIMITED, ResultQuantity
from rpscli.records.ground_motion import LEAST, MOST
from rpscli.records.measures import measure_label
from rpscli.records.recordings import clusters
from rpscli.sweep.statistics.fractiles import Spread, demand, spread
from rpscli.sweep.statistics.grouping import Histories, grouping
from rpscli.sweep.table import Array, FixedBaseReferences, Outcomes, PointTable

REDUCTION = next(quantity for quantity in LIMITED if quantity.name == "fixed_base_ratio")


@dataclass(frozen=True, eq=False)
class SummaryRow(Histories):
    """Histories of one system at one intensity, and their demands."""

    spreads: tuple[Spread, ...]


@dataclass(frozen=True, eq=False)
class Summary:
    """All rows; `pooled` says what differs within a row besides the
    record, `notes` warn of it. `systems` are the names of those of the rows.
    """

    keys: tuple[str, ...]
    pooled: tuple[str, ...]
    notes: tuple[str, ...]
    quantities: tuple[ResultQuantity, ...]
    rows: tuple[SummaryRow, ...]
    systems: tuple[str, ...] = ()


class Records(Outcomes):
    """Histories of one structure, a point each; what is
    independent are their recordings.
    """

    @classmethod
    def of(
        cls,
        outcomes: Sequence[str],
        demands: Sequence[Mapping[str, float]],
        sources: Sequence[str],
    ) -> Records:
        """From the outcome, the demands and the record of each history."""
        columns = {
            name: np.array([each[name] for each in demands]) for name in demands[0]
        }
        return cls(np.array(outcomes), columns, np.array(clusters(sources)), "recordings")


def summary(table: PointTable, fixed: FixedBaseReferences) -> Summary:
    """Of histories of a study, with storey shears on a fixed base as a reference."""
    found = grouping(table)
    known = _demands(table, {REDUCTION: shear_over_fixed_base(table, fixed)})
    for quantity, values in known.items():
        # What overturned exceeds any demand, but not one that its system cannot have.
        lacks = np.array(
            [
                system.storeys == 0
                if quantity is REDUCTION
                else quantity.name in system.lacking
                for system in table.layout.properties
            ]
        )
        known_of = np.isfinite(values).reshape(len(lacks), -1).any(axis=1)
        if quantity.name in OF_COLUMNS and not lacks.all():
            known_of = np.zeros_like(lacks)  # a mean of columns beside forces of one
        values[np.repeat(lacks & ~known_of, table.layout.points_of_system)] = np.nan
    rows = (_row(known, each) for each in found.groups)
    notes = [*found.notes, *_still_moving(table)]
    if any(table.layout.pairs) and not all(table.layout.pairs):
        notes.append("histories of one component and of pairs are counted together")
    if any("ductility" not in system.lacking for system in table.layout.properties):
        notes.append(
            "on the fixed base every building is elastic, also where its storeys yield"
        )
    layout = table.layout
    systems = tuple(layout.system_name(group.every[0]) for group in found.groups)
    return Summary(
        found.keys, found.pooled, tuple(notes), tuple(known), tuple(rows), systems
    )


def summary_of_records(records: Records) -> Summary:
    """One row."""
    known = _demands(records, {})
    row = _row(known, Histories(records, (), np.arange(len(records))))
    return Summary((), (), (), tuple(known), (row,))


def _demands(
    table: Outcomes, others: dict[ResultQuantity, Array]
) -> dict[ResultQuantity, Array]:
    """(points,) demands of all quantities that there are, some of them from elsewhere."""
    columns = {quantity: table.columns[quantity.name] for quantity in LIMITED} | others
    return {
        quantity: demand(table, values, from_below=quantity.from_below)
        for quantity, values in columns.items()
        if not np.isnan(values).all()
    }


def _row(demands: dict[ResultQuantity, Array], of: Histories) -> SummaryRow:
    known = (
        (column[of.points], quantity.from_below) for quantity, column in demands.items()
    )
    spreads = tuple(spread(values, from_below=below) for values, below in known)
    return SummaryRow(of.table, of.values, of.every, spreads)


def shear_over_fixed_base(table: PointTable, fixed: FixedBaseReferences) -> Array:
    """(points,) base shear over that of the same building on a
    fixed base; NaN without one.
    """
    layout = table.layout
    within = layout.points_of_system // len(layout.records)
    reference = np.full(len(layout), np.nan)
    for system, properties in enumerate(layout.properties):
        for place, record in enumerate(layout.records):
            request = record or properties.record
            if request is not None and (system, request) in fixed:
                first = system * layout.points_of_system + place * within
                reference[first : first + within] = fixed[system, request][0]
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(
            table.columns["max_base_shear"] / (np.abs(table.scale) * reference)
        )


MOVING = 0.01
"""Of its largest rotation: what survives and is tilted by more at its end still moves."""


def _still_moving(table: PointTable) -> Iterator[str]:
    """The remark on residual rotations that are those of an instant."""
    at_end = table.columns["residual_rotation"]
    largest = table.columns["max_rotation"]
    survived = table.outcomes == "survived"
    if number := np.count_nonzero(survived & (at_end > MOVING * largest)):
        yield (
            f"{number} of {np.count_nonzero(survived)} histories that survived still move"
            " at their end: their residual rotations and displacements are those of that"
            " instant; a longer `analysis.free_vibration` or something that dissipates"
            " brings them to rest"
        )


def scale_notes(table: PointTable) -> Iterator[str]:
    """Remarks on single records that are scaled like pairs, and on
    factors that are unusual.
    """
    layout = table.layout
    alone = [record.source for record in layout.records if record and record.pair is None]
    if layout.plan.measure is not None and layout.of is not None and alone:
        name = measure_label(layout.plan.measure.measure, layout.of)
        yield (
            f"{name} is that of pairs; {len(alone)} of {len(layout.records)} records"
            f" stand alone, {alone[0]} for one, and are scaled to it by themselves"
        )
    of, sources = layout.identifying["record"]
    pulses = np.array([source.startswith("pulse:") for source in sources])[
        layout.places[of]
    ]
    scale = np.abs(table.scale if table.factors is None else table.factors)
    unusual = ((scale < LEAST) | (scale > MOST)) & ~pulses
    if unusual.any():
        distance = np.abs(np.log(np.where(unusual, np.maximum(scale, 1e-300), 1.0)))
        farthest = int(np.argmax(distance))
        record = table.layout[farthest].record
        assert record is not None, "points of histories have a record"
        yield (
            f"{np.count_nonzero(unusual)} of {len(table)} points scale their record"
            f" beyond the usual {LEAST:g} to {MOST:g}, {record.source} by"
            f" {scale[farthest]:.4g}"
        )


COMPUTED_AGAIN = 64
"""Points that are computed again."""

PROMISED = 1e-4
"""Of the largest rotation and base shear, and of what has a limit: what steps keep where
motions converge."""

MAIN = ("max_rotation", "max_base_shear")

NAMED = 5


def step_notes(table: PointTable) -> Iterator[str]:
    """Remarks on points that change with steps of half the
    length; nothing if none does.
    """
    layout = table.layout
    known = np.flatnonzero(~table.failed)
    some = known[:: max(-(-len(known) // COMPUTED_AGAIN), 1)].tolist()
    requests = [layout.context.history(layout[number]) for number in some]
    if any(request.structure.twist for request in requests):
        yield "steps: points of slabs that turn were not computed again with half the length"
        return
    finer = [
        replace(of, settings=replace(of.settings, accuracy=FINER * of.settings.accuracy))
        for of in requests
    ]
    after = zip(some, demands(finer), strict=True)
    changes = sorted(
        (_change(table, *each) for each in after), key=lambda change: -change[0]
    )
    if names := [text for change, text in changes if change > 0.0]:
        more = f" and {len(names) - NAMED} more" * (len(names) > NAMED)
        yield (
            f"steps: of {len(some)} points (of {len(known)}) computed again with steps of"
            f" half the length {len(names)} changed: point"
            f" {', '.join(names[:NAMED])}{more}. There a change smaller than the error of"
            " a step decides: judge by many records"
        )


def _change(table: PointTable, number: int, after: Demand) -> tuple[float, str]:
    """Largest relative change of a point with shorter steps, 0
    if none, and all in words.
    """
    if (outcome := table.outcomes[number]) != after.outcome:
        return math.inf, f"{number + 1} ({outcome} or {after.outcome})".replace("_", " ")
    before = {name: float(values[number]) for name, values in table.columns.items()}
    known = {quantity.name for quantity in after.quantities} & before.keys()
    found = {name: getattr(after, name) for name in known}
    system = number // table.layout.points_of_system
    limits = {each.name: each.limit for each in table.layout.properties[system].limits}
    changes = step_changes(before, found, limits)
    words = ", ".join(f"{name} {change:.2g} of it" for name, change in changes.items())
    return max(changes.values(), default=0.0), f"{number + 1} ({words})"


def step_changes(
    before: Mapping[str, float | None],
    after: Mapping[str, float | None],
    limits: Mapping[str, float],
) -> dict[str, float]:
    """Relative changes that are larger than promised, of the main results and of those
    that have a limit, of which what is small beside the limit says nothing.
    """
    changes = {}
    for name in dict.fromkeys((*MAIN, *limits)):
        old = before.get(name)
        new = after.get(name)
        if old is None or new is None:
            continue
        size = max(abs(old), abs(new))
        if abs(new - old) > PROMISED * max(size, abs(limits.get(name, 0.0))):
            changes[name] = abs(new - old) / size
    return changes
