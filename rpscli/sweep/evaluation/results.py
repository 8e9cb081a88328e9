"""Results of points as columns under their published names."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses import result_quantities as rq
from rpscli.analyses.modal import modal
from rpscli.analyses.pushover import pushover
from rpscli.analyses.result_quantities import ResultQuantity
from rpscli.case.study.schema import Analysis
from rpscli.model.podium import PodiumStructure

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

DONE = "done"
"""Outcome of an analysis that has no others."""

FAILED = "failed"

MISSING = ""
"""Outcome of a point that has not been computed."""


class PointResults(NamedTuple):
    """What became of some points, of which each has a row.

    `outcomes` are (points,) words; `messages` say by the number of the row why points failed;
    `columns` are (points, ...) under the names of results, NaN where a point has none.
    """

    outcomes: NDArray[np.str_]
    messages: dict[int, str]
    columns: dict[str, Array]

    def failed(self) -> int:
        """How many failed."""
        return int(np.count_nonzero(self.outcomes == FAILED))


def no_results(count: int) -> PointResults:
    """Of points about which nothing is known yet."""
    return PointResults(np.full(count, MISSING, dtype="U20"), {}, {})


def put(found: PointResults, at: Indices, name: str, values: Array) -> None:
    """Set a column at some rows; what is wider than the column so far widens it."""
    column = found.columns.get(name)
    shape = (len(found.outcomes), *values.shape[1:])
    if column is None:
        column = found.columns[name] = np.full(shape, np.nan)
    elif any(new > old for new, old in zip(shape, column.shape, strict=True)):
        before, wider = column, map(max, shape, column.shape)
        column = found.columns[name] = np.full(tuple(wider), np.nan)
        column[_up_to(before.shape)] = before
    inner: Any = (at, *_up_to(values.shape[1:]))
    column[inner] = values


def _up_to(shape: Sequence[int]) -> tuple[slice, ...]:
    return tuple(slice(0, size) for size in shape)


def failures(messages: Sequence[str]) -> PointResults:
    """Of points that all failed."""
    found = no_results(len(messages))
    found.outcomes[:] = FAILED
    found.messages.update(enumerate(messages))
    return found


Named = dict[str, ResultQuantity]
"""Quantities by their dotted paths in the results of a point."""


def _named(
    quantities: Iterable[ResultQuantity], places: Iterable[str] = ("",), index: str = ""
) -> Named:
    known = tuple(quantities)
    return {f"{place}{q.name}{index}": q for place in places for q in known}


_FIXED, _ROLLING, _ROCKING = ("fixed_base.",), ("rolling.",), ("rocking.",)

SCALARS: dict[Analysis, Named] = {
    "timehistory": _named((*rq.HISTORY, *rq.SAMPLED, *rq.IMPACTS, *rq.INTENSITIES)),
    "modal": _named(rq.FIXED_BASE_MODES, _FIXED, ".0")
    | _named(rq.UPLIFTED_RATIOS, _ROLLING, ".0")
    | _named(rq.FREQUENCY_PARAMETERS, _ROLLING)
    | _named(rq.UPLIFTED_RATIOS, _ROCKING, ".0")
    | _named(rq.FREQUENCY_PARAMETERS, _ROCKING),
    "pushover": _named(rq.PUSHOVER),
}
"""Scalar results of each analysis, in the order of `points.csv`; modes count from 0."""

KNOWN: dict[Analysis, Named] = {
    "timehistory": SCALARS["timehistory"] | _named([rq.STOREY_SHEARS]),
    "modal": _named((*rq.FIXED_BASE_MODES, *rq.FIXED_BASE_SHAPES), _FIXED)
    | _named((*rq.LINEAR, *rq.UPLIFTED_SHAPES), _ROLLING + _ROCKING)
    | _named(rq.LINEAR, ("rolling.first_order.", "rocking.first_order."))
    | _named([rq.LEVEL]),
    "pushover": SCALARS["pushover"]
    | _named((*rq.STOREY_CURVE, *rq.STOREY_CURVE_RATIOS), ["curve."]),
}
"""Results that a report may name; elements of lists by their index, counted from 0."""


def quantity(analysis: Analysis, path: str) -> ResultQuantity | None:
    """The quantity at a dotted path; None if the analysis has no such result."""
    return KNOWN[analysis].get(split(path)[0])


def parametric_results(analysis: Analysis, structure: PodiumStructure) -> dict[str, Any]:
    """Results of a modal or pushover analysis: numbers and lists under dotted paths."""
    found = _modal(structure) if analysis == "modal" else _pushover(structure)
    return {path: found[path] for path in KNOWN[analysis] if path in found}


def _modal(structure: PodiumStructure) -> dict[str, Any]:
    result = modal(structure)
    found: dict[str, Any] = {rq.LEVEL.name: range(structure.storeys + 1)}
    paper = {f"{name}.first_order": modes for name, (_, modes) in result.both_orders.items()}
    states: dict[str, Any] = {**result.uplifted, **paper, "fixed_base": result.fixed_base}
    for state, modes in states.items():
        if modes is not None:
            found |= {f"{state}.{name}": values for name, values in modes.profiles().items()}
            lists = rq.FIXED_BASE_MODES if state == "fixed_base" else rq.LINEAR
            found |= {f"{state}.{q.name}": getattr(modes, q.name) for q in lists}
    return found


def _pushover(structure: PodiumStructure) -> dict[str, Any]:
    result = pushover(structure)
    curve = {q.name: getattr(result.curve, q.name) for q in rq.STOREY_CURVE} | result.curve_ratios()
    scalars = {q.name: getattr(result, q.name) for q in rq.PUSHOVER}
    return scalars | {f"curve.{name}": values for name, values in curve.items()}


def stacked(values: Sequence[Any]) -> Array:
    """Numbers, or arrays of as many dimensions, as (points, ...): NaN where one has no number.

    >>> stacked([[1.0, 2.0], None, [3.0]]).tolist()
    [[1.0, 2.0], [nan, nan], [3.0, nan]]
    """
    arrays = [None if value is None else np.asarray(value, np.float64) for value in values]
    shapes = [array.shape for array in arrays if array is not None]
    found = np.full((len(arrays), *map(max, zip(*shapes, strict=True))), np.nan)
    for row, array in enumerate(arrays):
        if array is not None:
            place: Any = (row, *_up_to(array.shape))
            found[place] = array + 0.0  # no -0.0
    found[~np.isfinite(found)] = np.nan
    return found


def split(path: str) -> tuple[str, tuple[int, ...]]:
    """The name of a column and the place in its rows that a dotted path stands for."""
    parts, places = path.split("."), []
    while len(parts) > 1 and parts[-1].isdecimal():
        places.append(int(parts.pop()))
    return ".".join(parts), tuple(reversed(places))


def at_path(columns: Mapping[str, Array], path: str) -> Array | None:
    """What the points have at a dotted path; None where none can have it."""
    name, places = split(path)
    column = columns.get(name)
    if column is None or len(places) > column.ndim - 1:
        return None
    if any(place >= size for place, size in zip(places, column.shape[1:], strict=False)):
        return None
    inner: tuple[int | slice, ...] = (slice(None), *places)
    return column[inner]
