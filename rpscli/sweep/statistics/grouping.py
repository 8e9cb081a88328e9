"""Groups of histories, as every statistic of a study counts them.

What is kept apart, what is pooled, which points failed, shares with their intervals and fractiles
are decided here once: a report names keys, and takes what it gets.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rpscli.sweep.points.layout import StudyPoints
from rpscli.sweep.statistics.fractiles import Share, demand, fractiles, share
from rpscli.sweep.table import Array, Indices, Table, groups, leading_keys

INTENSITY = "scale"
"""How the groups of a table call the axis of factors and intensities."""


@dataclass(frozen=True, eq=False)
class Histories:
    """Points (m,) of one group that did not fail, and how many did."""

    table: Table
    values: tuple[object, ...]
    points: Indices
    failed: int

    def __len__(self) -> int:
        return len(self.points)

    @property
    def fallen(self) -> NDArray[np.bool_]:
        """(m,) which overturned."""
        return self.table.overturned[self.points]

    @property
    def overturned(self) -> Share:
        """The share that overturned."""
        return self.share(self.table.overturned)

    @property
    def survivors(self) -> Indices:
        """Points that did not overturn."""
        return self.points[~self.fallen]

    def share(self, happened: NDArray[np.bool_]) -> Share:
        """The share in which something happened, told for all points of the study."""
        return share(int(happened[self.points].sum()), len(self.points))

    def demands(self, result: str) -> Array:
        """(m,) values of a result, infinite where overturned."""
        return demand(self.table, self.table.columns[result])[self.points]

    def fractiles(self, result: str, shares: Sequence[float]) -> Array:
        """Fractiles of a result, in which an overturned history is larger than any demand."""
        return fractiles(self.demands(result), shares)

    def parts(self, keys: Sequence[str]) -> list[Histories]:
        """Its points that did not fail, grouped by further keys."""
        layout = self.table.layout
        return [
            Histories(self.table, group.values, group.points, 0)
            for group in groups(layout, keys, self.points)
        ]


@dataclass(frozen=True, eq=False)
class Grouping:
    """All groups under the keys that tables and figures show.

    `pooled` says what differs within a group besides the record, `notes` warn of it.
    """

    keys: tuple[str, ...]
    groups: tuple[Histories, ...]
    pooled: tuple[str, ...]
    notes: tuple[str, ...]

    @property
    def failed(self) -> int:
        """Points left out."""
        return sum(group.failed for group in self.groups)

    @property
    def overturned(self) -> int:
        """Points that overturned."""
        return sum(group.overturned.number for group in self.groups)

    @property
    def values(self) -> list[tuple[object, ...]]:
        """Values of the keys in each group."""
        return [group.values for group in self.groups]


def grouping(
    table: Table,
    keys: Sequence[str] | None = None,
    besides: Sequence[str] = (),
    within: Indices | None = None,
) -> Grouping:
    """Points grouped by some keys; by default each system at each intensity.

    `besides` are keys that tell points apart inside a group: series, abscissae. `within` are points
    to be grouped, in place of all.
    """
    layout = table.layout
    keys = own_keys(layout, besides) if keys is None else tuple(keys)
    found = []
    for group in groups(layout, keys, within):
        failed = table.failed[group.points]
        found.append(Histories(table, group.values, group.points[~failed], int(failed.sum())))
    differing = pooled(layout, (*keys, *besides))
    return Grouping(shown_keys(layout, keys), tuple(found), differing, pooling_notes(differing))


def own_keys(layout: StudyPoints, besides: Sequence[str] = ()) -> tuple[str, ...]:
    """What tells systems and intensities apart, where a report does not say otherwise.

    Keys that vary together with one of `besides` are left out.
    """
    together = {key for other in besides for key in axis_keys(layout, other)}
    keys = tuple(key for key in leading_keys(layout) if key not in together)
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
    return tuple(_pooled(layout, set(keys)))


def _pooled(layout: StudyPoints, keys: set[str]) -> Iterator[str]:
    for axis in layout.study.axes:
        if len(axis.rows) > 1 and not keys & set(axis.keys):
            yield f"{len(axis.rows)} values of {axis.keys[0]}"
    if (samples := layout.combinations.shape[-1]) > 1:
        yield f"{samples} samples"
    if len(layout.scales) > 1 and INTENSITY not in keys:
        yield f"{len(layout.scales)} intensities"
    if len(layout.members) > 1:
        yield f"{len(layout.members)} members"


def pooling_notes(differing: Sequence[str]) -> tuple[str, ...]:
    """The warning that belongs to what is pooled; empty if nothing is."""
    if not differing:
        return ()
    text = f"pools {' and '.join(differing)}, which differ"
    return (f"{text}: histories of one record are not independent, so intervals are too narrow",)


def shown_keys(layout: StudyPoints, keys: Sequence[str]) -> tuple[str, ...]:
    """The keys as tables and figures call them: an intensity by its measure."""
    measure = layout.plan.measure
    name = INTENSITY if measure is None else measure.measure
    return tuple(name if key == INTENSITY else key for key in keys)


def apart(layout: StudyPoints, keys: Sequence[str]) -> tuple[str, ...]:
    """The keys, and the intensity with them if the study has several."""
    several = len(layout.scales) > 1 and INTENSITY not in keys
    return (*keys, INTENSITY) if several else tuple(keys)


def pooling_note(layout: StudyPoints, keys: Sequence[str]) -> tuple[str, ...]:
    """The warning that belongs to what is pooled within groups of these keys."""
    return pooling_notes(pooled(layout, keys))
