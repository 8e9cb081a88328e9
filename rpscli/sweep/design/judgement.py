"""Designs against what is required of them, under the records as they are and as they might be."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from rpscli.case.conditions import EVENTS, Condition
from rpscli.case.design import DesignTask, Objective
from rpscli.sweep.statistics.verdicts import decisive, judge, worse
from rpscli.sweep.table import Array, Table

Demands = Mapping[str, Array]
"""(designs, records, intensities) of each limit by name, larger ones the worse: see `worse`.

NaN where a history failed or the design is not a valid case."""


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


def demands_of(table: Table, name: str) -> Array:
    """(designs, records, intensities) demands of the designs of a study on a limit."""
    layout = table.layout
    shape = len(layout.properties), len(layout.records), len(layout.scales)
    return worse(table, name).reshape(shape)


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


def judged_designs(
    task: DesignTask,
    requirements: Sequence[Requirement],
    values: Array,
    demands: Demands,
    weights: Array,
) -> Judged:
    """Judge designs with values (designs, keys) in weightings (weightings, records) of the records.

    `demands` are those of the names in requirements and aims.
    """
    found, excess, met = [], [], []
    for requirement in requirements:
        condition = requirement.condition
        at = demands[condition.name][:, :, requirement.intensity]
        counted = judge(at, weights, condition)
        excess.append(counted.excess[0])
        met.append(counted.met)
        if condition.name in EVENTS:
            with np.errstate(invalid="ignore", divide="ignore"):
                found.append(counted.beyond / counted.total)
        else:
            found.append(condition.sign * decisive(at, weights, condition))
    keys = dict(zip(task.keys, values.T, strict=True))
    aims = [_aim(aim, keys, demands, weights) for aim in task.file.minimise]
    return Judged(tuple(requirements), *map(np.array, (found, excess, met, aims)))


def _aim(aim: Objective, keys: Mapping[str, Array], demands: Demands, weights: Array) -> Array:
    """(weightings, designs) a sum; of a result, the largest of all intensities."""
    total = np.zeros((len(weights), len(next(iter(keys.values())))))
    for name, term in aim.items():
        if name in keys:
            total += term.times * keys[name]
            continue
        condition = Condition(name, 0.0, "", fractile=term.fractile)
        of_each = [decisive(at, weights, condition) for at in np.moveaxis(demands[name], 2, 0)]
        total += term.times * np.max(of_each, axis=0)
    return total
