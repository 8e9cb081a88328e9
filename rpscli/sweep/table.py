"""All results of a study as columns, in its order; the ground on which statistics stand."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.result_quantities import STOREY_SHEARS
from rpscli.records.recordings import By
from rpscli.shown import Frozen, frozen
from rpscli.sweep.evaluation.results import FAILED, MISSING, SCALARS
from rpscli.sweep.points.layout import StudyPoints
from rpscli.sweep.store import Stored

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Table(Frozen):
    """Outcomes and scalar results of all points."""

    layout: StudyPoints
    """The study, laid out."""
    outcomes: NDArray[np.str_]
    """(points,) words."""
    scale: Array
    """(points,) factors on the records; NaN where it is not known."""
    columns: dict[str, Array]
    """(points,) of each scalar result under its name; NaN where there is none."""
    messages: dict[int, str]
    """Why points failed, by their number."""
    storey_shears: Array
    """(points, most storeys) largest storey shears from the bottom [N], NaN above the roof."""

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

    @property
    def clusters(self) -> Indices:
        """(points,) numbers of what is independent."""
        return self.layout.clusters

    @property
    def independent(self) -> By:
        """What that is."""
        return self.layout.independent


def tabulate(layout: StudyPoints, stored: Stored) -> Table:
    """Columns of what is stored, given in the order of the study."""
    names, count = SCALARS[layout.plan.analysis], len(layout)
    found = stored([*names, "scale", STOREY_SHEARS.name])
    unknown = np.full(count, np.nan)
    most = max(properties.storeys for properties in layout.properties)
    shears = np.full((count, most), np.nan)
    if (known := found.columns.get(STOREY_SHEARS.name)) is not None:
        shears[:, : known.shape[1]] = known
    return Table(
        layout,
        found.outcomes,
        found.columns.get("scale", unknown),
        {name: found.columns.get(name, unknown) for name in names},
        {row: text or "no reason was given" for row, text in found.messages.items()},
        shears,
    )


class Dimension(NamedTuple):
    """One axis of the product: the keys that name it, and their values along it."""

    keys: tuple[str, ...]
    rows: Sequence[tuple[object, ...]]


def dimensions(layout: StudyPoints) -> tuple[Dimension, ...]:
    """Axes of the study, then sample, record, scale and member: those of `StudyPoints.shape`."""
    axes = [Dimension(axis.keys, axis.rows) for axis in layout.study.axes]
    sources = [(None if r is None else r.source,) for r in layout.records]
    return (
        *axes,
        Dimension((), [()] * layout.combinations.shape[-1]),
        Dimension(("record",), sources),
        Dimension(("scale",), [(scale,) for scale in layout.scales]),
        Dimension((), [()] * len(layout.members)),
    )


class Group(NamedTuple):
    """Points that have the same values at some keys."""

    values: tuple[object, ...]
    points: Indices


def groups(layout: StudyPoints, keys: Sequence[str], within: Indices | None = None) -> list[Group]:
    """Points grouped by the values of keys, in the order in which the keys are named."""
    known, shape = dimensions(layout), layout.shape
    numbers = np.arange(len(layout)) if within is None else within
    places = np.unravel_index(numbers, shape)
    axes = list(dict.fromkeys(_axis(known, key) for key in keys))
    if not axes:
        return [Group((), numbers)]
    found: list[Group] = []
    for row in np.ndindex(*(shape[axis] for axis in axes)):
        chosen = np.ones(len(numbers), dtype=bool)
        for axis, place in zip(axes, row, strict=True):
            chosen &= places[axis] == place
        if chosen.any():
            at = dict(zip(axes, row, strict=True))
            values = tuple(_value(known[_axis(known, key)], key, at, known) for key in keys)
            found.append(Group(values, numbers[chosen]))
    return found


def _axis(known: Sequence[Dimension], key: str) -> int:
    return next(axis for axis, dimension in enumerate(known) if key in dimension.keys)


def _value(
    dimension: Dimension, key: str, at: dict[int, int], known: Sequence[Dimension]
) -> object:
    row = dimension.rows[at[_axis(known, key)]]
    return row[dimension.keys.index(key)]


def leading_keys(layout: StudyPoints) -> tuple[str, ...]:
    """The first key of each varied axis: what tells systems apart, sample aside."""
    return tuple(axis.keys[0] for axis in layout.study.axes)
