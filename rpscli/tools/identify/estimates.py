"""Parameters with their intervals, and what they are in a case."""

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
        """True if its interval has a width, and one below the value."""
        return 0.0 < self.high - self.low < abs(self.value)


class Identified(NamedTuple):
    """Estimates, and what they are in a case."""

    estimates: dict[tuple[str, str], Estimate]  # by name and unit
    keys: dict[str, str]  # values of keys, as written
    misfit: float  # distance of the model over the errors
    remarks: str
    ensembles: bool = False  # true if means of many motions were fitted
    residuals: tuple[dict[str, float], ...] = ()  # of each swing
    sensor: dict[str, float] | None = None  # what it adds to a rotation [rad, rad/s]
    fault: str = ""  # why what was measured does not say more of this case


def estimate(value: float, error: float, freedoms: int) -> Estimate:
    """From a standard error whose own size was estimated: Student's t."""
    from scipy.stats import t

    wide = float(t.ppf(0.5 + 0.5 * LEVEL, freedoms)) * error
    return Estimate(float(value), float(value - wide), float(value + wide))
