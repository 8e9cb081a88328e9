"""Designs against what is required of them, under the records as they are and as they might be."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from rpscli.case.conditions import EVENTS, LIMITS, Condition
from rpscli.case.design import Aim, DesignTask
from rpscli.sweep.statistics.verdicts import exceeds
from rpscli.sweep.table import Array, Table

ROUNDING = 1e-9
"""Of shares times numbers of records, which are meant as whole numbers."""

Demands = Mapping[str, Array]
"""(designs, records, intensities) of each result by name; events count 1 where they happened.

Of results of which small values are bad, the negative ones. Infinite where a history overturned,
NaN where it failed or the design is no valid case."""


class Requirement(NamedTuple):
    """A condition at one intensity: its place among them, its measure and its value.

    The value is None where there is one intensity only.
    """

    condition: Condition
    intensity: int
    measure: str = "scale"
    level: float | None = None

    @property
    def bound(self) -> float:
        """What the value must keep: an admissible share of an event, or a limit."""
        return self.condition.share if self.condition.name in EVENTS else self.condition.limit

    @property
    def sign(self) -> float:
        """By which larger demands are worse ones."""
        return -1.0 if self.condition.from_below else 1.0


class Weights(NamedTuple):
    """How often each record counts, (rows, records).

    The first row is of ones. `resamples` rows of a bootstrap follow, then one row for each record
    that is left out, if there are several.
    """

    rows: Array
    resamples: int


def weights_of(records: int, resamples: int, seed: int) -> Weights:
    """The records as they are, drawn anew, and without one of them at a time."""
    if records < 2:
        return Weights(np.ones((1, records)), 0)
    even = np.full(records, 1.0 / records)
    drawn = np.random.default_rng(seed).multinomial(records, even, size=resamples)
    ones = np.ones((1, records))
    return Weights(np.concatenate([ones, drawn, 1.0 - np.eye(records)]), resamples)


def demands_of(table: Table, names: Sequence[str]) -> dict[str, Array]:
    """Demands of the designs of a study, whose points are designs x records x intensities."""
    layout = table.layout
    shape = len(layout.properties), len(layout.records), len(layout.scales)
    found = {}
    for name in names:
        if name in EVENTS:
            values = exceeds(table, name, 0.0).astype(float)
        else:
            column = table.columns[name]
            sign = -1.0 if name in LIMITS and LIMITS[name].from_below else 1.0
            values = np.where(table.overturned | np.isnan(column), np.inf, sign * column)
        found[name] = np.where(table.failed, np.nan, values).reshape(shape)
    return found


@dataclass(frozen=True, eq=False)
class Judged:
    """What became of each design.

    Parameters
    ----------
    requirements
        In the order of the rows below.
    values
        (requirements, weightings, designs) share of an event, or the demand that no more than the
        admissible records exceed.
    excess
        (requirements, designs) records beyond the limit less those that may be, over all of them;
        a requirement is met where it is not positive.
    met
        (requirements, weightings, designs)
    aims
        (aims, weightings, designs)
    """

    requirements: tuple[Requirement, ...]
    values: Array
    excess: Array
    met: np.typing.NDArray[np.bool_]
    aims: Array

    @property
    def passes(self) -> np.typing.NDArray[np.bool_]:
        """(weightings, designs) whether all requirements are met."""
        return np.asarray(self.met.all(axis=0))


def judge(
    task: DesignTask,
    requirements: Sequence[Requirement],
    values: Array,
    demands: Demands,
    weights: Array,
) -> Judged:
    """Judge designs.

    Parameters
    ----------
    task
        What is to be least.
    requirements
        What must be kept.
    values
        (designs, keys) of the keys that change.
    demands
        Of the names in requirements and aims.
    weights
        (weightings, records)
    """
    found = np.array([_value(r, demands[r.condition.name], weights) for r in requirements])
    bounds = np.array([requirement.sign * requirement.bound for requirement in requirements])
    signs = np.array([requirement.sign for requirement in requirements])
    return Judged(
        requirements=tuple(requirements),
        values=signs[:, None, None] * found,
        excess=np.array([_excess(r, demands[r.condition.name]) for r in requirements]),
        met=np.asarray(found <= bounds[:, None, None]),
        aims=np.array(
            [_aim(aim, dict(zip(task.keys, values.T, strict=True)), demands, weights)
             for aim in task.file.least]
        ),
    )  # fmt: skip


def _value(requirement: Requirement, demands: Array, weights: Array) -> Array:
    """(weightings, designs) in which larger is worse; NaN without any history."""
    condition, at = requirement.condition, demands[:, :, requirement.intensity]
    if condition.name in EVENTS:
        known = ~np.isnan(at)
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.asarray(weights @ (np.nan_to_num(at) * known).T / (weights @ known.T))
    return _reached(at, weights, condition)


def _excess(requirement: Requirement, demands: Array) -> Array:
    """(designs,) records too many beyond the limit, over all; infinite without any history."""
    condition, at = requirement.condition, demands[:, :, requirement.intensity]
    total = (~np.isnan(at)).sum(axis=1).astype(float)
    limit = 0.0 if condition.name in EVENTS else requirement.sign * condition.limit
    beyond = (at > limit).sum(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(total > 0.0, (beyond - admissible(condition, total)) / total, np.inf)


def admissible(condition: Condition, total: Array) -> Array:
    """How many of so many records may be beyond the limit, as studies are judged."""
    if condition.fractile is not None:
        up_to = np.ceil(condition.fractile * total - ROUNDING)
        return np.asarray(up_to - 1.0 if condition.from_below else total - up_to)
    return np.asarray(np.floor(condition.share * total + ROUNDING))


def _reached(demands: Array, weights: Array, condition: Condition) -> Array:
    """(weightings, designs) least demand that no more than the admissible records exceed."""
    found = np.full((len(weights), len(demands)), np.nan)
    for place, row in enumerate(demands):
        order = np.argsort(row, kind="stable")[: int((~np.isnan(row)).sum())]
        if not len(order):
            continue
        counted = np.cumsum(weights[:, order], axis=1)
        total = counted[:, -1]
        needed = np.maximum(total - admissible(condition, total), 1.0)
        first = (counted >= needed[:, None] - ROUNDING).argmax(axis=1)
        found[:, place] = np.where(total > 0.0, row[order][first], np.nan)
    return found


def _aim(aim: Aim, keys: Mapping[str, Array], demands: Demands, weights: Array) -> Array:
    """(weightings, designs) a sum; of a result, the largest of all intensities."""
    total = np.zeros((len(weights), len(next(iter(keys.values())))))
    for name, term in aim.items():
        if name in keys:
            total += term.times * keys[name]
            continue
        condition = Condition(name, 0.0, "", fractile=term.fractile)
        of_each = [_reached(at, weights, condition) for at in np.moveaxis(demands[name], 2, 0)]
        total += term.times * np.max(of_each, axis=0)
    return total
