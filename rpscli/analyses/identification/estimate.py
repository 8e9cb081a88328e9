"""A value with its interval, from the scatter about what was fitted."""

from __future__ import annotations

from typing import NamedTuple

LEVEL = 0.90
"""Of every interval."""


class Estimate(NamedTuple):
    """A parameter with its interval of 90 %."""

    value: float
    low: float
    high: float

    @property
    def determined(self) -> bool:
        """Whether its interval has a width, and one below the value."""
        return 0.0 < self.high - self.low < abs(self.value)


def estimate(value: float, error: float, freedoms: int) -> Estimate:
    """From a standard error whose own size was estimated: Student's t."""
    from scipy.stats import t

    wide = float(t.ppf(0.5 + 0.5 * LEVEL, freedoms)) * error
    return Estimate(float(value), float(value - wide), float(value + wide))
