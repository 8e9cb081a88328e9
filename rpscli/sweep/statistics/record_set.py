"""One structure under several records: what codes want of them, and verdicts."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from rpscli.analyses.result_quantities import DEMANDS, ResultQuantity
from rpscli.case.conditions import EVENTS, Condition
from rpscli.sweep.statistics.fractiles import fractiles, spread
from rpscli.sweep.statistics.share import Share, share
from rpscli.sweep.table import Array

Scalars = Mapping[str, Any]
"""Scalar results of a history by their names, the outcome with them."""


class SetDemand(NamedTuple):
    """A demand over the records: infinite where so many overturned, the mean where any did."""

    mean: float
    median: float
    high: float
    largest: float


class RecordSet(NamedTuple):
    """Histories of a structure under a set of records.

    Parameters
    ----------
    counted
        Histories that did not fail.
    failed
        Those that did, which enter nothing else.
    overturned
        How many of them overturned, with the interval of the probability.
    demands
        Of each quantity that the structure has.
    """

    counted: int
    failed: int
    overturned: Share
    demands: dict[ResultQuantity, SetDemand]


class SetVerdict(NamedTuple):
    """What became of a condition.

    `beyond` are the records that exceed it, every overturned one among them; `worst` is the place
    of the worst value among the records, `value` that value, infinite where it overturned.
    """

    condition: Condition
    beyond: Share
    value: float
    worst: int
    exceeded: bool


def record_set(histories: Sequence[Scalars]) -> RecordSet:
    """Mean, median, 84 % fractile and largest of the maxima of histories."""
    known = [history for history in histories if history["outcome"] != "failed"]
    demands = {}
    for quantity in DEMANDS:
        values = _demands(known, quantity.name)
        if len(values) and not np.isnan(values).any():
            demands[quantity] = SetDemand(float(np.mean(values)), *spread(values))
    return RecordSet(
        counted=len(known),
        failed=len(histories) - len(known),
        overturned=share(sum(map(_overturned, known)), len(known)),
        demands=demands,
    )


def set_verdicts(
    histories: Sequence[Scalars], conditions: Iterable[Condition]
) -> tuple[SetVerdict, ...]:
    """Every condition over the histories that did not fail; none without any."""
    known = [place for place, each in enumerate(histories) if each["outcome"] != "failed"]
    if not known:
        return ()
    return tuple(_verdict(histories, known, condition) for condition in conditions)


def _verdict(histories: Sequence[Scalars], known: list[int], condition: Condition) -> SetVerdict:
    found = [histories[place] for place in known]
    if condition.name in EVENTS:
        values = _happened(found, condition.name)
    else:
        values = _demands(found, condition.name, -np.inf if condition.from_below else np.inf)
    beyond = share(int((~condition.kept_by(values)).sum()), len(values))
    worst = int(np.argmin(values) if condition.from_below else np.argmax(values))
    if condition.fractile is None:
        exceeded = beyond.number / beyond.of > condition.share
    else:
        exceeded = not condition.kept_by(float(fractiles(values, [condition.fractile])[0]))
    return SetVerdict(condition, beyond, float(values[worst]), known[worst], exceeded)


def _overturned(history: Scalars) -> bool:
    return str(history["outcome"]).startswith("overturned")


def _happened(histories: Sequence[Scalars], event: str) -> Array:
    if event == "overturning":
        return np.array([float(_overturned(history)) for history in histories])
    return np.array([float(history["uplifts"]) for history in histories])


def _demands(histories: Sequence[Scalars], name: str, overturned: float = np.inf) -> Array:
    """(histories,) infinite where overturned, NaN where the structure has no such result."""
    values = [
        overturned if _overturned(each) else np.nan if each[name] is None else float(each[name])
        for each in histories
    ]
    return np.array(values)
