"""The wishes of a user for a set of motions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rpscli.errors import RecordError
from rpscli.records.target import Component
from rpscli.tools.selection.requirements import Periods


@dataclass(frozen=True)
class SelectionRequest:
    """A request for `count` motions, or pairs, whose spectra are compared in `periods`
    [s].

    `factors` bound those on a motion, `per_event` the motions from one earthquake. A
    `pgv` [m/s] is that of every motion, in place of the factor that fits it best. `rules`
    name what a code asks of the set, enforced and judged, None what the target's asks;
    its range of periods is about those of the `structure`.
    """

    count: int
    periods: tuple[float, float]
    factors: tuple[float, float] = (0.25, 4.0)
    per_event: int = 2
    pgv: float | None = None
    of: Component = "component"
    rules: str | None = None
    structure: Periods | None = None

    def __post_init__(self) -> None:
        (short, long) = self.periods
        (low, high) = self.factors
        if not 0.0 < short < long < np.inf:
            raise RecordError(f"--periods {short:g} {long:g}: must be > 0 and grow")
        if not 0.0 < low <= high < np.inf:
            raise RecordError(f"--factors {low:g} {high:g}: must be > 0 and not fall")
        if self.count < 1 or self.per_event < 1:
            raise RecordError(
                "the numbers of motions and of motions per event must be >= 1"
            )
        if self.pgv is not None and not 0.0 < self.pgv < np.inf:
            raise RecordError(f"--pgv {self.pgv:g}: must be > 0, in m/s")
