"""A target spectrum: pseudo-acceleration over the period, with the peaks that go with it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rpscli.errors import RecordError

Array = NDArray[np.float64]

AMPLIFICATION = 1.65
"""Pseudo-velocity over PGV: median of Newmark and Hall, 1982, at 5 % damping."""


@dataclass(frozen=True)
class TargetSpectrum:
    """What the response spectra of motions are compared with.

    Parameters
    ----------
    name : str
        Short, for figures.
    source : str
        As the user wrote it.
    damping : float
        Share of critical damping.
    span : tuple of float [s]
        Periods between which it is defined.
    shape : callable
        Periods (n,) [s] to pseudo-accelerations (n,) [m/s2].
    pgv : float, optional [m/s]
        Peak ground velocity that goes with it; None if it cannot be told.
    pgd : float, optional [m]
        Peak ground displacement; None if the code gives none.
    """

    name: str
    source: str
    damping: float
    span: tuple[float, float]
    shape: Callable[[Array], Array]
    pgv: float | None
    pgd: float | None

    def acceleration(self, periods: Array) -> Array:
        """Pseudo-acceleration at periods (n,) [s], (n,) [m/s2].

        Raises
        ------
        RecordError
            If a period is outside the span.
        """
        low, high = self.span
        outside = (periods < low * (1.0 - 1e-9)) | (periods > high * (1.0 + 1e-9))
        if outside.any():
            raise RecordError(
                f"{self.source}: has no value at {periods[outside][0]:g} s; it is defined from"
                f" {low:g} to {high:g} s: choose --periods within"
            )
        return self.shape(np.clip(periods, low, high))


def velocity_of(shape: Callable[[Array], Array]) -> float:
    """PGV [m/s] that goes with a 5 % spectrum: its pseudo-velocity at 1 s over 1.65.

    Parameters
    ----------
    shape
        Periods (n,) [s] to pseudo-accelerations (n,) [m/s2].

    References
    ----------
    FEMA, Hazus-MH 2.1, Earthquake Model Technical Manual, section 4.1.

    Examples
    --------
    >>> round(velocity_of(lambda periods: 9.80665 * 0.6 / periods), 4)
    0.5676
    """
    return float(shape(np.ones(1))[0]) / (2.0 * math.pi) / AMPLIFICATION
