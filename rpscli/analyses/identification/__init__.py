"""What measurements on a standing structure say about it: values with their intervals."""

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


class Identified(NamedTuple):
    """Estimates by name and unit; values of keys of the case, as they are written.

    `misfit` is the distance of the model over the errors, `ensembles` whether means of many motions
    were fitted. `residuals` are, of each swing, time and amplitude, their errors, and those of the
    model.
    """

    estimates: dict[tuple[str, str], Estimate]
    keys: dict[str, str]
    misfit: float
    remarks: str
    ensembles: bool = False
    residuals: tuple[dict[str, float], ...] = ()


def estimate(value: float, error: float, freedoms: int) -> Estimate:
    """From a standard error whose own size was estimated: Student's t."""
    from scipy.stats import t

    wide = float(t.ppf(0.5 + 0.5 * LEVEL, freedoms)) * error
    return Estimate(float(value), float(value - wide), float(value + wide))
