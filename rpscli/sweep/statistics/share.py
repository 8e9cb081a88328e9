"""A share of histories, with the interval in which the probability behind it lies."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

CONFIDENCE = 0.95


class Share(NamedTuple):
    """A number of so many histories, and the interval of the probability; NaN without any.

    The interval is that of Clopper and Pearson, exact for independent histories. Where none or all
    are counted it has one end only, which then has the whole confidence.
    """

    number: int
    of: int
    low: float
    high: float

    @property
    def fraction(self) -> float | None:
        """The share; None without histories."""
        return self.number / self.of if self.of else None

    @property
    def interval(self) -> str:
        """The interval in words.

        >>> share(0, 22).interval, share(3, 22).interval, share(5, 5).interval, share(0, 0).interval
        ('below 0.13', '0.029 to 0.35', 'above 0.55', '-')
        """
        if not self.of:
            return "-"
        if self.number in {0, self.of}:
            return f"above {self.low:#.2g}" if self.number else f"below {self.high:#.2g}"
        return f"{self.low:#.2g} to {self.high:#.2g}"

    def __str__(self) -> str:
        """Counts and interval.

        >>> str(share(0, 22))
        '0 of 22 (95 %: below 0.13)'
        """
        return f"{self.number} of {self.of} ({100.0 * CONFIDENCE:g} %: {self.interval})"


@lru_cache(maxsize=65_536)
def share(number: int, of: int) -> Share:
    """The share with its interval.

    Parameters
    ----------
    number
        Histories in which it happened [-].
    of
        All histories that did not fail [-].
    """
    # Not `scipy.stats.binomtest`, whose import takes as long as a thousand histories.
    from scipy.special import betaincinv

    if not of:
        return Share(0, 0, float("nan"), float("nan"))
    beyond = 1.0 - CONFIDENCE
    end = beyond if number in {0, of} else 0.5 * beyond
    low = betaincinv(number, of - number + 1, end) if number else 0.0
    high = betaincinv(number + 1, of - number, 1.0 - end) if number < of else 1.0
    return Share(number, of, float(low), float(high))
