"""Groups of histories, as every statistic of a study counts them.

What is kept apart, what is pooled, which points failed, shares with their intervals and
fractiles are decided here once: a report names keys, and takes what it gets.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rpscli.records.measures import measure_label
from rpscli.shown import Frozen, frozen
from rpscli.sweep.names import with_names
from rpscli.sweep.points import StudyPoints
from rpscli.sweep.statistics.fractiles import Share, demand, fractiles, share_of
from rpscli.sweep.table import Array, Indices, Outcomes, PointTable, groups

INTENSITY = "scale"
"""Name of the axis of factors and intensities in groups of a table."""


@dataclass(frozen=True, eq=False)
class Histories(Frozen):
    """The points of one group; those that failed are counted, and enter nothing else."""

    table: Outcomes
    values: tuple[object, ...]
    every: Indices

    def __len__(self) -> int:
        return len(self.points)

    @cached_property
    def points(self) -> Indices:
        """(m,) those that did not fail."""
        return frozen(self.every[~self.table.failed[self.every]])

    @property
    def failed(self) -> int:
        """Points left out."""
        return len(self.every) - len(self.points)

    @property
    def fallen(self) -> NDArray[np.bool_]:
        """(m,) which overturned."""
        return frozen(self.table.overturned[self.points])

    @cached_property
    def overturned(self) -> Share:
        """The share that overturned."""
        return share_of(self.table, self.points, self.fallen)

    @property
    def survivors(self) -> Indices:
        """Points that did not overturn."""
        return frozen(self.points[~self.fallen])

    def demands(self, values: Array) -> Array:
        """(m,) of a result of all points of the study, infinite where overturned."""
        return demand(self.table, values)[self.points]

    def statistic(self, values: Array, wanted: float | str) -> float:
        """The mean of survivors, or a fractile in which what
        overturned is the largest; or NaN.
        """
        if wanted == "mean":
            known = values[self.survivors]
            known = known[~np.isnan(known)]
            return math.fsum(known) / len(known) if len(known) else math.nan
        share = {"median": 0.5, "largest": 1.0}.get(str(wanted)) or float(wanted)
        return float(fractiles(self.demands(values), [share])[0])

    def parts(self, keys: Sequence[str]) -> list[Histories]:
        """Its points grouped by further keys."""
        assert isinstance(self.table, PointTable), "keys are those of a study"
        found = groups(self.table.layout, keys, self.every)
        return [Histories(self.table, group.values, group.points) for group in found]


def statistic_words(wanted: float | str) -> str:
    """A statistic in words."""
    if wanted == "mean":
        return "mean of survivors"
    return wanted if isinstance(wanted, str) else f"{100.0 * wanted:g} % fractile"


@dataclass(frozen=True, eq=False)
class Grouping:
    """All groups under the keys of tables; `pooled` differs within
    them, `notes` warn of it.
    """

    keys: tuple[str, ...]
    groups: tuple[Histories, ...]
    pooled: tuple[str, ...]
    notes: tuple[str, ...]

    @property
    def computed(self) -> list[Histories]:
        """Groups with points that did not fail."""
        return [group for group in self.groups if len(group)]

    @property
    def failed(self) -> int:
        """Points left out."""
        return sum(group.failed for group in self.groups)

    @property
    def overturned(self) -> int:
        """Points that overturned."""
        return sum(group.overturned.number for group in self.groups)


def grouping(
    table: PointTable,
    keys: Sequence[str] | None = None,
    besides: Sequence[str] = (),
) -> Grouping:
    """Points grouped by keys; `besides` are those that tell them apart inside."""
    layout = table.layout
    keys = own_keys(layout, besides) if keys is None else tuple(keys)
    found = (Histories(table, *group) for group in groups(layout, keys))
    differing = pooled(layout, (*keys, *besides))
    of = f"intervals count {layout.independent}"
    if layout.alone:
        of = "intervals are of these histories, and say nothing of other records"
    notes = (f"pools {' and '.join(differing)}: {of}",) if differing else ()
    return Grouping(shown_keys(layout, keys), tuple(found), differing, notes)


def own_keys(layout: StudyPoints, besides: Sequence[str] = ()) -> tuple[str, ...]:
    """Keys of systems and intensities, without those that vary with one of `besides`."""
    together = {key for other in besides for key in axis_keys(layout, other)}
    naming = (key for axis in layout.study.axes for key in axis.naming)
    keys = tuple(key for key in naming if key not in together)
    several = len(layout.scales) > 1 and INTENSITY not in besides
    return (*keys, INTENSITY) if several else keys


def axis_keys(layout: StudyPoints, key: str) -> tuple[str, ...]:
    """The keys of the axis in which a key varies; none if it does not."""
    if key in {"record", INTENSITY}:
        return (key,)
    axes = (axis.keys for axis in layout.study.axes)
    return next((keys for keys in axes if key in keys), ())


def pooled(layout: StudyPoints, keys: Sequence[str]) -> tuple[str, ...]:
    """In words, what differs within groups of these keys besides the record."""
    axes = (axis for axis in layout.study.axes if not set(keys) & set(axis.keys))
    counts = [(len(axis.rows), f"values of {axis.keys[0]}") for axis in axes]
    counts += [(layout.samples, "samples")]
    counts += [(len(layout.scales), "intensities")] * (INTENSITY not in keys)
    counts += [(len(layout.members), "members")]
    return tuple(f"{count} {what}" for count, what in counts if count > 1)


def shown_keys(layout: StudyPoints, keys: Sequence[str]) -> tuple[str, ...]:
    """The keys as tables and figures call them: an intensity by its measure, those of an
    axis with the names of its rows.
    """
    measure = layout.plan.measure
    name = INTENSITY if measure is None else measure_label(measure.measure, layout.of)
    axes = layout.study.axes
    return tuple(name if key == INTENSITY else with_names(axes, key) for key in keys)
